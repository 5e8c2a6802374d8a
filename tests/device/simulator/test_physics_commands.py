"""Servo commands and plant effects through the command language, each against its own formula."""

from __future__ import annotations

import math

import numpy
import pytest

from codegen.models import model
from device.simulator.plant import Drive, Place, Plant
from tests.device.simulator.bench import Bench

VOLT = 20 / 65536  # of one count of the converter (dmc-1412-1414.txt l.4451)
SCALE = 4000 / (2 * math.pi)  # counts a radian of a 1000-line encoder (l.4445)
HELD = Plant(coulomb_friction=100.0)  # nothing moves: the filter alone


def number(bench: Bench, operand: str) -> float:
    return float(bench.ask(f"MG {operand}"))


def pushed(counts: int, commands: str = "") -> Bench:
    """A held axis with a position error."""
    bench = Bench("ssc1", {"X": HELD})
    bench.ask("SHX;KD 0;KI 0;ER 32767")
    if commands:
        bench.ask(commands)
    bench.simulation.stimulus("position_x", -counts)
    bench.samples(2)
    assert number(bench, "_TEX") == counts
    return bench


# ---------------------------------------------------------------- the filter's commands


def test_gain_and_zero_are_the_same_filter_in_other_words() -> None:
    # l.4460-4462: K = 4 (KP + KD) = 4 GN, A = KD / (KP + KD) = ZR
    bench = Bench("ssc1")
    bench.ask("GN 40;ZR 0.9")
    kp, kd = number(bench, "_KPX"), number(bench, "_KDX")
    assert kp + kd == pytest.approx(40, abs=0.2)
    assert kd / (kp + kd) == pytest.approx(0.9, abs=0.01)
    step = pushed(50, "GN 40;ZR 0.9")
    assert number(step, "_TTX") == pytest.approx(4 * 4 * 50 * VOLT, abs=0.01)  # at rest only 4 KP e is left


def test_integrator_grows_by_half_ki_a_sample_and_stops_at_its_limit() -> None:
    bench = pushed(8, "KP 0;KI 2;IL 0.5")
    before = number(bench, "_TTX"), bench.simulation.motion.sample
    bench.samples(40)
    after = number(bench, "_TTX"), bench.simulation.motion.sample
    assert after[0] - before[0] == pytest.approx((after[1] - before[1]) * 2 / 2 * 8 * VOLT, abs=1e-3)
    bench.samples(2000)
    assert number(bench, "_TTX") == pytest.approx(0.5, abs=1e-3)


def test_a_negative_integrator_limit_freezes_the_integrator_while_the_profile_runs() -> None:
    bench = pushed(8, "KP 0;KI 2;IL -3;JG 0")
    bench.ask("BGX")
    first = number(bench, "_TTX")
    bench.samples(500)
    assert number(bench, "_TTX") == first
    bench.ask("STX")
    bench.samples(5000)
    assert number(bench, "_TTX") == pytest.approx(3, abs=1e-3)


def test_torque_limit_and_offset() -> None:
    bench = pushed(1000, "KP 6;OF 0.5")
    assert number(bench, "_TTX") == pytest.approx(min(9.9982, 0.5 + 4 * 6 * 1000 * VOLT), abs=0.01)
    bench.ask("TL 2")
    bench.samples(1)
    assert number(bench, "_TTX") == pytest.approx(2, abs=5e-4)
    bench.ask("MOX")
    bench.samples(1)
    assert number(bench, "_TTX") == pytest.approx(0.5, abs=1e-4)  # MO: only OF is left


def test_feed_forwards_in_volts() -> None:
    # commands.md 8: FV 10 at 30 000 counts/s is 0.366 V; FA: 1.5e-7 V per count/s²
    bench = Bench("ssc1", {"X": HELD})
    bench.ask("SHX;KP 0;KD 0;FV 10;FA 8;ER 32767;AC 102400;JG 30000;BGX")
    bench.samples(100)  # speeding up at 102 400 counts/s²
    bench.simulation.rest(10)
    motion = bench.simulation.motion
    speed = motion.commanded_velocity(0)
    assert 10_000 < speed < 20_000
    assert motion.torque(0) == pytest.approx(1.22e-6 * 10 * speed + 1.5e-7 * 8 * 102400, rel=1e-6)
    bench.samples(1000)
    assert number(bench, "_TTX") == pytest.approx(0.366, abs=0.001)


@pytest.mark.parametrize("name", ["ssc1", "ssc2", "ssc3", "ssc4", "dmc1412", "dmc1414"])
def test_the_shortest_sample_time_of_each_model(name: str) -> None:
    # models.json: 250 µs with one axis, 375 with two, 500 with three or four
    shortest = {"ssc2": 375, "ssc3": 500, "ssc4": 500}.get(name, 250)
    assert model(name).tm_min_us == shortest
    bench = Bench(name)
    assert bench.refused(f"TM {shortest - 1}") == 6
    bench.ask(f"TM {shortest}")
    bench.simulation.rest(10)
    first = bench.simulation.motion.sample
    bench.wait(1000)
    bench.simulation.rest(10)
    # a sample is TM/1 024 000 s; speeds and times count samples as if there were 1024 a second
    assert bench.simulation.motion.sample - first == pytest.approx(1_024_000 / shortest, abs=2)


def test_a_move_at_the_shortest_sample_time_takes_that_much_less_true_time() -> None:
    times = []
    for period in (1000, 250):
        bench = Bench("ssc1", {"X": Plant(viscous_friction=0.002)})
        bench.ask(f"TM {period};SHX")
        bench.run("KD 200;SP 20000;AC 204800;DC 204800;PR 10000;BGX;MG 1;AMX;MG 2;EN")
        (began, _, _), (ended, _, _) = bench.simulation.messages
        times.append(ended - began)
    assert times[1] / times[0] == pytest.approx(0.25, abs=0.01)


# ---------------------------------------------------------------- effects of the machine


def test_gravity_needs_the_error_that_holds_it() -> None:
    # at rest 4 KP e VOLT = gravity
    bench = Bench("ssc1", {"X": Plant(gravity=0.4, viscous_friction=0.003)})
    bench.ask("SHX;KP 10;KD 200")
    bench.wait(3000)
    assert number(bench, "_TEX") == pytest.approx(0.4 / (4 * 10 * VOLT), abs=1)
    bench.ask("KI 1")
    bench.wait(3000)
    assert abs(number(bench, "_TEX")) <= 1  # l.888-891: the integrator takes it
    bench.ask("MOX")
    motion = bench.simulation.motion
    bench.simulation.rest(10)
    begin, speed = motion.position(0), motion.velocity_now(0)
    seconds = len(traced(bench, 200)) / 1024
    rate, pull = 0.003 / 2e-4, 0.4 * 0.1 / 2e-4 * SCALE  # falls against viscous friction
    left = (1 - math.exp(-rate * seconds)) / rate
    fall = pull / rate * (seconds - left) - speed * left  # MO was some samples ago: it has some speed
    assert begin - motion.position(0) == pytest.approx(fall, abs=0.01 * fall + pull / 1024 * seconds / 1024)


def test_coulomb_friction_leaves_an_error_within_its_band() -> None:
    # at rest |4 KP e VOLT Ka Kt| <= friction; without friction the same move ends on its target
    plant = Plant(coulomb_friction=0.02, viscous_friction=0.001)
    bench = Bench("ssc1", {"X": plant})
    bench.ask("SHX;KP 2;KD 60;SP 4000;PR 500;BGX")
    bench.wait(4000)
    error = number(bench, "_TEX")
    assert bench.simulation.motion.velocity_now(0) == 0
    assert 3 < abs(error) <= 0.02 / 0.1 / (4 * 2 * VOLT) + 1


def test_backlash_shows_between_the_encoders() -> None:
    # the load stands half the play behind the motor on either side
    bench = Bench("ssc1", {"X": Plant(backlash=40, auxiliary=Place.LOAD, viscous_friction=0.01)})
    bench.ask("SHX;KD 400;KP 12;SP 4000;AC 20480;DC 20480")
    differences = []
    for target in (2000, 500):
        bench.ask(f"PA {target};BGX")
        bench.wait(2500)
        differences.append(number(bench, "_TPX") - number(bench, "_TDX"))
    assert differences == [20, -20]


def traced(bench: Bench, samples: int) -> numpy.ndarray:
    """The encoder's positions in the samples to come."""
    motion = bench.simulation.motion
    bench.simulation.rest(10)
    motion.trace(samples)
    bench.samples(samples)
    bench.simulation.rest(10)
    return motion.trace_rows()[:, 2].copy()


def swing(bench: Bench, samples: int) -> float:
    """How far the load swings."""
    places = traced(bench, samples)
    return float(places.max() - places.min())


def test_dual_loop_settles_where_the_load_encoder_alone_swings() -> None:
    # l.2238-2250: KD on the motor's encoder makes a loop with play stable
    plant = Plant(backlash=40.0, main=Place.LOAD, auxiliary=Place.MOTOR)
    swings = []
    for dual in (0, 1):
        bench = Bench("ssc1", {"X": plant})
        bench.ask(f"SHX;KP 6;KD 150;DV {dual};ER 32767;SP 20000;PR 2000;BGX")
        bench.wait(4000)
        swings.append(swing(bench, 1000))
    assert abs(number(bench, "_TEX")) <= 1
    assert swings[0] > 10  # counts of the load, for ever
    assert swings[1] <= 2


def test_sampled_dual_loop_of_the_manual_corrects_the_play() -> None:
    # l.2256-2280: four motor counts are one load count; the program corrects until the load is within 2 counts
    plant = Plant(backlash=80, auxiliary=Place.LOAD, auxiliary_ratio=0.25, viscous_friction=0.01)
    bench = Bench("ssc1", {"X": plant})
    bench.ask("SHX;KD 200;KP 20")
    program = """
#DUALOOP
CE 0
DE 0
PR 40000
BGX
#CORRECT
AMX
WT 500
V1=10000-_DEX
V2=_TEX/4+V1
JP#END,@ABS[V2]<2
PR V2*4
BGX
JP#CORRECT
#END
EN
"""
    assert bench.run(program) == "end"
    assert abs(number(bench, "_TDX") - 10000) <= 2
    assert number(bench, "_TPX") == pytest.approx(40040, abs=10)


def test_dead_time_costs_phase_until_the_loop_swings() -> None:
    # chapter 10's example has 64.5 degrees at 196 rad/s: each sample of dead time takes 196/1024 rad, 11 degrees
    swings = []
    for delay in (0, 3, 8):
        bench = Bench("ssc1", {"X": Plant(amplifier_gain=4.0, encoder_lines=500, delay_samples=delay)})
        bench.ask("SHX;KP 12.5;KD 245;ER 32767")
        bench.simulation.stimulus("position_x", 200)
        bench.wait(1000)
        swings.append(swing(bench, 300))
    assert swings[0] <= 2
    assert swings[1] <= 8  # 31 degrees left
    assert swings[2] > 100  # -23 degrees: it swings


def test_encoder_noise_is_normal_enough_and_white() -> None:
    bench = Bench("ssc1", {"X": Plant(encoder_noise=5.0, coulomb_friction=100.0)})
    noise = traced(bench, 8000)
    spread = math.sqrt(25 + 1 / 12)  # rounding to whole counts adds a twelfth
    assert noise.std() == pytest.approx(spread, rel=0.03)
    assert abs(noise.mean()) < 4 * spread / math.sqrt(8000)
    assert abs(numpy.corrcoef(noise[:-1], noise[1:])[0, 1]) < 0.05
    inside = (numpy.abs(noise) <= spread).mean()
    assert inside == pytest.approx(0.68, abs=0.05)


# ---------------------------------------------------------------- wrong polarity


def unstable_rate(kp: float, kd: float) -> float:
    """How fast the sampled loop with the wrong sign runs away, 1/s: its largest pole outside the circle."""
    gain = 0.1 / 2.0e-4 * SCALE / 1024**2 / 2 * 4 * VOLT
    poles = numpy.roots(numpy.polyadd([1, -2, 1, 0], -gain * numpy.polymul([kp + kd, -kd], [1, 1])))
    return float(math.log(max(abs(poles))) * 1024)


def test_wrong_polarity_runs_away_as_its_pole_says() -> None:
    bench = Bench("ssc1", {"X": Plant(encoder_lines=1000)})
    bench.ask("MT -1;SHX;ER 32767;TL 9.99")
    bench.simulation.stimulus("position_x", 3)
    errors = numpy.abs(traced(bench, 400))
    first, last = (int(numpy.argmax(errors > level)) for level in (60, 240))  # before the torque limit acts
    rate = math.log(errors[last] / errors[first]) / ((last - first) / 1024)
    assert rate == pytest.approx(unstable_rate(6, 64), rel=0.1)


@pytest.mark.parametrize("drive", [Drive.CURRENT, Drive.VOLTAGE, Drive.VELOCITY])
def test_a_run_away_is_caught_by_the_error_limit(drive: Drive) -> None:
    # l.633-673: with OE1 the motor is off as soon as |TE| passes ER; stop code 8, the amplifier is disabled
    bench = Bench("dmc1412", {"X": Plant(drive=drive, viscous_friction=0.001)})
    bench.ask("ER 2000;OE 1;MT -1;SH")
    bench.simulation.stimulus("position_x", 5)
    bench.wait(5000)
    assert number(bench, "_MO") == 1
    assert int(bench.ask("SC")) == 8
    assert not bench.simulation.motion.amplifier_enabled(0)
    assert int(number(bench, "_TS")) & 96 == 96  # error exceeded, motor off


# ---------------------------------------------------------------- stepper


@pytest.mark.parametrize("smoothing", [1, 2, 4, 8])
def test_step_pulses_lag_by_the_time_constant_of_ks(smoothing: int) -> None:
    # l.2147: KS 2 is a time constant of 6 samples; at a constant speed a single pole of 1/(3 KS) a sample lags
    # 3 KS - 1 samples behind what goes in
    bench = Bench("ssc1", {"X": Plant(drive=Drive.STEPPER)})
    bench.ask(f"MT 2;KS {smoothing};SHX;AC 1024000;JG 20480;BGX")
    bench.samples(400)
    lag = number(bench, "_RPX-_TDX")
    assert lag == pytest.approx(20 * (3 * smoothing - 1), abs=1)


def test_motion_is_complete_when_all_steps_are_out() -> None:
    # l.2155: AM ends with the profile, MC when as many steps are out as commanded
    bench = Bench("ssc1", {"X": Plant(drive=Drive.STEPPER)})
    bench.ask("MT 2;KS 8;SHX")
    bench.run("AC 1024000;DC 1024000;SP 40000\nPR 4000;BGX;AMX;A=_TDX;T=TIME\nMCX;B=_TDX;T=TIME-T;EN")
    assert (number(bench, "A") < 4000, number(bench, "B")) == (True, 4000)
    tail = 24 * math.log(2 * (4000 - number(bench, "A")))  # exp(-t/24) of the rest falls below half a step
    assert number(bench, "T") == pytest.approx(tail, rel=0.25)
