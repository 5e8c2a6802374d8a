"""The strip along the top: menus and toolbar left, Watch/Control and STOP right, always in the same place."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QGridLayout, QMenuBar, QToolBar, QWidget

from widgets.parts.control_switch import ControlSwitch
from widgets.parts.stop_button import StopButton


class Header(QWidget):
    """No docks or layouts can push the STOP button away: it is not part of a toolbar."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("header")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self.menus, self.toolbar = QMenuBar(), tool_bar()
        self.toolbar.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextUnderIcon)
        self.switch, self.stop = ControlSwitch(), StopButton()
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 4, 8, 4)
        grid.setHorizontalSpacing(16)
        grid.setVerticalSpacing(0)
        grid.addWidget(self.menus, 0, 0)
        grid.addWidget(self.toolbar, 1, 0)
        grid.addWidget(self.switch, 0, 1, 2, 1, Qt.AlignmentFlag.AlignVCenter)
        grid.addWidget(self.stop, 0, 2, 2, 1, Qt.AlignmentFlag.AlignVCenter)
        grid.setColumnStretch(0, 1)


def tool_bar() -> QToolBar:
    """A toolbar with icons of 24 px that can not be dragged away."""
    bar = QToolBar()
    bar.setMovable(False)
    bar.setIconSize(QSize(24, 24))
    return bar
