"""Stick and gamepad in the jog panel: the pad is pretended at its seam, the machine is simulated behind its line."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from device.gamepad import INSTALL, NONE, Held, PadMissing
from tests.long import count
from tests.stage import Stage
from tests.widgets.jog.test_jog import LEFT, at, make_table, moving, ready, still
from widgets.jog.drive import ALONE, PAD_HELP, DrivePage


@dataclass
class HandPad:
    """A pad in the hands of the test."""

    held: Held | None = None

    def read(self) -> Held | None:
        return self.held

    def push(self, x: float, y: float = 0.0, dead_man: bool = True) -> None:
        self.held = Held(x, y, dead_man)

    def close(self) -> None:
        self.held = None


@pytest.fixture
def pad() -> HandPad:
    return HandPad(Held(0.0, 0.0, False))


@pytest.fixture
def stage(qapp: QApplication, tmp_path: Path, pad: HandPad) -> Iterator[Stage]:
    made = make_table(tmp_path)
    made.studio.at_machine.pads.opened = lambda: pad
    yield made
    made.clear_away()


def stick_page(stage: Stage) -> DrivePage:
    """The page of the stick, at 10 mm/s when fully pushed."""
    ready(stage)
    panel = stage.studio.at_machine.jog
    stage.studio.window.activateWindow()
    panel.buttons[3].click()
    assert panel.drive is not None
    QTest.mouseClick(panel.drive.pace.buttons["medium"], LEFT)
    stage.go(3)
    return panel.drive


def held_for(stage: Stage, ticks: int) -> None:
    for _ in range(ticks):
        stage.go(1)
        stage.studio.at_machine.jog.holder.renew()


def held_until(stage: Stage, true: Callable[[], object]) -> None:
    """Time passes until it is true, while something is held; a slow line needs some to begin."""
    end = stage.clock.now + 5
    while not true():
        assert stage.clock.now < end
        held_for(stage, 1)


def speed(stage: Stage, axis: str = "X") -> float:
    """Commanded, counts/s, from two places 0.2 s apart."""
    before, began = at(stage, axis), stage.clock.now
    held_for(stage, 6)
    return (at(stage, axis) - before) / (stage.clock.now - began)


def test_the_pad_drives_as_fast_as_it_is_pushed_while_its_button_is_down(stage: Stage, pad: HandPad) -> None:
    page = stick_page(stage)
    assert page.pad.text() == PAD_HELP
    pad.push(1.0, dead_man=False)
    held_for(stage, 15)
    assert at(stage) == 0  # nobody holds the button
    pad.push(0.1)
    held_for(stage, 10)
    assert at(stage) == 0  # in the dead zone
    pad.push(1.0)
    held_until(stage, lambda: at(stage) > 5000)
    assert speed(stage) == pytest.approx(10_000, rel=0.05)
    pad.push(0.575)  # half of the way from the dead zone (0.15) to the end
    held_for(stage, 25)
    assert speed(stage) == pytest.approx(5000, rel=0.05)
    pad.push(0.575, 0.0, dead_man=False)
    held_for(stage, 12)
    assert not moving(stage)
    assert "ran on" in still(stage).result.text()
    pad.push(-0.9, 1.0)
    held_until(stage, lambda: moving(stage, "Y") and (moving(stage) or stage.controller.motion.alone))
    pad.held = None  # unplugged
    held_for(stage, 14)
    assert not moving(stage) and not moving(stage, "Y")
    assert page.pad.text() == NONE


TAKEN = ("STOP", "panel", "window", "page", "Watch")


def test_whatever_takes_the_page_away_stops_and_a_pushed_pad_starts_nothing(
    stage: Stage, pad: HandPad, monkeypatch: pytest.MonkeyPatch
) -> None:
    stick_page(stage)
    for how in TAKEN[: count(3, len(TAKEN))]:
        pad.push(0.0)
        held_for(stage, 4)
        pad.push(1.0)
        held_until(stage, lambda: moving(stage))
        with monkeypatch.context() as patch:
            _take(stage, how, patch)
            held_for(stage, 14)
            assert not moving(stage), how
            stopped_at = at(stage)
        _give_back(stage, how)
        held_for(stage, 20)
        assert at(stage) == stopped_at, how  # still pushed: it has to go through its middle first


def _take(stage: Stage, how: str, patch: pytest.MonkeyPatch) -> None:
    panel = stage.studio.at_machine.jog
    if how == "page":
        panel.buttons[0].click()
    elif how == "panel":
        stage.studio.desk.bring("Display")
    elif how == "STOP":
        stage.controller.stop()
    elif how == "Watch":
        stage.controller.release_control()
    else:
        patch.setattr(type(panel), "isActiveWindow", lambda _: False)


def _give_back(stage: Stage, how: str) -> None:
    if how == "page":
        stage.studio.at_machine.jog.buttons[3].click()
    elif how == "panel":
        stage.studio.desk.bring("Jog")
    elif how == "Watch":
        stage.controller.take_control()


def test_the_stick_on_the_screen_moves_two_axes_and_only_one_hand_holds(stage: Stage, pad: HandPad) -> None:
    page = stick_page(stage)
    middle = QPoint(page.stick.width() // 2, page.stick.height() // 2)
    QTest.mousePress(page.stick, LEFT, pos=middle)
    QTest.mouseMove(page.stick, middle + QPoint(300, -300))
    if stage.controller.motion.alone:  # 9600 baud
        held_until(stage, lambda: at(stage) > 100)
        assert at(stage, "Y") == 0 and page.problem.text() == ALONE
    else:
        held_until(stage, lambda: at(stage) > 100 and at(stage, "Y") > 100)
        assert set(stage.controller.motion.ghost) == {"X", "Y"} and page.problem.text() == ""
    pad.push(-1.0)  # the stick has it
    held_for(stage, 5)
    assert stage.studio.at_machine.jog.holder.owner == "stick"
    QTest.mouseRelease(page.stick, LEFT, pos=middle)
    held_for(stage, 12)
    assert not moving(stage) and not moving(stage, "Y")
    places = at(stage), at(stage, "Y")
    held_for(stage, 10)
    assert (at(stage), at(stage, "Y")) == places  # the pad was pushed all the time: it begins in its middle
    pad.push(0.0)
    held_for(stage, 3)
    page.stick.setFocus()
    QTest.keyPress(page.stick, Qt.Key.Key_Left)
    held_until(stage, lambda: moving(stage))
    held_for(stage, 10)
    assert not moving(stage, "Y")
    QTest.keyRelease(page.stick, Qt.Key.Key_Left)
    still(stage)
    assert at(stage) < places[0] and at(stage, "Y") == places[1]


def test_without_the_optional_part_the_page_says_how_to_get_it(stage: Stage) -> None:
    def missing() -> HandPad:
        raise PadMissing(INSTALL)

    page = stick_page(stage)
    stage.studio.at_machine.pads.close()
    stage.studio.at_machine.pads.opened = missing
    stage.go(3)
    assert page.pad.text() == INSTALL
