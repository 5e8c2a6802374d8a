"""Loops that only wait for a condition (`#L;JP#L,_BGX=1`): recognised, and how long nothing they look at can change.

A loop of jumps and NO lines has no effect but to take time. While every thread is in such a loop, and nothing that
their conditions look at changes, the next command of each is known: all of them are left out at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from codegen.twoletter.evaluate import EvaluationError, Evaluator, compile_expression, constant
from codegen.twoletter.nodes import Command, Comment, Statement, Target
from codegen.twoletter.parse import parse_line
from device.simulator.times import COMMAND
from device.simulator.twoletter.arithmetic import rewritten
from device.simulator.twoletter.compile import Code, takes_time
from device.simulator.twoletter.looking import Look, Restless, Seen, looks
from device.simulator.twoletter.state import FOREVER, CommandError, Thread
from device.simulator.twoletter.values import VALUES

if TYPE_CHECKING:
    from device.simulator.motion import Range
    from device.simulator.twoletter.unit import Unit

LONGEST: Final = 64  # commands of a loop, its way in included
SELDOM: Final = 255  # jumps back between two attempts where attempts are in vain
WORTH: Final = 8  # commands left out from which an attempt was worth it


@dataclass(frozen=True, slots=True)
class Step:
    """A command without effect: where it goes on."""

    following: int
    target: int | None = None  # of a jump
    condition: Evaluator | None = None  # under which it is taken; None: always
    looks: tuple[Look, ...] = ()  # what the condition depends on


@dataclass(slots=True)
class Way:
    """The commands a thread comes by while nothing changes: once `order` to its end, then again from `again` on."""

    order: list[int]
    again: int

    def place(self, commands: int) -> int:
        """Where the thread is after so many of them."""
        if commands < len(self.order):
            return self.order[commands]
        return self.order[self.again + (commands - self.again) % (len(self.order) - self.again)]


@dataclass(frozen=True, slots=True)
class Leap:
    """What was left out."""

    commands: int = 0
    tripped: bool = False  # it ended at a sample that the scheduler must look at


NONE: Final = Leap()


def steps_of(code: Code, unit: Unit) -> list[Step | None]:
    """The commands of a program that have no effect; None for all others."""
    found: list[Step | None] = []
    for text in code.lines:
        for statement in parse_line(text).statements:
            if takes_time(statement):
                found.append(_step(rewritten(statement, unit.worked_out), len(found) + 1, code, unit))
    return [*found, None]


def _step(statement: Statement, following: int, code: Code, unit: Unit) -> Step | None:
    if isinstance(statement, Comment):
        return Step(following) if statement.mark == "NO" else None
    if not isinstance(statement, Command) or statement.name != "JP" or statement.axis is not None:
        return None
    place = next((item for item in statement.arguments if isinstance(item, Target)), None)
    target = None if place is None else _line_or_label(place, code)
    conditions = [item for item in statement.arguments if isinstance(item, VALUES)]
    if target is None:
        return None
    if not conditions:
        return Step(following, target)
    seen = looks(conditions[0], unit)
    return None if seen is None else Step(following, target, compile_expression(conditions[0]), seen)


def _line_or_label(target: Target, code: Code) -> int | None:
    if target.label is not None:
        return code.labels.get(target.label)
    number = None if target.line is None else constant(target.line)
    if number is None or not 0 <= number >> 16 < len(code.start_of):
        return None
    return code.start_of[number >> 16]


class Idling:
    """Leaves out the commands of threads that all do nothing but wait."""

    def __init__(self, unit: Unit) -> None:
        self._unit = unit
        self._code: Code | None = None
        self._steps: list[Step | None] = []
        self._rest = 0  # jumps back until the next attempt
        self._pause = 0
        self.allowed = True  # off only to compare
        self.left_out = 0  # commands

    def due(self) -> bool:
        """After a jump back: it is time for an attempt; they get seldom where they are in vain."""
        if self._rest > 0:
            self._rest -= 1
            return False
        return self.allowed

    def leap(self, threads: Sequence[Thread], index: int, at: int, limit: int, *, watched: bool) -> Leap:
        """Leaves out commands from tick `at` on, at most up to `limit`; the first would be of `threads[index]`."""
        done = self._leap(threads, index, at, limit, watched)
        self._pause = 0 if done.commands >= WORTH else min(SELDOM, 2 * self._pause + 1)
        self._rest = self._pause
        self.left_out += done.commands
        return done

    def _leap(self, threads: Sequence[Thread], index: int, at: int, limit: int, watched: bool) -> Leap:
        motion, clock = self._unit.clock.motion, self._unit.clock
        if watched and motion.has_events:
            return NONE  # the next sample is looked at whatever happens in it
        ways: list[Way] = []
        ranges: set[Range] = set()
        for thread in threads:
            way, until = self._way(thread, threads, ranges)
            if way is None:
                return NONE
            ways.append(way)
            limit = min(limit, until - 1)
        last = at + (limit - at) // COMMAND * COMMAND
        if last < at:
            return NONE
        tripped = False
        if ranges or watched:
            if not motion.guard(ranges):
                return NONE
            while clock.tick + clock.period <= last:
                clock.sync(last)
                tripped = watched and not motion.quiet()
                if tripped or motion.guard_broken:
                    last = at + (clock.tick - 1 - at) // COMMAND * COMMAND  # a sample precedes a command at its tick
                    break
            motion.drop_guards()
        commands = max(0, (last - at) // COMMAND + 1)
        for place, thread in enumerate(threads):
            turns = (commands + len(threads) - 1 - (place - index) % len(threads)) // len(threads)
            thread.pc = ways[place].place(turns)
        return Leap(commands, tripped)

    def _way(self, thread: Thread, threads: Sequence[Thread], ranges: set[Range]) -> tuple[Way | None, int]:
        """The thread's way through its loop, what must not leave its range on it, and the tick that ends it."""
        unit, names, pc, until = self._unit, self._unit.names, thread.pc, FOREVER
        if self._code is not unit.code:
            self._code, self._steps = unit.code, steps_of(unit.code, unit)
        order: list[int] = []
        try:
            while pc not in order:
                step = self._steps[pc]
                if step is None or len(order) >= LONGEST:
                    return None, until
                order.append(pc)
                pc = step.following
                if step.target is not None and (step.condition is None or step.condition(names)):
                    pc = step.target
                for look in step.looks:
                    until = min(until, look(Seen(unit, threads), ranges))
        except (EvaluationError, CommandError, Restless):
            return None, until
        return Way(order, order.index(pc)), until
