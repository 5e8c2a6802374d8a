"""What comes between a capture and its end: another's RC 0, TM, arrays taken away, a cut line, a hand that is early."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path

import numpy as np
import pytest

from device.api import State
from device.capture import Channel, Plan, Trigger, When
from device.capturing import CaptureJob, capture
from device.tasks import LinkError, NotAllowed
from device.tuning.bench import Wish
from device.tuning.loop import Gains
from device.tuning.run import run_step
from tests.device.test_capture import COMMANDED, INPUTS, POSITION, captured, done, moving
from tests.rig import Rig

EDGE = Trigger(When.INPUT, number=1, rising=False, pre=0.5)
WAITING = "waiting: when input 1 goes off"


def waiting(rig: Rig, channels: tuple[Channel, ...] = (POSITION, INPUTS)) -> CaptureJob:
    """Round and round, 4 samples a value (3.9 ms), 200 values (0.78 s), until input 1 goes off."""
    job = capture(rig.controller, Plan(channels, 2, 200, EDGE))
    rig.until(lambda: job.phase == WAITING)
    return job


def test_an_edge_right_behind_the_start_is_one() -> None:
    """What the input was before the recording began is known: nothing is waited for that has happened."""
    rig = moving()
    job = waiting(rig)
    rig.simulation.stimulus("in1", 0)
    found = done(rig, job)
    bits = found.of(INPUTS).astype(int) & 1
    assert found.early == 0 and not bits[found.trigger] and bits[: found.trigger].all()


def test_an_input_that_is_off_already_is_waited_for_until_it_goes_off_again() -> None:
    rig = moving()
    rig.simulation.stimulus("in1", 0)
    job = waiting(rig)
    rig.run(1.0)
    assert not job.future.done()
    rig.simulation.stimulus("in1", 1)
    rig.run(0.4)
    rig.simulation.stimulus("in1", 0)
    found = done(rig, job)
    bits = found.of(INPUTS).astype(int) & 1
    assert bits[found.trigger - 1] and not bits[found.trigger]


@pytest.mark.parametrize("who", ["the person", "somebody else"])
def test_what_ends_before_the_trigger_does_not_claim_one(who: str) -> None:
    rig = moving()
    job = waiting(rig)
    rig.run(1.0)
    if who == "the person":
        job.finish()
    else:
        rig.type("RC 0")  # by hand, or a program that began meanwhile
    found = done(rig, job)
    assert found.trigger_text == "ended before it came (when input 1 goes off)" and not found.complete
    assert found.count > 150 and found.times[-1] < 0  # all of it is from before
    assert rig.simulation.state()["arrays"] == {}


def test_a_sample_time_that_was_changed_meanwhile_is_said() -> None:
    """The times are TM/1 024 000 s a sample; half of this record was taken at another TM."""
    rig = moving()
    job = capture(rig.controller, Plan((POSITION,), 3, 60))
    rig.until(lambda: job.phase == "recording")
    rig.type("TM 2000")
    words = "TM was changed from 1000 to 2000 while this was recorded: its times are not right."
    assert done(rig, job).note == words
    assert captured(rig, Plan((POSITION,), 1, 10)).note == ""


def test_a_ring_that_a_cut_line_left_is_ended_by_the_next_capture() -> None:
    """It would record for ever, and every later capture would be told to wait for its end."""
    rig = moving()
    job = waiting(rig, (POSITION, COMMANDED))
    rig.cut()
    rig.until(job.future.done, 30)
    rig.loopback.unplugged = False
    rig.run(1.0)
    assert rig.simulation.unit.state.recording.circular
    assert captured(rig, Plan((POSITION,), 1, 10)).complete
    assert rig.simulation.state()["arrays"] == {}
    rig.type("DM MINE[50]", "RA MINE[]", "RD _TPX", "RC 8,-50")
    with pytest.raises(NotAllowed, match="is recording already"):
        captured(rig, Plan((POSITION,), 1, 10))
    assert rig.simulation.unit.state.recording.interval  # goes on: it is the person's


def test_arrays_that_are_gone_are_named() -> None:
    """As after a reset, or when somebody frees them all; what was read before is kept."""
    rig = moving()
    job = capture(rig.controller, Plan((POSITION, COMMANDED), 4, 200))
    rig.until(lambda: (part := job.partial()) is not None and part.count > 20, 10)
    rig.type("DA *[0]")
    with pytest.raises(LinkError, match=r"was it reset\?"):
        done(rig, job)
    part = job.partial()
    assert part is not None and np.isfinite(part.values[0]).any()


def test_the_tuner_does_not_take_a_capture_its_arrays(tmp_path: Path) -> None:
    """One recording at a time: each names what is under way, and that goes on."""
    rig = moving()
    job = waiting(rig)
    now, wish = datetime(2026, 11, 23), Wish("X", 300, Gains(kp=20, ki=0, kd=150, fv=0, fa=0), 5.0, 0.25)
    step = run_step(rig.controller, wish, tmp_path, now)
    with pytest.raises(NotAllowed, match="Not started: a capture is under way"):
        rig.result(step.future)
    assert not job.future.done() and not list(tmp_path.iterdir())
    rig.run(0.8)
    rig.simulation.stimulus("in1", 0)
    found = done(rig, job)
    assert found.complete and not int(found.of(INPUTS)[found.trigger]) & 1
    step = run_step(rig.controller, wish, tmp_path, now)
    rig.run(0.6)
    with pytest.raises(NotAllowed, match="Not captured: axis X is being tuned"):
        captured(rig, Plan((POSITION,), 1, 40))
    rig.until(step.future.done)
    assert step.future.result().metrics is not None
    assert captured(rig, Plan((POSITION,), 1, 40)).complete


def test_arrays_of_a_capture_are_not_burned() -> None:
    """BV keeps array values (dmc-1412-1414.txt l.3213)."""
    rig = moving()
    job = waiting(rig)
    with pytest.raises(NotAllowed, match="Not burned: a capture is under way"):
        rig.result(rig.controller.ask("BV"))
    job.cancel()
    rig.until(job.future.done)
    assert rig.result(rig.controller.ask("BV")).accepted


def test_another_recording_that_a_person_begins_meanwhile_ends_it() -> None:
    rig = moving()
    job = waiting(rig)
    rig.type("RC 0", "DM LONG[2000]", "RA LONG[]", "RD _TPX", "RC 1,-2000")
    rig.run(2.0)
    rig.simulation.stimulus("in1", 0)
    with pytest.raises(LinkError, match="somebody else has begun another recording"):
        done(rig, job)
    assert rig.controller.state is State.READY
