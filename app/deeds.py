"""What the person does, in words: actions, buttons, choices, fields, cells, menus, moves by hand; for the recorder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import PureWindowsPath
from typing import TYPE_CHECKING

from PySide6.QtCore import QModelIndex, QObject, Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QDockWidget,
    QDoubleSpinBox,
    QFileDialog,
    QLineEdit,
    QMainWindow,
    QMenu,
    QSlider,
    QSpinBox,
    QTabBar,
    QToolButton,
    QWidget,
)

from widgets.panel import Panel

if TYPE_CHECKING:
    from app.compose import Studio

LISTENED = "listened"  # the property of what tells its use
TOLD = "told"  # the property of a field: what it said last
TOUCHED = "touched"  # of a box with arrows: changed while it had the keyboard
LISTEN_TICKS = 5  # between two panels: buttons may be made at any time
HEARD = QAbstractButton | QComboBox | QLineEdit | QAbstractSpinBox | QSlider | QTabBar | QAbstractItemView


class Deeds(QObject):
    """Listens to the widgets of each panel and window when it first has the focus; tells everything in a sentence."""

    def __init__(self, studio: Studio, tell: Callable[[str], None]) -> None:
        super().__init__(studio)
        self._studio, self._tell = studio, tell
        self._edits, self._turn = len(studio.session.history.past), -1
        self._by_hand = ""
        for action in (*studio.actions.actions.values(), *studio.program.commands.values()):
            action.setProperty(LISTENED, True)
            action.triggered.connect(self._acted)
        studio.terminal.send.setProperty(LISTENED, True)  # the command itself is told
        studio.terminal.line.setProperty(LISTENED, True)
        studio.terminal.command.connect(lambda command: tell(f"Terminal: {command}"))
        studio.window.prompt.answered.connect(lambda text: tell(f"Answer: {text}"))
        studio.simulator.stimulus.connect(lambda signal, value: tell(f"Simulator switch: {signal} {value:g}"))
        application = QApplication.instance()
        if isinstance(application, QApplication):
            application.focusChanged.connect(self._focused)

    def look(self) -> None:
        """With each tick: the last edit of the program, moves by hand; what is new in one panel after the other."""
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
        by_hand = self._studio.connection.controller.motion.busy
        if by_hand != self._by_hand:
            self._by_hand = by_hand
            self._tell(f"By hand: {by_hand or 'let go'}")

    # ---------------------------------------------------------------- listening

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
        if isinstance(place, QMenu) and not place.property(LISTENED):
            place.setProperty(LISTENED, True)
            place.triggered.connect(self._picked)
        for widget in place.findChildren(QWidget):
            if isinstance(widget, HEARD) and not widget.property(LISTENED):
                widget.setProperty(LISTENED, True)
                self._listen(widget)

    def _listen(self, widget: QWidget) -> None:
        """Connects one widget; what is a part of another one, or shows an action, is told by that."""
        if isinstance(widget.parentWidget(), QComboBox | QAbstractSpinBox):
            return
        if isinstance(widget, QAbstractButton):
            if not (isinstance(widget, QToolButton) and widget.defaultAction() is not None):
                widget.clicked.connect(self._clicked)
        elif isinstance(widget, QComboBox):
            widget.textActivated.connect(self._chosen)
        elif isinstance(widget, QLineEdit | QAbstractSpinBox):
            widget.editingFinished.connect(self._typed)
            if isinstance(widget, QSpinBox | QDoubleSpinBox):
                widget.textChanged.connect(self._touched)
        elif isinstance(widget, QSlider):
            widget.sliderReleased.connect(self._slid)
            widget.actionTriggered.connect(self._slid)
        elif isinstance(widget, QTabBar):
            widget.tabBarClicked.connect(self._turned)
        elif isinstance(widget, QAbstractItemView):
            delegate = widget.itemDelegate()
            if delegate is not None:
                delegate.commitData.connect(self._entered)

    # ------------------------------------------------------------------ telling

    def _acted(self) -> None:
        action = self.sender()
        if isinstance(action, QAction):
            self._tell(_action_words(action))

    def _picked(self, action: QAction) -> None:
        """An entry of a menu that is no action of the studio."""
        if not action.property(LISTENED):
            self._tell(f"Menu: {_action_words(action)}")

    def _clicked(self) -> None:
        button = self.sender()
        if isinstance(button, QAbstractButton):
            state = (" on" if button.isChecked() else " off") if button.isCheckable() else ""
            self._tell(f"{_named(button, button.text())}{state}")

    def _chosen(self, text: str) -> None:
        box = self.sender()
        if isinstance(box, QWidget):
            self._tell(f"{_named(box, 'list')} = {_without_folders(box, text)}")

    def _typed(self) -> None:
        """A field was left, or Enter was pressed in it; told once, and only what the person changed."""
        field = self.sender()
        if not isinstance(field, QLineEdit | QAbstractSpinBox):
            return
        by_person = field.isModified() if isinstance(field, QLineEdit) else field.property(TOUCHED)
        if by_person and field.text() != field.property(TOLD):
            field.setProperty(TOLD, field.text())
            self._tell(f"{_named(field, 'field')} = {_without_folders(field, field.text())}")

    def _touched(self) -> None:
        box = self.sender()
        if isinstance(box, QWidget) and box.hasFocus():
            box.setProperty(TOUCHED, True)

    def _slid(self) -> None:
        slider = self.sender()
        if isinstance(slider, QSlider) and not slider.isSliderDown():
            self._tell(f"{_named(slider, 'slider')} = {slider.sliderPosition()}")

    def _turned(self, place: int) -> None:
        bar = self.sender()
        if isinstance(bar, QTabBar) and place >= 0:
            self._tell(f"{_named(bar, 'page')} = {bar.tabText(place)}")

    def _entered(self, editor: QWidget) -> None:
        """A cell was edited."""
        delegate = self.sender()
        view = delegate.parent() if delegate is not None else None
        if not isinstance(view, QAbstractItemView):
            return
        text = editor.currentText() if isinstance(editor, QComboBox) else str(editor.property("text") or "")
        self._tell(f"{_named(view, 'table')}, {_cell_words(view.currentIndex())} = {text}")


def _action_words(action: QAction) -> str:
    state = (" on" if action.isChecked() else " off") if action.isCheckable() else ""
    return f"{action.text().replace('&', '').rstrip('…')}{state}"


def _without_folders(widget: QWidget, text: str) -> str:
    """Of a file only its name: where it lies on this computer, and whose it is, is nobody's business elsewhere."""
    return PureWindowsPath(text).name if isinstance(widget.window(), QFileDialog) else text


def _cell_words(cell: QModelIndex) -> str:
    """`row 3, Pos X mm`, as the heading says."""
    if not cell.isValid():
        return "a cell"
    heading = cell.model().headerData(cell.column(), Qt.Orientation.Horizontal)
    name = " ".join(str(heading).split()) if heading is not None else f"column {cell.column() + 1}"
    return f"row {cell.row() + 1}, {name}"


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
