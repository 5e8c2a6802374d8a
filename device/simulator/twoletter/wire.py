"""The controller's end of a serial line: characters become command lines, answers, downloads; prompts go back."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from codegen.twoletter.fixed import read_number
from device.simulator.twoletter import editor, memory
from device.simulator.twoletter.behaviour import operator
from device.simulator.twoletter.behaviour.messages import answer_input
from device.simulator.twoletter.state import CommandError, Port, Wait

if TYPE_CHECKING:
    from device.simulator.twoletter.unit import Unit

ENTER, BACKSPACE, CONTROL_R, CONTROL_S, CONTROL_V, RUBOUT = 0x0D, 0x08, 0x12, 0x13, 0x16, 0x7F
END_OF_DATA: Final = frozenset(b"\\\x1a\x11\x04")  # dmc-1412-1414.txt l.3408
ACCEPTED: Final = b":"
REFUSED: Final = b"?"
ADDRESSES: Final = tuple("01234567")
BAD_ADDRESS: Final = 6
BUFFER_FULL, BAD_NUMBER, TOO_MANY_ELEMENTS = 5, 83, 84


def take_characters(unit: Unit, port: Port) -> None:
    """Reads what the port has received, up to a whole command line."""
    uart = unit.uarts[port.number - 1]
    if uart.overruns and port.number == 1:
        uart.overruns = 0
        _refuse(unit, port, BUFFER_FULL)
    while port.pending is None and unit.state.reset_at < 0:
        byte = uart.take(unit.clock.now)
        if byte is None:
            return
        _character(unit, port, byte)


def _character(unit: Unit, port: Port, byte: int) -> None:
    if echoes(unit, port):
        unit.reply(port.number, _echoed_return(unit) if byte == ENTER else bytes((byte,)))
    if port.mode == "edit":
        editor.key(unit, port, byte)
    elif port.mode in ("download", "array"):
        _data_character(unit, port, byte)
    elif operator.data_mode(unit, port) and spoken_to(unit, port) and waiting_input(unit, port) is None:
        operator.character(unit, port, byte)
    elif port.control:
        port.control = False
        if byte == CONTROL_V:
            unit.reply(port.number, unit.revision().encode("latin-1") + b"\r\n" + ACCEPTED)
        elif byte == CONTROL_S and spoken_to(unit, port):
            unit.master_reset()
    else:
        _line_character(unit, port, byte)


def echoes(unit: Unit, port: Port) -> bool:
    """EO for port 1; the last field of CC for port 2."""
    if port.number == 1:
        return unit.state.settings["EO"] != 0
    return unit.state.port_two[3] == 1 and unit.state.port_two[2] == 0


def _echoed_return(unit: Unit) -> bytes:
    return b"\r\n" if unit.profile.echo_return == "CR LF" else b"\r"


# ------------------------------------------------------------- command lines


def _line_character(unit: Unit, port: Port, byte: int) -> None:
    if port.number == 1:
        operator.interrupt(unit, port, byte)
    if byte == CONTROL_R:
        port.control = True
    elif byte == ENTER or (byte == ord(";") and waiting_input(unit, port) is not None):
        _line_end(unit, port)
    elif byte in (BACKSPACE, RUBOUT):
        del port.text[-1:]
    elif byte >= 0x20:
        if len(port.text) < unit.profile.line_characters:
            port.text.append(byte)
        else:
            port.too_long = True


def spoken_to(unit: Unit, port: Port) -> bool:
    """Port 1 is this controller's: it is alone, or the last %n was its address."""
    return port.number != 1 or unit.state.selected


def waiting_input(unit: Unit, port: Port) -> Wait | None:
    """The IN that waits for an answer from this port."""
    wait = unit.state.threads[0].wait
    if wait is None or wait.kind != "input" or wait.number != port.number or not spoken_to(unit, port):
        return None
    return wait


def _line_end(unit: Unit, port: Port) -> None:
    text, too_long = port.text.decode("latin-1"), port.too_long
    port.text.clear()
    port.too_long = False
    wait = waiting_input(unit, port)
    if wait is not None:
        _answer(unit, wait, text)
    elif port.number != 1:
        return  # port 2 takes no commands (SSC manual l.1243)
    elif too_long:
        _refuse(unit, port, BUFFER_FULL)
    elif text.strip() or unit.profile.prompt_on_empty_line:
        _command_line(unit, port, text)


def _command_line(unit: Unit, port: Port, text: str) -> None:
    """`%n` chooses who is talked to, `!` is for all and answered by address 0 (dmc-1412-1414.txt l.1305)."""
    state, line = unit.state, text.lstrip(" ")
    if line.startswith("%"):
        if line[1:2] not in ADDRESSES:
            _refuse(unit, port, BAD_ADDRESS)
            return
        state.selected = int(line[1]) == unit.address
        text = line[2:].lstrip("; ")
    for_all = line.startswith("!")
    port.silent = unit.address != 0 if for_all else not state.selected
    if for_all or state.selected:
        port.pending, port.position = line[1:] if for_all else text, 0
        unit.changed = True


def _answer(unit: Unit, wait: Wait, text: str) -> None:
    main = unit.state.threads[0]
    main.wait = None
    unit.changed = True
    try:
        answer_input(unit, wait, text)
    except CommandError as refusal:
        unit.fail(main, refusal.code, main.pc - 1)


def _refuse(unit: Unit, port: Port, code: int) -> None:
    port.text.clear()
    if spoken_to(unit, port):
        unit.state.error_code = unit.profile.code(code)
        unit.reply(port.number, REFUSED)


# ------------------------------------------------------------------ downloads


def _data_character(unit: Unit, port: Port, byte: int) -> None:
    if byte in END_OF_DATA:
        _data_line(unit, port, last=True)
        _finish(unit, port)
    elif byte == ENTER or (byte == ord(",") and port.mode == "array"):
        _data_line(unit, port, last=False)
    elif byte >= 0x20:
        port.text.append(byte)


def _data_line(unit: Unit, port: Port, *, last: bool) -> None:
    download = port.download
    assert download is not None
    text = port.text.decode("latin-1")
    port.text.clear()
    if last and not text:
        return
    if port.mode == "download":
        memory.add_line(download, text, unit.model)
        return
    number = read_number(text)
    if download.error or not text:
        return
    if number is None:
        download.error = BAD_NUMBER
    elif download.index > download.last:
        download.error = TOO_MANY_ELEMENTS
    else:
        memory.set_element(unit.state, download.array, download.index, number)
        download.index += 1


def _finish(unit: Unit, port: Port) -> None:
    download, port.download = port.download, None
    assert download is not None
    error = download.error
    if port.mode == "download":
        error = memory.finish_program(unit.state, download, unit.model)
        unit.set_program(unit.state.program)
    port.mode = "command"
    if error:
        unit.state.error_code = unit.profile.code(error)
    unit.reply(port.number, REFUSED if error else ACCEPTED)
