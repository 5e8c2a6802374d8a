"""Starting, changing and stopping moves of single axes."""

from __future__ import annotations

from device.simulator.kernel import layout, profile
from device.simulator.kernel.layout import State, axis_base
from device.simulator.readings import Readings, wrapped
from device.simulator.registers import Register, write_register
from device.simulator.sequence import Path


class Moves(Readings):
    """What the commands of independent motion do."""

    path: Path

    def set(self, axis: int, register: Register, value: float) -> None:
        """Sets a register, in the manual's unit."""
        write_register(self._state, axis_base(axis), register, float(value))

    def get(self, axis: int, register: Register) -> float:
        """What was set."""
        return self._state[axis_base(axis) + register]

    def set_limit_polarity(self, active_high: bool) -> None:
        """CN, first field: the level at which the limit inputs stop an axis."""
        for axis in range(self.axes):
            self._state[axis_base(axis) + layout.LIMIT_ACTIVE_LEVEL] = 1.0 if active_high else 0.0

    def _begin(self, axis: int, mode: int, direction: float) -> State:
        part = self._parts[axis]
        part[layout.MODE] = mode
        part[layout.MOVING] = 1.0
        part[layout.VELOCITY_V] = 0.0
        part[layout.DIRECTION] = direction
        part[layout.START] = part[layout.MARK] = part[layout.POSITION]
        part[layout.DISTANCE] = part[layout.MARK_DISTANCE] = 0.0
        part[layout.STAGE] = layout.STAGE_NONE
        part[layout.STOP_CODE] = 0.0
        part[layout.AT_SPEED] = part[layout.IN_POSITION] = 0.0
        part[layout.SETTLING] = -1.0  # the time of MC begins with the end of this move
        return part

    def begin_position(self, axis: int, target: int) -> None:
        """Starts a move to `target`, as RP will read at its end."""
        way = target - self._parts[axis][layout.REFERENCE]
        part = self._begin(axis, layout.MODE_POSITION, float((way > 0) - (way < 0)))
        part[layout.TARGET] = float(target)

    def begin_jog(self, axis: int) -> None:
        """Starts a jog at the jog speed, which may change at any time."""
        speed = self.get(axis, Register.JOG_SPEED)
        self._begin(axis, layout.MODE_JOG, -1.0 if speed < 0.0 else 1.0)

    def _begin_stage(self, axis: int, stage: int, direction: float, speed: float) -> None:
        part = self._begin(axis, layout.MODE_JOG, direction)
        part[layout.STAGE] = stage
        part[layout.STAGE_LEVEL] = part[layout.HOME_LEVEL]
        part[layout.SLEW_V] = speed * direction

    def begin_edge(self, axis: int, home: bool) -> None:
        """FE: with `home` (the `_HM` value) 1 in reverse, else forward, until the home input changes."""
        self._begin_stage(axis, layout.STAGE_EDGE, -1.0 if home else 1.0, self.get(axis, Register.SPEED))

    def begin_home(self, axis: int, home: bool) -> None:
        """HM: to the home switch, back off it, and forward to the index, which becomes 0."""
        self._begin_stage(axis, layout.STAGE_HOME_SEARCH, -1.0 if home else 1.0, self.get(axis, Register.SPEED))

    def begin_index(self, axis: int, speed: float, direction: int) -> None:
        """FI: at `speed` until the index pulse, whose place becomes 0."""
        self._begin_stage(axis, layout.STAGE_INDEX, float(direction), abs(speed))

    def increment(self, axis: int, counts: int) -> bool:
        """IP in a move: a new target, or a step of a jog; False where that is not possible (error 16)."""
        state, b = self._state, axis_base(axis)
        mode = state[b + layout.MODE]
        if mode == layout.MODE_JOG and state[b + layout.STAGE] == layout.STAGE_NONE:
            profile.step_by(self._parts[axis], counts)
            state[b + layout.SMOOTHED_LAST] += counts
            return True
        ending = mode == layout.MODE_SETTLING and state[b + layout.STOP_CODE] == 1.0
        if not (mode == layout.MODE_POSITION or ending) or counts * state[b + layout.DIRECTION] < 0:
            return False
        state[b + layout.TARGET] += counts
        state[b + layout.MODE] = layout.MODE_POSITION
        state[b + layout.STOP_CODE] = 0.0
        return True

    def stop(self, axis: int, code: int = 4) -> None:
        """Decelerates at DC (a path with VD) and ends gearing, cam and contour of the axis."""
        state, b = self._state, axis_base(axis)
        for slot in (layout.GEAR_RATIO, layout.CAM_ENGAGED, layout.CAM_WAITS, layout.IN_CONTOUR, layout.CONTOUR_STEP):
            state[b + slot] = 0.0
        if not state[b + layout.MOVING]:
            return
        state[b + layout.STAGE] = layout.STAGE_NONE
        mode = state[b + layout.MODE]
        state[b + layout.STOP_CODE] = float(code)
        if mode == layout.MODE_IDLE:
            state[b + layout.MOVING] = 0.0
        elif mode == layout.MODE_PATH:
            self.path.stop(code)
        elif mode != layout.MODE_SETTLING:
            state[b + layout.MODE] = layout.MODE_STOPPING

    def abort(self, axis: int, code: int = 7) -> None:
        """RP stays where it is; with OE 1 the motor goes off."""
        state, b = self._state, axis_base(axis)
        if state[b + layout.MOVING]:
            state[b + layout.STOP_CODE] = float(code)
        profile.freeze(self._parts[axis])
        if state[b + layout.OFF_ON_ERROR]:
            self.motor_off(axis)

    def stop_all(self, code: int = 4) -> None:
        """Stops every axis."""
        for axis in range(self.axes):
            self.stop(axis, code)

    def abort_all(self, code: int = 7) -> None:
        """Freezes every axis."""
        for axis in range(self.axes):
            self.abort(axis, code)

    def _stand_at(self, b: int, counts: float) -> None:
        """RP and everything that goes with it is `counts`; axes that follow this one see no movement."""
        state = self._state
        state[b + layout.POSITION_SHIFT] += counts - state[b + layout.POSITION]
        for slot in (layout.POSITION, layout.SMOOTHED, layout.SMOOTHED_LAST, layout.REFERENCE, layout.TARGET):
            state[b + slot] = counts
        state[b + layout.START] = state[b + layout.MARK] = counts

    def define_position(self, axis: int, counts: int) -> None:
        """DP: RP, and TP (a stepper's step count), read `counts` from now on."""
        state, b = self._state, axis_base(axis)
        self._stand_at(b, float(counts))
        if state[b + layout.STEPPER]:
            state[b + layout.STEPS_SHIFT] += counts - state[b + layout.STEPS]
            state[b + layout.STEPS] = state[b + layout.STEPS_SMOOTH] = float(counts)
        else:
            self._set_actual(b, float(counts))
            state[b + layout.ERROR] = state[b + layout.LAST_ERROR] = 0.0

    def _set_actual(self, b: int, counts: float) -> None:
        state = self._state
        state[b + layout.COUNTS_SHIFT] = counts - state[b + layout.COUNTS]
        state[b + layout.ACTUAL] = counts

    def define_auxiliary(self, axis: int, counts: int) -> None:
        """DE: the auxiliary encoder (a stepper's main encoder) reads `counts` from now on."""
        state, b = self._state, axis_base(axis)
        if state[b + layout.STEPPER]:
            self._set_actual(b, float(counts))
        else:
            state[b + layout.AUXILIARY_SHIFT] = counts - state[b + layout.AUXILIARY_COUNTS]
            state[b + layout.AUXILIARY] = float(counts)

    def servo_here(self, axis: int) -> None:
        """SH: commanded becomes actual position, and the loop is closed."""
        state, b = self._state, axis_base(axis)
        state[b + layout.MOTOR_ON] = 1.0
        if state[b + layout.STEPPER]:
            return
        here = float(wrapped(state[b + layout.ACTUAL]))
        self._set_actual(b, here)
        self._stand_at(b, here)
        state[b + layout.INTEGRAL] = state[b + layout.ERROR] = state[b + layout.LAST_ERROR] = 0.0
        state[b + layout.ERROR_HIGH] = 0.0

    def motor_off(self, axis: int) -> None:
        """MO: the loop is open, the amplifier disabled, OF stays at the output."""
        state, b = self._state, axis_base(axis)
        state[b + layout.MOTOR_ON] = 0.0
        state[b + layout.INTEGRAL] = 0.0
        state[b + layout.COMMAND] = state[b + layout.OFFSET] * state[b + layout.OUTPUT_SIGN]

    def set_stop_code(self, axis: int, code: int) -> None:
        """SC, where the host decides it (99: MC time-out)."""
        self._state[axis_base(axis) + layout.STOP_CODE] = float(code)
