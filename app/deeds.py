"""What the person does, in words: actions, buttons, choices, commands, edits; for the recorder."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QComboBox,
    QDockWidget,
    QLineEdit,
    QMainWindow,
    QToolButton,
    QWidget,
)

from widgets.panel import Panel

if TYPE_CHECKING:
    from app.compose import Studio

LISTENED = "listened"  # the property of a widget whose use is told
LISTEN_TICKS = 5  # between two panels: buttons may be made at any time


class Deeds(QObject):
    """Listens to the widgets of each panel and window when it first has the focus; tells everything in a sentence."""

    def __init__(self, studio: Studio, tell: Callable[[str], None]) -> None:
        super().__init__(studio)
        self._studio, self._tell = studio, tell
        self._edits, self._turn = len(studio.session.history.past), -1
        for action in (*studio.actions.actions.values(), *studio.program.commands.values()):
            action.triggered.connect(self._acted)
        studio.terminal.send.setProperty(LISTENED, True)  # the command itself is told
        studio.terminal.command.connect(lambda command: tell(f"Terminal: {command}"))
        studio.window.prompt.answered.connect(lambda text: tell(f"Answer: {text}"))
        studio.simulator.stimulus.connect(lambda signal, value: tell(f"Simulator switch: {signal} {value:g}"))
        application = QApplication.instance()
        if isinstance(application, QApplication):
            application.focusChanged.connect(self._focused)

    def look(self) -> None:
        """With each tick: the last edit of the program; what is new in one panel after the other."""
        panels = self._studio.panels
        self._turn = (self._turn + 1) % (LISTEN_TICKS * len(panels))
        if self._turn % LISTEN_TICKS == 0:
            self._listen_to(panels[self._turn // LISTEN_TICKS])
            self._listen_to_windows()
        past = self._studio.session.history.past
        if len(past) != self._edits:
            self._edits = len(past)
            if past:
                self._tell(f"Program: {past[-1].label}")

    def _listen_to_windows(self) -> None:
        """Those that never get the focus, because another program has it, are used as well."""
        for window in QApplication.topLevelWidgets():
            if window.isVisible() and not isinstance(window, QMainWindow | QDockWidget):
                self._listen_to(window)

    def _focused(self, old: QWidget | None, new: QWidget | None) -> None:
        if new is None:
            return
        window = new.window()
        if not isinstance(window, QMainWindow | QDockWidget):
            self._listen_to(window)
            return
        panel: QWidget | None = new
        while panel is not None and not isinstance(panel, Panel):
            panel = panel.parentWidget()
        if panel is not None:
            self._listen_to(panel)

    def _listen_to(self, place: QWidget) -> None:
        for widget in place.findChildren(QWidget):
            if widget.property(LISTENED) or not isinstance(widget, QAbstractButton | QComboBox | QLineEdit):
                continue
            widget.setProperty(LISTENED, True)
            if isinstance(widget, QToolButton) and widget.defaultAction() is not None:
                continue  # the action tells it
            if isinstance(widget, QAbstractButton):
                widget.clicked.connect(self._clicked)
            elif isinstance(widget, QComboBox):
                widget.textActivated.connect(self._chosen)
            elif not isinstance(widget.parentWidget(), QComboBox):
                widget.returnPressed.connect(self._typed)

    def _acted(self) -> None:
        action = self.sender()
        if isinstance(action, QAction):
            state = (" on" if action.isChecked() else " off") if action.isCheckable() else ""
            self._tell(f"{action.text().replace('&', '').rstrip('…')}{state}")

    def _clicked(self) -> None:
        button = self.sender()
        if isinstance(button, QAbstractButton):
            state = (" on" if button.isChecked() else " off") if button.isCheckable() else ""
            self._tell(f"{_named(button, button.text())}{state}")

    def _chosen(self, text: str) -> None:
        box = self.sender()
        if isinstance(box, QWidget):
            self._tell(f"{_named(box, 'list')} = {text}")

    def _typed(self) -> None:
        line = self.sender()
        if isinstance(line, QLineEdit) and line is not self._studio.terminal.line:
            self._tell(f"{_named(line, 'field')} = {line.text()}")


def _named(widget: QWidget, otherwise: str) -> str:
    """Where it is and what it is called."""
    name = (widget.accessibleName() or otherwise).replace("&", "").rstrip("…")
    above: QWidget | None = widget.parentWidget()
    while above is not None:
        place = above.title if isinstance(above, Panel) else above.windowTitle() if above.isWindow() else ""
        if place:
            return f"{place}: {name}"
        above = above.parentWidget()
    return name
