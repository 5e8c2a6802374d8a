"""Every example of chapters 2 and 7 of dmc-1412-1414.txt runs on the simulator with the result the manual states."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.examples.script import Example, Player, read_examples

HERE = Path(__file__).parent
EXAMPLES = [example for path in sorted(HERE.glob("chapter*.txt")) for example in read_examples(path)]


@pytest.mark.parametrize("example", EXAMPLES, ids=str)
def test_example_of_the_manual(example: Example) -> None:
    player = Player(example)
    player.play()
    assert player.place, "nothing was done"


def test_the_examples_of_both_chapters_are_there() -> None:
    files = [example.file for example in EXAMPLES]
    assert files.count("chapter2.txt") >= 15 and files.count("chapter7.txt") >= 45
