"""`twoletter simulate`: a simulated controller in real time, until interrupted."""

from __future__ import annotations

import argparse
import signal
import threading
from pathlib import Path

from app.cli.failure import DONE, Failure
from app.cli.run import read_plants
from app.cli.sources import DEFAULT_MODEL, read_profile, said_of, target
from codegen.models import model
from device.simulator.eeprom import Eeprom, EepromUnreadable, read_eeproms
from device.simulator.lines import open_line, open_second
from device.simulator.server import MOST_IN_CHAIN, maker, serve

LOOPBACK = ("127.0.0.1", "localhost", "::1", "")
ANY_PORT = "127.0.0.1:0"


def tcp_address(text: str | None, option: str = "--tcp") -> str:
    """HOST:PORT on this computer; other hosts are refused, the simulator has no lock on its door."""
    if text is None:
        return ANY_PORT
    host, colon, port = text.rpartition(":")
    if not colon or not port.isdecimal() or int(port) > 65535:
        raise Failure(f"{option} {text}: needs HOST:PORT, for example {ANY_PORT}")
    if host.strip("[]") not in LOOPBACK:
        raise Failure(f"{option} {text}: a simulated controller is served on this computer only, use 127.0.0.1:{port}")
    return f"127.0.0.1:{port}" if host in ("", "localhost") else text


def end_when_interrupted() -> None:
    """Ctrl-C and a request to end are the same, also where whoever started us ignores Ctrl-C."""
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.signal(signal.SIGTERM, signal.default_int_handler)


def eeproms_of(path: str | None, count: int) -> list[Eeprom]:
    """What keeps the burned data of each controller."""
    if path:
        target(path)  # nothing is written yet: better said now than at the first burn
    try:
        return read_eeproms(Path(path) if path else None, count)
    except (EepromUnreadable, OSError) as problem:
        raise said_of(Path(path or ""), problem) from problem


def simulate(options: argparse.Namespace) -> int:
    """Serves until interrupted."""
    name = options.controller or DEFAULT_MODEL
    if options.chain is not None and not 1 <= options.chain <= MOST_IN_CHAIN:
        raise Failure(f"--chain {options.chain}: a daisy chain has 1 to {MOST_IN_CHAIN} controllers")
    if name == "smartmotor":
        raise Failure("a simulated smartmotor is not available yet")
    if options.pty and options.tcp:
        raise Failure("--pty and --tcp exclude each other")
    if options.baud is not None and options.baud < 1:
        raise Failure("--baud must be greater than 0")
    eeproms = eeproms_of(options.eeprom, options.chain or 1)
    plants = read_plants(options.plant)
    profile = read_profile(options.profile)
    tcp = None if options.pty else tcp_address(options.tcp)
    port2 = options.port2 if options.port2 in (None, "pty") else tcp_address(options.port2, "--port2")
    end_when_interrupted()
    try:
        line = open_line(pty=options.pty, tcp=tcp)
        second = open_second(port2) if port2 else None
    except OSError as problem:
        raise Failure(f"cannot listen on {tcp or 'a pseudo-terminal'}: {problem.strerror}") from problem
    make = maker(
        model(name),
        plants,
        eeproms,
        chain=options.chain is not None,
        baud=options.baud,
        handshake=not options.no_handshake,
        profile=profile,
    )
    serve(make, line, second=second)
    return DONE
