"""Three real programs: built from dialogs by mouse or keys, saved, opened again, downloaded, run, and measured.

The first of them, the wire cutter, is in `test_main_job.py`. Here are a table that mills a rounded rectangle with its
tool turned along the path, and a press whose strip is fed by a cam, with an interrupt, limits, faults and a question.
Geometry is worked out here; the controller is simulated in virtual time, every byte on its line is real.
"""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

import resources
from codegen import files
from codegen.document import Document
from codegen.generate import generate
from tests.app.by_dialogs import build, same, set_up
from tests.app.hands import Hands, Keys, Mouse, until
from tests.app.test_main_job import name_file
from tests.long import is_long
from tests.stage import Stage

WAYS = [Mouse, Keys]
pytestmark = pytest.mark.paced
MS = 1000  # ticks of a sample at TM 1000


def ways_for(everyday: type[Hands]) -> list[type[Hands]]:
    """One way in the everyday run, both in the long one."""
    return WAYS if is_long() else [everyday]


def built(stage: Stage, way: type[Hands], name: str, folder: Path) -> Document:
    """The program built in an empty document, saved, opened again; it is the one that is shipped."""
    wanted = files.load(resources.path(f"examples/{name}.tlp"))
    studio = stage.studio
    hands = way(studio)
    hands.act("new")
    set_up(hands, wanted.setup)
    build(hands, wanted.program)
    assert studio.session.listing.text.split("\n") == generate(wanted).text.split("\n")
    assert same(studio.session.document.program, wanted.program)
    path = folder / f"{name}.tlp"
    hands.act("save")
    name_file(hands, path)
    until(lambda: path.is_file() and not studio.session.dirty, "the file to be saved")
    document = studio.session.document
    hands.act("new")
    assert not studio.session.document.program.main
    hands.act("open")
    name_file(hands, path)
    until(lambda: studio.session.path == path, "the program to be opened again")
    assert studio.session.document == document
    return document


def machine(stage: Stage, document: Document) -> Any:
    """A simulated controller of the model with the program downloaded and verified."""
    stage.connect("simulator", document.setup.model)
    rig = stage.download()
    return rig.simulation


# ------------------------------------------------------------------ the cutting table

LEFT, BOTTOM, RIGHT, TOP, RADIUS = 10.0, 10.0, 110.0, 70.0, 10.0  # mm
COUNTS = 200  # a mm; the tool's axis has 10 a degree
TOLERANCE = 1.5  # counts


def off_the_rectangle(x: float, y: float) -> float:
    """Distance of a place from the rounded rectangle, in mm; negative inside."""
    across = abs(x - (LEFT + RIGHT) / 2) - ((RIGHT - LEFT) / 2 - RADIUS)
    along = abs(y - (BOTTOM + TOP) / 2) - ((TOP - BOTTOM) / 2 - RADIUS)
    return math.hypot(max(across, 0), max(along, 0)) + min(max(across, along), 0) - RADIUS


def heading(x: float, y: float) -> float:
    """The direction of the rectangle's edge near a place, counter-clockwise round it, in degrees."""
    centre_x = min(max(x, LEFT + RADIUS), RIGHT - RADIUS)
    centre_y = min(max(y, BOTTOM + RADIUS), TOP - RADIUS)
    return math.degrees(math.atan2(y - centre_y, x - centre_x)) + 90


@pytest.mark.parametrize("way", ways_for(Mouse), ids=lambda each: each.__name__)
def test_a_table_mills_a_rounded_rectangle(way: type[Hands], stage: Stage, tmp_path: Path) -> None:
    document = built(stage, way, "knife-table", tmp_path)
    simulation = machine(stage, document)
    way(stage.studio).act("execute")
    stage.until(lambda: simulation.state()["threads"][0]["running"])
    places: list[tuple[float, float, float]] = []
    switched: list[tuple[bool, float, float]] = []
    down = False
    for _ in range(6000):
        simulation.advance(MS)
        motion = simulation.unit.motion
        x, y, z = (motion.reference(axis) for axis in range(3))
        on = bool(simulation.state()["outputs"] & 1)
        if on != down:
            down = on
            switched.append((on, x, y))
        if on and motion.path.moving:
            places.append((x, y, z))
        if len(switched) == 2:
            break
    assert simulation.errors == []
    # The tool goes down and up at the first corner's beginning, where the path starts and ends.
    start = ((LEFT + RADIUS) * COUNTS, BOTTOM * COUNTS)
    assert [on for on, _, _ in switched] == [True, False]
    for _, x, y in switched:
        assert math.hypot(x - start[0], y - start[1]) <= TOLERANCE
    assert len(places) > 1000
    assert max(abs(off_the_rectangle(x / COUNTS, y / COUNTS)) for x, y, _ in places) * COUNTS <= TOLERANCE
    for x, y, z in places:  # the tool points along the edge; 1.5 counts on the radius of 2000 are 0.05 degrees
        off = (z / 10 - heading(x / COUNTS, y / COUNTS) + 180) % 360 - 180
        assert abs(off) <= 0.2
    length = 2 * (RIGHT - LEFT + TOP - BOTTOM) - 8 * RADIUS + 2 * math.pi * RADIUS
    gone = sum(math.dist(first[:2], second[:2]) for first, second in pairwise(places))
    assert gone / COUNTS == pytest.approx(length, abs=1)


# ----------------------------------------------------------------------- the press

CYCLE, FEED = 3600, 2000  # counts: a turn of the press, 50 mm of strip
TABLE = [
    0,
    0,
    200,
    600,
    1000,
    1400,
    1800,
    2000,
    2000,
]  # 0 0 5 15 25 35 45 50 50 mm at 40 counts, every 450 of the press


def cam(master: float) -> float:
    """Where the strip belongs at a place of the press."""
    step = CYCLE / (len(TABLE) - 1)
    row = min(int(master // step), len(TABLE) - 2)
    return TABLE[row] + (TABLE[row + 1] - TABLE[row]) * (master - row * step) / step


def answer(stage: Stage, text: str) -> None:
    """The operator answers the question that is open."""
    stage.until(lambda: stage.controller.pending_prompt is not None)
    stage.controller.answer(text)


@pytest.mark.parametrize("way", ways_for(Keys), ids=lambda each: each.__name__)
def test_a_cam_feeds_a_press(way: type[Hands], stage: Stage, tmp_path: Path) -> None:
    document = built(stage, way, "press-feeder", tmp_path)
    simulation = machine(stage, document)
    hands = way(stage.studio)
    hands.act("execute")
    answer(stage, "3")
    motion = simulation.unit.motion
    stage.until(lambda: motion.moving(0))
    fed, before, strokes, on, led = 0.0, motion.reference(1), [], False, 0.0
    for _ in range(5 * 512):  # three turns take 1.6 s
        simulation.advance(MS)
        state = simulation.state()
        master, slave = float(state["axes"]["X"]["actual"]), motion.reference(1)
        if motion.moving(0) and led <= master:  # the strip follows the encoder of the press, read once a sample
            assert cam(led % CYCLE) - 1.5 <= slave <= cam(master % CYCLE) + 1.5, (led, master, slave)
        led = master
        fed += slave - before if abs(slave - before) < FEED / 2 else slave - before + FEED
        before = slave
        if bool(state["outputs"] & 1) != on:
            on = not on
            strokes += [master % CYCLE] if on else []
    assert simulation.errors == []
    # The press strikes at half a turn, 180 degrees of 10 counts; one sample later at 7200 counts/s are 7 counts.
    assert len(strokes) == 3 and all(1800 <= place <= 1800 + 30 for place in strokes)
    assert fed == pytest.approx(3 * FEED, abs=2)
    assert any("DONE" in text and "0003" in text for _, _, text in simulation.messages)
    the_guard_stops_it(stage, simulation)
    a_limit_ends_it(stage, simulation)
    a_jam_ends_it(stage, simulation)


def the_guard_stops_it(stage: Stage, simulation: Any) -> None:
    """Input 2 low: the interrupt routine stops the press, and lets it go on when the guard is closed."""
    motion = simulation.unit.motion
    answer(stage, "2")
    stage.until(lambda: motion.moving(0))
    stage.go(5)
    simulation.stimulus("in2", 0)
    stage.until(lambda: not motion.moving(0), 2)
    rest = motion.reference(0)
    stage.go(10)
    assert motion.reference(0) == rest
    simulation.stimulus("in2", 1)
    stage.until(lambda: motion.moving(0), 2)
    stage.until(lambda: stage.controller.pending_prompt is not None)
    assert any("DONE" in text and "0002" in text for _, _, text in simulation.messages)


def a_limit_ends_it(stage: Stage, simulation: Any) -> None:
    """The limit switch of the press: the limit routine tells it and stops everything."""
    motion = simulation.unit.motion
    answer(stage, "5")
    stage.until(lambda: motion.moving(0))
    simulation.stimulus("fls_x", 0)
    stage.until(lambda: any("LIMIT SWITCH" in text for _, _, text in simulation.messages), 2)
    stage.until(lambda: not motion.moving(0), 2)
    simulation.stimulus("fls_x", 1)


def a_jam_ends_it(stage: Stage, simulation: Any) -> None:
    """Started again, and the strip is held: its following error passes 5 mm, the error routine tells it and aborts."""
    stage.studio.run.halt()
    stage.until(lambda: not simulation.state()["threads"][0]["running"], 2)
    stage.studio.run.execute()
    stage.until(lambda: simulation.state()["threads"][0]["running"], 2)
    answer(stage, "5")
    stage.until(lambda: simulation.unit.motion.moving(0))
    simulation.stimulus("position_y", 400)
    stage.until(lambda: any("STRIP JAMMED" in text for _, _, text in simulation.messages), 2)
    stage.until(lambda: not simulation.state()["threads"][0]["running"], 2)
    assert simulation.errors == []
