"""What a live panel is: a widget that says what it needs polled and is handed the newest row while it is visible."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QLabel, QWidget

from device.api import ONLY_WATCHED, Kind, State
from widgets.parts.pieces import Pieces

if TYPE_CHECKING:
    from codegen.document import Document
    from device.api import Controller, Notice, Row

VEIL = 8192  # px, more than any panel has, whatever size it gets meanwhile
NOT_READY = "The controller does not answer at the moment."


class Panel(QWidget):
    """A dock's content. `moves` is True where something on the machine can be moved or switched from it."""

    title = ""
    moves = False

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName(self.title)
        self.setProperty("helpPage", self.title)
        self.controller: Controller | None = None
        self.loaded: Callable[[], bool] = lambda: True  # whether what its pieces need can be had without waiting
        self.making = Pieces(self.pieces())
        self.making.done = type(self).pieces is Panel.pieces  # there are none
        self._veil: QWidget | None = None

    def pieces(self) -> Iterator[object]:
        """What takes long to make; one piece with each tick, from the first look on."""
        return iter(())

    def grow(self) -> None:
        """Makes the next piece, if it can be made without waiting."""
        if self.loaded():
            self.making.step()

    @property
    def in_sight(self) -> bool:
        """Whether any of it can be seen: what stands behind another tab is visible too, as Qt has it."""
        veil = self._veil
        return self.isVisible() and not (self if veil is None else veil).visibleRegion().isEmpty()

    def no_control(self, offline: str, watched: str) -> str:
        """Why nothing may be moved or set from here now, in the panel's own words; or nothing."""
        controller = self.controller
        if controller is None or controller.kind is Kind.OFFLINE:
            return offline
        if controller.kind is Kind.REPLAY:
            return ONLY_WATCHED
        if controller.state is not State.READY:
            return NOT_READY
        return "" if controller.control else watched

    def attach(self, controller: Controller) -> None:
        """Another controller (or none) is worked with from now on, and that is seen."""
        self.take(controller)
        self.show_controller()

    def take(self, controller: Controller) -> None:
        """The first half, which comes at once: nothing more goes to the one before; what is shown stays."""
        self.controller = controller

    def show_controller(self) -> None:
        """The other half: what is shown is of this controller. The tick does it, one panel after the other."""

    def veil(self) -> None:
        """Nothing of it is seen, nor can be clicked, until `unveil`: it would be of the controller before."""
        if self._veil is None:
            self._veil = veil = QWidget(self)
            veil.setAutoFillBackground(True)
            veil.resize(VEIL, VEIL)
            veil.show()

    def unveil(self) -> None:
        """It is seen again."""
        if self._veil is not None:
            self._veil.hide()
            self._veil.deleteLater()
            self._veil = None

    def show_document(self, old: Document | None, new: Document) -> None:
        """The program or the setup has changed."""

    def watches(self) -> tuple[str, ...]:
        """Keys of the live values it needs while it is visible."""
        return ()

    def draws(self) -> tuple[str, ...]:
        """Those of them that it draws as curves or ways: read in every round, together as far as a line holds them."""
        return ()

    def refresh(self, row: Row) -> None:
        """The newest values; called some thirty times a second while visible, must be cheap when nothing changed."""

    def notice(self, notice: Notice) -> None:
        """Something happened; called for every notice, visible or not."""


def set_text(label: QLabel, text: str) -> None:
    """Sets a label's text only when it differs, so that nothing is laid out again for nothing."""
    if label.text() != text:
        label.setText(text)


def set_tip(widget: QWidget, tip: str) -> None:
    """Sets a tooltip only when it differs: Qt tells everybody about each."""
    if widget.toolTip() != tip:
        widget.setToolTip(tip)


def show_role(widget: QWidget, role: str) -> None:
    """Gives a widget another role of the style sheet; nothing happens when it has it already."""
    if (widget.property("role") or "") != role:
        widget.setProperty("role", role)
        widget.style().unpolish(widget)
        widget.style().polish(widget)
