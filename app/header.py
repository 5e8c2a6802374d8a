"""The strip along the top: menus and toolbar left, Watch/Control and STOP right, always in the same place."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QResizeEvent, QShowEvent
from PySide6.QtWidgets import QGridLayout, QMenuBar, QToolBar, QToolButton, QWidget

from widgets.panel import show_role
from widgets.parts.control_switch import ControlSwitch
from widgets.parts.stop_button import StopButton

UNDER, ALONE = Qt.ToolButtonStyle.ToolButtonTextUnderIcon, Qt.ToolButtonStyle.ToolButtonIconOnly
ASIDE = 40  # px: margin and spaces of the strip
CLOSER = 9  # px that a button can spare


class Header(QWidget):
    """No docks or layouts can push the STOP button away: it is not part of a toolbar."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("header")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self.menus, self.toolbar = QMenuBar(), tool_bar()
        self.toolbar.setToolButtonStyle(UNDER)
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
        self._text_width = 0  # px of the toolbar with the texts under its pictures

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self.menus.setMinimumWidth(self.menus.sizeHint().width())  # no menu is ever cut or hidden
        self._fit()

    def _fit(self) -> None:
        """Texts under the pictures where all of them have room; else the pictures alone, never half a word."""
        if not self.isVisible():
            return
        if not self._text_width:
            self._text_width = width_of(self.toolbar)
        room = self.width() - self.switch.sizeHint().width() - self.stop.sizeHint().width() - ASIDE
        show_texts(self.toolbar, UNDER if room >= self._text_width else ALONE)


def width_of(bar: QToolBar) -> int:
    """px at which every word is still whole: a button may stand a little closer than it likes."""
    return bar.sizeHint().width() - CLOSER * sum(bool(each.text()) for each in bar.actions())


def show_texts(bar: QToolBar, style: Qt.ToolButtonStyle) -> None:
    """Another place for the texts of a toolbar; without them its buttons stand closer."""
    if bar.toolButtonStyle() is not style:
        bar.setToolButtonStyle(style)
        for button in bar.findChildren(QToolButton):
            if button.defaultAction() is not None:
                show_role(button, "narrow" if style is ALONE else "")


def tool_bar() -> QToolBar:
    """A toolbar with icons of 24 px that cannot be dragged away."""
    bar = QToolBar()
    bar.setMovable(False)
    bar.setIconSize(QSize(24, 24))
    return bar
