"""Every instruction in every mode: its sentence, its code, and the simulated effect the sentence promises.

The oracles (tests/codegen/modes) are written from the sentences; they know nothing of the code that was emitted.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from codegen import files
from codegen.document import Document
from codegen.fields import Choice, Flag, ListOf, fields_of, is_shown
from codegen.generate import code
from codegen.instructions import ALL, Instruction
from codegen.models import model
from codegen.program import Program, Step
from codegen.read import problems, sentence
from codegen.twoletter.check import check
from tests.codegen.modes import MODES
from tests.codegen.modes.bench import Mode, Seen

EVERY = pytest.mark.parametrize("mode", MODES, ids=lambda mode: mode.name)
GOLDEN = Path(__file__).parent.parent / "golden" / "modes.txt"
NO_EFFECT_ALONE = {"End"}  # shown by the subroutines they end


@EVERY
def test_the_sentence_says_it(mode: Mode) -> None:
    assert [each.message for each in problems(mode.does, mode.setup) if each.severity == "error"] == []
    assert sentence(mode.does, mode.setup) == mode.says


@EVERY
def test_the_machine_does_what_the_sentence_says(mode: Mode) -> None:
    """The oracle compares a run without the instruction with one that has it."""
    before, after = Seen(mode, None), Seen(mode, mode.does)
    assert bool(after.errors) == mode.fails, after.errors
    assert mode.holds(before, after, mode.setup), (before.known, after.known, after.listing.text)
    errors = [each for each in check(after.listing.text, model(mode.setup.model)) if each.severity == "error"]
    assert errors == []


@EVERY
def test_a_file_keeps_it(mode: Mode) -> None:
    document = Document(Program("P", main=(Step("s1", mode.does),)), mode.setup)
    assert files.loads(files.dumps(document)) == document


def shown_choices(item: Any) -> Iterator[tuple[str, str, Any]]:
    """Every choice and switch of an instruction and its rows that counts, with its present value."""
    for name, field in fields_of(item).items():
        if not is_shown(item, name):
            continue
        if isinstance(field, Choice | Flag):
            yield type(item).__name__, name, getattr(item, name)
        elif isinstance(field, ListOf):
            for row in getattr(item, name):
                yield from shown_choices(row)


def wanted_choices(kind: type[Any]) -> Iterator[tuple[str, str, Any]]:
    """Every value of every choice and switch of a kind and its rows."""
    for name, field in fields_of(kind).items():
        match field:
            case Choice(kind=values):
                yield from ((kind.__name__, name, value) for value in values)
            case Flag():
                yield from ((kind.__name__, name, value) for value in (True, False))
            case ListOf(row=row):
                yield from wanted_choices(row)


def used(mode: Mode) -> Iterator[Instruction]:
    """The instructions of a mode: its own, and those that only make sense inside others."""
    yield mode.does
    yield from (each for each in mode.body if type(each).__name__ in NO_EFFECT_ALONE)


@pytest.mark.parametrize("kind", [kind for kind in ALL if not kind.needs], ids=lambda kind: kind.__name__)
def test_every_mode_is_there(kind: type[Instruction]) -> None:
    """Every instruction has a mode, and every choice of it is made in one."""
    instructions = [each for mode in MODES for each in used(mode) if type(each) is kind]
    assert instructions
    made = {choice for each in instructions for choice in shown_choices(each)}
    assert set(wanted_choices(kind)) - made == set()


def test_the_code_is_as_approved(approve: bool) -> None:
    """Sentence and code of every mode, to be read when they change."""
    text = "\n".join(f"{mode.says}\n    " + "\n    ".join(code(mode.does, mode.setup)) for mode in MODES) + "\n"
    if approve:
        GOLDEN.write_text(text, encoding="utf-8")
    assert text == GOLDEN.read_text(encoding="utf-8")
