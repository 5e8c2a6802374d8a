"""The world around the simulated controller: switches, inputs, voltages, pushes on the load."""

from __future__ import annotations

from collections.abc import Sequence

from device.simulator.kernel import inputs, layout
from device.simulator.kernel.layout import State, axis_base


class Outside:
    """What happens to the machine from outside; levels are those the controller reads."""

    _state: State
    _parts: Sequence[State]
    axes: int

    def set_limit(self, axis: int, forward: bool, level: bool) -> None:
        """Level of a limit input; the machine's own switch can still pull it low."""
        b = axis_base(axis)
        self._state[b + (layout.FORWARD_FORCED if forward else layout.REVERSE_FORCED)] = float(level)
        inputs.read_switches(self._parts[axis])

    def set_home(self, axis: int, level: bool) -> None:
        """Level of the home input; the machine's own switch can still pull it low."""
        b = axis_base(axis)
        self._state[b + layout.HOME_FORCED] = float(level)
        inputs.read_switches(self._parts[axis])

    def set_abort(self, level: bool) -> None:
        """Level of the abort input; low is active, from the next sample on."""
        self._state[layout.ABORT_LEVEL] = float(level)

    def set_input(self, number: int, level: bool) -> None:
        """Level of input 1..8."""
        self._state[layout.INPUT_1 + number - 1] = float(level)
        self._state[layout.INPUTS] = float(sum(int(self._state[layout.INPUT_1 + n]) << n for n in range(8)))

    def set_outputs(self, byte: int) -> None:
        """The output byte, for the trace."""
        self._state[layout.OUTPUTS] = float(byte)

    def set_analog(self, number: int, volts: float) -> None:
        """Voltage at analog input 1..8."""
        self._state[layout.ANALOG_1 + number - 1] = volts

    def push(self, axis: int, counts: float) -> None:
        """Moves motor and load by hand."""
        b = axis_base(axis)
        self._state[b + layout.MOTOR_X] += counts
        self._state[b + layout.LOAD_X] += counts

    def load(self, axis: int, volts: float) -> None:
        """A torque on the load, as volts of motor command; positive pushes forward."""
        self._state[axis_base(axis) + layout.DISTURBANCE] = volts

    def set_auxiliary(self, axis: int, counts: float) -> None:
        """Place of an external auxiliary encoder."""
        self._state[axis_base(axis) + layout.OUTSIDE_X] = counts

    def set_auxiliary_speed(self, axis: int, counts_per_second: float) -> None:
        """Speed of an external auxiliary encoder, held until changed."""
        self._state[axis_base(axis) + layout.OUTSIDE_V] = counts_per_second
