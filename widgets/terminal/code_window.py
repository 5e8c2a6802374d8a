"""Code read from the controller or a file, and where it differs from the open program."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from difflib import SequenceMatcher
from itertools import groupby

from PySide6.QtCore import Signal
from PySide6.QtGui import QTextCharFormat, QTextCursor
from PySide6.QtWidgets import (
    QDialog,
    QLabel,
    QPlainTextEdit,
    QPushButton,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from widgets.parts.foot import foot
from widgets.parts.look import look


class CodeWindow(QDialog):
    """Not modal; read only."""

    save_wanted = Signal(str)

    def __init__(
        self, title: str, text: str, own: str, parent: QWidget | None = None, where: str = "controller"
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(title)
        self.setModal(False)
        self.text = text
        theirs, mine = text.splitlines(), own.splitlines()
        same = [line.strip() for line in theirs if line.strip()] == [line.strip() for line in mine if line.strip()]
        self._where = where
        self.words = QLabel(_words(theirs, same, where))
        self.words.setWordWrap(True)
        self.code, self.differences = _view(f"Code in the {where}"), _view("Differences")
        self.code.setPlainText("\n".join(f"{number:4}  {line}" for number, line in enumerate(theirs)))
        self._compared: tuple[list[str], list[str]] | None = (mine, theirs)
        self.tabs = QTabWidget(self)
        self.tabs.addTab(self.code, f"In the {where}")
        if not same:
            self.tabs.addTab(self.differences, "Compared with the open program")
        self.tabs.currentChanged.connect(lambda _: self._show_differences())
        self.save, self.shut = QPushButton("Save as code…"), QPushButton("Close")
        self.save.setEnabled(bool(theirs))
        self.save.setVisible(where == "controller")  # what is in a file is saved already
        self.save.setToolTip("Writes it into a file" if theirs else "There is nothing to save")
        self.save.clicked.connect(lambda: self.save_wanted.emit(self.text))
        self.shut.clicked.connect(self.accept)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 16, 16, 16)
        column.addWidget(self.words)
        column.addWidget(self.tabs, 1)
        column.addWidget(foot(away=self.shut, left=(self.save,)))
        self.resize(640, 560)

    def add_words(self, sentence: str) -> None:
        """What else there is to say."""
        self.words.setText(f"{self.words.text()} {sentence}")

    def _show_differences(self) -> None:
        """When they are looked at for the first time."""
        if self._compared is None:
            return
        cursor = QTextCursor(self.differences.document())
        heads = {"-": "only in the open program   ", "+": f"only in the {self._where}".ljust(27), " ": " " * 27}
        for sign, lines in groupby(compared(*self._compared), key=lambda each: each[0]):
            shape = QTextCharFormat()
            shape.setForeground(look().colour({"-": "group_flow", "+": "accent"}.get(sign, "quiet")))
            cursor.insertText("".join(f"{heads[sign]}{line}\n" for _, line in lines), shape)
        self._compared = None


def compared(mine: Sequence[str], theirs: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Each line with its sign: "-" only in mine, "+" only in theirs; lines that took another's place behind it.

    Lines are the same or not: how alike two of them are takes Python seconds for some hundred.
    """
    for kind, first, last, begin, end in SequenceMatcher(None, mine, theirs).get_opcodes():
        if kind == "equal":
            yield from ((" ", line) for line in mine[first:last])
            continue
        gone, come = mine[first:last], theirs[begin:end]
        if len(gone) == len(come):
            yield from (each for old, new in zip(gone, come, strict=True) for each in (("-", old), ("+", new)))
        else:
            yield from (("-", line) for line in gone)
            yield from (("+", line) for line in come)


def _words(lines: list[str], same: bool, where: str) -> str:
    if not lines:
        return f"There is no program in the {where}."
    return f"{len(lines)} lines. " + (
        "They are the code of the open program." if same else "They differ from the open program."
    )


def _view(name: str) -> QPlainTextEdit:
    view = QPlainTextEdit()
    view.setReadOnly(True)
    view.setAccessibleName(name)
    view.setFont(look().code_font())
    view.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
    return view
