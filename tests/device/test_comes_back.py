"""A machine that was lost and answers again: reading goes on, nothing else does (safety.md, 2)."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest

from device import jog
from device.api import Kind, State
from device.door import only_reads
from device.proof import bare
from tests.device.bench import Bench

RAMP = 102_400
STOPS = re.compile(r"(\x11\x1b\\)?((ST|AB|HX)( [XYZWS]+)?;?)*")  # these may leave at any time
WORK: dict[str, Callable[[Bench], object]] = {
    "held": lambda bench: bench.controller.motion.hold("X", 20_000, RAMP, RAMP, owner="mouse"),
    "latched": lambda bench: bench.controller.motion.run("X", 20_000, RAMP, RAMP, owner="panel"),
    "driven": lambda bench: bench.controller.motion.drive({"X": 9000}, {"X": RAMP}, {"X": RAMP}, owner="stick"),
    "a move": lambda bench: bench.controller.motion.go(jog.by("X", 90_000, 20_000, RAMP, RAMP), owner="panel"),
    "a download": lambda bench: bench.controller.download("#A\n" + "NO\n" * 200 + "EN"),
    "a question typed": lambda bench: bench.controller.ask("TPX"),
}


@pytest.mark.parametrize("work", WORK)
def test_after_a_reconnect_reading_resumes_and_nothing_else(work: str) -> None:
    bench = Bench("ssc2", kind=Kind.MACHINE).ready()
    controller = bench.controller
    controller.watch("test", ["position.x"])
    controller.take_control()
    bench.ask("SH")
    controller.motion.set_latch(True)
    WORK[work](bench)
    for _ in range(6):  # a hand that does not know
        bench.run(0.05)
        controller.motion.renew("mouse")
        controller.motion.renew("stick")
    bench.loopback.unplugged = True
    for _ in range(80):
        bench.run(0.05)
        controller.motion.renew("mouse")
        controller.motion.renew("stick")
    assert controller.state is State.LOST
    bench.sent.clear()
    lost = bench.loopback.clock()
    bench.loopback.unplugged = False
    bench.run_until(lambda: controller.state is State.READY, 30.0)
    for _ in range(40):
        bench.run(0.05)
        controller.motion.renew("mouse")
        controller.motion.renew("stick")
    assert controller.last().time("position.x") > lost
    assert not controller.control and not controller.motion.latch and not controller.motion.busy
    assert bench.still()
    lines = [bare(line) for line in bytes(bench.sent).decode("ascii").replace("\x12\x16", "").split("\r")]
    assert [line for line in lines if not only_reads(f"{line}\r".encode()) and not STOPS.fullmatch(line)] == []
