"""Motion that follows data or another axis: contour records, electronic cam, gearing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from device.simulator.kernel import cam, layout
from device.simulator.kernel.layout import State, axis_base


class Contour:
    """Contour mode (CM, DT, CD, WC)."""

    def __init__(self, state: State, parts: Sequence[State]) -> None:
        self._state, self._parts = state, parts

    def open(self, axes: Sequence[int]) -> None:
        """CM: the axes whose increments come next; nothing moves yet."""
        for axis, part in enumerate(self._parts):
            part[layout.IN_CONTOUR] = 1.0 if axis in axes else 0.0
            part[layout.CONTOUR_STEP] = 0.0

    def give(self, counts: Mapping[int, int], exponent: int) -> None:
        """CD with DT `exponent`: the record behind the running one; 0 ends the mode there. Ask `free` first."""
        for axis, part in enumerate(self._parts):
            if part[layout.IN_CONTOUR]:
                part[layout.CONTOUR_NEXT] = float(counts.get(axis, 0))
                if not part[layout.MOVING]:
                    part[layout.START] = part[layout.MARK] = part[layout.POSITION]
                part[layout.MOVING] = 1.0
                part[layout.IN_POSITION] = 0.0
                part[layout.SETTLING] = -1.0
                part[layout.STOP_CODE] = 50.0
        self._state[layout.CONTOUR_LENGTH] = float(2**exponent if exponent else 0)
        self._state[layout.CONTOUR_BUFFERED] = 1.0
        self._state[layout.CONTOUR_ACTIVE] = 1.0

    @property
    def free(self) -> bool:
        """Room for a record: the interpolator has taken the last one."""
        return self._state[layout.CONTOUR_BUFFERED] == 0.0

    def has(self, axis: int) -> bool:
        """The axis is in contour mode."""
        return self._parts[axis][layout.IN_CONTOUR] != 0.0

    @property
    def active(self) -> bool:
        """Any axis is in contour mode."""
        return any(part[layout.IN_CONTOUR] for part in self._parts)


class Cam:
    """Electronic cam (EA, EM, EP, ET, EB, EG, EQ)."""

    def __init__(self, state: State, parts: Sequence[State]) -> None:
        self._state, self._parts = state, parts
        self.master(0, auxiliary=False)
        self.interval(256, 0)

    def master(self, axis: int, *, auxiliary: bool, commanded: bool = False) -> None:
        """EA: the master's main encoder or commanded place, or (141x) the auxiliary encoder of the axis."""
        slot = layout.AUXILIARY if auxiliary else layout.POSITION if commanded else layout.ACTUAL
        self._state[layout.CAM_MASTER] = float(axis_base(axis) + slot)
        self._state[layout.CAM_AXIS] = float(axis)
        self._state[layout.CAM_AUXILIARY] = 1.0 if auxiliary else 0.0

    def cycle(self, counts: int) -> None:
        """EM at the master's place."""
        self._state[layout.CAM_CYCLE] = float(counts)

    def net(self, axis: int, counts: int) -> None:
        """EM at a slave's place: the amount of its change in a cycle."""
        self._parts[axis][layout.CAM_NET] = float(counts)

    def interval(self, counts: int, start: int) -> None:
        """EP: master counts an entry, and the master position of entry 0."""
        self._state[layout.CAM_INTERVAL] = float(counts)
        self._state[layout.CAM_START] = float(start)

    def entry(self, axis: int, index: int, counts: float) -> None:
        """ET[index] of one axis."""
        self._state[layout.CAM + layout.CAM_LENGTH * axis + index] = float(counts)

    def value(self, axis: int, master: float) -> float:
        """The slave's place for a master position within the cycle."""
        return cam.cam_value(self._state, axis, master)

    def enable(self, on: bool) -> None:
        """EB: the master's position is kept within its cycle from now on; off lets every slave go."""
        state = self._state
        state[layout.CAM_ON] = 1.0 if on else 0.0
        if not on:
            for part in self._parts:
                part[layout.CAM_ENGAGED] = part[layout.CAM_WAITS] = 0.0
            return
        cycle = state[layout.CAM_CYCLE]
        for axis, part in enumerate(self._parts):
            change = self.value(axis, cycle) - self.value(axis, 0.0)
            if change < 0.0:
                part[layout.CAM_NET] = -abs(part[layout.CAM_NET])
        master = state[int(state[layout.CAM_MASTER])]
        turns = float(master // cycle)
        if turns:
            cam.wrap_master(state, turns, cycle)
        state[layout.CAM_LAST] = master - turns * cycle

    @property
    def on(self) -> bool:
        """_EB."""
        return self._state[layout.CAM_ON] != 0.0

    def engaged(self, axis: int) -> bool:
        """_EG: the axis follows."""
        return self._parts[axis][layout.CAM_ENGAGED] != 0.0

    def _change(self, axis: int, at: float, follow: bool) -> None:
        part = self._parts[axis]
        there = follow and at == self._state[layout.CAM_LAST]  # the master stands at the place already
        if 0.0 <= at < self._state[layout.CAM_CYCLE] and not there:
            part[layout.CAM_WAITS] = 1.0
            part[layout.CAM_NEXT] = 1.0 if follow else 0.0
            part[layout.CAM_AT] = float(at)
            return
        part[layout.CAM_WAITS] = 0.0
        if follow:
            cam.engage(self._state, axis)
        else:
            part[layout.CAM_ENGAGED] = 0.0

    def engage(self, axis: int, at: float) -> None:
        """EG: follows from master position `at` on; outside the cycle at once."""
        self._change(axis, at, follow=True)

    def disengage(self, axis: int, at: float) -> None:
        """EQ: stands still from master position `at` on; outside the cycle at once."""
        self._change(axis, at, follow=False)
