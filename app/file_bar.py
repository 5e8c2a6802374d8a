"""A bar above the program while its file is not as it was: changed or removed by another program."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import QFrame, QGridLayout, QHBoxLayout, QLabel, QPushButton, QWidget

from app.disk import Disk
from widgets.panel import set_text
from widgets.parts.icons import icon

WORDS = {
    Disk.CHANGED: "{name} was changed by another program. Saving would overwrite that.",
    Disk.GONE: "{name} is not there any more, or cannot be read: another program moved, renamed or deleted it.",
}
UNSAVED = " Reload brings the file; your own changes stay within reach of Undo."


class FileBar(QFrame):
    """Hidden while the file is as it was; every button goes up as a signal."""

    reload = Signal()
    compare = Signal()
    save_as = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setProperty("role", "card")
        self.setAccessibleName("The file on disk")
        drawing, self.text = QLabel(), QLabel()
        drawing.setPixmap(icon("warning", "warning").pixmap(QSize(20, 20), self.devicePixelRatioF()))
        self.text.setWordWrap(True)
        buttons = {
            "Reload": ("Opens the file as it is now", self.reload),
            "Compare": ("Shows the code of both, line by line", self.compare),
            "Save as…": ("Saves what is open here under another name", self.save_as),
            "Keep mine": ("Goes on with what is open here; Save asks before it overwrites the file", None),
        }
        row = QHBoxLayout()
        row.setSpacing(8)
        row.addStretch(1)
        grid = QGridLayout(self)
        grid.setContentsMargins(12, 8, 12, 8)
        grid.setHorizontalSpacing(12)
        grid.setColumnStretch(1, 1)
        grid.addWidget(drawing, 0, 0, Qt.AlignmentFlag.AlignTop)
        grid.addWidget(self.text, 0, 1)
        grid.addLayout(row, 1, 0, 1, 2)
        self.buttons: dict[str, QPushButton] = {}
        for words, (help_text, signal) in buttons.items():
            button = self.buttons[words] = QPushButton(words)
            button.setToolTip(help_text)
            button.clicked.connect(self.hide if signal is None else signal)
            row.addWidget(button)
        self.hide()

    def show_disk(self, disk: Disk, name: str, unsaved: bool) -> None:
        """How the file stands; the bar goes when it is as it was."""
        if disk is not Disk.SAME:
            set_text(self.text, WORDS[disk].format(name=name) + UNSAVED * (unsaved and disk is Disk.CHANGED))
            for words in ("Reload", "Compare"):
                self.buttons[words].setVisible(disk is Disk.CHANGED)
        self.setVisible(disk is not Disk.SAME)
