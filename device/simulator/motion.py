"""The host's side of the sample loop: start and stop moves, wait for something, read, be the outside world."""

from __future__ import annotations

import functools
from collections.abc import Collection, Sequence
from enum import IntFlag
from typing import TypeAlias

import numpy

from device.simulator.commutation import Commutation
from device.simulator.following import Cam, Contour
from device.simulator.kernel import angle, inputs, layout
from device.simulator.kernel.compiled import Vector, as_state
from device.simulator.kernel.layout import State, axis_base
from device.simulator.loops import SampleLoop, loop_for
from device.simulator.mechanics import write_period, write_plant
from device.simulator.moves import Moves
from device.simulator.outside import Outside
from device.simulator.plant import Plant
from device.simulator.registers import Register, write_defaults
from device.simulator.sequence import Path
from device.simulator.watches import Watch, arm, release

__all__ = ["Event", "Motion", "Register", "Watch"]

TM_UNITS_PER_SECOND = 1_024_000.0
Range: TypeAlias = tuple[int, float, float]  # slot, lowest, highest value


class Event(IntFlag):
    """What happened on an axis."""

    FORWARD_LIMIT = layout.EVENT_FORWARD_LIMIT
    REVERSE_LIMIT = layout.EVENT_REVERSE_LIMIT
    ERROR = layout.EVENT_ERROR
    SWITCHED_OFF = layout.EVENT_OFF
    HOMED = layout.EVENT_HOMED
    ABORT = layout.EVENT_ABORT


@functools.cache
def sine_table() -> tuple[float, ...]:
    """Sines of a whole turn and its first again; what they are is worked out once."""
    return tuple(angle.sine(360.0 * n / layout.SINE_LENGTH) for n in range(layout.SINE_LENGTH + 1))


class Motion(Moves, Outside):
    """Profiler, servo and machine of one to four axes."""

    def __init__(self, axes: int, plants: Sequence[Plant] = (), *, seed: int = 0, compiled: bool | None = None) -> None:
        self.axes = axes
        self._loop = loop_for(compiled)
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
        self.commutation = Commutation(self._state, self._parts, self._plants)

    def _power_up(self, seed: int) -> None:
        state = self._state
        state[layout.AXES] = self.axes
        state[layout.PERIOD_T] = 1000.0 / TM_UNITS_PER_SECOND
        state[layout.RANDOM] = 1 + seed % (2**31 - 2)
        state[layout.ABORT_LEVEL] = 1.0
        state[layout.INPUTS] = 255.0
        for n in range(8):
            state[layout.INPUT_1 + n] = 1.0
        for n, value in enumerate(sine_table()):
            state[layout.SINE + n] = value
        for axis in range(self.axes):
            write_defaults(state, axis_base(axis))
            write_plant(state, axis_base(axis), self._plants[axis], state[layout.PERIOD_T])
            inputs.read_switches(self._parts[axis])

    # --- time -------------------------------------------------------------------------------------------------------
    def run(self, samples: int) -> int:
        """Runs up to `samples`; ends after the one in which an armed watch trips or a new event is raised."""
        return int(self._loop.run(self._array, self._trace, samples))

    @property
    def compiled(self) -> bool:
        """The compiled loop runs; before it is ready the same source does as plain Python."""
        return self._loop.compiled

    def use(self, loop: SampleLoop) -> None:
        """Another loop from the next run on."""
        self._loop = loop

    @property
    def sample(self) -> int:
        """Samples since power-up."""
        return int(self._state[layout.SAMPLE])

    def set_sample_time(self, microseconds: float) -> None:
        """TM: the true length of a sample; a speed stays SP/1024 counts a sample."""
        self._state[layout.PERIOD_T] = microseconds / TM_UNITS_PER_SECOND
        for axis, plant in enumerate(self._plants):
            write_period(self._state, axis_base(axis), plant, self._state[layout.PERIOD_T])

    # --- waiting ----------------------------------------------------------------------------------------------------
    def watch(self, kind: Watch, axis: int = 0, value: float = 0.0) -> int:
        """Arms a watch and tests it at once; `run` returns after the sample in which it trips."""
        return arm(self._state, [(kind, axis, value)])[0]

    def watch_all(self, wanted: Sequence[tuple[Watch, int, float]]) -> tuple[int, ...]:
        """Arms several; `run` returns after the sample in which the last of them trips. Dropped together."""
        return tuple(arm(self._state, wanted))

    def tripped(self, number: int) -> bool:
        """The watch has tripped."""
        return self._state[layout.WATCH + layout.WATCH_STRIDE * number + layout.W_STATE] == 2.0

    def drop(self, number: int) -> None:
        """Frees a watch; a tripped AD or AR marks the place from which the next AR counts."""
        release(self._state, number)

    def guard(self, ranges: Collection[Range]) -> bool:
        """`run` returns after the sample in which one of these slots leaves its range; False: they are too many."""
        if len(ranges) > layout.MAXIMUM_GUARDS:
            return False
        for number, item in enumerate(ranges):
            for offset, value in enumerate(item):
                self._state[layout.GUARD + layout.GUARD_STRIDE * number + offset] = float(value)
        self._state[layout.GUARDS] = float(len(ranges))
        return True

    def guard_moves(self) -> None:
        """`run` returns after the sample in which an axis that moves comes to rest."""
        slots = [axis_base(axis) + layout.MOVING for axis in range(self.axes)]
        self.guard([(slot, 1.0, 1.0) for slot in slots if self._state[slot]])

    @property
    def guard_broken(self) -> bool:
        """A guarded slot has left its range."""
        return self._state[layout.GUARD_BROKEN] != 0.0

    def drop_guards(self) -> None:
        """Leaves no trace of them: a state does not tell how it was come by."""
        for slot in range(layout.GUARD, layout.GUARD + layout.GUARD_STRIDE * int(self._state[layout.GUARDS])):
            self._state[slot] = 0.0
        self._state[layout.GUARDS] = self._state[layout.GUARD_BROKEN] = 0.0

    @property
    def has_events(self) -> bool:
        """Something has happened that nobody has taken yet."""
        return self._state[layout.EVENTS] != 0.0

    def forget_events(self) -> None:
        """Whatever has happened is known."""
        if self._state[layout.EVENTS] != 0.0:
            for axis in range(self.axes):
                self._state[axis_base(axis) + layout.EVENT] = 0.0
            self._state[layout.EVENTS] = 0.0

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

    def forget(self) -> None:
        """What the controller loses at a reset, with everything at rest; machine and inputs stay as they are."""
        state = self._state
        for axis in range(self.axes):
            for slot, value in ((layout.LATCH_ARMED, 0.0), (layout.LATCHED, 0.0), (layout.STOP_CODE, 1.0)):
                state[axis_base(axis) + slot] = value
        for slot in range(layout.CAM, layout.CAM + layout.CAM_LENGTH * layout.MAXIMUM_AXES):
            state[slot] = 0.0
        self.path.set_scale(1.0, 1.0)
        self.path.set_tangent(0.0, 0.0)

    # --- whole state ------------------------------------------------------------------------------------------------
    def snapshot(self) -> Vector:
        """Everything, as one copied array."""
        return self._array.copy()

    def restore(self, snapshot: Vector) -> None:
        """Back to a snapshot; the trace goes on where it is."""
        kept = self._array[layout.TRACE_CAPACITY : layout.TRACE_COUNTDOWN + 1].copy()
        self._array[:] = snapshot
        self._array[layout.TRACE_CAPACITY : layout.TRACE_COUNTDOWN + 1] = kept

    def rewind(self, snapshot: Vector) -> None:
        """Back to a snapshot of this very run, its trace too: the same samples will be recorded in the same rows."""
        self._array[:] = snapshot

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
