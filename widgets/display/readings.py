"""From a row of raw controller numbers to the words and lamps that are shown. Pure."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from codegen.numbers import parse_number
from device.bits import ERROR, FORWARD, HOME, LATCH, MOTOR, MOVING, REVERSE
from device.live import AT
from widgets.display.analog import volts_words
from widgets.display.position import AxisShown
from widgets.parts.axis_bar import Marks
from widgets.parts.units import NOTHING, decimals_of, scale_of, shown

if TYPE_CHECKING:
    from codegen.setup import Axis
    from device.api import Row

USUAL_TM = 1000.0  # µs; the sample period at which a controller tells speeds in counts a second
# stop codes that are worth a word of their own (spec/tables.json, stop_codes)
STOP_WORDS = {6: "abort input", 8: "off on error", 99: "not in position"}


@dataclass(frozen=True)
class Switches:
    """State of one axis' switches; None where it is not known."""

    forward: bool | None = None  # True: the limit is active
    reverse: bool | None = None
    home: bool | None = None  # level of the home input
    motor_on: bool | None = None
    moving: bool | None = None
    error: bool | None = None  # following error beyond ER
    latch_armed: bool | None = None  # False: never armed, or it has caught a place
    stale: bool = False


def switches_of(row: Row, letter: str, now: float) -> Switches:
    """Reads the TS byte of an axis."""
    key = f"switches.{letter.lower()}"
    value = row.value(key)
    if not math.isfinite(value):
        return Switches()
    told = int(value)
    return Switches(
        forward=FORWARD.on(told),
        reverse=REVERSE.on(told),
        home=HOME.on(told),
        motor_on=MOTOR.on(told),
        moving=MOVING.on(told),
        error=ERROR.on(told),
        latch_armed=LATCH.on(told),
        stale=row.stale(key, now),
    )


@dataclass(frozen=True)
class Drive:
    """What an axis' column shows beside its switches."""

    torque: str = "?"  # V
    torque_stale: bool = False
    latch: str = "?"
    latch_stale: bool = False


def drive_of(row: Row, letter: str, axis: Axis, switches: Switches, now: float) -> Drive:
    """Torque, and the latch: armed, or the place it caught (in the unit of the axis)."""
    low = letter.lower()
    caught, old = row.value(f"latch.{low}"), row.stale(f"latch.{low}", now)
    return Drive(
        volts_words(row.value(f"torque.{low}")),
        row.stale(f"torque.{low}", now),
        _latch_words(switches.latch_armed, caught, axis),
        switches.stale or (old and not switches.latch_armed),
    )


def _latch_words(armed: bool | None, caught: float, axis: Axis) -> str:
    """Two lines at most, so that the columns of four axes stay narrow."""
    if armed is None or (not armed and not math.isfinite(caught)):
        return "?"
    if armed:
        return "▲ armed"
    return f"◆ tripped\n{shown(caught, axis)}" if caught else "○ off"


def error_output(axes: Iterable[Switches]) -> bool | None:
    """Whether the one error output is on (low): an axis is beyond ER (dmc-1412-1414.txt l.4098); None: not known."""
    told = [each.error for each in axes]
    return True if True in told else None if None in told or not told else False


def fault_of(switches: Switches, stop_code: float) -> str:
    """The worst that can be said of an axis, or nothing."""
    if switches.forward:
        return "at forward limit"
    if switches.reverse:
        return "at reverse limit"
    if switches.error:
        return "following error"
    if math.isfinite(stop_code) and not switches.moving:
        return STOP_WORDS.get(int(stop_code), "")
    return ""


def axis_shown(row: Row, letter: str, axis: Axis, now: float) -> AxisShown:
    """Everything the position read-out shows of one axis."""
    low = letter.lower()
    place = place_of(row, low)
    switches = switches_of(row, letter, now)
    known = switches if not switches.stale else Switches()  # an old "stopped" may be false by now
    unit = unit_of(axis)
    error = row.value(f"error.{low}")
    return AxisShown(
        position=shown(row.value(place), axis),
        unit=unit,
        commanded=shown(row.value(f"commanded.{low}"), axis),
        error=NOTHING if not math.isfinite(error) else f"{shown(error, axis)} {unit}",
        speed=_speed(row.value(f"velocity.{low}"), axis, unit, row.value("period")),
        moving=known.moving,
        motor_on=known.motor_on,
        fault="" if switches.stale else fault_of(switches, row.value(f"stop_code.{low}")),
        age=age_of(row, place, now),
        marks=marks_of(row, letter, axis),
    )


def place_of(row: Row, low: str) -> str:
    """The newest position; at first the one of the same exchange as error and commanded position."""
    return max((f"{AT}.{low}", f"position.{low}"), key=lambda key: row.time(key) if row.has(key) else -math.inf)


def unit_of(axis: Axis) -> str:
    """The unit of the numbers that are shown: counts, whatever was chosen, until it is said how many make a unit."""
    return axis.symbol if axis.counts_per_unit.strip() and not axis.scale_problem else "counts"


def rate_words(rate_hz: float) -> str:
    """ "12 reads/s", "1.4 reads/s"."""
    return f"{rate_hz:.{0 if rate_hz >= 9.95 else 1}f} reads/s"


def age_of(row: Row, key: str, now: float) -> str:
    """ "12 s old" when the value is older than it should be, else nothing."""
    if not math.isfinite(row.value(key)) or not row.stale(key, now):
        return ""
    seconds = max(0.0, now - row.time(key))
    return (
        f"{seconds:.1f} s old"
        if seconds < 10
        else f"{seconds:.0f} s old"
        if seconds < 120
        else f"{seconds / 60:.0f} min old"
    )


def fresh(row: Row, key: str, now: float) -> float:
    """A value that is as new as it should be; NaN, not known, when it is older."""
    return math.nan if row.stale(key, now) else row.value(key)


def bit(value: float, number: int) -> bool | None:
    """Bit `number` (from 1) of a byte of inputs or outputs; None when it is not known."""
    return None if not math.isfinite(value) else bool(int(value) >> (number - 1) & 1)


def _speed(counts_s: float, axis: Axis, unit: str, period: float) -> str:
    """TV is right at TM 1000 only (commands.md, TM); with an external clock (TM -1) no speed is known."""
    if not math.isfinite(counts_s) or not period > 0:
        return "moving"
    return f"{shown(counts_s * USUAL_TM / period, axis, decimals=2)} {unit}/s"


def marks_of(row: Row, letter: str, axis: Axis) -> Marks:
    """The places of an axis in its unit; the latch once it has caught a place."""
    low, scale = letter.lower(), scale_of(axis)
    latch = row.value(f"latch.{low}")
    return Marks(
        limit_of(axis.reverse_limit),
        limit_of(axis.forward_limit),
        row.value(place_of(row, low)) / scale,
        row.value(f"commanded.{low}") / scale,
        latch=latch / scale if latch else math.nan,
        unit=unit_of(axis),
        decimals=decimals_of(axis),
    )


def limit_of(text: str) -> float:
    """A soft limit of the setup; NaN where there is none."""
    number = parse_number(text)
    return math.nan if number is None else float(number)
