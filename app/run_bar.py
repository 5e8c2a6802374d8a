"""Above the program: Download, Execute, Halt, Burn, Upload, and whether the controller holds this program."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QHBoxLayout, QLabel, QToolBar, QWidget

from app.header import tool_bar
from app.held import Held, Holding
from widgets.panel import set_text, show_role

BADGES = {
    Holding.SAME: (
        "ok",
        "✓ In the controller",
        "The controller holds exactly the open program: what was read from it is the same line by line. "
        "Execute runs it.",
    ),
    Holding.EARLIER: (
        "warning",
        "≠ Changed since",
        "The controller holds {held}, before the changes since. Execute asks which one is meant; Download sends it.",
    ),
    Holding.OTHER: (
        "warning",
        "≠ Another program",
        "The controller holds {held}. Execute belongs to the verified one: it asks before anything runs.",
    ),
    Holding.EMPTY: ("warning", "○ No program", "There is no program in the controller: download this one."),
    Holding.UNKNOWN: (
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
        self._shown: Held | None = None
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 12, 0)
        row.setSpacing(8)
        row.addWidget(self.toolbar)
        row.addStretch(1)
        row.addWidget(self.badge)
        self.badge.setMinimumWidth(0)

    def show_held(self, held: Held | None) -> None:
        """None: nothing is connected, nothing to compare with."""
        if held == self._shown:
            return
        self._shown = held
        role, words, help_text = BADGES[held.holding] if held is not None else ("quiet", "", "")
        set_text(self.badge, words)
        self.badge.setToolTip(help_text.format(held=held.words) if held is not None else "")
        self.badge.setAccessibleName(f"Program in the controller: {words}")
        show_role(self.badge, role)
