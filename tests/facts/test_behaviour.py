"""What the manuals state about time, memory, programs and answers holds on the simulator."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.examples.script import Example, Player, read_examples

HERE = Path(__file__).parent
STATEMENTS = [each for name in ("behaviour", "motion", "program") for each in read_examples(HERE / f"{name}.txt")]


@pytest.mark.parametrize("statement", STATEMENTS, ids=str)
def test_statement_of_the_manuals(statement: Example) -> None:
    player = Player(statement)
    player.play()
    assert player.place, "nothing was done"


def test_there_are_statements_of_both_manuals() -> None:
    assert sum("ssc-tol" in each.lines for each in STATEMENTS) >= 12
    assert sum("dmc-14" in each.lines for each in STATEMENTS) >= 10
