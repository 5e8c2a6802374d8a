"""Derived curves, measurements and spectra of signals whose answers mathematics tells."""

from __future__ import annotations

import math

import numpy as np
import pytest

from codegen.setup import Setup
from codegen.setup_axis import Axis
from device.capture import Capture, Channel
from device.curves import Derived, Window, curves, derive, frequency, measure, rise_time, spectrum

POSITION, COMMANDED, ERROR = (Channel(what, "X") for what in ("position", "commanded", "error"))
DT = 2 / 1024  # RC 1 at TM 1000: 2 samples of 1000/1 024 000 s


def taken(values: np.ndarray, *channels: Channel, setup: Setup | None = None) -> Capture:
    return Capture(channels, np.atleast_2d(values).astype(np.float64), 1, 1000.0, setup=setup)


def test_a_parabola_has_the_velocity_and_acceleration_of_its_derivatives() -> None:
    """s = a t²/2: v = a t (central differences of a parabola are exact), a constant."""
    t = np.arange(200) * DT
    capture = taken(0.5 * 3000.0 * t**2, POSITION)
    speed, change = derive(capture, Derived.VELOCITY, "X"), derive(capture, Derived.ACCELERATION, "X")
    assert speed is not None and change is not None
    np.testing.assert_allclose(speed.values[1:-1], 3000.0 * t[1:-1], rtol=1e-9)
    np.testing.assert_allclose(change.values, 3000.0, rtol=1e-6)
    assert (speed.unit, change.unit) == ("counts/s", "counts/s²")


def test_derived_values_at_the_ends_and_of_few_values() -> None:
    """At an end the velocity is that of the half interval inside, a·T/2 away; the acceleration is its neighbour's."""
    t = np.arange(6) * DT
    capture = taken(0.5 * 3000.0 * t**2, POSITION)
    speed, change = derive(capture, Derived.VELOCITY, "X"), derive(capture, Derived.ACCELERATION, "X")
    assert speed is not None and change is not None
    np.testing.assert_allclose(speed.values[[0, -1]], [3000 * DT / 2, 3000 * (t[-1] - DT / 2)])
    np.testing.assert_allclose(change.values[[0, -1]], 3000.0)
    assert derive(taken(np.zeros(2), POSITION), Derived.VELOCITY, "X") is None  # two values are no curve
    part = taken(np.array([0.0, 3.0, np.nan, np.nan]), POSITION)
    speed = derive(part, Derived.VELOCITY, "X")
    assert speed is not None and np.isnan(speed.values[2:]).all()  # nothing is made up where nothing was read


@pytest.mark.parametrize("tm", [250.0, 1000.0, 2000.0, -1000.0])
def test_times_and_frequencies_are_those_of_the_sample_time(tm: float) -> None:
    """A sample is TM/1 024 000 s; a negative TM (an external clock) has the same length, which is all that is known."""
    count, line, interval = 512, 16, 8 * abs(tm) / 1_024_000
    values = 5 * np.sin(2 * math.pi * line / count * np.arange(count))
    capture = Capture((POSITION,), values[None, :], 3, tm, trigger=100)
    assert capture.interval_s == pytest.approx(interval) and capture.times[100] == 0
    assert capture.times[0] == pytest.approx(-100 * interval)
    hertz, lines = spectrum(capture.of(POSITION), capture.interval_s, Window.HANN)
    assert hertz[int(np.argmax(lines))] == pytest.approx(line / (count * interval))
    assert measure(capture.times, capture.of(POSITION)).frequency_hz == pytest.approx(
        line / (count * interval), rel=1e-3
    )


def test_units_are_those_of_the_axis() -> None:
    setup = Setup(model="ssc1").with_axis("X", Axis(unit="mm", counts_per_unit="500"))
    capture = taken(np.array([[0.0, 250.0, 500.0], [0.0, 300.0, 500.0]]), POSITION, COMMANDED, setup=setup)
    position, commanded, error = curves(capture, {Derived.FOLLOWING})
    assert (position.unit, error.unit) == ("mm", "mm")
    np.testing.assert_allclose(position.values, [0.0, 0.5, 1.0])
    np.testing.assert_allclose(error.values, [0.0, 0.1, 0.0])
    assert position.group == commanded.group != error.group


@pytest.mark.parametrize(("amplitude", "hertz", "offset"), [(3.0, 8.0, 0.0), (250.0, 31.0, 1000.0), (0.02, 3.3, -5.0)])
def test_a_sine_measures_as_a_sine(amplitude: float, hertz: float, offset: float) -> None:
    """rms² = offset² + amplitude²/2 over whole periods."""
    t = np.arange(0, 10.0, DT)
    y = offset + amplitude * np.sin(2 * math.pi * hertz * t)
    found = measure(t, y)
    assert found.mean == pytest.approx(offset, abs=amplitude * 1e-3)
    assert found.rms == pytest.approx(math.sqrt(offset**2 + amplitude**2 / 2), rel=1e-3)
    assert found.peak_to_peak == pytest.approx(2 * amplitude, rel=5e-3)
    assert found.frequency_hz == pytest.approx(hertz, rel=1e-3)
    assert math.isnan(found.rise_s) or hertz == 3.3  # the ends of a sine are no levels


def test_noise_on_a_slow_square_wave_is_not_its_frequency() -> None:
    t = np.arange(0, 4.0, DT)
    noise = np.random.default_rng(1).normal(0, 0.02, len(t))
    assert frequency(t, np.sign(np.sin(2 * math.pi * 2.0 * t + 0.1)) + noise) == pytest.approx(2.0, rel=2e-3)


def test_rise_times() -> None:
    """A ramp of 0.5 s rises from 10 to 90 % in 0.4 s; a first-order lag in ln 9 of its time constant."""
    t = np.arange(0, 2.0, DT)
    ramp = np.clip((t - 0.7) / 0.5, 0, 1) * -40 + 7
    assert rise_time(t, ramp) == pytest.approx(0.4, abs=1e-6)
    lag = np.where(t < 0.5, 0.0, 1 - np.exp(-(t - 0.5) / 0.05))
    assert rise_time(t, lag) == pytest.approx(0.05 * math.log(9), rel=2e-2)
    assert math.isnan(rise_time(t, np.ones(len(t))))


def test_what_was_not_read_is_left_out() -> None:
    found = measure(np.arange(4.0), np.array([1.0, 3.0, np.nan, np.nan]))
    assert (found.least, found.most, found.mean) == (1.0, 3.0, 2.0)
    assert math.isnan(measure(np.arange(2.0), np.array([np.nan, np.nan])).mean)


@pytest.mark.parametrize("window", Window)
def test_a_sine_on_a_line_of_the_spectrum_has_its_amplitude(window: Window) -> None:
    """With N values and the interval T a sine of k/(N T) falls on line k, whatever window."""
    count, line, amplitude = 1000, 40, 7.5
    t = np.arange(count) * DT
    hertz, lines = spectrum(100 + amplitude * np.sin(2 * math.pi * line / (count * DT) * t + 0.3), DT, window)
    assert int(np.argmax(lines)) == line
    assert hertz[line] == pytest.approx(line / (count * DT))
    assert lines[line] == pytest.approx(amplitude, rel=1e-6)
    assert lines[0] < amplitude * (0.03 if window is Window.NONE else 0.5)


def test_between_two_lines_the_flat_top_keeps_the_amplitude() -> None:
    """Hann loses up to 1.42 dB = 15.1 % there, the flat top less than 0.02 dB."""
    count, amplitude = 1000, 2.0
    t = np.arange(count) * DT
    y = amplitude * np.sin(2 * math.pi * 40.5 / (count * DT) * t)
    assert spectrum(y, DT, Window.FLAT_TOP)[1].max() == pytest.approx(amplitude, rel=2e-3)
    assert spectrum(y, DT, Window.HANN)[1].max() == pytest.approx(amplitude * 10 ** (-1.42 / 20), rel=5e-3)


def test_the_highest_line_stands_for_itself() -> None:
    """Alternating +1, -1 is a cosine of amplitude 1 at half the rate."""
    y = np.where(np.arange(64) % 2, -1.0, 1.0)
    hertz, lines = spectrum(y, DT, Window.NONE)
    assert lines[-1] == pytest.approx(1.0) and hertz[-1] == pytest.approx(0.5 / DT)
