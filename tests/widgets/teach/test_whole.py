"""From the joystick to a program: recorded, edited, played back, saved as a module, imported, run: always the same."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication

from codegen.bows import Point, distance_to_line
from device.api import Badge
from tests.long import count, record
from tests.stage import TICK_S
from tests.widgets.teach.bench import Bench

PLACES = count(3, 40)
WAIT_INPUT = 3
PARTS = 8  # of a tick, 4 ms: within a count of a stop
RAMP = 20_480  # counts/s² of 20 mm/s², in steps of 1024 (dmc-1412-1414.txt, AC)


@pytest.fixture
def bench(qapp: QApplication, tmp_path: Path) -> Iterator[Bench]:
    made = Bench(tmp_path, example="")
    yield made
    made.stage.clear_away()


class Seen:
    """What the simulated machine itself did: where its axes were commanded to be, and its outputs, tick by tick."""

    def __init__(self, bench: Bench) -> None:
        self.bench = bench
        self.places: list[tuple[int, int]] = [bench.places]
        self.switched: list[tuple[int, tuple[int, int]]] = []
        self.waited: list[tuple[int, int]] = []
        self._outputs, self._still, self._level = bench.outputs, 0, True
        self.bench.stage.rig.simulation.stimulus(f"in{WAIT_INPUT}", 1)

    def look(self) -> None:
        """One tick in parts. Whoever stands for a second waits for the input, which then changes."""
        for _ in range(PARTS):
            self.bench.stage.clock.pass_by(TICK_S / PARTS)
            place = self.bench.places
            self._still = self._still + 1 if place == self.places[-1] else 0
            self.places.append(place)
            if self.bench.outputs != self._outputs:
                self._outputs = self.bench.outputs
                self.switched.append((self._outputs, place))
        self.bench.stage.studio.tick.once()
        QApplication.processEvents()
        if self._still >= 30 * PARTS:
            self._level, self._still = not self._level, 0
            self.waited.append(place)
            self.bench.stage.rig.simulation.stimulus(f"in{WAIT_INPUT}", int(self._level))


def teach(bench: Bench) -> None:
    """Driven by the joystick, recorded by its button; a wait or an output now and then, by the windows' signals."""
    hand = random.Random(11)
    bench.connect()
    bench.fill(bench.parts.of_stick, "full", "20")
    bench.enable()
    for number in range(PLACES):
        x, y = bench.places
        way = -1 if x > 3000 else 1
        bench.push(
            way * hand.uniform(0.4, 1), hand.choice((-1, 1)) * hand.uniform(0.3, 1) if abs(y) < 3000 else -y / 4000
        )
        bench.stage.go(hand.randrange(8, 20))
        bench.push(0, 0)
        bench.stage.go(8)
        bench.still()
        rows = len(bench.rows)
        bench.press(7)
        bench.stage.until(lambda rows=rows: len(bench.rows) > rows)
        if number % 4 == 1:
            bench.panel.output_added.emit(hand.choice(("1", "-1", "0x2A", "5", "-4")))
        if number % 6 == 2:
            bench.panel.wait_added.emit(f"-{WAIT_INPUT}" if number % 12 == 2 else str(WAIT_INPUT))
    bench.press(8)
    assert not bench.panel.enabled


def path_of(bench: Bench) -> list[Point]:
    return [(float(row["x"]) * 1000, float(row["y"]) * 1000) for row in bench.rows if "x" in row]


def near(path: list[Point], places: list[tuple[int, int]]) -> float:
    """How far the machine ever was from the lines of the table, counts."""
    return max(min(distance_to_line(place, *line) for line in pairwise(path)) for place in places)


@pytest.mark.timeout(1800)
def test_a_taught_path_is_the_same_played_back_and_as_a_program(bench: Bench, tmp_path: Path) -> None:
    teach(bench)
    assert sum("x" in row for row in bench.rows) == PLACES
    for row, each in enumerate(bench.rows):
        if "x" in each:
            bench.typed(row, 2, "40")
    last = max(n for n, row in enumerate(bench.rows) if "x" in row)
    bench.typed(last, 0, "4.321")
    path = path_of(bench)
    assert path[-1][0] == 4321 and bench.panel.wrong == ()

    bench.click(bench.parts.io_control)
    bench.click(bench.parts.play)
    bench.stage.go(10)
    bench.answer("Play back?", "Play back")
    bench.stage.go(5)
    played = Seen(bench)
    while bench.panel.words() != "Played back.":
        played.look()
        assert len(played.places) < 200_000, bench.panel.words()
    start = played.places.index((round(path[0][0]), round(path[0][1])))
    assert bench.places == tuple(map(round, path[-1]))
    off = near(path, played.places[start:])

    file = tmp_path / "taught.tlp"
    bench.stage.studio.at_machine.teach.save_module(file)
    bench.stage.studio.importing.take(file)
    bench.stage.go(3)
    rig = bench.stage.download()
    assert bench.stage.controller.program_badge is Badge.SAME
    rig.type("OP 0")
    program = Seen(bench)
    bench.stage.controller.execute()
    bench.stage.until(lambda: rig.running)
    while rig.running:
        program.look()
        assert len(program.places) < 200_000
    start = program.places.index((round(path[0][0]), round(path[0][1])))
    off = max(off, near(path, program.places[start:]))
    record(
        f"a taught path of {PLACES} places, played back and run as an imported module: off its lines at most",
        "pytest tests/widgets/teach/test_whole.py", 11, off, "counts",
    )  # fmt: skip
    assert off <= 1
    closest = RAMP / 2 * (TICK_S / PARTS) ** 2 + 1  # near a stop between two looks, with the ramps of the rows
    for seen in (played, program):
        assert all(min(math.dist(place, corner) for place in seen.places) <= closest for corner in path)
        assert seen.places[-1] == tuple(map(round, path[-1]))
    assert [byte for byte, _ in program.switched] == [byte for byte, _ in played.switched]
    pairs = zip(program.switched, played.switched, strict=True)
    assert all(math.dist(here, there) <= 1 for (_, here), (_, there) in pairs)
    assert program.waited == played.waited
    assert played.switched and played.waited
