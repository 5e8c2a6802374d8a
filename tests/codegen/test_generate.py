"""Programs to code: the frame, the source map, unique names, what stands in the way."""

from __future__ import annotations

import dataclasses as dc
import random
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen import files, read
from codegen.compiled import _compiled
from codegen.document import Document
from codegen.generate import Listing, generate
from codegen.instructions import (
    AutoExecution,
    Comment,
    End,
    Instruction,
    Jump,
    Label,
    LoopRate,
    MathematicalEquation,
    Output,
    Print,
    Repeat,
    SingleAxisMove,
    StopMotion,
    Subroutine,
    TwoLetterCode,
    VariableArray,
    Wait,
)
from codegen.instructions.configuration import Declare
from codegen.instructions.flow import EndOf, RepeatMode, Routine
from codegen.instructions.math import Equation
from codegen.instructions.motion import MoveMode, Which
from codegen.instructions.operator import ItemKind, PrintItem
from codegen.models import MODELS
from codegen.program import Place, Program, Step, find, fresh, insert, replace
from codegen.read import _problems, _sentence, sentence
from codegen.setup import Axis, Setup
from codegen.twoletter.check import check
from resources import path
from tests.benchmarks.editing import large_document, random_edit
from tests.codegen.strategies import SETUP, items, programs
from tests.long import count

GOLDEN = Path(__file__).parent.parent / "golden"
EXAMPLES = sorted(Path(path("examples")).glob("*.tlp"))


def document(*main: Instruction, setup: Setup = SETUP, name: str = "P") -> Document:
    return Document(Program(name, main=tuple(Step(f"s{place}", each) for place, each in enumerate(main))), setup)


def code(*main: Instruction, setup: Setup = SETUP) -> list[str]:
    """The lines between `#P` and `EN`."""
    listing = generate(document(*main, setup=setup))
    assert listing.is_complete, listing.problems
    return listing.text.splitlines()[1:-1]


def test_the_wire_cutter() -> None:
    """The worked example of the catalogue, line by line (spec/instructions.md, end)."""
    cutter = files.load(path("examples/wire-cutter.tlp"))
    listing = generate(cutter)
    expected = "#CUTTER/AC 254976/DC 254976/#A/AI 1/PR 6370/SP 3184/BG X/AM X/SB 1/WT 20/CB 1/WT 80/JP #A/EN"
    assert listing.text.split("\n") == expected.split("/")
    assert listing.problems == ()
    sentences = [sentence(step.instruction, cutter.working_setup) for step in cutter.program.steps()]
    assert sentences == [
        "Accelerate X at 400 in/s², decelerate at 400 in/s²",
        "Label A",
        "Wait until input 1 is high",
        "Move X by 10 in at 5 in/s, then wait until the profile has ended",
        "Turn output 1 on",
        "Wait 20 ms (20 samples = 19.5 ms)",
        "Turn output 1 off",
        "Wait 80 ms (80 samples = 78.1 ms)",
        "Go to A",
    ]


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda each: each.stem)
def test_examples(example: Path, approve: bool) -> None:
    """Every example is complete, passes the checker, and gives the approved code and sentences."""
    program = files.load(example)
    listing = generate(program)
    errors = [finding for finding in listing.problems if finding.severity == "error"]
    assert errors == []
    assert [each for each in check(listing.text, program.setup.limits) if each.severity == "error"] == []
    rows = [f"{line.text:<30} {_said(program, listing, number)}".rstrip() for number, line in enumerate(listing.lines)]
    golden = GOLDEN / f"{example.stem}.txt"
    text = "\n".join(rows) + "\n"
    if approve:
        golden.write_text(text, encoding="utf-8")
    assert text == golden.read_text(encoding="utf-8")


def _said(program: Document, listing: Listing, number: int) -> str:
    step = listing.lines[number].step
    if not step or (number and listing.lines[number - 1].step == step):
        return ""
    return sentence(find(program.program, step).instruction, program.working_setup)


def test_frame() -> None:
    """#AUTO, the name, configuration, main, EN, then the subroutines."""
    program = Program(
        "Cutter",
        configuration=(Step("c", AutoExecution()), Step("v", VariableArray(variable="N", number="0"))),
        main=(Step("m", Output()),),
        routines=(
            Step("r", Subroutine(name="CUT"), body=(Step("w", Wait(time="5")), Step("e", End()))),
            Step("i", Subroutine(routine=Routine.ININT), body=(Step("f", End(of=EndOf.INPUT)),)),
        ),
    )
    listing = generate(Document(program, SETUP))
    expected = "#AUTO/#CUTTER/N=0/SB 1/EN/#CUT/WT 5/EN/#ININT/RI 0"
    assert listing.text.split("\n") == expected.split("/")
    assert listing.problems == ()
    assert [line.step for line in listing.lines] == ["", "", "v", "m", "", "r", "w", "e", "i", "f"]


def test_an_open_subroutine_gets_its_end() -> None:
    program = Program("P", routines=(Step("r", Subroutine(routine=Routine.LIMSWI), body=(Step("w", Wait(time="5")),)),))
    listing = generate(Document(program, SETUP))
    assert listing.text.split("\n")[2:] == ["#LIMSWI", "WT 5", "RE 0"]
    assert [finding.severity for finding in listing.problems] == ["warning"]


def test_a_wrong_end_is_a_problem() -> None:
    program = Program("P", routines=(Step("r", Subroutine(routine=Routine.POSERR), body=(Step("e", End()),)),))
    (finding,) = generate(Document(program, SETUP)).problems
    assert (finding.step, finding.message) == ("e", "POSERR needs the end of error or limit subroutine")


def test_commented_out_steps_send_nothing() -> None:
    steps = (Step("a", Output()), Step("b", Repeat(), enabled=False, body=(Step("c", Wait(time="5")),)))
    assert generate(Document(Program("P", main=steps), SETUP)).text == "#P\nSB 1\nEN"


def repeat(**values: object) -> list[str]:
    step = Step("r", Repeat(**values), body=(Step("o", Output()),))  # type: ignore[arg-type]
    return generate(Document(Program("P", main=(step,)), SETUP)).text.split("\n")[1:-1]


def test_repeats() -> None:
    assert repeat(count="3") == ["RC1=3", "#R1", "SB 1", "RC1=RC1-1", "JP #R1,RC1>0"]
    assert repeat(count="N") == ["RC1=N", "#R1", "JP #R2,RC1<=0", "SB 1", "RC1=RC1-1", "JP #R1", "#R2"]
    assert repeat(mode=RepeatMode.UNTIL, until="A>5") == ["#R1", "SB 1", "JP #R1,(A>5)=0"]
    assert repeat(mode=RepeatMode.WHILE, condition="A") == ["#R1", "JP #R2,A=0", "SB 1", "JP #R1", "#R2"]
    assert repeat(mode=RepeatMode.FOREVER) == ["#R1", "SB 1", "JP #R1"]


def test_generated_names_avoid_the_persons() -> None:
    inner = Step("i", Repeat(count="2"), body=(Step("o", Output()),))
    steps = (
        Step("l", Label(name="R1")),
        Step("v", VariableArray(variable="RC2")),
        Step("r", Repeat(count="3"), body=(inner,)),
    )
    text = generate(Document(Program("P", main=steps), SETUP)).text
    assert "#R3\n" in text and "RC4=2" in text and text.count("#R1\n") == 1


@given(programs())
def test_labels_are_unique_and_every_line_knows_its_step(program: Program) -> None:
    listing = generate(Document(program, SETUP))
    ids = {step.id for step in program.steps()}
    assert all(line.step in ids or line.text in ("EN", "#AUTO") or line.text.startswith("#") for line in listing.lines)
    generated = [line.text for line in listing.lines if line.text.startswith("#R")]
    assert len(generated) == len(set(generated))
    for number, line in enumerate(listing.lines):
        assert line.text.isascii() or line.problem
        if line.step:
            assert listing.step_of(number) == line.step and number in listing.lines_of(line.step)


@given(programs())
def test_compact_code_says_the_same(program: Program) -> None:
    plain = generate(Document(program, SETUP))
    packed = generate(Document(program, SETUP, compact=True))
    limit = SETUP.limits.columns
    assert all(len(line.text) <= limit or line.problem for line in packed.lines)
    assert packed.problems == plain.problems
    apart: list[tuple[str, str]] = []
    for line in packed.lines:
        spans = line.spans or ((0, len(line.text), line.step),)
        apart += [(line.text[start:end], step) for start, end, step in spans]
        assert ";".join(line.text[start:end] for start, end, _ in spans) == line.text
        assert all(packed.step_of(packed.lines.index(line), start) == step for start, _, step in spans[:1])
    assert apart == [(line.text, line.step) for line in plain.lines]
    assert not any("#" in line.text[1:].split('"')[0] and ";#" in line.text for line in packed.lines)


def test_long_programs_become_compact_by_themselves() -> None:
    small = Setup(model="dmc1412", axes=SETUP.axes)
    listing = generate(document(*[Output(output=str(place % 3 + 1)) for place in range(400)], setup=small))
    assert listing.is_complete and listing.lines[0].text == "#P;SB 1;SB 2;SB 3;SB 1;SB 2;SB 3;SB 1"
    assert max(len(line.text) for line in listing.lines) <= 40
    assert listing.step_of(0, 3) == "s0" and listing.step_of(0, 8) == "s1" and listing.step_of(0, 0) == ""
    many = generate(document(*[Label(name=f"L{place}") for place in range(300)], setup=small))
    assert [finding.message for finding in many.problems] == ["The program has 301 lines; the controller takes 250"]


def test_arrays_are_freed_before_the_first_is_made() -> None:
    arrays = [VariableArray(mode=Declare.ARRAY, array=name, size="10") for name in ("POS", "DIF")]
    assert code(Output(), *arrays) == ["SB 1", "DA POS[],DIF[]", "DM POS[10]", "DM DIF[10]"]


def test_problems_keep_the_listing_from_being_sent() -> None:
    listing = generate(document(SingleAxisMove(), Jump(target="NOWHERE"), Label(name="A"), Label(name="A")))
    assert not listing.is_complete
    assert [(finding.step, finding.message) for finding in listing.problems] == [
        ("s0", "Distance is missing"),
        ("s3", "The label A is used twice"),
        ("s1", "There is no label NOWHERE"),
    ]
    assert listing.lines[1].problem == "Distance is missing" and listing.lines[1].text == "' Distance is missing"


def test_a_label_in_written_code_counts() -> None:
    listing = generate(document(TwoLetterCode(text="#HERE;SB 1"), Jump(target="HERE")))
    assert listing.problems == ()
    clash = generate(document(TwoLetterCode(text="#P"), name="P"))
    assert clash.lines[0].text == "#MAIN"


def test_loop_rate_keeps_the_english_true() -> None:
    """TM 500: a sample is half as long, so speeds halve, accelerations quarter, waits double (safety.md, 6)."""
    setup = Setup(model="ssc1").with_axis("X", Axis(counts_per_unit="1000"))
    move = SingleAxisMove(distance="4", speed="8", acceleration="4096")
    steps = (Step("m", move), Step("w", Wait(time="20")), Step("v", SingleAxisMove(distance="LEN", speed="V")))
    rate = Step("t", LoopRate(period="500"))
    fast = Document(Program("P", configuration=(rate,), main=steps), setup)
    expected = "TM 500/PR 4000/SP 4000/AC 1024000/BG X/AM X/WT 40/PR LEN*1000/SP V*500/BG X/AM X/EN"
    assert generate(fast).text.split("\n")[1:] == expected.split("/")
    assert sentence(steps[0].instruction, fast.working_setup).startswith("Move X by 4 in at 8 in/s")
    assert sentence(steps[1].instruction, fast.working_setup) == "Wait 20 ms (40 samples = 19.5 ms)"
    late = Document(Program("P", main=(rate, *steps)), setup)
    assert [finding.step for finding in generate(late).problems] == ["t"]


def test_the_loop_rate_of_the_setup_is_sent() -> None:
    """Everything is converted for it, so the controller must have it (safety.md, 6)."""
    setup = Setup(model="ssc1", sample_us="2000").with_axis("X", Axis(counts_per_unit="637"))
    move = Step("m", SingleAxisMove(distance="1", speed="5"))
    listing = generate(Document(Program("P", main=(move,)), setup))
    assert listing.text.split("\n")[:4] == ["#P", "TM 2000", "PR 637", "SP 6370"] and listing.problems == ()
    own = (Step("t", LoopRate(period="1000")),)
    assert generate(Document(Program("P", configuration=own, main=(move,)), setup)).text.split("\n")[1] == "TM 1000"
    wrong = generate(Document(Program("P", main=(move,)), dc.replace(setup, model="ssc4", sample_us="250")))
    assert not wrong.is_complete


def test_a_step_with_an_error_sends_nothing() -> None:
    """What a model cannot do is a remark, never code."""
    listing = generate(document(StopMotion(which=Which.PATH), setup=Setup(model="ssc1")))
    assert [line.text for line in listing.lines] == ["#P", "' The SSC, one axis has no coordinated motion", "EN"]


def test_exact_waits() -> None:
    assert code(Wait(time="1000", exactly=True)) == ["WT 1024"]
    assert sentence(Wait(time="1000", exactly=True), SETUP) == "Wait 1000 ms (1024 samples = 1000 ms)"


def test_positional_axes() -> None:
    move = SingleAxisMove(axis="Y", mode=MoveMode.TO, position="2", speed="1")
    assert code(move) == ["PA ,8000", "SP ,4000", "BG Y", "AM Y"]


def test_long_messages_are_split() -> None:
    text = "x" * 60
    lines = code(
        Print(items=(PrintItem(text=text), PrintItem(text=text), PrintItem(kind=ItemKind.VALUE, expression="A+1")))
    )
    assert lines == [f'MG "{text}"{{N}}', f'MG "{text}",(A+1)']


def test_remarks_in_the_code() -> None:
    assert code(Comment(text="one; two\nthree", in_code=True), Comment(text="silent")) == ["NO one, two", "NO three"]


def test_equations_stay_raw_counts() -> None:
    assert code(
        MathematicalEquation(
            equations=(Equation(variable="A", expression="_TPX*2"), Equation(variable="B[1]", expression="(A+1)*2"))
        )
    ) == ["A=_TPX*2", "B[1]=(A+1)*2"]


@given(st.data())
def test_memo_equals_from_scratch(data: st.DataObject) -> None:
    """After random edits the memo gives what an empty one gives."""
    program = data.draw(programs())
    for _ in range(data.draw(st.integers(1, 3))):
        program = insert(program, [fresh(program, data.draw(items(Wait)))], Place("main", 0))
        step = data.draw(st.sampled_from(list(program.steps())))
        program = replace(program, dc.replace(step, enabled=not step.enabled))
        setup = data.draw(st.sampled_from([SETUP, SETUP.with_axis("X", Axis(counts_per_unit="100"))]))
        kept = generate(Document(program, setup))
        said = [sentence(each.instruction, setup) for each in program.steps()]
        for memo in (_compiled, _problems, _sentence):
            memo.cache_clear()
        anew = files.loads(files.dumps(Document(program, setup)))  # other instances: nothing is remembered
        assert generate(anew) == kept
        assert [sentence(each.instruction, setup) for each in anew.program.steps()] == said


def test_a_large_program_is_put_together_as_from_scratch() -> None:
    """1000 steps, some of them in repeats and subroutines of many steps, arrays, numbers, labels: edit by edit."""
    chance, large = random.Random(7), large_document()
    program, main = large.program, large.program.main
    held = (Step("r1", Repeat(count="5"), body=main[200:300]), Step("r2", Repeat(count="5"), body=main[300:303]))
    array = Step("a1", VariableArray(mode=Declare.ARRAY, array="PLACES", size="10"))
    routines = (Step("u1", Subroutine(name="GRIP"), body=(*main[400:500], Step("u2", Repeat(), body=main[500:502]))),)
    program = dc.replace(program, main=(*main[:200], *held, array, *main[502:]), routines=routines)
    now = dc.replace(large, program=program)
    for number in range(count(4, 200)):
        inside = chance.choice([step for step in now.program.steps() if step.id not in ("r1", "r2", "u1", "s0")])
        changed = replace(now.program, dc.replace(inside, enabled=not inside.enabled))
        now = random_edit(chance, dc.replace(now, program=changed), number)
        for each in (now, dc.replace(now, compact=True)):
            kept = generate(each)
            anew = generate(files.loads(files.dumps(each)))  # other instances: nothing is remembered
            assert anew == kept
            assert all(number in kept.lines_of(line.step) for number, line in enumerate(kept.lines))


@pytest.mark.parametrize("model", [name for name, model in MODELS.items() if model.family != "smartmotor"])
def test_axes_of_the_model(model: str) -> None:
    """An axis the controller has not is refused."""
    setup = Setup(model=model, axes=SETUP.axes)
    for letter in "XYZW":
        listing = generate(document(SingleAxisMove(axis=letter, distance="1", speed="9"), setup=setup))
        assert listing.is_complete == (letter in setup.letters)


def test_a_move_back_by_an_expression_says_outside_loops_too_that_it_is_rounded_down() -> None:
    """commands.md, 11: an argument of step 1 is rounded downwards: 0.63 counts forth are 0, back -1."""
    there, back = SingleAxisMove(distance="LEN", speed="5"), SingleAxisMove(distance="-LEN", speed="5")
    setup = Setup(model="ssc1").with_axis("X", Axis(counts_per_unit="637"))
    listing = generate(Document(Program("P", main=(Step("s1", there), Step("s2", back))), setup))
    told = [
        (finding.step, finding.field, finding.severity) for finding in listing.problems if "rounds" in finding.message
    ]
    assert told == [("s2", "distance", "warning")]
    assert [read.counts_text(move, "distance", setup) for move in (there, back)] == [
        "LEN × 637, rounded down to whole counts",
        "-LEN × 637, rounded down to whole counts",
    ]
