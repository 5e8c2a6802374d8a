"""STOP: F12 and the button, in every state the windows can be in."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from PySide6.QtCore import QEvent, QObject, QPoint, Qt, QTimer
from PySide6.QtGui import QKeyEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QComboBox, QDialog, QFileDialog, QLineEdit, QMessageBox, QWidget

from app.background import in_background
from device.api import Kind, State, StopState
from tests.rig import Rig
from tests.stage import ASKS, Stage


def press_f12(widget: QWidget | None = None) -> None:
    """The key as the window system delivers it."""
    target = widget or QApplication.activePopupWidget() or QApplication.activeModalWidget()
    target = target or QApplication.focusWidget() or QApplication.activeWindow()
    assert target is not None
    QTest.keyClick(target, Qt.Key.Key_F12)


def machine(stage: Stage) -> Rig:
    """A machine in Watch whose X axis jogs."""
    rig = stage.connect("machine", scene="jogging")
    assert rig.moving == ["X"]
    assert rig.stops == []
    return rig


def stopped_once(stage: Stage) -> bool:
    """One stop has left, and it was enough: no axis is commanded, no program runs."""
    rig = stage.rig
    stage.until(lambda: rig.controller.stop_state is StopState.STOPPED)
    return rig.stops == ["ST"] and rig.moving == [] and rig.running == []


def _welcome(stage: Stage) -> QWidget:
    stage.studio.start.look()
    return stage.studio.start.welcome_window()


def _serial(stage: Stage) -> QWidget:
    stage.studio.start.show_serial()
    assert stage.studio.start.serial is not None
    return stage.studio.start.serial


def _setup(stage: Stage) -> QWidget:
    stage.studio.setup.show()
    assert stage.studio.setup.window is not None
    return stage.studio.setup.window


def _settings(stage: Stage) -> QWidget:
    stage.studio.options.show()
    assert stage.studio.options.page is not None
    return stage.studio.options.page


def _question(stage: Stage) -> QWidget:
    stage.studio.desk.ask("Sure?", "Really?", [("Yes", lambda: None)])
    assert stage.studio.desk.question is not None
    return stage.studio.desk.question


def _upload(stage: Stage) -> QWidget:
    stage.studio.desk.show_upload("EN\n")
    assert stage.studio.desk.upload is not None
    return stage.studio.desk.upload


def _help(stage: Stage) -> QWidget:
    stage.studio.desk.show_help("Program window")
    assert stage.studio.desk.help is not None
    return stage.studio.desk.help


def _file_dialog(stage: Stage) -> QWidget:
    stage.studio.files.open()
    return stage.studio.window.findChildren(QFileDialog)[-1]


def _terminal(stage: Stage) -> QWidget:
    stage.studio.desk.bring("Terminal")
    stage.studio.terminal.line.setFocus()
    stage.studio.terminal.line.setText("PR 100")
    return stage.studio.terminal.line


def _backups(stage: Stage) -> QWidget:
    stage.studio.proof.backups.show()
    assert stage.studio.proof.backups.window is not None
    return stage.studio.proof.backups.window.note


def _replacing(stage: Stage) -> QWidget:
    stage.studio.proof.backups.show()
    stage.studio.proof.backups.show_replacing()
    assert stage.studio.proof.backups.replacing is not None
    return stage.studio.proof.backups.replacing


def _compare(stage: Stage) -> QWidget:
    stage.studio.proof.comparing.show()
    assert stage.studio.proof.comparing.window is not None
    return stage.studio.proof.comparing.window.tables["Program"]


def _handover(stage: Stage) -> QWidget:
    stage.studio.proof.handing.show()
    assert stage.studio.proof.handing.page is not None
    return stage.studio.proof.handing.page.changes


def _commissioning(stage: Stage) -> QWidget:
    stage.studio.commissioning.show()
    assert stage.studio.commissioning.window is not None
    return stage.studio.commissioning.window.steps


def _prompt(stage: Stage) -> QWidget:
    rig = stage.question()
    assert rig.running == [ASKS]
    stage.go()
    return stage.studio.window.prompt.line


def _scope(stage: Stage) -> QWidget:
    stage.studio.actions["scope"].trigger()
    stage.go()
    return stage.studio.at_machine.curves.body.choices.count


def _tuner(stage: Stage) -> QWidget:
    stage.studio.actions["tune"].trigger()
    stage.go()
    return stage.studio.at_machine.tuning.panel.manual.gains.fields["KP"]


def _floating(stage: Stage) -> QWidget:
    stage.studio.window.docks["Display"].setFloating(True)
    stage.go()
    return stage.studio.window.docks["Display"]


PLACES: dict[str, Callable[[Stage], QWidget]] = {
    "the window": lambda stage: stage.studio.window,
    "the program": lambda stage: stage.studio.program.tree,
    "the welcome window": _welcome,
    "the serial setup": _serial,
    "the setup": _setup,
    "the settings": _settings,
    "a question": _question,
    "an upload": _upload,
    "the back-ups": _backups,
    "the steps to replace": _replacing,
    "the comparison": _compare,
    "the handover": _handover,
    "the list that brings an axis to life": _commissioning,
    "help": _help,
    "a file dialog": _file_dialog,
    "a half-typed command": _terminal,
    "the answer to a program": _prompt,
    "a floating panel": _floating,
    "the scope": _scope,
    "the tuner": _tuner,
}


@pytest.mark.parametrize("place", PLACES)
def test_f12_stops_from(place: str, stage: Stage) -> None:
    machine(stage)
    widget = PLACES[place](stage)
    assert stage.rig.moving or stage.rig.running
    QApplication.processEvents()
    press_f12(widget)
    assert stopped_once(stage)


def test_f12_stops_inside_a_modal_dialog(stage: Stage) -> None:
    machine(stage)
    box = QMessageBox(stage.studio.window)
    box.setText("modal")
    seen: list[bool] = []

    def press() -> None:
        press_f12(box)
        seen.append(stopped_once(stage))
        box.accept()

    QTimer.singleShot(0, press)
    box.exec()
    assert seen == [True]


def test_f12_stops_while_a_menu_is_open(stage: Stage) -> None:
    machine(stage)
    menu = stage.studio.window.header.menus.actions()[0].menu()
    menu.popup(QPoint(10, 10))  # type: ignore[union-attr]
    press_f12(menu)  # type: ignore[arg-type]
    assert stopped_once(stage)
    menu.close()  # type: ignore[union-attr]


def test_f12_stops_while_a_choice_is_open(stage: Stage) -> None:
    machine(stage)
    serial = _serial(stage)
    box = serial.findChildren(QComboBox)[0]
    box.showPopup()
    press_f12(box.view())
    assert stopped_once(stage)
    box.hidePopup()


class Greedy(QObject):
    """Swallows every key, as the filter of a running drag does."""

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        return isinstance(event, QKeyEvent)


def test_f12_stops_during_a_drag(stage: Stage, qapp: QApplication) -> None:
    machine(stage)
    greedy = Greedy()
    qapp.installEventFilter(greedy)
    try:
        stage.go(1)  # the tick goes on during a drag
        press_f12(stage.studio.program.tree)
        assert stopped_once(stage)
    finally:
        qapp.removeEventFilter(greedy)


def test_f12_stops_after_a_tick_that_failed(stage: Stage) -> None:
    machine(stage)

    def fail() -> None:
        raise RuntimeError("in a tick")

    stage.studio.tick.when_done(in_background(lambda: None), lambda _: fail())
    with pytest.raises(RuntimeError):
        stage.until(lambda: False)
    press_f12(stage.studio.window)
    assert stopped_once(stage)


def test_f12_stays_away_after_the_end_even_where_that_comes_in_a_tick(stage: Stage) -> None:
    machine(stage)
    with stage.studio.stop_key.aside():
        stage.studio.stop_key.remove()
    press_f12(stage.studio.window)
    stage.go(3)
    assert stage.rig.stops == []


def test_f12_stops_while_a_name_is_edited_in_place(stage: Stage) -> None:
    machine(stage)
    line = next(each for each in stage.studio.program.findChildren(QLineEdit) if each.isVisible() and each.isEnabled())
    line.setFocus()
    QTest.keyClicks(line, "AB")
    press_f12(line)
    assert stopped_once(stage)


def test_holding_f12_down_is_one_stop(stage: Stage) -> None:
    machine(stage)
    window = stage.studio.window
    for repeated in (False, True, True):
        event = QKeyEvent(QEvent.Type.KeyPress, Qt.Key.Key_F12, Qt.KeyboardModifier.NoModifier, "", repeated)
        QApplication.sendEvent(window, event)
    assert stopped_once(stage)


@pytest.mark.parametrize("modifier", [Qt.KeyboardModifier.ShiftModifier, Qt.KeyboardModifier.ControlModifier])
def test_f12_stops_with_a_modifier_held(stage: Stage, modifier: Qt.KeyboardModifier) -> None:
    machine(stage)
    QTest.keyClick(stage.studio.window, Qt.Key.Key_F12, modifier)
    assert stopped_once(stage)


def test_a_second_press_is_a_second_stop(stage: Stage) -> None:
    machine(stage)
    press_f12(stage.studio.window)
    stage.until(lambda: stage.rig.stops == ["ST"])
    assert stage.controller.stop_state is StopState.STOPPING
    press_f12(stage.studio.window)
    stage.until(lambda: stage.controller.stop_state is StopState.STOPPED)
    assert stage.rig.stops == ["ST", "AB"]
    assert stage.rig.moving == []


@pytest.mark.parametrize("layout", ["Program", "Run"])
def test_the_button_is_visible_in_every_layout_and_acts_when_pressed(stage: Stage, layout: str) -> None:
    machine(stage)
    stage.studio.desk.arrange(layout)
    stage.go()
    button = stage.studio.window.header.stop
    assert button.isVisible()
    assert button.visibleRegion().boundingRect() == button.rect()
    QTest.mousePress(button, Qt.MouseButton.LeftButton)
    assert stopped_once(stage)
    QTest.mouseRelease(button, Qt.MouseButton.LeftButton)
    stage.go(10)
    assert stopped_once(stage)


@pytest.mark.parametrize("key", [Qt.Key.Key_Space, Qt.Key.Key_Return])
def test_the_button_works_by_keyboard(stage: Stage, key: Qt.Key) -> None:
    machine(stage)
    QTest.keyClick(stage.studio.window.header.stop, key)
    assert stopped_once(stage)


def test_the_button_keeps_its_place_when_the_window_is_narrow(stage: Stage) -> None:
    stage.studio.window.resize(1024, 700)
    stage.go()
    button = stage.studio.window.header.stop
    assert button.visibleRegion().boundingRect() == button.rect()


def test_a_floating_panel_that_moves_something_has_its_own_stop(stage: Stage) -> None:
    for title in ("Display", "Terminal", "Simulator"):
        machine(stage)
        dock = stage.studio.window.docks[title]
        dock.setFloating(True)
        stage.go()
        assert dock.stop_button is not None
        assert dock.stop_button.isVisible()
        QTest.mousePress(dock.stop_button, Qt.MouseButton.LeftButton)
        assert stopped_once(stage)
        QTest.mouseRelease(dock.stop_button, Qt.MouseButton.LeftButton)


WORDS: dict[StopState, tuple[str, str]] = {
    StopState.READY: ("STOP", "MACHINE · ready"),
    StopState.STOPPING: ("STOP", "MACHINE · stopping…"),
    StopState.STOPPED: ("STOP", "MACHINE · stopped (confirmed)"),
    StopState.NOT_CONFIRMED: ("NOT CONFIRMED", "use the machine's emergency stop"),
    StopState.NO_LINK: ("STOP", "MACHINE · no link"),
}


def _ready(stage: Stage) -> None:
    machine(stage)


def _stopping(stage: Stage) -> None:
    machine(stage)
    press_f12(stage.studio.window)
    stage.go(1)


def _stopped(stage: Stage) -> None:
    machine(stage)
    press_f12(stage.studio.window)
    assert stopped_once(stage)


def _not_confirmed(stage: Stage) -> None:
    machine(stage).cut()
    press_f12(stage.studio.window)
    stage.later(0.6)  # 0.5 s without an answer


def _no_link(stage: Stage) -> None:
    rig = stage.connect("machine", answers=False, openable=False)
    stage.until(lambda: rig.controller.state is State.LOST)


SITUATIONS: dict[StopState, Callable[[Stage], None]] = {
    StopState.READY: _ready,
    StopState.STOPPING: _stopping,
    StopState.STOPPED: _stopped,
    StopState.NOT_CONFIRMED: _not_confirmed,
    StopState.NO_LINK: _no_link,
}


@pytest.mark.parametrize("state", list(StopState))
def test_the_button_says_what_has_become_of_the_stop(stage: Stage, state: StopState) -> None:
    SITUATIONS[state](stage)
    stage.studio.tick.once()
    button = stage.studio.window.header.stop
    assert stage.controller.stop_state is state
    assert button.words == WORDS[state]
    assert button.accessibleDescription() == " - ".join(WORDS[state])


@pytest.mark.parametrize("kind", list(Kind))
def test_window_button_status_bar_and_panels_say_what_is_connected(stage: Stage, kind: Kind) -> None:
    if kind is Kind.OFFLINE:
        stage.studio.connection.go_offline()
    else:
        stage.connect(kind.value, answers=kind is not Kind.REPLAY)
    stage.go()
    word, window = kind.value.upper(), stage.studio.window
    assert word in window.windowTitle()
    assert word in window.header.stop.words[1]
    assert window.status.badge.text == word
    assert window.header.switch.badge.text == word
    for title in ("Display", "Terminal", "Simulator"):
        frame = window.docks[title].frame
        assert frame is not None
        assert frame.text == word


def test_no_word_of_ours_calls_it_an_emergency_stop(stage: Stage) -> None:
    assert stage.studio.at_machine.panels
    widgets: list[Any] = stage.studio.window.findChildren(QWidget)
    for widget in widgets:
        for text in (widget.toolTip(), widget.accessibleName(), widget.windowTitle()):
            low = text.lower().replace("machine's emergency stop", "").replace("is not an emergency stop", "")
            assert "emergency stop" not in low


def test_dialogs_of_the_studio_are_never_modal(stage: Stage) -> None:
    for make in (_welcome, _serial, _setup, _settings, _question, _upload, _help, _file_dialog):
        dialog = make(stage)
        assert isinstance(dialog, QDialog)
        assert not dialog.isModal()
