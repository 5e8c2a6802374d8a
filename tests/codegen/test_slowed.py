"""A program at a part of its speed: the same places and paths, longer times, and what cannot be slowed is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest

from codegen.document import Document
from codegen.instructions import AccelDecel, MotionParameters, SingleAxisMove, TwoLetterCode, WriteEeprom
from codegen.instructions.motion import MoveMode
from codegen.models import model
from codegen.program import Program, Step
from codegen.setup import Axis, Setup, Unit
from codegen.slowed import PERCENTS, slowed
from codegen.twoletter.slow_mark import FULL, mark_of, percent_of
from device.simulator.simulation import Simulation

SECOND = 1_024_000  # ticks
COUNTS = Setup(model="ssc2", axes=tuple(Axis(unit=Unit.COUNT) for _ in "XYZW"))
PATH = (
    "AC 1024000,1024000\nVS 20000\nVA 1024000\nVD 1024000\nVM XY\nVP 3000,0\nCR 1000,-90,90\nVP 4000,5000\nVE\nBGS\nAMS"
)


def raw(*lines: str) -> Document:
    """A program of code as it is typed."""
    return Document(Program("P", main=(Step("s1", TwoLetterCode(text="\n".join(lines))),)), COUNTS)


def code(document: Document, percent: int) -> list[str]:
    return [line.text for line in slowed(document, percent).lines]


def messages(document: Document, percent: int = 50) -> list[str]:
    return [each.message for each in slowed(document, percent).problems if each.severity == "error"]


def run(text: str) -> tuple[list[tuple[float, float]], float]:
    """Commanded places of X and Y, one each 4 samples, and the seconds until nothing moves."""
    simulation = Simulation(model("ssc2"), compiled=False)
    simulation.load_program(text)
    simulation.execute(0, 0)
    places: list[tuple[float, float]] = []
    for _ in range(100_000):
        simulation.advance(SECOND // 250)
        axes = simulation.state()["axes"]
        places.append((axes["X"]["commanded"], axes["Y"]["commanded"]))
        if not any(thread["running"] for thread in simulation.state()["threads"]):
            break
    assert simulation.errors == []
    return places, simulation.ticks / SECOND


@pytest.mark.parametrize("percent", PERCENTS)
def test_every_kind_of_speed_is_scaled_and_nothing_else(percent: int) -> None:
    lines = ["AC 102400", "SP 20000,4000", "JG -30000", "VS 8000", "LM XY", "LI 1000,2000<5000", "LE", "WT 100", "GR 2"]
    part = percent / 100
    made = code(raw(*lines), percent)
    assert made[1:10] == [
        "AC 102400",
        f"SP {20000 * part:g},{4000 * part:g}",
        f"JG {-30000 * part:g}",
        f"VS {8000 * part:g}",
        "LM XY",
        f"LI 1000,2000<{5000 * part:g}",
        "LE",
        "WT 100",
        "GR 2",
    ]


def test_expressions_are_divided_as_a_whole() -> None:
    assert code(raw("SP V1", "JG V1+V2,-V3", "VS @ABS[V1]"), 25)[1:4] == [
        "SP V1/4",
        "JG (V1+V2)/4,(-V3)/4",
        "VS @ABS[V1]/4",
    ]


def test_speeds_are_rounded_down_in_twos_but_never_to_nothing() -> None:
    assert code(raw("SP 3185", "SP 15,0", "JG -3"), 10)[1:4] == ["SP 318", "SP 2,0", "JG -2"]


def test_contours_take_twice_as_long_for_each_half() -> None:
    document = raw("CM X", "DT 2", "CD 10", "WC", "DT 0")
    assert [code(document, percent)[2] for percent in (50, 25, 10)] == ["DT 3", "DT 4", "DT 6"]
    assert code(document, 10)[5] == "DT 0"


def test_lines_keep_their_numbers_and_their_steps() -> None:
    document = raw("#A", "SP 1000;PR 500;BG X;AM X", "JP #A")
    full, slow = slowed(document, FULL), slowed(document, 25)
    assert [line.step for line in slow.lines[:-1]] == [line.step for line in full.lines]
    assert slow.lines[2].text == "SP 250;PR 500;BG X;AM X"
    assert percent_of(slow.text) == 25
    assert percent_of(full.text) == FULL
    assert mark_of([line.text for line in slow.lines]) == "slowed to 25 %"
    assert mark_of([line.text for line in full.lines]) == ""


def test_compact_lines_are_scaled_piece_by_piece() -> None:
    document = Document(
        Program("P", main=(Step("a", TwoLetterCode(text="SP 400")), Step("b", TwoLetterCode(text="PR 9")))),
        COUNTS,
        compact=True,
    )
    listing = slowed(document, 50)
    assert [line.text for line in listing.lines] == ["#P;SP 200;PR 9;EN", "NO SLOWED TO 50 PERCENT"]
    assert listing.step_of(0, 4) == "a"
    assert listing.step_of(0, 12) == "b"


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (["PR 100", "BG X"], "never sets the speed of axis X"),
        (["SP 100", "PR 1,1", "BG"], "never sets the speed of axis Y"),
        (["VM XY", "VP 1,1", "VE", "BG S"], "never sets the speed of the common path"),
        (["SP 100", "PR 1", "BG X", "BN"], "burns into the EEPROM"),
        (["SP 100", "SP _SPX*2"], "_SP"),
        (["DT V1"], "not known before it runs"),
        (["DT 8"], "cannot run at 50 %"),
    ],
)
def test_what_can_not_be_slowed_is_refused_in_a_sentence(lines: list[str], words: str) -> None:
    found = messages(raw(*lines))
    assert len(found) == 1
    assert words in found[0]


def test_instructions_are_scaled_in_their_own_units() -> None:
    setup = Setup(model="ssc1", axes=(Axis(unit=Unit.MM, counts_per_unit="100"), *(Axis() for _ in "YZW")))
    main = (
        Step("r", AccelDecel(acceleration=("1024", "", "", ""), deceleration=("1024", "", "", ""))),
        Step("s", SingleAxisMove(axis="X", mode=MoveMode.BY, distance="10", speed="50")),
        Step("p", MotionParameters(speed=("30", "", "", ""))),
    )
    made = code(Document(Program("P", main=main), setup), 10)
    assert "SP 500" in made  # 50 mm/s x 100 counts/mm x 10 %
    assert "SP 300" in made
    assert "AC 102400" in made
    assert "PR 1000" in made
    burns = Document(Program("P", main=(*main, Step("b", WriteEeprom()))), setup)
    assert "burns" in messages(burns)[0]


@pytest.mark.parametrize("percent", PERCENTS)
def test_a_move_takes_as_long_as_the_mathematics_says(percent: int) -> None:
    distance, speed, ramp = 20_000, 10_000, 102_400
    document = raw(f"AC {ramp}", f"DC {ramp}", f"SP {speed}", f"PR {distance}", "BG X", "AM X")
    places, seconds = run(slowed(document, percent).text)
    slow = speed * percent / 100
    assert places[-1][0] == distance
    assert seconds == pytest.approx(distance / slow + slow / ramp, abs=0.02)


@pytest.mark.parametrize("percent", [50, 10])
def test_a_common_path_is_the_same_within_a_count(percent: int) -> None:
    document = raw(*PATH.splitlines())
    places, _ = run(slowed(document, percent).text)
    assert places[-1] == (4000.0, 5000.0)
    assert max(_from_path(x, y) for x, y in places) <= 1.0
    length = 3000 + math.pi / 2 * 1000 + 4000
    speed, ramp = 20_000 * percent / 100, 1_024_000
    assert _seconds(places) == pytest.approx(length / speed + speed / ramp, abs=0.05)


def _seconds(places: list[tuple[float, float]]) -> float:
    moving = np.abs(np.diff(np.array(places), axis=0)).sum(axis=1) > 0
    return float(moving.sum()) / 250


def _from_path(x: float, y: float) -> float:
    """How far a place is from the path: 3000 along X, a quarter round (3000, 1000), 4000 along Y."""
    if y <= 1000 and x > 3000:
        return abs(math.hypot(x - 3000, y - 1000) - 1000)
    return abs(y) if x <= 3000 else abs(x - 4000)
