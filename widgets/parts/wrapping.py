"""A row of controls that goes on in a further line where it has no room."""

from __future__ import annotations

from PySide6.QtCore import QRect, QSize, Qt
from PySide6.QtWidgets import QLayout, QLayoutItem, QWidget

SPACE = 8  # px between controls and between lines
ACROSS = Qt.Orientation.Horizontal


class WrappingRow(QLayout):
    """Left to right; what may grow takes the rest of its line."""

    def __init__(self, *widgets: QWidget) -> None:
        super().__init__()
        self._items: list[QLayoutItem] = []
        self._heights: dict[int, int] = {}  # by width: asked for again and again while a window is laid out
        self.setSpacing(SPACE)
        for widget in widgets:
            self.addWidget(widget)

    def addItem(self, item: QLayoutItem) -> None:
        self._items.append(item)

    def count(self) -> int:
        return len(self._items)

    def itemAt(self, index: int) -> QLayoutItem | None:  # type: ignore[override]
        return self._items[index] if 0 <= index < len(self._items) else None

    def takeAt(self, index: int) -> QLayoutItem | None:  # type: ignore[override]
        return self._items.pop(index) if 0 <= index < len(self._items) else None

    def hasHeightForWidth(self) -> bool:
        return True

    def heightForWidth(self, width: int) -> int:
        if width not in self._heights:
            self._heights[width] = _height(self._lines(width), self.spacing())
        return self._heights[width]

    def invalidate(self) -> None:
        """Something in it is shown, hidden or of another size."""
        self._heights.clear()
        super().invalidate()

    def minimumSize(self) -> QSize:
        """As wide as the widest control."""
        sizes = [each.minimumSize() for each in self._items if not each.isEmpty()]
        return QSize(*(max((size.toTuple()[place] for size in sizes), default=0) for place in (0, 1)))

    def sizeHint(self) -> QSize:
        """All in one line."""
        return QSize(_width(self._shown(), self.spacing()), max((_tall(each) for each in self._shown()), default=0))

    def setGeometry(self, rect: QRect) -> None:
        super().setGeometry(rect)
        top = rect.top()
        for line in self._lines(rect.width()):
            growing = [each for each in line if each.expandingDirections() & ACROSS]
            rest = max(0, rect.width() - _width(line, self.spacing()))
            height, left = max(_tall(each) for each in line), rect.left()
            for each in line:
                width = _wide(each) + (rest // len(growing) if each in growing else 0)
                each.setGeometry(QRect(left, top, min(width, rect.width()), height))
                left += width + self.spacing()
            top += height + self.spacing()

    def _shown(self) -> list[QLayoutItem]:
        return [each for each in self._items if not each.isEmpty()]

    def _lines(self, width: int) -> list[list[QLayoutItem]]:
        lines: list[list[QLayoutItem]] = []
        used, space = 0, self.spacing()
        for each in self._shown():
            wide = _wide(each)
            if lines and used + space + wide <= width:
                lines[-1].append(each)
                used += space + wide
            else:
                lines.append([each])
                used = wide
        return lines


def _wide(item: QLayoutItem) -> int:
    """What may grow begins at its least width, everything else is as wide as it wants to be."""
    return item.minimumSize().width() if item.expandingDirections() & ACROSS else item.sizeHint().width()


def _tall(item: QLayoutItem) -> int:
    return item.sizeHint().height()


def _width(line: list[QLayoutItem], space: int) -> int:
    return sum(map(_wide, line)) + space * max(0, len(line) - 1)


def _height(lines: list[list[QLayoutItem]], space: int) -> int:
    return sum(max(map(_tall, line)) for line in lines) + space * max(0, len(lines) - 1)
