"""One channel of the scope: what it is, and the colour of its curve."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QIcon, QPainter, QPixmap
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QMenu, QSizePolicy, QToolButton, QWidget

from codegen.models import Model
from codegen.setup import Setup
from device.bits import signals
from device.capture import BY_NAME, Channel
from widgets.parts.look import look
from widgets.scope.bit_menu import BitMenu, Bits

NONE = "–"
COLOURS = {"Blue": "axis_x", "Orange": "axis_y", "Green": "axis_z", "Purple": "axis_w", "Text": "text", "Grey": "quiet"}


LEAST_WIDTH = 96  # px of a list
WORD = 16  # bits of the longest number of bits


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
        self.bits: Bits = None  # which of its bits are tracks
        self._model: Model | None = None
        self._setup: Setup | None = None
        self.what, self.pen, self.tracks = QComboBox(self), QToolButton(self), QToolButton(self)
        as_wide_as_there_is_room(self.what)
        self.what.setAccessibleName(f"Channel {number}")
        self.pen.setAccessibleName(f"Colour of channel {number}")
        self.pen.setToolTip("Colour of the curve")
        self.pen.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.pen.clicked.connect(self._ask_colour)
        self.what.currentIndexChanged.connect(self._chosen)
        self.tracks.setText("Bits")
        self.tracks.setAccessibleName(f"Bits of channel {number}")
        self.tracks.setToolTip("Which inputs, outputs or switches are drawn, each as a track of its own")
        self.tracks.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.tracks.setProperty("role", "control")
        self.tracks.clicked.connect(self._ask_bits)
        self.tracks.hide()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self.pen)
        row.addWidget(self.what, 1)
        row.addWidget(self.tracks)

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

    def offer(self, known: Sequence[Channel], model: Model, setup: Setup | None) -> None:
        """The channels there are now; the wanted one is chosen where it can be."""
        self._model, self._setup = model, setup
        self.what.blockSignals(True)
        self.what.clear()
        self.what.addItem(NONE, None)
        for channel in known:
            self.what.addItem(channel.label, channel)
        self.what.setCurrentIndex(known.index(self.wanted) + 1 if self.wanted in known else 0)
        self.what.blockSignals(False)
        self._follow()

    def _follow(self) -> None:
        self.tracks.setVisible(self.channel is not None and self.channel.row.dimension == "bits")
        self.paint_pen()

    def paint_pen(self) -> None:
        picture = QPixmap(32, 32)
        picture.fill(Qt.GlobalColor.transparent)
        painter = QPainter(picture)
        painter.fillRect(3, 12, 26, 8, look().colour(self.colour))
        painter.end()
        self.pen.setIcon(QIcon(picture))

    def state(self) -> list[Any]:
        """What is wanted and its axis (nothing: no channel), the colour, and which bits."""
        what, axis = (self.wanted.what, self.wanted.axis) if self.wanted is not None else ("", "")
        return [what, axis, self.token, list(self.bits) if self.bits is not None else None]

    def restore(self, found: Any) -> None:
        """As `state` told it; anything else leaves the slot as it is."""
        if not isinstance(found, list) or len(found) not in (3, 4):  # without bits: of an earlier version
            return
        what, axis, token = found[:3]
        if not all(isinstance(each, str) for each in (what, axis, token)):
            return
        if (what and what not in BY_NAME) or len(axis) > 1 or axis not in "XYZW":
            return
        self.wanted = Channel(what, axis) if what else None
        self.token = token if token in COLOURS.values() else ""
        bits = found[3] if len(found) == 4 else None
        known = isinstance(bits, list) and all(type(each) is int and 0 <= each < WORD for each in bits)
        self.bits = tuple(sorted(set(bits))) if known else None

    def _chosen(self) -> None:
        self.wanted, self.bits = self.channel, None
        self._follow()
        self.changed.emit()

    def _ask_bits(self) -> None:
        assert self.channel is not None
        menu = BitMenu(signals(self.channel, self._setup, self._model, live=True), self.bits, self)
        menu.chosen.connect(self.choose_bits)
        menu.popup(self.tracks.mapToGlobal(self.tracks.rect().bottomLeft()))

    def choose_bits(self, bits: Bits) -> None:
        self.bits = bits
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
