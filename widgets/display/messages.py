"""What happened, newest last: program messages, faults, connections, in words and with their time."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import QHBoxLayout, QLabel, QListWidget, QListWidgetItem, QPushButton, QVBoxLayout, QWidget

from device.api import NoticeKind
from widgets.panel import Panel
from widgets.parts.icons import icon

if TYPE_CHECKING:
    from device.api import Notice

MOST = 2000
ICONS = {
    NoticeKind.MESSAGE: ("messages", "text"),
    NoticeKind.UNCLEAR: ("messages", "warning"),
    NoticeKind.PROMPT: ("comment", "accent"),
    NoticeKind.FAULT: ("problem", "fault"),
    NoticeKind.LOST: ("disconnect", "fault"),
    NoticeKind.RESTARTED: ("refresh", "warning"),
    NoticeKind.STOP: ("stop", "stop"),
}
EMPTY = "Nothing has happened yet. Messages of the program, faults and connections appear here."


class MessagesPanel(Panel):
    """A list that keeps the last two thousand lines."""

    title = "Messages"
    count_changed = Signal(int)

    def __init__(self, parent: QWidget | None = None, wall: Callable[[], time.struct_time] = time.localtime) -> None:
        super().__init__(parent)
        self._wall = wall
        self.list = QListWidget()
        self.list.setAccessibleName("Messages")
        self.list.setIconSize(QSize(16, 16))
        self.list.setWordWrap(True)
        self.list.setUniformItemSizes(False)
        self.empty = QLabel(EMPTY)
        self.empty.setProperty("role", "quiet")
        self.clear = QPushButton("Clear")
        self.clear.setToolTip("Empties this list")
        self.clear.clicked.connect(self._clear)
        row = QHBoxLayout()
        self.empty.setWordWrap(True)
        row.addWidget(self.empty, 1)
        row.addStretch(0)
        row.addWidget(self.clear)
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 4, 8, 8)
        column.setSpacing(4)
        column.addLayout(row)
        column.addWidget(self.list)
        self._count()

    def notice(self, notice: Notice) -> None:
        name, token = ICONS.get(notice.kind, ("info", "quiet"))
        self.say(notice.text, icon(name, token))

    def say(self, text: str, picture: QIcon | None = None) -> None:
        """Adds a line with the time of day; an equal line just before is counted instead of repeated."""
        text = text.strip()
        if not text:
            return
        last = self.list.item(self.list.count() - 1) if self.list.count() else None
        if last is not None and last.data(Qt.ItemDataRole.UserRole) == text:
            times = int(last.data(Qt.ItemDataRole.UserRole + 1)) + 1
            last.setData(Qt.ItemDataRole.UserRole + 1, times)
            last.setText(f"{self._clock_text()}   {text}   ({times} times)")
            return
        item = QListWidgetItem(f"{self._clock_text()}   {text}")
        item.setIcon(picture if picture is not None else icon("info", "quiet"))
        item.setData(Qt.ItemDataRole.UserRole, text)
        item.setData(Qt.ItemDataRole.UserRole + 1, 1)
        at_end = self.list.verticalScrollBar().value() >= self.list.verticalScrollBar().maximum() - 4
        self.list.addItem(item)
        if self.list.count() > MOST:
            self.list.takeItem(0)
        if at_end:
            self.list.scrollToBottom()
        self._count()

    def texts(self) -> list[str]:
        """The lines without their times."""
        return [str(self.list.item(row).data(Qt.ItemDataRole.UserRole)) for row in range(self.list.count())]

    def _clock_text(self) -> str:
        return time.strftime("%H:%M:%S", self._wall())

    def _clear(self) -> None:
        self.list.clear()
        self._count()

    def _count(self) -> None:
        self.empty.setVisible(self.list.count() == 0)
        self.clear.setEnabled(self.list.count() > 0)
        self.count_changed.emit(self.list.count())
