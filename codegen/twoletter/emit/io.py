"""The group I/O, and talking to the operator."""

from __future__ import annotations

from collections.abc import Iterator

from codegen.expressions import Binary, Negative, parse_expression
from codegen.instructions.io import Level, Output, OutputMode
from codegen.instructions.operator import AnswerKind, ItemKind, Port, Print, PrintItem, Shape, UserInterface
from codegen.twoletter.calls import Statement, listed, numbers
from codegen.twoletter.emit.build import Build, raw

LONGEST_TEXT = 72  # characters between quotes; dmc-1412-1414.txt, MG


def output(output: Output, build: Build) -> Iterator[Statement]:
    """One output, one that follows a condition, or all of them."""
    match output.mode:
        case OutputMode.CHANNEL:
            yield numbers("SB" if output.level is Level.ON else "CB", build.setup.output_number(output.output) or 0)
        case OutputMode.CONDITION:
            yield numbers("OB", build.setup.output_number(output.output) or 0, raw(output.condition))
        case OutputMode.PORT:
            yield numbers("OP", raw(output.byte))


def print_items(message: Print, build: Build) -> Iterator[Statement]:
    """One message, or several that go on in the same line where one is too long."""
    port = "{P2}" if message.port is Port.AUXILIARY else ""
    room = build.setup.limits.columns - len("MG ") - len(port)
    groups = _packed(_pieces(message, room - len("{N}")), room, message.same_line)
    for number, items in enumerate(groups):
        last = number + 1 == len(groups)
        ending = "{N}" if message.same_line or not last else ""
        yield listed("MG", port + ",".join(items) + ending)


def _pieces(message: Print, room: int) -> list[str]:
    """The items as they are written, long texts cut."""
    pieces: list[str] = []
    for item in message.items:
        if item.kind is ItemKind.TEXT:
            size = min(LONGEST_TEXT, room - 2)
            pieces += [f'"{item.text[start : start + size]}"' for start in range(0, len(item.text), size)]
        else:
            pieces.append(_item(item))
    return pieces


def _item(item: PrintItem) -> str:
    if item.kind is ItemKind.CHARACTER:
        return f"{{^{raw(item.character)}}}"
    written = raw(item.expression)
    if isinstance(parse_expression(item.expression), Binary | Negative):
        written = f"({written})"
    match item.shape:
        case Shape.PLAIN:
            return written
        case Shape.DECIMAL:
            return f"{written}{{F{raw(item.digits)}.{raw(item.decimals)}}}"
        case Shape.HEXADECIMAL:
            return f"{written}{{${raw(item.digits)}.{raw(item.decimals)}}}"
        case Shape.STRING:
            return f"{written}{{S{raw(item.length)}}}"


def _packed(pieces: list[str], room: int, same_line: bool) -> list[list[str]]:
    """Pieces in groups that fit on a line each; all but the last need room for `{N}`."""
    groups: list[list[str]] = [[]]
    used = 0
    for number, piece in enumerate(pieces):
        ending = 3 if same_line or number + 1 < len(pieces) else 0
        if groups[-1] and used + 1 + len(piece) + ending > room:
            groups.append([])
            used = 0
        used += len(piece) + (1 if groups[-1] else 0)
        groups[-1].append(piece)
    return groups


def user_interface(question: UserInterface, build: Build) -> Iterator[Statement]:
    """A prompt and the variable for the answer."""
    port = "{P2}" if question.port is Port.AUXILIARY else ""
    length = f"{{S{raw(question.length)}}}" if question.answer is AnswerKind.TEXT else ""
    yield listed("IN", f'{port}"{question.prompt}"', raw(question.variable) + length)
