"""Which ports there are, and who answers: listens, asks before writing to a strange port, sends only CR and ^R^V."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection
from dataclasses import dataclass

from serial.tools import list_ports

from codegen.models import Model
from device.door import REVISION
from device.identify import model_of
from device.transport import LineSettings, OpenFailed, Transport, TransportLost, open_transport
from device.wire import Kind, Revision, Wire

LISTEN_S = 0.3
ANSWER_S = 0.7


@dataclass(frozen=True, slots=True)
class Port:
    """A serial port of this computer."""

    device: str
    description: str
    hardware: str
    used_before: bool


@dataclass(frozen=True, slots=True)
class Found:
    """What answered: its revision text and the type that text names, if it is known."""

    address: str
    text: str
    model: Model | None


def ports(used: Collection[str] = ()) -> list[Port]:
    """The serial ports there are, those used before first."""
    found = [
        Port(each.device, _words(each.description), _words(each.hwid), each.device in used)
        for each in list_ports.comports()
    ]
    return sorted(found, key=lambda port: (not port.used_before, port.device))


def _words(text: str | None) -> str:
    return "" if text in (None, "n/a") else str(text)


def probe(
    address: str,
    line: LineSettings,
    *,
    used_before: bool,
    ask: Callable[[str], bool],
    open_: Callable[[str, LineSettings], Transport] = open_transport,
    clock: Callable[[], float] = time.monotonic,
) -> Found | str:
    """Who is at this address, or why nobody is; `ask` is asked before a port never used is written to."""
    try:
        transport = open_(address, line)
    except OpenFailed as reason:
        return str(reason)
    try:
        return _talk(transport, address, used_before, ask, clock)
    except TransportLost as reason:
        return str(reason)
    finally:
        transport.close()


def _talk(
    transport: Transport, address: str, used_before: bool, ask: Callable[[str], bool], clock: Callable[[], float]
) -> Found | str:
    wire = Wire()
    _listen(transport, wire, LISTEN_S, clock)
    if not used_before and not ask(f"{address} was never used here. Send it a carriage return to see who answers?"):
        return f"{address} was left alone."
    wire.expect(Revision())
    transport.write(REVISION)
    _listen(transport, wire, ANSWER_S, clock)
    answer = wire.answer()
    if answer is not None and answer.kind is Kind.ACCEPTED:
        return Found(address, answer.text, model_of(answer.text))
    wire.give_up()
    transport.write(b"\r")
    came = _listen(transport, wire, ANSWER_S, clock)
    if came.rstrip().endswith(b":"):
        return Found(address, "", None)
    return f"Nothing that speaks two-letter code answers at {address}; check speed, cable and power."


def _listen(transport: Transport, wire: Wire, seconds: float, clock: Callable[[], float]) -> bytes:
    end = clock() + seconds
    came = b""
    while clock() < end:
        data = transport.read(0.02)
        wire.feed(data)
        came += bytes(byte & 0x7F for byte in data)
    return came
