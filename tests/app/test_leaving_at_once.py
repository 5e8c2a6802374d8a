"""Leaving at once in the middle of a run of the tuner: the axis stands; its former values come with the next start."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from app.connection import Opened
from device.former import left_behind
from tests.app.spot import press
from tests.app.test_tuner import GAINS, asked, click, held, tuner, typed
from tests.rig import Rig
from tests.stage import Stage, make_studio
from widgets.tuner.panel import AUTOMATIC, MANUAL, MODEL, TunerPanel

PAGES = (MANUAL, AUTOMATIC, MODEL)
WAYS = [(MANUAL, 2), (MODEL, 24)]
WAYS += [pytest.param(page, ticks, marks=pytest.mark.long) for page in PAGES for ticks in range(0, 60, 2)]
TICKS_S = 1_024_000


@pytest.fixture
def again(stage: Stage, tmp_path: Path) -> Iterator[Callable[[], Stage]]:
    """The next start, with the same machine at the port."""
    made: list[Stage] = []

    def start() -> Stage:
        rig = stage.rig
        made.append(make_studio(tmp_path, example=""))
        next_one, studio = made[-1], made[-1].studio
        studio.window.show()
        there = next_one.clock.add(Rig("machine", "ssc1", there=rig.simulation, began=next_one.clock.now))
        studio.connection.adopt(Opened(there.controller), "machine")
        return next_one

    yield start
    for each in made:
        each.clear_away()


def begin(stage: Stage, panel: TunerPanel, page: int) -> None:
    """A run of this page with other gains, as a person starts it."""
    typed(panel.manual.gains.fields["KP"], "11")
    click(panel.buttons[page])
    panel.box.drive.setCurrentIndex(1)  # current: nothing is tried to find that out
    stage.until(lambda: panel.box.words.text().startswith("X moves by"))
    click(panel.box.free)
    stage.go()
    click(panel.box.begin)
    stage.go(1)
    assert panel.running


@pytest.mark.parametrize(("page", "ticks"), WAYS)
def test_nothing_moves_on_and_former_gains_are_offered(
    stage: Stage, again: Callable[[], Stage], page: int, ticks: int
) -> None:
    panel = tuner(stage, "machine")
    simulation, folder = stage.rig.simulation, stage.studio.at_machine.tuning.tuner.folder
    begin(stage, panel, page)
    stage.go(ticks)
    assert panel.running
    stage.studio.actions["exit"].trigger()
    stage.until(lambda: asked(stage) is not None)
    question = asked(stage)
    assert question is not None and "is not finished" in question.words
    press(question.buttons["Leave at once"])
    stage.until(lambda: not stage.studio.window.isVisible())
    stage.studio.close()
    stage.studio.close = lambda: None  # type: ignore[method-assign]
    stands(simulation)
    left = left_behind(folder)
    registers = simulation.unit.state.registers
    assert left or held(stage.rig) == GAINS
    if left:
        differ = [name for name, value in left[0].values.items() if registers[name][0] != value]
        offered(again(), folder, differ)
        now = {name: registers[name][0] for name in left[0].values}
        assert now == pytest.approx(dict(left[0].values), abs=20)  # TL and IL in steps of 20 V / 65536
    assert held(stage.rig) == GAINS and not stage.rig.moving


def stands(simulation: object) -> None:
    """After its deceleration nothing is commanded to move, and where it is commanded to be it stays."""
    simulation.advance(TICKS_S // 2)
    before = simulation.state()["axes"]["X"]
    assert not before["moving"] and before["motor_on"]
    simulation.advance(TICKS_S)
    after = simulation.state()["axes"]["X"]
    assert not after["moving"] and after["motor_on"] and after["commanded"] == before["commanded"]
    assert abs(after["actual"] - after["commanded"]) <= 2


def offered(stage: Stage, folder: Path, differ: list[str]) -> None:
    """First thing, and one click puts them back."""
    stage.until(lambda: asked(stage) is not None, 30)
    question = asked(stage)
    assert question is not None and "tuning of axis X" in question.words
    _, _, before = question.words.partition("Before it: ")
    assert differ and all(f"{name} " in before for name in differ)
    press(question.buttons["Take Control and put them back"])
    stage.until(lambda: not left_behind(folder))
