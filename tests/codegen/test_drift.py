"""How far rounding carries an axis away: every kind of relative move, in repeats and in loops closed by a jump.

The axis has 100 counts a millimetre in all of them: 0.003 mm are 0.3 counts, which are lost in each turn, and
1000 turns of it are 3 mm.
"""

from __future__ import annotations

import pytest

from codegen.document import Document
from codegen.drift import drift
from codegen.generate import generate
from codegen.instructions import (
    CircularPath,
    ContourMode,
    DefinePosition,
    Home,
    IncrementalPosition,
    Instruction,
    Jump,
    Label,
    LinearPath,
    Repeat,
    SingleAxisMove,
    Wait,
)
from codegen.instructions.flow import JumpIf, RepeatMode
from codegen.instructions.path_parts import Measured, Piece, Shape, Stretch
from codegen.program import Program, Step
from codegen.setup import Axis, Setup, Unit

HUNDRED = Axis(unit=Unit.MM, counts_per_unit="100")
SETUP = Setup(model="ssc4", axes=(HUNDRED,) * 4)
LINE = Stretch(to=("1.003", "0", "", ""))


def told(*body: Instruction, mode: RepeatMode = RepeatMode.COUNT) -> str | None:
    steps = tuple(Step(f"m{place}", each) for place, each in enumerate(body))
    return drift(Step("r", Repeat(mode=mode, count="1000", until="A=1", condition="A=1"), body=steps), SETUP)


@pytest.mark.parametrize(
    "move",
    [
        SingleAxisMove(distance="1.003"),
        IncrementalPosition(distance=("1.003", "", "", "")),
        LinearPath(axes="XY", speed="5", segments=(LINE,)),
        LinearPath(axes="XY", speed="5", measured=Measured.STEPS, segments=(LINE,)),
        LinearPath(axes="XYZ", speed="5", measured=Measured.STEPS, segments=(LINE,)),
        ContourMode(axes="X", table="0.5\n0.25\n0.253"),
        CircularPath(segments=(Piece(to=("0.5", "0", "", "")), Piece(to=("1.003", "0", "", "")))),
        # half a turn on a radius of 0.5015 mm, 50.15 counts, which are sent as 50: 1 mm instead of 1.003
        CircularPath(
            axes="XY", speed="5", segments=(Piece(shape=Shape.ARC, radius="0.5015", start="180", sweep="180"),)
        ),
    ],
    ids=lambda move: type(move).__name__,
)
def test_every_relative_move_drifts(move: Instruction) -> None:
    assert told(move) == "This repeat drifts: X by -3 mm in 1000 turns"


@pytest.mark.parametrize(
    "body",
    [
        (SingleAxisMove(distance="1.25"),),
        (SingleAxisMove(distance="1.003"), Home(axes="X")),
        (SingleAxisMove(distance="1.003"), DefinePosition(position=("0", "", "", ""))),
        (SingleAxisMove(distance="1.003"), SingleAxisMove(distance="-1.003")),
        # a closed path comes back to its beginning, whatever is rounded on the way
        (LinearPath(axes="XY", segments=(LINE, Stretch(to=("0", "0.007", "", "")), Stretch(to=("0", "0", "", "")))),),
        (SingleAxisMove(distance="LEN"),),
    ],
)
def test_what_does_not_drift(body: tuple[Instruction, ...]) -> None:
    assert told(*body) is None


def test_an_endless_repeat_is_judged_by_1000_turns_and_one_that_a_condition_ends_by_one() -> None:
    move = SingleAxisMove(distance="1.003")
    assert told(move, mode=RepeatMode.FOREVER) == "This repeat drifts: X by -3 mm in 1000 turns"
    assert told(move, mode=RepeatMode.UNTIL) is None


@pytest.mark.parametrize(
    ("when", "wanted"),
    [(JumpIf.ALWAYS, ["This loop drifts: X by -3 mm in 1000 turns"]), (JumpIf.CONDITION, [])],
)
def test_a_jump_back_closes_a_loop(when: JumpIf, wanted: list[str]) -> None:
    """The form in which most programs repeat: a label, and a jump to it (dmc-1412-1414.txt l.4025-4035)."""
    body = (Label(name="A"), SingleAxisMove(distance="1.003"), Wait(time="5"), Jump(target="A", when=when))
    main = tuple(Step(f"s{place}", each) for place, each in enumerate(body))
    found = generate(Document(Program("P", main=main), SETUP)).problems
    assert [each.message for each in found if each.severity == "warning" and "drift" in each.message] == wanted
    assert not wanted or found[-1].step == "s3"
