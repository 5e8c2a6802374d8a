"""Plays every transcript of this folder: what is typed, and byte for byte what comes back.

model NAME             the controller (first line)
plant KEY=VALUE …      what hangs on axis x
> text                 typed at port 1, with Return; \\r \\n \\x.. are escapes, a final \\ leaves Return out
< text                 what must have come back by then, all of it (escapes as above)
set SIGNAL VALUE       something happens outside
wait MS                time passes, true milliseconds
# …                    comment
"""

from __future__ import annotations

from pathlib import Path

import pytest

from device.simulator.plant import Plant
from tests.device.simulator.bench import Bench

FOLDER = Path(__file__).parent
SETTLING_MS = 20


def plain(text: str) -> str:
    """A text with its escapes carried out."""
    return text.encode("latin-1").decode("unicode_escape")


class Player:
    """One transcript under way."""

    def __init__(self) -> None:
        self.model = "ssc4"
        self.plants: dict[str, Plant] = {}
        self.bench: Bench | None = None
        self.received = ""

    def there(self) -> Bench:
        if self.bench is None:
            self.bench = Bench(self.model, plants=self.plants)
        return self.bench

    def line(self, number: int, text: str) -> None:
        word, _, rest = text.partition(" ")
        if word == "model":
            self.model = rest
        elif word == "plant":
            values = dict(pair.split("=") for pair in rest.split())
            self.plants["X"] = Plant(**{key: float(value) for key, value in values.items()})
        elif word == ">":
            typed = rest.removesuffix("\\") if rest.endswith("\\") else rest + "\\r"
            self.received += self.there().type(plain(typed), SETTLING_MS)
        elif word == "<":
            assert self.received == plain(rest), f"line {number}"
            self.received = ""
        elif word == "set":
            signal, value = rest.split()
            self.there().simulation.stimulus(signal, float(value))
        elif word == "wait":
            self.received += self.there().wait(float(rest))
        else:
            assert word in ("#", ""), f"line {number}: {text}"


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.txt")), ids=lambda path: path.stem)
def test_transcript(path: Path) -> None:
    player = Player()
    for number, text in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        player.line(number, text)
    assert player.received == "", "more came back than the transcript says"
    assert player.bench is not None
