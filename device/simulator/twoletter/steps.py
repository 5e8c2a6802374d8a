"""Commands of which nothing is to be seen but the time they take and a variable they set: what a leap may leave out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from codegen.twoletter.evaluate import Evaluator, compile_expression, constant
from codegen.twoletter.nodes import Assign, Command, Comment, Expression, Statement, Target
from codegen.twoletter.parse import parse_line
from device.simulator.twoletter.arithmetic import rewritten
from device.simulator.twoletter.compile import Code, takes_time
from device.simulator.twoletter.looking import Look, Restless, looks
from device.simulator.twoletter.state import Frame, Thread
from device.simulator.twoletter.values import VALUES
from device.simulator.twoletter.writes import Write, forms, write_of

if TYPE_CHECKING:
    from device.simulator.twoletter.unit import Unit

LONGEST: Final = 64  # commands of a loop, its way in included


@dataclass(frozen=True, slots=True)
class Test:
    """A condition in one of its forms."""

    holds: Evaluator
    looks: tuple[Look, ...]  # what it depends on


@dataclass(frozen=True, slots=True)
class Step:
    """A command without effect: where it goes on."""

    following: int
    target: int | None = None  # of a jump
    condition: Expression | None = None  # under which it is taken; None: always
    test: Test | None = None
    calls: bool = False  # JS
    returns: bool = False  # EN
    write: Write | None = None


@dataclass(frozen=True, slots=True)
class Place:
    """Where a thread is: its next command, and where the subroutines it is in go back to."""

    pc: int
    stack: tuple[int, ...] = ()


@dataclass(slots=True)
class Way:
    """The places a thread comes by while nothing changes: once `order` to its end, then again from `again` on."""

    order: list[Place]
    again: int

    @property
    def round(self) -> int:
        """Commands of the loop."""
        return len(self.order) - self.again

    def place(self, commands: int) -> Place:
        """Where the thread is after so many of them."""
        if commands < len(self.order):
            return self.order[commands]
        return self.order[self.again + (commands - self.again) % self.round]

    def times(self, pc: int, commands: int) -> int:
        """How often a command of the loop is among the first so many."""
        return sum(
            (commands - 1 - number) // self.round + 1
            for number, place in enumerate(self.order)
            if place.pc == pc and number < commands
        )


def steps_of(code: Code, unit: Unit) -> list[Step | None]:
    """The commands of a program that have no effect; None for all others."""
    found: list[Step | None] = []
    by_axis = unit.profile.axis_assignment == "command"
    for text in code.lines:
        for statement in parse_line(text).statements:
            if takes_time(statement):
                plain = rewritten(statement, unit.worked_out, axis_assignments=by_axis)
                found.append(_step(plain, len(found) + 1, code, unit))
    return [*found, None]


def _step(statement: Statement, following: int, code: Code, unit: Unit) -> Step | None:
    match statement:
        case Comment(mark="NO"):
            return Step(following)
        case Assign():
            write = write_of(statement, unit)
            return None if write is None else Step(following, write=write)
        case Command("EN", (), None):
            return Step(following, returns=True)
        case Command("JP" | "JS" as name, arguments, None):
            return _jump(name, arguments, following, code, unit)
    return None


def _jump(name: str, arguments: tuple[object, ...], following: int, code: Code, unit: Unit) -> Step | None:
    place = next((item for item in arguments if isinstance(item, Target)), None)
    target = None if place is None else _line_or_label(place, code)
    conditions = [item for item in arguments if isinstance(item, VALUES)]
    if target is None:
        return None
    if not conditions:
        return Step(following, target, calls=name == "JS")
    test = _test(conditions[0], unit)
    return None if test is None else Step(following, target, conditions[0], test, calls=name == "JS")


def _test(condition: Expression, unit: Unit) -> Test | None:
    seen = looks(condition, unit)
    return None if seen is None else Test(compile_expression(condition), seen)


def _line_or_label(target: Target, code: Code) -> int | None:
    if target.label is not None:
        return code.labels.get(target.label)
    number = None if target.line is None else constant(target.line)
    if number is None or not 0 <= number >> 16 < len(code.start_of):
        return None
    return code.start_of[number >> 16]


def tests_of(condition: Expression, writes: Mapping[str, Write], unit: Unit) -> list[Test]:
    """All forms of a condition whose variables are set meanwhile; Restless where one of them cannot be waited for."""
    found = []
    for form in forms(condition, writes):
        test = _test(form, unit)
        if test is None:
            raise Restless
        found.append(test)
    return found


def way_of(thread: Thread, steps: list[Step | None], unit: Unit) -> Way | None:
    """The thread's way through its loop as things are now; None when it does anything else."""
    place, order = Place(thread.pc, tuple(frame.pc for frame in thread.stack)), dict[Place, int]()
    bottom = 1 + max(
        (n for n, frame in enumerate(thread.stack) if frame.kind != "JS" or frame.wait is not None), default=-1
    )
    while place not in order:
        step = steps[place.pc]
        if step is None or len(order) >= LONGEST:
            return None
        order[place] = len(order)
        if step.returns:
            if len(place.stack) <= bottom:
                return None  # the end of the thread, or of an automatic routine
            place = Place(place.stack[-1], place.stack[:-1])
        elif step.target is None or not (step.test is None or step.test.holds(unit.names)):
            place = Place(step.following, place.stack)
        elif not step.calls:
            place = Place(step.target, place.stack)
        elif len(place.stack) + 1 < unit.model.subroutine_levels:  # with all in use no automatic routine is called
            place = Place(step.target, (*place.stack, step.following))
        else:
            return None
    return Way(list(order), order[place])


def put(thread: Thread, place: Place) -> None:
    """The thread is there now."""
    thread.pc, kept = place.pc, 0
    while kept < min(len(thread.stack), len(place.stack)) and thread.stack[kept].pc == place.stack[kept]:
        kept += 1
    thread.stack[kept:] = [Frame(pc, "JS") for pc in place.stack[kept:]]
