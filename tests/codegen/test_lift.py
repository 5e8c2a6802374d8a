"""Source becomes a visual program that writes the same code, of instructions where they are recognised."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest
from hypothesis import given, settings

from codegen import files
from codegen.document import Document
from codegen.generate import Listing, generate
from codegen.instructions import (
    CircularPath,
    ContourMode,
    DisableGearing,
    Drive,
    ElectronicCam,
    ElectronicGearing,
    Execute,
    Home,
    Instruction,
    Interrupt,
    Jump,
    Label,
    LinearPath,
    MathematicalEquation,
    MotionParameters,
    PidGains,
    Print,
    RecordData,
    SingleAxisMove,
    StopMotion,
    TangentPath,
    TwoLetterCode,
    UserInterface,
    Wait,
    WaitForCondition,
)
from codegen.program import Program
from codegen.setup import Setup
from codegen.twoletter.lift import lift, plain
from codegen.twoletter.nodes import Command, Comment, Statement
from codegen.twoletter.nodes import Label as LabelNode
from codegen.twoletter.parse import parse
from resources import path
from tests.codegen.strategies import SETUP as RANDOM_SETUP
from tests.codegen.strategies import programs
from tests.examples.script import Example, read_examples
from tests.long import count, record

SETUP = Setup(model="ssc4")
COMMAND = "pytest tests/codegen/test_lift.py"
EXAMPLES = sorted(Path(path("examples")).glob("*.tlp"))
MANUALS = [
    example
    for text in sorted((Path(__file__).parent.parent / "examples").glob("*chapter*.txt"))
    for example in read_examples(text)
]


def kinds(text: str) -> list[type[Instruction]]:
    """What the lines between the first label and the last EN become."""
    program = lift(f"#PROG\n{text}\nEN", "x", SETUP).program
    return [type(step.instruction) for step in (*program.configuration, *program.main)]


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("PR ,2000\nSP ,5000\nBG Y\nAM Y", [SingleAxisMove]),
        ("PR ,2000;SP ,5000;BG Y;AM Y", [SingleAxisMove]),
        ("PA ,,-500\nBG Z", [SingleAxisMove]),
        ("PR 100,200\nBG XY", None),  # X and Y are set one after the other, and then begin together
        ("SP 5000,,6000", [MotionParameters]),
        ("JP #B,V1>5", [Jump]),
        ("V1=2*@SIN[30]", [MathematicalEquation]),
        ("V1=1+B*2", [TwoLetterCode]),  # read from left to right only by the controller: nothing is guessed
        ("V1=B*2+1", [MathematicalEquation]),  # everybody reads it so
        ("POS[3]=V1+1", [MathematicalEquation]),
        ("XQ #B,2", [Execute]),
        ("SH XY\nMO Z", [Drive, Drive]),
        ("PR LEN*4000\nBG X", [SingleAxisMove]),
        ("#A\nJS #B", [Label, Jump]),
        ("VM XY\nVS 4000\nVP 1000,0\nCR 500,-90,180\nVP 0,1000\nVE\nBGS\nAMS", [CircularPath]),
        ("VM XYZ\nTN 10,0\nVS 4000\nVP 1000,0\nVE\nPA ,,_TN\nBG Z\nAM Z\nBGS\nAMS", [TangentPath]),
        ("LM XYZ\nVS 4000\nLI 100,200,300<2000\nLI ,,50\nLE\nBG S\nAM S", [LinearPath]),
        ("VM XY\nVS 4000\nVP 1000,0\nSB 1\nVP 2000,0\nVE\nBGS\nAMS", None),
        ("CM XY\nDT 4\nCD 10,20\nWC\nCD 5,5\nWC\nDT 0\nCD 0,0\nAM XY", [ContourMode]),
        ("EA X\nEM 2000,500\nEP 1000,0\nET[0]=,0\nET[1]=,300\nET[2]=,500\nEB 1\nEG ,100", [ElectronicCam] * 2),
        ("GA CX\nGR ,1.5\nGR ,0", [ElectronicGearing, DisableGearing]),
        ('MG {P2}"AT",_TPX{F6.0},{^13}{N}', [Print]),
        ('IN {P2}"LEN?",LEN{S4}', [UserInterface]),
        ("II 2\nII ,,5", [Interrupt, Interrupt]),
        ("SP 500\nHM X\nBG X\nAM X", [Home]),
        ("KP 1,2\nKI 0.5\nKD 3", [PidGains]),
        ("RA A[],B[]\nRD _TPX,_TEX\nRC 2,-100", [RecordData]),
        ("ST XY\nAM XY", [StopMotion]),
        ("AM\nAT -40\nAD ,500\nWT 20", [WaitForCondition] * 3 + [Wait]),
        ("TP\nWT 5;TC 1", [TwoLetterCode, Wait, TwoLetterCode]),
        ("AC 100000", [TwoLetterCode]),  # a dialog would send 99328: the same to the controller, not the same source
    ],
)
def test_what_is_recognised(text: str, wanted: list[type[Instruction]] | None) -> None:
    found = kinds(text)
    if wanted is None:
        assert TwoLetterCode not in found and len(found) >= 3
    else:
        assert found == wanted


# ------------------------------------------------------------------ nothing is lost


def told(text: str, setup: Setup) -> list[Statement]:
    """The statements that the controller gets."""
    found = [statement for _, statement in parse(text).statements()]
    return plain([each for each in found if not (isinstance(each, Comment) and each.mark != "NO")], setup.limits)


def same(source: str, listing: Listing, setup: Setup) -> bool:
    """Whether the code is the source but for a label at its head, an EN, and the arrays' DA."""
    wanted, got = told(source, setup), told(listing.text, setup)
    rest = iter(wanted)
    expected = next(rest, None)
    for each in got:
        if each == expected:
            expected = next(rest, None)
        elif not isinstance(each, LabelNode) and each != Command("EN"):
            return False
    return expected is None and len(got) <= len(wanted) + 3


def sources(example: Example) -> list[str]:
    """The programs that an example of the manual loads."""
    found: list[str] = []
    block: list[str] | None = None
    for _, line in example.steps:
        if line.strip() == "program":
            block = []
        elif line == "end" and block is not None:
            found.append("\n".join(block))
            block = None
        elif block is not None:
            block.append(line)
    return found


def by_hand(documents: Sequence[Document]) -> float:
    """Which part of the steps stays two-letter code, in percent."""
    steps = [step for document in documents for step in document.program.steps()]
    return 100 * sum(isinstance(step.instruction, TwoLetterCode) for step in steps) / len(steps)


def test_every_program_of_the_manuals_comes_back_as_it_was() -> None:
    """Of 556 steps 164 stayed code (29 %) when lines of several statements, paths and tables were not recognised."""
    documents, places = [], 0
    for example in MANUALS:
        setup = Setup(model=example.model)
        for text in sources(example):
            documents.append(lift(text, "PROG", setup))
            places += 1
            assert same(text, generate(documents[-1]), setup), f"{example}\n{text}\n--\n{generate(documents[-1]).text}"
    assert places > 70
    share = by_hand(documents)
    record("import: steps of the manuals' programs that stay code", COMMAND, None, share, "%")
    assert share < 12


@pytest.mark.parametrize("known", [True, False], ids=["with its setup", "in counts"])
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda each: each.stem)
def test_every_program_we_ship_comes_back_as_it_was(example: Path, known: bool) -> None:
    """Letter by letter; with the machine's setup every step is an instruction again."""
    document = files.load(example)
    text = generate(document).text
    setup = document.setup if known else Setup(model=document.setup.model)
    lifted = lift(text, document.program.name, setup)
    assert generate(lifted).text == text
    if known:
        assert not any(isinstance(step.instruction, TwoLetterCode) for step in lifted.program.steps())


def golden_modes() -> list[str]:
    """The code of every mode of every instruction."""
    blocks: list[list[str]] = []
    for line in (Path(__file__).parent.parent / "golden" / "modes.txt").read_text(encoding="utf-8").splitlines():
        if line.startswith("    "):
            blocks[-1].append(line.strip())
        elif line:
            blocks.append([])
    return ["\n".join(block) for block in blocks if block]


def test_every_mode_of_every_instruction_comes_back_as_it_was() -> None:
    documents = []
    for text in golden_modes():
        source = f"#P\n{text}\nEN"
        documents.append(lift(source, "P", SETUP))
        assert same(source, generate(documents[-1]), SETUP), text
    share = by_hand(documents)
    record("import: steps of every mode that stay code", COMMAND, None, share, "%")
    assert share < 19  # arrays without DA in front, other scales, labels of routines that stand alone


@settings(max_examples=count(12, 1000))
@given(program=programs())
def test_any_program_comes_back_as_it_was(program: Program) -> None:
    document = Document(program, RANDOM_SETUP)
    text = generate(document).text
    assert same(text, generate(lift(text, program.name or "P", RANDOM_SETUP)), RANDOM_SETUP)


@pytest.mark.parametrize(
    "source",
    [
        "#TASK\nAT0\nCB1\n#LOOP\nAT 10\nSB1\nAT -40\nCB1\nJP #LOOP,@IN[2]=1\nEN",
        "#A\nPR ,8000\nSP ,2000\nBG Y\nAM Y\nV1=V1+1\nJP #A,V1<5\nEN\n#CUT\nSB 1\nWT 20\nCB 1\nEN",
        '#A\nPR 1,2,3;BG\nAM\nCI ,2\nMG "A",V1{F4.2}\nEN',
        '#AUTO\n#MAIN\nVM XY\nVP 10,10<500\nCR 100,0,90\nVE\nBGS\nAMS\nEN\n#LIMSWI\nMG "X"\nRE',
        "SB 1\nWT 5\nCB 1",  # no label, no end
        "#A\nJP #A\n#LIMSWI\nRE\n#POSERR\nAB\nRE\n#ININT\nRI",
        "#A\nSB 1\nIF (V1=1)\nEN",  # later controllers have it
        "#A\nREM a remark\nSB 1\n' another\nNO in the code\nEN",
        "#A;JS #B,V1=1;EN;#B;JS #A;EN",
        "#A\n#A\nJP #NOWHERE\nEN",
        "#A\nDA POS[],D[]\nDM POS[5]\nDM D[6]\nEN",
        "#A\nDM POS[5],D[6]\nDA *[0]\nEN",
        "#R1\nRC1=5\n#R2\nRC1=RC1-1\nJP #R2,RC1>0\nJP #R1\nEN",
        "",
    ],
)
def test_the_code_stays_the_same(source: str) -> None:
    """Labels, statements and their order: the visual program writes what was read."""
    assert same(source, generate(lift(source, "x", SETUP)), SETUP)


def test_a_program_that_counts_its_lines_is_left_as_it_is_and_says_so() -> None:
    """A step more or less would send the jump elsewhere."""
    source = "#A\nSB 1;WT 5\nJP 1,@IN[1]=1\nEN"
    lifted = lift(source, "A", SETUP)
    kinds_found = [type(step.instruction).__name__ for step in lifted.program.main]
    assert kinds_found == ["Comment", "TwoLetterCode"]
    assert source in generate(lifted).text


def test_a_line_that_is_not_understood_is_kept_and_says_what_is_wrong() -> None:
    lifted = lift('#A\nSB 1\nMG "unclosed\nXX 5;WT 1\nCB 1\nEN', "A", SETUP)
    texts = [step.instruction.text for step in lifted.program.main if isinstance(step.instruction, TwoLetterCode)]
    assert texts == ['MG "unclosed', "XX 5;WT 1"]
    listing = generate(lifted)
    assert [finding.severity for finding in listing.problems] == ["error", "error"]
    assert "SB 1" in listing.text and "CB 1" in listing.text


def test_the_revision_in_the_first_line_becomes_that_of_the_program() -> None:
    source = "NO Long name, rev C, 2026-11-22, by J. Smith\n#LONGNAM\nSB 1\nEN"
    document = lift(source, "x", SETUP)
    assert document.program.name == "Long name"
    made = document.handover
    assert (made.revision, made.date, made.author) == ("C", "2026-11-22", "J. Smith")
    assert generate(document).text == source


def test_remarks_are_kept() -> None:
    program = lift("#A\nREM first the clamp\nSB 1\nEN", "A", SETUP).program
    texts = [getattr(step.instruction, "text", "") for step in program.steps()]
    assert texts[0] == "first the clamp"


def test_counts_become_units_where_the_machine_is_known() -> None:
    """637 counts an inch: 6370 are 10 inches (dmc-1412-1414.txt l.4018-4035)."""
    document = files.load(Path(path("examples/wire-cutter.tlp")))
    lifted = lift("#A\nPR 6370\nSP 3184\nBG X\nAM X\nEN", "A", document.setup)
    move = lifted.program.main[0].instruction
    assert isinstance(move, SingleAxisMove) and move.distance == "10"
    assert "PR 6370\nSP 3184" in generate(lifted).text
