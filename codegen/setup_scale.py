"""The scale of an axis worked out from its mechanics: encoder, gear, and what one turn moves. Exact as fractions."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc
from enum import StrEnum
from fractions import Fraction

from codegen.fields import Choice, Context, Number, fields_of, is_shown, value
from codegen.numbers import decimal, is_short_decimal, parse_number, plain, shown
from codegen.setup import Setup, Unit, ratio_of

MILLIMETRES = {
    Unit.INCH: Fraction("25.4"),
    Unit.FOOT: Fraction("304.8"),
    Unit.MM: Fraction(1),
    Unit.CM: Fraction(10),
    Unit.METRE: Fraction(1000),
}
PI = Fraction("3.14159265358979323846264338327950288")
FULL_TURN = 360  # degrees
QUADRATURE = 4  # counts in one line (ssc-tol-o-motion.txt l.1578)
FIGURES = 12  # of a scale that has to be rounded


class Length(StrEnum):
    """Units a mechanical drawing may use."""

    MM = "mm"
    INCH = "inch"


LENGTH_WORDS = {Length.MM: "Millimetres", Length.INCH: "Inches"}


class Drive(StrEnum):
    PITCH = "pitch"
    TURNS = "turns"
    BELT = "belt"
    WHEEL = "wheel"
    ROTARY = "rotary"
    OWN = "own"


DRIVE_WORDS = {
    Drive.PITCH: "Screw, travel of one turn",
    Drive.TURNS: "Screw, turns per length",
    Drive.BELT: "Toothed belt or rack",
    Drive.WHEEL: "Wheel, roller or drum",
    Drive.ROTARY: "Rotary table",
    Drive.OWN: "One turn in the axis' unit",
}


class Feedback(StrEnum):
    LINES = "lines"
    PULSES = "pulses"
    STEPS = "steps"


FEEDBACK_WORDS = {
    Feedback.LINES: "Encoder, lines of a turn",
    Feedback.PULSES: "Encoder, pulses of a turn",
    Feedback.STEPS: "Stepper, steps of a turn",
}


def _number(label: str, help: str, **more: object) -> Number:
    return Number(label=label, help=help, low=0.000001, high=10_000_000, literal=True, **more)  # type: ignore[arg-type]


@dc.dataclass(frozen=True, kw_only=True)
class Mechanics:
    """What stands between the counts and the load, as typed."""

    drive: Drive = value(
        Choice(label="Drive", kind=Drive, words=DRIVE_WORDS, help="What turns the motor's turns into travel."),
        Drive.PITCH,
    )
    length: Length = value(
        Choice(
            label="Drawn in",
            kind=Length,
            words=LENGTH_WORDS,
            help="The unit of pitch, belt or diameter here.",
            when={"drive": (Drive.PITCH, Drive.TURNS, Drive.BELT, Drive.WHEEL)},
        ),
        Length.MM,
    )
    pitch: str = value(
        _number("Travel of one turn", "Lead of the screw: how far one turn moves.", when={"drive": Drive.PITCH}), ""
    )
    turns: str = value(
        _number("Turns per length", "Turns of the screw for 1 mm or 1 inch (TPI).", when={"drive": Drive.TURNS}), ""
    )
    teeth: str = value(
        _number("Teeth of the pulley", "Teeth of the pulley or pinion.", whole=True, when={"drive": Drive.BELT}), ""
    )
    tooth: str = value(_number("Tooth pitch", "From tooth to tooth of belt or rack.", when={"drive": Drive.BELT}), "")
    diameter: str = value(
        _number("Diameter", "Of the wheel, where it touches what it moves.", when={"drive": Drive.WHEEL}), ""
    )
    turn: str = value(_number("One turn moves", "In the unit of the axis.", when={"drive": Drive.OWN}), "")
    motor_turns: str = value(_number("Gear: turns of the motor", "Turns of the motor…"), "1")
    load_turns: str = value(_number("Gear: turns of the load", "…for as many turns of screw, pulley or table."), "1")
    feedback: Feedback = value(
        Choice(label="Counted by", kind=Feedback, words=FEEDBACK_WORDS, help="What makes the counts, on the motor."),
        Feedback.LINES,
    )
    lines: str = value(
        _number(
            "Encoder lines",
            "Of one turn; the controller counts each line four times.",
            whole=True,
            when={"feedback": Feedback.LINES},
        ),
        "1000",
    )
    pulses: str = value(
        _number(
            "Pulses", "Of one turn; pulse and direction count once.", whole=True, when={"feedback": Feedback.PULSES}
        ),
        "1000",
    )
    steps: str = value(
        _number("Full steps", "Of one turn of the motor.", whole=True, when={"feedback": Feedback.STEPS}), "200"
    )
    microsteps: str = value(
        _number("Microsteps", "The drive's pulses for one full step.", whole=True, when={"feedback": Feedback.STEPS}),
        "1",
    )


@dc.dataclass(frozen=True, slots=True)
class Scale:
    """Counts in one unit, how it came about, and whether it is exact."""

    counts: Fraction
    exact: bool
    words: str

    @property
    def text(self) -> str:
        """For the setup: a decimal where it ends, else the exact quotient; with pi as many figures as make sense."""
        if not self.exact:
            return rounded(self.counts)
        return (
            plain(self.counts)
            if is_short_decimal(self.counts)
            else f"{self.counts.numerator}/{self.counts.denominator}"
        )

    @property
    def remark(self) -> str:
        """Whether it is exact, and what rounding does."""
        if not self.exact:
            return f"Rounded to {FIGURES} figures, because π never ends: one count in {_reach(self.counts)}."
        if is_short_decimal(self.counts):
            return "Exact."
        short = Fraction(rounded(self.counts))
        off = abs(short - self.counts) / self.counts
        lost = 1 / (self.counts * off) if off else Fraction(0)
        return (
            f"Exact as a quotient. As a decimal, {plain(short)}, it would be rounded: one count in "
            f"{shown(lost, 3)} units."
        )


def rounded(number: Fraction) -> str:
    """A decimal of twelve figures."""
    return decimal(number, max(FIGURES - len(str(int(number))), 0))


def _reach(counts: Fraction) -> str:
    """Beyond how many units a scale of twelve figures is a count off."""
    return f"more than {shown(Fraction(10 ** (FIGURES - 1)) / counts, 2)} units"


def in_unit(text: str, old: Unit, new: Unit) -> str:
    """Counts per unit of the same mechanics in another unit of length; other text stays as it is."""
    number = ratio_of(text)
    if number is None or old not in MILLIMETRES or new not in MILLIMETRES:
        return text
    counts = number * MILLIMETRES[new] / MILLIMETRES[old]
    return plain(counts) if is_short_decimal(counts) else str(counts)


def drives_for(unit: Unit) -> tuple[Drive, ...]:
    """What can move an axis of that unit."""
    if unit in MILLIMETRES:
        return (Drive.PITCH, Drive.TURNS, Drive.BELT, Drive.WHEEL, Drive.OWN)
    return (Drive.ROTARY, Drive.OWN) if unit is Unit.DEGREE else (Drive.OWN,)


def scale_of(mechanics: Mechanics, setup: Setup, letter: str) -> Scale | str:
    """Counts in one unit of the axis, or what is wrong, as a sentence."""
    axis = setup.axis(letter)
    if axis.unit is Unit.COUNT:
        return "The unit of this axis is the count itself: there is nothing to work out."
    if mechanics.drive not in drives_for(axis.unit):
        return f"This drive does not give {axis.symbol}: choose another drive, or another unit for {letter}."
    for name, field in fields_of(mechanics).items():
        problem = field.problem(getattr(mechanics, name), Context(setup, letter)) if is_shown(mechanics, name) else None
        if problem:
            return f"{problem}."
    counts, counted = _counts_of_turn(mechanics)
    travel, moved = _travel_of_turn(mechanics, axis.unit)
    gear = _value(mechanics.motor_turns) / _value(mechanics.load_turns)
    words = f"{counted}{f' × gear {plain(gear, 6)}' if gear != 1 else ''}, per {moved}"
    return Scale(counts * gear / travel, mechanics.drive is not Drive.WHEEL, words)


def _counts_of_turn(mechanics: Mechanics) -> tuple[Fraction, str]:
    """Counts of one turn of the motor."""
    match mechanics.feedback:
        case Feedback.LINES:
            lines = _value(mechanics.lines)
            return lines * QUADRATURE, f"{plain(lines)} lines × {QUADRATURE}"
        case Feedback.PULSES:
            return _value(mechanics.pulses), f"{mechanics.pulses.strip()} pulses"
        case Feedback.STEPS:
            steps, micro = _value(mechanics.steps), _value(mechanics.microsteps)
            return steps * micro, f"{plain(steps)} steps × {plain(micro)}"


def _travel_of_turn(mechanics: Mechanics, unit: Unit) -> tuple[Fraction, str]:
    """What one turn of screw, pulley or table moves, in the axis' unit."""
    if mechanics.drive is Drive.OWN:
        return _value(mechanics.turn), f"{mechanics.turn.strip()} in the axis' unit"
    if mechanics.drive is Drive.ROTARY:
        return Fraction(FULL_TURN), f"{FULL_TURN}°"
    drawn = Unit(mechanics.length.value)
    factor = MILLIMETRES[drawn] / MILLIMETRES[unit]
    match mechanics.drive:
        case Drive.PITCH:
            return _value(mechanics.pitch) * factor, f"{mechanics.pitch.strip()} {drawn}"
        case Drive.TURNS:
            return factor / _value(mechanics.turns), f"1/{mechanics.turns.strip()} {drawn}"
        case Drive.BELT:
            teeth, tooth = _value(mechanics.teeth), _value(mechanics.tooth)
            return teeth * tooth * factor, f"{plain(teeth)} teeth × {plain(tooth)} {drawn}"
        case _:
            return _value(mechanics.diameter) * PI * factor, f"π × {mechanics.diameter.strip()} {drawn}"


def _value(text: str) -> Fraction:
    number = parse_number(text)
    assert number is not None and number > 0  # its field said so
    return number
