"""The captures of this session and those that were opened: one is shown, any lie over it."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QListWidget, QListWidgetItem, QPushButton, QVBoxLayout, QWidget

from device.capture import Capture, facts
from widgets.panel import set_text

MOST = 100  # captures that are kept in memory; the oldest goes
MOST_VALUES = 8_000_000  # of all of them
WORDS = "A tick lays a capture over the one that is shown."


class Kept(QWidget):
    """The list, newest first."""

    changed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.list, self.about, self.remove = QListWidget(), QLabel(WORDS), QPushButton("Remove")
        self.list.setAccessibleName("Captures")
        self.list.setToolTip(WORDS)
        self.list.setWordWrap(True)
        self.list.setSpacing(2)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.remove.setAccessibleName("Remove capture from the list")
        self.remove.setToolTip("Takes it out of this list; files stay")
        self.about.setWordWrap(True)
        self.about.setProperty("role", "quiet")
        self.about.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._captures: dict[int, Capture] = {}
        self._next = 0
        foot = QHBoxLayout()
        foot.addStretch(1)
        foot.addWidget(self.remove)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 4, 0, 0)
        column.addWidget(self.list, 1)
        column.addWidget(self.about)
        column.addLayout(foot)
        self.list.currentItemChanged.connect(self._chosen)
        self.list.itemChanged.connect(lambda: self.changed.emit())
        self.remove.clicked.connect(self._remove)
        self._chosen()

    @property
    def current(self) -> Capture | None:
        item = self.list.currentItem()
        return self._captures[item.data(Qt.ItemDataRole.UserRole)] if item is not None else None

    @property
    def overlaid(self) -> list[Capture]:
        """Those with a tick."""
        items = [self.list.item(row) for row in range(self.list.count())]
        ticked = [item for item in items if item.checkState() is Qt.CheckState.Checked]
        return [self._captures[item.data(Qt.ItemDataRole.UserRole)] for item in ticked]

    def add(self, capture: Capture, name: str = "", show: bool = True) -> None:
        """On top; a file goes by its name, others by their time."""
        self._next += 1
        self._captures[self._next] = capture
        channels = ", ".join(channel.label for channel in capture.channels)
        part = "" if capture.complete else " (part)"
        item = QListWidgetItem(f"{name or capture.when[11:] or 'Capture'}{part}\n{channels}")
        item.setData(Qt.ItemDataRole.UserRole, self._next)
        item.setFlags(item.flags() | Qt.ItemFlag.ItemIsUserCheckable)
        item.setCheckState(Qt.CheckState.Unchecked)
        self.list.blockSignals(True)
        self.list.insertItem(0, item)
        if show:
            self.list.setCurrentItem(item)
        while self.list.count() > MOST or (self.list.count() > 1 and self._size > MOST_VALUES):
            gone = self.list.takeItem(self.list.count() - 1)
            self._captures.pop(gone.data(Qt.ItemDataRole.UserRole))
        self.list.blockSignals(False)
        self._tell()

    @property
    def _size(self) -> int:
        """Values of all of them."""
        return sum(capture.values.size for capture in self._captures.values())

    def _chosen(self, *_: object) -> None:
        self._tell()
        self.changed.emit()

    def _tell(self) -> None:
        capture = self.current
        told = facts(capture) if capture is not None else {}
        lines = [f"{name}: {words}" for name, words in told.items() if words]
        set_text(self.about, "\n".join(lines) or WORDS)
        self.remove.setEnabled(capture is not None)

    def _remove(self) -> None:
        row = self.list.currentRow()
        if row >= 0:
            gone = self.list.takeItem(row)
            self._captures.pop(gone.data(Qt.ItemDataRole.UserRole))
            self._chosen()
