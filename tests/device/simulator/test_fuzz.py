"""Nothing that comes over the line breaks the controller: it answers, can be stopped, and is then as good as new."""

from __future__ import annotations

import random
from functools import cache

import pytest

from codegen.models import MODELS
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.nodes import Command
from codegen.twoletter.parse import parse
from device.simulator.plant import Plant
from tests.codegen.twoletter.test_fuzz import mutated
from tests.device.simulator.bench import Bench
from tests.long import count, record

CHUNK = 2_500
CHUNKS = count(30_000, 1_000_000) // CHUNK
NAMED = ("ssc1", "ssc2", "ssc3", "ssc4", "dmc1412", "dmc1414")
SLOW = frozenset({"RS", "BN", "BV", "BP", "BS"})  # BS turns the motor there and back (dmc-1412-1414.txt l.730)
# A trippoint typed at the port holds the port until it is over, AI or AM of a jog for ever (dmc-1412-1414.txt l.988).
HOLDING = SLOW | {"BZ"} | {name for name, row in COMMANDS.items() if row.trippoint}
NAMES = [name for name in COMMANDS if name.isalpha() and name not in HOLDING]
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
PROGRAM = "\x11\x1b\\\rDL\r#A;WT 2;N=0;JP#A\r\\XQ#A\r"
LEAVE = "\x11\x1b\\\r\x1b\\\r"  # whatever takes characters for something else than commands
QUIET = "CI0,0,0\rHX\rST\rAB\r"
SIGNALS = ("in1", "in7", "fls_x", "rls_x", "abort", "home_x")
SESSION = [
    "TC1", "MG _XQ0,_BGX,_RPX", "TI;TB;TS", "PR 4000;PR ?", "KP?;KD?;KI?", "SP 3185;SP?", "V1=7.5*2/4;V1=",
    "AC 2000000;DC 2000000;SP 100000;BGX", "MG _BGX", "RP", "DM A[5];A[3]=12;A[3]=", "QQ", "TC1", "LS", "UL",
    "MG \"END\",@SQR[2]{F1.4}", "PF 6;RP", "\x12\x16",
]  # fmt: skip


def command(chance: random.Random) -> str:
    """A command as somebody might type it, often a wrong one."""
    if chance.random() < 0.15:
        return chance.choice(OTHERS)
    number = str(chance.randint(-40000, 40000))
    return chance.choice(NAMES) + chance.choice([*ARGUMENTS, number, number])


def garbage(chance: random.Random) -> str:
    """A line of any bytes, as noise on the cable would make it."""
    return "".join(map(chr, chance.randbytes(chance.randint(0, 30))))


def line(chance: random.Random) -> str:
    """Half grammar-aware, half bytes."""
    text = garbage(chance)
    if chance.random() < 0.5:
        text = mutated(chance).encode("latin-1", "replace").decode("latin-1")
        text = command(chance) if chance.random() < 0.7 else text
    return "" if holds(text) else text


def holds(text: str) -> bool:
    """Whether it keeps the port busy for long, or erases what the test put there."""
    names = {each.name for row in parse(text).lines for each in row.statements if isinstance(each, Command)}
    return bool(names & HOLDING) or "\x12" in text


def machine(model: str) -> Bench:
    """A controller whose motors come to rest by themselves, also after they ran away."""
    return Bench(model, plants={axis: Plant(viscous_friction=0.002) for axis in MODELS[model].axes})


def golden(bench: Bench) -> list[str]:
    """A session that asks, sets, moves, fails and lists."""
    return [bench.type(text + "\r", ms=400) for text in SESSION]


@cache
def golden_of_a_new_one(model: str) -> list[str]:
    return golden(machine(model))


def drained(bench: Bench) -> None:
    """Waits until the controller has taken what is on the line; where nothing helps (an XOFF, a question) it leaves."""
    for turn in range(320):  # RS and a reset take a second
        if not bench.simulation.uarts[0].line:
            return
        bench.wait(5)
        if turn % 20 == 19:
            bench.type(LEAVE, ms=20)
        wait = bench.simulation.unit.state.ports[0].wait
        if turn % 20 == 19 and wait is not None and wait.kind in HOLDING:  # bytes may spell MF: only a reset ends it
            for level in (0, 1):
                bench.simulation.stimulus("reset", level)
                bench.wait(1500)
    pytest.fail("the controller takes no more characters")


def recover(bench: Bench) -> None:
    """Whatever state it is in, it comes back to the prompt and stands still; SA and % may have turned it away."""
    recovery = f"{LEAVE}%{bench.simulation.unit.address}\r{QUIET}"
    bench.type(recovery, ms=1500)
    bench.type(recovery, ms=1500)
    assert bench.type("\r", ms=50).endswith(":")
    assert not bench.simulation.unit.running()
    assert not bench.simulation.unit.moving()


def as_good_as_new(bench: Bench) -> None:
    """After a master reset (^R^S) the golden session answers byte for byte what it answers on a new controller."""
    for signal in SIGNALS:
        bench.simulation.stimulus(signal, 1)
    recover(bench)
    bench.type("\x12\x13", ms=13_000)  # a motor that ran away comes to rest
    recover(bench)
    bench.type("TC1\r", ms=50)
    assert golden(bench) == golden_of_a_new_one(bench.simulation.unit.model.name)


@pytest.mark.timeout(600)
@pytest.mark.parametrize("seed", range(CHUNKS))
def test_any_lines_are_answered(seed: int) -> None:
    chance = random.Random(seed)
    bench = machine(NAMED[seed % len(NAMED)])
    bench.load("#A\nWT 2\nN=0\nJP#A,N<1\nEN")
    bench.type("N=0;DM A[5]\r")
    for number in range(CHUNK):
        bench.type(line(chance) + "\r", ms=0)
        if number % 4 == 0:  # XON before the buffer is full: an XOFF among the bytes would silence both sides for good
            bench.type("\x11", ms=5)
            drained(bench)
        if number % 50 == 0:
            bench.simulation.stimulus(chance.choice(SIGNALS), chance.randint(0, 1))
        if number % 500 == 0:
            bench.type(LEAVE + PROGRAM, ms=20)
    as_good_as_new(bench)
    if seed == CHUNKS - 1:
        record("fuzz: lines into the simulator, all answered", "tests/device/simulator/test_fuzz.py", 0,
               CHUNKS * CHUNK, "lines")  # fmt: skip


@pytest.mark.parametrize("seed", range(count(8, 400)))
def test_any_bytes_over_a_slow_line_can_be_stopped(seed: int) -> None:
    """Through the UART: paced, with and without handshake, so that characters overrun."""
    chance = random.Random(seed)
    bench = Bench("ssc2", baud=chance.choice([9600, 19200, 38400]), handshake=seed % 2 == 0)
    for _ in range(40):
        bench.type("".join(chr(chance.choice([chance.randrange(256), 13, 59])) for _ in range(60)), ms=20)
        bench.type(PROGRAM, ms=20)
    recover(bench)
