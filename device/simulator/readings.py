"""What can be read of the motion: positions, speeds, volts, flags, switches."""

from __future__ import annotations

import math
from collections.abc import Sequence

from device.simulator.kernel import inputs, layout
from device.simulator.kernel.layout import State


def wrapped(value: float) -> int:
    """A position as the controller's 32 bits hold it."""
    return (int(value) + 2**31) % 2**32 - 2**31


class Readings:
    """Reads of a motion state; changes nothing."""

    _state: State
    _parts: Sequence[State]
    axes: int

    def _read(self, axis: int, slot: int) -> float:
        return self._parts[axis][slot]

    def _flag(self, axis: int, slot: int) -> bool:
        return self._parts[axis][slot] != 0.0

    def position(self, axis: int) -> int:
        """TP: main encoder, counts."""
        return wrapped(self._encoder(axis))

    def _encoder(self, axis: int) -> float:
        """The encoder as this sample began; with READ_LATE as it is at its end (without noise)."""
        part = self._parts[axis]
        if not part[layout.READ_LATE] or part[layout.ANALOG_FEEDBACK]:
            return part[layout.ACTUAL]
        place = part[layout.LOAD_X if part[layout.MAIN_ON_LOAD] else layout.MOTOR_X]
        raw = float(math.floor(place + 0.5))
        if part[layout.DEAD_CHANNEL]:
            raw = inputs.toggled(raw, part[layout.DEAD_CHANNEL])
        return raw * part[layout.ENCODER_SIGN] + part[layout.COUNTS_SHIFT]

    def reference(self, axis: int) -> int:
        """RP: commanded position, counts (behind the IT filter)."""
        return wrapped(self._parts[axis][layout.REFERENCE])

    def target(self, axis: int) -> int:
        """Where a running PA or PR move ends; RP of any other axis."""
        moving = self._read(axis, layout.MODE) == layout.MODE_POSITION
        return wrapped(self._read(axis, layout.TARGET)) if moving else self.reference(axis)

    def error(self, axis: int) -> int:
        """TE: RP - TP, 0 for a stepper."""
        if self._flag(axis, layout.STEPPER):
            return 0
        return int(self._read(axis, layout.REFERENCE) - self._encoder(axis))

    def auxiliary(self, axis: int) -> int:
        """TD: auxiliary encoder of a servo, steps sent of a stepper."""
        return wrapped(self._read(axis, layout.STEPS if self._flag(axis, layout.STEPPER) else layout.AUXILIARY))

    def velocity(self, axis: int) -> float:
        """TV: mean over 0.25 s, counts/s."""
        return self._read(axis, layout.MOVED) * 4.0

    def velocity_now(self, axis: int) -> float:
        """The machine's true speed, counts/s of the main encoder."""
        slot = layout.LOAD_V if self._flag(axis, layout.MAIN_ON_LOAD) else layout.MOTOR_V
        return self._read(axis, slot) * self._read(axis, layout.ENCODER_SIGN)

    def commanded_velocity(self, axis: int) -> float:
        """Speed of the commanded position in the last sample, counts/s."""
        return self._read(axis, layout.COMMANDED_V)

    def torque(self, axis: int) -> float:
        """TT: motor command, V."""
        return self._read(axis, layout.COMMAND)

    def moving(self, axis: int) -> bool:
        """The profile runs (the IT filter's tail included)."""
        return self._parts[axis][layout.MOVING] != 0.0

    def jogging(self, axis: int) -> bool:
        """In a jog that has not been stopped."""
        stage = self._read(axis, layout.STAGE)
        return self._read(axis, layout.MODE) == layout.MODE_JOG and stage == layout.STAGE_NONE

    def stopping(self, axis: int) -> bool:
        """Decelerating by ST or a limit."""
        return self._read(axis, layout.MODE) == layout.MODE_STOPPING

    def motor_on(self, axis: int) -> bool:
        """The loop is closed."""
        return self._flag(axis, layout.MOTOR_ON)

    def amplifier_enabled(self, axis: int) -> bool:
        """AEN."""
        return self.motor_on(axis)

    def error_exceeded(self, axis: int) -> bool:
        """|TE| > ER, as a level."""
        return self._flag(axis, layout.ERROR_HIGH)

    def stop_code(self, axis: int) -> int:
        """SC."""
        return int(self._read(axis, layout.STOP_CODE))

    def in_position(self, axis: int) -> bool:
        """The profile is done and the encoder has reached or passed its end."""
        return self._flag(axis, layout.IN_POSITION)

    def driving_into_limit(self, axis: int) -> int:
        """1 or -1 while the axis is driven into an active forward or reverse limit, else 0."""
        return (0, 1, -1)[int(self._read(axis, layout.LIMIT_NOW))]

    def blocked(self, axis: int, direction: float) -> bool:
        """A switch or software limit refuses motion in this direction (error 22)."""
        if direction > 0:
            return inputs.forward_blocked(self._parts[axis])
        return direction < 0 and inputs.reverse_blocked(self._parts[axis])

    def forward_level(self, axis: int) -> bool:
        """Level of the forward limit input."""
        return self._flag(axis, layout.FORWARD_LEVEL)

    def reverse_level(self, axis: int) -> bool:
        """Level of the reverse limit input."""
        return self._flag(axis, layout.REVERSE_LEVEL)

    def home_level(self, axis: int) -> bool:
        """Level of the home input."""
        return self._flag(axis, layout.HOME_LEVEL)

    def inputs(self) -> int:
        """The byte TI shows."""
        return int(self._state[layout.INPUTS])

    def analog(self, number: int) -> float:
        """Volts at analog input 1..8."""
        return self._state[layout.ANALOG_1 + number - 1]

    def quiet(self) -> bool:
        """No watch tripped in the last run and no event waits to be taken."""
        return self._state[layout.TRIPS] == 0.0 and self._state[layout.EVENTS] == 0.0

    def latch_armed(self, axis: int) -> bool:
        """Armed and nothing captured yet."""
        return self._flag(axis, layout.LATCH_ARMED)

    def latched(self, axis: int) -> int:
        """RL: the captured position."""
        return wrapped(self._read(axis, layout.LATCHED))

    def status_word(self, axis: int) -> int:
        """The bits of `_NO` as recorded by RD (commands.md 4)."""
        mode, stage = self._read(axis, layout.MODE), self._read(axis, layout.STAGE)
        homing = stage >= layout.STAGE_HOME_SEARCH
        bits = (
            (15, self.moving(axis)),
            (14, mode == layout.MODE_POSITION),
            (12, stage == layout.STAGE_EDGE),
            (11, homing),
            (10, stage >= layout.STAGE_HOME_BACK),
            (9, stage in (layout.STAGE_HOME_INDEX, layout.STAGE_INDEX)),
            (8, mode == layout.MODE_PATH),
            (7, self._read(axis, layout.VELOCITY_V) < 0.0),
            (6, self._flag(axis, layout.IN_CONTOUR)),
            (5, self._flag(axis, layout.AT_SPEED)),
            (4, mode == layout.MODE_STOPPING),
            (3, mode == layout.MODE_POSITION and self.stop_code(axis) == 1),
            (2, self.latch_armed(axis)),
            (1, self._flag(axis, layout.OFF_ON_ERROR)),
            (0, not self.motor_on(axis)),
        )
        return sum(1 << bit for bit, on in bits if on)

    def slot(self, place: int) -> float:
        """What a slot of the motion holds."""
        return self._state[place]
