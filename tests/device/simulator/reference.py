"""A second, independent account of servo and machine, in SI units, to compare with: the equations of chapter 10.

Nothing here is shared with the simulator but the description of the machine. One sample is cut into many steps of the
classical Runge-Kutta method; the simulator works with matrix exponentials instead.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy
from numpy.typing import NDArray

from device.simulator.plant import Drive, Place, Plant

VOLT = 20 / 65536  # of one count of the converter (dmc-1412-1414.txt l.4451)
PERIOD = 1 / 1024  # s at TM 1000
State = tuple[float, float, float, float, float]  # motor angle and speed, current, load angle and speed


@dataclass(frozen=True)
class Gains:
    """The filter's parameters by their names on the controller."""

    kp: float = 6.0
    kd: float = 64.0
    ki: float = 0.0
    torque_limit: float = 9.9982
    dual: bool = False


def counts_a_radian(plant: Plant) -> float:
    """Kf = 4N / 2π (l.4440)."""
    return 4 * plant.encoder_lines / (2 * math.pi)


def is_coupled(plant: Plant) -> bool:
    return plant.load_inertia > 0 and plant.coupling_stiffness > 0


class Machine:
    """One axis, integrated."""

    def __init__(self, plant: Plant, steps: int = 40, period: float = PERIOD) -> None:
        self.plant, self.steps, self.period = plant, steps, period
        self.state: State = (0.0, 0.0, 0.0, 0.0, 0.0)
        self._pipe = [0.0] * plant.delay_samples

    def counts(self, place: Place) -> float:
        """Where motor or load are."""
        angle = self.state[3] if place is Place.LOAD else self.state[0]
        return angle * counts_a_radian(self.plant)

    def motor_torque(self, state: State, volts: float) -> tuple[float, float]:
        """N·m at the shaft, and the change of the current in A/s."""
        p, (_, speed, current, _, _) = self.plant, state
        if p.drive is Drive.VOLTAGE and p.inductance > 0:
            change = (p.amplifier_gain * volts - p.resistance * current - p.torque_constant * speed) / p.inductance
            return p.torque_constant * current, change
        if p.drive is Drive.VOLTAGE:
            current = (p.amplifier_gain * volts - p.torque_constant * speed) / p.resistance
        elif p.drive is Drive.VELOCITY:
            current = p.amplifier_gain * (volts - p.tachometer_gain * speed)
        else:
            current = p.amplifier_gain * volts
        return p.torque_constant * max(-p.peak_current, min(p.peak_current, current)), 0.0

    def weight(self) -> float:
        """Torque of gravity, N·m: that of `gravity` volts at standstill."""
        p = self.plant
        gain = p.amplifier_gain * p.torque_constant / (p.resistance if p.drive is Drive.VOLTAGE else 1.0)
        return gain * p.gravity

    def coupling(self, state: State) -> float:
        """Torque from motor to load; none within the play."""
        p, (angle, speed, _, load, load_speed) = self.plant, state
        play = 0.5 * p.backlash / counts_a_radian(p)
        twist = angle - load
        if abs(twist) <= play and play > 0:
            return 0.0
        twist -= math.copysign(play, twist)
        return p.coupling_stiffness * twist + p.coupling_damping * (speed - load_speed)

    def rates(self, state: State, volts: float, friction: float) -> State:
        """The differential equations; `friction` is the Coulomb torque that acts now."""
        p, (_, speed, _, _, load_speed) = self.plant, state
        torque, change = self.motor_torque(state, volts)
        torque += friction - p.viscous_friction * speed
        if is_coupled(p):
            between = self.coupling(state)
            load_a = (between - self.weight()) / p.load_inertia
            return speed, (torque - between) / p.inertia, change, load_speed, load_a
        a = (torque - self.weight()) / (p.inertia + p.load_inertia)
        return speed, a, change, speed, a

    def friction(self, state: State, volts: float) -> float:
        """Coulomb's torque: against the motion, or against what pulls while it stands."""
        most = self.plant.coulomb_friction
        if most == 0:
            return 0.0
        if state[1] != 0:
            return -math.copysign(most, state[1])
        torque, _ = self.motor_torque(state, volts)
        pull = torque - (self.coupling(state) if is_coupled(self.plant) else self.weight())
        return -max(-most, min(most, pull))

    def step(self, volts: float, h: float) -> None:
        """One Runge-Kutta step; friction holds a motor that comes to rest."""
        s, friction = self.state, self.friction(self.state, volts)

        def at(rate: State, part: float) -> State:
            a, b, c, d, e = (value + part * change for value, change in zip(s, rate, strict=True))
            return a, b, c, d, e

        k1 = self.rates(s, volts, friction)
        k2 = self.rates(at(k1, h / 2), volts, friction)
        k3 = self.rates(at(k2, h / 2), volts, friction)
        k4 = self.rates(at(k3, h), volts, friction)
        mean = [(a + 2 * b + 2 * c + d) / 6 for a, b, c, d in zip(k1, k2, k3, k4, strict=True)]
        angle, speed, current, load, load_speed = (value + h * change for value, change in zip(s, mean, strict=True))
        if self.plant.coulomb_friction > 0 and speed * s[1] < 0:
            speed = 0.0
        self.state = (angle, speed, current, load, load_speed)

    def advance(self, volts: float) -> None:
        """One sample with the motor command held."""
        self._pipe.append(volts)
        volts = self._pipe.pop(0)
        if self.plant.torque_ripple:
            turns = 6 * self.counts(Place.MOTOR) / self.plant.magnetic_cycle  # six ripples a magnetic cycle
            volts *= 1 + self.plant.torque_ripple * math.sin(2 * math.pi * turns)
        for _ in range(self.steps):
            self.step(volts, self.period / self.steps)


def closed_loop(machine: Machine, gains: Gains, references: Sequence[float]) -> NDArray[numpy.float64]:
    """Encoder positions at the samples under u = 4KP e + 4KD (e - e1) + KI/2 Σe (l.4454-4476)."""
    plant, seen, last, total = machine.plant, [], 0.0, 0.0
    for reference in references:
        position = math.floor(machine.counts(plant.main) + 0.5)
        seen.append(position)
        error = reference - position
        damped = error
        if gains.dual:
            damped = reference - math.floor(machine.counts(plant.auxiliary) + 0.5)
        total += gains.ki / 2 * error
        volts = VOLT * (4 * gains.kp * error + 4 * gains.kd * (damped - last) + total)
        last = damped
        machine.advance(max(-gains.torque_limit, min(gains.torque_limit, volts)))
    return numpy.array(seen, dtype=float)


# ---------------------------------------------------------------- frequency domain, linear machines


def matrices(plant: Plant) -> tuple[NDArray[numpy.float64], NDArray[numpy.float64]]:
    """x' = A x + B u of the differential equations above, u in volts of command."""
    machine = Machine(plant)
    zero: State = (0.0, 0.0, 0.0, 0.0, 0.0)
    columns = []
    for place in range(5):
        unit = tuple(1.0 if place == i else 0.0 for i in range(5))
        columns.append(machine.rates(unit, 0.0, 0.0))  # type: ignore[arg-type]
    return numpy.array(columns).T, numpy.array(machine.rates(zero, 1.0, 0.0))


def held(a: NDArray[numpy.float64], b: NDArray[numpy.float64], period: float) -> tuple[NDArray[numpy.float64], ...]:
    """The sampled system behind a zero-order hold: the exponential of [[A, B], [0, 0]] T by squaring a short series."""
    size = len(a) + 1
    whole = numpy.zeros((size, size))
    whole[:-1, :-1], whole[:-1, -1] = a * period, b * period
    halvings = 20
    small = whole / 2**halvings
    result = numpy.eye(size) + small + small @ small / 2 + small @ small @ small / 6
    for _ in range(halvings):
        result = result @ result
    return result[:-1, :-1], result[:-1, -1]


def loop_response(plant: Plant, gains: Gains, omega: float, period: float = PERIOD) -> complex:
    """The exact open loop of filter, hold, machine and encoder at one frequency, without the minus of the feedback."""
    transition, drive = held(*matrices(plant), period)
    z = complex(math.cos(omega * period), math.sin(omega * period))
    x = numpy.linalg.solve(z * numpy.eye(5) - transition, drive)
    angle = x[3] if plant.main is Place.LOAD else x[0]
    filtered = 4 * gains.kp + 4 * gains.kd * (1 - 1 / z) + gains.ki / 2 / (1 - 1 / z)
    found: complex = filtered * VOLT * angle * counts_a_radian(plant) * z**-plant.delay_samples
    return found
