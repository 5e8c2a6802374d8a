"""Loops that only wait are left out, and nothing can tell: the same state, bit for bit, as carried out one by one."""

from __future__ import annotations

import dataclasses
import random
from typing import Any

import pytest

from device.simulator.plant import Plant
from device.simulator.times import COMMAND
from tests.device.simulator.bench import MS, Bench
from tests.long import count, record

PLANTS = {
    "X": Plant(viscous_friction=0.001, home_switch=(900.0, 1000.0), index_at=137.0, forward_limit=9000.0),
    "Y": Plant(coulomb_friction=0.004, encoder_noise=0.7, reverse_limit=-4000.0),
    "Z": Plant(backlash=9.0, viscous_friction=0.001),
}
OPERATORS = ("<", ">", "=", "<=", ">=", "<>")
NUMBERS = (
    """
_TPX|_TPY|_RPX|_RPY|_TEX|_TDX|_DEX|-_TPX|_RPX+A|_RPX-A+10|A-_RPX|-(_TPX-A)|@ABS[_TPX-A]|@ABS[_TEX]|@ABS[_TPX]-20
@ABS[A-_RPX]|_TPX*2|@INT[_TPX/7]|@SIN[_TPX]*90|_AVS|_PAX|_TVX|@ABS[_TVY]|_TTX*100|_TTX|@ABS[_TTY]|_RLX
""".replace("\n", "|")
    .strip("|")
    .split("|")
)
TIMES = ["TIME-T0", "TIME-T0", "TIME-T0+50", "@ABS[TIME-T0-60]"]
FLAGS = (
    """
_BGX=1|_BGX|_BGY<>0|_BGZ|_BGS=1|_TPX=_TPX|@IN[1]=1|@IN[2]=0|@IN[1]|_TI&3=3|_TIX<255|A<>3|B=0|V[1]<5|_HX1=1|_HX2<>0|_XQ1>0
_XQ2>=0|_SCX=0|_SCY<>1|_MOX=0|_TSX&128|_TSY>30|_LFX=1|_LRY=1|_HMX=1|_ALX=1|_LMX<511|_CS<2|_TPX<_TPY|_TTX<1|_OP=0|_TC=0
_RC=1|_RD<9|_KPX=6|@OUT[1]=0|@AN[1]<2.5|P1CD=0|P2CD<3|_ZSX=0|_TBX>0|_XQ0>3|_TPX<2147483647|_TPX>-2147483648|NOSUCH=1
A/0=1|TIME<0|A=_RPX
""".replace("\n", "|")
    .strip("|")
    .split("|")
)
MOVES = ["PR 700;BGX", "PR ,-300;BGY", "PR 400,600;BGXY", "PA 0;BGX", "JG 3000;BGX", "AMX", "AM", "T0=TIME"]
MOVES += ["T0=TIME;A=_RPX", "WT 20"]
DEEDS = (
    """
ST|STX|STY|SP 4000,2000|AC 100000|WT 3|AT0;AT 9|A=_TPX|A=A+30|B=B+1|SB1|CB1|AMY|MC|MCX|AD 90|AS|AI-1|AI2|AP 300|MF 200
MR -50|XQ#B,1|XQ#C,2|HX1|HX2|XQ#B,2
II1|II2|TW 40,40,40|ER 90|ER 16384|OE1|OE0|SHX|MOX|DP 0|MG A|MG "T",TIME|V[1]=_TPY|ALX|FL 600|FL 2147483647|T0=TIME
LMXY;LI 200,300;LI 40,-50;LE;BGS|AMS|CN1|CN-1|TM 500|TM 1000|NO x|ZS|TR0|IP 50|HMX;BGX|FEX;BGX|GACX;GR ,0.5|GR ,0|AV 90
RA V[],W[];RD _TPX,_TEX;RC 1,9|RC 0|CI,2|OF 0.1|KP 8,8
""".replace("\n", "|")
    .strip("|")
    .split("|")
)
MOVES_FIRST = [4] * len(MOVES) + [1] * len(DEEDS)


SETS = (
    """
C=_TPX|C=_TPX|C=_RPX-A|C=TIME-T0|C=_TEX|C=@ABS[_TPY]|C=_AVS|C=_PAX|C=V[1]|C=_TTX*10|C=_TPX/7|C=100/_TPX|C="AB"|C=A
C=_TIX|C=@SIN[_TPX]*50|C=D|C=F*2|D=@IN[1]|D=_BGX|D=C+1|D=C|D=_TPX<A|D=_XQ1|D=V[C]|D=-C|D=_TPZ-_TPX|F=F+1|F=F-0.5|F=2+F
F=F+C|NEW=_TPX|V[2]=_TPX|D=@AN[1]|F=F+1|A=A|B=_TVX
""".replace("\n", "|")
    .strip("|")
    .split("|")
)
ABOUT_SETS = (
    """
C<500|C>A|@ABS[C]<50|D=1|D<>0|(C<300)|(D=1)|(C>20)&(_BGX=1)|F<30|F<4000|C-D<50|C<_RPX|D>_TPX|C=D|_TPX-C<30|C<A+100|V[D]<5
""".replace("\n", "|")
    .strip("|")
    .split("|")
)


def about(chance: random.Random) -> str:
    """A condition, mostly of variables that loops set."""
    return condition(chance) if chance.random() < 0.4 else chance.choice(ABOUT_SETS)


def setting_loop(chance: random.Random, label: str) -> str:
    """Jumps round and round, sets variables and calls subroutines on the way."""
    kind, test, other = chance.randrange(8), about(chance), about(chance)
    first, second = chance.choice(SETS), chance.choice(SETS)
    if kind < 3:
        return f"#{label};{first};JP#{label},{test}"
    if kind == 3:
        return f"#{label};{first};{second}\nJP#{label},{test}"
    if kind == 4:
        return f"#{label};JP#{label}e,{other}\n{first};{second}\nJP#{label},{test}\n#{label}e"
    if kind == 5:
        return f"#{label};JS#S{chance.randrange(4)};JP#{label},{test}"
    if kind == 6:
        return f"#{label};JS#S{chance.randrange(4)},{other}\n{first};JP#{label},{test}"
    return f"{first};#{label};JS#S{chance.randrange(4)};{second};NO a\nJP#{label},{test}"


def subroutines(chance: random.Random) -> list[str]:
    """What the loops call: they return at once, set something, call each other, or wait themselves."""
    sets = chance.choices(SETS, k=3)
    return [
        "#S0;EN",
        f"#S1;{sets[0]};EN",
        f"#S2;JS#S0;JP#S2e,{about(chance)}\n{sets[1]};#S2e;EN",
        f"#S3;{sets[2]};JP#S3,{about(chance)}\nEN",
    ]


def condition(chance: random.Random) -> str:
    """Something that is true or not, and may change."""
    kind = chance.randrange(8)
    if kind == 0:
        return chance.choice(FLAGS)
    if kind == 1 and chance.random() < 0.5:  # brackets nest four deep, and a line has 80 columns
        return f"({chance.choice(FLAGS)}){chance.choice('&|')}({chance.choice(NUMBERS)}>50)"
    number, still = chance.choice(NUMBERS if kind < 6 else TIMES), chance.choice(("A", chance.randint(-90, 700)))
    if chance.random() < 0.2:
        return f"{still}{chance.choice(OPERATORS)}{number}"
    return f"{number}{chance.choice(OPERATORS)}{still}"


def loop(chance: random.Random, label: str) -> str:
    """Jumps round and round until a condition fails."""
    kind = chance.randrange(8)
    test, other = condition(chance), condition(chance)
    if kind < 4:
        return f"#{label};JP#{label},{test}"
    if kind == 4:
        return f"#{label};NO wait\nJP#{label},{test}"
    if kind == 5:
        return f"#{label};JP#{label}x,{test};JP#{label}y\n#{label}x;NO a;NO b\nJP#{label}\n#{label}y"
    if kind == 6:
        return f"#{label};JP#{label},{test}\nJP#{label},{other}"
    return f"#{label};JP#{label}z,{test};JP#{label},{other}\n#{label}z"


def program(chance: random.Random) -> str:
    """Three threads of deeds and loops, and automatic routines."""
    parts = []
    for name in "ABC":
        body = [f"#{name}"]
        for number in range(chance.randint(1, 4)):
            body += chance.choices(MOVES + DEEDS, weights=MOVES_FIRST, k=chance.randint(0, 3))
            body.append(chance.choice((loop, setting_loop))(chance, f"{name}{number}"))
        parts.append("\n".join([*body, chance.choice(("EN", f"JP#{name}"))]))
    routines = ("#LIMSWI;RE", "#POSERR;E=E+1;RE1", "#ININT;B=B+1;RI1", "#CMDERR;EN", "#MCTIME;EN", "#COMINT;EN0,1")
    parts += [routine for routine in routines if chance.random() < 0.4]
    return "\n".join([*parts, *subroutines(chance)])


def facts(bench: Bench) -> Any:
    simulation = bench.simulation
    simulation.rest(10_000)  # the motion is brought up to now
    state = dataclasses.asdict(simulation.unit.state)
    return (
        state,
        simulation.motion.snapshot().tobytes(),
        list(simulation.messages),
        list(simulation.errors),
        simulation.motion.trace_rows().tobytes(),
        simulation.transmit(1),
    )


def outside(bench: Bench, chance: random.Random) -> None:
    """Something happens to the controller."""
    simulation, kind = bench.simulation, chance.randrange(9)
    if kind < 3:
        simulation.stimulus(f"in{chance.randint(1, 2)}", chance.randint(0, 1))
    elif kind == 3:
        words = ("MG TIME", "ST", "HX", "TP", "XQ#A", "XQ#C,2", "AB1", "A=5", "SH", "x", "STX;HX1", "TM 1000", "BGY")
        simulation.receive(1, (chance.choice(words) + "\r").encode())
    elif kind == 4:
        simulation.stimulus("position_x", chance.randint(-60, 60))
    elif kind == 5:
        simulation.stimulus(chance.choice(("fls_x", "rls_y", "home_x", "abort")), chance.randint(0, 1))
    elif kind == 6:
        simulation.stimulus("an1", chance.uniform(-10, 10))
    elif kind == 7:
        simulation.stimulus("type2", "7\r")


def play(seed: int, *, leaping: bool, sliced: bool = False, compiled: bool | None = None) -> tuple[list[Any], int]:
    """A random program in a random world; what is to be seen of it now and then, and how much was left out."""
    chance = random.Random(seed)
    bench = Bench("ssc3", PLANTS, baud=chance.choice((None, 19200)), compiled=compiled)
    simulation = bench.simulation
    simulation.interpreter.idling.allowed = leaping
    simulation.motion.trace(4000)
    bench.load(
        f"A=300;B=0;E=0;T0=0;C=0;D=0;F=0\nDM V[9],W[9];II1{chance.choice(('', ';XQ#B,1', ';XQ#B,1;XQ#C,2'))}\n"
        + program(chance)
    )
    simulation.execute(0)
    seen = []
    for _ in range(chance.randint(3, 9)):
        end = simulation.ticks + chance.randint(1, 400_000)
        while simulation.ticks < end:
            simulation.advance(min(777 if sliced else end, end - simulation.ticks))
        seen.append(facts(bench))
        outside(bench, chance)
    return seen, simulation.interpreter.idling.left_out


@pytest.mark.parametrize("block", range(4))
def test_leaving_out_changes_nothing(block: int) -> None:
    each, left_out = count(12, 500), 0
    for seed in range(block * each, (block + 1) * each):
        leaping, commands = play(seed, leaping=True)
        left_out += commands
        assert leaping == play(seed, leaping=False)[0], f"seed {seed}"
        if seed % 5 == 0:
            assert leaping == play(seed, leaping=True, sliced=True)[0], f"seed {seed}, sliced"
    assert left_out > 100 * each  # else the comparison would say nothing
    here = "pytest tests/device/simulator/test_busy_loops.py"
    record("programs with waiting loops, left out or not the same", here, None, each, "programs", add=True)


@pytest.mark.parametrize("block", range(2))
def test_the_compiled_and_the_plain_loop_run_programs_alike(block: int) -> None:
    each = count(4, 120)
    for seed in range(50_000 + block * each, 50_000 + (block + 1) * each):
        assert play(seed, leaping=True, compiled=True) == play(seed, leaping=True, compiled=False), f"seed {seed}"


FOREVER = 400_000  # commands of the runs below


CONDITIONS = ("_BGX=1", "TIME<900000", "@IN[1]=1", "(_TPX<9000000)&(_BGX=1)", "_TVX>-1", "_TTX<9.9", "1")
LOOPS = (
    "V=_TPX;JP#L,V<9000000",
    "V=_TPX-1000;W=@ABS[V-50];JP#L,W<9000000",
    "JS#S;JP#L,_BGX=1",
    "JS#S,_BGX=1;NO a;JP#L",
    "N=N+1;JP#L,_BGX=1",
    "V=TIME-T0;W=@IN[1];JP#L,(V<900000)&(W=1)",
)


@pytest.mark.parametrize("waiting", [f"JP#L,{each}" for each in CONDITIONS] + list(LOOPS))
def test_a_waiting_loop_is_left_out(waiting: str) -> None:
    bench = Bench("ssc1")
    bench.load(f"JG 10000;BGX;T0=0\n#L;{waiting}\nMG TIME\nEN\n#S;EN")
    bench.ask("V=0;W=0;N=0")
    bench.simulation.execute(0)
    bench.simulation.advance(FOREVER * COMMAND)
    assert bench.simulation.interpreter.idling.left_out > 0.99 * FOREVER
    assert bench.simulation.unit.state.threads[0].running and bench.texts() == []


@pytest.mark.parametrize(
    ("moves", "waiting"),
    [
        ("PA 2000000;SP 1000;BGX", "JP#L,_PAX>1000"),
        ("VM XY;VP 900000,0;VE;VS 2000;BGS", "JP#L,_AV<800000"),
        ("VM XY;VP 900000,0;VE;VS 2000;BGS", "V=_AV;JP#L,V<800000"),
    ],
)
def test_targets_and_ways_are_waited_for(moves: str, waiting: str) -> None:
    bench = Bench("ssc2")
    bench.load(f"V=0\n{moves}\n#L;{waiting}\nMG TIME\nEN")
    bench.simulation.execute(0)
    bench.simulation.advance(FOREVER * COMMAND)  # 200 s
    assert bench.simulation.interpreter.idling.left_out > 0.99 * FOREVER
    assert bench.simulation.unit.state.threads[0].running and bench.texts() == []


def test_variables_hold_what_the_last_round_set() -> None:
    # three commands of 512 ticks a round; a jog of 10 counts a sample of 1000 ticks
    bench = Bench("ssc1")
    bench.load("V=0;N=0;AC 67107840;JG 10240;BGX\n#L;V=_TPX;N=N+1;JP#L,V<100000\nMG V,N\nEN")
    bench.simulation.execute(0)
    bench.simulation.advance(12_000 * MS)
    assert bench.simulation.interpreter.idling.left_out > 15_000
    place, rounds = (float(word) for word in bench.texts()[0].split())
    assert 100_000 <= place <= 100_000 + 20  # a round takes 1.5 samples
    assert rounds == pytest.approx(place / 10 * 1000 / (3 * COMMAND), abs=5)


def test_the_way_out_is_taken_at_its_tick() -> None:
    # 2500 counts at 10 000 counts/s and 1 024 000 counts/s²: 9 + 256 samples and a bit; the jump looks every 512 ticks
    bench = Bench("ssc1")
    bench.load("SP 10000;AC 1024000;DC 1024000;PR 2500;BGX\n#L;JP#L,_BGX=1\nMG TIME\nEN")
    bench.simulation.execute(0)
    bench.simulation.advance(1000 * MS)
    assert bench.simulation.interpreter.idling.left_out > 400
    began = 5 * COMMAND // 1000  # samples before the fifth command
    ramp, travel = 10, round((2500 - 10 * 10000 / 1024) / (10000 / 1024))
    assert abs(float(bench.texts()[0]) - (began + 2 * ramp + travel)) <= 2


def test_a_run_ends_with_the_sample_that_ends_the_motion() -> None:
    # SP 2048, AC and DC 102400 (20 samples up and down): 4096 counts take 2 s and 20 samples
    ends = []
    for more in ("", "MG 1;WT 3000;"):  # once nothing but the motion is left, once a thread outlives it
        bench = Bench("ssc2")
        assert bench.run(f"SP 2048,1024;AC 102400;DC 102400;PR 4096;BGX;{more}EN") == "end"
        assert not bench.simulation.unit.moving()
        assert bench.position() == 4096
        ends.append(bench.simulation.ticks)
    begun = 5 * COMMAND  # the sample after the fifth command is the first of the move
    assert ends[0] == pytest.approx(begun + (2 * 1024 + 20) * 1000, abs=2000)
    assert ends[1] > 3000 * 1000
