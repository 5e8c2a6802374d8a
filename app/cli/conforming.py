"""`twoletter conform`: a motionless comparison of a controller with the simulator's assumptions."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from app.cli.failure import DONE, NO, Failure
from app.cli.line import CONNECT_S, checked_port, line_settings
from app.cli.sources import DEFAULT_MODEL, target, write_text
from codegen.models import model
from device.conform import Report, Unfit
from device.conform import conform as check
from device.simulator.process import SimulatorFailed, SimulatorProcess
from device.simulator.twoletter.profile_file import profile_text
from device.transport import LineSettings, OpenFailed, Transport, TransportLost, open_transport

PATIENCE_S = 3.0


@contextmanager
def opened(port: str, line: LineSettings) -> Iterator[Transport]:
    """The line to a controller, or to a simulated one of its own."""
    if port.partition(":")[0] == "simulator":
        name = port.partition(":")[2] or DEFAULT_MODEL
        if name == "smartmotor":
            raise Failure(f"{port}: a SmartMotor does not speak two-letter code")
        with SimulatorProcess(name) as process, opened(process.address, line) as transport:
            yield transport
        return
    transport = open_transport(port, line)
    try:
        yield transport
    finally:
        transport.close()


def conform(options: argparse.Namespace) -> int:
    """Prints how the controller differs and writes its profile; 1 when it differs."""
    output = target(options.output, ending=".toml") if options.output else None
    refuse_existing(output, options.force)
    line = line_settings(options)
    expected = model(options.controller) if options.controller else None
    try:
        with opened(checked_port(options.port), line) as transport:
            report = check(
                transport,
                clock=time.monotonic,
                byte_s=line.byte_s,
                model=expected,
                address=options.address,
                cw=options.cw,
                patience_s=CONNECT_S if options.port.startswith("simulator") else PATIENCE_S,
                progress=shown_progress,
            )
    except (Unfit, OpenFailed, TransportLost, SimulatorFailed) as problem:
        raise Failure(f"{options.port}: {problem}") from problem
    finally:
        if sys.stderr.isatty():
            print(file=sys.stderr)
    output = output or free_name(report.model.name, options.force)
    for each in told(report):
        print(each)
    about = f"{report.named}, compared with the simulated {report.model.name}; nothing was moved."
    write_text(output, profile_text(report.profile, about))
    print(f"profile: {output}")
    return NO if report.differences or report.odd else DONE


def refuse_existing(output: Path | None, force: bool) -> None:
    """An existing file is overwritten only with --force."""
    if output and output.exists() and not force:
        raise Failure(f"{output} exists already (--force overwrites it)")


def free_name(name: str, force: bool) -> Path:
    """MODEL-profile.toml, or the next one that is not there."""
    number, path = 1, target(f"{name}-profile.toml")
    while path.exists() and not force:
        number += 1
        path = target(f"{name}-profile-{number}.toml")
    return path


def shown_progress(title: str) -> None:
    """What is looked at, on one line of a terminal."""
    if sys.stderr.isatty():
        print(f"\r{title:<40}", end="", file=sys.stderr, flush=True)


def told(report: Report) -> Iterator[str]:
    """The report, a line each."""
    yield f"{report.named} ({report.model.name}): {len(report.seen)} settings seen, {len(report.differences)} differ"
    for difference in report.differences:
        yield f"differs: {difference.sentence}"
    for sentence in report.odd:
        yield f"not understood: {sentence}"
    for what, reason in report.unseen.items():
        yield f"not seen: {what}: {reason}"
