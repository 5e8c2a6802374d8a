"""Every instruction: code that parses back, a finished sentence, help, a file round trip, an emitter per language."""

from __future__ import annotations

import dataclasses as dc
import re
from typing import Any

import pytest
from hypothesis import given

from codegen import files, smartmotor
from codegen.docs import EXAMPLE_SETUP, page
from codegen.document import Document
from codegen.fields import Choice, ListOf, fields_of
from codegen.generate import code
from codegen.instructions import ALL, GROUPS, Instruction
from codegen.program import Program, Step
from codegen.read import has_errors, problems, sentence
from codegen.twoletter import emit
from codegen.twoletter.calls import Assign, Body, Call, Mark, Raw
from codegen.twoletter.emit.build import Build
from codegen.twoletter.format import format_statement
from codegen.twoletter.nodes import Assign as AssignNode
from codegen.twoletter.nodes import Broken, Command, Comment, Foreign
from codegen.twoletter.nodes import Label as LabelNode
from codegen.twoletter.parse import parse_line
from tests.codegen.strategies import SETUP, instructions

KINDS = pytest.mark.parametrize("kind", ALL, ids=lambda kind: kind.__name__)
ROWS = [field.row for kind in ALL for field in fields_of(kind).values() if isinstance(field, ListOf)]


@KINDS
def test_help_and_labels(kind: type[Instruction]) -> None:
    """Nothing without help text, and every value is a field."""
    assert kind.title and kind.help.endswith(".") and kind.group in GROUPS
    for field in dc.fields(kind):
        shown = fields_of(kind)[field.name]
        assert shown.label and shown.help, f"{kind.__name__}.{field.name}"
        if isinstance(shown, Choice):
            assert set(shown.words) in (set(shown.kind), set()), f"{kind.__name__}.{field.name}: a choice without words"


@pytest.mark.parametrize("kind", [*ALL, *ROWS], ids=lambda kind: kind.__name__)
def test_when_names_siblings_and_their_values(kind: type[Any]) -> None:
    """`when` is data: every name is a sibling, every value one it can have."""
    for name, field in fields_of(kind).items():
        for sibling, wanted in field.when.items():
            other = fields_of(kind)[sibling]
            assert sibling != name
            for value in wanted if isinstance(wanted, tuple) else (wanted,):
                assert value in tuple(other.kind) if isinstance(other, Choice) else isinstance(value, bool)


@KINDS
def test_sentence_names_only_fields(kind: type[Instruction]) -> None:
    names = set(re.findall(r"\{(\w+)\}", kind.sentence))
    assert names <= set(fields_of(kind)) | {"axis"}
    assert not any(mark in sentence(kind(), SETUP) for mark in "{}[]<>\0")


@KINDS
def test_a_new_one_tells_what_is_missing(kind: type[Instruction]) -> None:
    """A new instruction either is complete or names a field that is shown."""
    for finding in problems(kind(), SETUP):
        assert finding.field in fields_of(kind) or finding.message == kind.needs
        assert "\n" not in finding.message and not finding.message.endswith(".")


@KINDS
def test_example_is_complete(kind: type[Instruction]) -> None:
    example = kind.example()
    if kind.needs:
        assert [finding.message for finding in problems(example, EXAMPLE_SETUP)] == [kind.needs]
        return
    assert problems(example, EXAMPLE_SETUP) == ()
    assert "…" not in sentence(example, EXAMPLE_SETUP)
    text = page(kind)
    assert text.startswith(f"# {kind.title}\n") and sentence(example, EXAMPLE_SETUP) in text
    assert all(line in text for line in code(example, EXAMPLE_SETUP))


@KINDS
def test_every_language_has_an_emitter_or_a_reason(kind: type[Instruction]) -> None:
    for language in (emit, smartmotor):
        has = kind in language.EMITTERS
        reason = language.CANNOT.get(kind, "")
        assert has != bool(reason), f"{kind.__name__} in {language.__name__}"


@given(instructions())
def test_code_parses_back_to_the_same_calls(instruction: Instruction) -> None:
    if has_errors(instruction, SETUP):
        return
    for statement in emit.statements(instruction, Build(SETUP)):
        if isinstance(statement, Body | Raw):
            continue
        text = "".join(character if character.isascii() else "1" for character in statement.text)
        parsed = parse_line(text).statements
        assert len(parsed) == 1, text
        node = parsed[0]
        assert not isinstance(node, Broken | Foreign), (text, node)
        match statement:
            case Call(name=name):
                assert isinstance(node, Comment) if name == "NO" else isinstance(node, Command) and node.name == name
            case Mark():
                assert isinstance(node, LabelNode)
            case Assign():
                assert isinstance(node, AssignNode)
        again = parse_line(format_statement(node)).statements
        assert again == parsed, text


@given(instructions())
def test_sentences_are_finished(instruction: Instruction) -> None:
    """No mark of the template is left over; brackets and braces come only from values."""
    text = sentence(instruction, SETUP)
    typed = repr(instruction)
    for mark in "{}\0|":
        assert mark not in text or mark in typed
    assert "  " not in text.replace(", ", ",") or "  " in typed
    assert text == text.strip() or typed != typed.strip() or "text" in typed


@given(instructions())
def test_files_keep_every_value(instruction: Instruction) -> None:
    document = Document(Program("P", main=(Step("s1", instruction),)), SETUP)
    text = files.dumps(document)
    assert files.loads(text) == document
    assert files.dumps(files.loads(text)) == text


@given(instructions())
def test_lines_fit_the_controller(instruction: Instruction) -> None:
    assert all(len(line) <= SETUP.limits.columns for line in code(instruction, SETUP))


def test_rows_hold_no_lists() -> None:
    """A row holds no list of its own, so that a form can show it as one entry."""
    for row in ROWS:
        assert not any(isinstance(field, ListOf) for field in fields_of(row).values())
