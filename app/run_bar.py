"""Above the program: Download, Execute, Halt, Burn, Upload, and whether the controller holds this program."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QHBoxLayout, QLabel, QToolBar, QWidget

from app.header import tool_bar
from device.api import Badge
from widgets.panel import set_text

BADGES = {
    Badge.SAME: ("ok", "✓ In the controller: this program"),
    Badge.CHANGED: ("warning", "≠ In the controller: an earlier version"),
    Badge.UNKNOWN: ("quiet", "? In the controller: not known"),
}


class RunBar(QWidget):
    """Its buttons are filled from the action rows."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.toolbar: QToolBar = tool_bar()
        self.toolbar.setIconSize(QSize(20, 20))
        self.toolbar.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.badge = QLabel()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 12, 0)
        row.setSpacing(8)
        row.addWidget(self.toolbar)
        row.addStretch(1)
        row.addWidget(self.badge)
        self._role = ""

    def show_badge(self, badge: Badge | None) -> None:
        """None: nothing is connected, nothing to compare with."""
        role, words = BADGES[badge] if badge is not None else ("quiet", "")
        set_text(self.badge, words)
        if role != self._role:
            self._role = role
            self.badge.setProperty("role", role)
            self.badge.style().unpolish(self.badge)
            self.badge.style().polish(self.badge)
