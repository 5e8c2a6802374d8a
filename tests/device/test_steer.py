"""Two axes in one hand: bounded ahead at every speed, stopped by letting go, silence, a pulled cable (safety.md, 4)."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future

import pytest

from device.api import LinkError, NotAllowed
from device.steer import Drove
from tests.device.bench import Bench

SPEED, RAMP = 20_000, 256_000
STOPPING = SPEED**2 / (2 * RAMP)
RAMPS = {"X": RAMP, "Y": RAMP}


class Hand:
    """X and Y of a simulated machine in one hand, renewed every 50 ms."""

    def __init__(self, x: float = SPEED, y: float = 0, baud: int = 19200, limits: str = "") -> None:
        self.bench = Bench("ssc2", baud).ready()
        for command in ("SH", *filter(None, [limits])):
            self.bench.ask(command)
        self.before = len(self.bench.sent)
        self.motion = self.bench.controller.motion
        self.along: tuple[str, ...] = ()
        self.future: Future[Drove] = self.motion.drive({"X": x, "Y": y}, RAMPS, RAMPS, "stick", along=("analog1",))

    def keep(self, seconds: float, each: Callable[[Hand], None] = lambda hand: None) -> Hand:
        end = self.bench.loopback.clock() + seconds
        while self.bench.loopback.clock() < end:
            self.bench.run(0.05)
            self.motion.renew("stick")
            each(self)
        return self

    def steer(self, x: float, y: float) -> Hand:
        assert self.motion.steer("stick", {"X": x, "Y": y}) == ""
        return self

    def place(self, axis: str) -> float:
        return float(self.bench.simulation.state()["axes"][axis]["commanded"])

    def moving(self, axis: str) -> bool:
        return bool(self.bench.simulation.state()["axes"][axis]["moving"])

    def ahead(self, axis: str) -> float:
        """Counts to the end of the move that the controller has."""
        return abs(float(self.bench.simulation.unit.motion.target("XY".index(axis))) - self.place(axis))

    def sp(self, axis: str) -> float:
        """What SP is, from the lines that left."""
        lines = [line.replace(";", "\r") for line in self.bench.sent.decode("ascii").split("\r")]
        found = [each for line in lines for each in line.split("\r") if each.startswith("SP ")]
        place = "XY".index(axis)
        values = [each[3:].split(",")[place] for each in found if len(each[3:].split(",")) == place + 1]
        return float(values[-1])


def test_both_axes_follow_the_hand_and_stand_when_it_lets_go() -> None:
    hand = Hand(SPEED, -SPEED / 2).keep(2.0)
    assert hand.place("X") > 1.4 * SPEED and -0.85 * SPEED < hand.place("Y") < -0.7 * SPEED
    hand.steer(0, SPEED)  # X stands, Y turns round
    hand.keep(0.4)
    assert not hand.moving("X")
    x = hand.place("X")
    hand.keep(1.5)
    assert hand.place("X") == x and hand.place("Y") > 0.2 * SPEED
    before = hand.place("Y")
    hand.motion.release("stick")
    drove = hand.bench.result(hand.future)
    assert hand.bench.still()
    assert drove.places == {"X": hand.place("X"), "Y": hand.place("Y")}
    assert hand.place("Y") - before <= SPEED * 0.15 + STOPPING
    assert drove.seconds <= 0.15 + SPEED / RAMP + 0.3
    assert [float(hand.bench.ask(f"MG {each}")) for each in ("_SPX", "_ACY", "_DCY")] == [25000, 256000, 256000]


def test_at_most_400_ms_and_the_stopping_distance_lie_ahead_of_each_axis() -> None:
    """At the speed it has now, also while the hand changes it all the time."""
    hand = Hand(SPEED, SPEED / 4)
    wanted = [(1, 0.25), (0.3, 1), (0.1, 0.6), (1, -1), (-0.5, -0.05), (-1, 1), (0.05, 0.05)]
    seen = 0

    def bounded(hand: Hand) -> None:
        nonlocal seen
        for axis in "XY":
            if hand.moving(axis):
                speed = hand.sp(axis)
                assert hand.ahead(axis) <= speed * 0.4 + speed**2 / (2 * RAMP) + speed * 0.01 + 4
                seen += 1

    for x, y in wanted:
        hand.steer(x * SPEED, y * SPEED).keep(0.8, bounded)
    assert seen > 100


def test_nobody_renewing_and_a_pulled_cable_stop_both_axes() -> None:
    for cut in (False, True):
        hand = Hand(SPEED, SPEED).keep(1.0)
        before = hand.place("X"), hand.place("Y")
        hand.bench.loopback.unplugged = cut
        hand.bench.run(2.0)
        assert hand.bench.still()
        for axis, place in zip("XY", before, strict=True):
            assert hand.place(axis) - place <= SPEED * 0.5 + STOPPING
        assert hand.future.done() and isinstance(hand.future.exception(), LinkError) == cut


def test_slowed_down_and_then_cut_off_it_ends_in_time() -> None:
    """The way that lay ahead at full speed is not crept along at the slow one."""
    hand = Hand(SPEED, 0).keep(1.0)
    hand.steer(SPEED / 50, 0).keep(0.1)
    hand.bench.loopback.unplugged = True
    hand.bench.run(0.8)
    assert hand.bench.still()


def test_it_stops_on_the_limits_of_the_controller_and_comes_back() -> None:
    hand = Hand(SPEED, SPEED, limits="FL 9000,200000").keep(2.0)
    assert hand.place("X") == 9000 and not hand.moving("X")
    assert hand.place("Y") > SPEED
    hand.steer(-SPEED, 0).keep(0.5)
    assert hand.place("X") < 7000
    hand.motion.release("stick")
    hand.bench.result(hand.future)


def test_one_hand_at_a_time_and_stop_ends_it() -> None:
    hand = Hand(SPEED, SPEED).keep(0.5)
    for other in (
        hand.motion.hold("X", SPEED, RAMP, RAMP, "mouse"),
        hand.motion.drive({"Y": 1e4}, RAMPS, RAMPS, "pad"),
    ):
        assert isinstance(other.exception(), NotAllowed) and "moved by hand already" in str(other.exception())
    assert hand.motion.steer("pad", {"X": 0.0}) == "Nothing is driven by this hand."
    assert "above the top speed" in hand.motion.steer("stick", {"X": 1e9})
    hand.bench.controller.stop()
    hand.keep(1.0)
    assert hand.bench.still() and hand.future.done()
    assert hand.motion.steer("stick", {"X": SPEED}) != ""


def test_a_slow_line_drives_the_stronger_axis_alone() -> None:
    hand = Hand(SPEED, SPEED / 2, baud=9600).keep(1.5)
    assert hand.place("X") > SPEED / 2 and hand.place("Y") == 0
    hand.motion.release("stick")
    hand.bench.result(hand.future)


def test_live_values_are_read_along_the_way() -> None:
    hand = Hand(SPEED, SPEED).keep(0.5)
    hand.bench.simulation.stimulus("an1", 4.5)
    hand.keep(0.4)
    row = hand.bench.controller.last()
    assert row.value("analog1") == pytest.approx(4.5, abs=0.005)  # 12 bits of 20 V (SSC manual l.1404)
    assert hand.bench.loopback.clock() - row.time("analog1") < 0.3


def test_a_limit_switch_stops_both() -> None:
    hand = Hand(SPEED, SPEED).keep(0.5)
    hand.bench.simulation.stimulus("fls_x", 0)
    hand.keep(1.0)
    assert hand.bench.still()
    assert "limit switch" in hand.bench.result(hand.future).sentence
