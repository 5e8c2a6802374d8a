"""STOP over real file descriptors whose line is held, half used, or goes nowhere (safety.md, 1)."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable

import pytest

from device.api import Controller, Kind, State, StopState
from device.simulator.process import SimulatorProcess
from device.transport import LineSettings, open_transport
from tests.device.test_latency import NO_PTY, connected, wait_until
from tests.slower import queued_s

pytestmark = NO_PTY
XOFF = b"\x13"


@pytest.fixture
def pair() -> tuple[int, str]:
    """A pseudo-terminal: our end, and the name under which the other one is opened."""
    import pty

    ours, theirs = pty.openpty()
    return ours, os.ttyname(theirs)


def test_a_line_held_by_xoff_takes_nothing_and_never_blocks(pair: tuple[int, str]) -> None:
    """The kernel answers "try again" to every write; the link's thread must not wait there."""
    ours, name = pair
    port = open_transport(name, LineSettings(baud=19200, handshake="xon"))
    assert port.write(b"PR 1\r") == 5
    assert os.read(ours, 100) == b"PR 1\r"
    os.write(ours, XOFF)
    time.sleep(0.1)
    began = time.monotonic()
    assert port.write(b"PR 2\r") == 0
    assert time.monotonic() - began < 5.0
    port.discard_output()
    assert port.write(b"ST\r") == 3
    assert os.read(ours, 100).endswith(b"ST\r")
    port.close()


def test_without_that_handshake_xoff_is_a_character_like_any_other(pair: tuple[int, str]) -> None:
    ours, name = pair
    port = open_transport(name, LineSettings(baud=19200))
    os.write(ours, XOFF)
    assert port.read(1.0) == XOFF
    assert port.write(b"PR 2\r") == 5
    port.close()


def moving(process: SimulatorProcess) -> bool:
    return any(axis["moving"] for axis in process.state()["axes"].values())


def stands(process: SimulatorProcess) -> bool:
    return not moving(process) and not any(thread["running"] for thread in process.state()["threads"])


def jogging(process: SimulatorProcess, controller: Controller, *lines: str) -> None:
    for line in ("SH", "JG 50000;BG X", *lines):
        assert controller.ask(line).result(5).accepted
    wait_until(lambda: moving(process))


def on_the_wire(controller: Controller, data: bytes) -> None:
    """Characters past the link, between two of its reads."""
    transport = controller.link.transport
    assert transport is not None
    transport.write(data)
    time.sleep(0.05)


@pytest.mark.paced
def test_stop_through_a_line_that_the_controller_holds_by_xoff() -> None:
    """A program sends character 19: this computer's port takes it for XOFF and lets nothing out any more."""
    line = LineSettings(baud=19200, handshake="xon")
    with SimulatorProcess("ssc1", baud=19200, pty=True) as process:
        controller = Controller(lambda: open_transport(process.address, line), kind=Kind.SIMULATOR, line=line)
        try:
            wait_until(lambda: controller.state is State.READY)
            controller.download("#A\nMG {^19}{N}\n#B\nWT 20\nJP #B").future.result(20)
            jogging(process, controller)
            controller.execute("A", anyway=True)  # its answer may be lost
            wait_until(lambda: process.state()["threads"][0]["running"])
            time.sleep(0.1)
            controller.stop()
            wait_until(lambda: stands(process))
            wait_until(lambda: controller.stop_state is StopState.STOPPED)
        finally:
            controller.close()


@pytest.mark.paced
def test_stop_from_what_stands_on_the_wire() -> None:
    """Our XOFF to the controller, half a line, a download begun behind the link's back, a port that is busy."""
    with connected(19200, pty=True) as (process, controller):
        for held in (XOFF, b"PR 100", b"BG", b"DL\rPR 7\rBG", b"WT 400\r"):
            jogging(process, controller)
            on_the_wire(controller, held)
            controller.stop()
            wait_until(lambda: stands(process))
            wait_until(lambda: controller.stop_state is StopState.STOPPED)
        assert "ST" not in controller.upload().future.result(20).replace("\n", ";").split(";")


def not_confirmed_in_time(controller: Controller, press: Callable[[], None]) -> None:
    began, queued = time.monotonic(), queued_s()
    press()
    wait_until(lambda: controller.stop_state is not StopState.STOPPING)
    assert time.monotonic() - began - (queued_s() - queued) <= 0.55  # without what other programs took
    assert controller.stop_state is StopState.NOT_CONFIRMED


@pytest.mark.alone
@pytest.mark.parametrize("pty", [False, True])
def test_a_controller_that_is_frozen_and_thaws(pty: bool) -> None:
    """Nothing takes our characters (as with CTS held): not confirmed at 500 ms, confirmed once it goes on."""
    with connected(19200, pty=pty) as (process, controller):
        jogging(process, controller)
        os.kill(process.pid, signal.SIGSTOP)
        try:
            not_confirmed_in_time(controller, controller.stop)
        finally:
            os.kill(process.pid, signal.SIGCONT)
        wait_until(lambda: controller.stop_state is StopState.STOPPED)
        assert stands(process)


@pytest.mark.alone
@pytest.mark.parametrize("pty", [False, True])
def test_a_controller_that_is_gone(pty: bool) -> None:
    """The process dies: the port's other end closes; STOP never claims anything."""
    with connected(19200, pty=pty) as (process, controller):
        os.kill(process.pid, signal.SIGKILL)
        not_confirmed_in_time(controller, controller.stop)
        wait_until(lambda: controller.state is State.LOST)
        assert "STOP" not in controller.state_text
