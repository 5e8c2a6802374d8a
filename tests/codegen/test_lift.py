"""Source becomes a visual program that writes the same code, of instructions where they are recognised."""

from __future__ import annotations

import pytest

from codegen.generate import generate
from codegen.instructions import (
    Drive,
    Execute,
    Instruction,
    Jump,
    Label,
    MathematicalEquation,
    MotionParameters,
    SingleAxisMove,
    TwoLetterCode,
)
from codegen.setup import Setup
from codegen.twoletter.lift import lift, plain
from codegen.twoletter.parse import parse

SETUP = Setup(model="ssc4")


def kinds(text: str) -> list[type[Instruction]]:
    """What the lines between the first label and the last EN become."""
    return [type(step.instruction) for step in lift(f"#PROG\n{text}\nEN", "x", SETUP).program.main]


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("PR ,2000\nSP ,5000\nBG Y\nAM Y", [SingleAxisMove]),
        ("PA ,,-500\nBG Z", [SingleAxisMove]),
        ("PR 100,200\nBG XY", None),  # two axes at once: the move stays code
        ("SP 5000,,6000", [MotionParameters]),
        ("JP #B,V1>5", [Jump]),
        ("V1=2*@SIN[30]", [MathematicalEquation]),
        ("V1=1+B*2", [TwoLetterCode]),  # read from left to right only by the controller: nothing is guessed
        ("POS[3]=V1+1", [MathematicalEquation]),
        ("XQ #B,2", [Execute]),
        ("SH XY\nMO Z", [Drive, Drive]),
        ("PR LEN*4000", [TwoLetterCode]),
        ("#A\nJS #B", [Label, Jump]),
    ],
)
def test_what_is_recognised(text: str, wanted: list[type[Instruction]] | None) -> None:
    found = kinds(text)
    assert TwoLetterCode in found if wanted is None else found == wanted


@pytest.mark.parametrize(
    "source",
    [
        "#TASK\nAT0\nCB1\n#LOOP\nAT 10\nSB1\nAT -40\nCB1\nJP #LOOP,@IN[2]=1\nEN",
        "#A\nPR ,8000\nSP ,2000\nBG Y\nAM Y\nV1=V1+1\nJP #A,V1<5\nEN\n#CUT\nSB 1\nWT 20\nCB 1\nEN",
        '#A\nPR 1,2,3;BG\nAM\nCI ,2\nMG "A",V1{F4.2}\nEN',
        '#AUTO\n#MAIN\nVM XY\nVP 10,10<500\nCR 100,0,90\nVE\nBGS\nAMS\nEN\n#LIMSWI\nMG "X"\nRE',
    ],
)
def test_the_code_stays_the_same(source: str) -> None:
    """Labels, statements and their order: the visual program writes what was read."""
    listing = generate(lift(source, "x", SETUP))
    before = plain([statement for _, statement in parse(source).statements()], "XYZW")
    after = plain([statement for _, statement in parse(listing.text).statements()], "XYZW")
    assert [each for each in after if each in before] == before
