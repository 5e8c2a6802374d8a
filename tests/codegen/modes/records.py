"""Modes of Record Data."""

from __future__ import annotations

import itertools

from codegen.instructions import (
    RecordData,
    SingleAxisMove,
    Wait,
)
from codegen.instructions.motion import MoveMode
from codegen.instructions.records import Interval, Recording, Source
from device.simulator.plant import Place, Plant
from tests.codegen.modes.bench import Mode, code
from tests.codegen.modes.oracles import close, sees

RUN = SingleAxisMove(mode=MoveMode.AT, jog_speed="1")


def recorded(source: Source, check: object, says: str, **more: object) -> Mode:
    """Ten values of one source, every 4 samples, while X and port and inputs have something to show."""
    axis = "X"
    return Mode(
        RecordData(recordings=(Recording(array="REC", size="10", source=source, axis=axis),), interval=Interval.MS4),
        f"Record {says} in REC every 4 samples",
        sees(lambda b, a: check([a[f"REC[{number}]"] for number in range(10)])),  # type: ignore[operator]
        first=(RUN, Wait(time="300"), code("SB 1\nSB 3")),
        **more,  # type: ignore[arg-type]
    )


def rising(values: list[float]) -> bool:
    """1 in/s: 4000 counts/s, 15.6 counts in 4 samples."""
    return all(10 < after - before < 22 for before, after in itertools.pairwise(values))


RECORDS = (
    recorded(Source.POSITION, rising, "position of X"),
    recorded(Source.COMMANDED, rising, "commanded position of X"),
    recorded(Source.ERROR, lambda values: all(abs(each) < 200 for each in values), "following error of X"),
    recorded(
        Source.AUXILIARY,
        lambda values: all(each == 700 for each in values),
        "auxiliary encoder of X",
        plants={"X": Plant(auxiliary=Place.EXTERNAL)},
        world=((0.1, "aux_x", 700.0),),
    ),
    recorded(Source.LATCH, lambda values: all(each == 0 for each in values), "latched position of X"),
    recorded(Source.TORQUE, lambda values: all(abs(each) <= 32767 for each in values), "motor command of X"),
    recorded(Source.SWITCHES, lambda values: all(int(each) & 12 == 12 for each in values), "switches of X"),
    recorded(Source.STOP, lambda values: all(each == 0 for each in values), "stop code of X"),
    recorded(Source.STATUS, lambda values: all(int(each) & 1 << 15 for each in values), "status bits of X"),
    recorded(
        Source.INPUTS, lambda values: all(each == 0b11111101 for each in values), "inputs", world=((0.1, "in2", 0),)
    ),
    recorded(Source.OUTPUTS, lambda values: all(each == 5 for each in values), "outputs"),
    *(
        Mode(
            RecordData(recordings=(Recording(array="REC", size="20"),), interval=interval, count="3"),
            f"Record position of X in REC every {2 ** int(interval)} samples, 3 times",
            # the way between two values is the speed times the interval
            sees(
                lambda b, a, n=2 ** int(interval): (
                    close(a["REC[2]"] - a["REC[1]"], 4000 * n / 1024, 8)  # type: ignore[misc]
                    and a["REC[3]"] == 0
                    and a["_RC"] == 0
                )
            ),
            first=(RUN, Wait(time="400")),
            seconds=1 + 2 ** int(interval) / 256,
        )
        for interval in Interval
    ),
    Mode(
        RecordData(recordings=(Recording(array="REC", size="20"),), endless=True),
        "Record position of X in REC every 2 samples, over and over",
        sees(lambda b, a: a["_RC"] == 1 and a["REC[0]"] > 3000),
        first=(RUN, Wait(time="300")),
    ),
)

MODES = (*RECORDS,)
