"""Numbers of step responses against closed forms."""

from __future__ import annotations

import math

import numpy
import pytest

from device.tuning.automatic import NEAR_COUNTS, Seen, search, seen
from device.tuning.loop import VOLTS, Gains
from device.tuning.metrics import Metrics, Response, measure, measured_words

DT = 1e-4  # s


def response(gone: numpy.ndarray, size: float = 1000.0, at: int = 50, volts: numpy.ndarray | None = None) -> Response:
    """An ideal step of `size` whose answer is `gone` (0 to 1 at rest) from the step on."""
    commanded = numpy.concatenate([numpy.zeros(at), numpy.full(len(gone), size)])
    actual = numpy.concatenate([numpy.zeros(at), size * gone])
    return Response(DT, commanded, actual, numpy.zeros(len(commanded)) if volts is None else volts)


def measured(one: Response, limit: float = 10.0) -> Metrics:
    found = measure(one, limit)
    assert isinstance(found, Metrics)
    return found


@pytest.mark.parametrize("size", [1000.0, -1000.0])
def test_a_first_order_answer(size: float) -> None:
    # 1 - exp(-t/τ): 10 to 90 % takes τ ln 9, 2 % is left after τ ln 50
    tau, t = 0.02, numpy.arange(0, 0.4, DT)
    found = measured(response(1 - numpy.exp(-t / tau), size))
    assert found.step == size
    assert found.rise_time == pytest.approx(tau * math.log(9), abs=DT)
    assert found.settling_time == pytest.approx(tau * math.log(50), abs=2 * DT)
    assert found.overshoot == 0.0
    assert found.peak_error == pytest.approx(1000.0)
    assert abs(found.steady_error) < 0.01


@pytest.mark.parametrize("zeta", [0.2, 0.45, 0.7])
def test_a_second_order_answer(zeta: float) -> None:
    # overshoot exp(-πζ/√(1-ζ²)); the crest of the envelope is below 2 % from ln(50/√(1-ζ²))/(ζω) on
    omega, t = 100.0, numpy.arange(0, 0.6, DT)
    damped = omega * math.sqrt(1 - zeta**2)
    decay = numpy.exp(-zeta * omega * t)
    answer = 1 - decay * (numpy.cos(damped * t) + zeta * omega / damped * numpy.sin(damped * t))
    found = measured(response(answer))
    assert found.overshoot == pytest.approx(math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2)), rel=2e-3)
    envelope = math.log(50 / math.sqrt(1 - zeta**2)) / (zeta * omega)
    assert found.settling_time is not None
    assert envelope - math.pi / damped <= found.settling_time <= envelope + 2 * DT
    assert found.rise_time is not None and found.rise_time < math.pi / damped


def test_what_never_comes_there_has_no_times() -> None:
    t = numpy.arange(0, 0.4, DT)
    short = measured(response(0.8 * (1 - numpy.exp(-t / 0.01))))
    assert (short.rise_time, short.settling_time) == (None, None)
    assert short.steady_error == pytest.approx(200.0, abs=0.1)
    assert short.rest_time == pytest.approx(0.01 * math.log(800 / 20), abs=2 * DT)  # 20 counts are 2 % of the step
    assert "rests 200 counts beside its end" in measured_words(short, False)
    swinging = measured(response(1 - 0.5 * numpy.cos(200 * t)))
    assert swinging.settling_time is None and swinging.rest_time is None
    assert measured_words(swinging, False) == "The response did not settle within the record."


def sagging(before: float, after: float) -> Response:
    """Errors at rest on both sides of a step of 1000 counts that overshoots by 50; 0.5 V at its end."""
    one = response(1 - numpy.exp(-numpy.arange(0, 0.4, DT) / 0.01), volts=numpy.full(4050, 0.5))
    actual = numpy.where(numpy.arange(4050) < 50, -before, one.actual - after)
    actual[1000] = 1050 - after
    return Response(DT, one.commanded, actual, one.volts)


@pytest.mark.parametrize(
    ("before", "after", "overshoot"),
    [(60.0, 60.0, 0.05), (-60.0, -60.0, 0.05), (60.0, 40.0, 0.05), (-40.0, 40.0, 0.01), (0.0, 40.0, 0.01)],
    ids=["hangs", "hangs the other way", "hangs and rubs", "rubs", "comes from rest"],
)
def test_a_trial_of_a_hanging_axis_is_judged_without_its_sag(before: float, after: float, overshoot: float) -> None:
    """Weight pulls to one side before the step and after it; friction leaves the error where it came from."""
    gains = Gains(kp=8, kd=100, offset=0.1)
    found = seen(sagging(before, after), gains, False)
    hangs = before * after > 0
    assert found.overshoot == pytest.approx(overshoot)
    assert (found.settled < 0.1) == hangs and math.isinf(found.settled) == (not hangs)
    assert found.metrics is not None and found.metrics.steady_error == pytest.approx(after)
    assert found.carried == pytest.approx(0.4)  # V less OF


def test_an_integrator_that_still_carries_the_weight_does_not_hide_it() -> None:
    """KI may be 0 and what it had gathered be there still: without it the error would show."""
    gains = Gains(kp=16, kd=100)
    quick = measured(response(1 - numpy.exp(-numpy.arange(0, 0.4, DT) / 0.005)))
    volts = NEAR_COUNTS * 4 * 16 * VOLTS  # what KP makes of one count (dmc-1412-1414.txt l.4454-4476)
    for carried, ki in ((0.5 * volts, 0.0), (5 * volts, 0.5)):
        trials = search(gains)
        assert next(trials).gains.ki == 0
        with pytest.raises(StopIteration) as end:
            trial = trials.send(Seen(quick, carried=carried))
            while True:
                trial = trials.send(Seen(quick, carried=carried))
        assert end.value.value.gains.ki == pytest.approx(ki) and (ki == 0 or trial.gains.ki == ki)


def test_a_small_step_settles_within_a_count() -> None:
    # 2 % of 20 counts is less than the encoder can show
    gone = numpy.array([0.0, 0.5, 1.1, 1.05, 0.95, 1.05, 0.95, 1.05] + [0.95] * 20)
    assert measured(response(gone, 20.0)).settling_time == pytest.approx(4 * DT)  # 22 of 20 counts is the last outside


def test_the_time_at_the_torque_limit() -> None:
    t = numpy.arange(0, 0.0400, DT)
    volts = numpy.concatenate([numpy.zeros(50), numpy.where(t < 0.01, -9.9982, 1.0)])
    one = response(1 - numpy.exp(-t / 0.003), volts=volts)
    assert measured(one, 9.9982).saturated == pytest.approx(0.25, abs=0.01)
    assert measured(one, 10.5).saturated == 0.0


def test_no_step_is_a_sentence() -> None:
    flat = Response(DT, numpy.zeros(100), numpy.zeros(100), numpy.zeros(100))
    assert measure(flat, 10.0) == "There is no step in this response: the commanded position ends where it began."
    nothing = Response(DT, numpy.zeros(0), numpy.zeros(0), numpy.zeros(0))
    assert isinstance(measure(nothing, 10.0), str)


@pytest.mark.parametrize(("each", "coarse"), [(0.004, False), (0.0085, False), (0.009, True), (0.0156, True)])
def test_a_rise_between_a_few_values_says_so(each: float, coarse: bool) -> None:
    """τ ln 9 of 20 ms is 43.9 ms: five values apart by at most 8.79 ms stand in it."""
    t = numpy.arange(0, 0.4, each)
    commanded, actual = (numpy.concatenate([[0.0], way]) for way in (1000 + 0 * t, 1000 * (1 - numpy.exp(-t / 0.02))))
    one = Response(each, commanded, actual, 0 * actual)
    found = measured(one)
    assert found.every == each
    assert found.rise_time is not None
    assert (found.rise_time < 5 * each) == found.coarse == coarse
