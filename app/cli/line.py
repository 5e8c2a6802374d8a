"""Connects a call of the command line to a controller, and lets go of it again."""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

from app.cli.failure import UNUSABLE, Failure
from app.cli.sources import known_models, read_profile
from codegen.models import MODELS
from device.api import Controller, Kind, State
from device.tasks import LinkError
from device.transport import LineSettings

Result = TypeVar("Result")
CONNECT_S = 40.0  # a simulator may have to compile its sample loop first
STARTING_S = 10.0  # a computer that is busy needs as long to start one
TICK_S = 0.02
DEFAULT_BAUD = 9600


def line_settings(options: argparse.Namespace) -> LineSettings:
    """The line as the options describe it."""
    if options.baud is not None and options.baud < 1:
        raise Failure("--baud must be greater than 0")
    return LineSettings(baud=options.baud or DEFAULT_BAUD, handshake=options.handshake, address=options.address)


def checked_port(text: str) -> str:
    """A port's name; the model of a simulator must exist."""
    kind, _, name = text.partition(":")
    if kind == "simulator" and name and name not in MODELS:
        raise Failure(f"--port {text}: no controller model {name} (there are {known_models()})")
    return text


@contextmanager
def connected(options: argparse.Namespace) -> Iterator[Controller]:
    """A connected controller; in Control where that was asked for or it is a simulator."""
    port, settings = checked_port(options.port), line_settings(options)
    read_profile(options.profile)
    controller = Controller.connect(port, settings, profile=Path(options.profile) if options.profile else None)
    try:
        wait_for(controller, options.port)
        if options.control and not controller.control:
            controller.take_control()
        yield controller
    finally:
        controller.close()


def wait_for(controller: Controller, port: str) -> None:
    """Waits until the controller has answered, a simulated one also while it starts; the reason when it does not."""
    end = time.monotonic() + CONNECT_S
    starts = time.monotonic() + (0 if is_machine(controller) else STARTING_S)
    last = ""
    while controller.state is not State.READY:
        last = next((notice.text for notice in reversed(controller.notices())), last)
        now = time.monotonic()
        if (controller.state is State.LOST and now > starts) or now > end:
            raise Failure(f"{port}: {last or 'no answer from a controller'}")
        time.sleep(TICK_S)


def result_of(future: Future[Result], port: str, code: int = UNUSABLE) -> Result:
    """Waits for an answer; what went wrong becomes one sentence."""
    try:
        return future.result()
    except LinkError as problem:
        raise Failure(f"{port}: {problem}", code) from problem


def is_machine(controller: Controller) -> bool:
    """Whether something real hangs on the line."""
    return controller.kind is Kind.MACHINE
