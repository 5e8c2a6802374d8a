"""What a small excitation tells: every sample of it, the machine behind it, and what cannot be told."""

from __future__ import annotations

import math
import random
import time
from dataclasses import replace

import numpy
import pytest

from device.simulator.plant import Drive, Place, Plant
from device.tuning.excite import Excitation, NotIdentified, excitation, kick
from device.tuning.identify import Estimate, identify, identifying
from device.tuning.loop import FACTORY, VOLTS, Gains
from device.tuning.recording import Recording, Samples, every_sample
from tests.device.tuning.axis import PERIOD, Axis
from tests.device.tuning.thirty import MOTOR, rigid, spring
from tests.long import count, record
from tests.slower import slower


def gain_of(plant: Plant) -> float:
    """Counts/s² for one volt: Ka Kt / J Kf (dmc-1412-1414.txt l.4400-4440)."""
    whole = plant.inertia + plant.load_inertia
    return plant.amplifier_gain * plant.torque_constant / whole * 4 * plant.encoder_lines / (2 * math.pi)


def recorded(
    plant: Plant, travel: int = 200, gains: Gains = FACTORY, elements: int = 500, model: str = "ssc1"
) -> Recording:
    axis = Axis(plant, model)
    axis.set(gains)
    return axis.excite(travel, elements)


def told(*recordings: Recording) -> Estimate:
    found = identify(recordings)
    assert isinstance(found, Estimate), found
    return found


def refused(*recordings: Recording) -> str:
    found = identify(recordings)
    assert isinstance(found, NotIdentified)
    return found.reason


# ---------------------------------------------------------------- the excitation


def test_an_excitation_stays_within_its_travel_and_below_the_torque_limit() -> None:
    for travel, gains in ((60, FACTORY), (5000, FACTORY), (100_000, Gains(kp=1, kd=1)), (400, Gains(kp=100, kd=40))):
        plan = excitation(gains, travel, 500, 2, PERIOD)
        assert isinstance(plan, Excitation)
        places = numpy.cumsum([step.counts for step in plan.steps])
        assert 4 <= numpy.abs(places).max() <= plan.travel <= travel / 2  # as much again is left for the overshoot
        largest = max(abs(step.counts) for step in plan.steps)
        # one sample after the jump, before anything moves: 4KP e + 4KD (e - e1) counts of 20/65536 V
        assert largest * 4 * (gains.kp + gains.kd) * 20 / 65536 <= plan.peak_volts + 1e-9 <= 9.9982
        at = numpy.array([step.at for step in plan.steps])
        assert at[0] >= 0.02 and (numpy.diff(at) >= 0.0299).all() and at[-1] < plan.seconds - 0.1
        assert plan.seconds == pytest.approx(2 * 500 / 1024)


@pytest.mark.parametrize(
    ("gains", "travel", "word"),
    [
        (Gains(kd=0.5), 200, "KD is 0.5"),
        (FACTORY, 6, "The travel of 6 counts"),
        (Gains(kp=900, kd=4000), 200, "KP 900 and KD 4000"),
        (replace(FACTORY, torque_limit=0.3), 200, "KP 6 and KD 64"),
    ],
)
def test_an_excitation_that_can_not_be_made_says_why(gains: Gains, travel: int, word: str) -> None:
    found = excitation(gains, travel, 500, 2, PERIOD)
    assert isinstance(found, NotIdentified) and found.reason.startswith(word)


# ---------------------------------------------------------------- every sample


@pytest.mark.parametrize("late", [False, True], ids=["read as the sample begins", "read at its end"])
@pytest.mark.parametrize("channels", [2, 3])
@pytest.mark.parametrize("gains", [FACTORY, Gains(kp=9, kd=100, ki=1)], ids=["factory", "with KI"])
def test_every_sample_follows_from_every_second(gains: Gains, channels: int, late: bool) -> None:
    # what is read at the end of a sample is without noise in the simulator; the servo's error is not
    plant = Plant(gravity=0.3, coulomb_friction=0.003, encoder_noise=0.0 if late else 0.3)
    axis = Axis(plant, late=late)
    axis.set(gains)
    axis.channels = channels
    axis.bench.simulation.motion.trace(3000)
    found = every_sample(axis.excite(200, 500))
    rows = axis.bench.simulation.motion.trace_rows()
    assert isinstance(found, Samples)
    total = len(found.counts)
    assert total == 999 and found.sure.all()
    gone = found.counts - found.counts[0]
    # where the capture lies in the simulator's own trace of every sample
    true = next(
        part
        for part in (rows[n : n + total] for n in range(len(rows) - total))
        if numpy.array_equal(part[:, 2] - part[0, 2], gone)
    )
    assert numpy.ptp(gone) > 50
    assert numpy.abs(found.volts - true[:, 4]).max() < 3e-4  # a step of the captured torque
    assert list(found.jumps) == [int(n) + 1 for n in numpy.flatnonzero(numpy.diff(true[:, 1]))]


def test_a_capture_that_does_not_belong_to_the_gains_is_told() -> None:
    recording = recorded(Plant())
    assert "these were not the gains" in refused(replace(recording, gains=Gains(kp=6, kd=50)))
    assert "RC 1" in refused(replace(recording, every=4))
    assert "64 are the least" in refused(replace(recording, error=recording.error[:40], volts=recording.volts[:40]))
    assert "KD is 0" in refused(replace(recording, gains=Gains(kp=6, kd=0)))
    assert "FV and FA" in refused(replace(recording, gains=Gains(fv=10)))
    two = replace(recording, position=None)
    assert isinstance(every_sample(two), Samples)
    assert "jumps that were sent" in refused(replace(two, steps=(50, -50)))


# ---------------------------------------------------------------- the machine


RIGID = {
    "x30": rigid(30, 5000, 4.0, rub=4e-3),
    "plain": rigid(1, 1000),
    "dry": rigid(2, 1000, 1.0, dry=0.008),
    "100 lines": rigid(1, 100, 2.0, dry=0.004),
    "hangs": rigid(3, 2000, gravity=-0.7),
    "late": rigid(1, 1000, delay_samples=3),
}


@pytest.mark.parametrize("name", list(RIGID)[: count(2, 99)])
@pytest.mark.parametrize("model", ["ssc1", "dmc1412"])
def test_inertia_friction_weight_and_delay(name: str, model: str) -> None:
    plant = RIGID[name]
    found = told(recorded(plant, 200, model=model))
    volt = plant.amplifier_gain * plant.torque_constant  # N·m for one volt
    assert found.plant.gain == pytest.approx(gain_of(plant), rel=0.02)
    assert found.plant.coulomb == pytest.approx(plant.coulomb_friction / volt, abs=0.015)
    assert found.plant.gravity == pytest.approx(plant.gravity, abs=0.01)
    assert found.plant.delay == pytest.approx(plant.delay_samples * PERIOD, abs=0.15 * PERIOD)
    assert found.plant.resonance is None and not found.plant.velocity_mode
    assert found.fit > 0.99
    assert abs(found.plant.gain - gain_of(plant)) < 6 * found.sigma["gain"] + 0.005 * gain_of(plant)


@pytest.mark.parametrize("tm", [500, pytest.param(2000, marks=pytest.mark.long)])
def test_other_sample_times(tm: int) -> None:
    plant = rigid(3, 2000, delay_samples=2)
    axis = Axis(plant, tm=tm)
    axis.set(Gains(kp=6, kd=64 * 1000 / tm))
    found = told(axis.excite(200, 500))
    assert found.plant.gain == pytest.approx(gain_of(plant), rel=0.02)
    assert found.plant.delay == pytest.approx(2 * axis.period, abs=0.15 * axis.period)


@pytest.mark.parametrize(
    ("plant", "hertz", "ratio"),
    [
        (Plant(**spring(40, 0.04, 0.5)), 40, 0.5),
        pytest.param(Plant(encoder_lines=2500, **spring(280, 0.03, 1.0)), 280, 1.0, marks=pytest.mark.long),
        (Plant(main=Place.LOAD, **spring(90, 0.05, 0.7)), 90, None),
    ],
    ids=["40 Hz", "280 Hz", "encoder on the load"],
)
def test_the_first_resonance(plant: Plant, hertz: float, ratio: float | None) -> None:
    found = told(recorded(plant))
    seen = found.plant.resonance
    assert seen is not None
    assert seen.frequency == pytest.approx(hertz, rel=0.01)
    assert abs(seen.frequency - hertz) < 5 * found.sigma["frequency"] + 0.001 * hertz
    assert seen.on_load == (ratio is None)
    if ratio is not None:
        assert seen.ratio == pytest.approx(ratio, rel=0.08)
    else:
        assert any("does not tell how the inertia is divided" in note for note in found.notes)
    assert found.plant.gain == pytest.approx(gain_of(plant), rel=0.02)


def test_a_velocity_drive_is_another_kind_of_plant() -> None:
    plant = Plant(drive=Drive.VELOCITY, amplifier_gain=2.0, tachometer_gain=0.1)
    found = told(recorded(plant))
    assert found.plant.velocity_mode
    assert found.plant.pole == pytest.approx(2 * 0.1 * 0.1 / MOTOR, rel=0.03)  # Ka Kt Kg / J (l.4415)
    # its speed for one volt is 1 / Kg (l.4420)
    assert found.plant.gain / found.plant.pole == pytest.approx(4000 / (2 * math.pi) / 0.1, rel=0.03)
    assert any("velocity loop" in note for note in found.notes)


def test_what_could_not_be_told_is_said() -> None:
    notes = " ".join(told(recorded(Plant())).notes)
    assert "No resonance was seen" in notes and "Coulomb friction is too small" in notes


@pytest.mark.long
def test_jumps_of_a_few_counts_tell_less_and_it_is_said() -> None:
    """KP 68, KD 670: one count makes 0.9 V, so jumps are 4 counts (0.8 of 10 V over 0.9 V, to either side)."""
    axis = Axis(Plant())
    axis.set(Gains(kp=68.25, kd=670.5))
    found = identify([axis.excite(500, 500)])
    assert isinstance(found, Estimate)
    assert found.plant.gain == pytest.approx(gain_of(Plant()), rel=0.05)
    assert "The jumps were 4 counts" in found.notes[0] and "lower gains" in found.notes[0]


def test_an_axis_that_friction_holds_is_not_guessed_at() -> None:
    stuck = Plant(coulomb_friction=0.09)  # 0.9 V; jumps of 20 counts hold 0.15 V
    assert "Allow more travel" in refused(recorded(stuck, 20))


@pytest.mark.long
def test_noise_and_ripple_are_not_taken_for_a_machine() -> None:
    plant = replace(rigid(2, 2000, dry=0.004), encoder_noise=0.7, torque_ripple=0.03)
    found = told(recorded(plant, 400))
    assert found.plant.gain == pytest.approx(gain_of(plant), rel=0.05)
    assert found.plant.resonance is None


@pytest.mark.long
def test_play_in_the_coupling_is_told_as_unexplained() -> None:
    plant = Plant(backlash=30.0, main=Place.LOAD, **spring(60, 0.1, 1.0))
    found = identify([recorded(plant)])
    assert isinstance(found, NotIdentified) or any("unexplained" in note for note in found.notes)


@pytest.mark.long
def test_two_weak_recordings_make_a_better_one() -> None:
    plant = rigid(10, 2000, dry=0.01)
    first = recorded(plant, 60)
    axis = Axis(plant)
    axis.set(Gains(kp=10, kd=150))
    second = axis.excite(60, 500, seed=1)
    alone, both = told(first), told(first, second)
    assert both.sigma["gain"] < alone.sigma["gain"]
    assert both.plant.gain == pytest.approx(gain_of(plant), rel=0.05)


@pytest.mark.alone
def test_the_work_comes_in_pieces_that_nobody_notices() -> None:
    work = identifying([recorded(Plant(coulomb_friction=0.004, **spring(60, 0.04, 1.0)))])
    done, longest = [0.0], 0.0
    while True:
        begin = time.thread_time()
        try:
            done.append(next(work))
        except StopIteration as result:
            assert isinstance(result.value, Estimate)
            break
        longest = max(longest, time.thread_time() - begin)
    assert len(done) > 50 and done == sorted(done) and done[-1] < 1
    assert longest < 0.05 * slower()


def test_a_kick_is_what_the_filter_makes_of_one_count() -> None:
    assert kick(FACTORY) == pytest.approx(4 * 70 * 20 / 65536)
    assert VOLTS == 20 / 65536  # dmc-1412-1414.txt l.4451


def any_axis(chance: random.Random) -> tuple[Plant, Gains, int]:
    """A rigid machine with gains up to ten times the factory's, and the travel."""
    plant = rigid(
        chance.choice([1, 3, 10, 30]), chance.choice([250, 500, 1000, 2500, 5000]), chance.choice([1.0, 2.0, 4.0]),
        dry=chance.choice([0.0, 0.004, 0.01]), delay_samples=chance.choice([0, 0, 1, 2]),
    )  # fmt: skip
    stiff = math.exp(chance.uniform(0.0, math.log(10.0)))
    return plant, Gains(kp=6 * stiff * chance.uniform(0.5, 1.5), kd=64 * stiff), chance.choice([40, 100, 300, 1000])


def test_the_inertia_is_known_as_well_as_it_says() -> None:
    """Whatever the gains: of those told at least nine in ten within two sigma, none beyond five."""
    chance, off = random.Random(count(3, 4)), []
    for _ in range(count(5, 60)):
        plant, gains, travel = any_axis(chance)
        found = identify([recorded(plant, travel, gains)])
        if isinstance(found, Estimate):
            off.append(abs(found.plant.gain - gain_of(plant)) / found.sigma["gain"])
    print([round(each, 1) for each in sorted(off)])
    command = "pytest tests/device/tuning/test_identify.py"
    record("inertia told: most sigma off, of so many axes", command, 4, max(off), f"of {len(off)}")
    assert len(off) >= count(3, 45)
    assert max(off) < 5.0
    assert sum(each > 2.0 for each in off) <= 0.1 * len(off)


@pytest.mark.parametrize("lines", [1000, pytest.param(5000, marks=pytest.mark.long)])
def test_what_chatters_between_counts_is_not_told(lines: int) -> None:
    """KD of four times the factory's and dry friction: the fit comes out a quarter (three quarters) too small."""
    plant = rigid(1, lines, dry=0.004)
    assert "chatters between its counts" in refused(recorded(plant, 300, Gains(kp=23.5, kd=250)))
