"""Program and setup files: readable, exact, safe to save, one sentence for every bad one."""

from __future__ import annotations

import dataclasses as dc
import json
import os
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen import files
from codegen.disk import FileUnreadable
from codegen.document import Document
from codegen.fields import fields_of
from codegen.instructions import ALL, SingleAxisMove, Wait
from codegen.program import Program, Step
from codegen.setup import Axis, Setup
from resources import path
from tests.codegen.strategies import SETUP, programs

DOCUMENT = Document(
    Program("CUTTER", "cuts", main=(Step("s1", Wait(time="20"), note="a note"),)),
    SETUP,
    "t,signal\n0,in1",
    "two\nlines",
)
TEXT = files.dumps(DOCUMENT)
EXAMPLES = sorted(Path(path("examples")).glob("*.tlp"))


@given(programs(), st.text(max_size=40), st.text(max_size=40))
def test_round_trip(program: Program, stimulus: str, notes: str) -> None:
    document = Document(program, SETUP, stimulus, notes)
    text = files.dumps(document)
    assert files.loads(text) == document
    assert files.dumps(files.loads(text)) == text


@given(programs())
def test_clipboard(program: Program) -> None:
    assert files.steps_from_text(files.steps_to_text(program.main)) == program.main


def test_other_text_on_the_clipboard_is_nothing() -> None:
    assert files.steps_from_text("PR 1000") == () == files.steps_from_text(TEXT)


def test_a_step_is_a_line() -> None:
    """Files compare line by line: a changed value changes one line."""
    moved = dc.replace(DOCUMENT, program=Program("CUTTER", "cuts", main=(Step("s1", Wait(time="25"), note="a note"),)))
    old, new = TEXT.splitlines(), files.dumps(moved).splitlines()
    assert [line for line in old if line not in new] == [
        '    {"id": "s1", "do": "Wait", "time": "20", "exactly": false, "note": "a note"}'
    ]
    assert len(old) == len(new)


def test_save_and_load(tmp_path: Path) -> None:
    where = tmp_path / "a.tlp"
    files.save(where, DOCUMENT)
    assert files.load(where) == DOCUMENT
    files.save_setup(tmp_path / "a.tls", SETUP)
    assert files.load_setup(tmp_path / "a.tls") == SETUP
    assert sorted(os.listdir(tmp_path)) == ["a.tlp", "a.tls"]


def test_a_failed_save_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    where = tmp_path / "a.tlp"
    files.save(where, DOCUMENT)

    def broken(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", broken)
    with pytest.raises(OSError, match="No space"):
        files.save(where, dc.replace(DOCUMENT, notes="new"))
    assert files.load(where) == DOCUMENT
    assert os.listdir(tmp_path) == ["a.tlp"]


@pytest.mark.skipif(os.name != "posix", reason="permissions and links of this kind are of POSIX systems")
def test_save_keeps_permissions_and_links(tmp_path: Path) -> None:
    real, link = tmp_path / "real.tlp", tmp_path / "link.tlp"
    files.save(real, DOCUMENT)
    real.chmod(0o640)
    link.symlink_to(real)
    files.save(link, dc.replace(DOCUMENT, notes="new"))
    assert link.is_symlink() and real.stat().st_mode & 0o777 == 0o640
    assert files.load(real).notes == "new"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "not a program file (line 1: Expecting value)"),
        ("hello", "not a program file (line 1: Expecting value)"),
        ("[]", 'not a program file (it has no "format": "twoletter program")'),
        ('{"format": "twoletter setup", "version": 1}', 'not a program file (it has no "format": "twoletter program")'),
        ('{"format": "twoletter program"}', "not a program file (its version is missing)"),
        (
            TEXT.replace('"version": 1', '"version": 99'),
            "this program file was written by a newer Twoletter Studio (version 99 of the format)",
        ),
        (
            TEXT.replace('"do": "Wait"', '"do": "Dance"'),
            "not a program file (line 8: step s1 has the unknown instruction 'Dance')",
        ),
        (
            TEXT.replace('"time": "20"', '"thyme": "20"'),
            "not a program file (line 8: step s1 has the unknown value 'thyme')",
        ),
        (TEXT.replace('"time": "20"', '"time": 20'), "not a program file (line 8: step s1: time is not text)"),
        (
            TEXT.replace('"exactly": false', '"exactly": 1'),
            "not a program file (line 8: step s1: exactly is neither true nor false)",
        ),
        (TEXT.replace('"main": [', '"main": [,'), "not a program file (line 7: Expecting value)"),
        (TEXT.replace('"cuts"', "NaN"), "not a program file (line 5: NaN is no value)"),
        (TEXT.replace('"ssc4"', '"ssc9"'), "not a program file (line 12: there is no controller model 'ssc9')"),
        (TEXT[:150], "not a program file (line 8: Unterminated string starting at)"),
        ("[" * 100000, "not a program file (it is nested too deeply)"),
    ],
)
def test_one_sentence_for_bad_files(text: str, message: str) -> None:
    with pytest.raises(FileUnreadable) as caught:
        files.loads(text)
    assert str(caught.value) == message


def test_two_steps_with_one_id() -> None:
    twice = json.loads(TEXT)
    twice["main"] *= 2
    with pytest.raises(FileUnreadable, match="two steps have the id s1"):
        files.loads(json.dumps(twice))


@given(st.binary(max_size=200))
def test_any_bytes_are_refused_in_one_sentence(tmp_path_factory: pytest.TempPathFactory, data: bytes) -> None:
    where = tmp_path_factory.mktemp("bytes") / "x.tlp"
    where.write_bytes(data)
    with pytest.raises(FileUnreadable) as caught:
        files.load(where)
    assert "\n" not in str(caught.value)


JSON = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(-5, 5), st.text(max_size=5)),
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=5), inner, max_size=3)),
    max_leaves=8,
)


@given(st.data())
def test_any_wrong_value_is_refused_in_one_sentence(data: st.DataObject) -> None:
    """Any part of a good file replaced by anything: it opens, or one sentence says why not."""
    tree = json.loads(TEXT)
    node: Any = tree
    while True:
        key = data.draw(st.sampled_from(list(node) if isinstance(node, dict) else list(range(len(node)))))
        if isinstance(node[key], dict | list) and node[key] and data.draw(st.booleans()):
            node = node[key]
            continue
        node[key] = data.draw(JSON)
        break
    try:
        document = files.loads(json.dumps(tree))
    except FileUnreadable as refused:
        assert "\n" not in str(refused)
    else:
        assert files.loads(files.dumps(document)) == document


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(FileUnreadable, match=r"^missing\.tlp cannot be read: "):
        files.load(tmp_path / "missing.tlp")
    with pytest.raises(FileUnreadable, match="cannot be read"):
        files.load(tmp_path)


def test_a_byte_order_mark_and_other_line_ends_are_harmless(tmp_path: Path) -> None:
    where = tmp_path / "x.tlp"
    where.write_bytes(("\ufeff" + TEXT.replace("\n", "\r\n")).encode())
    assert files.load(where) == DOCUMENT


def test_renamed_values_open_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Wait, "renamed", {"duration": "time"})
    assert files.loads(TEXT.replace('"time": "20"', '"duration": "20"')) == DOCUMENT
    monkeypatch.setitem(files.CLASSES, "Pause", Wait)
    assert files.loads(TEXT.replace('"do": "Wait"', '"do": "Pause"')) == DOCUMENT


def test_defaults_never_change(approve: bool) -> None:
    """Files leave out what a new instruction holds, so a default is part of the format."""
    lines = [
        f"{kind.__name__}.{name} = {field.default!s}"
        for kind in (*ALL, Axis, Setup)
        for name, field in ((field.name, field) for field in dc.fields(kind))
        if name in fields_of(kind)
    ]
    golden = Path(__file__).parent.parent / "golden" / "defaults.txt"
    text = "\n".join(lines) + "\n"
    if approve:
        golden.write_text(text, encoding="utf-8")
    assert text == golden.read_text(encoding="utf-8")


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda each: each.stem)
def test_examples_are_as_the_program_saves_them(example: Path) -> None:
    assert files.dumps(files.load(example)) == example.read_text(encoding="utf-8")


def test_hidden_values_are_kept() -> None:
    """What was typed in a mode that is hidden now is not lost."""
    move = SingleAxisMove(distance="4", position="7")
    document = Document(Program(main=(Step("s1", move),)))
    assert files.loads(files.dumps(document)).program.main[0].instruction == move
