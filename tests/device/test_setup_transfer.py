"""A setup over the simulator's byte stream: read in Watch, sent only to what stands still, burned on demand only."""

from __future__ import annotations

import dataclasses as dc
from concurrent.futures import Future
from typing import TypeVar

import pytest

from codegen.models import MODELS
from codegen.setup import Axis, EncoderType, MotorType, Setup, Unit
from codegen.setup_differences import Key, differences, lines_to_send, stated
from codegen.twoletter.fixed import ONE
from device.setup_transfer import Reading, Sent, burn_setup, burn_words, read_setup, send_setup
from device.tasks import NotAllowed
from tests.rig import Rig

T = TypeVar("T")
AXIS = Axis(
    unit=Unit.MM, counts_per_unit="4000/3", kp="12.25", ki="0.5", kd="80", fv="3", fa="0.25", smoothing="128",
    forward_limit="100", reverse_limit="-20.5", error_limit="2", torque_limit="5", integrator_limit="4", offset="-0.5",
    maximum_speed="15", maximum_acceleration="150",
)  # fmt: skip
SETUP = Setup(model="ssc2").with_axis("X", AXIS).with_axis("Y", Axis(unit=Unit.COUNT))


def done(rig: Rig, future: Future[T]) -> T:
    rig.until(future.done, 60)
    return future.result()


def ready(kind: str = "simulator", model: str = "ssc2", **more: str) -> Rig:
    return Rig(kind, model, **more).ready()  # type: ignore[arg-type]


def send(rig: Rig, setup: Setup, keys: set[Key] | frozenset[Key] | None = None) -> Sent:
    return done(
        rig, send_setup(rig.controller, setup, lines_to_send(setup, stated(setup) if keys is None else keys)).future
    )


def register(rig: Rig, name: str, place: int = 0) -> float:
    """Told by the simulation itself."""
    return rig.simulation.unit.state.registers[name][place] / ONE


def test_reading_in_watch_tells_everything_and_sends_only_reads() -> None:
    rig = ready("machine")
    rig.simulation.unit.state.registers["KP"][1] = int(12.25 * ONE)
    before = len(rig.loopback.written)
    reading = done(rig, read_setup(rig.controller))
    left = bytes(rig.loopback.written[before:]).decode().split("\r")
    assert len(left) > 10 and all(line.startswith("MG") or not line for line in left[1:]), left  # the first was cut
    assert not rig.controller.control
    assert reading.values["KP", "Y"] == int(12.25 * ONE)
    assert reading.values["KP", "X"] == 6 * ONE  # the power-up value
    assert reading.not_told == () and reading.motors_on == "XY"
    assert {axis for _, axis in reading.values} == {"X", "Y", ""}


def test_reading_goes_on_while_a_program_runs() -> None:
    rig = ready(program="#A\nWT 100\nJP #A\nEN")
    rig.simulation.execute("#A")
    rig.run(0.3)
    assert done(rig, read_setup(rig.controller)).values["KD", "X"] == 64 * ONE
    assert rig.running


def test_a_whole_setup_is_sent_and_read_back() -> None:
    rig = ready()
    sent = send(rig, SETUP)
    assert sent.complete, sent.sentence
    assert "read back; nothing is burned" in sent.sentence
    for name, value in (
        ("KP", 12.25), ("KI", 0.5), ("KD", 80), ("FV", 3), ("FA", 0.25), ("OE", 1), ("IT", 0.5), ("OF", -0.5),
        ("FL", 133333),  # 100 × 4000/3 = 133333.3
        ("BL", -27333),  # -20.5 × 4000/3 = -27333.3
        ("ER", 2666),  # 2 × 4000/3 = 2666.7
        ("SP", 20000),  # 15 × 4000/3
        ("AC", 199680),  # 150 × 4000/3 = 200000, the multiple of 1024 below
        ("DC", 199680),
    ):  # fmt: skip
        assert register(rig, name) == pytest.approx(value, abs=20 / 65536), name
    assert register(rig, "OE", 1) == 1
    assert differences(SETUP, sent.reading.values) == ()
    assert "BN" not in " ".join(rig.lines).replace("_BN", "")


def test_nothing_is_sent_in_watch() -> None:
    rig = ready("machine")
    with pytest.raises(NotAllowed, match="this is Watch"):
        send(rig, SETUP)
    with pytest.raises(NotAllowed, match="this is Watch"):
        done(rig, burn_setup(rig.controller))
    assert register(rig, "KP") == 6


@pytest.mark.parametrize(
    ("commands", "reason"),
    [
        (("JG 5000", "BG X"), "an axis is moving"),
        (("VM XY", "VS 200", "VP 100000,0", "VE", "BGS"), "an axis is moving"),
        (("GAX", "GR ,1"), "follows a master"),
    ],
)
def test_nothing_is_sent_while_something_moves(commands: tuple[str, ...], reason: str) -> None:
    rig = ready()
    rig.type(*commands)
    for attempt in (lambda: send(rig, SETUP), lambda: done(rig, burn_setup(rig.controller))):
        with pytest.raises(NotAllowed, match=reason):
            attempt()
    assert register(rig, "KP") == 6


def test_nothing_is_sent_while_a_program_runs() -> None:
    rig = ready(program="#A\nWT 100\nJP #A\nEN")
    rig.simulation.execute("#A")
    rig.run(0.3)
    with pytest.raises(NotAllowed, match="a program is running"):
        send(rig, SETUP)


def test_what_begins_to_move_meanwhile_ends_the_sending_and_says_how_far_it_came() -> None:
    rig = ready()
    keys = {(name, axis) for name, axis in stated(SETUP) if name not in ("MT", "CE")}  # those switch the motor off
    job = send_setup(rig.controller, SETUP, lines_to_send(SETUP, keys))
    rig.until(lambda: register(rig, "KP") == 12.25)
    rig.simulation.load_program("#A\nJG 5000\nBG X\nEN")
    rig.simulation.execute("#A")
    with pytest.raises(NotAllowed, match="values were sent before"):
        done(rig, job.future)
    assert register(rig, "SP") == 25000  # the last ones were not sent


def test_a_motor_type_is_sent_with_the_motor_off_which_stays_off() -> None:
    rig = ready()
    setup = SETUP.with_axis("X", dc.replace(AXIS, motor=MotorType.SERVO_REVERSED, main_encoder=EncoderType.PULSE))
    sent = send(rig, setup, {("MT", "X"), ("CE", "X")})
    assert sent.complete and "The motor of X is off now" in sent.sentence
    assert (register(rig, "MT"), register(rig, "CE")) == (-1, 1)
    assert sent.reading.motors_on == "Y"
    user = [line for line in rig.sent("(MO|MT|CE)") if line]
    assert [line[:2] for line in user] == ["MO", "MT", "CE"]


def test_a_gain_leaves_the_motor_on() -> None:
    rig = ready()
    sent = send(rig, SETUP, {("KP", "X")})
    assert sent.reading.motors_on == "XY" and not rig.sent("MO")


def test_another_model_is_refused() -> None:
    rig = ready(model="ssc1")
    with pytest.raises(NotAllowed, match="the setup is for SSC, two axes, connected is SSC, one axis"):
        send(rig, SETUP)


def test_a_value_the_controller_does_not_keep_is_told() -> None:
    """Its register refuses to change, as a worn memory would."""
    rig = ready()
    state = rig.simulation.unit.state
    state.registers["KD"] = Stuck(state.registers["KD"])
    sent = send(rig, SETUP, {("KD", "X"), ("KP", "X")})
    assert [each.key for each in sent.left] == [("KD", "X")]
    assert "the controller holds other values of Derivative of X" in sent.sentence


class Stuck(list[int]):
    """A list that keeps what it has."""

    def __setitem__(self, place: object, value: object) -> None:
        return


def test_burned_is_there_after_a_reset_and_not_before() -> None:
    rig = ready()
    send(rig, SETUP, {("KP", "X"), ("OE", "X")})
    rig.type("KD 33")
    reply = done(rig, burn_setup(rig.controller))
    assert reply.accepted
    rig.type("KP 1", "MO Y")
    rig.controller.ask("RS")
    rig.run(3.0)
    assert (register(rig, "KP"), register(rig, "KD"), register(rig, "OE")) == (12.25, 33, 1)


def test_the_words_before_burning_say_what_the_next_power_up_does() -> None:
    words = burn_words(Reading("ssc2", {}, "X"), MODELS["ssc2"], 2)
    assert "the motor of X is switched on by itself" in words and "the motor of Y stays off" in words
    assert "2 values of this setup are not in the controller" in words
    assert "program is not burned" in words and "leave the power on" in words
    assert "motors of X and Y are switched on by themselves" in burn_words(Reading("ssc2", {}, "XY"), MODELS["ssc2"], 0)
