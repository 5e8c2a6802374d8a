"""The result never depends on how time is cut into slices; snapshots bring back every moment, bit for bit."""

from __future__ import annotations

import dataclasses
import random
from typing import Any

import pytest

from tests.device.simulator.bench import Bench
from tests.long import count, record

PROGRAM = """
#A
XQ#OUT,1
SP 20000,15000,10000,5000
#L
PR 2000,-1500,1000,500
BG
AD 1000
SB3
AM
CB3
WT 20
N=N+1
MG "N",N{F3.0},_TPX
JP#L,N<3
JG 3000;BGX
AI-2
STX;AMX
EN
#OUT
AT0
#P;SB1
AT 7
CB1
AT -15
JP#P
#LIMSWI;RE
#POSERR;V=V+1;RE
#ININT
MG "INT"
WT 3
RI1
"""
SCRIPT = (
    (0, 1, "N=0;V=0;II1\r"),
    (10, 1, "XQ#A\r"),
    (40, 1, "TP\r"),
    (120, "in1", 0),
    (130, "in1", 1),
    (200, "position_y", 300),
    (300, 1, "MG _TPZ,_TVX\rPR ?\rbg\r"),
    (600, "in2", 0),
    (700, 1, "HX;ST;TC1\r"),
)


def facts(bench: Bench) -> Any:
    simulation = bench.simulation
    return (
        dataclasses.asdict(simulation.unit.state),
        simulation.motion.snapshot().tobytes(),
        simulation.messages,
        simulation.errors,
        simulation.state(),
    )


def play(slice_ticks: int | None, seed: int = 0) -> tuple[Any, bytes]:
    bench = Bench("ssc4", baud=19200)
    bench.load(PROGRAM)
    simulation, sent = bench.simulation, b""
    chance = random.Random(seed)
    for ms, what, value in (*SCRIPT, (900, "in3", 1)):
        until = ms * 1024
        while simulation.ticks < until:
            step = until if slice_ticks is None else slice_ticks or chance.choice((1, 13, 511, 512, 999, 4096))
            simulation.advance(min(step, until - simulation.ticks))
            sent += simulation.transmit(1)
        if what == 1:
            simulation.receive(1, str(value).encode())
        else:
            simulation.stimulus(str(what), value)
    return facts(bench), sent


@pytest.mark.parametrize("slice_ticks", [1000, 7000, 100_000, 333, 0])
def test_slices_do_not_matter(slice_ticks: int) -> None:
    assert play(slice_ticks) == play(None)


def test_a_snapshot_brings_the_moment_back() -> None:
    bench = Bench("ssc4")
    bench.load(PROGRAM)
    bench.type("N=0;V=0;XQ#A\r")
    bench.wait(150)
    moment = bench.simulation.snapshot()
    bench.wait(300)
    bench.simulation.stimulus("in2", 0)
    bench.wait(300)
    first = facts(bench)[:2]
    bench.type("HX;ST;V=99;DM Q[5];EO1\r")
    bench.simulation.restore(moment)
    bench.wait(300)
    bench.simulation.stimulus("in2", 0)
    bench.wait(300)
    assert facts(bench)[:2] == first


def test_a_snapshot_survives_another_program() -> None:
    bench = Bench()
    bench.load("#A;N=N+1;JP#A")
    bench.type("N=0;XQ#A\r")
    moment = bench.simulation.snapshot()
    bench.simulation.unit.halt_all()
    bench.load("#B;EN")
    bench.simulation.restore(moment)
    before = bench.simulation.unit.state.variables["N"]
    bench.wait(100)
    assert bench.simulation.unit.state.variables["N"] > before


WORDS = (
    """
PR 100|PA -50,7|SP 2000|AC 100000|BG|BGX|BGYZ|AM|AMX|ST|STX|AB|AB1|JG 500|HM|FE|FI|SH|MO|DP 0|WT 1|WT 3|AT0|AT 5|AT -5
AI1|AI-2|SB1|CB2|OB1,N|OP 5|TP|TE|TS|TB|TC|TC1|TI|SC|RP|TV|TT|MG N|MG "x",_TPX|N=N+1|V[0]=1|DM V[5]|DA *|JP#A|JP#B,N<5
JS#S|EN|RE|RI|ZS|ZS1|HX|HX1|XQ#A,1|XQ#B,2|II1|II0|CN-1|CN1,1|EO0|LZ1|PF6|VF4.2|TM1000|TM2000|ER100|OE1|OE0|FL1000|BL-1000|KP?|PR?
TW10|MC|MF10|MR-10|AD5|AR5|AP20|AS|IP10|NO hello|TR0|TR1|#A|#B|#S|#CMDERR|#POSERR|#LIMSWI|#ININT
#MCTIME|CI,2|CW2|@|XX|bg|IN"q",N|=5
""".replace("\n", "|")
    .strip("|")
    .split("|")
)


def fuzz(seed: int, slices: bool) -> Any:
    chance = random.Random(seed)
    bench = Bench(chance.choice(["ssc1", "ssc4", "dmc1412"]), baud=chance.choice([None, 9600]))
    simulation = bench.simulation
    lines = [";".join(chance.choices(WORDS, k=chance.randint(1, 3)))[:40] for _ in range(30)]
    bench.type("N=0\rDL\r" + "\r".join(["#GO", *lines]) + "\r\\", ms=2000)
    bench.type("XQ#GO\r", ms=5)
    for _ in range(20):
        action = chance.randrange(4)
        if action == 0:
            simulation.stimulus(f"in{chance.randint(1, 3)}", chance.randint(0, 1))
        elif action == 1:
            simulation.receive(1, (chance.choice(WORDS) + "\r").encode())
        elif action == 2:
            simulation.stimulus("position_x", chance.randint(-200, 200))
        until = simulation.ticks + 20_000
        while simulation.ticks < until:
            simulation.advance(777 if slices and simulation.ticks + 777 < until else until - simulation.ticks)
    return facts(bench)


ECHO_WITHOUT_ROOM = 1237  # an echo found the output full, and a thread had to wait for it


@pytest.mark.parametrize("seed", sorted({*range(count(12, 2000)), ECHO_WITHOUT_ROOM}))
def test_any_program_runs_the_same_in_any_slices(seed: int) -> None:
    assert fuzz(seed, slices=True) == fuzz(seed, slices=False)
    here = "pytest tests/device/simulator/test_determinism.py"
    record("random programs, the same in any slices", here, None, 1, "programs", add=True)
