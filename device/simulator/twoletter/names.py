"""What names in expressions mean on the simulated controller: variables, array elements, operands, keywords, inputs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.evaluate import EvaluationError
from codegen.twoletter.fixed import ONE, string_value
from device.simulator.twoletter import behaviour
from device.simulator.twoletter.arithmetic import FUNCTIONS
from device.simulator.twoletter.behaviour import registers
from device.simulator.twoletter.behaviour.io import converted
from device.simulator.twoletter.state import AXES

if TYPE_CHECKING:
    from device.simulator.twoletter.unit import Unit

FUNCTION_KEYS = {"F1": 22, "F2": 23, "F3": 24, "F4": 25, "F5": 26}  # terminal keys, dmc-1412-1414.txt l.5204
UNKNOWN_OPERAND = 58


class SimulatedNames:
    """The `Names` of one controller."""

    def __init__(self, unit: Unit) -> None:
        self.unit = unit
        self._foreign = frozenset(name for name, row in COMMANDS.items() if not row.known_to(unit.model))

    def variable(self, name: str) -> int:
        try:
            return self.unit.state.variables[name]
        except KeyError:
            raise EvaluationError(self.unit.profile.undefined_variable_code) from None

    def element(self, name: str, index: int) -> int:
        array = self.unit.state.arrays.get(name)
        if array is None:
            raise EvaluationError(82)
        if not 0 <= index < len(array):
            raise EvaluationError(56)
        return array[index]

    def operand(self, name: str, suffix: str) -> int:
        if name in self._foreign:
            raise EvaluationError(UNKNOWN_OPERAND)
        reads = behaviour.READS.get(name)
        axis = self._place(name, suffix)
        if reads is not None:
            return reads(self.unit, axis)
        if name in registers.STORES:
            return registers.read(self.unit, name, axis)
        raise EvaluationError(UNKNOWN_OPERAND)

    def keyword(self, name: str) -> int:
        unit = self.unit
        if name == "TIME":
            return (unit.sample - unit.state.clock_offset) * ONE
        if name in FUNCTION_KEYS:
            return string_value(chr(FUNCTION_KEYS[name]))
        reads = behaviour.KEYWORDS.get(name)
        if reads is None:
            raise EvaluationError(self.unit.profile.undefined_variable_code)
        return reads(unit)

    def function(self, name: str, argument: int) -> int:
        state, number = self.unit.state, argument >> 16
        if name == "IN":
            return self._bit(self.unit.inputs, number, self.unit.model.inputs)
        if name == "OUT":
            return self._bit(state.outputs, number, self.unit.model.outputs)
        if name == "AN" and 1 <= number <= len(state.analog):
            return converted(state.analog[number - 1])
        if name in FUNCTIONS:
            return FUNCTIONS[name](argument)
        raise EvaluationError(6)

    def _bit(self, byte: int, number: int, count: int) -> int:
        if not 1 <= number <= count:
            raise EvaluationError(6)
        return (byte >> (number - 1) & 1) * ONE

    def _place(self, name: str, suffix: str) -> int:
        if not suffix:
            return 0
        if suffix.isdigit():
            return int(suffix)
        if suffix == "S":
            return -1
        axis = AXES.find(suffix)
        if axis < 0 or axis >= len(self.unit.model.axes):
            raise EvaluationError(90)
        return axis
