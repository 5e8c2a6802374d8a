"""What an interrupted step left is offered also where the line was disturbed while the controller was met."""

from __future__ import annotations

from datetime import datetime

from app.former_offer import STEP
from codegen.twoletter.fixed import ONE
from device.former import Former, keep, left_behind
from tests.stage import Stage
from widgets.parts.question import Question

WHEN = datetime(2026, 5, 4, 10, 30).isoformat()
TRIES = 2  # how often the number is asked for when a controller is met


def test_a_serial_number_that_was_not_heard_is_asked_again(stage: Stage) -> None:
    folder = stage.studio.data / "commissioning"
    keep(Former("X", "ssc2", 1, "machine", "the press", WHEN, 0, {"ER": 900 * ONE}, folder / "left.before-tuning"))
    rig = stage.connect("machine", "ssc2", answers=False)
    write, lost = rig.loopback.write, []

    def disturbed(data: bytes) -> int:
        if b"_BN" in data and len(lost) < TRIES:
            lost.append(data)
            return len(data)
        return write(data)

    rig.loopback.write = disturbed  # type: ignore[method-assign]
    assert stage.studio.at_machine
    stage.until(lambda: any(each.isVisible() for each in stage.studio.window.findChildren(Question)))
    assert len(lost) == TRIES
    question = next(each for each in stage.studio.window.findChildren(Question) if each.isVisible())
    assert question.windowTitle() == STEP.title
    question.buttons["Take Control and put them back"].click()
    stage.until(lambda: not left_behind(folder))
    assert rig.simulation.unit.state.registers["ER"][0] == 900 * ONE
