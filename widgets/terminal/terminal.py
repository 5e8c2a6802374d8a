"""The terminal: typed commands, their replies, the reason behind a `?`, and what the program says unasked."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QShowEvent, QTextCharFormat, QTextCursor, QTextFormat
from PySide6.QtWidgets import QCheckBox, QLabel, QPlainTextEdit, QPushButton, QVBoxLayout, QWidget

from device.api import Kind, NoticeKind
from widgets.panel import Panel, set_text, show_role
from widgets.parts.files import LOGS, ask_save
from widgets.parts.look import look
from widgets.parts.wrapping import WrappingRow
from widgets.terminal.command_line import CommandLine
from widgets.terminal.diary import Diary

if TYPE_CHECKING:
    from device.api import Controller, Notice, Reply, Row, Traffic

MOST_LINES = 5000
TOKEN = int(QTextFormat.Property.UserProperty) + 1  # of a line: the name of its colour
LEAST = 150  # px of the line that is typed into
# what a line is: (colour token, sign before it)
STYLES = {
    "typed": ("accent", "› "),
    "reply": ("text", "  "),
    "refused": ("fault", "? "),
    "said": ("group_math", "« "),
    "poll": ("quiet", "· "),
    "note": ("quiet", "  "),
}
CLEARING = ("\x1b[2J\x1b[H", "\x1b[2J", "\x1bE", "\x0c")  # of an ANSI terminal, of a TERM-1500, of a printer
WATCHING = "Watch sends what only reads (TP, MG _TPX, KP ?); for the rest: Control, Ctrl+T."


class TerminalPanel(Panel):
    """Commands go up as `command`; the owner answers with `show_reply`."""

    title = "Terminal"
    moves = True
    command = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._seen = 0
        self._known: tuple[object, ...] = ()
        self.diary = Diary()
        self.log, self.line = QPlainTextEdit(), CommandLine()
        self.send, self.clear = QPushButton("Send"), QPushButton("Clear")
        self.keep = QPushButton("Log to file…")
        self.traffic = QCheckBox("Show live reads")
        self.traffic.setProperty("role", "field")
        self.why, self.help = QLabel(), QLabel()
        self._lay_out()
        self.line.typed.connect(self._typed)
        self.line.help_changed.connect(self._show_help)
        self.send.clicked.connect(self.line.send)
        self.clear.clicked.connect(self.log.clear)
        self.keep.clicked.connect(self._keep)
        self._dressed = look().colour("text")
        self._at_end = True  # nobody has scrolled up to read
        bar = self.log.verticalScrollBar()
        bar.rangeChanged.connect(lambda _, most: bar.setValue(most) if self._at_end else None)
        bar.valueChanged.connect(self._scrolled)
        self._allow("Connect a controller or start the simulator first.")

    def take(self, controller: Controller) -> None:
        super().take(controller)
        self._seen = 0

    def refresh(self, row: Row) -> None:
        controller = self.controller
        if controller is None:
            return
        self._allow(why_not(controller), not controller.control)
        known = (controller.model, controller.listing)
        if known != self._known:
            self._known = known
            if controller.model is not None:
                from codegen.twoletter.complete import names_of
                from codegen.twoletter.parse import parse

                names = names_of(parse(controller.listing or "").lines, controller.model)
                self.line.show_names(controller.model, names)
        if self.traffic.isChecked():
            for entry in controller.traffic(self._seen):
                self._seen = entry.number
                self._show_traffic(entry)

    def notice(self, notice: Notice) -> None:
        if notice.kind is NoticeKind.MESSAGE:
            self._said(notice.text)
        elif notice.kind is NoticeKind.FAULT:
            self.write("refused", notice.text)
        elif notice.kind in (NoticeKind.IDENTIFIED, NoticeKind.LOST, NoticeKind.CONNECTED, NoticeKind.UNCLEAR):
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
        self.diary.add(sign.strip() or "=", text.rstrip("\r\n"))
        shape = QTextCharFormat()
        shape.setForeground(look().colour(token))
        shape.setProperty(TOKEN, token)
        cursor = self.log.textCursor()
        cursor.movePosition(QTextCursor.MoveOperation.End)
        if not self.log.document().isEmpty():
            cursor.insertBlock()
        cursor.insertText(sign + text.rstrip("\r\n"), shape)
        if self._at_end:
            self._show_end()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.StyleChange, QEvent.Type.PaletteChange) and hasattr(self, "_dressed"):
            self._dress()

    def _dress(self) -> None:
        """What stands there already takes the colours of the theme as it is now."""
        if self._dressed == look().colour("text"):
            return
        self._dressed = look().colour("text")
        cursor = QTextCursor(self.log.document())
        block = self.log.document().firstBlock()
        while block.isValid():
            cursor.setPosition(block.position())
            cursor.movePosition(QTextCursor.MoveOperation.EndOfBlock, QTextCursor.MoveMode.KeepAnchor)
            shape = QTextCharFormat()
            shape.setForeground(look().colour(cursor.charFormat().stringProperty(TOKEN) or "text"))
            cursor.mergeCharFormat(shape)
            block = block.next()

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

    def _said(self, text: str) -> None:
        """What the program says; a command to clear the screen clears it (ssc-tol-o-motion.txt, Clear Screen)."""
        for code in CLEARING:
            if code in text:
                self.log.clear()
                text = text.rpartition(code)[2]
        if text.strip():
            self.write("said", text)

    def _typed(self, text: str) -> None:
        if self.line.isEnabled():
            self.write("typed", text)
            self.command.emit(text)

    def _show_help(self, words: str) -> None:
        set_text(self.help, words)
        self.help.setVisible(bool(words))

    def _keep(self) -> None:
        """Begins the log, or ends it."""
        if self.diary.open:
            self.diary.end()
            self._show_keeping()
        else:
            proposed = Path.home() / "terminal.log"
            ask_save(self.window(), "Log to file", LOGS, self.keep_in, proposed, "log")

    def keep_in(self, path: Path) -> None:
        """Every line goes into this file as well, from now on."""
        self.diary.begin(path)
        self._show_keeping()

    def _show_keeping(self) -> None:
        self.keep.setText("End log" if self.diary.open else "Log to file…")
        self.keep.setToolTip(f"Writing {self.diary.path}" if self.diary.open else "")
        if self.diary.problem:
            self.write("note", self.diary.problem)

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
        if entry.source in ("poll", "stop", "download", "unclear"):
            self.write("poll", f"{entry.direction} {entry.text.strip()}")

    def _lay_out(self) -> None:
        self.log.setReadOnly(True)
        self.log.setMaximumBlockCount(MOST_LINES)
        self.log.setAccessibleName("Terminal log")
        self.log.setFont(look().code_font())
        self.log.setPlaceholderText("Replies and program messages appear here.")
        self.line.setFont(look().code_font())
        self.line.setAccessibleName("Command")
        self.line.setPlaceholderText("For example TP")
        self.send.setProperty("role", "primary")
        self.why.setWordWrap(True)
        self.log.setMinimumHeight(48)
        self.line.setMinimumWidth(LEAST)
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 0, 8, 4)
        column.setSpacing(4)
        column.addWidget(self.log, 1)
        column.addWidget(self.why)
        self.help.setTextFormat(Qt.TextFormat.RichText)
        self.help.setWordWrap(True)
        self.help.setProperty("role", "quiet")
        self.help.hide()
        column.addWidget(self.help)
        column.addLayout(WrappingRow(self.line, self.send, self.traffic, self.keep, self.clear))


def why_not(controller: Controller) -> str:
    """Why nothing can be typed now; empty when it can."""
    if controller.kind is Kind.OFFLINE:
        return "Connect a controller or start the simulator first."
    if controller.pending_prompt is not None:
        return "The program waits: the next line would be its answer. Use the answer box."
    return ""
