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
    End,
    Home,
    IncrementalPosition,
    Instruction,
    Jump,
    Label,
    LinearPath,
    Repeat,
    SingleAxisMove,
    Subroutine,
    TwoLetterCode,
    Wait,
)
from codegen.instructions.flow import JumpIf, JumpKind, RepeatMode
from codegen.instructions.motion import MoveMode
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


def of_loop(*body: Instruction, routines: tuple[Step, ...] = ()) -> list[tuple[str, str]]:
    """What is said of drift in a program of these steps: step and sentence."""
    main = tuple(Step(f"s{place}", each) for place, each in enumerate(body))
    found = generate(Document(Program("P", main=main, routines=routines), SETUP)).problems
    return [(each.step, each.message) for each in found if "drift" in each.message]


MOVE, TEN = SingleAxisMove(distance="1.003"), SingleAxisMove(distance="1")
FAR = "This loop drifts: X by -3 mm in 1000 turns"


def test_what_lies_behind_a_jump_back_is_not_in_its_loop() -> None:
    """The first jump always goes back, so the second is never reached from the label."""
    assert of_loop(Label(name="A"), MOVE, Jump(target="A"), MOVE, Jump(target="A")) == [("s2", FAR)]
    assert of_loop(Label(name="A"), TEN, Jump(target="A"), MOVE, Jump(target="A")) == []


def test_a_jump_forward_inside_a_loop() -> None:
    """Over what does not move it changes nothing; over a move the way depends on what else jumps there."""
    skip, there = Jump(target="B"), Label(name="B")
    assert of_loop(Label(name="A"), MOVE, skip, Wait(time="5"), there, Jump(target="A")) == [("s5", FAR)]
    assert of_loop(Label(name="A"), MOVE, skip, SingleAxisMove(distance="0.003"), there, Jump(target="A")) == []
    assert of_loop(Label(name="A"), MOVE, Jump(target="OUT"), Jump(target="A")) == []


def test_a_called_subroutine_that_homes_ends_the_drift() -> None:
    call = Jump(kind=JumpKind.CALL, target="GO")
    home = Step("r", Subroutine(name="GO"), body=(Step("h", Home(axes="X")), Step("e", End())))
    grip = Step("r", Subroutine(name="GO"), body=(Step("h", Wait(time="5")), Step("e", End())))
    body = (Label(name="A"), MOVE, call, Jump(target="A"))
    assert of_loop(*body, routines=(home,)) == []
    assert of_loop(*body, routines=(grip,)) == [("s3", FAR)]
    assert of_loop(*body) == []  # nothing is known of a label that is no step


@pytest.mark.parametrize(
    ("code", "wanted"),
    [
        ('MG "X"', [FAR]),
        ("PR 100;BGX;AMX", [FAR]),  # whole counts are sent as they are
        ("PR 100.3;BGX;AMX", ["This loop drifts: X by -6 mm in 1000 turns"]),  # 0.3 + 0.3 counts a turn
        ("PR ,100.3;BGY;AMY", ["This loop drifts: X by -3 mm, Y by -3 mm in 1000 turns"]),
        ("IPX=-0.5", ["This loop drifts: X by -8 mm in 1000 turns"]),  # rounded down to -1 (commands.md, 11)
        ("PR LEN", [FAR]),
        ("PA 0;BGX;AMX", []),  # a known place each turn
        ("DP 0", []),
        ("JS #OWN", []),
        ("EN", []),  # the jump back is not reached
    ],
)
def test_two_letter_code_in_a_loop(code: str, wanted: list[str]) -> None:
    body = (Label(name="A"), MOVE, TwoLetterCode(text=code), Jump(target="A"))
    assert [text for _, text in of_loop(*body)] == wanted
    repeat = told(MOVE, TwoLetterCode(text=code)) if code != "EN" else None
    assert [repeat] == [text.replace("loop", "repeat") for text in wanted] or (repeat is None and not wanted)


@pytest.mark.parametrize(
    ("code", "wanted"),
    [
        ("#OWN\nPR 10.3;BGX;AMX\nJP #OWN", [("s0", FAR)]),
        ("#OWN\nPR 10;BGX;AMX\nJP #OWN", []),
        ("#OWN\nPR 10.3;BGX;AMX\nJP #OWN,V=1", []),
    ],
)
def test_a_loop_of_two_letter_code(code: str, wanted: list[tuple[str, str]]) -> None:
    assert of_loop(TwoLetterCode(text=code)) == wanted


def moves(count: str, *distances: str) -> Step:
    body = tuple(Step(f"m{place}", SingleAxisMove(axis="Y", distance=each)) for place, each in enumerate(distances))
    return Step("r", Repeat(count=count), body=body)


def test_drift_over_loops() -> None:
    """0.0016 mm too far in each of 1000 turns are 1.6 mm (safety.md, 6): here 0.3 counts are lost each time."""
    assert drift(moves("1000", "0.003"), SETUP) == "This repeat drifts: Y by -3 mm in 1000 turns"
    assert drift(moves("1000", "0.0116"), SETUP) == "This repeat drifts: Y by -1.6 mm in 1000 turns"
    assert drift(moves("1000", "0.003", "-0.003"), SETUP) is None
    assert drift(moves("1000", "0.25"), SETUP) is None
    inside = Step("o", Repeat(count="10"), body=(moves("100", "0.003"),))
    assert drift(inside, SETUP) == "This repeat drifts: Y by -3 mm in 10 turns"


def test_expressions_with_a_minus_may_drift() -> None:
    """commands.md, 11: an argument of step 1 is rounded downwards, so -LEN*100 is not -(LEN*100)."""
    assert "may drift" in (drift(moves("10", "LEN", "-LEN"), SETUP) or "")
    assert drift(moves("10", "LEN"), SETUP) is None


def test_an_absolute_move_ends_the_drift() -> None:
    body = (*moves("1", "0.003").body, Step("p", SingleAxisMove(axis="Y", mode=MoveMode.TO, position="0")))
    assert drift(Step("r", Repeat(count="1000"), body=body), SETUP) is None
