"""Program memory from the port: DL UL LS ED, arrays by QD and QU, lists LL LV LA."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final, TypeAlias

from codegen.twoletter.evaluate import compile_expression
from codegen.twoletter.fixed import ONE
from codegen.twoletter.nodes import Axes, Command, Dimension, Empty, Expression, Format, Target
from device.simulator.twoletter import editor, memory
from device.simulator.twoletter.state import CommandError, Download, Port, Strand

if TYPE_CHECKING:
    from device.simulator.twoletter.calls import Call
    from device.simulator.twoletter.compile import Code
    from device.simulator.twoletter.unit import Unit

Op: TypeAlias = Callable[[Strand], int]
RUNNING, BAD_LINE, UNDEFINED_ARRAY, NOT_FROM_PROGRAM = 17, 11, 82, 3
RETURN: Final = b"\r\n"


def _line_number(target: Target, unit: Unit) -> int:
    """The line a target names; error 11 when there is none."""
    if target.label is not None:
        labels = memory.labels_of(unit.state.program)
        if target.label not in labels:
            raise CommandError(BAD_LINE)
        return labels[target.label]
    assert target.line is not None
    line = compile_expression(target.line)(unit.names) // ONE
    if not 0 <= line <= len(unit.state.program):
        raise CommandError(BAD_LINE)
    return line


def _targets(command: Command) -> list[Target]:
    """All arguments as targets: LS #A,9."""
    found: list[Target] = []
    for argument in command.arguments:
        if isinstance(argument, Target):
            found.append(argument)
        elif not isinstance(argument, Empty | Axes):
            found.append(Target(None, argument))  # type: ignore[arg-type]  # only expressions are left
    return found


def _port(strand: Strand) -> Port:
    if not isinstance(strand, Port):
        raise CommandError(NOT_FROM_PROGRAM)
    return strand


def download(command: Command, following: int, unit: Unit, code: Code | None) -> Op:
    """DL: the following lines become the program, from the start, from a line or label, or behind the end (#)."""
    targets = _targets(command)

    def op(strand: Strand) -> int:
        port, program = _port(strand), unit.state.program
        if unit.running():
            raise CommandError(RUNNING)
        keep = 0
        if targets:
            keep = len(program) if targets[0].label == "" else _line_number(targets[0], unit)
        port.download = Download(before=program[:keep])
        port.mode = "download"
        return following

    return op


def upload(unit: Unit, strand: Strand, call: Call) -> None:
    """UL: the lines, then ctrl-Z (recall)."""
    text = b"".join(line.encode("latin-1") + RETURN for line in unit.state.program)
    unit.reply(_port(strand).number, text + unit.profile.upload_end)


def list_program(command: Command, following: int, unit: Unit, code: Code | None) -> Op:
    """LS first,last: lines with three-digit numbers (dmc-1412-1414.txt l.2474)."""
    targets = _targets(command)

    def op(strand: Strand) -> int:
        program = unit.state.program
        first = _line_number(targets[0], unit) if targets else 0
        last = _line_number(targets[1], unit) if len(targets) > 1 else len(program) - 1
        for number in range(first, min(last + 1, len(program))):
            unit.answer(strand, unit.listed(number))
        return following

    return op


def edit(command: Command, following: int, unit: Unit, code: Code | None) -> Op:
    """ED: the line editor (dmc-1412-1414.txt l.2430)."""
    targets = _targets(command)

    def op(strand: Strand) -> int:
        port = _port(strand)
        if unit.running():
            raise CommandError(RUNNING)
        line = _line_number(targets[0], unit) if targets else max(0, len(unit.state.program) - 1)
        port.mode = "edit"
        port.edit_line = line
        editor.show(unit, port)
        return following

    return op


def _array(command: Command, unit: Unit) -> tuple[str, list[Callable[[], int] | None]]:
    name = ""
    numbers: list[Callable[[], int] | None] = []
    for argument in command.arguments:
        if isinstance(argument, Dimension) and not name:
            name = argument.name
        elif isinstance(argument, Empty):
            numbers.append(None)
        else:
            numbers.append(_number(argument, unit))  # type: ignore[arg-type]  # only expressions are left
    return name, numbers


def _number(expression: Expression, unit: Unit) -> Callable[[], int]:
    value = compile_expression(expression)
    return lambda: value(unit.names) // ONE


def _range(unit: Unit, name: str, numbers: list[Callable[[], int] | None]) -> tuple[list[int], int, int, int]:
    """Array, first and last element, and the number behind them."""
    array = unit.state.arrays.get(name)
    if array is None:
        raise CommandError(UNDEFINED_ARRAY)
    given = [None if number is None else number() for number in numbers] + [None, None, None]
    first = 0 if given[0] is None else given[0]
    last = len(array) - 1 if given[1] is None else given[1]
    if not 0 <= first <= last < len(array):
        raise CommandError(memory.BAD_INDEX)
    return array, first, last, given[2] or 0


def upload_array(command: Command, following: int, unit: Unit, code: Code | None) -> Op:
    """QU A[],first,last,1: by commas; 0: one a line (dmc-1412-1414.txt l.3396)."""
    name, numbers = _array(command, unit)

    def op(strand: Strand) -> int:
        array, first, last, commas = _range(unit, name, numbers)
        form = None if unit.profile.array_format == "VF" else Format("F", 10, 4)
        values = [unit.formatted(value, form) for value in array[first : last + 1]]
        text = (",".join(values) if commas else "\r\n".join(values)) + "\r\n"
        data = text.encode("latin-1") + unit.profile.array_upload_end
        if isinstance(strand, Port):
            unit.reply(strand.number, data)
        else:
            unit.unsolicited(1, data.decode("latin-1"))
        return following

    return op


def download_array(command: Command, following: int, unit: Unit, code: Code | None) -> Op:
    """QD A[],first,last: elements by comma or CR until a backslash, ctrl-Z, ctrl-Q or ctrl-D."""
    name, numbers = _array(command, unit)

    def op(strand: Strand) -> int:
        port = _port(strand)
        _, first, last, _ = _range(unit, name, numbers)
        port.download = Download(array=name, index=first, last=last)
        port.mode = "array"
        return following

    return op


def list_labels(unit: Unit, strand: Strand, call: Call) -> None:
    for name, line in memory.labels_of(unit.state.program).items():
        unit.answer(strand, f"#{name}={line}")


def list_variables(unit: Unit, strand: Strand, call: Call) -> None:
    for name, value in unit.state.variables.items():
        unit.answer(strand, f"{name}={unit.formatted(value, None)}")


def list_arrays(unit: Unit, strand: Strand, call: Call) -> None:
    for name, values in unit.state.arrays.items():
        unit.answer(strand, f"{name}[{len(values)}]")


COMPILES: Final = {"DL": download, "LS": list_program, "ED": edit, "QD": download_array, "QU": upload_array}
DOES: Final = {"UL": upload, "LL": list_labels, "LV": list_variables, "LA": list_arrays}
