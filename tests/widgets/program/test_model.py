"""The rows equal the document after any edits, and rows that stay keep their identity."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
from PySide6.QtCore import QPersistentModelIndex
from PySide6.QtTest import QAbstractItemModelTester

from codegen.changes import apply
from codegen.document import Document
from codegen.instructions import Repeat, Subroutine, Wait
from codegen.program import Place, Program, Section, Step, fresh, insert, move, remove, replace
from widgets.program.difference import edits
from widgets.program.model import ProgramModel
from widgets.program.node import Node
from widgets.program.words import Words


def shape(node: Node) -> object:
    """A row and those below it, as ids."""
    return (node.id, [shape(child) for child in node.children])


def wanted(program: Program) -> object:
    """What the rows must be."""

    def of(step: Step) -> object:
        return (step.id, [of(inner) for inner in step.body])

    sections = [(section.value, [of(step) for step in program.section(section)]) for section in Section]
    return ("", sections)


def edited(program: Program, choice: tuple[int, int, int, int]) -> Program:
    """One edit, chosen by four numbers."""
    what, which, where, index = choice
    steps = list(program.steps())
    holders = [Section.MAIN.value, Section.ROUTINES.value, *(s.id for s in steps if s.instruction.container)]
    parent = holders[where % len(holders)]
    place = Place(parent, index % (1 + len(_children(program, parent))))
    if what == 0 or not steps:
        kinds = (Wait(time=str(which + 1)), Repeat(), Subroutine(name=f"S{which}"))
        return insert(program, [fresh(program, kinds[which % 3])], place)
    step = steps[which % len(steps)]
    if what == 1:
        return remove(program, [step.id])
    if what == 2:
        return move(program, [step.id, steps[(which + 1) % len(steps)].id], place)
    return replace(program, Step(step.id, step.instruction, "changed", not step.enabled, step.body))


def _children(program: Program, parent: str) -> tuple[Step, ...]:
    if parent in tuple(Section):
        return program.section(Section(parent))
    return next(step.body for step in program.steps() if step.id == parent)


CHOICES = st.tuples(st.integers(0, 3), st.integers(0, 9), st.integers(0, 9), st.integers(0, 9))


def unfolded(node: Node) -> list[str]:
    """What is on the screen below a row: everything that no folded row hides."""
    return [] if node.folded else [name for child in node.children for name in (child.id, *unfolded(child))]


@given(st.lists(st.tuples(st.lists(CHOICES, min_size=1, max_size=4), st.integers(0, 30)), max_size=12))
@settings(max_examples=60)
def test_the_rows_equal_the_document_after_any_edits(
    batches: list[tuple[list[tuple[int, int, int, int]], int]],
) -> None:
    model = ProgramModel(Words())
    tester = QAbstractItemModelTester(model, QAbstractItemModelTester.FailureReportingMode.Fatal)
    program = Program()
    for batch, turned in batches:
        for choice in batch:
            program = edited(program, choice)
        model.show(Document(program))
        name = sorted(model.nodes)[turned % len(model.nodes)]
        model.fold(name, not model.nodes[name].folded)
        assert [node.id for node in model.rows] == unfolded(model.root)
        assert all(node.line == model.rows.index(node) for node in model.rows)
        assert all(node.line == -1 for node in model.root.walk() if node not in model.rows)
        assert shape(model.root) == wanted(program)
        assert [node.step for node in model.root.walk() if node.step] == list(program.steps())
        assert all(child.row == row for node in model.root.walk() for row, child in enumerate(node.children))
        assert set(model.nodes) == {section.value for section in Section} | {step.id for step in program.steps()}
    assert tester.model() is model


@given(st.lists(st.integers(0, 39), min_size=1, max_size=6), st.integers(0, 40))
@settings(max_examples=60)
def test_moved_steps_are_told_in_few_edits(which: list[int], place: int) -> None:
    program = Program(main=tuple(Step(f"s{number}", Wait(time="1")) for number in range(40)))
    after = move(program, [f"s{number}" for number in which], Place(Section.MAIN, place))
    found = edits(program, after)
    assert apply(program, found) == after
    assert len(found) <= len(set(which))


def test_a_step_dragged_into_a_repeat_keeps_its_row_object() -> None:
    program = Program(main=(Step("s1", Repeat()), Step("s2", Wait(time="1")), Step("s3", Wait(time="2"))))
    model = ProgramModel(Words())
    model.show(Document(program))
    kept = QPersistentModelIndex(model.index_of("s3"))
    model.show(Document(move(program, ["s3"], Place("s1", 0))))
    assert kept.isValid()
    assert model.node(kept).id == "s3"
    above = model.node(kept).parent
    assert above is not None
    assert above.id == "s1"


def test_only_the_rows_that_changed_are_told() -> None:
    steps = tuple(Step(f"s{number}", Wait(time=str(number + 1))) for number in range(100))
    program = Program(main=steps)
    model = ProgramModel(Words())
    model.show(Document(program))
    told: list[str] = []
    model.dataChanged.connect(lambda first, last, roles=(): told.append(model.node(first).id))
    model.modelReset.connect(lambda: told.append("reset"))
    model.rowsInserted.connect(lambda *_: told.append("inserted"))
    model.rowsRemoved.connect(lambda *_: told.append("removed"))
    model.show(Document(replace(program, Step("s42", Wait(time="7")))))
    assert told == ["s42"]
    told.clear()
    model.show(Document(move(model.shown.program, ["s0"], Place(Section.MAIN, 100))))
    assert told == []  # a move is a move: nothing is inserted or removed


def test_showing_the_same_document_twice_does_nothing() -> None:
    program = Program(main=(Step("s1", Wait(time="1")),))
    model = ProgramModel(Words())
    model.show(Document(program))
    model.show(Document(program))
    assert shape(model.root) == wanted(program)
