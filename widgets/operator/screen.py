"""The display of the terminal: four rows of twenty characters and a cursor."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QFontMetricsF, QHideEvent, QKeyEvent, QPainter, QPaintEvent, QPen, QShowEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from device.terminal1500 import COLUMNS, ROWS, Terminal
from widgets.parts.look import look

EDGE = 12  # px around the characters
POINTS = 16.0
BLINK_MS = 500
NAMED = {Qt.Key.Key_Return: "ENTER", Qt.Key.Key_Enter: "ENTER", Qt.Key.Key_Backspace: "BKSPC", Qt.Key.Key_Escape: "ESC"}


class Screen(QWidget):
    """Paints a terminal; `refresh` when it may have changed. Says what is typed while it has the focus."""

    named = Signal(str)  # a key by its name
    typed = Signal(str)  # a character

    def __init__(self, terminal: Terminal, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.terminal = terminal
        self._shown: tuple[object, ...] = ()
        self._lit = True
        self._blink = QTimer(self, interval=BLINK_MS)
        self._blink.timeout.connect(self._turn)
        self.setAccessibleName("Display of the operator terminal")
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)

    def event(self, event: QEvent) -> bool:
        """F1 to F5 are taken before the shortcuts of the window: Shift+F5 would halt the program."""
        if event.type() is QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent) and _function_key(event):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Shift+F1 to Shift+F5 are F1 to F5, because F1 is help."""
        key, text, held = Qt.Key(event.key()), event.text(), event.modifiers()
        if name := _function_key(event):
            self.named.emit(name)
        elif NAMED.get(key) in self.terminal.by_name:
            self.named.emit(NAMED[key])
        elif len(text) == 1 and not held & Qt.KeyboardModifier.ControlModifier:
            self.typed.emit(text.upper())
        else:
            super().keyPressEvent(event)

    def refresh(self) -> None:
        """Paints again when something has changed."""
        at = self.terminal
        now = (at.lines, at.row, at.column, at.underscore, at.blinking)
        if now != self._shown:
            self._shown = now
            self.setAccessibleDescription("\n".join(line.rstrip() for line in at.lines).strip() or "empty")
            self.update()

    def sizeHint(self) -> QSize:
        cell = self._cell()
        return QSize(round(COLUMNS * cell.width()) + 2 * EDGE, round(ROWS * cell.height()) + 2 * EDGE)

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def _cell(self) -> QRectF:
        metrics = QFontMetricsF(look().code_font(POINTS))
        return QRectF(0, 0, metrics.horizontalAdvance("0") + 2, metrics.height() + 2)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(look().colour("border"), 1))
        painter.setBrush(look().colour("sunken"))
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5), 4, 4)
        cell, font = self._cell(), look().code_font(POINTS)
        left = (self.width() - COLUMNS * cell.width()) / 2
        painter.setFont(font)
        painter.setPen(look().colour("text"))
        base = QFontMetricsF(font).ascent() + 1
        for row, line in enumerate(self.terminal.lines):
            for column, character in enumerate(line):
                if character != " ":
                    place = QPointF(left + column * cell.width() + 1, EDGE + row * cell.height() + base)
                    painter.drawText(place, character)
        at = cell.translated(left + self.terminal.column * cell.width(), EDGE + self.terminal.row * cell.height())
        if self.terminal.blinking and self._lit:
            painter.fillRect(at, look().colour("quiet"))
        if self.terminal.underscore:
            painter.fillRect(QRectF(at.left() + 1, at.bottom() - 2, at.width() - 2, 2), look().colour("text"))

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._blink.start()

    def hideEvent(self, event: QHideEvent) -> None:
        super().hideEvent(event)
        self._blink.stop()

    def _turn(self) -> None:
        self._lit = not self._lit
        if self.terminal.blinking:
            self.update()


def _function_key(event: QKeyEvent) -> str:
    """F1 to F5 of the terminal, or nothing."""
    key = Qt.Key(event.key())
    if event.modifiers() & Qt.KeyboardModifier.ShiftModifier and Qt.Key.Key_F1 <= key <= Qt.Key.Key_F5:
        return f"F{key - Qt.Key.Key_F1 + 1}"
    return ""
