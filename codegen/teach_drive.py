"""What a person sets for teaching by hand, and what a stick means with it. Pure."""

from __future__ import annotations

import dataclasses as dc
from fractions import Fraction

from codegen.fields import Context, Dimension, Field, Number, PathQuantity, Quantity, base_letter, fields_of, value
from codegen.numbers import number_problem, parse_number, plain
from codegen.setup import Setup
from codegen.teach import Row, exact

AXES = "XY"
RAMP_S = Fraction(1, 4)  # from standing to full speed by hand


def _path(label: str, dimension: Dimension, text: str) -> PathQuantity:
    return PathQuantity(label=label, dimension=dimension, positive=True, literal=True, help=text)


def _volts(label: str, low: float, text: str) -> Number:
    return Number(label=label, low=low, high=10, suffix="V", literal=True, help=text)


@dc.dataclass(frozen=True, kw_only=True)
class Driving:
    """How fast a stick drives, and what a row gets."""

    full: str = value(_path("Full speed", Dimension.SPEED, "With the stick fully pushed."), "1")
    dead: str = value(
        Number(label="Dead band", low=2, high=60, suffix="%", literal=True,
               help="So far a stick may be from its middle without moving anything."),
        "15",
    )  # fmt: skip
    centre: str = value(_volts("Joystick middle", -10, "Of both analog inputs while nobody touches it."), "2.5")
    reach: str = value(_volts("Joystick reach", 0.1, "From its middle to where it is fully pushed."), "2.5")
    speed: str = value(_path("Speed", Dimension.SPEED, "Of the rows that are recorded."), "1")
    acceleration: str = value(_path("Accel", Dimension.ACCELERATION, "Of the rows that are recorded."), "10")
    deceleration: str = value(_path("Decel", Dimension.ACCELERATION, "Of the rows that are recorded."), "10")
    tolerance: str = value(
        Quantity(label="Tolerance", dimension=Dimension.DISTANCE, positive=True, literal=True,
                 help="So far a recorded way may be from its lines and arcs."),
        "0.01",
    )  # fmt: skip


OF_THE_ROWS = ("speed", "acceleration", "deceleration", "tolerance")
OF_THE_STICK = ("full", "dead", "centre", "reach")


def beginning(setup: Setup) -> Driving:
    """Slow on any machine, in round numbers: some 5000 counts/s, ramps of a quarter of a second, ten counts."""
    coarse = setup.axis(base_letter(setup, AXES)).scale
    speed, ramp = _round(5000 / coarse), _round(20_000 / coarse)
    return Driving(
        full=plain(speed),
        speed=plain(speed),
        acceleration=plain(ramp),
        deceleration=plain(ramp),
        tolerance=plain(_round(10 / coarse)),
    )


def _round(number: Fraction) -> Fraction:
    """A power of ten below."""
    power = Fraction(1)
    while power > number:
        power /= 10
    while power * 10 <= number:
        power *= 10
    return power * max(step for step in (1, 2, 5) if power * step <= number)


def field_problem(name: str, text: str, setup: Setup) -> str:
    """Why a text cannot stand in a field, or nothing."""
    field = fields_of(Driving)[name]
    if text.strip() and (problem := number_problem(text)):
        return f"{field.label}: {problem}"
    return field.problem(text.strip(), context_of(field, setup)) or ""


def context_of(field: Field, setup: Setup) -> Context:
    """The axes a value belongs to."""
    return Context(setup, AXES if isinstance(field, PathQuantity) else "X")


def pace_of(driving: Driving) -> Row:
    """A row with these speeds and no place."""
    return Row(speed=driving.speed, acceleration=driving.acceleration, deceleration=driving.deceleration)


def share_of(volts: float, driving: Driving) -> float:
    """How far the controller's joystick is pushed, -1 to 1, from the voltage of its axis."""
    pushed = (volts - float(exact(driving.centre))) / float(exact(driving.reach))
    return max(-1.0, min(1.0, pushed))


def dead_band(driving: Driving) -> float:
    """Share of the way."""
    return float(exact(driving.dead)) / 100


def speeds_of(across: float, upward: float, driving: Driving, setup: Setup) -> dict[str, int]:
    """Counts/s of both axes for a stick that is pushed so far (shares of full speed, behind the dead band)."""
    full = exact(driving.full)
    return {
        letter: int(share * setup.counts(Dimension.SPEED, letter, full))
        for letter, share in zip(AXES, (across, upward), strict=True)
    }


def ramps_of(driving: Driving, setup: Setup) -> dict[str, int]:
    """Ramps of both axes by hand, counts/s²: a quarter of a second to full speed, within what an axis may."""
    found = {}
    for letter in AXES:
        most = setup.bounds(Dimension.ACCELERATION, letter)[1]
        wanted = min(exact(driving.full) / RAMP_S, most)
        found[letter] = setup.counts(Dimension.ACCELERATION, letter, wanted)
    return found


def slow(driving: Driving, row: Row, setup: Setup) -> tuple[str, dict[str, int]]:
    """The speed of the way to the first place, as text and by axis: a quarter of the slower of both."""
    speed = min(exact(driving.full), exact(row.speed)) / 4
    return plain(speed, 6), {letter: max(setup.counts(Dimension.SPEED, letter, speed), 2) for letter in AXES}


def tolerance_counts(driving: Driving, setup: Setup) -> float:
    """In counts of the coarser axis."""
    number = parse_number(driving.tolerance)
    return float((number or 0) * setup.axis(base_letter(setup, AXES)).scale)
