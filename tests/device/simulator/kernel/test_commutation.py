"""Sine commutation: zero by field, by halls, and what happens without (dmc-1412-1414.txt l.680-804)."""

from __future__ import annotations

import itertools
import math

import pytest

from device.simulator.motion import Event, Motion, Register
from device.simulator.plant import Plant


def brushless(**changes: object) -> Motion:
    values: dict[str, object] = {"viscous_friction": 0.002, "hall_inputs": 5} | changes
    motion = Motion(1, [Plant(**values)])  # type: ignore[arg-type]
    motion.set(0, Register.KD, 200)
    motion.set(0, Register.KP, 20)
    motion.set(0, Register.ERROR_LIMIT, 500)
    motion.set(0, Register.OFF_ON_ERROR, 1)
    motion.commutation.enable(0, True)
    motion.commutation.set_cycle(0, 4000 / 3)  # l.723: BM 1333.333
    motion.run(1)
    return motion


def moves_to(motion: Motion, target: int) -> bool:
    motion.servo_here(0)
    motion.begin_position(0, target)
    while motion.sample < 20_000:
        motion.run(4000)
        if Event.SWITCHED_OFF in [event for event, _ in motion.take_events()]:
            return False
    return abs(motion.position(0) - target) <= 2


def test_without_a_phase_the_loop_runs_away() -> None:
    assert not moves_to(brushless(), 2000)


@pytest.mark.parametrize("start", [0, 300, 500, -450])
def test_a_held_field_finds_the_zero(start: int) -> None:
    motion = brushless()
    motion.motor_off(0)
    motion.push(0, start)
    motion.commutation.hold(0, 2.0)
    motion.run(1500)
    assert motion.torque(0) == 2.0
    motion.commutation.release(0)
    assert not motion.motor_on(0)
    assert abs(motion.commutation.phase_error(0)) < 1.0
    assert abs(motion.commutation.counts_to_zero(0)) <= 1
    assert moves_to(motion, 3000)


def test_halls_give_the_phase_to_thirty_degrees_and_calibration_the_rest() -> None:
    motion = brushless(hall_offset=30.0)
    motion.commutation.set_hall_offset(0, 30.0)
    motion.commutation.set_hall_inputs(0, 5)
    motion.run(1)
    assert motion.commutation.estimate(0)
    assert abs(motion.commutation.phase_error(0)) <= 30.5
    motion.commutation.calibrate(0)
    assert moves_to(motion, 1500)
    assert not motion.commutation.calibrating(0)
    assert abs(motion.commutation.phase_error(0)) < 2.0


def test_calibration_in_reverse() -> None:
    motion = brushless()
    motion.commutation.set_hall_inputs(0, 5)
    motion.run(1)
    motion.commutation.estimate(0)
    motion.commutation.calibrate(0)
    assert moves_to(motion, -1500)
    assert abs(motion.commutation.phase_error(0)) < 2.0


def test_hall_inputs_go_through_six_patterns_a_cycle() -> None:
    motion = brushless()
    motion.motor_off(0)
    patterns = []
    for _ in range(120):
        motion.push(0, 4000 / 3 / 60)
        motion.run(1)
        bits = motion.inputs() >> 4 & 7
        if not patterns or patterns[-1] != bits:
            patterns.append(bits)
    assert len(set(patterns)) == 6
    assert 0 not in patterns
    assert 7 not in patterns
    assert 12 <= len(patterns) <= 13
    assert all((a ^ b).bit_count() == 1 for a, b in itertools.pairwise(patterns))


def test_swapped_wires_draw_the_rotor_backwards() -> None:
    # BS: the field turned by 90 degrees moves the rotor by a quarter cycle, backwards with swapped wires
    moved = {}
    for swapped in (False, True):
        motion = brushless(phases_swapped=swapped)
        motion.commutation.hold(0, 2.0, 0.0)
        motion.run(1500)
        before = motion.position(0)
        motion.commutation.hold(0, 2.0, 60.0)
        motion.run(1500)
        moved[swapped] = motion.position(0) - before
    assert moved[False] == pytest.approx(4000 / 18, abs=2)
    assert moved[True] == pytest.approx(-4000 / 18, abs=2)


def test_no_sensors_no_estimate() -> None:
    motion = brushless(hall_inputs=None)
    motion.commutation.set_hall_inputs(0, 5)
    motion.run(1)
    assert motion.commutation.sector(0) is None
    assert not motion.commutation.estimate(0)


def test_phase_and_cycle() -> None:
    motion = brushless()
    motion.commutation.set_phase(0, 90.0)
    assert motion.commutation.phase(0) == pytest.approx(90.0)
    assert motion.commutation.counts_to_zero(0) == 333
    motion.commutation.set_cycle(0, 2000)
    assert motion.commutation.phase(0) == pytest.approx(90.0)
    assert motion.commutation.counts_to_zero(0) == 500


def two_phases(volts: float, believed: float, rotor: float, offset: float, swapped: bool) -> float:
    """Volts that turn the motor: two windings a quarter of a cycle apart, each drawn to its own axis (l.707-715)."""
    lead = math.radians(believed + 90)
    first, second = volts * math.cos(lead), volts * math.sin(lead) + offset
    if swapped:
        first, second = second, first
    turn = math.radians(rotor)
    return -first * math.sin(turn) + second * math.cos(turn)


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("offset", [0.0, 0.7, -1.3])
def test_the_command_turns_as_two_phases_do(swapped: bool, offset: float) -> None:
    for place, believed in itertools.product((0, 217, 640, -1111), (0, 45, 123, 200, 301)):
        motion = Motion(1, [Plant(phases_swapped=swapped)])
        for register in (Register.KP, Register.KD):
            motion.set(0, register, 0)
        motion.set(0, Register.ERROR_LIMIT, 1e9)
        motion.commutation.enable(0, True)
        motion.commutation.set_cycle(0, 4000 / 3)
        motion.push(0, place)
        motion.run(1)
        motion.commutation.set_phase(0, believed)
        motion.commutation.set_offset(0, offset)
        motion.set(0, Register.OFFSET, 2.0)
        motion.run(1)
        rotor = believed - motion.commutation.phase_error(0)  # where the motor really is; its zero is arbitrary
        volts = two_phases(2.0, believed, rotor, offset, swapped)
        gain = 0.1 / 2.0e-4 * 4000 / (2 * math.pi)  # Ka Kt / J in counts/s² a volt (l.4394, 4445)
        assert motion.velocity_now(0) == pytest.approx(gain * volts / 1024, abs=1 + 0.01 * gain / 1024)
