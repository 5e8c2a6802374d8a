"""Program flow: jumps, subroutines, threads, and the way back from automatic routines."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final, TypeAlias

from codegen.twoletter.evaluate import EvaluationError, compile_expression
from codegen.twoletter.fixed import ONE
from codegen.twoletter.nodes import Command, Expression, Target
from device.simulator.twoletter.state import CommandError, Frame, Strand, Thread
from device.simulator.twoletter.values import VALUES

if TYPE_CHECKING:
    from device.simulator.twoletter.calls import Call
    from device.simulator.twoletter.compile import Code
    from device.simulator.twoletter.unit import Unit

Op: TypeAlias = Callable[[Strand], int]
BAD_LINE, TOO_DEEP, NO_OPERAND = 11, 12, 58


def destination(target: Target, unit: Unit, code: Code | None) -> Callable[[], int]:
    """The op a target means; labels are looked up when the jump runs, so that a missing one is an error there."""
    label = target.label
    if label is not None:

        def by_label() -> int:
            try:
                return (code or unit.code).labels[label]
            except KeyError:
                raise CommandError(unit.profile.unknown_label_code) from None

        return by_label
    if target.line is None:
        return lambda: 0
    number = compile_expression(target.line)

    def by_line() -> int:
        line, starts = number(unit.names) // ONE, (code or unit.code).start_of
        if not 0 <= line < len(starts):
            raise CommandError(BAD_LINE)
        return starts[line]

    return by_line


def _target(command: Command) -> Target:
    return next((argument for argument in command.arguments if isinstance(argument, Target)), Target(None))


def _rest(command: Command) -> list[Expression]:
    """What stands behind the target: the parser leaves only expressions there."""
    return [item for item in command.arguments if isinstance(item, VALUES)]


def jump(command: Command, following: int, unit: Unit, code: Code | None) -> Op:
    """JP: jumps when the condition is not zero (dmc-1412-1414.txt l.2884)."""
    target, rest, names = _target(command), _rest(command), unit.names
    where = destination(target, unit, code)
    if target.label is not None and code is not None and target.label in code.labels:
        fixed = code.labels[target.label]
        if not rest:
            return lambda strand: fixed
        condition = compile_expression(rest[0])
        return lambda strand: fixed if condition(names) else following
    if not rest:
        return lambda strand: where()
    test = compile_expression(rest[0])
    return lambda strand: where() if test(names) else following


def call_subroutine(command: Command, following: int, unit: Unit, code: Code | None) -> Op:
    """JS: as JP, with the place to return to pushed; eight levels (dmc-1412-1414.txt l.2955)."""
    rest, names, levels = _rest(command), unit.names, unit.model.subroutine_levels
    where = destination(_target(command), unit, code)
    condition = compile_expression(rest[0]) if rest else None

    def op(strand: Strand) -> int:
        if condition is not None and not condition(names):
            return following
        assert isinstance(strand, Thread)
        pc = where()
        if len(strand.stack) >= levels:
            raise CommandError(TOO_DEEP)
        strand.stack.append(Frame(following, "JS"))
        return pc

    return op


def _numbers(command: Command) -> list[Expression | None]:
    return [item if isinstance(item, VALUES) else None for item in command.arguments]


def _flags(command: Command, unit: Unit) -> Callable[[], list[bool]]:
    """The 0/1 arguments of EN, RE, RI, ZS; empty places are 0."""
    values = [None if item is None else compile_expression(item) for item in _numbers(command)]

    def flags() -> list[bool]:
        found = []
        for value in values:
            number = 0 if value is None else value(unit.names) // ONE
            if number not in (0, 1):
                raise CommandError(6)
            found.append(bool(number))
        return [*found, False, False]

    return flags


def end(command: Command, following: int, unit: Unit, code: Code | None) -> Op:
    """EN: returns from a subroutine, or ends the thread."""
    flags, first = _flags(command, unit), unit.profile.end_fields.partition(",")[0]

    def op(strand: Strand) -> int:
        restore, interrupt = flags()[:2] if first == "trippoint" else flags()[1::-1]
        assert isinstance(strand, Thread)
        if not strand.stack:
            finish(unit, strand)
            return strand.pc
        if interrupt and strand.stack[-1].kind == "COMINT":
            unit.state.comint_armed = True
        return come_back(unit, strand, restore=restore)

    return op


def return_from(kinds: tuple[str, ...]) -> Callable[[Command, int, Unit, Code | None], Op]:
    """RE and RI: end an automatic routine; 1 goes back to waiting at the trippoint it interrupted."""

    def compiled(command: Command, following: int, unit: Unit, code: Code | None) -> Op:
        flags = _flags(command, unit)

        def op(strand: Strand) -> int:
            restore = flags()[0]
            assert isinstance(strand, Thread)
            if "ININT" in kinds:
                unit.state.interrupt_armed = bool(unit.state.interrupt_mask)
                unit.changed = True
            if not strand.stack:
                finish(unit, strand)
                return strand.pc
            return come_back(unit, strand, restore=restore)

        return op

    return compiled


def finish(unit: Unit, thread: Thread) -> None:
    """A thread has come to its end."""
    pc = thread.pc
    unit.halt(thread.number)
    unit.state.threads[thread.number].pc = pc


def come_back(unit: Unit, thread: Thread, *, restore: bool) -> int:
    """Pops one frame; the interrupted trippoint goes on, or is cleared."""
    frame = thread.stack.pop()
    if frame.wait is not None:
        if restore:
            thread.wait = frame.wait
        else:
            unit.drop(frame.wait)
    if frame.kind != "JS" or frame.wait is not None or len(thread.stack) + 1 >= unit.model.subroutine_levels:
        unit.changed = True  # else nothing waits for this return: no wait goes on, and routines found room before
    return frame.pc


def zero_stack(command: Command, following: int, unit: Unit, code: Code | None) -> Op:
    """ZS empties the stack, ZS1 drops one return (dmc-1412-1414.txt l.2963)."""
    flags = _flags(command, unit)

    def op(strand: Strand) -> int:
        one = flags()[0]
        assert isinstance(strand, Thread)
        for frame in strand.stack[-1:] if one else strand.stack:
            unit.drop(frame.wait)
        del strand.stack[-1 if one else 0 :]
        unit.changed = True
        return following

    return op


def execute(command: Command, following: int, unit: Unit, code: Code | None) -> Op:
    """XQ #label or line, thread (dmc-1412-1414.txt l.2632)."""
    where, rest = destination(_target(command), unit, None), _rest(command)
    number = compile_expression(rest[0]) if rest else None

    def op(strand: Strand) -> int:
        thread = 0 if number is None else number(unit.names) // ONE
        if not 0 <= thread < unit.model.threads:
            raise CommandError(6)
        unit.start(thread, where())
        return following

    return op


def halt(unit: Unit, strand: Strand, call: Call) -> None:
    """HX n; HX alone halts all."""
    if call.value(0) is None:
        unit.halt_all()
        return
    number = call.whole(0)
    if not 0 <= number < unit.model.threads:
        raise CommandError(6)
    unit.halt(number)


def _thread(unit: Unit, number: int) -> Thread:
    if not 0 <= number < unit.model.threads:
        raise CommandError(6)
    return unit.state.threads[number]


def line_of(unit: Unit, number: int) -> int:
    """_XQn: the line being executed, -1 when not running."""
    thread = _thread(unit, number)
    return unit.current_line(thread) * ONE if thread.running else -ONE


def running_state(unit: Unit, number: int) -> int:
    """_HXn: 0 not running, 1 running, 2 at a trippoint."""
    thread = _thread(unit, number)
    if not thread.running:
        return 0
    return 2 * ONE if thread.wait is not None and unit.profile.waiting_operand else ONE


def stack_depth(unit: Unit, number: int) -> int:
    """_ZSn: how many returns wait."""
    if not unit.profile.stack_operand:
        raise EvaluationError(NO_OPERAND)
    return len(_thread(unit, number).stack) * ONE


COMPILES: Final = {
    "JP": jump,
    "JS": call_subroutine,
    "EN": end,
    "RE": return_from(("LIMSWI", "POSERR")),
    "RI": return_from(("ININT",)),
    "ZS": zero_stack,
    "XQ": execute,
}
DOES: Final = {"HX": halt}
READS: Final = {
    "XQ": line_of,
    "HX": running_state,
    "ZS": stack_depth,
}
