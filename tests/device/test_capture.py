"""A capture holds what the simulated controller had at those very samples, and disturbs nothing on its way."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from codegen.models import MODELS
from device.capture import Capture, Channel, Plan, Trigger, When, channels, objection
from device.capturing import CaptureJob, capture
from device.stop import StopState
from device.tasks import LinkError, NotAllowed, Refused
from device.transport import LineSettings
from tests.long import count
from tests.rig import Rig

POSITION, COMMANDED = Channel("position", "X"), Channel("commanded", "X")
ERROR, TORQUE, INPUTS = Channel("error", "X"), Channel("torque", "X"), Channel("inputs")
MOVE = "PR 2000;BG X"


def moving(model: str = "ssc2", **more: object) -> Rig:
    """A machine with its motor on, ready to move quickly."""
    rig = Rig(model=model, **more).ready()  # type: ignore[arg-type]
    rig.type("SH X", "SP 20000", "AC 256000", "DC 256000")
    return rig


def captured(rig: Rig, plan: Plan) -> Capture:
    return done(rig, capture(rig.controller, plan))


def done(rig: Rig, job: CaptureJob) -> Capture:
    rig.until(job.future.done, 300)
    return job.future.result()


class Trace:
    """What every sample had: time is cut into single samples, and each is looked at from outside."""

    def __init__(self, rig: Rig) -> None:
        simulation, self.samples = rig.simulation, dict[int, tuple[float, ...]]()
        self.began = 0
        advance = simulation.advance

        def slowly(ticks: int) -> None:
            end = simulation.ticks + ticks
            clock, motion = simulation.unit.clock, simulation.unit.motion
            while simulation.ticks < end:
                advance(min(clock.tick_of(clock.sample + 1) - simulation.ticks, end - simulation.ticks))
                clock.catch_up(simulation.ticks)
                self.samples[clock.sample] = (
                    motion.position(0), motion.reference(0), motion.error(0), round(motion.torque(0) * 3276.7) / 3276.7
                )  # fmt: skip
                if not self.began and simulation.unit.state.recording.interval:
                    self.began = clock.sample + (clock.tick < simulation.ticks)  # the first sample after RC

        simulation.advance = slowly  # type: ignore[method-assign]

    def rows(self, capture: Capture) -> np.ndarray:
        places = [self.began + n * capture.interval_samples for n in range(capture.count)]
        return np.array([self.samples[place] for place in places]).T


CASES = [("ssc2", 500, 3), ("dmc1412", 250, 2), ("ssc1", 1000, 1), ("ssc4", 2000, 1), ("dmc1414", 1000, 4)]


@pytest.mark.parametrize(("model", "tm", "exponent"), CASES[: count(2, 5)])
def test_values_are_those_of_the_very_samples(model: str, tm: int, exponent: int) -> None:
    rig = moving(model)
    rig.type(f"TM {tm}")
    chosen = (POSITION, COMMANDED, ERROR, TORQUE)[: rig.simulation.model.recorded_channels]
    trace = Trace(rig)
    found = captured(rig, Plan(chosen, exponent, 60, go="PR 200;BG X"))
    assert found.complete and found.count == 60
    assert found.interval_s == pytest.approx(2**exponent * tm / 1_024_000)  # a sample is TM ticks of 1/1 024 000 s
    assert np.ptp(found.of(POSITION)) > 100
    np.testing.assert_allclose(found.values, trace.rows(found)[: len(chosen)], atol=1e-9)
    assert rig.simulation.state()["arrays"] == {}


def test_the_141x_records_two_channels_and_no_analog_input() -> None:
    """dmc-1412-1414.txt l.3411 (two arrays) and l.3425-3436 (its data types); SSC: four, analog l.1923."""
    codes = [channel.code for channel in channels(MODELS["dmc1412"])]
    assert codes == ["_TPX", "_SHX", "_TEX", "_DEX", "_TTX", "_RLX", "_SCX", "_TSX", "_NOX", "_TI", "_OP"]
    assert "2 channels at once" in objection(Plan((POSITION, ERROR, TORQUE)), MODELS["dmc1412"])
    assert not objection(Plan((POSITION, ERROR, TORQUE, INPUTS), 1, 2000), MODELS["ssc1"])
    assert "2000 do" in objection(Plan((POSITION, ERROR, TORQUE, INPUTS), 1, 2001), MODELS["ssc1"])  # 8000 in all


@pytest.mark.parametrize("channel", [COMMANDED, Channel("axis_status", "X")])
def test_the_begin_of_a_move_is_found_to_the_element(channel: Channel) -> None:
    rig = moving()
    plan = Plan((POSITION, channel), 1, 280, Trigger(When.MOTION, axis="X", pre=0.4))
    job = capture(rig.controller, plan)
    rig.until(lambda: job.phase.startswith("waiting:"))
    rig.run(0.7)
    rig.type(MOVE)
    found = done(rig, job)
    assert found.early == 0 and found.complete
    place = found.trigger
    assert 0.2 < place / 280 < 0.8
    row = found.of(channel)
    begun = row != 0 if channel == COMMANDED else (row.astype(int) >> 15 & 1).astype(bool)
    assert begun[place] and not begun[:place].any()
    assert found.times[place] == 0.0


@pytest.mark.parametrize(
    ("baud", "values", "waited", "said"),
    [
        (4800, 257, 1.0, "a ring of 257 turns too fast for this line"),  # two rounds a second; a look takes a fifth
        (19200, 280, 1.0, ""),
        (19200, 1000, 0.3, "it came sooner"),  # 0.3 s and the move's way at 512 a second, of 400 wanted
    ],
)
def test_fewer_values_from_before_a_trigger_than_wanted_are_told(
    baud: int, values: int, waited: float, said: str
) -> None:
    rig = moving(line=LineSettings(baud=baud))
    job = capture(rig.controller, Plan((POSITION, COMMANDED), 1, values, Trigger(When.MOTION, axis="X", pre=0.4)))
    rig.until(lambda: job.phase.startswith("waiting:"))
    rig.run(waited)
    rig.type(MOVE)
    found = done(rig, job)
    few = f"Only {found.trigger} values are from before the trigger, {0.4 * values:.0f} were wanted: "
    assert (found.trigger < 0.35 * values) == bool(said)
    assert found.note.startswith(few + said) if said else not found.note


def test_a_level_and_an_input_are_found_to_the_element() -> None:
    rig = moving()
    for trigger in (
        Trigger(When.LEVEL, channel=POSITION, level=700.0, pre=0.5),
        Trigger(When.INPUT, number=3, rising=True, pre=0.5),
    ):
        job = capture(rig.controller, Plan((POSITION, INPUTS), 1, 280, trigger))
        rig.until(lambda job=job: job.phase.startswith("waiting:"))
        rig.run(0.4)
        rig.type(MOVE)
        rig.run(0.3)
        rig.simulation.stimulus("in3", 1)
        found = done(rig, job)
        assert found.early == 0
        before, at = found.values[:, found.trigger - 1], found.values[:, found.trigger]
        if trigger.when is When.LEVEL:
            assert before[0] < 700 <= at[0]
        else:
            assert not int(before[1]) & 4 and int(at[1]) & 4
        rig.type("DP 0")
        rig.simulation.stimulus("in3", 0)


def test_where_no_channel_shows_the_trigger_it_says_how_unsure_it_is() -> None:
    rig = moving()
    job = capture(rig.controller, Plan((POSITION,), 1, 300, Trigger(When.MOTION, axis="X", pre=0.4)))
    rig.until(lambda: job.phase.startswith("waiting:"))
    rig.run(0.5)
    rig.type(MOVE)
    found = done(rig, job)
    first = int(np.flatnonzero(found.of(POSITION) != found.of(POSITION)[0])[0])
    assert 0 < found.early_s < 0.4
    assert found.trigger - found.early - 2 <= first <= found.trigger + 5  # the load follows a few samples later


def test_watch_refuses_and_says_why() -> None:
    rig = Rig("machine", "ssc2").ready()
    job = capture(rig.controller, Plan((POSITION,)))
    with pytest.raises(NotAllowed, match="Switch to Control first"):
        done(rig, job)
    assert rig.sent("DM|RA|RC") == []


def test_memory_that_is_short_is_told_with_what_is_there() -> None:
    rig = moving(program="#A\nDM TABLE[7800]\nEN")
    rig.type("DM TABLE[7800]")
    with pytest.raises(NotAllowed, match=r"400 array elements are needed, 200 of 8000 are free.*TABLE\[\]") as told:
        captured(rig, Plan((POSITION, ERROR), 1, 200))
    assert "100 values a channel" in str(told.value)
    assert list(rig.simulation.state()["arrays"]) == ["TABLE"]
    assert captured(rig, Plan((POSITION, ERROR), 1, 100)).complete


def test_names_of_a_program_are_never_used() -> None:
    rig = moving(program="#A\nZCA[0]=5\nEN")
    rig.type("DM ZCA[3];ZCA[0]=7", "DM ZKA[2]")
    assert captured(rig, Plan((POSITION,), 1, 60)).complete
    arrays = rig.simulation.state()["arrays"]
    assert arrays["ZCA"][0] == 7 and set(arrays) == {"ZCA", "ZKA"}


def test_what_a_lost_capture_left_is_given_back() -> None:
    rig = moving()
    rig.type("DM ZCA[4000],ZCB[4000]")
    assert captured(rig, Plan((POSITION, ERROR), 1, 60)).complete
    assert rig.simulation.state()["arrays"] == {}


def test_a_recording_of_the_program_is_not_taken_away() -> None:
    program = "#A\nDM P[100]\nRA P[]\nRD _TPX\n#B\nWT 50\nJP #B\nEN"
    rig = moving(program=program)
    rig.simulation.execute("#A")
    rig.run(0.5)
    with pytest.raises(NotAllowed, match="records by itself"):
        captured(rig, Plan((POSITION,)))


def test_the_room_for_an_array_of_unknown_size_is_not_taken() -> None:
    """Else a program that runs would end at its DM with an error; what it has made already is safe."""
    rig = moving(program="#A\nN=300\nWT 1500\nDM P[N*10]\n#L\nWT 20\nJP #L\nEN")
    rig.simulation.execute("#A")
    rig.run(0.3)
    plan = Plan((POSITION, TORQUE), 1, 3000)
    with pytest.raises(NotAllowed, match=r"will make P\[\] in line 3, of a size that is not known"):
        captured(rig, plan)
    rig.run(1.5)
    with pytest.raises(NotAllowed, match="5000 of 8000 are free"):
        captured(rig, plan)
    assert captured(rig, Plan((POSITION,), 1, 40)).complete
    assert rig.running and rig.simulation.state()["arrays"].keys() == {"P"}


def test_a_running_program_keeps_its_pace_and_its_text() -> None:
    """Within 5 % of its pace without a capture (safety rules, reading without harm)."""
    rig = moving(program='#A\nDM P[500]\nN=0\n#L\nWT 20\nMG "TICK"\nN=N+1\nJP #L\nEN')
    rig.simulation.execute("#A")
    rig.run(0.5)

    def turns_in(seconds: float) -> float:
        before = rig.simulation.state()["variables"]["N"]
        rig.run(seconds)
        return float(rig.simulation.state()["variables"]["N"] - before)

    usual = turns_in(2.0)
    job = capture(rig.controller, Plan((POSITION, TORQUE), 1, 60))
    rig.until(lambda: job.phase != "preparing")
    assert turns_in(2.0) >= 0.95 * usual > 60
    assert not job.future.done()
    assert done(rig, job).complete
    assert {each.text for each in rig.controller.traffic() if each.direction == "*"} == {"TICK"}
    assert rig.simulation.state()["arrays"].keys() == {"P"}


@pytest.mark.parametrize("settings", ["VF 5.2", "VF -8", "LZ 1"])
def test_the_format_of_variables_changes_no_number(settings: str) -> None:
    rig = moving()
    rig.type(settings, "DP -123456")
    found = captured(rig, Plan((POSITION,), 1, 30))
    assert found.complete and set(found.of(POSITION)) == {-123456.0}


def test_cancel_keeps_what_was_read_and_finish_reads_what_was_recorded() -> None:
    rig = moving()
    job = capture(rig.controller, Plan((POSITION,), 5, 400, go=MOVE))
    rig.until(lambda: (job.partial() or found_nothing()).count > 40)
    job.cancel()
    found = done(rig, job)
    assert not found.complete and 40 < found.count < 200
    job = capture(rig.controller, Plan((POSITION,), 6, 400))
    rig.run(3.0)
    job.finish()
    found = done(rig, job)
    assert not found.complete and 40 <= found.count <= 56  # 3 s of 62.5 ms, and the way there
    assert rig.simulation.state()["arrays"] == {}


def found_nothing() -> Capture:
    return Capture((), np.zeros((0, 0)), 1, 1000.0)


def test_stop_ends_the_motion_and_not_the_capture() -> None:
    rig = moving()
    job = capture(rig.controller, Plan((POSITION, COMMANDED), 4, 100, go="JG 5000;BG X"))
    rig.until(lambda: rig.moving)
    rig.run(0.4)
    rig.controller.stop()
    found = done(rig, job)
    assert found.complete and not rig.moving
    speed = np.diff(found.of(COMMANDED))
    assert speed[5] > 0 and not speed[-20:].any()


def test_stop_does_not_wait_behind_what_is_read() -> None:
    """ST begins to act once the element that is being sent has left: at most CHUNK_S and the way of the stop itself."""
    rig = moving()
    job = capture(rig.controller, Plan((POSITION, COMMANDED), 1, 500))
    for offset in (0.0, 0.03, 0.08, 0.13)[: count(2, 4)]:
        rig.type("DC 67107840", "JG 3000", "BG X")
        rig.run(0.4 + offset)
        assert rig.moving and not job.future.done()
        before = rig.clock()
        rig.controller.stop()
        rig.until(lambda: not rig.moving)
        assert rig.clock() - before < 0.25
        rig.until(lambda: rig.controller.stop_state is StopState.STOPPED)
    assert done(rig, job).complete


def test_a_question_gets_its_answer_and_nothing_else() -> None:
    rig = moving(program='#A\nWT 200\nIN "LEN",LEN\nEN')
    job = capture(rig.controller, Plan((POSITION,), 1, 150))
    rig.until(lambda: job.partial() is not None)
    rig.controller.execute(anyway=True)
    rig.until(lambda: rig.controller.pending_prompt is not None)
    sent = len(rig.lines)
    rig.run(1.0)
    assert len(rig.lines) == sent and not job.future.done()
    rig.result(rig.controller.answer("12.5"))
    assert done(rig, job).complete
    assert rig.simulation.state()["variables"]["LEN"] == 12.5
    with pytest.raises(NotAllowed, match="Not captured: Live values rest"):
        rig.controller.execute(anyway=True)
        rig.run(0.05)
        captured(rig, Plan((POSITION,), 1, 150))


def test_a_refused_go_leaves_nothing_behind() -> None:
    rig = Rig(model="ssc2").ready()
    rig.type("MO")
    with pytest.raises(Refused, match="BG X"):
        captured(rig, Plan((POSITION,), 8, 50, go=MOVE))
    assert rig.simulation.state()["arrays"] == {}
    assert rig.result(rig.controller.read("_RC")) == (0.0,)


def test_a_cut_line_is_one_sentence_and_keeps_the_part() -> None:
    rig = moving()
    job = capture(rig.controller, Plan((POSITION,), 1, 1500))
    rig.until(lambda: (job.partial() or found_nothing()).count > 30)
    rig.cut()
    with pytest.raises(LinkError):
        done(rig, job)
    part: Callable[[], Capture | None] = job.partial
    assert (part() or found_nothing()).count > 30
