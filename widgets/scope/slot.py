"""One channel of the scope: what it is, and the colour of its curve."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QIcon, QPainter, QPixmap
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QMenu, QSizePolicy, QToolButton, QWidget

from device.capture import BY_NAME, Channel
from widgets.parts.look import look

NONE = "–"
COLOURS = {"Blue": "axis_x", "Orange": "axis_y", "Green": "axis_z", "Purple": "axis_w", "Text": "text", "Grey": "quiet"}


LEAST_WIDTH = 96  # px of a list


def as_wide_as_there_is_room(box: QComboBox) -> None:
    """Whatever its entries are; told to adjust to so many letters it would make what opens at once."""
    box.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
    box.setMinimumWidth(LEAST_WIDTH)


class Slot(QWidget):
    """One channel: its colour and what it is."""

    changed = Signal()

    def __init__(self, number: int, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.number = number
        self.token = ""  # a colour the person chose; nothing: that of the axis
        self.wanted: Channel | None = None  # what the person chose, also while this controller does not have it
        self.what, self.pen = QComboBox(self), QToolButton(self)
        as_wide_as_there_is_room(self.what)
        self.what.setAccessibleName(f"Channel {number}")
        self.pen.setAccessibleName(f"Colour of channel {number}")
        self.pen.setToolTip("Colour of the curve")
        self.pen.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.pen.clicked.connect(self._ask_colour)
        self.what.currentIndexChanged.connect(self._chosen)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self.pen)
        row.addWidget(self.what, 1)

    @property
    def channel(self) -> Channel | None:
        found = self.what.currentData()
        return found if isinstance(found, Channel) else None

    @property
    def colour(self) -> str:
        """A token of the theme."""
        if self.token:
            return self.token
        channel = self.channel
        return f"axis_{channel.axis.lower()}" if channel is not None and channel.axis else "quiet"

    def offer(self, known: Sequence[Channel]) -> None:
        """The channels there are now; the wanted one is chosen where it can be."""
        self.what.blockSignals(True)
        self.what.clear()
        self.what.addItem(NONE, None)
        for channel in known:
            self.what.addItem(channel.label, channel)
        self.what.setCurrentIndex(known.index(self.wanted) + 1 if self.wanted in known else 0)
        self.what.blockSignals(False)
        self.paint_pen()

    def paint_pen(self) -> None:
        picture = QPixmap(32, 32)
        picture.fill(Qt.GlobalColor.transparent)
        painter = QPainter(picture)
        painter.fillRect(3, 12, 26, 8, look().colour(self.colour))
        painter.end()
        self.pen.setIcon(QIcon(picture))

    def state(self) -> list[str]:
        """What is wanted and its axis (nothing: no channel), and the colour."""
        wanted = self.wanted
        return [wanted.what if wanted is not None else "", wanted.axis if wanted is not None else "", self.token]

    def restore(self, found: Any) -> None:
        """As `state` told it; anything else leaves the slot as it is."""
        if not isinstance(found, list) or len(found) != 3 or not all(isinstance(each, str) for each in found):
            return
        what, axis, token = found
        if (what and what not in BY_NAME) or len(axis) > 1 or axis not in "XYZW":
            return
        self.wanted = Channel(what, axis) if what else None
        self.token = token if token in COLOURS.values() else ""

    def _chosen(self) -> None:
        self.wanted = self.channel
        self.paint_pen()
        self.changed.emit()

    def _ask_colour(self) -> None:
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.addAction("As the axis").triggered.connect(lambda: self.choose_colour(""))
        for name, token in COLOURS.items():
            menu.addAction(name).triggered.connect(lambda _=False, token=token: self.choose_colour(token))
        menu.popup(self.pen.mapToGlobal(self.pen.rect().bottomLeft()))

    def choose_colour(self, token: str) -> None:
        self.token = token
        self.paint_pen()
        self.changed.emit()
