"""One controller of a daisy chain of three over one line: `%n` before commands (dmc-1412-1414.txt l.1302-1324)."""

from __future__ import annotations

import pytest

from codegen.models import model
from device.api import LinkError, NotAllowed, State, StopState, jog
from device.simulator.chain import make_chain
from device.simulator.eeprom import read_eeproms
from tests.device.bench import Bench

RAMP = 256_000


def chained(address: int | None, ready: bool = True) -> Bench:
    chain = make_chain(model("ssc1"), None, read_eeproms(None, 3), baud=19200, compiled=False)
    bench = Bench("ssc1", simulation=chain, address=address)
    return bench.ready() if ready else bench


def places(bench: Bench) -> list[int]:
    return [state["axes"]["X"]["commanded"] for state in bench.simulation.state()["chain"]]


@pytest.mark.parametrize("address", [0, 1, 2])
def test_only_the_chosen_one_is_read_and_moved(address: int) -> None:
    bench = chained(address)
    bench.controller.watch("test", ["position.x"])
    bench.ask("SH")
    bench.raw(f"%{(address + 1) % 3}\r".encode(), 0.2)  # somebody else on the line
    ended = bench.result(bench.controller.motion.go(jog.by("X", 700, 20_000, RAMP, RAMP)))
    assert ended.places == {"X": 700}
    assert places(bench) == [700 if place == address else 0 for place in range(3)]
    bench.run(1.0)
    assert bench.controller.last().value("position.x") == pytest.approx(700, abs=3)


def test_a_hold_moves_the_chosen_one_and_stop_stops_all() -> None:
    bench = chained(1)
    bench.ask("SH")
    bench.raw(b"!SH\r!JG 5000\r!BG X\r%1\r", 0.3)
    bench.raw(b"ST X\r", 0.3)
    bench.controller.motion.hold("X", 20_000, RAMP, RAMP)
    for _ in range(10):
        bench.run(0.05)
        bench.controller.motion.renew()
    before = places(bench)
    assert before[1] > 5000
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED)
    assert not any(state["axes"]["X"]["moving"] for state in bench.simulation.state()["chain"])


def test_a_program_goes_into_the_chosen_one() -> None:
    bench = chained(2)
    assert bench.result(bench.controller.download("#A\nN=1\nEN").future).verified
    held = [unit.unit.state.program for unit in bench.simulation.units]
    assert held == [(), (), ("#A", "N=1", "EN")]


@pytest.mark.parametrize("line", ["%2", "%0;TP", "TP;%2", " % 2"])
@pytest.mark.parametrize("address", [None, 1])
def test_an_address_is_no_matter_of_the_terminal(line: str, address: int | None) -> None:
    """Readings of another controller would be shown as those of this one."""
    bench = chained(address)
    with pytest.raises(NotAllowed, match="Another address"):
        bench.result(bench.controller.ask(line))
    assert bench.ask("V=5;V={F1.0}").strip() == "5"
    assert 'MG "100%"' not in bench.sent.decode("latin-1")
    assert bench.ask('MG "100%2"') == "100%2"


def test_an_address_nobody_has_is_said() -> None:
    bench = chained(5, ready=False)
    bench.run_until(lambda: bench.controller.state is State.LOST, 15.0)
    assert bench.controller.state_text.startswith("No controller with address 5 answers in the chain")
    with pytest.raises(LinkError):
        bench.result(bench.controller.ask("TP"))
