"""Kept back-ups of a controller: look inside, compare item by item, put one back, take a new one."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import (
    QDialog,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QLineEdit,
    QProgressBar,
    QPushButton,
    QSplitter,
    QTabWidget,
    QTextBrowser,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from widgets.panel import set_text
from widgets.parts.foot import foot
from widgets.parts.look import look

HEIGHT = 32  # px of a row
GAP = 20  # px between columns
EMPTY = (
    "Nothing is kept of this controller yet. “Back up now” reads everything it holds; before every download, burn and "
    "restore a back-up is made by itself."
)
COLUMNS = ("Taken", "Why", "Note")
BUTTONS = {  # what each says that it does
    "Back up now": "Reads parameters, program, variables and arrays; changes nothing",
    "Open file…": "Opens a back-up from a file",
    "Save a copy…": "Writes this back-up into a file, to keep it or hand it over",
    "Compare": "Reads the controller and says item by item what is otherwise",
    "Replace controller…": "The steps from a broken controller to a new one that does the same",
    "Restore…": "Puts this back-up into the controller, motors off, and compares afterwards",
}
Parts = Sequence[tuple[str, Sequence[str], bool]]  # heading, lines, whether they are code


class BackupWindow(QDialog):
    """Not modal; shows what it is handed and says what was pressed."""

    chosen = Signal(int)  # row of the list
    pressed = Signal(str)  # the text of a button
    cancelled = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Back-ups of the controller")
        self.setProperty("helpPage", "Back up, restore, replace")
        self.setModal(False)
        self.who, self.fit = QLabel(), QLabel()
        self.who.setProperty("role", "title")
        self.fit.setWordWrap(True)
        self.fit.setProperty("role", "quiet")
        self.note = QLineEdit()
        self.note.setAccessibleName("Note for the next back-up")
        self.note.setPlaceholderText("Note, for example: new gearbox")
        self.list = self._make_list()
        self.inside, self.compared = _page("What is in the back-up"), _page("Compared with the controller")
        self.tabs = QTabWidget()
        self.tabs.addTab(self.inside, "What is in it")
        self.tabs.addTab(self.compared, "Compared with the controller")
        self.buttons = {text: self._button(text, words) for text, words in BUTTONS.items()}
        self.shut = QPushButton("Close")
        self.shut.setAutoDefault(False)
        self.shut.clicked.connect(self.accept)
        self.doing, self.bar, self.cancel = QLabel(), QProgressBar(), QPushButton("Cancel")
        self.bar.setRange(0, 1000)
        self.bar.setAccessibleName("Progress")
        self.bar.setFixedWidth(200)
        self.cancel.setAutoDefault(False)
        self.cancel.clicked.connect(self.cancelled)
        self._lay_out()
        self.show_work("", 0.0, can_cancel=False)
        self.resize(960, 640)

    # ---- what is shown

    def show_controller(self, who: str) -> None:
        """Which controller's back-ups these are."""
        set_text(self.who, who)

    def show_list(self, rows: Sequence[Sequence[str]], current: int = 0) -> None:
        """When, why and note of each, newest first."""
        self.list.blockSignals(True)
        self.list.clear()
        for texts in rows:
            item = QTreeWidgetItem(list(texts))
            for column, text in enumerate(texts):
                item.setSizeHint(column, QSize(self.list.fontMetrics().horizontalAdvance(text) + GAP, HEIGHT))
            item.setToolTip(2, texts[2])
            self.list.addTopLevelItem(item)
        if rows:
            self.list.setCurrentItem(self.list.topLevelItem(min(current, len(rows) - 1)))
        self.list.blockSignals(False)
        if not rows:
            self.show_parts([], EMPTY)

    def show_parts(self, parts: Parts, words: str = "") -> None:
        """What is in the chosen one, part by part; or why there is nothing to see."""
        self.inside.setHtml(_html(parts) if parts else f"<p>{escape(words)}</p>")

    def show_fit(self, words: str, problem: bool = False) -> None:
        """Whether the chosen one fits the controller that is connected."""
        set_text(self.fit, words)
        self.fit.setProperty("role", "warning" if problem else "quiet")
        self.fit.style().unpolish(self.fit)
        self.fit.style().polish(self.fit)

    def show_compared(self, words: str, items: Sequence[str] = ()) -> None:
        """How controller and back-up differ, one line each; comes to the front when there is anything to say."""
        listed = "".join(f"<li>{escape(each)}</li>" for each in items)
        self.compared.setHtml(f"<p>{escape(words)}</p>" + (f"<ul>{listed}</ul>" if listed else ""))
        self.tabs.setCurrentWidget(self.compared if words else self.inside)

    def show_reasons(self, reasons: dict[str, str]) -> None:
        """Which buttons are grey, and why."""
        for text, button in self.buttons.items():
            reason = reasons.get(text, "")
            button.setEnabled(not reason)
            button.setToolTip(f"{BUTTONS[text]}\n{reason}" if reason else BUTTONS[text])

    def show_work(self, doing: str, fraction: float, can_cancel: bool = True) -> None:
        """What is under way; nothing when `doing` is empty."""
        for widget in (self.doing, self.bar, self.cancel):
            widget.setVisible(bool(doing) and (can_cancel or widget is self.doing))
        set_text(self.doing, doing)
        self.bar.setValue(round(fraction * 1000))

    @property
    def row(self) -> int:
        """The chosen row; -1 when there is none."""
        return self.list.indexOfTopLevelItem(self.list.currentItem()) if self.list.currentItem() else -1

    # ---- how it is made

    def _make_list(self) -> QTreeWidget:
        made = QTreeWidget()
        made.setAccessibleName("Back-ups, newest first")
        made.setHeaderLabels(list(COLUMNS))
        made.setRootIsDecorated(False)
        made.setUniformRowHeights(True)
        made.setTabKeyNavigation(False)
        made.header().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        made.currentItemChanged.connect(lambda *_: self.chosen.emit(self.row))
        return made

    def _button(self, text: str, words: str) -> QPushButton:
        button = QPushButton(text)
        button.setMinimumHeight(look().control)
        button.setAutoDefault(False)
        button.setToolTip(words)
        button.setAccessibleDescription(words)
        button.clicked.connect(lambda: self.pressed.emit(text))
        return button

    def _lay_out(self) -> None:
        left = QWidget()
        column = _column(left, 0)
        column.setContentsMargins(0, 0, 8, 0)
        first = QHBoxLayout()
        first.addWidget(self.note, 1)
        first.addWidget(self.buttons["Back up now"])
        column.addLayout(first)
        column.addWidget(self.list, 1)
        below = QHBoxLayout()
        below.addWidget(self.buttons["Open file…"])
        below.addWidget(self.buttons["Save a copy…"])
        below.addStretch(1)
        column.addLayout(below)
        right = QWidget()
        column = _column(right, 0)
        column.setContentsMargins(8, 0, 0, 0)
        column.addWidget(self.fit)
        column.addWidget(self.tabs, 1)
        acts = QHBoxLayout()
        acts.addStretch(1)
        for text in ("Compare", "Restore…"):
            acts.addWidget(self.buttons[text])
        column.addLayout(acts)
        halves = QSplitter(Qt.Orientation.Horizontal)
        halves.setChildrenCollapsible(False)
        halves.addWidget(left)
        halves.addWidget(right)
        halves.setSizes([460, 480])
        row = QHBoxLayout()
        row.addWidget(self.buttons["Replace controller…"])
        for widget in (self.doing, self.bar, self.cancel):
            row.addWidget(widget)
        row.addStretch(1)
        row.addWidget(foot(away=self.shut))
        column = _column(self, 16)
        column.addWidget(self.who)
        column.addWidget(halves, 1)
        column.addLayout(row)


def _column(widget: QWidget, margin: int) -> QVBoxLayout:
    column = QVBoxLayout(widget)
    column.setContentsMargins(margin, margin, margin, margin)
    column.setSpacing(12)
    return column


def _page(name: str) -> QTextBrowser:
    page = QTextBrowser()
    page.setAccessibleName(name)
    page.setOpenLinks(False)
    page.setTabChangesFocus(True)
    return page


def _html(parts: Parts) -> str:
    code: Any = look().code_font().family()
    found = []
    for title, lines, is_code in parts:
        found.append(f"<h3>{escape(title)}</h3>")
        if is_code:
            found.append(f"<pre style='font-family: \"{code}\"'>{escape(chr(10).join(lines))}</pre>")
        else:
            found.append("".join(f"<p style='margin: 2px 0'>{escape(line)}</p>" for line in lines))
    return "".join(found)
