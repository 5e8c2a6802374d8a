"""What a move will look like with given gains: the sampled loop run over a plant, limits and counting included."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy

from device.simulator.kernel.servo import ACCELERATION_VOLTS, VELOCITY_VOLTS
from device.tuning.loop import VOLTS, Gains
from device.tuning.metrics import Response
from device.tuning.plant import AxisPlant, Vector, held, rates

PARTS = 4  # steps of the machine in a sample: friction and delay change between them
SPEED_UNIT = 1024.0  # samples a second at TM 1000: a commanded speed is the change in a sample times this


@dataclass
class Machine:
    """The plant in motion."""

    plant: AxisPlant
    transition: Vector
    added: Vector  # columns: motor torque, weight
    row: Vector  # what pulls at the motor, in volts, from the states
    output: Vector
    state: Vector

    def advance(self, volts: float) -> None:
        """One part of a sample; friction holds a motor that comes to rest."""
        plant, before = self.plant, float(self.state[1])
        torque = volts
        stuck = False
        if plant.coulomb > 0.0:
            if before == 0.0:
                pull = float(self.row @ self.state) + volts - (0.0 if plant.resonance else plant.gravity)
                stuck = abs(pull) <= plant.coulomb
                torque -= pull if stuck else math.copysign(plant.coulomb, pull)
            else:
                torque -= math.copysign(plant.coulomb, before)
        place = float(self.state[0])
        self.state = self.transition @ self.state + self.added[:, 0] * torque - self.added[:, 1] * plant.gravity
        if stuck:
            self.state[0], self.state[1] = place, 0.0
        elif plant.coulomb > 0.0 and float(self.state[1]) * before < 0.0:
            self.state[1] = 0.0

    def counts(self) -> float:
        """The encoder, in whole counts."""
        return math.floor(float(self.output @ self.state) + 0.5)


def machine(plant: AxisPlant, period: float, place: float) -> Machine:
    """At rest at `place`, the spring bent by the weight."""
    a, motor, load, output = rates(plant)
    transition, added = held(a, numpy.column_stack([motor, load]), period / PARTS)
    state = numpy.zeros(len(a))
    state[0] = place
    if plant.resonance is not None:
        stiff_load = a[3, 0]
        state[2] = place - float(load[3]) * plant.gravity / stiff_load
        if plant.resonance.on_load:
            state[0], state[2] = place + (place - state[2]), place
    return Machine(plant, transition, added, a[1] / motor[1], output, state)


def step(counts: int, samples: int, at: int = 0) -> Vector:
    """Commanded positions of an ideal step."""
    found = numpy.zeros(samples)
    found[at:] = counts
    return found


def predict(plant: AxisPlant, gains: Gains, commanded: Vector, period: float) -> Response:
    """Position and motor command of every sample, from rest at the first commanded position."""
    holding = plant.gravity
    integral = holding if gains.ki else gains.offset
    sag = (holding - integral) / (VOLTS * 4.0 * gains.kp) if gains.kp and not gains.ki else 0.0
    axis = machine(plant, period, float(commanded[0]) - sag if len(commanded) else 0.0)
    late = max(0, round(plant.delay / period * PARTS))
    pipe = [holding] * late
    actual, volts = numpy.zeros(len(commanded)), numpy.zeros(len(commanded))
    last_error, last_place, last_speed = sag, float(commanded[0]) if len(commanded) else 0.0, 0.0
    limit = abs(gains.integrator_limit)
    for n, place in enumerate(commanded.tolist()):
        actual[n] = axis.counts()
        error = place - actual[n]
        if n == 0:
            last_error = error
        speed = (place - last_place) * SPEED_UNIT
        integral = max(-limit, min(limit, integral + 0.5 * gains.ki * error * VOLTS)) if gains.ki else integral
        torque = VOLTS * (4.0 * gains.kp * error + 4.0 * gains.kd * (error - last_error)) + integral
        torque += VELOCITY_VOLTS * gains.fv * speed + ACCELERATION_VOLTS * gains.fa * (speed - last_speed) * SPEED_UNIT
        torque = max(-gains.torque_limit, min(gains.torque_limit, torque))
        last_error, last_place, last_speed = error, place, speed
        volts[n] = torque
        for _ in range(PARTS):
            pipe.append(torque)
            axis.advance(pipe.pop(0))
    return Response(period, commanded.astype(float), actual, volts)
