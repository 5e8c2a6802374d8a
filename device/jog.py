"""Moves a person starts by hand, planned before anything is sent: what is sent, where it ends, which limit it passes.

Lengths are counts, speeds and accelerations what SP, AC, VS … take; `Setup.counts` makes them from user units.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from functools import lru_cache
from typing import TYPE_CHECKING

from codegen.fields import Dimension
from codegen.instructions.path_parts import LONGEST_ARC
from codegen.numbers import parse_number, shown
from codegen.twoletter import nodes
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.parse import parse
from codegen.twoletter.rows import BY_AXIS
from device.lease import at

if TYPE_CHECKING:
    from codegen.setup import Setup

MOVES = frozenset({"Motion", "Coordinated motion", "Contour and cam"})  # groups of commands that drive an axis
ALSO = frozenset({"DP", "SH", "MO"})
STOPS = frozenset({"ST", "AB"})
DEAD_ZONE = 0.15  # of a stick's way: no stick comes back to its middle exactly
FURTHEST = 2147483647  # counts


class Routine(StrEnum):
    """The three ways home (dmc-1412-1414.txt l.1143)."""

    HOME = "HM"  # to the switch, back to its edge, forward to the index; that place becomes 0
    EDGE = "FE"  # to the switch; the position is not changed
    INDEX = "FI"  # to the index pulse; that place becomes 0


@dataclass(frozen=True, slots=True)
class Places:
    """Where axes are commanded to be, and between which soft limits (none: nothing in `forward`, `reverse`)."""

    commanded: Mapping[str, int]
    forward: Mapping[str, int] = field(default_factory=dict)
    reverse: Mapping[str, int] = field(default_factory=dict)

    def narrowed(self, setup: Setup | None) -> Places:
        """With the limits of a setup as well: the nearer one counts."""
        if setup is None:
            return self
        forward, reverse = dict(self.forward), dict(self.reverse)
        for letter in self.commanded:
            axis = setup.axis(letter)
            high, low = parse_number(axis.forward_limit), parse_number(axis.reverse_limit)
            if high is not None:
                forward[letter] = min(setup.counts(Dimension.POSITION, letter, high), forward.get(letter, FURTHEST))
            if low is not None:
                reverse[letter] = max(setup.counts(Dimension.POSITION, letter, low), reverse.get(letter, -FURTHEST))
        return Places(self.commanded, forward, reverse)


@dataclass(frozen=True, slots=True)
class Plan:
    """One move by hand: its commands, and for each axis where it ends and how far it swings out on the way.

    `absolute` ends are places, others distances; `opens` has none, because a switch or a pulse ends it.
    """

    title: str
    axes: str
    commands: tuple[str, ...]
    ends: Mapping[str, int]
    swing: Mapping[str, tuple[int, int]] = field(default_factory=dict)  # lowest, highest distance on the way
    absolute: bool = False
    sequence: bool = False  # a coordinated one (BG S)
    stopping_s: float = 0.0
    problem: str = ""
    defines: str = ""  # axes whose position is defined anew

    def ghost(self, places: Places) -> dict[str, int]:
        """Where each axis stops: for the marker."""
        return {
            letter: end if self.absolute else places.commanded[letter] + end
            for letter, end in self.ends.items()
            if self.absolute or letter in places.commanded
        }

    def passes(self, places: Places, setup: Setup | None = None) -> str:
        """Which limit the move passes on its way or at its end, as a sentence, or nothing; in the setup's units."""
        for letter, end in self.ghost(places).items():
            start = places.commanded.get(letter, end)
            low, high = self.swing.get(letter, (0, 0))
            lowest, highest = min(start + low, start, end), max(start + high, start, end)
            forward, reverse = places.forward.get(letter), places.reverse.get(letter)
            if forward is not None and highest > max(forward, start):
                ends, limit = told(highest, letter, setup), told(forward, letter, setup)
                return f"Axis {letter} would come to {ends} and passes its forward limit, {limit}."
            if reverse is not None and lowest < min(reverse, start):
                ends, limit = told(lowest, letter, setup), told(reverse, letter, setup)
                return f"Axis {letter} would come to {ends} and passes its reverse limit, {limit}."
        return ""


def told(counts: int, letter: str, setup: Setup | None) -> str:
    """A place in the unit of its axis; in counts where no setup is known."""
    if setup is None:
        return f"{counts} counts"
    number = setup.from_counts(Dimension.POSITION, letter, counts)
    return f"{shown(number)} {setup.unit_text(Dimension.POSITION, letter)}"


def by(axis: str, counts: int, speed: int, acceleration: int, deceleration: int) -> Plan:
    """One click, one increment."""
    return Plan(
        f"Move {axis} by {counts} counts",
        axis,
        (*_ramps(axis, speed, acceleration, deceleration), f"PR {at(axis, counts)}", f"BG {axis}"),
        {axis: counts},
        stopping_s=_stopping(speed, deceleration),
        problem=_speed_problem(speed, acceleration, deceleration),
    )


def to(axis: str, place: int, speed: int, acceleration: int, deceleration: int) -> Plan:
    """To a saved point, or any place; asks for *homed*."""
    return Plan(
        f"Move {axis} to {place} counts",
        axis,
        (*_ramps(axis, speed, acceleration, deceleration), f"PA {at(axis, place)}", f"BG {axis}"),
        {axis: place},
        absolute=True,
        stopping_s=_stopping(speed, deceleration),
        problem=_speed_problem(speed, acceleration, deceleration),
    )


def to_point(name: str, places: Mapping[str, int], paces: Mapping[str, tuple[int, int, int]]) -> Plan:
    """Several axes to a saved point, each by itself at its speed, acceleration and deceleration; asks for *homed*."""
    axes = "".join(sorted(places, key="XYZW".index))
    columns = {key: {letter: paces[letter][number] for letter in axes} for number, key in enumerate(("SP", "AC", "DC"))}
    return Plan(
        f"Go to {name}",
        axes,
        (
            *(f"{key} {_listed(columns[key])}" for key in ("AC", "DC", "SP")),
            f"PA {_listed(places)}",
            f"BG {axes}",
        ),
        dict(places),
        absolute=True,
        stopping_s=max((_stopping(speed, deceleration) for speed, _, deceleration in paces.values()), default=0.0),
        problem=next((text for axis in axes if (text := _speed_problem(*paces[axis]))), "")
        or ("" if axes else "The point has no axis."),
    )


def _listed(values: Mapping[str, int]) -> str:
    """A number for each axis at its place: `1000,,500`."""
    return ",".join(str(values.get(letter, "")) for letter in "XYZW").rstrip(",")


def line(increments: Mapping[str, int], speed: int, acceleration: int, deceleration: int) -> Plan:
    """Two axes on a straight line, by increments, at a speed along it (LM, LI)."""
    axes = "".join(sorted(increments, key="XYZW".index))
    if len(axes) < 2 or not any(increments.values()):
        return Plan("Line", axes, (), {}, problem="A line needs two axes, and a distance that is not 0.")
    return Plan(
        f"Line {axes}",
        axes,
        (f"LM {axes}", *_vector(speed, acceleration, deceleration), f"LI {_listed(increments)}", "LE", "BG S"),
        dict(increments),
        sequence=True,
        stopping_s=_stopping(speed, deceleration),
        problem=_speed_problem(speed, acceleration, deceleration),
    )


def arc(axes: str, radius: int, start: float, sweep: float, speed: int, acceleration: int, deceleration: int) -> Plan:
    """An arc of two axes from angle `start` on over `sweep` degrees (VM, CR); the circle's place follows from both."""
    problem = _arc_problem(axes, radius, sweep)
    first, second = axes[:1], axes[1:2]
    ends = _arc_at(radius, start, start + sweep)
    swing = _arc_swing(radius, start, sweep)
    return Plan(
        f"Arc {axes}",
        axes,
        (
            f"VM {axes}",
            *_vector(speed, acceleration, deceleration),
            f"CR {radius},{_degrees(start)},{_degrees(sweep)}",
            "VE",
            "BG S",
        ),
        {first: ends[0], second: ends[1]},
        {first: swing[0], second: swing[1]},
        sequence=True,
        stopping_s=_stopping(speed, deceleration),
        problem=problem or _speed_problem(speed, acceleration, deceleration),
    )


def home(
    axis: str, routine: Routine, speed: int, acceleration: int, deceleration: int, *, reverse: bool = False
) -> Plan:
    """One of the three routines; its end is where the switch or the pulse is. `reverse` is for the index alone."""
    speeds = f"JG {at(axis, -speed if reverse else speed)}" if routine is Routine.INDEX else f"SP {at(axis, speed)}"
    ramps = (f"AC {at(axis, acceleration)}", f"DC {at(axis, deceleration)}")
    return Plan(
        f"Home {axis} ({routine})",
        axis,
        (*ramps, speeds, f"{routine} {axis}", f"BG {axis}"),
        {},
        stopping_s=_stopping(speed, deceleration),
        problem=_speed_problem(speed, acceleration, deceleration),
    )


def zero(axes: Iterable[str], place: int = 0) -> Plan:
    """The place where the axes stand is called `place` from now on (DP); nothing moves."""
    letters = "".join(axes)
    return Plan(
        f"Position {letters} = {place}", letters, tuple(f"DP {at(letter, place)}" for letter in letters), {},
        defines=letters,
    )  # fmt: skip


def deflection(x: float, y: float = 0.0, dead: float = DEAD_ZONE) -> tuple[float, float]:
    """A stick's place (-1 to 1 each way) as shares of the full speed: 0 in the dead zone, and from there on without a
    jump; never more than 1 in its direction. A place that is no number is the middle."""
    way = math.hypot(x, y)
    if not math.isfinite(way) or way <= dead:
        return 0.0, 0.0
    share = (min(way, 1.0) - dead) / (1.0 - dead)
    return x / way * share, y / way * share


def _ramps(axis: str, speed: int, acceleration: int, deceleration: int) -> tuple[str, ...]:
    return f"AC {at(axis, acceleration)}", f"DC {at(axis, deceleration)}", f"SP {at(axis, speed)}"


def _vector(speed: int, acceleration: int, deceleration: int) -> tuple[str, ...]:
    return f"VA {acceleration}", f"VD {deceleration}", f"VS {speed}"


def _stopping(speed: int, deceleration: int) -> float:
    return abs(speed) / deceleration if deceleration > 0 else 0.0


def _speed_problem(speed: int, acceleration: int, deceleration: int) -> str:
    if speed <= 0:
        return "The speed is 0; write one above 0."
    if acceleration < 1024 or deceleration < 1024:
        return "Acceleration and deceleration must be at least 1024 counts/s²."
    return ""


def _arc_problem(axes: str, radius: int, sweep: float) -> str:
    """Why the controller would not take it (commands.md 7, CR)."""
    if len(axes) != 2:
        return "An arc needs two axes."
    if radius <= 0 or not float(_degrees(sweep)):
        return "An arc needs a radius above 0 and a sweep angle that is not 0."
    least, most = (round(each or 0) for each in (COMMANDS["CR"].fields[0].low, COMMANDS["CR"].fields[0].high))
    if not least <= radius <= most:
        return f"The radius would be {radius} counts; the controller takes {least} to {most}."
    if radius * abs(sweep) > LONGEST_ARC:
        return "The arc is too long for the controller: make the radius or the sweep angle smaller."
    return ""


def _degrees(angle: float) -> str:
    return f"{angle:.4f}".rstrip("0").rstrip(".")


def _arc_at(radius: int, start: float, angle: float) -> tuple[int, int]:
    """Way from the start of the arc to the place at this angle, counts (dmc-1412-1414.txt, CR)."""
    first, here = math.radians(start), math.radians(angle)
    return (
        round(radius * (math.cos(here) - math.cos(first))),
        round(radius * (math.sin(here) - math.sin(first))),
    )


def _arc_swing(radius: int, start: float, sweep: float) -> tuple[tuple[int, int], tuple[int, int]]:
    """The furthest ways on the arc: at its ends and where it crosses a quarter of the circle."""
    low, high = sorted((start, start + sweep))
    quarters = [90.0 * n for n in range(math.ceil(low / 90), math.floor(high / 90) + 1)][:5]
    ways = [_arc_at(radius, start, angle) for angle in (start, start + sweep, *quarters)]
    return (
        (min(way[0] for way in ways), max(way[0] for way in ways)),
        (min(way[1] for way in ways), max(way[1] for way in ways)),
    )


@lru_cache(maxsize=8)
def axes_driven(text: str, axes: str) -> frozenset[str]:
    """The axes a program drives; a command that names none drives them all."""
    found: set[str] = set()
    for each in parse(text).lines:
        for statement in each.statements:
            if isinstance(statement, nodes.Command) and statement.name in COMMANDS:
                found |= _driven(statement, axes)
            elif isinstance(statement, nodes.Broken | nodes.Foreign):
                found |= set(axes)
    return frozenset(found)


def _driven(statement: nodes.Command, axes: str) -> set[str]:
    row = COMMANDS[statement.name]
    if statement.name in STOPS or (row.group not in MOVES and statement.name not in ALSO):
        return set()
    if statement.axis is not None:
        return {statement.axis}
    if row.takes in BY_AXIS:
        given = [not isinstance(item, nodes.Empty | nodes.Query) for item in statement.arguments]
        return {letter for letter, on in zip(axes, given, strict=False) if on}
    letters = {letter for item in statement.arguments if isinstance(item, nodes.Axes) for letter in item.letters}
    if letters:
        return letters - {"S", "N"}
    return set() if row.group == "Coordinated motion" else set(axes)  # LM and VM name the axes of a path
