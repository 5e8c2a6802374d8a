"""Instructions of one statement each."""

from __future__ import annotations

from collections.abc import Callable

from codegen.expressions import Bad, parse_expression
from codegen.fields import Dimension
from codegen.instructions import (
    AbortMotion,
    ArmLatch,
    BeginMotion,
    DedicatedInputs,
    DisableGearing,
    Drive,
    End,
    Execute,
    HaltTask,
    Instruction,
    Interrupt,
    Jump,
    MathematicalEquation,
    Output,
    StopMotion,
    VariableArray,
    Wait,
    WaitForCondition,
    WriteEeprom,
    ZeroStack,
)
from codegen.instructions.configuration import Declare, ValueKind
from codegen.instructions.flow import EndOf, InputLevel, JumpIf, JumpKind
from codegen.instructions.following import Aborted
from codegen.instructions.io import Level, OutputMode
from codegen.instructions.machine import Burned, Polarity, Power
from codegen.instructions.math import Equation
from codegen.instructions.motion import Beginning, Which
from codegen.instructions.tasks import Halted, InterruptInput, Interrupts, Levels
from codegen.instructions.waits import Clock, Finished, Moving, Place, WaitKind
from codegen.setup import Setup
from codegen.twoletter.format import format_expression
from codegen.twoletter.lift.talk import ask, message
from codegen.twoletter.lift.values import (
    arguments_by_axis,
    letters_of,
    number_of,
    one_number,
    text_of,
    whole_numbers,
)
from codegen.twoletter.nodes import Assign, Binary, Command, Function, Number, String, Target

Maker = Callable[[Command, Setup], Instruction | None]
PASSING = {"AP": Place.PASSED, "MF": Place.FORWARD, "MR": Place.REVERSE}
DISTANCES = {"AD": Place.START, "AR": Place.LAST}


def wait_input(statement: Command, _: Setup) -> Instruction | None:
    """AI with a number."""
    text = one_number(statement)
    level = InputLevel.LOW if text.startswith("-") else InputLevel.HIGH
    return WaitForCondition(kind=WaitKind.INPUT, input=text.lstrip("-"), level=level) if text else None


def wait_motion(finished: Finished) -> Maker:
    """AM or MC; without letters AM waits for all axes."""

    def make(statement: Command, setup: Setup) -> Instruction | None:
        axes = letters_of(statement, setup)
        if axes == "S":
            return WaitForCondition(kind=WaitKind.MOTION, moving=Moving.PATH, finished=finished)
        if statement.arguments and not axes:
            return None
        return WaitForCondition(kind=WaitKind.MOTION, axes=axes, finished=finished)

    return make


def wait_speed(statement: Command, setup: Setup) -> Instruction | None:
    """AS of one axis or of the path."""
    axes = letters_of(statement, setup)
    if axes == "S":
        return WaitForCondition(kind=WaitKind.SPEED, moving=Moving.PATH)
    return WaitForCondition(kind=WaitKind.SPEED, speed_axis=axes) if len(axes) == 1 else None


def wait_position(statement: Command, setup: Setup) -> Instruction | None:
    """AP, MF and MR at a place, AD and AR over a distance."""
    given = list(arguments_by_axis(statement).items())
    if len(given) != 1 or statement.axis is not None:
        return None
    letter, argument = given[0]
    if statement.name in PASSING:
        text = text_of(argument, setup, Dimension.POSITION, letter)
        return WaitForCondition(kind=WaitKind.POSITION, place=PASSING[statement.name], axis=letter, position=text)
    text = text_of(argument, setup, Dimension.DISTANCE, letter)
    return WaitForCondition(kind=WaitKind.POSITION, place=DISTANCES[statement.name], axis=letter, distance=text)


def wait_path(statement: Command, setup: Setup) -> Instruction | None:
    """AV."""
    text = text_of(statement.arguments[0] if len(statement.arguments) == 1 else None, setup, Dimension.DISTANCE, "X")
    return WaitForCondition(kind=WaitKind.POSITION, place=Place.PATH, axis="X", path=text) if text else None


def wait_clock(statement: Command, setup: Setup) -> Instruction | None:
    """AT: 0 starts the clock, a negative time starts it again."""
    number = number_of(statement.arguments[0]) if len(statement.arguments) == 1 else None
    if number == 0:
        return WaitForCondition(kind=WaitKind.CLOCK, clock=Clock.NOW)
    text = text_of(statement.arguments[0] if len(statement.arguments) == 1 else None, setup, Dimension.TIME)
    clock = Clock.AGAIN if text.startswith("-") else Clock.AFTER
    return WaitForCondition(kind=WaitKind.CLOCK, clock=clock, time=text.lstrip("-")) if text else None


def wait(statement: Command, setup: Setup) -> Instruction | None:
    """WT with a number or an expression."""
    text = text_of(statement.arguments[0] if len(statement.arguments) == 1 else None, setup, Dimension.TIME)
    return Wait(time=text) if text else None


def output(level: Level) -> Maker:
    """SB or CB."""

    def make(statement: Command, _: Setup) -> Instruction | None:
        text = one_number(statement)
        return Output(mode=OutputMode.CHANNEL, output=text, level=level) if text else None

    return make


def output_if(statement: Command, setup: Setup) -> Instruction | None:
    """OB."""
    if len(statement.arguments) != 2 or not isinstance(statement.arguments[0], Number):
        return None
    number, condition = (text_of(each, setup) for each in statement.arguments)
    return Output(mode=OutputMode.CONDITION, output=number, condition=condition) if condition else None


def port(statement: Command, setup: Setup) -> Instruction | None:
    """OP."""
    text = text_of(statement.arguments[0] if len(statement.arguments) == 1 else None, setup)
    return Output(mode=OutputMode.PORT, byte=text) if text else None


def jump(kind: JumpKind) -> Maker:
    """JP or JS, with a condition or without."""

    def make(statement: Command, setup: Setup) -> Instruction | None:
        match statement.arguments:
            case (Target(label=str(label)),):
                return Jump(kind=kind, target=label)
            case (Target(label=str(label)), condition):
                pass
            case _:
                return None
        match condition:
            case Binary("=", Function("IN", Number() as number), Number(scaled=level)) if level in (0, 1 << 16):
                wanted = InputLevel.HIGH if level else InputLevel.LOW
                return Jump(kind=kind, target=label, when=JumpIf.INPUT, input=text_of(number, setup), level=wanted)
        text = text_of(condition, setup)
        return Jump(kind=kind, target=label, when=JumpIf.CONDITION, condition=text) if text else None

    return make


def execute(statement: Command, _: Setup) -> Instruction | None:
    """XQ with a label and a thread."""
    match statement.arguments:
        case (Target(label=str(label)), Number(text=thread)):
            return Execute(label=label, thread=thread)
    return None


def halt(statement: Command, _: Setup) -> Instruction | None:
    """HX."""
    if not statement.arguments:
        return HaltTask(which=Halted.ALL)
    text = one_number(statement)
    return HaltTask(which=Halted.ONE, thread=text) if text else None


def drive(power: Power) -> Maker:
    """SH or MO with its axes."""

    def make(statement: Command, setup: Setup) -> Instruction | None:
        axes = letters_of(statement, setup)
        return Drive(power=power, axes=axes) if axes else None

    return make


def begin(statement: Command, setup: Setup) -> Instruction | None:
    """BG with its axes, or of the path."""
    axes = letters_of(statement, setup)
    if axes == "S":
        return BeginMotion(which=Beginning.PATH)
    return BeginMotion(which=Beginning.AXES, axes=axes) if axes else None


def stop(statement: Command, setup: Setup) -> Instruction | None:
    """ST with its axes; without them it ends the programs of an SSC too."""
    if not statement.arguments and setup.limits.family == "ssc":
        return StopMotion(which=Which.EVERYTHING)
    axes = letters_of(statement, setup)
    which = {"S": Which.PATH, setup.letters + "S": Which.MOTION}.get(axes, Which.AXES)
    return StopMotion(which=which, axes=axes if which is Which.AXES else "X", wait=False) if axes else None


def abort(statement: Command, _: Setup) -> Instruction | None:
    """AB."""
    return AbortMotion(what=Aborted.MOTION if statement.arguments else Aborted.EVERYTHING)


def zero_stack(statement: Command, _: Setup) -> Instruction | None:
    """ZS."""
    return ZeroStack(levels=Levels.ONE if one_number(statement) == "1" else Levels.ALL)


def interrupt(statement: Command, _: Setup) -> Instruction | None:
    """II: a run of inputs, or a mask."""
    numbers = whole_numbers(statement.arguments)
    match numbers:
        case [0]:
            return Interrupt(which=Interrupts.NONE)
        case [int(first)]:
            chosen = [first]
        case [int(first), int(last)]:
            chosen = list(range(first, last + 1))
        case [None, None, int(mask)]:
            chosen = [number for number in range(1, 9) if mask >> (number - 1) & 1]
        case _:
            return None
    rows = tuple(InterruptInput(input=str(number)) for number in chosen)
    return Interrupt(which=Interrupts.SOME, inputs=rows) if rows else None


def end(of: EndOf) -> Maker:
    """EN, RE or RI; EN with numbers ends the communication interrupt."""

    def make(statement: Command, _: Setup) -> Instruction | None:
        found = whole_numbers(statement.arguments)
        if found is None or any(number not in (0, 1, None) for number in found):
            return None
        numbers = [number or 0 for number in found]
        if of is EndOf.SUBROUTINE and len(numbers) == 2:
            return End(of=EndOf.COMMUNICATION, keep=bool(numbers[0]), restore=bool(numbers[1]))
        return End(of=of, keep=bool(numbers and numbers[0]))

    return make


def burn(what: Burned) -> Maker:
    """BN or BV."""
    return lambda statement, _: WriteEeprom(what=what)


def inputs(statement: Command, _: Setup) -> Instruction | None:
    """CN with all three levels."""
    numbers = whole_numbers(statement.arguments)
    if numbers is None or len(numbers) != 3 or any(number not in (1, -1) for number in numbers):
        return None
    limit, home, latch = (Polarity.HIGH if number == 1 else Polarity.LOW for number in numbers)
    return DedicatedInputs(limit=limit, home=home, latch=latch)


def latch(statement: Command, setup: Setup) -> Instruction | None:
    """AL."""
    axes = letters_of(statement, setup)
    return ArmLatch(axes=axes) if axes else None


def gearing_off(statement: Command, _: Setup) -> Instruction | None:
    """GR with nothing but zeros."""
    given = arguments_by_axis(statement)
    zero = bool(given) and all(number_of(argument) == 0 for argument in given.values())
    return DisableGearing(axes="".join(given)) if zero else None


def equation(statement: Assign, setup: Setup, configuring: bool) -> Instruction | None:
    """`V=expression`; a text, or a number in the configuration, declares the variable."""
    target, value = format_expression(statement.target), text_of(statement.value, setup)
    if isinstance(statement.value, String):
        return VariableArray(mode=Declare.VARIABLE, variable=target, holds=ValueKind.TEXT, text=statement.value.text)
    if configuring and isinstance(statement.value, Number):
        return VariableArray(mode=Declare.VARIABLE, variable=target, number=value)
    if not value or isinstance(parse_expression(value), Bad):
        return None
    return MathematicalEquation(equations=(Equation(variable=target, expression=value),))


MAKERS: dict[str, Maker] = {
    "AI": wait_input,
    "AM": wait_motion(Finished.PROFILE),
    "MC": wait_motion(Finished.POSITION),
    "AS": wait_speed,
    "AP": wait_position,
    "MF": wait_position,
    "MR": wait_position,
    "AD": wait_position,
    "AR": wait_position,
    "AV": wait_path,
    "AT": wait_clock,
    "WT": wait,
    "SB": output(Level.ON),
    "CB": output(Level.OFF),
    "OB": output_if,
    "OP": port,
    "JP": jump(JumpKind.GO),
    "JS": jump(JumpKind.CALL),
    "XQ": execute,
    "HX": halt,
    "AB": abort,
    "ZS": zero_stack,
    "II": interrupt,
    "BG": begin,
    "ST": stop,
    "SH": drive(Power.ENABLE),
    "MO": drive(Power.DISABLE),
    "BN": burn(Burned.PARAMETERS),
    "BV": burn(Burned.VARIABLES),
    "CN": inputs,
    "AL": latch,
    "GR": gearing_off,
    "MG": message,
    "IN": ask,
    "EN": end(EndOf.SUBROUTINE),
    "RE": end(EndOf.ERROR),
    "RI": end(EndOf.INPUT),
}
