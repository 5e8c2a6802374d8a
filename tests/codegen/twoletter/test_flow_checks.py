"""Checks along the ways of a program: held to the simulator, to every program of the manuals, and to generated ones."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from codegen.document import Document
from codegen.generate import generate
from codegen.models import model
from codegen.program import Program
from codegen.twoletter.check import check
from device.simulator.simulation import Simulation
from tests.codegen.strategies import SETUP, programs
from tests.codegen.test_lift import MANUALS, sources
from tests.long import count

SECOND = 1_024_000  # ticks


def found(source: str, name: str = "ssc2") -> list[tuple[str, int]]:
    """Rules and lines, from 0."""
    return [(problem.rule, problem.line) for problem in check(source, model(name))]


@pytest.mark.parametrize(
    ("source", "wanted"),
    [
        # the second turn of a loop comes while the axis still moves
        ("#A\nPR 1\nBG X\nJP #A\nEN", [("still-moving", 1)]),
        ("#A\nPR 1\nBG X\nAM X\nJP #A\nEN", []),
        ("#A\nN=0\n#B\nPR 1\nBG X\nN=N+1\nJP #B,N<5\nEN", [("still-moving", 3)]),
        # what asks the machine may be the wait itself
        ("#A\nPR 1\nBG X\n#W\nJP #W,_BGX=1\nPR 1\nBG X\nAM X\nEN", []),
        ("#A\nPR 1\nBG X\n#W\nJP #W,@IN[1]=0\nPR 1\nEN", []),
        # one of two ways has waited; which one is taken nobody knows here
        ("#A\nJP #B,@IN[1]=0\nPR 1\nBG X\nAM X\n#B\nPR 1\nEN", []),
        # behind a jump and behind a label
        ("#A\nPR 1\nBG X\nJP #B\n#B\nPR 5\nEN", [("still-moving", 5)]),
        ("#A\nPR 1\nBG X\nJS #C\nPR 5\nEN\n#C\nAM X\nEN", []),
        ("#A\nPR 1\nBG X\nJS #C\nPR 5\nEN\n#C\nSB 1\nEN", [("still-moving", 4)]),
        # a jog goes on while the operator is asked, a move ends
        ('#A\nV=1\n#B\nIN "SPEED",V\nJG V\nBG X\nJP #B\nEN', [("still-moving", 5)]),
        ('#A\nV=1\n#B\nIN "HOW FAR",V\nPR V\nBG X\nJP #B\nEN', []),
        # another axis, another wait
        ("#A\nPR 1,1\nBG X\nPR ,2\nBG Y\nAM Y\nPR 3\nEN", []),
        ("#A\nPR 1,1\nBG X\nBG Y\nAM\nBG XY\nEN", []),
        ("#A\nPR 1,1\nBG X\nAM Y\nPR 2\nEN", [("still-moving", 4)]),  # Y stands: nothing is waited for
        ("#A\nPR 1,1\nBG XY\nAM Y\nPR 2\nEN", []),  # the person may know that X is the shorter one
        # subroutines
        ("#A\nJS #B\nEN\n#B\nSB 1\n#LIMSWI\nRE", [("runs-into", 4)]),
        ("#A\nJS #B\nJS #C\nEN\n#B\nSB 1\n#C\nCB 1\nEN", []),  # #B ends with #C: both are called
        ("#A\nJS #B\nEN\n#B\nRI", [("stray-return", 4)]),
        ("#A\nJP #A\n#ININT\nJP #B\n#B\nRI", []),
        # arrays, in the order of the way and not of the text
        ("#A\nJS #B\nP[0]=1\nEN\n#B\nDM P[5]\nEN", []),
        ("#A\nJP #C\n#B\nP[0]=1\nEN\n#C\nDM P[5]\nJP #B\nEN", []),
        ("#A\nN=0\nP[N]=1\nDM P[5]\nEN", [("dimensioned-later", 2)]),
        # a contour and its end, also in a subroutine
        ("#A\nCM X\nDT 2\nCD 1\nWC\nJS #E\nEN\n#E\nDT 0\nCD 0\nEN", []),
        ("#A\nCD 1\nWC\nEN", [("segment-alone", 1)]),
    ],
)
def test_what_the_ways_say(source: str, wanted: list[tuple[str, int]]) -> None:
    assert found(source) == wanted


# --------------------------------------------------------------- held to the simulator

STEPS = st.sampled_from(
    ["PR 150", "PR ,150", "BG X", "BG Y", "BG XY", "AM XY", "AM", "SB 1", "JS #WAIT", "JS #LAMP", "JP #N"]
)


@st.composite
def journeys(draw: st.DrawFn) -> str:
    """A program of moves, waits, calls, jumps and one counted loop; every line of it is run."""
    lines = ["#A", "N=0", "PR 150,150", "#L", *draw(st.lists(STEPS, min_size=1, max_size=7)), "N=N+1"]
    turns = draw(st.integers(1, 2))
    lines += [f"JP #L,N<{turns}", *draw(st.lists(STEPS, max_size=3)), "EN"]
    lines += ["#WAIT", "AM XY", "EN", "#LAMP", "SB 2", "EN"]
    return "\n".join(_numbered(lines))


def _numbered(lines: list[str]) -> Iterator[str]:
    """Each jump to a label right behind it."""
    for number, line in enumerate(lines):
        if line == "JP #N":
            yield f"JP #N{number}"
            yield f"#N{number}"
        else:
            yield line


@settings(max_examples=count(15, 3000))
@given(source=journeys())
def test_what_is_warned_about_is_what_the_controller_refuses(source: str) -> None:
    """A move takes 50 ms and a statement 0.5 ms: without a wait the axis still moves at the next one.

    A loop of one turn never comes back: its end is the one place where a warning may be about nothing.
    """
    flagged = {line for rule, line in found(source) if rule == "still-moving"}
    simulation = Simulation(model("ssc2"), compiled=False)
    simulation.load_program(source)
    simulation.execute(0)
    simulation.run_until_idle(20 * SECOND)
    refused = [error for error in simulation.errors if error["code"] in (7, 21)]
    for error in refused:
        assert error["line"] in flagged, (source, error, flagged)
    if flagged and "N<1" not in source:
        assert refused, (source, flagged)


# ---------------------------------------------------------------- no false alarms

# Every finding in the programs of the manuals, and why it is right.
JUSTIFIED = {
    ("l.2711-2725", "still-moving"): "the manual's own example of a program that fails: error 7 in line 3 (l.2717)",
    ("l.2772", "still-moving"): "shown as wrong in the example: the second PR is refused without AM",
    ("l.2831-2837", "rounded"): "AC 10000 is stored as 9216, 8 % less",
    ("l.1765-1773", "rounded"): "AC 20000 and DC 20000 are stored as 19456, 2.7 % less",
    ("l.2953", "calls-itself"): "the example shows the full stack",
    ("l.3069-3091", "still-moving"): "a second valid speed is answered by error 21: the jog is still running",
    ("l.3243-3245", "unassigned"): "V1 is typed at the port before the program runs",
    ("l.5348-5352", "unassigned"): "V1 is typed at the port before the program runs",
}


def test_every_finding_in_the_manuals_is_justified() -> None:
    told = set()
    for example in MANUALS:
        for text in sources(example):
            told |= {(example.lines, problem.rule) for problem in check(text, model(example.model))}
    assert told == set(JUSTIFIED)


@settings(max_examples=count(8, 1000))
@given(program=programs())
def test_what_the_dialogs_write_has_no_errors(program: Program) -> None:
    """A random program may name labels and arrays it has not, or repeat names: those findings are right."""
    listing = generate(Document(program, SETUP))
    allowed = {
        "missing-label",
        "duplicate-label",
        "undimensioned",
        "index-range",
        "too-many-elements",
        "too-many-arrays",
        "sequence-open",
        "segment-alone",
        "input-thread",
        "stack-full",
    }
    if not listing.is_complete:
        return
    errors = [each for each in check(listing.text, SETUP.limits) if each.severity == "error"]
    assert not [each for each in errors if each.rule not in allowed], listing.text
