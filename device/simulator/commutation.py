"""The host's side of sine commutation (BA, BB, BC, BD, BI, BM, BS, BZ; dmc-1412-1414.txt l.680-804)."""

from __future__ import annotations

import math
from collections.abc import Sequence

from device.simulator.kernel import commutation, layout
from device.simulator.kernel.layout import State
from device.simulator.plant import Plant

START_ANGLE = 130.0  # degrees: where a motor happens to stand at power-up; without a set phase its loop runs away


class Commutation:
    """Phase of brushless axes."""

    def __init__(self, state: State, parts: Sequence[State], plants: Sequence[Plant]) -> None:
        self._state = state
        self._parts = parts
        for part, plant in zip(parts, plants, strict=True):
            part[layout.MAGNETIC_CYCLE] = plant.magnetic_cycle
            part[layout.MAGNETIC_ZERO] = START_ANGLE
            part[layout.WIRES_SWAPPED] = float(plant.phases_swapped)
            part[layout.HALL_FIRST] = float(plant.hall_inputs or 0)
            part[layout.HALL_ANGLE] = plant.hall_offset
            for wire, number in enumerate(plant.hall_order):
                part[layout.HALL_ORDER + wire] = float(number)
            part[layout.PHASE_CYCLE] = 2000.0
            part[layout.HALL_SECTOR] = -1.0

    def enable(self, axis: int, on: bool) -> None:
        """BA: the axis has two phase signals; off, its amplifier commutates."""
        self._parts[axis][layout.PHASE_MODE] = 1.0 if on else 0.0

    def enabled(self, axis: int) -> bool:
        """The axis was named in BA."""
        return self._parts[axis][layout.PHASE_MODE] != 0.0

    def set_cycle(self, axis: int, counts: float) -> None:
        """BM: counts of a magnetic cycle; the phase of now stays."""
        phase = self.phase(axis)
        self._parts[axis][layout.PHASE_CYCLE] = counts
        self.set_phase(axis, phase)

    def set_hall_offset(self, axis: int, degrees: float) -> None:
        """BB: from commutation zero to the sensors' zero."""
        self._parts[axis][layout.PHASE_HALL_OFFSET] = degrees

    def set_hall_inputs(self, axis: int, first: int) -> None:
        """BI: the first of the three inputs, 0 for none."""
        self._parts[axis][layout.PHASE_HALLS] = float(first)
        self._parts[axis][layout.HALL_SECTOR] = -1.0

    def set_offset(self, axis: int, volts: float) -> None:
        """BO: volts added to the second of the two signals."""
        self._parts[axis][layout.PHASE_OFFSET] = volts

    def set_phase(self, axis: int, degrees: float) -> None:
        """BD: the phase of the place where the axis is."""
        part = self._parts[axis]
        part[layout.PHASE_ZERO] = part[layout.COUNTS] - degrees * part[layout.PHASE_CYCLE] / 360.0

    def phase(self, axis: int) -> float:
        """_BD: 0 up to 360 degrees."""
        return commutation.believed_angle(self._parts[axis]) % 360.0

    def phase_error(self, axis: int) -> float:
        """How far the believed phase is from the motor's, -180 to 180 degrees (only a simulator knows)."""
        part = self._parts[axis]
        apart = commutation.believed_angle(part) - commutation.true_angle(part)
        return (apart + 180.0) % 360.0 - 180.0

    def counts_to_zero(self, axis: int) -> int:
        """_BZ: counts from commutation zero to here, the short way; PR of its negative goes there."""
        turn = (self.phase(axis) + 180.0) % 360.0 - 180.0
        return round(turn * self._parts[axis][layout.PHASE_CYCLE] / 360.0)

    def sector(self, axis: int) -> int | None:
        """_BC: which sixth of the cycle the hall inputs show; None where they show none (error 110)."""
        value = int(self._parts[axis][layout.HALL_SECTOR])
        return None if value < 0 else value

    def hall_mask(self) -> int:
        """The input bits that hall sensors drive."""
        return sum(7 << int(part[layout.HALL_FIRST]) - 1 for part in self._parts if part[layout.HALL_FIRST] > 0.0)

    def estimate(self, axis: int) -> bool:
        """At reset: the phase from the hall sensors, good to 30 degrees; False without them."""
        commutation.read_halls(self._state, self._parts[axis])
        sector = self.sector(axis)
        if sector is None:
            return False
        self.set_phase(axis, 60.0 * sector + 30.0 + self._parts[axis][layout.PHASE_HALL_OFFSET])
        return True

    def calibrate(self, axis: int) -> None:
        """BC: sets the phase at the next hall transition."""
        self._parts[axis][layout.PHASE_CALIBRATE] = 1.0

    def calibrating(self, axis: int) -> bool:
        """BC still waits for a transition."""
        return self._parts[axis][layout.PHASE_CALIBRATE] != 0.0

    def hold(self, axis: int, volts: float, degrees: float = 0.0) -> None:
        """BZ, BS: a field held still at an angle draws the rotor there; critically damped, as windings and iron do."""
        part = self._parts[axis]
        strength = abs(volts)
        stiffness = part[layout.GAIN_A] * strength * 2.0 * math.pi / part[layout.MAGNETIC_CYCLE]
        part[layout.PHASE_DAMPING] = 2.0 * math.sqrt(stiffness) / part[layout.GAIN_A]
        part[layout.PHASE_VOLTS], part[layout.PHASE_HELD] = strength, degrees
        part[layout.PHASE_MODE] = 2.0
        part[layout.MOTOR_ON] = 1.0

    def release(self, axis: int) -> None:
        """Ends `hold`: the phase here is the held angle. The axis is left motor off; SH is the caller's."""
        part = self._parts[axis]
        if part[layout.PHASE_MODE] == 2.0:
            part[layout.PHASE_MODE] = 1.0
            part[layout.MOTOR_ON] = 0.0
            part[layout.COMMAND] = part[layout.INTEGRAL] = 0.0
            self.set_phase(axis, part[layout.PHASE_HELD])
