"""`twoletter doctor`: what is wrong with a connection, in words."""

from __future__ import annotations

import argparse
import sys
from contextlib import ExitStack

from app.cli.failure import DONE, NO, UNUSABLE, Failure
from app.cli.line import checked_port, line_settings
from app.cli.sources import DEFAULT_MODEL
from device.doctor import Diagnosis, Doctor, Trouble
from device.download import Job
from device.simulator.process import SimulatorFailed, SimulatorProcess


def doctor(options: argparse.Namespace) -> int:
    """Prints the diagnosis and the next steps; 0 when a controller answers, 1 when something is wrong."""
    port, line = checked_port(options.port), line_settings(options)
    with ExitStack() as stack:
        if port.partition(":")[0] == "simulator":
            name = port.partition(":")[2] or DEFAULT_MODEL
            if name == "smartmotor":
                raise Failure(f"{port}: a SmartMotor does not speak two-letter code")
            try:
                process = stack.enter_context(SimulatorProcess(name))
                process.state()  # it has started
                port = process.address
            except SimulatorFailed as problem:
                raise Failure(f"{port}: {problem}") from problem
        diagnosis = Doctor(port, line, Job(shown)).examine()
    if sys.stderr.isatty():
        print(file=sys.stderr)
    if diagnosis.trouble is Trouble.ADDRESS:
        raise Failure(f"{options.port}: {diagnosis.sentence}", UNUSABLE)
    print(diagnosis.words)
    return DONE if diagnosis.fine else NO


def shown(job: Job[Diagnosis]) -> None:
    """What is tried, on one line of a terminal."""
    if sys.stderr.isatty():
        print(f"\r{job.phase:<40}", end="", file=sys.stderr, flush=True)
