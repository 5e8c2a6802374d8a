"""Mouse and keyboard of a technician: real events on the real windows, nothing called behind them."""

from __future__ import annotations

import time
from collections.abc import Callable

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAction
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QApplication,
    QCheckBox,
    QComboBox,
    QDialog,
    QLineEdit,
    QListWidget,
    QMenu,
    QPushButton,
    QToolButton,
    QTreeWidgetItem,
    QWidget,
)

from app.compose import Studio
from widgets.form.dialog import InstructionDialog

PATIENCE_S = 20.0
TURN_S = 0.005


def until(true: Callable[[], object], what: str, patience_s: float = PATIENCE_S) -> None:
    """Lets the studio live until `true` holds; fails with `what` was awaited."""
    end = time.monotonic() + patience_s
    while not true():
        QApplication.processEvents()
        QTest.qWait(round(1000 * TURN_S))
        assert time.monotonic() < end, f"waited {patience_s:g} s in vain for {what}"


def live(seconds: float) -> None:
    """Lets the studio live for a while, in turns: a computer that is busy with others meanwhile takes none away."""
    for _ in range(max(1, round(seconds / TURN_S))):
        QApplication.processEvents()
        QTest.qWait(round(1000 * TURN_S))


class Hands:
    """What every way of working has in common."""

    def __init__(self, studio: Studio) -> None:
        self.studio = studio
        self.window = studio.window

    # ---- to be done in the way of the hand

    def act(self, name: str) -> None:
        """Uses a menu entry or toolbar button."""
        raise NotImplementedError

    def pick(self, title: str) -> InstructionDialog:
        """Opens the dialog of an instruction from the palette."""
        raise NotImplementedError

    def press(self, button: QWidget) -> None:
        """Presses a button or ticks a box."""
        raise NotImplementedError

    def fill(self, line: QLineEdit, text: str) -> None:
        """Replaces what stands in a line."""
        raise NotImplementedError

    def choose(self, box: QComboBox, words: str) -> None:
        """Chooses an entry of a list."""
        raise NotImplementedError

    def turn_to(self, pages: QListWidget, title: str) -> None:
        """Chooses a page of a window."""
        raise NotImplementedError

    # ---- made of these

    def add(self, title: str, **fields: str) -> None:
        """Adds an instruction; fields are named as in its definition, per-axis ones with the axis: `acceleration_X`."""
        dialog = self.pick(title)
        for name, text in fields.items():
            self.enter(dialog, name, text)
        add = dialog.buttons["Add"]
        assert add.isEnabled(), f"{title}: {add.toolTip()}"
        self.confirm(dialog)
        until(lambda: not visible(dialog), f"the dialog {title} to close")

    def enter(self, dialog: InstructionDialog, name: str, text: str) -> None:
        """Puts a value into a field, whatever its editor is."""
        field, _, axis = name.partition("_") if name[-2:-1] == "_" else (name, "", "")
        cell = dialog.form.fields.cells[field, axis]
        assert cell.isVisible(), f"the field {name} is hidden"
        boxes = [box for box in cell.findChildren(QComboBox) if box.isVisible() and not box.isEditable()]
        if boxes:
            self.choose(boxes[0], text)
            return
        lines = [line for line in cell.findChildren(QLineEdit) if line.isVisible()]
        if lines:
            self.fill(lines[0], text)
            return
        buttons = [button for button in cell.findChildren(QPushButton) if button.text() == text]
        assert buttons, f"{name}: no button {text!r} among {[b.text() for b in cell.findChildren(QPushButton)]}"
        self.take(buttons[0])

    def take(self, button: QPushButton) -> None:
        """Chooses one of a few words side by side."""
        self.press(button)
        assert button.isChecked()

    def confirm(self, dialog: InstructionDialog) -> None:
        """Add."""
        raise NotImplementedError


class Mouse(Hands):
    """Clicks, double clicks; keys only for text."""

    def act(self, name: str) -> None:
        action = action_of(self.studio, name)
        until(action.isEnabled, f"{action.text()}, which is grey: {action.toolTip()}")
        for button in self.window.findChildren(QToolButton):
            if button.defaultAction() is action and button.isVisible():
                self.press(button)
                return
        menu, top = menu_of(self.studio, action)
        bar_rect = menu.parentWidget().actionGeometry(top)
        QTest.mouseClick(menu.parentWidget(), Qt.MouseButton.LeftButton, pos=bar_rect.center())
        until(menu.isVisible, f"the menu {top.text()}")
        QTest.mouseClick(menu, Qt.MouseButton.LeftButton, pos=menu.actionGeometry(action).center())
        QApplication.processEvents()

    def pick(self, title: str) -> InstructionDialog:
        palette = self.studio.program.instructions
        item: QTreeWidgetItem = palette.items[title]
        tree = palette.tree
        tree.scrollToItem(item)
        place = tree.visualItemRect(item).center()
        QTest.mouseClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=place)
        QTest.mouseDClick(tree.viewport(), Qt.MouseButton.LeftButton, pos=place)
        return dialog_of(title)

    def press(self, button: QWidget) -> None:
        assert button.isVisible() and button.isEnabled(), f"{button.accessibleName()}: {button.toolTip()}"
        place = button.rect().center()
        if isinstance(button, QCheckBox):
            place = QPoint(10, button.rect().center().y())
        QTest.mouseClick(button, Qt.MouseButton.LeftButton, pos=place)
        QApplication.processEvents()

    def fill(self, line: QLineEdit, text: str) -> None:
        QTest.mouseClick(line, Qt.MouseButton.LeftButton)
        QTest.keySequence(line, "Ctrl+A")
        QTest.keyClicks(line, text)
        QApplication.processEvents()

    def choose(self, box: QComboBox, words: str) -> None:
        index = box.findText(words)
        assert index >= 0, f"{words} is not offered"
        QTest.mouseClick(box, Qt.MouseButton.LeftButton)
        until(box.view().isVisible, "the list to open")
        view = box.view()
        place = view.visualRect(box.model().index(index, 0)).center()
        ignored_s = 0.001 * QApplication.doubleClickInterval() + 0.05  # Qt ignores a release that comes sooner
        end = time.monotonic() + PATIENCE_S
        while view.isVisible():  # a slow computer may have opened it late
            assert time.monotonic() < end, f"{words} was not chosen"
            QTest.qWait(int(1000 * ignored_s))
            QTest.mouseClick(view.viewport(), Qt.MouseButton.LeftButton, pos=place)
            QTest.qWait(50)
        until(lambda: box.currentIndex() == index, f"{words} to be chosen")

    def turn_to(self, pages: QListWidget, title: str) -> None:
        (item,) = pages.findItems(title, Qt.MatchFlag.MatchStartsWith)
        QTest.mouseClick(pages.viewport(), Qt.MouseButton.LeftButton, pos=pages.visualItemRect(item).center())
        until(lambda: pages.currentItem() is item, f"the page {title}")

    def confirm(self, dialog: InstructionDialog) -> None:
        self.press(dialog.buttons["Add"])


class Keys(Hands):
    """Tab, arrows, Enter, shortcuts and letters; no mouse."""

    def act(self, name: str) -> None:
        action = action_of(self.studio, name)
        until(action.isEnabled, f"{action.text()}, which is grey: {action.toolTip()}")
        shortcut = action.shortcut().toString()
        if shortcut:
            QTest.keySequence(front(self.window), shortcut)
            QApplication.processEvents()
            return
        menu, top = menu_of(self.studio, action)
        letter = top.text()[top.text().index("&") + 1]
        QTest.keyClick(front(self.window), letter, Qt.KeyboardModifier.AltModifier)
        until(menu.isVisible, f"the menu {top.text()}")
        for _ in range(len(menu.actions()) + 1):
            if menu.activeAction() is action:
                break
            QTest.keyClick(menu, Qt.Key.Key_Down)
        assert menu.activeAction() is action, f"{action.text()} cannot be reached with the arrows"
        QTest.keyClick(menu, Qt.Key.Key_Return)
        QApplication.processEvents()

    def pick(self, title: str) -> InstructionDialog:
        QTest.keySequence(front(self.window), "Ctrl+Shift+F")
        search = QApplication.focusWidget()
        assert isinstance(search, QLineEdit), "Ctrl+Shift+F goes to the search"
        QTest.keySequence(search, "Ctrl+A")
        QTest.keyClicks(search, title)
        QTest.keyClick(search, Qt.Key.Key_Return)
        return dialog_of(title)

    def press(self, button: QWidget) -> None:
        self.go_to(button)
        QTest.keyClick(button, Qt.Key.Key_Space)
        QApplication.processEvents()

    def fill(self, line: QLineEdit, text: str) -> None:
        self.go_to(line)
        QTest.keySequence(line, "Ctrl+A")
        QTest.keyClicks(line, text)
        QApplication.processEvents()

    def choose(self, box: QComboBox, words: str) -> None:
        index = box.findText(words)
        assert index >= 0, f"{words} is not offered"
        self.go_to(box)
        QTest.keyClick(box, Qt.Key.Key_Home)
        for _ in range(index):
            QTest.keyClick(box, Qt.Key.Key_Down)
        until(lambda: box.currentIndex() == index, f"{words} to be chosen")

    def turn_to(self, pages: QListWidget, title: str) -> None:
        (item,) = pages.findItems(title, Qt.MatchFlag.MatchStartsWith)
        self.go_to(pages)
        QTest.keyClick(pages, Qt.Key.Key_Home)
        for _ in range(pages.row(item)):
            QTest.keyClick(pages, Qt.Key.Key_Down)
        until(lambda: pages.currentItem() is item, f"the page {title}")

    def confirm(self, dialog: InstructionDialog) -> None:
        QTest.keyClick(QApplication.focusWidget() or dialog, Qt.Key.Key_Return)

    def take(self, button: QPushButton) -> None:
        """Words side by side are one stop of the Tab key; arrows choose."""
        group = button.group()
        assert group is not None
        self.go_to(group.checkedButton() or button)
        order = group.buttons()
        way = order.index(button) - order.index(group.checkedButton() or button)
        for _ in range(abs(way)):
            QTest.keyClick(QApplication.focusWidget(), Qt.Key.Key_Right if way > 0 else Qt.Key.Key_Left)
        assert button.isChecked(), f"arrows do not choose {button.text()}"

    def go_to(self, wanted: QWidget) -> None:
        """Tab until the widget has the focus; one that cannot be reached so fails."""
        wanted = wanted.focusProxy() or wanted
        top = wanted.window()
        activate(top)
        seen = 0
        while QApplication.focusWidget() is not wanted:
            now = QApplication.focusWidget()
            QTest.keyClick(now if now is not None and now.window() is top else top, Qt.Key.Key_Tab)
            QApplication.processEvents()
            seen += 1
            assert seen < 300, f"Tab does not reach {wanted.accessibleName() or wanted}"


def activate(window: QWidget) -> None:
    """A window manager hands the keys to the window below when a dialog closes; off-screen there is none."""
    if QApplication.activeWindow() is not window:
        window.activateWindow()
        until(lambda: QApplication.activeWindow() is window, f"{window.windowTitle()} to take the keys")


def front(window: QWidget) -> QWidget:
    """Where keys go now."""
    active = QApplication.activeWindow()
    if active is None or not active.isVisible():
        activate(window)
    return QApplication.focusWidget() or QApplication.activeWindow() or window


def visible(dialog: QWidget) -> bool:
    """Whether a dialog is still there; it deletes itself when closed."""
    try:
        return dialog.isVisible()
    except RuntimeError:  # Qt's half has gone
        return False


def action_of(studio: Studio, name: str) -> QAction:
    """The action of a row, the program window's own ones included."""
    return studio.program.commands.get(name) or studio.actions[name]


def menu_of(studio: Studio, action: QAction) -> tuple[QMenu, QAction]:
    """The menu an action stands in, and the entry of the menu bar that opens it."""
    for top in studio.window.header.menus.actions():
        menu = top.menu()
        if isinstance(menu, QMenu) and action in menu.actions():
            return menu, top
    raise AssertionError(f"{action.text()} stands in no menu")


def dialog_of(title: str) -> InstructionDialog:
    """The open dialog of an instruction."""
    found: list[InstructionDialog] = []

    def look() -> bool:
        found[:] = [
            each
            for each in QApplication.topLevelWidgets()
            if isinstance(each, InstructionDialog) and each.isVisible() and each.windowTitle() == title
        ]
        return bool(found)

    until(look, f"the dialog {title}")
    QTest.qWaitForWindowActive(found[0], 2000)
    return found[0]


def shown(kind: type[QDialog]) -> QDialog:
    """The open dialog of a class."""
    found: list[QDialog] = []

    def look() -> bool:
        found[:] = [each for each in QApplication.topLevelWidgets() if isinstance(each, kind) and each.isVisible()]
        return bool(found)

    until(look, f"a {kind.__name__}")
    QTest.qWaitForWindowActive(found[0], 2000)
    return found[0]
