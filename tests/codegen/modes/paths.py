"""Modes of paths, contours and cams: the axes really go along the lines, arcs and tables of the sentence."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

from codegen.instructions import (
    CircularPath,
    ContourMode,
    ElectronicCam,
    LinearPath,
    SingleAxisMove,
    TangentPath,
)
from codegen.instructions.contour import Every
from codegen.instructions.curves import CamPlace, CamStep
from codegen.instructions.motion import MoveMode
from codegen.instructions.path_parts import Ending, Measured, Piece, Shape, Stretch, Turn
from codegen.setup import Setup
from tests.codegen.modes.bench import MACHINE, ONE_UNIT, SAMPLES, Mode, Oracle, Seen, code
from tests.codegen.modes.oracles import at_once, both, close, goes, is_at, sees, stands, took, went


def line(x: str, y: str, speed: str = "") -> Piece:
    return Piece(to=(x, y, "", ""), speed=speed)


def places(seen: Seen, letters: str) -> list[tuple[float, ...]]:
    """Where the commanded point was, in units, look by look."""
    axes = [(seen.mode.setup.letters.index(each), float(seen.mode.setup.axis(each).scale)) for each in letters]
    return [tuple(row[place] / counts for place, counts in axes) for row in seen.track]


def on_circle(letters: str, centre: tuple[float, float], radius: float, within: float) -> Oracle:
    """While it is beyond the line, the point keeps its distance from the centre, in user units."""

    def holds(before: Seen, after: Seen, setup: Setup) -> bool:
        beyond = [each for each in places(after, letters) if each[0] > centre[0] + 0.01]
        return len(beyond) > 10 and all(close(math.dist(each, centre), radius, within) for each in beyond)

    return holds


def visits(letters: str, point: tuple[float, ...], within: float) -> Oracle:
    """The point comes by this place, in user units."""
    return lambda before, after, setup: any(math.dist(each, point) <= within for each in places(after, letters))


def path_speed(letters: str, speed: float, share: float = 0.03, top: bool = True) -> Oracle:
    """The fastest the point moves along its path, in units/s: what really is travelled, in all axes together."""

    def holds(before: Seen, after: Seen, setup: Setup) -> bool:
        seen = places(after, letters)
        speeds = [math.dist(a, b) * SAMPLES / after.mode.every for a, b in itertools.pairwise(seen)]
        return close(max(speeds), speed, share * speed)

    return holds


def length_over_speed(length: float, speed: float, ramp: float) -> float:
    """Seconds of a path: constant speed and one ramp up and down."""
    return length / speed + speed / ramp


HALF_TURN = Piece(shape=Shape.ARC, radius="1", start="-90", sweep="180")
WIRE = (line("2", "0"), HALF_TURN, line("0", "2"))
CIRCULAR = (
    Mode(
        CircularPath(speed="2", segments=WIRE),
        "Path of X and Y at 2 in/s: line to X 2 in, Y 0 in; arc of radius 1 in from -90 deg by 180 deg "
        "counter-clockwise; line to X 0 in, Y 2 in, then wait until the profile has ended",
        both(
            is_at("X", 0, 2),
            is_at("Y", 2, 2),
            on_circle("XY", (2, 1), 1, 0.002),
            path_speed("XY", 2),
            took(length_over_speed(4 + math.pi, 2, 64)),
            stands("S"),
        ),
        seconds=5,
    ),
    Mode(
        CircularPath(
            axes="XY",
            speed="2",
            acceleration="32",
            deceleration="64",
            smoothing="64",
            segments=(
                Piece(shape=Shape.ARC, radius="1", start="180", sweep="90", turn=Turn.CW, speed="1"),
                line("2", "1"),
            ),
        ),
        "Path of X and Y at 2 in/s, accelerating at 32 in/s², decelerating at 64 in/s², smoothing 64: arc of "
        "radius 1 in from 180 deg by 90 deg clockwise at 1 in/s; line to X 2 in, Y 1 in, "
        "then wait until the profile has ended",
        both(visits("XY", (1, 1), 0.02), is_at("X", 2, 2), is_at("Y", 1, 2), path_speed("XY", 2)),
        seconds=5,
    ),
    Mode(
        CircularPath(axes="XZ", speed="2", segments=(Piece(to=("1", "", "1", "")),), begin=False),
        "Path of X and Z at 2 in/s: line to X 1 in, Z 1 in, prepared but not begun",
        both(at_once(), goes("X", 0), sees(lambda b, a: a["_BGS"] == 0)),
        setup=ONE_UNIT,
    ),
    Mode(
        CircularPath(speed="2", segments=(line("1", "0"),), ending=Ending.CONTINUE),
        "Path of X and Y at 2 in/s: line to X 1 in, Y 0 in, to be continued",
        both(at_once(), goes("X", 3, 2), goes("Y", 0)),
        then=(CircularPath(continues=True, segments=(line("3", "0"),)),),
        first=(),
        seconds=4,
    ),
    Mode(
        CircularPath(continues=True, speed="1", segments=(line("3", "0"),), wait=False),
        "Continue the path of X and Y at 1 in/s: line to X 3 in, Y 0 in",
        # the first inch at 2 in/s, the next two at 1
        both(
            at_once(),
            goes("X", 3, 2),
            path_speed("XY", 2),
            sees(lambda b, a: sum(abs(v - 4000) < 200 for v in a.speeds("X")) > 150),
        ),
        first=(CircularPath(speed="2", segments=(line("1", "0"),), ending=Ending.CONTINUE),),
        seconds=5,
    ),
)


def along(before: Seen, after: Seen, setup: Setup) -> bool:
    """Z points along the arc: where the point is at angle a of the circle, the direction is a + 90°."""
    for x, y, z in places(after, "XYZ"):
        if x > 2.01:
            angle = math.degrees(math.atan2(y - 1, x - 2)) + 90
            if abs((z - angle + 180) % 360 - 180) > 0.5:
                return False
    return after["_RPX"] > 0


DEGREES = Setup(model="ssc4", axes=(ONE_UNIT.axes[0], ONE_UNIT.axes[0], MACHINE.axes[2], ONE_UNIT.axes[3]))
TANGENT = (
    Mode(
        TangentPath(turn_counts="3600", speed="1", segments=(line("2", "0"), HALF_TURN)),
        "Path of X and Y at 1 in/s, Z along its direction, turned there first: line to X 2 in, Y 0 in; arc of radius "
        "1 in from -90 deg by 180 deg counter-clockwise, then wait until the profile has ended",
        both(along, is_at("X", 2, 2), is_at("Y", 2, 2), is_at("Z", 180, 2)),
        first=(code("DP ,,450"),),
        setup=DEGREES,
        seconds=7,
    ),
    Mode(
        TangentPath(turn_counts="3600", turn_first=False, zero="90", segments=(line("0", "1"),), begin=False),
        "Path of X and Y, Z along its direction: line to X 0 in, Y 1 in, prepared but not begun",
        both(at_once(), goes("Z", 0), sees(lambda b, a: a["_TN"] == 1800)),  # 0° at 90°, the path goes at 90°
        setup=DEGREES,
    ),
    Mode(
        TangentPath(
            turn_counts="3600",
            speed="2",
            segments=(Piece(shape=Shape.ARC, radius="1", start="180", sweep="90", turn=Turn.CW),),
            ending=Ending.CONTINUE,
        ),
        "Path of X and Y at 2 in/s, Z along its direction, turned there first: arc of radius 1 in from 180 deg by "
        "90 deg clockwise, to be continued",
        both(went("Z", 90), goes("X", 2, 2), goes("Y", 1, 2), is_at("Z", 0, 2)),
        then=(TangentPath(continues=True, segments=(line("2", "1"),)),),
        setup=DEGREES,
        seconds=5,
    ),
    Mode(
        TangentPath(continues=True, segments=(line("2", "1"),), wait=False),
        "Continue the path of X and Y, Z along its direction: line to X 2 in, Y 1 in",
        both(at_once(), goes("X", 2, 2), goes("Y", 1, 2)),
        first=(TangentPath(turn_counts="3600", speed="2", segments=(line("2", "0"),), ending=Ending.CONTINUE),),
        setup=DEGREES,
        seconds=4,
    ),
)


def stretch(*to: str, speed: str = "") -> Stretch:
    x, y, z, w = (*to, "", "", "", "")[:4]
    return Stretch(to=(x, y, z, w), speed=speed)


MIXED = ONE_UNIT.with_axis("Z", MACHINE.axes[1])  # 2000 counts/in
LINEAR = (
    Mode(
        LinearPath(axes="XYZ", measured=Measured.STEPS, speed="2", segments=(stretch("1", "1", "1"), stretch("", "1"))),
        "Path of X, Y and Z at 2 in/s: by X 1 in, Y 1 in, Z 1 in; Y 1 in, then wait until the profile has ended",
        both(
            went("X", 1), went("Y", 2), went("Z", 1), path_speed("XYZ", 2), took(length_over_speed(1 + 3**0.5, 2, 64))
        ),
        setup=ONE_UNIT,
        seconds=4,
    ),
    Mode(
        LinearPath(axes="XYZ", speed="2", segments=(stretch("", "", "2"), stretch("2", "", "2"))),
        "Path of X, Y and Z at 2 in/s: to Z 2 in; X 2 in, Z 2 in, then wait until the profile has ended",
        # Z has half the counts of X: the speed along the path is that of the sentence all the same
        both(went("X", 2), went("Z", 2), path_speed("XYZ", 2), took(length_over_speed(4, 2, 64), 60)),
        setup=MIXED,
        seconds=4,
    ),
    Mode(
        LinearPath(speed="2", segments=(stretch("1"), stretch("1", "2", speed="1"))),
        "Path of X and Y at 2 in/s: to X 1 in; X 1 in, Y 2 in at 1 in/s, then wait until the profile has ended",
        both(is_at("X", 1), is_at("Y", 2), path_speed("XY", 2), visits("XY", (1, 0.05), 0.02)),
        seconds=5,
    ),
    Mode(
        LinearPath(axes="X", measured=Measured.STEPS, segments=(stretch("1"),), wait=False),
        "Path of X: by X 1 in",
        both(at_once(), goes("X", 1)),
        first=(code("VS 8000"),),
        seconds=2,
    ),
    Mode(
        LinearPath(axes="XYZW", measured=Measured.STEPS, segments=(stretch("1", "1", "1", "1"),), begin=False),
        "Path of X, Y, Z and W: by X 1 in, Y 1 in, Z 1 in, W 1 in, prepared but not begun",
        both(at_once(), goes("W", 0), sees(lambda b, a: a["_BGS"] == 0)),
        setup=ONE_UNIT,
    ),
    Mode(
        LinearPath(axes="XYZ", measured=Measured.STEPS, speed="2", segments=(stretch("1"),), ending=Ending.CONTINUE),
        "Path of X, Y and Z at 2 in/s: by X 1 in, to be continued",
        both(at_once(), goes("X", 1), goes("Z", 2)),
        then=(LinearPath(axes="XYZ", continues=True, measured=Measured.STEPS, segments=(stretch("", "", "2"),)),),
        setup=ONE_UNIT,
        seconds=4,
    ),
    Mode(
        LinearPath(continues=True, segments=(stretch("2", "2"),)),
        "Continue the path of X and Y: to X 2 in, Y 2 in, then wait until the profile has ended",
        both(went("X", 2, 2), went("Y", 2, 2)),
        first=(CircularPath(speed="2", segments=(line("1", "0"),), ending=Ending.CONTINUE),),
        seconds=4,
    ),
)


def table_followed(steps: list[float], samples: int) -> Callable[[Seen, Seen, Setup], bool]:
    """Each row takes its time: the way after every row is what the rows before it add up to."""

    def holds(before: Seen, after: Seen, setup: Setup) -> bool:
        way = [row[0] for row in after.track]
        first = next(number for number, place in enumerate(way) if place)
        begin = first - samples / (steps[0] * 4000)  # one count is that late
        total, good = 0.0, True
        for number, step in enumerate(steps, 1):
            total += step * 4000
            at = round(begin) + number * samples // after.mode.every
            good &= min(abs(place - total) for place in way[at - 1 : at + 3]) <= abs(step) * 4000 / samples * 2 + 1
        return good

    return holds


STEPS = [0.01, 0.03, 0.05, 0.03, 0.01]
CONTOUR = (
    *(
        Mode(
            ContourMode(interval=every, table="0.01\n0.03\n0.05\n0.03\n0.01"),
            f"Contour of X: 5 rows of {every.value} ms, then wait until the profile has ended",
            both(went("X", 0.13), table_followed(STEPS, int(every.value)), took(5 * int(every.value) / SAMPLES, 30)),
            every=1,
            seconds=max(0.2, int(every.value) * 0.006),
        )
        for every in Every
    ),
    Mode(
        ContourMode(axes="XY", timed=True, table="64\t0.1\t0\n\t0.1\t0.1\n128\t-0.2\t0.2", wait=False),
        "Contour of X and Y: 3 rows with intervals of their own",
        both(goes("X", 0), goes("Y", 0.3), sees(lambda b, a: max(a.speeds("X")) > 5000)),
        seconds=1,
        every=32,
    ),
)

WAVE = "0\n0.5\n2\n3.5\n4\n3.5\n2\n0.5\n0"
DEFINE = ElectronicCam(cycle="4", table=WAVE)
ENGAGE = ElectronicCam(step=CamStep.ENGAGE, places=(CamPlace(),))
TURN = SingleAxisMove(mode=MoveMode.AT, jog_speed="4")
SLAVE = [0, 0.5, 2, 3.5, 4, 3.5, 2, 0.5, 0]


def in_step(before: Seen, after: Seen, setup: Setup) -> bool:
    """Where the master is an eighth of a cycle further, the slave is at the next row of the table, straight between."""
    place = float(after["_TPX"]) / 4000 * 2
    row = min(int(place), 7)
    wanted = SLAVE[row] + (place - row) * (SLAVE[row + 1] - SLAVE[row])
    return close(after["_RPY"] / 2000, wanted, 0.01) and after["_TPX"] > 1000 and before["_RPY"] == 0


CAM = (
    Mode(
        DEFINE,
        "Cam of Y over 4 in of X: 9 rows",
        in_step,
        then=(ENGAGE, SingleAxisMove(distance="1.3", speed="2")),
        seconds=2,
    ),
    Mode(
        ElectronicCam(cycle="4", offset="1", change=("", "0", "", ""), table=WAVE, enable=False),
        "Cam of Y over 4 in of X from 1 in: 9 rows, not yet switched on",
        sees(lambda b, a: a["_EMX"] == 16000 and a["_EB"] == 0 and a["_EP"] == 2000 != b["_EP"]),
    ),
    Mode(
        ElectronicCam(step=CamStep.ENGAGE, places=(CamPlace(at="1"),)),
        "Engage Y when the master is at 1 in",
        # nothing before 1 in; then the place of the table: 2 in of Y at 1 in of X
        both(
            sees(lambda b, a: all(row[1] == 0 for row in a.track if row[0] < 3900)),
            sees(lambda b, a: a["_RPY"] > 3900 and b["_RPY"] == 0),
        ),
        first=(DEFINE,),
        then=(SingleAxisMove(distance="1.2", speed="2"),),
        seconds=2,
    ),
    Mode(
        ElectronicCam(step=CamStep.DISENGAGE, places=(CamPlace(at="1"),)),
        "Disengage Y when the master is at 1 in",
        sees(lambda b, a: close(a["_RPY"], 4000, 100) and b["_RPY"] > 5000),
        first=(DEFINE, ENGAGE),
        then=(SingleAxisMove(distance="1.8", speed="2"),),
        seconds=2,
    ),
    Mode(
        ElectronicCam(step=CamStep.EXIT),
        "End of the cam",
        sees(lambda b, a: a["_EB"] == 0 and b["_EB"] == 1 and a["_RPY"] == 0 and b["_RPY"] > 1000),
        first=(DEFINE, ENGAGE),
        then=(SingleAxisMove(distance="1", speed="2"),),
        seconds=2,
    ),
)

MODES = (*CIRCULAR, *TANGENT, *LINEAR, *CONTOUR, *CAM)
