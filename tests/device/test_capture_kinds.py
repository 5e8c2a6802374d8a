"""Every kind of value that a controller records, and a ring that has turned, beside what the machine itself did."""

from __future__ import annotations

import numpy as np
import pytest

from device.capture import Capture, Channel, Plan, Trigger, When
from device.capturing import capture
from device.simulator.plant import Plant
from tests.device.test_capture import COMMANDED, POSITION, Trace, done, moving
from tests.long import count
from tests.rig import LINE, Rig

SLOW = LINE.baud is not None and LINE.baud < 19_200  # a tenth of a short ring goes by with each look
AUXILIARY, LATCH, CODE, SWITCHES = (Channel(what, "X") for what in ("auxiliary", "latch", "stop_code", "switches"))
INPUTS, OUTPUTS, FIRST, SECOND = Channel("inputs"), Channel("outputs"), Channel("analog", "X"), Channel("analog", "Y")


def between(rig: Rig, plan: Plan, *happens: tuple[str, float]) -> Capture:
    """A capture at once; something happens to the machine after 0.1 s, 0.2 s and so on."""
    job = capture(rig.controller, plan)
    rig.until(lambda: rig.simulation.unit.state.recording.interval)
    for signal, value in happens:
        rig.run(0.1)
        rig.simulation.stimulus(signal, value)
    return done(rig, job)


def stretches(row: np.ndarray) -> list[float]:
    """The values that follow each other, without repetitions."""
    return [float(row[0]), *(float(each) for each in row[1:][row[1:] != row[:-1]])]


def test_second_encoder_latch_switches_and_stop_code() -> None:
    """_TS: bits 3 and 2 limits not active, 1 home, 0 latched (commands.md, TS); stop code 1: at rest."""
    rig = moving(plants={"X": Plant(auxiliary="external")})
    rig.type("DP 500", "DE 5", "AL X")
    happens = (("aux_x", 1234), ("fls_x", 0), ("in1", 0))
    found = between(rig, Plan((AUXILIARY, LATCH, SWITCHES, CODE), 2, 140), *happens)
    assert found.complete and [stretches(found.of(each)) for each in found.channels] == [
        [5, 5 + 1234], [0, 500], [0b1110, 0b0110, 0b0111], [1]
    ]  # fmt: skip
    at = [
        int(np.flatnonzero(np.diff(found.of(each)))[place])
        for each, place in ((AUXILIARY, 0), (SWITCHES, 0), (LATCH, 0))
    ]
    np.testing.assert_allclose(np.diff(at) * found.interval_s, 0.1, atol=2 * found.interval_s)


def test_inputs_outputs_and_voltages() -> None:
    rig = moving()
    rig.type("OP 5")
    rig.simulation.stimulus("an1", 1.25)
    rig.simulation.stimulus("an2", -2.5)
    found = between(rig, Plan((INPUTS, OUTPUTS, FIRST, SECOND), 2, 140), ("in2", 0), ("an1", 3.75), ("in2", 1))
    assert stretches(found.of(INPUTS)) == [0xFF, 0xFD, 0xFF]  # input 2 is bit 1
    assert set(found.of(OUTPUTS)) == {5.0}
    step = 20 / 4096  # V, of a converter of 12 bits over ±10 V
    np.testing.assert_allclose(stretches(found.of(FIRST)), [1.25, 3.75], atol=step)
    np.testing.assert_allclose(found.of(SECOND), -2.5, atol=step)


@pytest.mark.parametrize("tm", [1000, 500][: count(1, 2)])
def test_a_ring_that_has_turned_holds_the_very_samples_in_their_order(tm: int) -> None:
    """Element n is the sample 8 (n - trigger) from the first recorded one that moves, whatever was turned over."""
    rig = moving()
    rig.type(f"TM {tm}")
    trace = Trace(rig)
    size = 75 * 1000 // tm
    job = capture(rig.controller, Plan((POSITION, COMMANDED), 3, size, Trigger(When.MOTION, axis="X", pre=0.3)))
    rig.until(lambda: job.phase.startswith("waiting:"))
    rig.run(0.65)  # once round
    rig.type("PR 3000;BG X")
    found = done(rig, job)
    assert found.complete and found.early == 0 and found.interval_s == 8 * tm / 1_024_000
    moved = next(sample for sample in sorted(trace.samples) if trace.samples[sample][1] != 0)
    grid = moved + (trace.began - moved) % 8  # the first sample from there that is recorded
    samples = [grid + 8 * (n - found.trigger) for n in range(found.count)]
    np.testing.assert_array_equal(found.values, np.array([trace.samples[each][:2] for each in samples]).T)
    assert found.times[found.trigger] == 0.0 and found.times[0] == pytest.approx(-found.trigger * 8 * tm / 1_024_000)
    if not SLOW:
        assert found.trigger >= 0.3 * size  # no less than what was asked for from before, and most is from behind
    assert found.count - found.trigger >= 0.4 * size
