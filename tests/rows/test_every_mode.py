"""Every instruction in every mode: its sentence, its code, and the simulated effect the sentence promises."""

from __future__ import annotations

import pytest

from codegen.models import model
from codegen.read import problems, sentence
from codegen.twoletter.check import check
from tests.codegen.modes import MODES
from tests.codegen.modes.bench import Mode, Seen

EVERY = pytest.mark.parametrize("mode", MODES, ids=lambda mode: mode.name)


@EVERY
def test_the_sentence_says_it(mode: Mode) -> None:
    assert [each.message for each in problems(mode.does, mode.setup) if each.severity == "error"] == []
    assert sentence(mode.does, mode.setup) == mode.says


@EVERY
def test_the_machine_does_what_the_sentence_says(mode: Mode) -> None:
    """The oracle compares a run without the instruction with one that has it."""
    before, after = Seen(mode, None), Seen(mode, mode.does)
    assert after.errors == []
    assert mode.holds(before, after, mode.setup), (before.known, after.known, after.listing.text)
    errors = [each for each in check(after.listing.text, model(mode.setup.model)) if each.severity == "error"]
    assert errors == []
