"""STOP while every kind of motion goes on, from every state of the line, on every address of a chain (safety.md, 1)."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from device.api import StopState
from device.simulator.chain import make_chain
from device.simulator.eeprom import read_eeproms
from device.simulator.plant import Place, Plant
from tests.device.bench import Bench
from tests.device.test_stop import ON_THE_LINE, PROGRAM, TYPED, put_into
from tests.long import is_long

PROGRAMS = """
#CONTOUR
CM X
DT 3
#C
CD 40
WC
JP #C
#TUNE
DM P[1000],T[1000]
RA P[],T[]
RD _TEX,_TTX
RC 1
SP 60000;AC 1024000;DC 1024000
#E
PR 3000;BG X;AM X;WT 20
PR -3000;BG X;AM X;WT 20
JP #E"""


@dataclass(frozen=True)
class Motion:
    """A kind of motion: what a person types, a program that streams it in thread 1, a shaft that somebody turns."""

    lines: tuple[str, ...]
    program: str = ""
    turned: float = 0.0
    model: str = "ssc4"


MOTIONS = {
    "linear sequence": Motion(("LM XY", "LI 400000,300000;LE", "VS 20000;BGS")),
    "path sequence": Motion(("VM XY", "VP 100000,50000", "CR 40000,0,360;VE", "VS 20000;BGS")),
    "gear": Motion(("GA DX", "GR ,2"), turned=5000),
    "gear to a moving axis": Motion(("GA X", "GR ,2", "JG 20000;BG X")),
    "cam": Motion(
        ("EA X", "EM 4000,0", "EP 1000,0", *(f"ET[{n}]=,{(0, 500, 1000, 500, 0)[n]}" for n in range(5)),
         "EB1;EG ,0", "JG 20000;BG X")
    ),
    "contour": Motion((), "#CONTOUR"),
    "tuning": Motion((), "#TUNE"),
    "gear of one axis": Motion(("GR 2",), turned=5000, model="dmc1412"),
    "cam of one axis": Motion(
        ("EM 0,4000", "EP 1000,0", *(f"ET[{n}]={(0, 500, 1000, 500, 0)[n]}" for n in range(5)), "EB1;EG 0"),
        turned=5000, model="dmc1412",
    ),
}  # fmt: skip
STATES = tuple(state for state in (*TYPED, *ON_THE_LINE))
ENTRIES = ("download", "editor")  # refused while a program runs
PAIRS = [
    (state, kind)
    for row, kind in enumerate(MOTIONS)
    for column, state in enumerate(STATES)
    if not (MOTIONS[kind].program and state in ENTRIES) and (is_long() or (row * 3 + column) % 6 == 0)
]


def places(bench: Bench) -> list[float]:
    return [axis["commanded"] for axis in bench.simulation.state()["axes"].values()]


def begun(motion: Motion) -> Bench:
    """A controller on which this motion goes on."""
    bench = Bench(motion.model, plants={"X": Plant(auxiliary=Place.EXTERNAL)}).ready()
    bench.result(bench.controller.download(PROGRAM + PROGRAMS).future)
    bench.ask("SH")
    for line in motion.lines:
        bench.ask(line)
    if motion.program:
        bench.ask(f"XQ {motion.program},1")
    if motion.turned:
        bench.simulation.stimulus("aux_speed_x", motion.turned)
    bench.run(0.15)
    before = places(bench)
    bench.run(0.03)
    assert places(bench) != before
    return bench


def stands(bench: Bench, was: str) -> None:
    """Stopped and proved; nothing is commanded any more, and it stays so."""
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED, 8.0)
    before = places(bench)
    bench.run(0.5)
    assert places(bench) == before, was
    assert bench.still()


@pytest.mark.parametrize("kind", MOTIONS)
def test_every_kind_of_motion_stands_still(kind: str) -> None:
    stands(begun(MOTIONS[kind]), kind)


@pytest.mark.parametrize(("state", "kind"), PAIRS)
def test_every_kind_of_motion_from_every_state_of_the_line(state: str, kind: str) -> None:
    bench = begun(MOTIONS[kind])
    put_into(bench, state)
    stands(bench, f"{kind}, {state}")
    held = bench.result(bench.controller.upload().future)
    assert "ST" not in [part.strip() for line in held.splitlines() for part in line.split(";")]


def chained(address: int) -> Bench:
    """Three controllers on one line; ours has this address."""
    chain = make_chain(Bench("ssc1").simulation.model, None, read_eeproms(None, 3), baud=19200, compiled=False)
    bench = Bench("ssc1", simulation=chain, address=address)
    return bench.ready()


@pytest.mark.parametrize("left", [b"", b"PR 100", b"\x13", b"DL\rPR 7\r"])
@pytest.mark.parametrize("address", [0, 1, 2])
def test_every_controller_of_a_chain_stands_still(address: int, left: bytes) -> None:
    """`!ST` is for all (dmc-1412-1414.txt l.1305); whoever is ours proves it."""
    bench = chained(address)
    chain = bench.simulation
    bench.raw(b"!SH\r!JG 20000\r!BG X\r", 0.4)
    assert all(state["axes"]["X"]["moving"] for state in chain.state()["chain"])
    bench.simulation.receive(1, left)
    bench.simulation.advance(1_024_000 // 20)
    bench.sent.clear()
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED, 8.0)
    assert b"!ST\r" in bench.sent
    for state in chain.state()["chain"]:
        assert not state["axes"]["X"]["moving"]
        assert not any(thread["running"] for thread in state["threads"])
