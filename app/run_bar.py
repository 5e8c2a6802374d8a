"""Above the program: Download, Execute, Halt, Burn, Upload, and whether the controller holds this program."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QHBoxLayout, QLabel, QToolBar, QWidget

from app.header import tool_bar
from device.api import Badge
from widgets.panel import set_text, show_role

BADGES = {
    Badge.SAME: ("ok", "✓ In the controller", "The controller holds exactly this program: it was sent and read back."),
    Badge.CHANGED: (
        "warning",
        "≠ Changed since",
        "The controller holds an earlier version of this program: download it again.",
    ),
    Badge.UNKNOWN: (
        "quiet",
        "? Not known",
        "What is in the controller is not known: download, or upload to look at it.",
    ),
}


class RunBar(QWidget):
    """Its buttons are filled from the action rows."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.toolbar: QToolBar = tool_bar()
        self.toolbar.setObjectName("run")
        self.toolbar.setIconSize(QSize(20, 20))
        self.toolbar.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.badge = QLabel()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 12, 0)
        row.setSpacing(8)
        row.addWidget(self.toolbar)
        row.addStretch(1)
        row.addWidget(self.badge)
        self.badge.setMinimumWidth(0)

    def show_badge(self, badge: Badge | None) -> None:
        """None: nothing is connected, nothing to compare with."""
        role, words, help_text = BADGES[badge] if badge is not None else ("quiet", "", "")
        set_text(self.badge, words)
        self.badge.setToolTip(help_text)
        self.badge.setAccessibleName(f"Program in the controller: {words}")
        show_role(self.badge, role)
