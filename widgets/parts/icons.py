"""The studio's own line icons, drawn in the colour of the theme at the moment they are painted."""

from __future__ import annotations

from functools import lru_cache

from PySide6.QtCore import QByteArray, QRect, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QIcon, QIconEngine, QPainter, QPixmap
from PySide6.QtSvg import QSvgRenderer

import resources
from widgets.parts.look import look


class LineIcon(QIconEngine):
    """Paints one drawing; `token` is its colour in the theme, grey when disabled."""

    def __init__(self, name: str, token: str) -> None:
        super().__init__()
        self._name = name
        self._token = token

    def paint(self, painter: QPainter, rect: QRect, mode: QIcon.Mode, state: QIcon.State) -> None:
        colour = look().colour("disabled" if mode is QIcon.Mode.Disabled else self._token)
        _renderer(self._name, colour.name()).render(painter, _square(rect))

    def pixmap(self, size: QSize, mode: QIcon.Mode, state: QIcon.State) -> QPixmap:
        pixmap = QPixmap(size)
        pixmap.fill(Qt.GlobalColor.transparent)
        painter = QPainter(pixmap)
        self.paint(painter, QRect(0, 0, size.width(), size.height()), mode, state)
        painter.end()
        return pixmap

    def scaledPixmap(self, size: QSize, mode: QIcon.Mode, state: QIcon.State, scale: float) -> QPixmap:
        return self.pixmap(size, mode, state)

    def clone(self) -> QIconEngine:
        copy = LineIcon(self._name, self._token)
        _CLONES.append(copy)
        return copy


_CLONES: list[LineIcon] = []  # Qt owns copies without telling Python: they must not be collected


def icon(name: str, token: str = "text") -> QIcon:
    """The icon of that name; KeyError when there is none."""
    _drawing(name)
    return QIcon(LineIcon(name, token))


def paint_icon(painter: QPainter, name: str, rect: QRectF, colour: QColor) -> None:
    """Draws the icon into `rect` in any colour."""
    _renderer(name, colour.name()).render(painter, rect)


@lru_cache(maxsize=256)
def _drawing(name: str) -> str:
    path = resources.path(f"icons/{name}.svg")
    if not path.is_file():
        raise KeyError(f"no icon named {name}")
    return path.read_text(encoding="utf-8")


@lru_cache(maxsize=512)
def _renderer(name: str, colour: str) -> QSvgRenderer:
    return QSvgRenderer(QByteArray(_drawing(name).replace("currentColor", colour).encode()))


def _square(rect: QRect) -> QRectF:
    side = min(rect.width(), rect.height())
    return QRectF(rect.x() + (rect.width() - side) / 2, rect.y() + (rect.height() - side) / 2, side, side)
