"""Nothing that comes over the line breaks the controller: it answers, and it can always be stopped."""

from __future__ import annotations

import random

import pytest

from codegen.twoletter.commands import COMMANDS
from tests.device.simulator.bench import Bench
from tests.long import count

LINES = count(3_000, 1_000_000)
CHUNK = 500
SLOW = frozenset({"RS", "BN", "BV", "BP", "BS"})  # BS turns the motor there and back (dmc-1412-1414.txt l.730)
# A trippoint typed at the port holds the port until it is over, AI or AM of a jog for ever (dmc-1412-1414.txt l.988).
NAMES = [name for name, row in COMMANDS.items() if name.isalpha() and name not in SLOW and not row.trippoint]
ARGUMENTS = [
    " ",
    " ?",
    " 1",
    " -1",
    " 0",
    " 100",
    " 9999999999",
    " X",
    " XY",
    " S",
    " A[0]",
    " N",
    " #A",
    " 1,2",
    " ,,3",
    " $FF",
    ' "AB"',
    " _TPX",
    " @SIN[N]",
    " (1+2)*N",
    " N=1",
    " *",
    " {F2.1}",
    " X{$4.2}",
]
OTHERS = ["N=N+1", "A[1]=N", "V1=", "N={F3.1}", "XX", "pr", "=", "DM A[9]", "", "#Q", "%0", "!BG", "N=_TPX*2"]
LEAVE = "\x11\x1b\\\r\x1b\\\r"  # whatever takes characters for something else than commands
QUIET = "CI0,0,0\rHX\rST\rAB\r"


def command(chance: random.Random) -> str:
    if chance.random() < 0.15:
        return chance.choice(OTHERS)
    number = str(chance.randint(-40000, 40000))
    return chance.choice(NAMES) + chance.choice([*ARGUMENTS, number, number])


def recover(bench: Bench) -> None:
    """Whatever state it is in, it comes back to the prompt and stands still; SA and % may have turned it away."""
    recovery = f"{LEAVE}%{bench.simulation.unit.address}\r{QUIET}"
    bench.type(recovery, ms=1500)
    bench.type(recovery, ms=1500)
    assert bench.type("\r", ms=50).endswith(":")
    assert not bench.simulation.unit.running()
    assert not bench.simulation.unit.moving()


@pytest.mark.parametrize("seed", range(LINES // CHUNK))
def test_any_lines_are_answered(seed: int) -> None:
    chance = random.Random(seed)
    bench = Bench(chance.choice(["ssc1", "ssc3", "ssc4", "dmc1412", "dmc1414"]))
    bench.load("#A\nWT 2\nN=0\nJP#A,N<1\nEN")
    bench.type("N=0;DM A[5]\r")
    for _ in range(CHUNK):
        bench.type(command(chance) + "\r", ms=chance.choice([0, 1, 3]))
        if chance.random() < 0.02:
            bench.simulation.stimulus(chance.choice(["in1", "fls_x", "abort", "home_x"]), chance.randint(0, 1))
    bench.simulation.stimulus("abort", 1)
    recover(bench)


@pytest.mark.parametrize("seed", range(count(4, 200)))
def test_any_bytes_can_be_stopped(seed: int) -> None:
    chance = random.Random(seed)
    bench = Bench("ssc2", baud=chance.choice([None, 38400]), handshake=chance.random() < 0.5)
    for _ in range(40):
        bench.type("".join(chr(chance.choice([chance.randrange(256), 13, 59])) for _ in range(60)), ms=20)
        bench.type("\x11\x1b\\\rDL\r#A;JP#A\r\\XQ#A\r", ms=20)
    recover(bench)
