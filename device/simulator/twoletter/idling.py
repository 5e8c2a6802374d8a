"""Loops that only wait for a condition (`#L;JP#L,_BGX=1`): recognised, and how long nothing they look at can change.

A loop of jumps, subroutines and NO lines has no effect but to take time; one that also sets variables has only that
effect. While every thread is in such a loop, and nothing that their conditions look at changes, the next command of
each is known: all of them are left out at once. Of the assignments only those of the last rounds are carried out, each
at its tick; a counter counts what was left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from codegen.twoletter.evaluate import EvaluationError, compile_expression
from codegen.twoletter.fixed import wrap
from device.simulator.times import COMMAND
from device.simulator.twoletter.compile import Code
from device.simulator.twoletter.looking import Look, Restless, Seen
from device.simulator.twoletter.state import FOREVER, CommandError, Thread
from device.simulator.twoletter.steps import Step, Test, Way, put, steps_of, tests_of, way_of
from device.simulator.twoletter.writes import Write, rounds

if TYPE_CHECKING:
    from device.simulator.kernel.compiled import Vector
    from device.simulator.motion import Range
    from device.simulator.twoletter.unit import Unit

SELDOM: Final = 255  # jumps back between two attempts where attempts are in vain
WORTH: Final = 8  # commands left out from which an attempt was worth it
WORTH_WRITING: Final = 64  # the same where variables are set: then an attempt is as much work as so many commands
LONGEST_TAIL: Final = 1024  # commands that are looked through for their assignments
CHUNK: Final = 512  # samples from one snapshot to the next


@dataclass(frozen=True, slots=True)
class Leap:
    """What was left out."""

    commands: int = 0
    tripped: bool = False  # it ended at a sample that the scheduler must look at
    writing: bool = False


NONE: Final = Leap()


@dataclass(slots=True)
class Plan:
    """What would be left out: the threads' ways from the first of them on, and up to when nothing can change."""

    threads: Sequence[Thread]
    ways: list[Way]
    index: int  # of the thread whose command is the first
    at: int  # its tick
    writes: dict[str, Write] = field(default_factory=dict)
    places: dict[int, Write] = field(default_factory=dict)  # the same by their commands
    ranges: set[Range] = field(default_factory=set)
    tail: int = 0  # commands after which every variable holds what it would

    def turns(self, place: int, commands: int) -> int:
        """How many of the first so many commands are of that thread."""
        number = len(self.threads)
        return (commands + number - 1 - (place - self.index) % number) // number

    def last(self, until: int) -> int:
        """The tick of the last command before `until`; a sample precedes a command at its tick."""
        return self.at + (until - 1 - self.at) // COMMAND * COMMAND

    def commands(self, last: int) -> int:
        return max(0, (last - self.at) // COMMAND + 1)


class Idling:
    """Leaves out the commands of threads that all do nothing but wait."""

    def __init__(self, unit: Unit) -> None:
        self._unit = unit
        self._code: Code | None = None
        self._halls = 0
        self._steps: list[Step | None] = []
        self._tests: dict[tuple[int, tuple[int, ...]], list[Test]] = {}
        self._rest = 0  # jumps back until the next attempt
        self._pause = 0
        self._worth = WORTH
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
        if (limit - at) // COMMAND < self._worth:
            self._rest = self._worth  # in slices as short as these it is not worth the looking
            return NONE
        done = self._leap(threads, index, at, limit, watched)
        self._worth = WORTH_WRITING if done.writing else WORTH
        self._pause = 0 if done.commands >= self._worth else min(SELDOM, 2 * self._pause + 1)
        self._rest = self._pause
        self.left_out += done.commands
        return done

    def _leap(self, threads: Sequence[Thread], index: int, at: int, limit: int, watched: bool) -> Leap:
        motion = self._unit.clock.motion
        if watched and motion.has_events:
            return NONE  # the next sample is looked at whatever happens in it
        try:
            plan = self._plan(threads, index, at)
            if plan is None:
                return NONE
            limit = min(limit, self._until(plan) - 1)
        except (EvaluationError, CommandError, Restless):
            return NONE
        last, tripped, kept = plan.last(limit + 1), False, list[Kept]()
        if last < at:
            return NONE
        if plan.ranges or watched:
            if not motion.guard(plan.ranges):
                return NONE
            last, tripped = self._watch(plan, last, watched, kept)
            motion.drop_guards()
        commands = plan.commands(last)
        if plan.writes:
            self._write(plan, commands, kept)
        for place, thread in enumerate(threads):
            put(thread, plan.ways[place].place(plan.turns(place, commands)))
        return Leap(commands, tripped, bool(plan.writes))

    # ---------------------------------------------------------------- before

    def _plan(self, threads: Sequence[Thread], index: int, at: int) -> Plan | None:
        """The ways of all threads and what they set; None or Restless where it cannot be foretold."""
        unit = self._unit
        if self._code is not unit.code or self._halls != unit.hall_mask:
            self._code, self._halls, self._steps = unit.code, unit.hall_mask, steps_of(unit.code, unit)
            self._tests.clear()
        ways = []
        for thread in threads:
            way = way_of(thread, self._steps, unit)
            if way is None:
                return None
            ways.append(way)
        plan = Plan(threads, ways, index, at)
        for way in ways:
            for number, place in enumerate(way.order):
                step = self._steps[place.pc]
                if step is not None and step.write is not None:
                    self._take(plan, step.write, place.pc, once=number < way.again)
        plan.tail = rounds(plan.writes) * len(threads) * max(way.round for way in ways)
        if plan.tail > LONGEST_TAIL:
            raise Restless
        return plan

    def _take(self, plan: Plan, write: Write, pc: int, *, once: bool) -> None:
        """Another assignment: each variable has one, and it is carried out again and again."""
        if once or write.name not in self._unit.state.variables:
            raise Restless
        if plan.writes.get(write.name, write) is not write:
            raise Restless
        compile_expression(write.value)(self._unit.names)  # whatever may be wrong with it is seen now
        plan.writes[write.name] = plan.places[pc] = write

    def _until(self, plan: Plan) -> int:
        """The tick that may change a condition; adds the ranges of what else they look at."""
        seen, known, until = Seen(self._unit, plan.threads), set[Look](), FOREVER
        for way in plan.ways:
            for place in way.order:
                step = self._steps[place.pc]
                if step is None or step.test is None:
                    continue
                for test in self._forms(step, place.pc, plan):
                    for look in test.looks:
                        if look not in known:
                            known.add(look)
                            until = min(until, look(seen, plan.ranges))
        return until

    def _forms(self, step: Step, pc: int, plan: Plan) -> Sequence[Test]:
        """A condition in every form that it can have within the leap; they must say the same."""
        assert step.condition is not None and step.test is not None
        if not plan.writes:
            return (step.test,)
        key = (pc, tuple(plan.places))
        if key not in self._tests:
            self._tests[key] = tests_of(step.condition, plan.writes, self._unit)
        tests, names = self._tests[key], self._unit.names
        if len({bool(test.holds(names)) for test in tests}) > 1:
            raise Restless
        return tests

    # ---------------------------------------------------------------- within

    def _watch(self, plan: Plan, last: int, watched: bool, kept: list[Kept]) -> tuple[int, bool]:
        """Runs the motion up to the first sample that changes anything: the last command before it, and whether
        the scheduler must look at it. Where variables are set, keeps how it was on the way."""
        clock = self._unit.clock
        motion, chunk = clock.motion, max(CHUNK * clock.period, (plan.tail + 1) * COMMAND)
        while clock.tick + clock.period <= last:
            if plan.writes:
                kept[:-1] = []
                kept.append(Kept(clock.tick, clock.sample, motion.snapshot()))
            clock.sync(min(last, clock.tick + chunk) if plan.writes else last)
            tripped = watched and not motion.quiet()
            if tripped or motion.guard_broken:
                return plan.last(clock.tick), tripped
        return last, False

    # ----------------------------------------------------------------- after

    def _write(self, plan: Plan, commands: int, kept: list[Kept]) -> None:
        """Variables get what they would: the last rounds are gone through again with the motion as it was then."""
        clock, state, ops = self._unit.clock, self._unit.state, self._unit.code.ops
        reached, first = clock.tick, max(0, commands - plan.tail)
        for pc, write in plan.places.items():
            if write.adds is not None:
                times = sum(way.times(pc, plan.turns(place, first)) for place, way in enumerate(plan.ways))
                state.variables[write.name] = wrap(state.variables[write.name] + times * write.adds)
        begin = plan.at + first * COMMAND
        for before in reversed(kept):
            if before.tick <= begin:
                clock.tick, clock.sample = before.tick, before.sample
                clock.motion.rewind(before.vector)
                clock.motion.drop_guards()
                break
        for number in range(first, commands):
            place = (plan.index + number) % len(plan.threads)
            pc = plan.ways[place].place(number // len(plan.threads)).pc
            if pc in plan.places:
                clock.now = plan.at + number * COMMAND
                ops[pc](plan.threads[place])
        if kept:
            clock.catch_up(reached)


@dataclass(frozen=True, slots=True)
class Kept:
    """How the motion was at a sample."""

    tick: int
    sample: int
    vector: Vector
