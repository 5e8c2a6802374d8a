"""A simple terminal: typed commands, their replies, the reason behind a `?`, and what the program says unasked."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QKeyEvent, QShowEvent, QTextCharFormat, QTextCursor
from PySide6.QtWidgets import (
    QCheckBox,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPlainTextEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from device.api import Kind, NoticeKind
from widgets.panel import Panel, set_text, show_role
from widgets.parts.look import look

if TYPE_CHECKING:
    from device.api import Controller, Notice, Reply, Row, Traffic

MOST_LINES = 5000
# what a line is: (colour token, sign before it)
STYLES = {
    "typed": ("accent", "› "),
    "reply": ("text", "  "),
    "refused": ("fault", "? "),
    "said": ("group_math", "« "),
    "poll": ("quiet", "· "),
    "note": ("quiet", "  "),
}
WATCHING = "Watch sends what only reads (TP, MG _TPX, KP ?); for the rest: Control, Ctrl+T."


class TerminalPanel(Panel):
    """Commands go up as `command`; the owner answers with `show_reply`."""

    title = "Terminal"
    moves = True
    command = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._typed: list[str] = []
        self._at = 0
        self._seen = 0
        self.log, self.line = QPlainTextEdit(), QLineEdit()
        self.send, self.clear = QPushButton("Send"), QPushButton("Clear")
        self.traffic = QCheckBox("Show live reads")
        self.traffic.setProperty("role", "field")
        self.why = QLabel()
        self._lay_out()
        self.line.returnPressed.connect(self._send)
        self.send.clicked.connect(self._send)
        self.clear.clicked.connect(self.log.clear)
        self.line.installEventFilter(self)
        self._at_end = True  # nobody has scrolled up to read
        bar = self.log.verticalScrollBar()
        bar.rangeChanged.connect(lambda _, most: bar.setValue(most) if self._at_end else None)
        bar.valueChanged.connect(self._scrolled)
        self._allow("Connect a controller or start the simulator first.")

    def attach(self, controller: Controller) -> None:
        super().attach(controller)
        self._seen = 0

    def refresh(self, row: Row) -> None:
        controller = self.controller
        if controller is None:
            return
        self._allow(why_not(controller), not controller.control)
        if self.traffic.isChecked():
            for entry in controller.traffic(self._seen):
                self._seen = entry.number
                self._show_traffic(entry)

    def notice(self, notice: Notice) -> None:
        if notice.kind is NoticeKind.MESSAGE:
            self.write("said", notice.text)
        elif notice.kind is NoticeKind.FAULT:
            self.write("refused", notice.text)
        elif notice.kind in (NoticeKind.IDENTIFIED, NoticeKind.LOST, NoticeKind.CONNECTED):
            self.write("note", f"— {notice.text} —")

    def show_reply(self, command: str, reply: Reply) -> None:
        """What the controller answered to a typed command."""
        if reply.accepted:
            for text in reply.text.splitlines() or ["accepted"]:
                self.write("reply" if reply.text else "note", text)
        else:
            self.write("refused", reply.reason or f"{command}: refused")
        if not reply.certain:
            self.write("note", "(the reply is uncertain: the program was talking at the same moment)")

    def show_failure(self, command: str, sentence: str) -> None:
        """Why a command got no answer."""
        self.write("refused", f"{command}: {sentence}")

    def write(self, style: str, text: str) -> None:
        """Adds a line in the colour and with the sign of its style."""
        token, sign = STYLES[style]
        shape = QTextCharFormat()
        shape.setForeground(look().colour(token))
        cursor = self.log.textCursor()
        cursor.movePosition(QTextCursor.MoveOperation.End)
        if not self.log.document().isEmpty():
            cursor.insertBlock()
        cursor.insertText(sign + text.rstrip("\r\n"), shape)
        if self._at_end:
            self._show_end()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._show_end()

    def _scrolled(self, value: int) -> None:
        self._at_end = value >= self.log.verticalScrollBar().maximum() - 1 or not self.isVisible()

    def _show_end(self) -> None:
        """The newest lines."""
        self._at_end = True
        bar = self.log.verticalScrollBar()
        bar.setValue(bar.maximum())

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Up and down bring back earlier lines."""
        if watched is self.line and isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            step = {Qt.Key.Key_Up: -1, Qt.Key.Key_Down: 1}.get(Qt.Key(event.key()))
            if step is not None and self._typed:
                self._at = min(max(0, self._at + step), len(self._typed))
                self.line.setText(self._typed[self._at] if self._at < len(self._typed) else "")
                return True
        return super().eventFilter(watched, event)

    def _send(self) -> None:
        text = self.line.text().strip()
        if not text or not self.line.isEnabled():
            return
        if not self._typed or self._typed[-1] != text:
            self._typed.append(text)
        self._at = len(self._typed)
        self.line.clear()
        self.write("typed", text)
        self.command.emit(text)

    def _allow(self, reason: str, watching: bool = False) -> None:
        """`watching`: what only reads may be typed; the controller's door decides what that is."""
        self.line.setEnabled(not reason)
        self.send.setEnabled(not reason)
        self.send.setToolTip(reason or "Sends the line (Enter)")
        words = reason or (WATCHING if watching else "")
        set_text(self.why, words)
        show_role(self.why, "warning" if reason else "quiet")
        self.why.setVisible(bool(words))

    def _show_traffic(self, entry: Traffic) -> None:
        if entry.source in ("poll", "stop", "download"):
            self.write("poll", f"{entry.direction} {entry.text.strip()}")

    def _lay_out(self) -> None:
        self.log.setReadOnly(True)
        self.log.setMaximumBlockCount(MOST_LINES)
        self.log.setAccessibleName("Terminal log")
        self.log.setFont(look().code_font())
        self.log.setPlaceholderText("Replies and program messages appear here.")
        self.line.setFont(look().code_font())
        self.line.setAccessibleName("Command")
        self.line.setPlaceholderText("Two-letter command, for example TP or MG _TPX")
        self.send.setProperty("role", "primary")
        self.why.setWordWrap(True)
        self.log.setMinimumHeight(48)
        foot, column = QHBoxLayout(), QVBoxLayout(self)
        foot.setSpacing(8)
        foot.addWidget(self.line, 1)
        for widget in (self.send, self.traffic, self.clear):
            foot.addWidget(widget)
        column.setContentsMargins(8, 0, 8, 4)
        column.setSpacing(4)
        column.addWidget(self.log, 1)
        column.addWidget(self.why)
        column.addLayout(foot)


def why_not(controller: Controller) -> str:
    """Why nothing can be typed now; empty when it can."""
    if controller.kind is Kind.OFFLINE:
        return "Connect a controller or start the simulator first."
    if controller.pending_prompt is not None:
        return "The program waits: the next line would be its answer. Use the answer box."
    return ""
