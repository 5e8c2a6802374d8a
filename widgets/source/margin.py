"""The margin of the code: line numbers as the controller counts them, arrows of running threads, problem marks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

from widgets.parts.look import look

if TYPE_CHECKING:
    from widgets.source.view import CodeView

RIGHT = (Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter).value


class Margin(QWidget):
    """Painted beside the text; the code view tells it how wide to be."""

    def __init__(self, code: CodeView) -> None:
        super().__init__(code)
        self.code = code
        self._colours: dict[str, QColor] = {}
        self._threads: set[int] = set()
        self.setAccessibleName("Line numbers")

    def sizeHint(self) -> QSize:
        """As wide as the code view reserves."""
        return QSize(self.code.margin_width(), 0)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paints numbers and marks of the visible lines."""
        painter = QPainter(self)
        now = look()
        self._colours = {token: now.colour(token) for token in ("text", "warning", "quiet", "executing")}
        painter.fillRect(event.rect(), now.colour("sunken"))
        painter.setFont(self.code.font())
        self._threads = set(self.code.executing.values())
        for number, top, height in self.code.visible_lines():
            if top + height < event.rect().top():
                continue
            if top > event.rect().bottom():
                break
            self._line(painter, number, top, height)

    def _line(self, painter: QPainter, number: int, top: float, height: float) -> None:
        threads = number in self._threads
        problem = number in self.code.problem_lines
        token = "text" if threads else "warning" if problem else "quiet"
        if threads:
            painter.fillRect(QRectF(0, top, self.width(), height), self._colours["executing"])
        painter.setPen(self._colours[token])
        box = QRectF(0, top, self.width() - 8, height)
        painter.drawText(box, RIGHT, str(number))
        mark = "►" if threads else "!" if problem else ""
        if mark:
            painter.drawText(QRectF(4, top, 16, height), Qt.AlignmentFlag.AlignCenter, mark)
