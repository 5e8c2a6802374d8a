"""What each instruction is in two-letter code: one function for each type, and the memo of what they gave."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeAlias

from codegen.instructions import (
    AccelDecel,
    AutoExecution,
    BeginMotion,
    Comment,
    End,
    Home,
    Instruction,
    Jump,
    Label,
    LoopRate,
    MathematicalEquation,
    MotionParameters,
    Output,
    Print,
    Repeat,
    SingleAxisMove,
    StopMotion,
    Subroutine,
    TwoLetterCode,
    UserInterface,
    VariableArray,
    Wait,
    WaitForCondition,
)
from codegen.twoletter.calls import Statement
from codegen.twoletter.emit import flow, io, motion, settings
from codegen.twoletter.emit.build import Build

Emitter: TypeAlias = Callable[[Any, Build], Iterator[Statement]]

EMITTERS: Mapping[type[Instruction], Emitter] = {
    AccelDecel: motion.accel_decel,
    AutoExecution: settings.auto_execution,
    BeginMotion: motion.begin_motion,
    Comment: settings.comment,
    End: flow.end,
    Home: motion.home,
    Jump: flow.jump,
    Label: flow.label,
    LoopRate: settings.loop_rate,
    MathematicalEquation: settings.mathematical_equation,
    MotionParameters: motion.motion_parameters,
    Output: io.output,
    Print: io.print_items,
    Repeat: flow.repeat,
    SingleAxisMove: motion.single_axis_move,
    StopMotion: motion.stop_motion,
    Subroutine: flow.subroutine,
    TwoLetterCode: settings.two_letter_code,
    UserInterface: io.user_interface,
    VariableArray: settings.variable_array,
    Wait: flow.wait,
    WaitForCondition: flow.wait_for_condition,
}
CANNOT: Mapping[type[Instruction], str] = {}  # instruction -> why two-letter code has nothing for it


def statements(instruction: Instruction, build: Build) -> tuple[Statement, ...]:
    """What a correct instruction is in two-letter code."""
    return tuple(EMITTERS[type(instruction)](instruction, build))
