"""Tuning by a model on thirty machines, end to end: excitation, capture, estimate, gains, step, true loop."""

from __future__ import annotations

import math

import numpy
import pytest

from device.tuning.design import Design, Refusal, design
from device.tuning.identify import Estimate, identify
from device.tuning.loop import FACTORY
from device.tuning.metrics import Metrics, Response, measure
from device.tuning.predict import predict
from tests.device.simulator.reference import PERIOD
from tests.device.tuning import truth
from tests.device.tuning.axis import ERROR_LIMIT, Axis
from tests.device.tuning.thirty import CASES, EVERY_DAY, Case
from tests.long import is_long, record

COMMAND = "./studio test --long tests/device/tuning"
CHOSEN = [case for case in CASES if is_long() or case.name in EVERY_DAY]


def identified(case: Case, seed: int = 0) -> Estimate:
    """What a small excitation with the factory's gains tells, over two channels of 500 elements."""
    axis = Axis(case.plant)
    axis.channels = 2
    found = identify([axis.excite(case.travel, 500, seed)])
    assert isinstance(found, Estimate), found
    assert axis.on() and axis.bench.simulation.unit.state.arrays
    return found


def answer(case: Case, gains: object = FACTORY) -> tuple[Response, Metrics, Axis]:
    """The step that these gains make."""
    axis = Axis(case.plant)
    axis.set(gains)  # type: ignore[arg-type]
    response = axis.step(case.travel)
    metrics = measure(response, FACTORY.torque_limit)
    assert isinstance(metrics, Metrics)
    return response, metrics, axis


def check_reached(case: Case, found: Design) -> None:
    """Crossover ±10 % and margin ±5° in the true sampled loop."""
    true = truth.loop(case.plant, found.gains)
    assert true.stable
    assert true.crossover == pytest.approx(case.target.crossover, rel=0.10)
    assert true.phase == pytest.approx(case.target.phase, abs=5.0)
    record("tuning by a model: targets reached", COMMAND, None, 1, "of 28", add=True)
    away = abs(true.crossover / case.target.crossover - 1) * 100
    record(f"tuning by a model, {case.name}: crossover off by", COMMAND, None, away, "%")
    record(
        f"tuning by a model, {case.name}: margin off by", COMMAND, None, abs(true.phase - case.target.phase), "degrees"
    )


def check_step(case: Case, estimate: Estimate, found: Design) -> None:
    """The axis stays on, comes to rest, settles before the factory's gains do, and as it was predicted."""
    response, metrics, axis = answer(case, found.gains)
    assert axis.on()
    error = response.commanded - response.actual
    assert numpy.abs(error).max() < ERROR_LIMIT
    assert numpy.ptp(error[-150:]) <= max(3.0, 0.02 * case.travel), "it swings"
    assert metrics.settling_time is not None
    _, factory, _ = answer(case)
    assert metrics.settling_time < (factory.settling_time or math.inf)
    rows = axis.rows
    shown = predict(estimate.plant, found.gains, rows[:, 1] - rows[0, 1], PERIOD)
    apart = float(numpy.sqrt(numpy.mean((shown.actual - (rows[:, 2] - rows[0, 1])) ** 2))) / case.travel
    assert apart < 0.03
    record(f"tuning by a model, {case.name}: settling", COMMAND, None, metrics.settling_time * 1000, "ms")
    if factory.settling_time is not None:
        record(f"factory's gains, {case.name}: settling", COMMAND, None, factory.settling_time * 1000, "ms")


def check_refusal(case: Case, found: Refusal) -> None:
    """No gains reach it, and what is offered instead is true."""
    assert not case.reachable
    assert not truth.reachable(case.plant, case.target.crossover, case.target.phase)
    assert found.nearest is not None and found.nearest_target is not None
    true = truth.loop(case.plant, found.nearest.gains)
    assert true.stable and true.apart > 0.4
    assert true.crossover == pytest.approx(found.nearest_target.crossover, rel=0.10)
    assert true.phase == pytest.approx(found.nearest_target.phase, abs=5.0)
    record("tuning by a model: right refusals", COMMAND, None, 1, "of 2", add=True)


@pytest.mark.parametrize("case", CHOSEN, ids=lambda case: case.name)
def test_a_machine_is_tuned_by_its_model(case: Case) -> None:
    estimate = identified(case)
    found = design(estimate.plant, case.target, PERIOD)
    if isinstance(found, Refusal):
        check_refusal(case, found)
        return
    assert case.reachable
    assert truth.reachable(case.plant, case.target.crossover, case.target.phase)
    check_reached(case, found)
    check_step(case, estimate, found)


def test_the_thirty_are_what_they_should_be() -> None:
    plants = [case.plant for case in CASES]
    inertia = [plant.inertia + plant.load_inertia for plant in plants]
    springs = [plant for plant in plants if plant.load_inertia > 0]
    hertz = [math.sqrt(p.coupling_stiffness * (1 / p.inertia + 1 / p.load_inertia)) / 2 / math.pi for p in springs]
    assert len(plants) == 30 and len({case.name for case in CASES}) == 30
    assert max(inertia) / min(inertia) == pytest.approx(50)
    assert {min(p.encoder_lines for p in plants), max(p.encoder_lines for p in plants)} == {100, 10000}
    assert len(springs) == 10 and min(hertz) == pytest.approx(30) and max(hertz) == pytest.approx(300)
    assert sum(p.gravity != 0 for p in plants) == 5 and sum(p.delay_samples > 0 for p in plants) >= 5
    assert {p.drive.value for p in plants} == {"current", "velocity"}
    assert sum(p.coulomb_friction > 0 for p in plants) >= 10
