"""The scope's dock: empty until it is first shown, because what draws curves takes a while to load."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QVBoxLayout, QWidget

from widgets.panel import Panel

if TYPE_CHECKING:
    from codegen.document import Document
    from device.api import Row
    from widgets.scope.body import Body


class ScopePanel(Panel):
    """Passes on what the body needs, once there is one."""

    title = "Scope"
    moves = True  # it writes in the controller, and where it floats STOP stays at hand
    opened = Signal()  # the body has just been made

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.body: Body | None = None
        self._document: Document | None = None
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(8, 8, 8, 8)
        self.setMinimumSize(420, 160)

    def pieces(self) -> Iterator[None]:
        """Bar, choices, curves and readings, one after the other."""
        from widgets.scope.body import Body

        body = Body(self, at_once=False)
        self._column.addWidget(body)
        self._tell(body)
        yield from body.making.each()
        self.body = body
        self._tell(body)
        self.setFocusProxy(body.start)
        self.opened.emit()
        yield

    def show_controller(self) -> None:
        self._tell(self.body)

    def show_document(self, old: Document | None, new: Document) -> None:
        self._document = new
        if old is None or old.setup is not new.setup:
            self._tell(self.body)

    def watches(self) -> tuple[str, ...]:
        """The sample time: how often a value is taken depends on it."""
        return ("period",) if self.body is not None else ()

    def refresh(self, row: Row) -> None:
        if self.body is not None and self.controller is not None:
            self._tell(self.body)
            self.body.choices.show_period(row.value("period"))
            self.body.refresh(self.controller)

    def _tell(self, body: Body | None) -> None:
        """Whose channels there are: the controller's, or while none is known those of the setup."""
        if body is None or self._document is None:
            return
        setup = self._document.setup
        model = self.controller.model if self.controller is not None else None
        body.show_machine(model or setup.limits, setup)
