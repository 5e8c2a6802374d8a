"""Modes of the waits of the group Program Flow."""

from __future__ import annotations

from codegen.instructions import (
    SingleAxisMove,
    Wait,
    WaitForCondition,
)
from codegen.instructions.flow import InputLevel
from codegen.instructions.motion import WaitFor
from codegen.instructions.waits import Clock, Finished, Moving, Place, WaitKind
from tests.codegen.modes.bench import Mode, code
from tests.codegen.modes.oracles import at_once, both, close, profile, sees, stands, took


def position(place: Place, units: str) -> WaitForCondition:
    along = {"distance": units} if place in (Place.START, Place.LAST) else {"position": units}
    return WaitForCondition(kind=WaitKind.POSITION, place=place, **along)


MOVING = SingleAxisMove(distance="4", speed="4", wait=WaitFor.NOTHING)
BACK = SingleAxisMove(distance="-4", speed="4", wait=WaitFor.NOTHING)
WAITS = (
    Mode(Wait(time="300"), "Wait 300 ms (300 samples = 293 ms)", took(300 / 1024)),
    Mode(
        Wait(time="300", exactly=True),
        "Wait 300 ms (307 samples = 299.8 ms)",
        took(0.3, 5),  # true seconds
    ),
    Mode(Wait(time="T*2"), "Wait (T*2) ms", took(200 / 1024), first=(code("T=100"),)),
    Mode(
        position(Place.PASSED, "2"),
        "Wait until X passes 2 in",
        sees(lambda b, a: close(a["ENCX"], 8000, 300)),
        first=(MOVING,),
        seconds=2,
    ),
    Mode(
        position(Place.FORWARD, "1"),
        "Wait until X has gone forward to 1 in",
        sees(lambda b, a: close(a["ENCX"], 4000, 300)),
        first=(MOVING,),
        seconds=2,
    ),
    Mode(
        position(Place.REVERSE, "-1"),
        "Wait until X has gone backward to -1 in",
        sees(lambda b, a: close(a["ENCX"], -4000, 300)),
        first=(BACK,),
        seconds=2,
    ),
    Mode(
        position(Place.START, "3"),
        "Wait until X has gone 3 in from the start of the move",
        sees(lambda b, a: close(a.at("X") - 1000, 12000, 120)),
        first=(code("PA 1000;BG X;AM X"), MOVING),
        seconds=2,
    ),
    Mode(
        position(Place.LAST, "0.5"),
        "Wait until X has gone 0.5 in from the last distance wait",
        sees(lambda b, a: close(a.at("X"), 4000 + 2000, 180)),
        first=(MOVING, position(Place.START, "1")),
        seconds=2,
    ),
    Mode(
        WaitForCondition(kind=WaitKind.POSITION, place=Place.PATH, path="0.75"),
        "Wait until the path has gone 0.75 in since the start or the last such wait",
        sees(lambda b, a: close((a.at("X") ** 2 + a.at("Y") ** 2) ** 0.5, 3000, 60)),
        first=(code("VM XY\nVS 4000\nVP 6000,8000\nVE\nBGS"),),
        seconds=1,
    ),
    Mode(
        WaitForCondition(kind=WaitKind.SPEED),
        "Wait until X is at speed",
        took(4 / 64),  # 4 in/s at 64 in/s²
        first=(MOVING,),
    ),
    Mode(
        WaitForCondition(kind=WaitKind.SPEED, moving=Moving.PATH),
        "Wait until the path is at speed",
        took(4000 / 16384, 30),
        first=(code("VM XY\nVS 4000\nVA 16384\nVP 6000,8000\nVE\nBGS"),),
    ),
    Mode(
        WaitForCondition(kind=WaitKind.CLOCK, clock=Clock.NOW),
        "Start the clock",
        both(at_once(), sees(lambda b, a: a["T2"] - a["T0"] < b["T2"] - b["T0"] + 260 and a["T2"] - a["T0"] > 480)),
        first=(Wait(time="300"),),
        then=(code("WT 250\nAT 500\nT2=TIME"),),
    ),
    Mode(
        WaitForCondition(kind=WaitKind.CLOCK, clock=Clock.AFTER, time="400"),
        "Wait until the clock shows 400 ms (400 samples = 390.6 ms)",
        took(300 / 1024),
        first=(WaitForCondition(kind=WaitKind.CLOCK), Wait(time="100")),
        then=(code("AT 600\nT2=TIME"),),
    ),
    Mode(
        WaitForCondition(kind=WaitKind.CLOCK, clock=Clock.AGAIN, time="400"),
        "Wait until the clock shows 400 ms, then start it again (400 samples = 390.6 ms)",
        both(took(300 / 1024), sees(lambda b, a: close(a["T2"] - a["T1"], 200, 20))),
        first=(WaitForCondition(kind=WaitKind.CLOCK), Wait(time="100")),
        then=(code("AT 200\nT2=TIME"),),
    ),
    Mode(
        WaitForCondition(),
        "Wait until the motion of X has ended",
        both(stands("X"), took(profile(4, 4, 64, 64))),
        first=(MOVING,),
        seconds=2,
    ),
    Mode(
        WaitForCondition(axes="", finished=Finished.PROFILE),
        "Wait until all motion has ended",
        took(profile(4, 4, 64, 64)),
        first=(code("PR ,,50;BG Z"), MOVING),
        seconds=2,
    ),
    Mode(
        WaitForCondition(finished=Finished.POSITION, time_out="400"),
        "Wait until the motion of X is in position, at most 400 ms",
        sees(lambda b, a: a["_TWX"] == 400 and a["ENCX"] >= 15990),
        first=(MOVING,),
        seconds=2,
    ),
    Mode(
        WaitForCondition(moving=Moving.PATH),
        "Wait until the path has ended",
        sees(lambda b, a: a.at("X") == 3000 and a.at("Y") == 4000),
        first=(code("VM XY\nVS 8000\nVP 3000,4000\nVE\nBGS"),),
        seconds=2,
    ),
    Mode(
        WaitForCondition(kind=WaitKind.INPUT, input="START", level=InputLevel.LOW),
        "Wait until input 1 (START) is low",
        took(0.5, 30),
        world=((0.5, "in1", 0),),
    ),
    Mode(
        WaitForCondition(kind=WaitKind.INPUT, input="3"),
        "Wait until input 3 is high",
        took(0.5, 30),
        world=((0, "in3", 0), (0.5, "in3", 1)),
    ),
)

MODES = (*WAITS,)
