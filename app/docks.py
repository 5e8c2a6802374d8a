"""Panels as docks: any may float, tab or close; what moves something wears its kind and floats with its own STOP."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication, QEvent, QSize, Qt, Signal
from PySide6.QtGui import QResizeEvent, QShowEvent
from PySide6.QtWidgets import QDockWidget, QGraphicsView, QVBoxLayout, QWidget

from device.api import Kind, StopState
from widgets.parts.kind import KindFrame
from widgets.parts.stop_button import StopButton
from widgets.parts.turns import Turns

NESTED = 6  # what is laid out anew asks what is around it to be, and so on


def settle() -> None:
    """Lays out what has changed before it is painted; Qt would paint diagrams in the room they had, then anew."""
    for _ in range(NESTED):
        QCoreApplication.sendPostedEvents(None, QEvent.Type.LayoutRequest.value)


class Contained(QWidget):
    """Lays out what is in it by itself; what is around it hears only when that takes more room, or less.

    Qt lays out and paints the whole window, with all docks and diagrams, whenever any text in it changes its length.
    """

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._content: QWidget | None = None
        self._told = QSize()

    def hold(self, content: QWidget) -> None:
        """What is in it from now on."""
        self._content = content
        if content.parentWidget() is not self:
            content.setParent(self)
        content.setGeometry(self.rect())
        self.setSizePolicy(content.sizePolicy())
        self._tell()

    def sizeHint(self) -> QSize:
        return self._content.sizeHint() if self._content is not None else super().sizeHint()

    def minimumSizeHint(self) -> QSize:
        content = self._content
        return content.minimumSizeHint().expandedTo(content.minimumSize()) if content is not None else QSize()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if self._content is not None:
            self._content.setGeometry(self.rect())

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._tell()

    def event(self, event: QEvent) -> bool:
        if event.type() is QEvent.Type.LayoutRequest:
            self._tell()
        return super().event(event)

    def _tell(self) -> None:
        if (least := self.minimumSizeHint()) != self._told:
            self._told = least
            self.updateGeometry()


class Dock(QDockWidget):
    """One panel. `moves` gives it the border of the kind and a STOP of its own while it floats."""

    stop = Signal()
    brought = Signal()  # it has come in front; before anything is laid out

    def __init__(self, title: str, content: QWidget, moves: bool = False, parent: QWidget | None = None) -> None:
        super().__init__(title, parent)
        self.setObjectName(title)
        self.setAccessibleName(title)
        self.content = content
        self.frame: KindFrame | None = None
        self.stop_button: StopButton | None = None
        around = Contained(self)  # from the outside inwards: what gets another parent is dressed anew, with all in it
        self.setWidget(around)
        around.hold(self._framed(content, around) if moves else content)
        self.topLevelChanged.connect(self._floats)
        self._no_title = QWidget()
        self._turns = Turns(self)

    def show_state(self, kind: Kind, state: StopState) -> None:
        """What is connected, and what has become of the last stop."""
        if self.frame is not None and self.stop_button is not None:
            self.frame.show_kind(kind)
            self.stop_button.show_state(kind, state)

    def bring(self) -> None:
        """Shown, in front, with the focus in it; diagrams beside it that get another size are painted in turn."""
        before = {each: each.size() for each in self.window().findChildren(QGraphicsView) if each.isVisible()}
        self.show()
        self.raise_()
        self.brought.emit()
        settle()
        self._turns.bring(each for each, size in before.items() if each.isVisible() and each.size() != size)
        self.content.setFocus(Qt.FocusReason.OtherFocusReason)

    def _framed(self, content: QWidget, around: QWidget) -> QWidget:
        self.frame = KindFrame(around)
        self.stop_button = StopButton(self.frame)
        self.stop_button.stop.connect(self.stop)
        self.stop_button.hide()
        column = QVBoxLayout(self.frame)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.stop_button, 0, Qt.AlignmentFlag.AlignRight)
        column.addWidget(content, 1)
        return self.frame

    def show_title(self, shown: bool) -> None:
        """A dock among tabs needs no title row: its tab says it."""
        wanted = None if shown else self._no_title
        if (self.titleBarWidget() is self._no_title) == shown:
            self.setTitleBarWidget(wanted)  # type: ignore[arg-type]

    def _floats(self, floating: bool) -> None:
        self.show_title(True)
        if self.stop_button is not None:
            self.stop_button.setVisible(floating)
