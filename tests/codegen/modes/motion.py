"""Modes of the group Motion (without paths and tables)."""

from __future__ import annotations

from codegen.instructions import (
    AbortMotion,
    BeginMotion,
    DisableGearing,
    ElectronicGearing,
    Home,
    IncrementalPosition,
    MotionParameters,
    MotorDisable,
    SingleAxisMove,
    StopMotion,
    Wait,
)
from codegen.instructions.following import Aborted, Master
from codegen.instructions.motion import Beginning, Direction, Homing, MoveMode, WaitFor, Which
from device.simulator.plant import Place, Plant
from tests.codegen.modes.bench import Mode, Seen, code
from tests.codegen.modes.oracles import (
    at_once,
    became,
    both,
    close,
    goes,
    is_at,
    profile,
    runs,
    sees,
    stands,
    took,
    top_speed,
    went,
)

PREPARED = (SingleAxisMove(distance="2", speed="2", begin=False), SingleAxisMove(axis="Z", distance="90", begin=False))
JOG = SingleAxisMove(mode=MoveMode.AT, jog_speed="2")
RUNNING = (JOG, Wait(time="300"))
ON_THE_PATH = (code("VM XY\nVS 2000\nVP 8000,0\nVE\nBGS"), Wait(time="300"))
SWITCH = {"X": Plant(home_switch=(-9000.0, -4000.0))}


def without_smoothing(seen: Seen) -> Seen:
    """The same machine making the same move with sharp corners in its speed."""
    return Seen(seen.mode, SingleAxisMove(distance="1", speed="4"))


def stop_takes(speed: float, deceleration: float) -> float:
    return speed / deceleration


SINGLE = (
    Mode(
        SingleAxisMove(distance="4", speed="8"),
        "Move X by 4 in at 8 in/s, then wait until the profile has ended",
        both(went("X", 4), goes("X", 4), took(profile(4, 8, 64, 64)), top_speed("X", 8)),
        first=(code("PA 1000;BG X;AM X"),),
        seconds=2,
    ),
    Mode(
        SingleAxisMove(axis="Y", mode=MoveMode.TO, position="-1.5", speed="6", acceleration="32", deceleration="64"),
        "Move Y to -1.5 in at 6 in/s, accelerating at 32 in/s², decelerating at 64 in/s², "
        "then wait until the profile has ended",
        both(is_at("Y", -1.5), took(profile(1.75, 6, 32, 64)), top_speed("Y", 6)),
        first=(code("PA ,500;BG Y;AM Y"),),
        seconds=2,
    ),
    Mode(
        SingleAxisMove(mode=MoveMode.AT, jog_speed="-3"),
        "Run X at -3 in/s",
        both(at_once(), runs("X"), top_speed("X", 3), sees(lambda b, a: a["_RPX"] < b["_RPX"] - 4000)),
    ),
    Mode(
        SingleAxisMove(distance="4", speed="8", wait=WaitFor.NOTHING),
        "Move X by 4 in at 8 in/s",
        both(at_once(), goes("X", 4)),
        seconds=2,
    ),
    Mode(
        SingleAxisMove(distance="1", speed="4", wait=WaitFor.POSITION, time_out="500"),
        "Move X by 1 in at 4 in/s, then wait until in position, at most 500 ms",
        both(went("X", 1), became("_TWX", 500), sees(lambda b, a: b["ENCX"] < 100 and a["ENCX"] >= 4000)),
        then=(),
        seconds=2,
    ),
    Mode(
        SingleAxisMove(distance="1", speed="4", begin=False),
        "Move X by 1 in at 4 in/s, prepared but not begun",
        both(at_once(), goes("X", 0), became("_SPX", 16000), sees(lambda b, a: a["_PRX"] == 4000 != b["_PRX"])),
    ),
    Mode(
        SingleAxisMove(distance="1", speed="4", smoothing="200"),
        "Move X by 1 in at 4 in/s, smoothing 200, then wait until the profile has ended",
        both(went("X", 1), sees(lambda b, a: a.waited - without_smoothing(a).waited > 4)),  # spread ramps take longer
        seconds=2,
    ),
    Mode(
        SingleAxisMove(distance="LEN*2", speed="4"),
        "Move X by (LEN*2) in at 4 in/s, then wait until the profile has ended",
        went("X", 3),
        first=(code("LEN=1.5"),),
        seconds=2,
    ),
)

PARAMETERS = (
    Mode(
        MotionParameters(
            speed=("2", "", "90", ""), acceleration=("32", "", "", "20.48"), deceleration=("64.512", "", "", "")
        ),
        "Set X to 2 in/s, acceleration 32 in/s², deceleration 64.512 in/s²; set Z to 90 deg/s; "
        "set the acceleration of W to 20.48 mm/s²",
        both(
            became("_SPX", 8000),
            became("_ACX", 128000),
            became("_DCX", 258048),
            became("_SPZ", 900),
            became("_ACW", 2048),
            sees(lambda b, a: a["_SPY"] == b["_SPY"] and a["_ACY"] == b["_ACY"]),
        ),
    ),
    Mode(
        IncrementalPosition(distance=("0.5", "", "", "")),
        "Shift the target of X 0.5 in",
        goes("X", 0.5),
        first=(SingleAxisMove(distance="2", speed="2", wait=WaitFor.NOTHING), Wait(time="200")),
        seconds=3,
    ),
)

BEGIN = (
    Mode(
        BeginMotion(axes="XZ"),
        "Begin motion of X and Z",
        both(at_once(), goes("X", 2), goes("Z", 90)),
        first=PREPARED,
        seconds=2,
    ),
    Mode(
        BeginMotion(which=Beginning.PATH),
        "Begin the path",
        both(at_once(), sees(lambda b, a: a["_RPX"] - b["_RPX"] == 4000)),
        first=(code("VM XY\nVS 8000\nVP 4000,0\nVE"),),
        seconds=2,
    ),
)

STOP = (
    Mode(
        StopMotion(axes="X"),
        "Stop X, then wait until it has stopped",
        both(stands("X"), took(stop_takes(2, 64)), sees(lambda b, a: b["_BGX"] == 1)),
        first=RUNNING,
    ),
    Mode(StopMotion(axes="X", wait=False), "Stop X", both(at_once(), stands("X")), first=RUNNING),
    Mode(
        StopMotion(which=Which.PATH),
        "Stop the path, then wait until it has stopped",
        both(stands("S"), sees(lambda b, a: b["_BGS"] == 1)),
        first=ON_THE_PATH,
    ),
    Mode(
        StopMotion(which=Which.MOTION),
        "Stop all motion, then wait until it has stopped",
        both(stands("XZ"), sees(lambda b, a: b["_BGX"] == 1 and a["_XQ0"] >= 0)),
        first=(*RUNNING, code("JG ,,300;BG Z")),
    ),
    Mode(
        StopMotion(which=Which.EVERYTHING),
        "Stop all motion and the program",
        both(stands("X"), sees(lambda b, a: a["_XQ0"] == -1 and b["_XQ0"] >= 0)),
        first=RUNNING,
    ),
    Mode(
        AbortMotion(what=Aborted.MOTION),
        "Abort motion only",
        # no ramp: the commanded position stands at once, the program goes on
        both(at_once(), stands("X"), sees(lambda b, a: a["_RPX"] == a.at("X") and a["_XQ0"] >= 0 and b["_BGX"] == 1)),
        first=RUNNING,
    ),
    Mode(
        AbortMotion(what=Aborted.EVERYTHING),
        "Abort motion and program",
        both(stands("X"), sees(lambda b, a: a["_XQ0"] == -1 and a["_SCX"] == 7 and b["_BGX"] == 1)),
        first=(MotorDisable(axes=("off", "", "", "")), *RUNNING),
    ),
)


def follows(letter: str, leader: str, ratio: float, within: float = 40.0) -> object:
    def holds(before: Seen, after: Seen, setup: object) -> bool:
        way = after[f"_RP{letter}"] - before[f"_RP{letter}"]
        return abs(after[leader]) > 1000 and close(way, ratio * after[leader], within)

    return holds


GEARING = (
    Mode(
        ElectronicGearing(ratio=("", "1.5", "", "")),
        "Gear to the encoder of X: Y 1.5",
        follows("Y", "_TPX", 1.5),  # type: ignore[arg-type]
        then=(SingleAxisMove(distance="1", speed="4"),),
        seconds=1.5,
    ),
    Mode(
        ElectronicGearing(master=Master.COMMANDED, ratio=("", "-0.5", "", "")),
        "Gear to the commanded position of X: Y -0.5",
        follows("Y", "_RPX", -0.5, 2),  # type: ignore[arg-type]
        then=(SingleAxisMove(distance="1", speed="4"),),
        seconds=1.5,
    ),
    Mode(
        ElectronicGearing(master=Master.AUXILIARY, axis="X", ratio=("", "", "2", "")),
        "Gear to the auxiliary encoder of X: Z 2",
        follows("Z", "_TDX", 2, 3),  # type: ignore[arg-type]
        world=((0.2, "aux_x", 3000.0),),
        plants={"X": Plant(auxiliary=Place.EXTERNAL)},
    ),
    Mode(
        ElectronicGearing(master=Master.PATH, ratio=("", "", "", "0.25")),
        "Gear to the path: W 0.25",
        sees(lambda b, a: close(a["_RPW"] - b["_RPW"], 0.25 * 5000, 2)),  # 3-4-5: the path is 5000 counts long
        then=(code("VM XY\nVS 8000\nVP 3000,4000\nVE\nBGS\nAMS"),),
        seconds=2,
    ),
    Mode(
        DisableGearing(axes="Y"),
        "Let Y no longer follow",
        both(goes("X", 0), sees(lambda b, a: a["_GRY"] == 0 and b["_GRY"] == 1 and b["_RPY"] != a["_RPY"] == 0)),
        first=(code("GA CX;GR ,1"),),
        then=(SingleAxisMove(distance="1", speed="4"),),
        seconds=1.5,
    ),
)

HOMING = (
    Mode(
        Home(speed=("2", "", "", ""), deceleration=("64", "", "", "")),
        "Find home of X (X at 2 in/s, decelerating at 64 in/s²), then wait until it has ended",
        both(stands("X"), is_at("X", 0), sees(lambda b, a: a["_SCX"] == 10 and a.waited > 1024)),
        plants=SWITCH,
        seconds=40,
        every=100,
    ),
    Mode(
        Home(routine=Homing.EDGE, speed=("2", "", "", "")),
        "Find the edge of the home switch of X (X at 2 in/s), then wait until it has ended",
        # stops behind the edge and sets no zero
        both(stands("X"), sees(lambda b, a: a["_SCX"] == 9 and a["_RPX"] < -3900)),
        plants=SWITCH,
        seconds=5,
    ),
    Mode(
        Home(routine=Homing.INDEX, speed=("0.1", "", "", ""), direction=Direction.REVERSE),
        "Find the index of X going backward (X at 0.1 in/s), then wait until it has ended",
        both(stands("X"), is_at("X", 0), sees(lambda b, a: a["_SCX"] == 10 and min(a.speeds("X")) < -300)),
        first=(code("DP 1500"),),
        seconds=15,
        every=50,
    ),
    Mode(
        Home(routine=Homing.INDEX, speed=("0.1", "", "", ""), wait=False),
        "Find the index of X going forward (X at 0.1 in/s)",
        both(at_once(), runs("X"), sees(lambda b, a: max(a.speeds("X")) > 300)),
    ),
    Mode(
        Home(speed=("2", "", "", ""), begin=False),
        "Find home of X (X at 2 in/s), prepared but not begun",
        both(at_once(), stands("X"), goes("X", 0), became("_SPX", 8000)),
        plants=SWITCH,
    ),
)

MODES = (*SINGLE, *PARAMETERS, *BEGIN, *STOP, *GEARING, *HOMING)
