"""Hold-to-run: a lease the link ends after 150 ms, over a bounded move that ends by itself (safety.md, 4)."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future

import pytest

from device.api import Kind, LinkError, NotAllowed, Ran, StopState
from tests.device.bench import Bench

SPEED, ACCELERATION = 20_000, 256_000
STOPPING = SPEED**2 / (2 * ACCELERATION)
STOPPING_S = SPEED / ACCELERATION


class Hold:
    """X of a simulated machine in somebody's hand, renewed every 50 ms."""

    def __init__(
        self, speed: int = SPEED, acceleration: int = ACCELERATION, baud: int = 19200, name: str = "ssc4"
    ) -> None:
        self.speed, self.acceleration = speed, acceleration
        self.bench = Bench(name, baud).ready()
        self.bench.ask("SH")
        self.future: Future[Ran] = self.press()

    def press(self) -> Future[Ran]:
        return self.bench.controller.motion.hold("X", self.speed, self.acceleration, self.acceleration)

    def keep(self, seconds: float, each: Callable[[Hold], None] = lambda hold: None) -> Hold:
        end = self.bench.loopback.clock() + seconds
        while self.bench.loopback.clock() < end:
            self.bench.run(0.05)
            self.bench.controller.motion.renew()
            each(self)
        return self

    @property
    def place(self) -> float:
        return float(self.bench.simulation.state()["axes"]["X"]["commanded"])

    @property
    def target(self) -> float:
        return float(self.bench.simulation.unit.motion.target(0))


@pytest.mark.parametrize("baud", [9600, 19200, 38400])
@pytest.mark.parametrize("direction", [1, -1])
def test_it_runs_while_held_and_stops_when_released(direction: int, baud: int) -> None:
    hold = Hold(direction * SPEED, baud=baud)
    hold.keep(2.0)
    assert abs(hold.place) > 1.5 * SPEED
    assert hold.place * direction > 0
    before = hold.place
    hold.bench.controller.motion.release()
    ran = hold.bench.result(hold.future)
    assert hold.bench.still()
    ran_on = abs(hold.place - before)
    assert ran_on <= SPEED * 0.15 + STOPPING
    assert -SPEED * 0.02 <= ran.run_on - ran_on <= SPEED * 0.04  # it says rather too much
    assert ran.seconds <= 0.15 + STOPPING_S + 0.2  # told some readings later
    assert ran.place == hold.place


@pytest.mark.parametrize(("name", "speed", "acceleration"), [("ssc4", 20_000, 20_480), ("dmc1412", 300_000, 1_024_000)])
def test_never_more_than_the_speed_in_400_ms_and_the_stopping_distance_lie_ahead(
    name: str, speed: int, acceleration: int
) -> None:
    """Also while it accelerates for a second, and on a controller whose lines take one command of it."""
    hold = Hold(speed, acceleration, name=name)
    ahead = speed * 0.4 + speed**2 / (2 * acceleration)
    furthest: list[float] = []
    least: list[float] = []

    def measure(hold: Hold) -> None:
        furthest.append(hold.target - hold.place)
        if hold.place > speed**2 / acceleration:  # at speed
            least.append(hold.target - hold.place - speed**2 / (2 * acceleration))

    hold.keep(3.0, measure)
    assert max(furthest) <= ahead + speed * 0.002
    assert min(least) > 0.05 * speed  # and it never slows down meanwhile


def test_without_renewal_it_stops_within_the_lease() -> None:
    hold = Hold().keep(1.0)
    before = hold.place
    hold.bench.run(1.0)
    assert hold.bench.still()
    assert hold.place - before <= SPEED * (0.15 + 0.1) + STOPPING


def test_whoever_comes_back_late_has_to_press_again() -> None:
    """A frozen window that wakes may renew before the link has looked."""
    hold = Hold().keep(1.0)
    lease = hold.bench.controller.motion._now
    assert lease is not None and lease.held
    hold.bench.simulation.advance(1_024_000 // 5)
    hold.bench.controller.motion.renew()
    assert not lease.held
    hold.keep(1.0)
    assert hold.bench.still()


def test_a_pulled_cable_ends_in_a_normal_deceleration() -> None:
    hold = Hold().keep(1.0)
    hold.bench.loopback.unplugged = True
    before = hold.place
    hold.keep(2.0)
    assert hold.bench.still()
    assert hold.place - before <= SPEED * 0.5 + STOPPING
    with pytest.raises(LinkError):
        hold.bench.result(hold.future)


def test_stop_ends_the_lease() -> None:
    hold = Hold().keep(0.5)
    hold.bench.controller.stop()
    hold.bench.controller.motion.renew()
    hold.bench.run_until(lambda: hold.bench.controller.stop_state is StopState.STOPPED)
    hold.keep(0.5)
    assert hold.bench.still()


def test_what_was_stopped_by_something_else_is_not_started_again() -> None:
    """IP starts a new move where the axis stands (dmc-1412-1414.txt l.1702), so it must not arrive there."""
    hold = Hold().keep(0.5)
    hold.bench.simulation.receive(1, b"ST X\r")
    hold.bench.run(STOPPING_S + 0.05)
    before = hold.place
    hold.keep(0.5)
    assert hold.place == pytest.approx(before, abs=SPEED * 0.02)
    sentence = hold.bench.result(hold.future).sentence
    assert "stop command (ST)" in sentence or "by something else" in sentence


def test_a_limit_switch_ends_it_and_is_said() -> None:
    hold = Hold().keep(0.5)
    hold.bench.simulation.stimulus("fls_x", 0)
    hold.keep(0.6)
    sentence = hold.bench.result(hold.future).sentence
    assert "FWD limit switch" in sentence or "forward limit" in sentence
    assert hold.bench.still()


def test_speed_and_ramps_are_as_before_afterwards() -> None:
    hold = Hold().keep(0.3)
    hold.bench.controller.motion.release()
    hold.bench.result(hold.future)
    values = hold.bench.result(hold.bench.controller.read("_SPX", "_ACX", "_DCX"))
    assert values == (25_000, 256_000, 256_000)  # the defaults of the power-up


def test_at_half_the_sample_time_everything_is_twice_as_fast() -> None:
    """TM 500: SP counts 1024 samples, so the axis runs at 40 000 counts/s and 16 000 counts are 0.4 s of it."""
    bench = Bench("ssc2").ready()
    bench.ask("SH;TM 500")
    bench.controller.motion.hold("X", SPEED, ACCELERATION, ACCELERATION)
    ahead = []
    for _ in range(20):
        bench.run(0.05)
        bench.controller.motion.renew()
        ahead.append(bench.simulation.unit.motion.target(0) - bench.simulation.unit.motion.reference(0))
    assert 2 * SPEED * 0.3 < max(ahead) <= 2 * SPEED * 0.4 + STOPPING + SPEED * 0.004


def test_a_motor_that_is_off_is_said() -> None:
    bench = Bench("ssc4").ready()
    bench.ask("MO")
    future = bench.controller.motion.hold("X", SPEED, ACCELERATION, ACCELERATION)
    with pytest.raises(LinkError, match="Axis X did not start: its motor is off"):
        bench.result(future)


def test_a_blocked_way_is_said() -> None:
    bench = Bench("ssc4").ready()
    bench.ask("SH")
    bench.simulation.stimulus("fls_x", 0)
    future = bench.controller.motion.hold("X", SPEED, ACCELERATION, ACCELERATION)
    with pytest.raises(LinkError, match="Axis X did not start: error 22"):
        bench.result(future)


@pytest.mark.parametrize("beyond", ["refused", "accepted"])
def test_a_software_limit_ends_it_with_its_name(beyond: str) -> None:
    """Whether a target beyond FL is refused (dmc-1412-1414.txt l.4135) or stopped at: said, and never passed."""
    hold = Hold()
    setting = hold.bench.simulation.unit.profile
    assert hasattr(setting, "target_beyond_limit")
    choices = {"refused": setting.target_beyond_limit, "accepted": "not refused"}
    hold.bench.simulation.unit.profile = type(setting)(target_beyond_limit=choices[beyond])
    hold.bench.simulation.receive(1, b"FL 30000\r")
    hold.keep(4.0)
    assert hold.bench.still()
    assert hold.place <= 30_000 + STOPPING
    assert "limit" in hold.bench.result(hold.future).sentence


def test_only_one_axis_is_held_at_a_time() -> None:
    hold = Hold().keep(0.5)
    bench = hold.bench
    bench.controller.motion.hold("Y", SPEED, ACCELERATION, ACCELERATION)
    hold.keep(0.8)
    state = bench.simulation.state()["axes"]
    assert not state["X"]["moving"]
    assert state["Y"]["moving"]


def test_one_hand_only() -> None:
    bench = Bench("ssc4").ready()
    bench.ask("SH")
    motion = bench.controller.motion
    motion.hold("X", SPEED, ACCELERATION, ACCELERATION, owner="mouse")
    bench.run(0.05)
    motion.renew("mouse")
    with pytest.raises(NotAllowed, match="moved by hand already"):
        bench.result(motion.hold("X", -SPEED, ACCELERATION, ACCELERATION, owner="keyboard"))
    motion.renew("keyboard")
    motion.release("keyboard")
    for _ in range(6):
        bench.run(0.05)
        motion.renew("mouse")
    assert bench.simulation.state()["axes"]["X"]["moving"]
    assert motion.busy == "axis X"
    for _ in range(6):  # only the mouse's renewals count
        bench.run(0.05)
        motion.renew("keyboard")
    bench.run(0.3)
    assert bench.still()


@pytest.mark.parametrize(
    ("speed", "ramp", "words"),
    [
        (0, 256_000, "speed"),
        (20_000, 0, "at least 1024"),
        (float("nan"), 256_000, "speed"),
        (9e6, 256_000, "top speed"),
    ],
)
def test_numbers_that_can_not_be_run_are_said(speed: float, ramp: float, words: str) -> None:
    bench = Bench("ssc4").ready()
    with pytest.raises(NotAllowed, match=words):
        bench.result(bench.controller.motion.hold("X", speed, ramp, ramp))


def test_a_slow_line_can_not_hold() -> None:
    bench = Bench("ssc2", 1200).ready()
    with pytest.raises(NotAllowed, match="faster line than 1200 baud"):
        bench.result(bench.controller.motion.hold("X", 100, 102_400, 102_400))


def test_an_axis_that_the_running_program_drives_is_its_own() -> None:
    bench = Bench("ssc2").ready()
    bench.ask("SH")
    bench.result(bench.controller.download("#A\nPR ,500\nBGY\nAMY\nWT 100\nJP #A\nEN").future)
    assert bench.result(bench.controller.execute("A", anyway=True)).accepted
    bench.run(2.0)
    with pytest.raises(NotAllowed, match="the running program drives axis Y"):
        bench.result(bench.controller.motion.hold("Y", SPEED, ACCELERATION, ACCELERATION))
    future = bench.controller.motion.hold("X", SPEED, ACCELERATION, ACCELERATION)
    for _ in range(10):
        bench.run(0.05)
        bench.controller.motion.renew()
    assert bench.simulation.state()["axes"]["X"]["commanded"] > SPEED * 0.2
    bench.controller.motion.release()
    bench.result(future)


# ------------------------------------------------------------- latched jogs


def latched() -> tuple[Bench, Future[Ran]]:
    bench = Bench("ssc4", kind=Kind.MACHINE).ready()
    bench.controller.take_control()
    bench.ask("SH")
    motion = bench.controller.motion
    with pytest.raises(NotAllowed, match="latch"):
        bench.result(motion.run("X", SPEED, ACCELERATION, ACCELERATION))
    motion.set_latch(True)
    future = motion.run("X", SPEED, ACCELERATION, ACCELERATION)
    bench.run(2.0)
    assert bench.simulation.state()["axes"]["X"]["commanded"] > SPEED * 1.5
    return bench, future


@pytest.mark.parametrize("end", ["release", "latch", "watch"])
def test_a_latched_jog_goes_on_until_it_is_ended(end: str) -> None:
    bench, future = latched()
    if end == "release":
        bench.controller.motion.release()
    elif end == "latch":
        bench.controller.motion.set_latch(False)
    else:
        bench.controller.release_control()
    bench.result(future)
    assert bench.still()


def test_closing_ends_a_latched_jog() -> None:
    bench, _ = latched()
    bench.controller.close()
    bench.simulation.advance(1_024_000)
    assert bench.still()


def test_stop_takes_the_latch_away() -> None:
    bench, _ = latched()
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED)
    assert bench.still()
    assert not bench.controller.motion.latch
