"""Hold-to-run: a lease the link ends after 150 ms, over a bounded move that ends by itself (safety.md, 4)."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from device.api import LinkError, StopState
from tests.device.bench import Bench

SPEED, ACCELERATION = 20_000, 256_000
STOPPING = SPEED**2 / (2 * ACCELERATION)


def held(seconds: float, each: Callable[[Bench], None] = lambda bench: None, direction: int = 1) -> Bench:
    """X held for so long, renewed every 50 ms."""
    bench = Bench("ssc4").ready()
    bench.ask("SH")
    bench.controller.motion.hold("X", direction * SPEED, ACCELERATION, ACCELERATION)
    end = bench.loopback.clock() + seconds
    while bench.loopback.clock() < end:
        bench.run(0.05)
        bench.controller.motion.renew()
        each(bench)
    return bench


def place(bench: Bench) -> float:
    return float(bench.simulation.state()["axes"]["X"]["commanded"])


@pytest.mark.parametrize("direction", [1, -1])
def test_it_runs_while_held_and_stops_when_released(direction: int) -> None:
    bench = held(2.0, direction=direction)
    assert abs(place(bench)) > 1.5 * SPEED
    assert place(bench) * direction > 0
    bench.controller.motion.release()
    before = place(bench)
    bench.run(0.6)
    assert bench.still()
    assert abs(place(bench) - before) <= STOPPING + SPEED * 0.1


def test_without_renewal_it_stops_within_the_lease() -> None:
    bench = held(1.0)
    before = place(bench)
    bench.run(1.0)
    assert bench.still()
    assert place(bench) - before <= SPEED * (0.15 + 0.1) + STOPPING


def test_a_pulled_cable_ends_in_a_normal_deceleration() -> None:
    bench = held(1.0)
    bench.loopback.unplugged = True
    before = place(bench)
    for _ in range(40):
        bench.controller.motion.renew()
        bench.run(0.05)
    assert bench.still()
    assert place(bench) - before <= SPEED * 0.6 + 2 * STOPPING


def test_stop_ends_the_lease() -> None:
    bench = held(0.5)
    bench.controller.stop()
    bench.controller.motion.renew()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED)
    bench.run(0.5)
    assert bench.still()


def test_a_motor_that_is_off_is_said() -> None:
    bench = Bench("ssc4").ready()
    bench.ask("MO")
    future = bench.controller.motion.hold("X", SPEED, ACCELERATION, ACCELERATION)
    with pytest.raises(LinkError, match="Axis X did not start"):
        bench.result(future)


def test_only_one_axis_is_held_at_a_time() -> None:
    bench = held(0.5)
    bench.controller.motion.hold("Y", SPEED, ACCELERATION, ACCELERATION)
    for _ in range(12):
        bench.run(0.05)
        bench.controller.motion.renew()
    state = bench.simulation.state()["axes"]
    assert not state["X"]["moving"]
    assert state["Y"]["moving"]
