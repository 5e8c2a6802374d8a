"""Edits of programs, differences between them, undo."""

from __future__ import annotations

import dataclasses as dc
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

from codegen.changes import Changed, Inserted, Moved, Removed, apply, changes, longest_rising
from codegen.document import Document
from codegen.history import History
from codegen.instructions import AccelDecel, AutoExecution, Comment, End, Jump, Label, Output, Repeat, Subroutine, Wait
from codegen.program import (
    Place,
    Program,
    Section,
    Step,
    children,
    find,
    fresh,
    insert,
    labels,
    move,
    open_routine,
    place_for,
    place_of,
    program_label,
    remove,
    renewed,
    replace,
    section_of,
    variables,
)
from tests.codegen.strategies import programs

A, B, C, D = (Step(id, Label(name=id.upper())) for id in "abcd")
LOOP = Step("loop", Repeat(), body=(C, D))
PROGRAM = Program("P", main=(A, B, LOOP))


def shape(program: Program) -> str:
    def of(steps: tuple[Step, ...]) -> str:
        return " ".join(step.id + (f"({of(step.body)})" if step.body else "") for step in steps)

    return " / ".join(of(program.section(section)) for section in Section)


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        (Place("main", 0), " / x a b loop(c d) / "),
        (Place("main", 3), " / a b loop(c d) x / "),
        (Place("loop", 1), " / a b loop(c x d) / "),
        (Place("configuration", 0), "x / a b loop(c d) / "),
    ],
)
def test_insert(place: Place, expected: str) -> None:
    program = insert(PROGRAM, [Step("x", Wait(time="1"))], place)
    assert shape(program) == expected
    assert place_of(program, "x") == place
    assert remove(program, ["x"]) == PROGRAM


@pytest.mark.parametrize(
    ("ids", "place", "expected"),
    [
        (["a"], Place("main", 3), " / b loop(c d) a / "),
        (["a"], Place("main", 0), " / a b loop(c d) / "),
        (["a"], Place("main", 1), " / a b loop(c d) / "),
        (["loop"], Place("main", 0), " / loop(c d) a b / "),
        (["a", "b"], Place("loop", 1), " / loop(c a b d) / "),
        (["d"], Place("main", 0), " / d a b loop(c) / "),
        (["c", "d"], Place("loop", 0), " / a b loop(c d) / "),
        (["loop"], Place("loop", 0), " / a b loop(c d) / "),
        (["loop", "c"], Place("main", 0), " / loop(c d) a b / "),
    ],
)
def test_move(ids: list[str], place: Place, expected: str) -> None:
    assert shape(move(PROGRAM, ids, place)) == expected


def test_replace_keeps_the_rest_identical() -> None:
    program = replace(PROGRAM, dc.replace(C, note="new"))
    assert find(program, "c").note == "new"
    assert program.main[0] is A and program.configuration is PROGRAM.configuration
    assert replace(program, dc.replace(find(program, "c"), note="")) == PROGRAM


def test_look_up() -> None:
    assert section_of(PROGRAM, "d") is Section.MAIN and children(PROGRAM, "loop") == (C, D)
    with pytest.raises(KeyError):
        find(PROGRAM, "zz")
    with pytest.raises(KeyError):
        place_of(PROGRAM, "zz")


def test_new_ids_are_unused() -> None:
    program = Program(main=(Step("s7", Repeat(), body=(Step("s9", Wait(time="1")),)),))
    assert fresh(program, Wait()).id == "s10"
    copies = renewed(program, program.main)
    assert [copies[0].id, copies[0].body[0].id] == ["s10", "s11"]


def test_where_new_instructions_go() -> None:
    """The rules of the catalogue: sections, open subroutines, before the selected step."""
    program = PROGRAM
    assert place_for(program, Wait(time="1")) == Place("main", 3)
    assert place_for(program, AccelDecel()) == Place("configuration", 0)
    assert place_for(program, AutoExecution, selected="b") == Place("configuration", 0)
    assert place_for(program, Wait, selected="b") == Place("main", 1)
    assert place_for(program, Wait, selected="d") == Place("loop", 1)
    assert place_for(program, Comment, section=Section.CONFIGURATION) == Place("configuration", 0)
    program = insert(program, [Step("r", Subroutine(name="CUT"))], place_for(program, Subroutine))
    assert open_routine(program) == "r"
    assert place_for(program, Output) == Place("r", 0)
    assert place_for(program, Output, section=Section.MAIN) == Place("main", 3)
    program = insert(program, [Step("e", End())], place_for(program, End))
    assert open_routine(program) is None
    assert place_for(program, Output) == Place("main", 3)


def test_names() -> None:
    program = insert(
        PROGRAM, [Step("r", Subroutine(name="CUT"), body=(Step("j", Jump(target="A")),))], Place("routines", 0)
    )
    assert labels(program) == ("A", "B", "C", "D", "CUT")
    assert variables(program) == ()


@pytest.mark.parametrize(
    ("name", "label"),
    [
        ("Cutter", "CUTTER"),
        ("wire cutter 2", "WIRECUT"),
        ("2 cutters", "CUTTERS"),
        ("", "MAIN"),
        ("42", "MAIN"),
        ("Säge!", "SGE"),
        ("a", "MAIN"),
        ("auto", "MAIN"),
    ],
)
def test_program_label(name: str, label: str) -> None:
    """First 7 letters and digits, a letter first; clash (label A, system label) or empty: MAIN."""
    assert program_label(dc.replace(PROGRAM, name=name)) == label


# ------------------------------------------------------------------ differences


@given(programs(), programs())
def test_changes_lead_from_any_program_to_any_other(old: Program, new: Program) -> None:
    edits = changes(old, new)
    done = apply(old, edits)
    assert (done.configuration, done.main, done.routines) == (new.configuration, new.main, new.routines)


@st.composite
def edited(draw: st.DrawFn) -> tuple[Program, Program]:
    """A program and what a few edits make of it."""
    old = new = draw(programs())
    for _ in range(draw(st.integers(1, 4))):
        ids = [step.id for step in new.steps()]
        places = ["configuration", "main", *(step.id for step in new.steps() if step.instruction.container)]
        parent = draw(st.sampled_from(places))
        place = Place(parent, draw(st.integers(0, len(children(new, parent)))))
        match draw(st.integers(0, 3)):
            case 0:
                new = insert(new, [fresh(new, Wait(time="5"))], place)
            case 1 if ids:
                new = remove(new, draw(st.lists(st.sampled_from(ids), min_size=1, max_size=3)))
            case 2 if ids:
                new = move(new, draw(st.lists(st.sampled_from(ids), min_size=1, max_size=3)), place)
            case 3 if ids:
                step = find(new, draw(st.sampled_from(ids)))
                new = replace(new, dc.replace(step, note="changed", enabled=not step.enabled))
            case _:
                pass
    return old, new


@given(edited())
def test_changes_after_edits(pair: tuple[Program, Program]) -> None:
    old, new = pair
    edits = changes(old, new)
    done = apply(old, edits)
    assert (done.configuration, done.main, done.routines) == (new.configuration, new.main, new.routines)
    assert (edits == ()) == ((old.configuration, old.main, old.routines) == (new.configuration, new.main, new.routines))


def test_changes_are_few() -> None:
    assert changes(PROGRAM, PROGRAM) == ()
    assert changes(PROGRAM, move(PROGRAM, ["a"], Place("main", 3))) == (Moved("a", Place("main", 0), Place("main", 2)),)
    assert changes(PROGRAM, remove(PROGRAM, ["loop"])) == (Removed("loop", Place("main", 2)),)
    note = dc.replace(D, note="n")
    assert changes(PROGRAM, replace(PROGRAM, note)) == (Changed(note),)
    new = Step("x", Wait(time="1"))
    assert changes(PROGRAM, insert(PROGRAM, [new], Place("loop", 2))) == (Inserted(new, Place("loop", 2)),)
    assert changes(PROGRAM, move(PROGRAM, ["c"], Place("main", 0))) == (Moved("c", Place("loop", 0), Place("main", 0)),)


@given(st.permutations(range(8)))
def test_longest_rising(numbers: list[int]) -> None:
    """Against the definition: the longest of all rising selections."""
    run = longest_rising(numbers)
    assert run == sorted(run) and all(numbers[a] < numbers[b] for a, b in pairwise(run))
    longest = 0
    for mask in range(256):
        chosen = [number for place, number in enumerate(numbers) if mask >> place & 1]
        if chosen == sorted(chosen):
            longest = max(longest, len(chosen))
    assert len(run) == longest


# ------------------------------------------------------------------------- undo


def named(name: str) -> Document:
    return Document(Program(name))


def test_typing_joins_within_a_second() -> None:
    history = History(named(""))
    for now, text in ((0.0, "C"), (0.4, "CU"), (1.3, "CUT")):
        history = history.push(named(text), "change name", key="name", now=now)
    assert history.labels == ("change name",)
    history = history.push(named("CUTTER"), "change name", key="name", now=2.4)
    assert len(history.labels) == 2
    history = history.push(named("X"), "change note", key="note", now=2.5).push(named("Y"), "insert", now=2.6)
    assert history.labels == ("change name", "change name", "change note", "insert")
    assert history.undo().undo().undo().present == named("CUT")


def test_nothing_changed_is_no_step() -> None:
    history = History(named("A"))
    assert history.push(named("A"), "nothing", now=0.0) is history
    assert history.undo() is history and history.redo() is history


def test_undo_breaks_joining() -> None:
    history = History(named("")).push(named("A"), "type", key="k", now=0.0).undo().redo()
    assert len(history.push(named("AB"), "type", key="k", now=0.1).labels) == 2


class Undoing(RuleBasedStateMachine):
    """Undo and redo against a plain list of everything that was."""

    def __init__(self) -> None:
        super().__init__()
        self.history = History(named("0"), most=5)
        self.states = ["0"]
        self.at = 0
        self.number = 0

    @rule()
    def push(self) -> None:
        self.number += 1
        self.history = self.history.push(named(str(self.number)), f"edit {self.number}", now=float(self.number))
        self.states = [*self.states[: self.at + 1], str(self.number)][-6:]
        self.at = len(self.states) - 1

    @rule()
    def undo(self) -> None:
        self.at = max(self.at - 1, 0)
        self.history = self.history.undo()

    @rule()
    def redo(self) -> None:
        self.at = min(self.at + 1, len(self.states) - 1)
        self.history = self.history.redo()

    @invariant()
    def same(self) -> None:
        assert self.history.present.program.name == self.states[self.at]
        assert self.history.can_undo == (self.at > 0) and self.history.can_redo == (self.at < len(self.states) - 1)
        if self.history.can_undo:
            assert self.history.undo_label == f"edit {self.states[self.at]}"
        if self.history.can_redo:
            assert self.history.redo_label == f"edit {self.states[self.at + 1]}"


TestUndoing = Undoing.TestCase
