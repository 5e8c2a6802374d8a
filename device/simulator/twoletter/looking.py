"""What a condition looks at, and in which range of it the condition cannot change."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, TypeAlias

from codegen.twoletter.evaluate import Evaluator, compile_expression
from codegen.twoletter.fixed import HIGHEST, LOWEST, ONE
from codegen.twoletter.functions import PURE
from codegen.twoletter.nodes import (
    Binary,
    Element,
    Expression,
    Function,
    Group,
    Keyword,
    Negative,
    Number,
    Operand,
    String,
    Variable,
)
from device.simulator.kernel import layout
from device.simulator.kernel.layout import axis_base
from device.simulator.twoletter.behaviour import READS
from device.simulator.twoletter.behaviour.registers import STORES
from device.simulator.twoletter.state import AXES, FOREVER, Thread

if TYPE_CHECKING:
    from codegen.twoletter.evaluate import Names
    from device.simulator.motion import Motion, Range
    from device.simulator.twoletter.unit import Unit


class Restless(Exception):
    """What is looked at may change with every command."""


@dataclass(frozen=True, slots=True)
class Seen:
    """Where a condition looks from: the controller, and the threads that have commands carried out."""

    unit: Unit
    threads: Sequence[Thread]


Look: TypeAlias = Callable[["Seen", "set[Range]"], int]
"""Adds the ranges within which a condition stays what it is; answers the tick that may change it."""


INSIDE: Final = 0.49  # of 1/65536: what is surely rounded to the next one


@dataclass(frozen=True, slots=True)
class Measure:
    """An operand that is a slot of its axis times `step`: comparing it with something is comparing the slot."""

    slot: int
    step: int = ONE  # in 1/65536
    whole: bool = True  # the slot holds whole numbers; else the operand is rounded to 1/65536
    cut: bool = False  # the operand is the whole part of the slot, which is never negative

    def told(self, value: float) -> int:
        """The operand when the slot holds that."""
        return int(value) * self.step if self.cut else round(value * self.step)

    def range(self, low: int, high: int) -> tuple[float, float]:
        """What the slot holds while the operand is one of these."""
        if not self.whole:
            return (low - INSIDE) / self.step, (high + INSIDE) / self.step
        lowest, highest = float(-(-low // self.step)), float(high // self.step)
        if self.cut:
            return max(lowest, 0.0), math.nextafter(highest + 1.0, -math.inf)
        if self.step == ONE:  # positions are told within 32 bits
            return max(lowest, -(2.0**31)), min(highest, 2.0**31 - 1.0)
        return lowest, highest


TRAVELLED: Final = Measure(layout.PATH_TRAVELLED, cut=True)  # _AV: there is one, whatever axis is named
NUMBERS: Final = {
    "TP": Measure(layout.ACTUAL),
    "DP": Measure(layout.ACTUAL),
    "RP": Measure(layout.REFERENCE),
    "TE": Measure(layout.ERROR),
    "TD": Measure(layout.AUXILIARY),
    "DE": Measure(layout.AUXILIARY),
    "TV": Measure(layout.MOVED, 4 * ONE),
    "TT": Measure(layout.COMMAND, whole=False),
}
# Operands that change only when one of these slots of their axis does.
SLOTS: Final[dict[str, tuple[int, ...]]] = {
    **{name: (measure.slot,) for name, measure in NUMBERS.items()},
    "TD": (layout.AUXILIARY, layout.STEPS),
    "DE": (layout.AUXILIARY, layout.STEPS),
    "BG": (layout.MOVING,),
    "SC": (layout.STOP_CODE,),
    "MO": (layout.MOTOR_ON,),
    "HM": (layout.HOME_LEVEL,),
    "LF": (layout.FORWARD_LEVEL,),
    "_LF": (layout.FORWARD_LEVEL,),
    "LR": (layout.REVERSE_LEVEL,),
    "_LR": (layout.REVERSE_LEVEL,),
    "AL": (layout.LATCH_ARMED,),
    "RL": (layout.LATCHED,),
    "GR": (layout.GEAR_RATIO,),
    "TS": (
        layout.MOVING,
        layout.ERROR_HIGH,
        layout.MOTOR_ON,
        layout.FORWARD_LEVEL,
        layout.REVERSE_LEVEL,
        layout.HOME_LEVEL,
        layout.LATCH_ARMED,
    ),
}
# The same for what there is once.
COMMON: Final[dict[str, tuple[int, ...]]] = {
    "CM": (layout.CONTOUR_BUFFERED,),
    "CS": (layout.PATH_OUT_HEAD,),
    "AV": (TRAVELLED.slot,),
    "LM": (
        layout.PATH_FINISHED,
        layout.PATH_TAIL,
        layout.PATH_HEAD,
        layout.PATH_ACTIVE,
        layout.PATH_OUT_HEAD,
    ),
}
# Operands that only commands, characters and the outside change: none of them come while all threads wait.
COMMANDED: Final = frozenset(
    {"OP", "TC", "TB", "ED", "DA", "DM", "DL", "UL", "BN", "RC", "RD", "EM", "EP", "GN", "ZR", "DT", "IP", "AB", "HX"}
    | {"ZS"}
    | (STORES.keys() - READS.keys())
)
KEYWORDS: Final = frozenset({"P1CH", "P2CH", "P1CD", "P2CD", "F1", "F2", "F3", "F4", "F5"})  # reading changes nothing
COMPARES: Final = {"<": ">", ">": "<", "=": "=", "<=": ">=", ">=": "<=", "<>": "<>"}  # as seen from the other side


def looks(expression: Expression, unit: Unit) -> tuple[Look, ...] | None:
    """Everything a condition depends on; None for what cannot be waited for."""
    match expression:
        case Number() | String() | Variable():
            return ()
        case Element(_, index):
            return None if index is None else looks(index, unit)
        case Keyword(name):
            return () if name in KEYWORDS else None
        case Group(inner) | Negative(inner):
            return looks(inner, unit)
        case Function(name, argument):
            fixed = name in PURE or name in ("OUT", "AN") or (name == "IN" and not unit.hall_mask)
            return looks(argument, unit) if fixed else None
        case Operand(name, suffix):
            return _operand(name, suffix, unit)
        case Binary(operator, left, right):
            return _comparison(operator, left, right, unit) or _both(left, right, unit)
    return None


def _both(left: Expression, right: Expression, unit: Unit) -> tuple[Look, ...] | None:
    one, other = looks(left, unit), looks(right, unit)
    return None if one is None or other is None else (*one, *other)


def _operand(name: str, suffix: str, unit: Unit) -> tuple[Look, ...] | None:
    if name == "TC" and unit.profile.error_code_cleared_by_operand:
        return None
    if name in COMMANDED or (name == "TI" and not unit.hall_mask):
        return ()
    if name == "XQ":
        return (_line_look(suffix),)
    if suffix == "S" and name == "BG":
        return (_still((layout.PATH_MOVING,)),)
    if name in COMMON:
        return (_still(COMMON[name]),)
    axis = AXES.find(suffix or "X")
    if name == "PA" and 0 <= axis < len(unit.model.axes):
        return (_target_look(axis_base(axis)),)
    if name not in SLOTS or not 0 <= axis < len(unit.model.axes):
        return None
    return (_still(tuple(axis_base(axis) + slot for slot in SLOTS[name])),)


def _line_look(suffix: str) -> Look:
    """_XQn is the line of a thread: it may change while that thread has commands carried out."""

    def look(seen: Seen, ranges: set[Range]) -> int:
        if any(str(thread.number) == (suffix or "0") for thread in seen.threads):
            raise Restless
        return FOREVER

    return look


def _still(slots: tuple[int, ...]) -> Look:
    """None of these slots changes."""

    def look(seen: Seen, ranges: set[Range]) -> int:
        _keep(slots, seen.unit.motion, ranges)
        return FOREVER

    return look


def _keep(slots: Iterable[int], motion: Motion, ranges: set[Range]) -> None:
    for slot in slots:
        value = motion.slot(slot)
        ranges.add((slot, value, value))


def _target_look(base: int) -> Look:
    """_PA is where a move to a position ends, else where the profile is."""

    def look(seen: Seen, ranges: set[Range]) -> int:
        motion = seen.unit.motion
        aims = motion.slot(base + layout.MOVING) and motion.slot(base + layout.MODE) == layout.MODE_POSITION
        place = layout.TARGET if aims else layout.REFERENCE
        _keep((base + slot for slot in (layout.MOVING, layout.MODE, place)), motion, ranges)
        return FOREVER

    return look


# ------------------------------------------------------------- comparisons


@dataclass(frozen=True, slots=True)
class Ramp:
    """sign × a changing number + what the terms come to, all in 1/65536; of it the magnitude where `folded`."""

    name: str  # of an operand, or TIME
    axis: int
    sign: int = 1
    terms: tuple[tuple[int, Evaluator], ...] = ()
    folded: bool = False

    def turned(self) -> Ramp:
        return Ramp(self.name, self.axis, -self.sign, tuple((-sign, term) for sign, term in self.terms))

    def shifted(self, sign: int, term: Evaluator) -> Ramp:
        return Ramp(self.name, self.axis, self.sign, (*self.terms, (sign, term)))


def ramp(expression: Expression, unit: Unit) -> Ramp | None:
    """The expression as one changing number with something added or taken off."""
    match expression:
        case Keyword("TIME"):
            return Ramp("TIME", 0)
        case Operand("AV"):
            return Ramp("AV", 0)
        case Operand(name, suffix) if name in NUMBERS:
            axis = AXES.find(suffix or "X")
            return Ramp(name, axis) if 0 <= axis < len(unit.model.axes) else None
        case Group(inner):
            return ramp(inner, unit)
        case Negative(inner):
            found = ramp(inner, unit)
            return None if found is None or found.folded else found.turned()
        case Function("ABS", inner):
            found = ramp(inner, unit)
            if found is None or found.folded:
                return None
            return Ramp(found.name, found.axis, found.sign, found.terms, folded=True)
        case Binary("+" | "-" as operator, left, right):
            return _shifted(operator, left, right, unit)
    return None


def _shifted(operator: str, left: Expression, right: Expression, unit: Unit) -> Ramp | None:
    first, second = ramp(left, unit), ramp(right, unit)
    sign = 1 if operator == "+" else -1
    if first is not None and not first.folded and looks(right, unit) == ():
        return first.shifted(sign, compile_expression(right))
    if second is not None and not second.folded and looks(left, unit) == ():
        return (second if sign > 0 else second.turned()).shifted(1, compile_expression(left))
    return None


def _comparison(operator: str, left: Expression, right: Expression, unit: Unit) -> tuple[Look, ...] | None:
    """A changing number against one that stays; None for any other comparison."""
    if operator not in COMPARES:
        return None
    for moving, still, compares in ((left, right, operator), (right, left, COMPARES[operator])):
        found = ramp(moving, unit)
        if found is not None and looks(still, unit) == ():
            return (_edge(found, compares, compile_expression(still)),)
    return None


def _slot(line: Ramp, measure: Measure, motion: Motion) -> int:
    if measure is TRAVELLED:
        return measure.slot
    base, slot = axis_base(line.axis), measure.slot
    if slot == layout.AUXILIARY and motion.slot(base + layout.STEPPER):
        slot = layout.STEPS  # TD of a stepper
    return base + slot


def _edge(line: Ramp, operator: str, still: Evaluator) -> Look:
    return _time_edge(line, operator, still) if line.name == "TIME" else _slot_edge(line, operator, still)


def _around(line: Ramp, now: int, operator: str, still: Evaluator, names: Names) -> tuple[int, int]:
    """The values of the changing number, around the one of now, for which the comparison stays what it is."""
    offset = sum(sign * term(names) for sign, term in line.terms)
    low, high = same_side(line.sign * now + offset, operator, still(names), folded=line.folded)
    low, high = max(low, LOWEST + 1) - offset, min(high, HIGHEST) - offset
    return (-high, -low) if line.sign < 0 else (low, high)


def _time_edge(line: Ramp, operator: str, still: Evaluator) -> Look:
    def look(seen: Seen, ranges: set[Range]) -> int:
        unit = seen.unit
        now = unit.sample - unit.state.clock_offset
        low, high = _around(line, now * ONE, operator, still, unit.names)
        if not low <= now * ONE <= high:
            raise Restless
        return unit.clock.tick_of(high // ONE + 1 + unit.state.clock_offset)

    return look


def _slot_edge(line: Ramp, operator: str, still: Evaluator) -> Look:
    measure, letter = NUMBERS.get(line.name, TRAVELLED), AXES[line.axis]

    def look(seen: Seen, ranges: set[Range]) -> int:
        names, place = seen.unit.names, _slot(line, measure, seen.unit.motion)
        value, now = names.operand(line.name, letter), seen.unit.clock.motion.slot(place)
        low, high = _around(line, value, operator, still, names)
        if not low <= value <= high or value != measure.told(now):
            raise Restless
        lowest, highest = measure.range(low, high)
        if not lowest <= now <= highest:
            raise Restless
        ranges.add((place, lowest, highest))
        return FOREVER

    return look


def same_side(value: int, operator: str, wanted: int, *, folded: bool) -> tuple[int, int]:
    """The numbers around `value` that compare with `wanted` as it does; by magnitude where `folded`."""
    if folded:
        low, high = same_side(abs(value), operator, wanted, folded=False)
        if low <= 0:
            return -high, high
        return (low, high) if value > 0 else (-high, -low)
    if operator in ("=", "<>"):
        if value == wanted:
            return wanted, wanted
        return (LOWEST, wanted - 1) if value < wanted else (wanted + 1, HIGHEST)
    if operator in ("<=", ">"):
        wanted += 1  # numbers are whole 1/65536: as `<` and `>=` of the next one
    return (LOWEST, wanted - 1) if value < wanted else (wanted, HIGHEST)
