"""Watch or Control: whether anything that moves or changes the controller may be sent."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import QButtonGroup, QHBoxLayout, QToolButton, QVBoxLayout, QWidget

from device.api import Kind
from widgets.parts.icons import icon
from widgets.parts.kind import KindBadge

WATCH = "Reads only: nothing is sent that moves or changes anything. STOP always works."
CONTROL = (
    "Moving, setting, downloading and burning are allowed. "
    "Falls back to Watch after a reconnect or when nobody does anything."
)


class ControlSwitch(QWidget):
    """The kind in its border, and below it the two positions of the switch."""

    wanted = Signal(bool)  # True: Control

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.badge = KindBadge()
        self.setProperty("helpPage", "Watch and Control")
        self.watch, self.control = QToolButton(), QToolButton()
        group = QButtonGroup(self)
        for button, text, name, help_text in (
            (self.watch, "Watch", "watch", WATCH),
            (self.control, "Control", "control", CONTROL),
        ):
            button.setText(text)
            button.setIcon(icon(name))
            button.setIconSize(QSize(18, 18))
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
            button.setCheckable(True)
            button.setProperty("role", "control")
            button.setObjectName("switch")
            button.setAccessibleName(text)
            button.setToolTip(help_text)
            button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
            group.addButton(button)
        self.watch.clicked.connect(lambda: self.wanted.emit(False))
        self.control.clicked.connect(lambda: self.wanted.emit(True))
        row = QHBoxLayout()
        row.setSpacing(4)
        row.addWidget(self.watch)
        row.addWidget(self.control)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(6)
        column.addWidget(self.badge, 0, Qt.AlignmentFlag.AlignHCenter)
        column.addLayout(row)
        self._shown: tuple[Kind, bool] | None = None
        self.show_state(Kind.OFFLINE, False)

    def show_state(self, kind: Kind, control: bool) -> None:
        """What is connected, and which position holds."""
        if (kind, control) == self._shown:
            return
        self._shown = (kind, control)
        self.badge.show_kind(kind)
        usable = kind in (Kind.MACHINE, Kind.SIMULATOR)
        for button, on, words in ((self.watch, not control, WATCH), (self.control, control, CONTROL)):
            button.setEnabled(usable)
            button.setChecked(on and usable)
            button.setToolTip(words if usable else "Nothing is connected that could be controlled.")
