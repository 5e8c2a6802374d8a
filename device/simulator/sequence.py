"""A sequence of lines and arcs as given by LM, LI, VM, VP and CR, worked out for the sample loop."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from device.simulator.kernel import layout, path
from device.simulator.kernel.angle import sine
from device.simulator.kernel.layout import State

LONGEST = 2147483647.0
TOO_SHORT, TOO_LONG, TOO_MANY, MIXED = 30, 31, 32, 33  # error codes of commands.md 2


class Path:
    """Coordinated motion; methods that take a segment answer 0 or the controller's error code."""

    def __init__(self, state: State, parts: Sequence[State]) -> None:
        self._state, self._parts = state, parts
        self.turns_back = False  # TN: the angle jumps back by a turn beyond 180 degrees
        self.set_speed(25000.0)
        self.set_acceleration(256000.0)
        self.set_deceleration(256000.0)
        state[layout.PATH_RATIO] = state[layout.PATH_SMOOTHING] = 1.0
        state[layout.PATH_TANGENT] = -1.0
        state[layout.PATH_SCALE_FIRST] = state[layout.PATH_SCALE_SECOND] = 1.0

    # --- settings -----------------------------------------------------------------------------------------------------
    def set_speed(self, counts_per_second: float) -> None:
        """VS."""
        self._state[layout.PATH_SPEED_V] = counts_per_second

    def set_acceleration(self, value: float) -> None:
        """VA, counts/s²."""
        self._state[layout.PATH_AC_STEP] = value / layout.SAMPLES_PER_SECOND

    def set_deceleration(self, value: float) -> None:
        """VD, counts/s²."""
        self._state[layout.PATH_DC_STEP] = value / layout.SAMPLES_PER_SECOND

    def set_ratio(self, value: float) -> None:
        """VR."""
        self._state[layout.PATH_RATIO] = value

    def set_smoothing(self, value: float) -> None:
        """VT."""
        self._state[layout.PATH_SMOOTHING] = value

    def set_scale(self, first: float, second: float, *, shrinks: bool = False) -> None:
        """ES: the larger number stretches its axis by their ratio, or shrinks it."""
        for slot, ratio in (
            (layout.PATH_SCALE_FIRST, max(1.0, first / second)),
            (layout.PATH_SCALE_SECOND, max(1.0, second / first)),
        ):
            self._state[slot] = 1.0 / ratio if shrinks else ratio

    def set_tangent(self, counts_per_degree: float, zero: float) -> None:
        """TN: slope of the tangent axis and its position for angle 0."""
        self._state[layout.PATH_TANGENT_SCALE] = counts_per_degree
        self._state[layout.PATH_TANGENT_ZERO] = zero

    # --- the sequence -------------------------------------------------------------------------------------------------
    def _open(self) -> None:
        state = self._state
        for slot in (layout.PATH_HEAD, layout.PATH_OUT_HEAD, layout.PATH_TAIL, layout.PATH_ENDED, layout.PATH_TOTAL):
            state[slot] = 0.0
        for part in self._parts:
            part[layout.PATH_END] = 0.0
        for slot in (layout.PATH_LAST_FIRST, layout.PATH_LAST_SECOND, layout.PATH_HEADING_KNOWN, layout.PATH_FINISHED):
            state[slot] = 0.0

    def linear(self, axes: Sequence[int]) -> None:
        """LM: a new sequence of straight segments of these axes."""
        self._open()
        self._state[layout.PATH_OPENED] = 1.0
        self._state[layout.PATH_MEMBERS] = float(sum(1 << axis for axis in set(axes)))
        self._state[layout.PATH_TANGENT] = -1.0

    def vector(self, first: int, second: int, tangent: int | None = None) -> None:
        """VM: a new sequence of lines and arcs in the plane of two axes, a third one along the direction of travel."""
        self._open()
        self._state[layout.PATH_OPENED] = 2.0
        self._state[layout.PATH_FIRST], self._state[layout.PATH_SECOND] = float(first), float(second)
        self._state[layout.PATH_TANGENT] = -1.0 if tangent is None else float(tangent)

    @property
    def opened(self) -> str:
        """ "linear", "vector", or "" when neither LM nor VM was given."""
        return ("", "linear", "vector")[int(self._state[layout.PATH_OPENED])]

    @property
    def members(self) -> tuple[int, ...]:
        """The axes of the sequence."""
        if self._vector:
            return int(self._state[layout.PATH_FIRST]), int(self._state[layout.PATH_SECOND])
        mask = int(self._state[layout.PATH_MEMBERS])
        return tuple(axis for axis in range(len(self._parts)) if mask >> axis & 1)

    @property
    def _vector(self) -> bool:
        return self._state[layout.PATH_OPENED] == 2.0

    @property
    def _point(self) -> tuple[float, float]:
        return self._state[layout.PATH_LAST_FIRST], self._state[layout.PATH_LAST_SECOND]

    @property
    def _scale(self) -> tuple[float, float]:
        return self._state[layout.PATH_SCALE_FIRST], self._state[layout.PATH_SCALE_SECOND]

    def _room(self, length: float) -> int:
        if self._state[layout.PATH_FINISHED]:
            self._open()
        if length <= 0.0:
            return TOO_SHORT
        if self._state[layout.PATH_TOTAL] + length > LONGEST:
            return TOO_LONG
        return TOO_MANY if self.free <= 0 else 0

    def _add(self, length: float, speed: float | None, values: Mapping[int, float]) -> None:
        state = self._state
        g = path.segment(state[layout.PATH_TAIL])
        for offset in range(layout.SEGMENT_STRIDE):
            state[g + offset] = 0.0
        state[layout.PATH_TOTAL] += length
        state[g + layout.G_LENGTH] = length
        state[g + layout.G_END] = state[layout.PATH_TOTAL]
        state[g + layout.G_SPEED_V] = -1.0 if speed is None else speed
        for offset, value in values.items():
            state[g + offset] = value
        state[layout.PATH_TAIL] += 1.0

    def line(self, counts: Mapping[int, float], speed: float | None = None) -> int:
        """LI: increments of the axes of LM."""
        if self._vector:
            return MIXED
        length = math.sqrt(math.fsum(counts.get(axis, 0) ** 2 for axis in self.members))
        error = self._room(length)
        if error:
            return error
        values: dict[int, float] = {}
        for axis in self.members:
            part = self._parts[axis]
            values[layout.G_START + axis] = part[layout.PATH_END]
            values[layout.G_DIRECTION + axis] = counts.get(axis, 0) / length
            part[layout.PATH_END] += counts.get(axis, 0)
        self._add(length, speed, values)
        return 0

    def point(self, first: float, second: float, speed: float | None = None) -> int:
        """VP: straight to a point of the plane, measured from the start of the sequence."""
        if not self._vector:
            return MIXED
        if self._state[layout.PATH_FINISHED]:
            self._open()
        step = (first - self._point[0], second - self._point[1])
        length = math.hypot(*step)
        error = self._room(length)
        if error:
            return error
        values = {}
        for index, axis in enumerate(self.members):
            values[layout.G_START + axis] = self._point[index] * self._scale[index]
            values[layout.G_DIRECTION + axis] = step[index] * self._scale[index] / length
        values |= self._turn(math.degrees(math.atan2(step[1], step[0])), 0.0)
        self._add(length, speed, values)
        self._end_at(first, second)
        return 0

    def arc(self, radius: float, start: float, sweep: float, speed: float | None = None) -> int:
        """CR: an arc that begins at angle `start` of its circle and sweeps (degrees, positive anticlockwise)."""
        if not self._vector:
            return MIXED
        length = abs(math.radians(sweep)) * radius
        error = self._room(length)
        if error:
            return error
        centre = (self._point[0] - radius * sine(start + 90.0), self._point[1] - radius * sine(start))
        values = {layout.G_ARC: 1.0, layout.G_DIRECTION + 2: start, layout.G_DIRECTION + 3: sweep / length}
        for index, axis in enumerate(self.members):
            values[layout.G_START + axis] = centre[index] * self._scale[index]
            values[layout.G_DIRECTION + index] = radius * self._scale[index]
        values |= self._turn(start + math.copysign(90.0, sweep), sweep / length)
        self._add(length, speed, values)
        end = start + sweep
        self._end_at(centre[0] + radius * sine(end + 90.0), centre[1] + radius * sine(end))
        self._state[layout.PATH_HEADING] += sweep
        return 0

    def _turn(self, heading: float, slope: float) -> dict[int, float]:
        """The tangent axis in a segment that begins in direction `heading`; angles go on without jumps of 360°."""
        state = self._state
        if state[layout.PATH_HEADING_KNOWN]:
            heading += 360.0 * round((state[layout.PATH_HEADING] - heading) / 360.0)
        if self.turns_back:
            heading -= 360.0 * round(heading / 360.0)
        state[layout.PATH_HEADING], state[layout.PATH_HEADING_KNOWN] = heading, 1.0
        scale, zero = state[layout.PATH_TANGENT_SCALE], state[layout.PATH_TANGENT_ZERO]
        return {layout.G_TANGENT: zero + scale * heading, layout.G_TANGENT_SLOPE: scale * slope}

    def _end_at(self, first: float, second: float) -> None:
        self._state[layout.PATH_LAST_FIRST], self._state[layout.PATH_LAST_SECOND] = first, second
        for index, axis in enumerate(self.members):
            self._parts[axis][layout.PATH_END] = self._point[index] * self._scale[index]

    def end(self) -> None:
        """LE, VE: decelerate to a stop at the end of the last segment."""
        self._state[layout.PATH_ENDED] = 1.0

    def clear(self) -> None:
        """CS: forgets the segments not begun."""
        self._open()

    # --- running ------------------------------------------------------------------------------------------------------
    def begin(self) -> None:
        """BGS: the sequence starts where the axes are."""
        state = self._state
        for axis, part in enumerate(self._parts):
            member = 1.0 if axis in self.members else 2.0 if axis == state[layout.PATH_TANGENT] else 0.0
            part[layout.PATH_MEMBER] = member
            if member:
                part[layout.MODE] = layout.MODE_PATH
                part[layout.MOVING] = 1.0
                part[layout.STOP_CODE] = 100.0
                part[layout.IN_POSITION] = part[layout.AT_SPEED] = 0.0
                part[layout.SETTLING] = -1.0
                part[layout.START] = part[layout.MARK] = part[layout.PATH_ORIGIN] = part[layout.POSITION]
            if part[layout.GEAR_MASTER] == layout.PATH_SMOOTHED:
                part[layout.GEAR_LAST] = 0.0
        for slot in (layout.PATH_TRAVELLED, layout.PATH_SMOOTHED, layout.PATH_MARK, layout.PATH_V):
            state[slot] = 0.0
        state[layout.PATH_STOP_CODE] = state[layout.PATH_AT_SPEED] = 0.0
        state[layout.PATH_ACTIVE] = state[layout.PATH_MOVING] = 1.0
        first = state[path.segment(state[layout.PATH_HEAD]) + layout.G_SPEED_V]
        if first >= 0.0:
            state[layout.PATH_SPEED_V] = first

    def stop(self, code: int = 4) -> None:
        """STS: decelerates along the path with VD."""
        if self._state[layout.PATH_ACTIVE]:
            self._state[layout.PATH_STOP_CODE] = float(code)

    # --- reads --------------------------------------------------------------------------------------------------------
    @property
    def ready(self) -> bool:
        """There are segments to run (else error 24)."""
        state = self._state
        return not state[layout.PATH_FINISHED] and state[layout.PATH_TAIL] > state[layout.PATH_HEAD]

    @property
    def moving(self) -> bool:
        """_BGS."""
        return self._state[layout.PATH_MOVING] != 0.0

    @property
    def free(self) -> int:
        """_LM: places for segments."""
        state = self._state
        if state[layout.PATH_FINISHED]:
            return layout.WAITING_SEGMENTS
        waiting = state[layout.PATH_TAIL] - state[layout.PATH_HEAD] - state[layout.PATH_ACTIVE]
        kept = layout.MAXIMUM_SEGMENTS - 1 - (state[layout.PATH_TAIL] - state[layout.PATH_OUT_HEAD])
        return int(min(layout.WAITING_SEGMENTS - waiting, kept))

    @property
    def segment(self) -> int:
        """_CS: index of the segment being run."""
        return int(self._state[layout.PATH_OUT_HEAD])

    @property
    def length(self) -> float:
        """_LE, _VE: counts of all segments."""
        return self._state[layout.PATH_TOTAL]

    @property
    def to_come(self) -> float:
        """Counts of the segments not yet begun."""
        state = self._state
        if not self.moving:
            return self.length if self.ready else 0.0
        return state[layout.PATH_TOTAL] - state[path.segment(state[layout.PATH_HEAD]) + layout.G_END]

    @property
    def travelled(self) -> float:
        """_AV: counts since BGS."""
        return self._state[layout.PATH_TRAVELLED]

    @property
    def tangent_start(self) -> float:
        """_TN: where the tangent axis begins."""
        return self._state[path.segment(self._state[layout.PATH_HEAD]) + layout.G_TANGENT]

    def last_point(self, axis: int) -> float:
        """_VP: absolute place of the end of the last finished segment."""
        part = self._parts[axis]
        return part[layout.PATH_ORIGIN] + part[layout.PATH_POINT]
