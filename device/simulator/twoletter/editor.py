"""The line editor ED: a numbered line at a time, with control keys (dmc-1412-1414.txt l.2430-2468)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from device.simulator.twoletter import memory

if TYPE_CHECKING:
    from device.simulator.twoletter.state import Port
    from device.simulator.twoletter.unit import Unit

DELETE, BACKSPACE, INSERT, ENTER, PREVIOUS, QUIT, RUBOUT = 0x04, 0x08, 0x09, 0x0D, 0x10, 0x11, 0x7F
PROMPT: Final = b":"


def show(unit: Unit, port: Port) -> None:
    """Sends the line's number and its present text."""
    program = unit.state.program
    text = program[port.edit_line] if port.edit_line < len(program) else ""
    port.text = bytearray(text.encode("latin-1"))
    port.edit_fresh = True
    unit.reply(port.number, f"{port.edit_line:03d} {text}".encode("latin-1"))


def key(unit: Unit, port: Port, byte: int) -> None:
    """One key: typed text replaces the line shown, backspace changes it."""
    if byte == ENTER:
        _store(unit, port)
    elif byte == QUIT:
        _leave(unit, port)
    elif byte == PREVIOUS:
        port.edit_line = max(0, port.edit_line - 1)
        _next_line(unit, port)
    elif byte == INSERT:
        _insert(unit, port)
    elif byte == DELETE:
        _delete(unit, port)
    elif byte in (BACKSPACE, RUBOUT):
        port.edit_fresh = False
        del port.text[-1:]
    elif byte >= 0x20:
        if port.edit_fresh:
            port.text.clear()
            port.edit_fresh = False
        port.text.append(byte)


def _store(unit: Unit, port: Port) -> None:
    lines, text = list(unit.state.program), port.text.decode("latin-1")
    if len(text) > unit.model.columns or port.edit_line >= unit.model.lines:
        _refuse(unit, port)
        return
    if port.edit_line < len(lines):
        lines[port.edit_line] = text
    elif text:
        lines.append(text)
    _set(unit, port, lines)
    if port.edit_line < len(unit.state.program):
        port.edit_line += 1
    _next_line(unit, port)


def _insert(unit: Unit, port: Port) -> None:
    lines = list(unit.state.program)
    if len(lines) >= unit.model.lines:
        _refuse(unit, port)
        return
    lines.insert(min(port.edit_line, len(lines)), "")
    _set(unit, port, lines)
    _next_line(unit, port)


def _delete(unit: Unit, port: Port) -> None:
    lines = list(unit.state.program)
    if port.edit_line < len(lines):
        del lines[port.edit_line]
        _set(unit, port, lines)
        port.edit_line = min(port.edit_line, max(0, len(lines) - 1))
    _next_line(unit, port)


def _set(unit: Unit, port: Port, lines: list[str]) -> None:
    unit.set_program(tuple(lines))
    code = memory.bad_label(unit.state.program, unit.model)[0]
    if code:
        unit.state.error_code = code
        unit.reply(port.number, b"?")


def _refuse(unit: Unit, port: Port) -> None:
    unit.state.error_code = memory.TOO_LONG
    unit.reply(port.number, b"\r\n?")
    _next_line(unit, port)


def _next_line(unit: Unit, port: Port) -> None:
    unit.reply(port.number, b"\r\n")
    show(unit, port)


def _leave(unit: Unit, port: Port) -> None:
    port.mode = "command"
    port.text.clear()
    unit.reply(port.number, b"\r\n" + PROMPT)
