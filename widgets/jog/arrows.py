"""The arrow keys of the jog panel: which move what, and a line that says whether they do now."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QWidget

from widgets.panel import set_text, show_role

ARROWS = {Qt.Key.Key_Left: -1, Qt.Key.Key_Right: 1}
MODIFIERS = (Qt.Key.Key_Shift, Qt.Key.Key_Control, Qt.Key.Key_Alt, Qt.Key.Key_Meta, Qt.Key.Key_AltGr)
WITH = (
    Qt.KeyboardModifier.ShiftModifier
    | Qt.KeyboardModifier.ControlModifier
    | Qt.KeyboardModifier.AltModifier
    | Qt.KeyboardModifier.MetaModifier
)
OFF = "○ Arrow keys: click here to use them for {}"
ON = "● ← → hold {}, with Shift one increment"


class ArrowLine(QLabel):
    """A shape and words; the panel takes the focus when it is clicked."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWordWrap(True)

    def show_on(self, on: bool, axis: str) -> None:
        """Whether the keys move this axis now."""
        set_text(self, (ON if on else OFF).format(axis))
        show_role(self, "ok" if on else "quiet")
