"""Author and revision travel with the program: file, first line of the code, and back from a controller."""

from __future__ import annotations

import dataclasses as dc

import pytest
from hypothesis import given
from hypothesis import strategies as st

import resources
from codegen import files
from codegen.document import Document
from codegen.generate import generate
from codegen.handover import Handover, Stamp, first_line, stamp_of
from codegen.models import MODELS
from codegen.twoletter.nodes import Comment
from codegen.twoletter.parse import parse
from codegen.twoletter.slow_mark import percent_of
from device.download import objection, program_lines

C = Handover("J. Smith", "C", "2026-11-22", "C: longer stroke\nB: first delivery")
SPEAKING = [model for model in MODELS.values() if model.columns]


def wire_cutter(handover: Handover) -> Document:
    return dc.replace(files.load(resources.path("examples/wire-cutter.tlp")), handover=handover)


def test_without_a_revision_the_code_is_as_before() -> None:
    plain = generate(wire_cutter(Handover()))
    assert generate(wire_cutter(Handover(author="J. Smith", changes="none"))).lines == plain.lines
    with_one = generate(wire_cutter(C))
    assert with_one.lines[0].text == "NO CUTTER, rev C, 2026-11-22, by J. Smith"
    assert with_one.lines[1:] == plain.lines


def test_the_file_keeps_it_and_older_files_open() -> None:
    text = files.dumps(wire_cutter(C))
    assert files.loads(text) == wire_cutter(C)
    assert "handover" not in files.dumps(wire_cutter(Handover()))
    with pytest.raises(files.FileUnreadable, match="handover"):
        files.loads(text.replace('"author"', '"autor"'))


@pytest.mark.parametrize("model", SPEAKING, ids=lambda model: model.name)
@given(*(st.text(max_size=60) for _ in range(3)))
def test_whatever_is_typed_is_one_comment_that_fits(model: object, name: str, revision: str, author: str) -> None:
    """80 columns; on the 141x 40 columns and comments of 38 characters (dmc-1412-1414.txt l.2536)."""
    assert model in SPEAKING
    line = first_line(Handover(author, revision, "2026-11-22"), name, model)  # type: ignore[arg-type]
    if not line:
        return
    assert objection([line], model) == "" and program_lines(line) == [line]  # type: ignore[arg-type]
    (statement,) = (each for _, each in parse(line).statements())
    assert isinstance(statement, Comment) and statement.mark == "NO"
    assert percent_of(line) == 100
    if model.name.startswith("dmc"):  # type: ignore[attr-defined]
        assert len(line) - len("NO ") <= 38


WORD = st.text(st.characters(codec="ascii", categories=("L", "N")), min_size=1, max_size=12)


@given(WORD, WORD, WORD)
def test_what_was_written_is_read_back(name: str, revision: str, author: str) -> None:
    line = first_line(Handover(author, revision, "2026-11-22"), name, MODELS["ssc4"])
    assert stamp_of(line) == Stamp(name, revision, "2026-11-22", author)


def test_on_a_short_line_the_author_goes_first_and_the_revision_stays() -> None:
    line = first_line(C, "Wire cutter of hall three", MODELS["dmc1412"])
    assert line == "NO Wire cutter of hall three, rev C"
    assert stamp_of(line) == Stamp("Wire cutter of hall three", "C")
    assert first_line(dc.replace(C, author="Jürgen Groß; Söhne"), "Säge", MODELS["ssc1"]) == (
        "NO Sage, rev C, 2026-11-22, by Jurgen Gross Sohne"
    )


@pytest.mark.parametrize("line", ["", "#A", "NO", "NO a remark", "NO revision C", "PR 100", "NO SLOWED TO 50 PERCENT"])
def test_any_other_first_line_is_no_stamp(line: str) -> None:
    assert stamp_of(line) is None


def test_it_is_said_in_words() -> None:
    stamp = stamp_of("NO Wirecutter, rev C, 2026-11-22, by J. Smith")
    assert stamp is not None
    assert stamp.words == "Wirecutter, revision C, 2026-11-22, by J. Smith"
