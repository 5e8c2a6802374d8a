"""Every instruction of the palette, in its order."""

from __future__ import annotations

from codegen.instructions.configuration import AccelDecel, AutoExecution, VariableArray
from codegen.instructions.flow import End, Jump, Label, Repeat, Subroutine, Wait
from codegen.instructions.instruction import Group, Instruction
from codegen.instructions.io import Output
from codegen.instructions.math import MathematicalEquation
from codegen.instructions.motion import BeginMotion, Home, MotionParameters, SingleAxisMove, StopMotion
from codegen.instructions.operator import Print, UserInterface
from codegen.instructions.raw import Comment, TwoLetterCode
from codegen.instructions.servo import LoopRate
from codegen.instructions.waits import WaitForCondition

ALL: tuple[type[Instruction], ...] = (
    TwoLetterCode,
    AccelDecel,
    Comment,
    VariableArray,
    Output,
    BeginMotion,
    Home,
    MotionParameters,
    SingleAxisMove,
    StopMotion,
    AutoExecution,
    End,
    Jump,
    Label,
    Print,
    Repeat,
    Subroutine,
    UserInterface,
    Wait,
    WaitForCondition,
    LoopRate,
    MathematicalEquation,
)
GROUPS: tuple[Group, ...] = tuple(Group)

__all__ = [
    "ALL",
    "GROUPS",
    "AccelDecel",
    "AutoExecution",
    "BeginMotion",
    "Comment",
    "End",
    "Group",
    "Home",
    "Instruction",
    "Jump",
    "Label",
    "LoopRate",
    "MathematicalEquation",
    "MotionParameters",
    "Output",
    "Print",
    "Repeat",
    "SingleAxisMove",
    "StopMotion",
    "Subroutine",
    "TwoLetterCode",
    "UserInterface",
    "VariableArray",
    "Wait",
    "WaitForCondition",
]
