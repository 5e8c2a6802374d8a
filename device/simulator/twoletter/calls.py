"""Turns one parsed command into an op: places its arguments, checks ranges, stores, asks, tells or waits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, TypeAlias

from codegen.twoletter.evaluate import compile_expression, constant
from codegen.twoletter.nodes import (
    Argument,
    Axes,
    Command,
    Empty,
    Format,
    Query,
    SegmentSpeed,
)
from codegen.twoletter.rows import Row, Takes
from device.simulator.twoletter import behaviour
from device.simulator.twoletter.behaviour import registers
from device.simulator.twoletter.state import AXES, CommandError, Strand
from device.simulator.twoletter.values import VALUES

if TYPE_CHECKING:
    from codegen.twoletter.evaluate import Names
    from device.simulator.twoletter.compile import Code
    from device.simulator.twoletter.unit import Unit

Op: TypeAlias = Callable[[Strand], int]

PER_AXIS: Final = frozenset({Takes.AXIS_NUMBERS, Takes.ONE_AXIS_NUMBER, Takes.SEGMENT_AXES, Takes.TABLE})
LETTERS: Final = frozenset({Takes.AXES, Takes.AXES_S, Takes.AXES_OR_ONE, Takes.AXIS})


@dataclass(frozen=True, slots=True)
class Call:
    """One use of a command with its arguments worked out."""

    name: str
    row: Row
    values: tuple[int | None, ...]  # 1/65536; None: place left empty
    axes: tuple[int, ...]  # the named axes, or all
    named: bool  # False: no letter was given
    sequence: bool  # S was given
    command: Command
    speed: int | None = None  # `< n` behind a segment

    def value(self, place: int) -> int | None:
        """The number at a place, or None."""
        return self.values[place] if place < len(self.values) else None

    def whole(self, place: int, default: int = 0) -> int:
        """The whole number at a place: rounded down (dmc-1412-1414.txt l.1065)."""
        value = self.value(place)
        return default if value is None else value >> 16


def command_op(command: Command, following: int, unit: Unit, code: Code | None, *, from_port: bool) -> Op:
    """The op of a command; what is refused at any time is refused when it runs."""
    row = unit.rows.get(command.name)
    refusal = _refusal(row, command, unit, from_port)
    if refusal or row is None:
        return refuse(refusal)
    compiled = behaviour.COMPILES.get(command.name)
    if compiled is not None:
        return compiled(command, following, unit, code)
    if any(isinstance(argument, Query) for argument in command.arguments):
        return _ask(command, row, following, unit)
    if command.name in behaviour.WAITS:
        return _wait(command, row, following, unit)
    if command.name in behaviour.DOES:
        return _do(command, row, following, unit)
    if command.name in registers.STORES:
        return _store(command, row, following, unit)
    if row.takes in LETTERS or row.takes is Takes.NONE:
        return _tell(command, row, following, unit)
    return refuse(1)


def _refusal(row: Row | None, command: Command, unit: Unit, from_port: bool) -> int:
    if row is None or not row.known_to(unit.model):
        return 1
    if from_port and not row.port:
        return 2
    if not from_port and not row.program:
        return 3
    return _bad_axis(row, command, unit)


def _bad_axis(row: Row, command: Command, unit: Unit) -> int:
    """Error 90 for an axis that this model has not, 28 for S where there are no sequences."""
    count = len(unit.model.axes)
    if command.axis is not None and AXES.index(command.axis) >= count:
        return 90
    if row.takes in PER_AXIS:
        more = [item for item in command.arguments if not isinstance(item, SegmentSpeed)][row.places_for(unit.model) :]
        return 90 if any(not isinstance(argument, Empty | Format) for argument in more) else 0
    if row.takes in LETTERS:
        letters = "".join(argument.letters for argument in command.arguments if isinstance(argument, Axes))
        if "S" in letters and (row.takes is not Takes.AXES_S or not unit.model.coordinated):
            return 28
        return 90 if any(letter in AXES[count:] for letter in letters) else 0
    return 0


def refuse(code: int) -> Op:
    """An op that answers an error."""

    def op(strand: Strand) -> int:
        raise CommandError(code)

    return op


# ----------------------------------------------------------------- arguments


def places(command: Command) -> list[Argument]:
    """The numbers of a command by place; the form PRX=5 puts its one number at the axis."""
    found: list[Argument] = [item for item in command.arguments if not isinstance(item, Axes | Format | SegmentSpeed)]
    if command.axis is not None:
        return [*([Empty()] * AXES.index(command.axis)), *found[:1]]
    return found


def local_format(command: Command) -> Format | None:
    """`TP{F2.2}`"""
    return next((argument for argument in command.arguments if isinstance(argument, Format)), None)


def caller(command: Command, row: Row, unit: Unit) -> Callable[[], Call]:
    """Answers the call with its arguments evaluated; once and for all where they are constants."""
    names = unit.names
    letters = "".join(argument.letters for argument in command.arguments if isinstance(argument, Axes))
    named = tuple(AXES.index(letter) for letter in letters if letter in AXES)
    axes = named or (() if "S" in letters else tuple(range(len(unit.model.axes))))
    sequence = "S" in letters
    # what RD names is read at every sample, and some of it (_SH, _NO) only there
    getters = [] if row.takes is Takes.SOURCES else [_getter(argument) for argument in places(command)]

    speed = next((item.value for item in command.arguments if isinstance(item, SegmentSpeed)), None)
    speed_value = None if speed is None else compile_expression(speed)

    def build(values: tuple[int | None, ...]) -> Call:
        limit = None if speed_value is None else speed_value(names)
        return Call(command.name, row, values, axes, bool(letters), sequence, command, limit)

    if speed is None and all(not callable(getter) for getter in getters):
        fixed = build(tuple(getter for getter in getters if not callable(getter)))
        return lambda: fixed
    return lambda: build(tuple(getter(names) if callable(getter) else getter for getter in getters))


def _getter(argument: Argument) -> Callable[[Names], int] | int | None:
    if isinstance(argument, VALUES):
        fixed = constant(argument)
        return compile_expression(argument) if fixed is None else fixed
    return None


# ----------------------------------------------------------------- kinds of op


def _do(command: Command, row: Row, following: int, unit: Unit) -> Op:
    call, does = caller(command, row, unit), behaviour.DOES[command.name]

    def op(strand: Strand) -> int:
        use = call()
        check_moving(unit, use)
        does(unit, strand, use)
        return following

    return op


def _wait(command: Command, row: Row, following: int, unit: Unit) -> Op:
    call, waits = caller(command, row, unit), behaviour.WAITS[command.name]

    def op(strand: Strand) -> int:
        wait = waits(unit, strand, call())
        if wait is not None:
            strand.wait = wait
            unit.changed = True
        return following

    return op


def _store(command: Command, row: Row, following: int, unit: Unit) -> Op:
    call = caller(command, row, unit)

    def op(strand: Strand) -> int:
        use = call()
        check_moving(unit, use)
        registers.store(unit, use)
        return following

    return op


def _ask(command: Command, row: Row, following: int, unit: Unit) -> Op:
    """`PR ?,?`: the asked places are answered, numbers beside them are stored."""
    reads, form = reader(command.name), local_format(command)
    if row.reply is None:
        return refuse(51)
    reply, name = row.reply, command.name
    arguments = places(command)
    asked = [place for place, argument in enumerate(arguments) if isinstance(argument, Query)]
    call = caller(command, row, unit)

    def op(strand: Strand) -> int:
        use = call()
        if any(value is not None for value in use.values):
            check_moving(unit, use)
            registers.store(unit, use)
        unit.answer(strand, ",".join(unit.formatted_reply(name, reply, reads(unit, place), form) for place in asked))
        return following

    return op


def _tell(command: Command, row: Row, following: int, unit: Unit) -> Op:
    """`TP XY`"""
    if command.name not in behaviour.READS or row.reply is None:
        return refuse(50)
    reads, form, reply, name = behaviour.READS[command.name], local_format(command), row.reply, command.name
    call = caller(command, row, unit)

    def op(strand: Strand) -> int:
        axes: Sequence[int] = call().axes if row.takes is not Takes.NONE else (0,)
        unit.answer(strand, ",".join(unit.formatted_reply(name, reply, reads(unit, axis), form) for axis in axes))
        return following

    return op


def reader(name: str) -> Callable[[Unit, int], int]:
    """What `?` and the operand read: a computed value, or the register."""
    computed = behaviour.ASKED.get(name) or behaviour.READS.get(name)
    if computed is not None:
        return computed
    return lambda unit, axis: registers.read(unit, name, axis)


def check_moving(unit: Unit, call: Call) -> None:
    """Refuses what is not valid while one of its axes moves (dmc-1412-1414.txt l.2711)."""
    row = call.row
    if row.moving and not row.moving_mode:
        return
    motion = unit.motion
    if row.takes in PER_AXIS:
        places = call.values[: len(unit.model.axes)]  # EM of a DMC-141x has a second place that is no axis
        axes: Sequence[int] = [axis for axis, value in enumerate(places) if value is not None]
    elif row.takes in LETTERS:
        axes = call.axes
    else:
        axes = range(len(unit.model.axes))
    for axis in axes:
        if motion.moving(axis):
            if row.moving_mode == "jog":
                if call.name == "JG" and motion.stopping(axis):
                    continue  # the speed of the next jog
                if not motion.jogging(axis):
                    raise CommandError(13 if call.name == "JG" else 7)
            elif row.moving_mode != "idle":
                raise CommandError(7)
