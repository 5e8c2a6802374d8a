"""A picture of the switches on the controller's front for a baud rate (Tol-O-Motion manual, chapter 5, l.1518-1526)."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from widgets.connect.rates import RATES
from widgets.parts.look import look

NAMES = ("MRST", "1200", "9600", "19.2K", "HSHK")


class DipSwitches(QWidget):
    """Five switches, the three of the baud rate set; HSHK on when RTS/CTS is used."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._rate = 9600
        self._handshake = True
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self.show_setting(9600, True)

    def show_setting(self, rate: int, handshake: bool) -> None:
        """What the switches must be set to."""
        self._rate, self._handshake = rate, handshake
        self.setAccessibleName(self.words())
        self.update()

    def positions(self) -> tuple[bool, ...]:
        """On or off, switch 1 to 5; the first (master reset) is always off."""
        return (False, *RATES[self._rate], self._handshake)

    def words(self) -> str:
        """The picture in words."""
        each = (f"{name} {'ON' if on else 'OFF'}" for name, on in zip(NAMES[1:], self.positions()[1:], strict=True))
        return f"Switches on the controller for {self._rate} baud: {', '.join(each)}"

    def sizeHint(self) -> QSize:
        return QSize(304, 128)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        box = QRectF(self.rect()).adjusted(1, 1, -1, -1)
        painter.setPen(QPen(look().colour("border"), 1))
        painter.setBrush(look().colour("raised"))
        painter.drawRoundedRect(box, 6, 6)
        for index, on in enumerate(self.positions()):
            self._paint_switch(painter, 16 + index * 56, index, on)

    def _paint_switch(self, painter: QPainter, left: float, index: int, on: bool) -> None:
        named = 1 <= index <= 3
        painter.setFont(look().small_font())
        painter.setPen(look().colour("quiet"))
        centre = Qt.AlignmentFlag.AlignCenter
        painter.drawText(QRectF(left - 8, 8, 56, 18), centre, NAMES[index])
        slot = QRectF(left + 8, 30, 24, 54)
        painter.setPen(QPen(look().colour("border"), 1.2))
        painter.setBrush(look().colour("sunken"))
        painter.drawRoundedRect(slot, 3, 3)
        knob = QRectF(slot.left() + 3, slot.top() + 3 if on else slot.bottom() - 25, 18, 22)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(look().colour("accent" if on else "border"))
        painter.drawRoundedRect(knob, 2, 2)
        font = look().body_font()
        font.setBold(on and named)
        painter.setFont(font)
        painter.setPen(look().colour("text" if named or on else "quiet"))
        painter.drawText(QRectF(left - 8, 88, 56, 20), centre, "ON" if on else "OFF")
        painter.setFont(look().small_font())
        painter.setPen(look().colour("quiet"))
        painter.drawText(QPointF(left + 17, 119), str(index + 1))
