"""Days of virtual time with random programs, characters and switches: nothing breaks, hangs or grows."""

from __future__ import annotations

import gc
import random
import re
import time
from pathlib import Path

import pytest

from codegen.models import model
from device.simulator.chain import make_chain
from device.simulator.eeprom import read_eeproms
from tests.device.simulator.bench import MS
from tests.device.simulator.soak import FRAME, Soak
from tests.long import count, is_long, record

STATM = Path("/proc/self/statm")
PAGE_MB = 4096 / 1e6
MOST_GROWTH_MB = 8


def resident_mb() -> float:
    gc.collect()
    return int(STATM.read_text().split()[1]) * PAGE_MB if STATM.exists() else 0.0


@pytest.mark.timeout(7200)
@pytest.mark.parametrize("seed", [3, 11, 12] if is_long() else [3])
def test_a_soak(seed: int) -> None:
    """Ten virtual minutes (long: a day for each seed)."""
    seconds = count(600, 86_400)
    soak = Soak(seed=seed)
    began, warm = time.process_time(), 0.0
    while soak.seconds < seconds:
        soak.episode()
        if not warm and soak.seconds > seconds / 4:
            warm = resident_mb()
    grown = resident_mb() - warm
    assert soak.busy > soak.looks / 2  # most of the programs are still at work when they are interfered with
    assert soak.answers == soak.episodes >= seconds / 60
    assert grown < MOST_GROWTH_MB
    command = "pytest tests/device/simulator/test_soak.py::test_a_soak"
    record("soak: virtual time, no answer missing", command, None, soak.seconds / 3600, "h", add=True)
    record(f"soak {seed}: growth of memory", command, seed, grown, "MB")
    record(f"soak {seed}: virtual over processor time", command, seed, soak.seconds / (time.process_time() - began), "")


@pytest.mark.timeout(1800)
@pytest.mark.parametrize("name", ["ssc1", "ssc4", "dmc1412", "dmc1414"])
def test_other_controllers(name: str) -> None:
    soak = Soak(seed=2, name=name)
    while soak.seconds < count(60, 3600):
        soak.episode()
    assert soak.answers == soak.episodes > 1


def test_the_same_soak_is_the_same() -> None:
    ends = []
    for _ in range(2):
        soak = Soak(seed=3)
        soak.episode()
        soak.episode()
        ends.append((soak.simulation.ticks, soak.simulation.motion.snapshot().tobytes(), soak.simulation.unit.state))
    assert ends[0] == ends[1]


@pytest.mark.timeout(1800)
def test_a_chain_of_eight() -> None:
    """Every controller runs its program and is asked in turn; each answers for itself, in a frame."""
    chance = random.Random(4)
    chain = make_chain(model("dmc1412"), None, read_eeproms(None, 8))

    def wait(ms: int) -> str:
        chain.advance(ms * MS)
        chain.rest(200)
        return chain.transmit(1).decode("latin-1")

    def type_(text: str, ms: int) -> str:
        chain.receive(1, text.encode("latin-1"))
        return wait(ms)

    for place in range(8):
        assert type_(f"%{place}\r", 20) == ":"
        assert type_(f"NUMBER={place};SP {1000 * place + 1000}\r", 30) == "::"
        program = f"#A\rPR {chance.randint(-900, 900)}\rBG;AM\rWT {chance.randint(5, 60)}\rN=N+1\rJP#A"
        assert type_(f"DL\r{program}\r\\", 60) == ":"
        assert type_("N=0;XQ #A\r", 20) == "::"
    rounds = count(60, 6000)
    for number in range(rounds):
        place = chance.randrange(8)
        answer = type_(f'%{place}\rMG{{^30}},"k{number % 10}",NUMBER{{F10.0}},{{^31}}\r', chance.choice([40, 90]))
        found = FRAME.fullmatch(answer[1:-1])
        assert found is not None and answer[0] == ":" == answer[-1], answer
        assert (found.group(1), int(found.group(2))) == (f"k{number % 10}", place)
        if chance.random() < 0.2:
            assert type_("!TC\r", 40) == "000\r\n:"  # all obey, address 0 answers (dmc-1412-1414.txt l.1305)
        if chance.random() < 0.2:
            type_("".join(chr(chance.randrange(32, 127)) for _ in range(20)).replace("%", "") + "\r", 60)
            type_("\x1b\\\r%0\rTC\r", 60)
            type_("!TC\r", 60)
    assert re.fullmatch(":+", type_("!HX\r!ST\r", 900))
    for place, simulation in enumerate(chain.units):
        assert simulation.unit.state.variables["N"] > 0, place
        assert not simulation.unit.running() and not simulation.unit.moving()
