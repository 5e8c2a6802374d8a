"""Which controller is connected, and whether it is the one a setup was written for (safety.md, 5)."""

from __future__ import annotations

from dataclasses import replace

import pytest

from codegen.setup import Setup
from device.api import Controller, State
from device.simulator.twoletter.profile import Profile
from tests.device.bench import Bench


def connected(model: str, serial: int) -> Bench:
    bench = Bench(model)
    bench.simulation.unit.profile = replace(Profile(), serial_number=serial)
    return bench.ready()


@pytest.mark.parametrize("number", ["", "4711", " 4711 "])
def test_the_controller_the_setup_was_written_for(number: str) -> None:
    bench = connected("ssc2", 4711)
    assert bench.controller.mismatch(Setup(model="ssc2", serial_number=number)) == ""
    assert "serial number 4711" in bench.controller.who


@pytest.mark.parametrize(
    ("model", "serial", "setup", "words"),
    [
        ("ssc4", 4711, Setup(model="ssc2"), ("SSC, two axes", "SSC, four axes", "4711")),
        ("dmc1412", 4711, Setup(model="ssc1"), ("SSC, one axis", "DMC-1412")),
        ("dmc1414", 4711, Setup(model="dmc1412"), ("DMC-1412", "DMC-1414")),
        ("ssc2", 4712, Setup(model="ssc2", serial_number="4711"), ("4711", "4712")),
        ("ssc2", 0, Setup(model="ssc2", serial_number="4711"), ("4711", "no serial number")),
        ("ssc2", 0, Setup(model="ssc2", serial_number="0"), ("number 0", "no serial number")),
        ("ssc2", 4711, Setup(model="ssc2", serial_number="A4711"), ("A4711", "4711")),
    ],
)
def test_another_controller(model: str, serial: int, setup: Setup, words: tuple[str, ...]) -> None:
    told = connected(model, serial).controller.mismatch(setup)
    assert told.endswith(".")
    assert "\n" not in told
    for word in words:
        assert word in told


def test_a_controller_exchanged_behind_the_cable_is_noticed() -> None:
    bench = connected("ssc2", 4711)
    setup = Setup(model="ssc2", serial_number="4711")
    bench.loopback.unplugged = True
    bench.run_until(lambda: bench.controller.state is State.LOST)
    assert "not asked yet" in bench.controller.mismatch(setup)
    bench.simulation.unit.profile = replace(Profile(), serial_number=9)
    bench.loopback.unplugged = False
    bench.run_until(lambda: bench.controller.state is State.READY)
    assert "serial number 9" in bench.controller.mismatch(setup)


def test_offline_nothing_is_known() -> None:
    assert "not asked yet" in Controller.offline().mismatch(Setup(model="ssc2"))
