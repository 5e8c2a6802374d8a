"""The host's side of the sample loop: start and stop moves, wait for something, read, be the outside world."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntFlag

import numpy

from device.simulator.commutation import Commutation
from device.simulator.following import Cam, Contour
from device.simulator.kernel import angle, events, inputs, layout, profile
from device.simulator.kernel.compiled import Vector, as_state, loop_for
from device.simulator.kernel.layout import State, axis_base
from device.simulator.mechanics import write_period, write_plant
from device.simulator.outside import Outside
from device.simulator.plant import Plant
from device.simulator.readings import Readings, wrapped
from device.simulator.registers import Register, write_defaults, write_register
from device.simulator.sequence import Path
from device.simulator.watches import Watch, arm, release

__all__ = ["Event", "Motion", "Register", "Watch"]

TM_UNITS_PER_SECOND = 1_024_000.0


class Event(IntFlag):
    """What happened on an axis."""

    FORWARD_LIMIT = layout.EVENT_FORWARD_LIMIT
    REVERSE_LIMIT = layout.EVENT_REVERSE_LIMIT
    ERROR = layout.EVENT_ERROR
    SWITCHED_OFF = layout.EVENT_OFF
    HOMED = layout.EVENT_HOMED
    ABORT = layout.EVENT_ABORT


class Motion(Readings, Outside):
    """Profiler, servo and machine of one to four axes."""

    def __init__(self, axes: int, plants: Sequence[Plant] = (), *, seed: int = 0, compiled: bool | None = None) -> None:
        self.axes = axes
        self._loop, self.compiled = loop_for(compiled)
        self._array: Vector = numpy.zeros(layout.SIZE)
        self._state: State = as_state(self._array)
        self._parts = [layout.part(self._state, i) for i in range(axes)]
        self._no_trace: Vector = numpy.zeros(1)
        self._trace: Vector = self._no_trace
        self._plants = [plants[i] if i < len(plants) else Plant() for i in range(axes)]
        self._power_up(seed)
        self.path = Path(self._state, self._parts)
        self.cam = Cam(self._state, self._parts)
        self.contour = Contour(self._state, self._parts)
        self.commutation = Commutation(self._parts, self._plants)

    def _power_up(self, seed: int) -> None:
        state = self._state
        state[layout.AXES] = self.axes
        state[layout.PERIOD_T] = 1000.0 / TM_UNITS_PER_SECOND
        state[layout.RANDOM] = 1 + seed % (2**31 - 2)
        state[layout.ABORT_LEVEL] = 1.0
        state[layout.INPUTS] = 255.0
        for n in range(8):
            state[layout.INPUT_1 + n] = 1.0
        for n in range(layout.SINE_LENGTH + 1):
            state[layout.SINE + n] = angle.sine(360.0 * n / layout.SINE_LENGTH)
        for axis in range(self.axes):
            write_defaults(state, axis_base(axis))
            write_plant(state, axis_base(axis), self._plants[axis], state[layout.PERIOD_T])
            inputs.read_switches(self._parts[axis])

    # --- time -------------------------------------------------------------------------------------------------------
    def run(self, samples: int) -> int:
        """Runs up to `samples`; ends after the one in which an armed watch trips or a new event is raised."""
        return int(self._loop(self._array, self._trace, samples))

    @property
    def sample(self) -> int:
        """Samples since power-up."""
        return int(self._state[layout.SAMPLE])

    def set_sample_time(self, microseconds: float) -> None:
        """TM: the true length of a sample; a speed stays SP/1024 counts a sample."""
        self._state[layout.PERIOD_T] = microseconds / TM_UNITS_PER_SECOND
        for axis, plant in enumerate(self._plants):
            write_period(self._state, axis_base(axis), plant, self._state[layout.PERIOD_T])

    # --- registers --------------------------------------------------------------------------------------------------
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

    # --- moves ------------------------------------------------------------------------------------------------------
    def _begin(self, axis: int, mode: int, direction: float) -> int:
        state, b = self._state, axis_base(axis)
        state[b + layout.MODE] = mode
        state[b + layout.MOVING] = 1.0
        state[b + layout.VELOCITY_V] = 0.0
        state[b + layout.DIRECTION] = direction
        state[b + layout.START] = state[b + layout.MARK] = state[b + layout.POSITION]
        state[b + layout.DISTANCE] = state[b + layout.MARK_DISTANCE] = 0.0
        state[b + layout.STAGE] = layout.STAGE_NONE
        state[b + layout.STOP_CODE] = 0.0
        state[b + layout.AT_SPEED] = state[b + layout.IN_POSITION] = 0.0
        return b

    def begin_position(self, axis: int, target: int) -> None:
        """Starts a move to `target`, as RP will read at its end."""
        way = target - self._state[axis_base(axis) + layout.REFERENCE]
        b = self._begin(axis, layout.MODE_POSITION, float(numpy.sign(way)))
        self._state[b + layout.TARGET] = float(target)

    def begin_jog(self, axis: int) -> None:
        """Starts a jog at the jog speed, which may change at any time."""
        speed = self.get(axis, Register.JOG_SPEED)
        self._begin(axis, layout.MODE_JOG, -1.0 if speed < 0.0 else 1.0)

    def _begin_stage(self, axis: int, stage: int, direction: float, speed: float) -> None:
        b = self._begin(axis, layout.MODE_JOG, direction)
        self._state[b + layout.STAGE] = stage
        self._state[b + layout.STAGE_LEVEL] = self._state[b + layout.HOME_LEVEL]
        self._state[b + layout.SLEW_V] = speed * direction

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

    # --- waiting ----------------------------------------------------------------------------------------------------
    def watch(self, kind: Watch, axis: int = 0, value: float = 0.0) -> int:
        """Arms a watch and tests it at once; `run` returns after the sample in which it trips."""
        number = arm(self._state, kind, axis, value)
        events.test_watches(self._state)
        return number

    def tripped(self, number: int) -> bool:
        """The watch has tripped."""
        return self._state[layout.WATCH + layout.WATCH_STRIDE * number + layout.W_STATE] == 2.0

    def drop(self, number: int) -> None:
        """Frees a watch; a tripped AD or AR marks the place from which the next AR counts."""
        release(self._state, number)

    def take_events(self) -> list[tuple[Event, int]]:
        """What has happened since the last call, and forgets it."""
        taken = []
        for axis in range(self.axes):
            b = axis_base(axis)
            word = Event(int(self._state[b + layout.EVENT]))
            taken += [(event, axis) for event in word]
            self._state[b + layout.EVENT] = 0.0
        self._state[layout.EVENTS] = 0.0
        return taken

    # --- gearing and latch ------------------------------------------------------------------------------------------
    def set_gear_master(self, axis: int, kind: str, master: int = 0) -> None:
        """GA: what the axis follows; "main", "auxiliary", "commanded", "vector" or "none"."""
        slots = {"main": layout.COUNTS, "auxiliary": layout.AUXILIARY_COUNTS, "commanded": layout.TRAVEL}
        if kind == "none":
            slot = -1
        elif kind == "vector":
            slot = layout.PATH_SMOOTHED
        else:
            slot = axis_base(master) + slots[kind]
        b = axis_base(axis)
        self._state[b + layout.GEAR_MASTER] = float(slot)
        self._state[b + layout.GEAR_LAST] = self._state[slot] if slot >= 0 else 0.0

    def arm_latch(self, axis: int) -> None:
        """AL."""
        self._state[axis_base(axis) + layout.LATCH_ARMED] = 1.0

    def latch(self, axis: int) -> None:
        """The latch input's edge: captures the position once."""
        b = axis_base(axis)
        if self._state[b + layout.LATCH_ARMED]:
            self._state[b + layout.LATCH_ARMED] = 0.0
            self._state[b + layout.LATCHED] = self._state[b + layout.ACTUAL]

    # --- whole state ------------------------------------------------------------------------------------------------
    def snapshot(self) -> Vector:
        """Everything, as one copied array."""
        return self._array.copy()

    def restore(self, snapshot: Vector) -> None:
        """Back to a snapshot; the trace goes on where it is."""
        kept = self._array[layout.TRACE_CAPACITY : layout.TRACE_COUNTDOWN + 1].copy()
        self._array[:] = snapshot
        self._array[layout.TRACE_CAPACITY : layout.TRACE_COUNTDOWN + 1] = kept

    def trace(self, rows: int, every: int = 1) -> None:
        """Records every n-th sample into memory for `rows` rows, touched now; 0 ends it."""
        self._trace = numpy.ones(max(1, rows * layout.trace_columns(self.axes)))
        self._state[layout.TRACE_CAPACITY] = float(rows)
        self._state[layout.TRACE_EVERY] = float(every)
        self._state[layout.TRACE_COUNTDOWN] = 1.0
        self._state[layout.TRACE_ROWS] = 0.0

    def trace_rows(self) -> Vector:
        """The rows recorded so far (a view): sample, four columns an axis, inputs, outputs."""
        columns = layout.trace_columns(self.axes)
        rows = int(self._state[layout.TRACE_ROWS])
        return self._trace[: rows * columns].reshape(rows, columns)

    def trace_clear(self) -> None:
        """Starts the same memory again."""
        self._state[layout.TRACE_ROWS] = 0.0
