"""How large a dialog may be, and where it stands."""

from __future__ import annotations

from PySide6.QtCore import QRect, QSize
from PySide6.QtWidgets import QWidget

PART = 0.85  # of the screen that a dialog may take


def room(widget: QWidget) -> QSize:
    """The size up to which a dialog grows before it scrolls."""
    return screen_of(widget).size() * PART


def screen_of(widget: QWidget) -> QRect:
    """The part of the screen that windows may use."""
    return widget.screen().availableGeometry()


def settle(widget: QWidget) -> None:
    """Brings all layouts inside up to date now, the innermost first."""
    for child in widget.children():
        if isinstance(child, QWidget) and not child.isWindow() and not child.isHidden():
            settle(child)
    layout = widget.layout()
    if layout is not None:
        layout.activate()


def keep_on_screen(dialog: QWidget) -> None:
    """Moves a dialog that has grown over the edge back in; a screen it does not fit on shows its top left."""
    screen, frame = screen_of(dialog), dialog.frameGeometry()
    right, low = screen.right() - frame.width() + 1, screen.bottom() - frame.height() + 1
    x = max(screen.left(), min(frame.left(), right))
    y = max(screen.top(), min(frame.top(), low))
    if (x, y) != (frame.left(), frame.top()):
        dialog.move(x, y)
