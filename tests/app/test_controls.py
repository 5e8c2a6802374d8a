"""Every control of every window: it has a name for screen readers and can be reached by keyboard."""

from __future__ import annotations

import re

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QLineEdit,
    QPlainTextEdit,
    QSlider,
    QTabBar,
    QTextBrowser,
    QTextEdit,
    QWidget,
)

from app.help_pages import Pages
from tests.app.test_stop import PLACES
from tests.stage import Stage
from widgets.help.topic import topic_of

CONTROLS = (
    QAbstractButton,
    QComboBox,
    QLineEdit,
    QAbstractSpinBox,
    QSlider,
    QPlainTextEdit,
    QTextBrowser,
    QTextEdit,
    QAbstractItemView,
)
INSIDE = (QComboBox, QAbstractSpinBox)  # their own parts are not controls by themselves


def controls(window: QWidget) -> list[QWidget]:
    """Visible controls that are not parts of another one."""
    found = []
    for widget in window.findChildren(QWidget):
        if not isinstance(widget, CONTROLS) or not widget.isVisibleTo(window) or _is_part(widget):
            continue
        found.append(widget)
    return found


def _is_part(widget: QWidget) -> bool:
    if widget.objectName().startswith("qt_") or isinstance(widget.parentWidget(), QTabBar):
        return True
    parent = widget.parentWidget()
    while parent is not None:
        if isinstance(parent, (*INSIDE, QAbstractItemView)):
            return True
        parent = parent.parentWidget()
    return False


def name_of(widget: QWidget) -> str:
    """What a screen reader says."""
    text = widget.text() if isinstance(widget, QAbstractButton) else ""
    return widget.accessibleName() or text or (widget.toolTip() if isinstance(widget, QAbstractButton) else "")


def describe(widget: QWidget) -> str:
    chain, each = [], widget
    while each is not None:
        chain.append(f"{type(each).__name__}#{each.objectName()}")
        each = each.parentWidget()
    return " < ".join(chain[:6])


def reachable(widget: QWidget) -> bool:
    return bool(widget.focusPolicy() & Qt.FocusPolicy.TabFocus)


WITH_A_PAGE = ("the welcome window", "the serial setup", "the setup", "the settings")
HIGH = ("the window", *WITH_A_PAGE, "a question")  # lists may have lower rows
FIELDS = (QComboBox, QLineEdit, QAbstractSpinBox)


@pytest.mark.parametrize("place", [name for name in PLACES if name not in ("the program", "a file dialog")])
def test_every_control_has_a_name_and_is_reached_by_tab(place: str, stage: Stage) -> None:
    """Fields are at least 32 px high, and dialogs name a help page that exists."""
    stage.connect("simulator")
    shown = PLACES[place](stage)
    window = shown.window()
    stage.go()
    found = controls(window)
    assert [describe(widget) for widget in found if not name_of(widget)] == []
    assert [describe(w) for w in found if w.isEnabled() and not reachable(w) and not _read_only(w)] == []
    low = [(describe(widget), widget.height()) for widget in found if isinstance(widget, FIELDS)]
    assert place not in HIGH or [each for each in low if each[1] < 32] == []
    assert place not in WITH_A_PAGE or topic_of(shown) in Pages()


def _read_only(widget: QWidget) -> bool:
    """Lamps that only show; buttons of the dock's own title, which the menu View > Panels does too."""
    from widgets.parts.lamp import Lamp

    title = type(widget).__name__ == "QDockWidgetTitleButton" or widget.objectName().startswith("qt_dockwidget")
    clear = isinstance(widget.parentWidget(), QLineEdit)
    return title or clear or isinstance(widget, Lamp)


def test_tab_walks_through_the_window_and_comes_back(stage: Stage) -> None:
    window = stage.studio.window
    window.activateWindow()
    stage.studio.program.tree.setFocus()
    seen: list[QWidget] = []
    widget: QWidget = stage.studio.program.tree
    for _ in range(2000):
        nxt = widget.nextInFocusChain()
        if nxt is stage.studio.program.tree:
            break
        widget = nxt
        seen.append(widget)
    else:
        pytest.fail("the focus chain does not close")
    for button in (window.header.stop, window.header.switch.watch, stage.studio.terminal.line):
        assert button in seen


def test_every_panel_can_be_brought_to_the_front_from_the_menu(stage: Stage) -> None:
    actions = {action.text().split(" ")[0]: action for action in stage.studio.window.submenus["panels"].actions()}
    for title in ("Instructions", "Display", "Simulator", "Messages", "Terminal", "Problems"):
        dock = stage.studio.window.docks[title]
        dock.hide()
        actions[title].trigger()
        QApplication.processEvents()
        assert dock.isVisible(), title


def test_f1_opens_the_page_of_the_panel_that_has_the_focus(stage: Stage) -> None:
    stage.connect("simulator")
    stage.go()
    for title in ("Display", "Simulator", "Terminal", "Messages"):
        dock = stage.studio.window.docks[title]
        dock.bring()
        stage.go()
        focus = next(widget for widget in controls(dock) if widget.focusPolicy() & Qt.FocusPolicy.TabFocus)
        assert topic_of(focus) == title
        stage.studio.desk.show_help(topic_of(focus) or "")
        stage.go(1)
        assert stage.studio.desk.help is not None
        assert title in stage.studio.desk.help.findChildren(QTextBrowser)[0].toPlainText()


def test_stop_and_the_switch_have_pages_of_their_own(stage: Stage) -> None:
    header = stage.studio.window.header
    assert topic_of(header.stop) in Pages()
    assert topic_of(header.switch.watch) in Pages()
    assert topic_of(stage.studio.program.tree) in Pages()


def test_every_link_between_pages_leads_somewhere() -> None:
    pages = Pages()
    links = [link for text in pages.values() for link in re.findall(r"\(page:([^)]+)\)", text)]
    assert links
    assert all(link.replace("%20", " ") in pages for link in links)
