"""Burning a program: it survives switching off, and whatever comes in between is no success."""

from __future__ import annotations

import pytest

from device.api import LinkError, State
from tests.device.bench import Bench
from tests.device.test_download import PROGRAM, works_again


def test_a_program_is_burned() -> None:
    """It is there again after the power was off (dmc-1412-1414.txt l.2963)."""
    bench = Bench("ssc4").ready()
    bench.result(bench.controller.download("#A\nPR 7\nEN").future)
    assert bench.result(bench.controller.burn_program()).accepted
    bench.simulation.stimulus("reset", 0)
    bench.simulation.stimulus("reset", 1)
    bench.run(4.0)
    assert bench.result(bench.controller.upload().future).rstrip("\n") == "#A\nPR 7\nEN"


def test_a_cable_pulled_while_burning() -> None:
    bench = Bench("ssc4").ready()
    bench.result(bench.controller.download(PROGRAM).future)
    future = bench.controller.burn_program()
    bench.run(0.5)
    bench.loopback.unplugged = True
    with pytest.raises(LinkError, match="No answer"):
        bench.result(future)
    bench.loopback.unplugged = False
    bench.run_until(lambda: bench.controller.state is State.READY, 30.0)
    assert bench.ask("TPX") == " 0000000000"


def test_a_controller_switched_off_while_burning_is_no_success() -> None:
    bench = Bench("ssc4").ready()
    bench.result(bench.controller.download(PROGRAM).future)
    future = bench.controller.burn_program()
    bench.run(0.3)
    bench.simulation.stimulus("reset", 0)
    bench.simulation.stimulus("reset", 1)
    with pytest.raises(LinkError) as failure:
        bench.result(future)
    assert "\n" not in str(failure.value)
    works_again(bench)


def test_garbage_while_burning_is_no_refusal() -> None:
    """Some `?` on the line are not the answer; the proof behind the command is."""
    bench = Bench("ssc4").ready()
    bench.result(bench.controller.download(PROGRAM).future)
    transmit, noise = bench.simulation.transmit, [b"\xf7?\x81:"]
    future = bench.controller.burn_program()
    bench.run(0.3)
    bench.simulation.transmit = lambda port: (noise.pop() if noise else b"") + transmit(port)  # type: ignore[method-assign]
    assert bench.result(future, 40.0).accepted
