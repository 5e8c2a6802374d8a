"""A click where a person sees a control: at its place in the window, after turning the wheel until it is in sight."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QScrollArea, QWidget

TURNS = 60
NOTCH = 120  # eighths of a degree


def press(widget: QWidget, place: QPoint | None = None) -> None:
    """A click of the left button; a control that is covered, cut off or not there fails."""
    window = widget.window()
    spot = place if place is not None else QPoint(min(12, widget.width() // 2), widget.height() // 2)
    assert widget.isVisible(), f"{_name(widget)} is not there"
    bring(widget, spot)
    there = widget.mapTo(window, spot)
    found = window.childAt(there)
    assert found is widget or widget.isAncestorOf(found), f"{_name(widget)} is covered by {found}"
    handle = window.windowHandle()
    assert handle is not None
    QTest.mouseClick(handle, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, there)


def bring(widget: QWidget, spot: QPoint) -> None:
    """Turns the wheel over the area that scrolls it, until the spot is in sight."""
    area = _area(widget)
    for _ in range(TURNS):
        if area is None or widget.visibleRegion().contains(spot):
            return
        view = area.viewport()
        below = widget.mapTo(view, spot).y() > view.height() // 2
        middle = QPointF(view.rect().center())
        event = QWheelEvent(
            middle, QPointF(view.mapToGlobal(view.rect().center())), QPoint(), QPoint(0, -NOTCH if below else NOTCH),
            Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False,
        )  # fmt: skip
        QApplication.sendEvent(view, event)
        QApplication.processEvents()
    raise AssertionError(f"{_name(widget)} does not come in sight")


def _area(widget: QWidget) -> QScrollArea | None:
    above = widget.parentWidget()
    while above is not None and not isinstance(above, QScrollArea):
        above = above.parentWidget()
    return above


def _name(widget: QWidget) -> str:
    return widget.accessibleName() or getattr(widget, "text", lambda: "")() or type(widget).__name__
