"""The code editor: a file of two-letter code, checked while it is typed, read from and sent to the controller."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QCloseEvent, QKeySequence, QShortcut
from PySide6.QtWidgets import QComboBox, QDialog, QHBoxLayout, QLabel, QListWidget, QPushButton, QVBoxLayout, QWidget

from codegen.models import Model
from codegen.twoletter.complete import Names
from codegen.twoletter.problems import Problem
from widgets.editor.text import EditorText
from widgets.panel import set_text

FILE = ("Open…", "Save", "Save as…", "Print…", "Insert into the program")
CONTROLLER = ("Upload", "Download", "Compare", "Execute", "Halt", "Burn")
SHORTCUTS = {"Open…": "Ctrl+O", "Save": "Ctrl+S", "Print…": "Ctrl+P"}
LABELS, LIST_HEIGHT = "Go to label", 120  # px


class EditorWindow(QDialog):
    """Not modal. `wanted` names the button that was pressed; the owner does it."""

    wanted = Signal(str)
    closing = Signal(object)  # the QCloseEvent; the owner may ignore it

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setModal(False)
        self.setProperty("helpPage", "Code editor")
        self.path: Path | None = None
        self._labels: list[tuple[str, int]] = []
        self._found: list[str] = []
        self.text = EditorText()
        self.labels, self.list = QComboBox(), QListWidget()
        self.words, self.help = QLabel(), QLabel()
        self.buttons: dict[str, QPushButton] = {}
        self._lay_out()
        self.text.help_changed.connect(lambda words: set_text(self.help, words))
        self.text.document().modificationChanged.connect(lambda _: self._retitle())
        self.labels.activated.connect(self._go_to_label)
        self.list.itemActivated.connect(self._go_to_problem)
        self.list.itemClicked.connect(self._go_to_problem)
        for name, keys in SHORTCUTS.items():
            shortcut = QShortcut(QKeySequence(keys), self)
            shortcut.activated.connect(self.buttons[name].click)
        self._retitle()

    @property
    def dirty(self) -> bool:
        """Whether something would be lost."""
        return self.text.document().isModified()

    def show_text(self, text: str, path: Path | None, changed: bool = False) -> None:
        """Another text; `changed`: it is in no file yet."""
        self.path = path
        self.text.setPlainText(text)
        self.text.document().setModified(changed)
        self.text.check_now()
        self._retitle()

    def show_saved(self, path: Path) -> None:
        """The text is in that file now."""
        self.path = path
        self.text.document().setModified(False)
        self._retitle()

    def show_reasons(self, reasons: dict[str, str]) -> None:
        """Why buttons are grey now; those without a reason are usable."""
        for name, button in self.buttons.items():
            reason = reasons.get(name, "")
            if button.isEnabled() == bool(reason):
                button.setEnabled(not reason)
            if button.toolTip() != reason:
                button.setToolTip(reason)

    def show_model(self, model: Model) -> None:
        """The controller the code is for."""
        self.text.show_model(model)

    def show_checked(self, names: Names, problems: Sequence[Problem]) -> None:
        """What was found in the text as it is: in the margin, as a list, and counted."""
        self.text.show_checked(names, problems)
        labels = self.text.labels()
        if labels != self._labels or not self.labels.count():
            self._labels = labels
            self.labels.clear()
            self.labels.addItems([LABELS if labels else "No labels", *[name for name, _ in labels]])
        found = [f"{problem.severity}, line {problem.line}: {problem.message}" for problem in problems]
        if found != self._found:
            self._found = found
            self.list.clear()
            self.list.addItems(found)
        count = len(problems)
        lines = f"{len(self.text.lines)} of {self.text.model.lines} lines"
        words = "no problems" if not count else f"{count} problem{'s' * (count != 1)}"
        self.say(f"{self.text.model.title}: {lines}, {words}.")

    def say(self, sentence: str) -> None:
        """One sentence at the bottom."""
        set_text(self.words, sentence)

    def closeEvent(self, event: QCloseEvent) -> None:
        event.accept()
        self.closing.emit(event)

    def reject(self) -> None:
        """Escape closes it like its cross: what is not saved is asked about."""
        self.close()

    # ---- inside

    def _retitle(self) -> None:
        name = self.path.name if self.path is not None else "not saved in a file"
        self.setWindowTitle(f"Code editor – {name}{' *' if self.dirty else ''}")

    def _go_to_label(self, index: int) -> None:
        self.labels.setCurrentIndex(0)
        if 0 < index <= len(self._labels):
            self.text.go_to(self._labels[index - 1][1])

    def _go_to_problem(self) -> None:
        row = self.list.currentRow()
        if 0 <= row < len(self.text.problems):
            self.text.go_to(self.text.problems[row].line)

    def _lay_out(self) -> None:
        self.resize(900, 640)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 12, 16, 12)
        press: Callable[[str], None] = self.wanted.emit
        for names in (FILE, CONTROLLER):
            row = QHBoxLayout()
            for name in names:
                button = self.buttons[name] = QPushButton(name)
                button.setAutoDefault(False)
                button.clicked.connect(partial(press, name))
                row.addWidget(button)
            row.addStretch(1)
            if names is FILE:
                self.labels.setAccessibleName(LABELS)
                self.labels.setMinimumWidth(140)
                row.addWidget(self.labels)
            column.addLayout(row)
        column.addWidget(self.text, 1)
        self.help.setTextFormat(Qt.TextFormat.RichText)
        self.help.setProperty("role", "quiet")
        self.help.setWordWrap(True)
        column.addWidget(self.help)
        self.list.setAccessibleName("Problems of the code")
        self.list.setMaximumHeight(LIST_HEIGHT)
        column.addWidget(self.list)
        self.words.setProperty("role", "quiet")
        column.addWidget(self.words)
