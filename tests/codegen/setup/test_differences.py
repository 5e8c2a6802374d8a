"""Setup and controller side by side: codes from the manual, round trips of every register, words."""

from __future__ import annotations

import dataclasses as dc
from fractions import Fraction

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from codegen.document import Document
from codegen.generate import generate
from codegen.instructions import UserSetup
from codegen.models import MODELS
from codegen.program import Program, Step
from codegen.setup import Axis, EncoderType, MotorType, Setup, Unit
from codegen.setup_cautions import unprotected
from codegen.setup_differences import (
    Key,
    differences,
    expressions,
    lines_to_send,
    loop_words,
    mark,
    stated,
    take,
)
from codegen.setup_registers import BY_COMMAND, REGISTERS, factory
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE, scaled

SCALES = ("1", "637", "4000/3", "39.37", "0.125", "25400")
SERVO = Setup(model="ssc1").with_axis("X", Axis(unit=Unit.MM, counts_per_unit="100"))


def one(**values: object) -> Setup:
    """An SSC1 at 100 counts/mm."""
    return SERVO.with_axis("X", dc.replace(SERVO.axis("X"), **values))  # type: ignore[arg-type]


def sent(setup: Setup, command: str) -> str:
    (line,) = lines_to_send(setup, {(command, "X")})
    return line.text


# ------------------------------------------------------------------ what is sent


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"main_encoder": EncoderType.QUADRATURE_REVERSED, "aux_encoder": EncoderType.PULSE}, "CE 6"),  # l.2199-2202
        ({"main_encoder": EncoderType.PULSE_REVERSED, "aux_encoder": EncoderType.PULSE_REVERSED}, "CE 15"),  # 3 + 12
        ({"motor": MotorType.SERVO_REVERSED}, "MT -1"),  # l.4253
        ({"motor": MotorType.STEPPER_LOW}, "MT 2"),  # l.2126
        ({"motor": MotorType.STEPPER_HIGH_REVERSED}, "MT -2.5"),  # l.2129
        ({"kp": "20"}, "KP 20"),
        ({"forward_limit": "10.019"}, "FL 1001"),  # 1001.9 counts: never beyond
        ({"reverse_limit": "-10.019"}, "BL -1001"),
        ({"forward_limit": "off"}, "FL 2147483647"),
        ({"reverse_limit": "off"}, "BL -2147483648"),
        ({"error_limit": "5.009"}, "ER 500"),
        ({"off_on_error": True}, "OE 1"),
        ({"torque_limit": "5"}, "TL 5"),
        ({"smoothing": "128"}, "IT 0.5"),  # (256 - 128)/256
        ({"smoothing": "0"}, "IT 1"),
        ({"motor": MotorType.STEPPER_LOW, "smoothing": "0.5"}, "KS 0.5"),  # l.810
        ({"maximum_speed": "50.01"}, "SP 5000"),  # even, never above
        ({"maximum_acceleration": "1000"}, "AC 99328"),  # 97 × 1024 = 99328 is the last one below 100000
        ({"maximum_acceleration": "1000"}, "DC 99328"),
    ],
)  # fmt: skip
def test_a_value_leaves_as_the_manual_writes_it(values: dict[str, object], text: str) -> None:
    assert sent(one(**values), text.split()[0]) == text


def test_every_register_exists_on_every_controller_with_its_range() -> None:
    """What a person may type is what the command takes: dmc-1412-1414.txt l.810 (KS) and the table of the gains."""
    for register in REGISTERS:
        for name in ("ssc1", "ssc4", "dmc1412", "dmc1414"):
            assert COMMANDS[register.command].known_to(MODELS[name])
    with pytest.raises(KeyError):
        COMMANDS["QZ"]


def test_the_lines_are_those_that_the_instruction_sends() -> None:
    """User Setup Settings and the setup window say the same thing to the controller."""
    setup = one(
        kp="20", kd="100.5", ki="0.25", fv="5", fa="1.5", smoothing="128", forward_limit="10", reverse_limit="-3",
        error_limit="2", torque_limit="5", integrator_limit="4", main_encoder=EncoderType.PULSE,
    )  # fmt: skip
    chosen = UserSetup(motors=True, encoders=True)
    code = generate(Document(Program("P", configuration=(Step("s", chosen),)), setup)).text.splitlines()
    ours = {line.text for line in lines_to_send(setup, stated(setup))}
    assert ours == {line for line in code if line[:2] in BY_COMMAND}


def test_protection_is_sent_before_what_moves_and_the_motor_before_all() -> None:
    order = [
        line.text[:2] for line in lines_to_send(one(kp="1", forward_limit="1"), stated(one(kp="1", forward_limit="1")))
    ]
    assert order == ["MT", "CE", "OE", "FL", "KP"]


def test_lines_say_what_they_do_and_may_do() -> None:
    setup = one(kp="20", motor=MotorType.SERVO_REVERSED)
    motor, gain = lines_to_send(setup, {("MT", "X"), ("KP", "X")})
    assert motor.motor_off and "run away" in motor.caution
    assert not gain.motor_off and "oscillate" in gain.caution
    assert gain.words == "Proportional of X: 20"
    assert motor.words == "Motor type of X: Servo, reversed (MT -1)"


# ------------------------------------------------------- what a reading means


def reading(values: dict[str, float]) -> dict[Key, int]:
    return {(command, "X"): scaled(Fraction(str(value))) for command, value in values.items()}


def test_a_controller_as_after_a_reset_differs_only_in_what_the_setup_states() -> None:
    found = {(each.command, "X"): factory(each.command) for each in REGISTERS}
    assert [each.command for each in differences(SERVO, found)] == ["OE"]  # a new setup has OE 1 (safety), a reset OE 0
    assert [each.command for each in differences(one(off_on_error=False), found)] == []


def test_both_sides_are_told_in_units_with_the_counts() -> None:
    (found,) = differences(one(forward_limit="10"), reading({"FL": 2500}))
    assert (found.axis, found.setup, found.controller) == ("X", "10 mm (FL 1000)", "25 mm (FL 2500)")
    (found,) = differences(one(), reading({"KP": 12.5}))
    assert (found.setup, found.controller, found.states) == ("not set", "12.5", False)


def test_a_maximum_is_right_below_and_wrong_above() -> None:
    setup = one(maximum_speed="50")
    assert differences(setup, reading({"SP": 4000})) == ()
    (found,) = differences(setup, reading({"SP": 25000}))
    assert found.setup == "at most 50 mm/s (SP 5000)" and not found.tells
    assert take(setup, reading({"SP": 25000}), {found.key}) == setup


def test_a_mark_stands_at_the_field_that_differs() -> None:
    readings = reading({"KP": 12.5, "CE": 2, "FL": 2147483647})
    assert mark(one(), readings, "kp", "X") == "12.5"
    assert mark(one(kp="12.5"), readings, "kp", "X") == ""
    assert "Quadrature, reversed" in mark(one(), readings, "main_encoder", "X")
    assert mark(one(), readings, "forward_limit", "X") == ""  # off is what a reset leaves
    assert mark(one(forward_limit="3"), readings, "forward_limit", "X") == "off"
    assert mark(one(torque_limit="5"), reading({"TL": 9.9982}), "torque_limit", "X") == "9.9982 V"


def test_a_loop_rate_other_than_the_setups_is_told() -> None:
    assert loop_words(SERVO, {("TM", ""): scaled(1000)}) == ""
    assert "500 µs" in loop_words(SERVO, {("TM", ""): scaled(500)})


def test_what_is_read_changes_nothing_and_exists() -> None:
    for name in ("ssc4", "dmc1412"):
        wanted = expressions(MODELS[name])
        assert all(text.startswith("_") for text in wanted.values())
        assert {letter for _, letter in wanted} == {*MODELS[name].axes, ""}


@st.composite
def held(draw: st.DrawFn) -> tuple[Setup, str, int]:
    """A machine, a register of it, and a number that such a register can hold."""
    register = draw(st.sampled_from([each for each in REGISTERS if not each.ceiling]))
    motor = MotorType.STEPPER_LOW if register.drives == "stepper" else MotorType.SERVO
    axis = Axis(unit=Unit.MM, counts_per_unit=draw(st.sampled_from(SCALES)), motor=motor)
    setup = Setup(model="ssc1").with_axis("X", axis)
    row = COMMANDS[register.command]
    if row.choices:
        value = Fraction(str(draw(st.sampled_from(row.choices))))
    else:
        low, high = (Fraction(str(each)) for each in (row.low or 0, row.high or 0))
        grain = Fraction(row.step or 1)
        value = draw(st.integers(int(low / grain), int(high / grain))) * grain
    kept = row.stored(scaled(value))
    assume(row.accepts(kept, MODELS["ssc1"]))
    return setup, register.command, kept


@given(held())
def test_what_is_taken_from_the_controller_means_the_same_when_it_is_sent(case: tuple[Setup, str, int]) -> None:
    """Property: taking a reading over and sending it again leaves the register as it was, to the last bit."""
    setup, command, value = case
    register = BY_COMMAND[command]
    taken = take(setup, {(command, "X"): value}, {(command, "X")})
    assert register.same(value, register.wanted(taken, "X") or 0)
    if register.command not in ("IT",):  # below 1/256 there is no smoothing, which no reading is
        assert register.wanted(taken, "X") == value
    assert differences(taken, {(command, "X"): value}) == ()


@given(st.sampled_from(SCALES), st.decimals("-20000", "20000", places=4))
def test_a_limit_never_lies_beyond_what_was_typed(scale: str, typed: object) -> None:
    axis = Axis(unit=Unit.MM, counts_per_unit=scale, forward_limit=f"{typed}", reverse_limit=f"{typed}")
    setup = Setup(model="ssc1").with_axis("X", axis)
    exact = Fraction(str(typed)) * axis.scale
    forward, reverse = BY_COMMAND["FL"].wanted(setup, "X"), BY_COMMAND["BL"].wanted(setup, "X")
    assert forward is not None and reverse is not None
    assert exact - 1 < forward // ONE <= exact <= reverse // ONE < exact + 1


# ----------------------------------------------------------------- amber words


def test_a_new_axis_shows_its_amber_words() -> None:
    """safety.md 4: OE 0, no FL/BL, default ER."""
    travel, error = unprotected(SERVO, "X")
    assert travel == "no travel limits (FL, BL)"
    assert error == "following error at its default: 16384 counts = 163.84 mm"  # 16384 / 100


def test_a_protected_axis_shows_none() -> None:
    safe = one(forward_limit="10", reverse_limit="0", error_limit="1")
    assert unprotected(safe, "X") == ()
    assert [words[:4] for words in unprotected(one(off_on_error=False), "X")] == ["OE 0", "no t", "foll"]
    assert unprotected(one(forward_limit="10", reverse_limit="off", error_limit="1"), "X") == (
        "no reverse travel limit (BL)",
    )
    stepper = one(motor=MotorType.STEPPER_LOW, off_on_error=False)
    assert unprotected(stepper, "X") == ("no travel limits (FL, BL)",)
    assert unprotected(one(forward_limit="1", reverse_limit="0", error_limit="163.84"), "X") != ()
