"""Settings of axes: one instruction takes several commands that follow each other."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

from codegen.fields import OFF, Dimension, PerAxisText
from codegen.instructions import (
    AccelDecel,
    AnalogFeedback,
    Communication,
    DefinePosition,
    DualLoop,
    ElectronicGearing,
    Encoder,
    FeedForward,
    FollowingError,
    IncrementalPosition,
    Instruction,
    Integrator,
    MotionParameters,
    Motor,
    MotorDisable,
    Offset,
    PidGains,
    PositionFormat,
    PositionLimits,
    RecordData,
    TorqueLimit,
    VariableArray,
    WaitForCondition,
)
from codegen.instructions.configuration import Declare
from codegen.instructions.following import Master
from codegen.instructions.machine import Register
from codegen.instructions.records import Baud, Interrupting, Interval, Link, PortMode, Recording, Source
from codegen.instructions.waits import Finished, WaitKind
from codegen.setup import Setup
from codegen.twoletter.emit.machine import AUXILIARY_STEP, MAIN_CODES, MOTOR_CODES
from codegen.twoletter.emit.records import CODES
from codegen.twoletter.lift.same import makes
from codegen.twoletter.lift.values import (
    arguments_by_axis,
    in_places,
    letters_of,
    number_of,
    one_number,
    per_axis,
    text_of,
    whole_numbers,
)
from codegen.twoletter.nodes import Command, Operand, Statement
from codegen.twoletter.nodes import Dimension as ArrayName

Found = tuple[tuple[Instruction, ...], int]  # instructions, and how many statements they take


@dataclasses.dataclass(frozen=True, slots=True)
class Part:
    """A command and the field that holds its values."""

    command: str
    field: str
    dimension: Dimension | None = None
    switch: bool = False  # 1 is on, 0 off


@dataclasses.dataclass(frozen=True, slots=True)
class Shape:
    """An instruction made of such commands, in their order; `fixed` are its other fields."""

    kind: type[Instruction]
    parts: tuple[Part, ...]
    fixed: tuple[tuple[str, Any], ...] = ()


_POSITION, _DISTANCE = Dimension.POSITION, Dimension.DISTANCE
_SPEED, _RAMP = Dimension.SPEED, Dimension.ACCELERATION
RAMPS = (Part("AC", "acceleration", _RAMP), Part("DC", "deceleration", _RAMP))
PARAMETERS = Shape(MotionParameters, (Part("SP", "speed", _SPEED), *RAMPS))
ACCEL_DECEL = Shape(AccelDecel, RAMPS)  # belongs to the configuration
SHAPES: tuple[Shape, ...] = (
    PARAMETERS,
    Shape(PidGains, (Part("KP", "proportional"), Part("KI", "integral"), Part("KD", "derivative"))),
    Shape(FeedForward, (Part("FV", "velocity"), Part("FA", "acceleration"))),
    Shape(PositionLimits, (Part("FL", "forward", _POSITION), Part("BL", "reverse", _POSITION))),
    Shape(FollowingError, (Part("ER", "error", Dimension.ERROR),)),
    Shape(MotorDisable, (Part("OE", "axes", switch=True),)),
    Shape(TorqueLimit, (Part("TL", "limit"),)),
    Shape(Integrator, (Part("IL", "limit"),)),
    Shape(Offset, (Part("OF", "offset"),)),
    Shape(DualLoop, (Part("DV", "axes", switch=True),)),
    Shape(AnalogFeedback, (Part("AF", "axes", switch=True),)),
    Shape(IncrementalPosition, (Part("IP", "distance", _DISTANCE),)),
    Shape(DefinePosition, (Part("DP", "position", _POSITION),), (("register", Register.MAIN),)),
    Shape(DefinePosition, (Part("DE", "position", _POSITION),), (("register", Register.AUXILIARY),)),
)
WIDEST = {"FL": "2147483647", "BL": "-2147483648"}  # a limit switched off


def settings(statements: Sequence[Statement], setup: Setup, configuring: bool) -> Found | None:
    """The longest instruction that settings of axes at the beginning of these statements are."""
    shapes = (ACCEL_DECEL, *SHAPES) if configuring else SHAPES
    for shape in shapes:
        fields: dict[str, Any] = dict(shape.fixed)
        best: Found | None = None
        left = list(shape.parts)
        for count, each in enumerate(statements[: len(shape.parts)], 1):
            place = next(
                (n for n, part in enumerate(left) if isinstance(each, Command) and part.command == each.name), -1
            )
            if place < 0 or not isinstance(each, Command) or (texts := _texts(each, left[place], setup)) is None:
                break
            fields[left[place].field] = texts
            del left[: place + 1]
            made = _integrator(shape.kind(**fields))
            if makes((made,), statements[:count], setup):
                best = (made,), count
        if best is not None:
            return best
    return None


def _texts(command: Command, part: Part, setup: Setup) -> PerAxisText | None:
    if part.switch:
        numbers = {letter: number_of(argument) for letter, argument in arguments_by_axis(command).items()}
        if not numbers or any(number not in (0, 1) for number in numbers.values()):
            return None
        return in_places({letter: "on" if number else "off" for letter, number in numbers.items()})
    texts = per_axis(command, setup, part.dimension)
    if texts is None or command.name not in WIDEST:
        return texts
    raw = per_axis(command, setup) or texts
    x, y, z, w = (OFF if each == WIDEST[command.name] else text for each, text in zip(raw, texts, strict=True))
    return x, y, z, w


def _integrator(made: Instruction) -> Instruction:
    """Negative limits freeze the integrator while the axis moves."""
    if isinstance(made, Integrator) and any(text.startswith("-") for text in made.limit):
        x, y, z, w = (text.removeprefix("-") for text in made.limit)
        return dataclasses.replace(made, limit=(x, y, z, w), freeze=True)
    return made


# --------------------------------------------------------- commands in pairs and codes


def encoder(statements: Sequence[Command], _: Setup) -> Found | None:
    """CE: the codes of both encoders of an axis in one number."""
    kinds = {code: kind.value for kind, code in MAIN_CODES.items()}
    main, auxiliary = {}, {}
    for letter, argument in arguments_by_axis(statements[0]).items():
        number = number_of(argument)
        if number is None or number not in range(4 * AUXILIARY_STEP):
            return None
        main[letter], auxiliary[letter] = kinds[int(number) % AUXILIARY_STEP], kinds[int(number) // AUXILIARY_STEP]
    return ((Encoder(main=in_places(main), auxiliary=in_places(auxiliary)),), 1) if main else None


def motor(statements: Sequence[Command], _: Setup) -> Found | None:
    """MT."""
    kinds = {code: kind.value for kind, code in MOTOR_CODES.items()}
    given = {letter: number_of(argument) for letter, argument in arguments_by_axis(statements[0]).items()}
    found = {letter: kinds[number] for letter, number in given.items() if number in kinds}
    return ((Motor(types=in_places(found)),), 1) if found and len(found) == len(given) else None


def _digits(text: str) -> tuple[str, str, bool]:
    """`-8.2` as digits, decimals, hexadecimal."""
    digits, _, decimals = text.lstrip("-").partition(".")
    return digits or "0", decimals or "0", text.startswith("-")


def position_format(statements: Sequence[Command], _: Setup) -> Found | None:
    """PF and LZ."""
    if len(statements) < 2 or statements[1].name != "LZ":
        return None
    digits, decimals, hexadecimal = _digits(one_number(statements[0]))
    zeros = one_number(statements[1]) == "0"
    shape = PositionFormat(digits=digits, decimals=decimals, hexadecimal=hexadecimal, leading_zeros=zeros)
    return (shape,), 2


def variable_format(statements: Sequence[Command], _: Setup) -> Found | None:
    """VF."""
    digits, decimals, hexadecimal = _digits(one_number(statements[0]))
    made = VariableArray(mode=Declare.FORMAT, digits=digits, decimals=decimals, hexadecimal=hexadecimal)
    return (made,), 1


def array(statements: Sequence[Command], setup: Setup) -> Found | None:
    """DM: an instruction for each array."""
    made: list[Instruction] = []
    for argument in statements[0].arguments:
        size = text_of(argument.size, setup) if isinstance(argument, ArrayName) else ""
        if not isinstance(argument, ArrayName) or not size:
            return None
        made.append(VariableArray(mode=Declare.ARRAY, array=argument.name, size=size))
    return (tuple(made), 1) if len(made) == 1 else None


def free(statements: Sequence[Command], _: Setup) -> Found | None:
    """DA of one array."""
    match statements[0].arguments:
        case (ArrayName(name=name, is_array=True),) if name != "*":
            return (VariableArray(mode=Declare.FREE, freed=name),), 1
    return None


def record(statements: Sequence[Command], _: Setup) -> Found | None:
    """RA, RD and RC."""
    if [each.name for each in statements[:3]] != ["RA", "RD", "RC"]:
        return None
    arrays, sources, timing = (each.arguments for each in statements[:3])
    rows = []
    for place, source in zip(arrays, sources, strict=False):
        if not isinstance(place, ArrayName) or not isinstance(source, Operand) or source.name not in list(Source):
            return None
        rows.append(Recording(array=place.name, source=Source(source.name), axis=source.suffix or "X"))
    numbers = whole_numbers(timing)
    if len(arrays) != len(sources) or not numbers or numbers[0] is None or not 1 <= numbers[0] <= 8:
        return None
    count = numbers[1] if len(numbers) > 1 else None
    made = RecordData(
        recordings=tuple(rows),
        interval=Interval(str(numbers[0])),
        endless=count is not None and count < 0,
        count="" if count is None else str(abs(count)),
    )
    return (made,), 3


def port(statements: Sequence[Command], _: Setup) -> Found | None:
    """CC with all its numbers."""
    numbers = whole_numbers(statements[0].arguments)
    if numbers is None or len(numbers) != 4 or None in numbers or str(numbers[0]) not in list(Baud):
        return None
    baud, handshake, chain, echo = numbers
    mode = PortMode.CHAIN if chain else PortMode.GENERAL
    made = Communication(what=Link.PORT, baud=Baud(str(baud)), handshake=bool(handshake), mode=mode, echo=bool(echo))
    return (made,), 1


def characters(statements: Sequence[Command], _: Setup) -> Found | None:
    """CI with all its numbers."""
    numbers = whole_numbers(statements[0].arguments)
    kinds: Mapping[int | None, Interrupting] = {code: kind for kind, code in CODES.items()}
    if numbers is None or len(numbers) != 3 or numbers[0] not in kinds or numbers[1] not in kinds:
        return None
    made = Communication(what=Link.INTERRUPT, first=kinds[numbers[0]], second=kinds[numbers[1]], live=bool(numbers[2]))
    return (made,), 1


def gearing(statements: Sequence[Command], setup: Setup) -> Found | None:
    """GA and GR; GR alone where there is one axis."""
    master, axis, used = Master.ENCODER, "X", 1
    if statements[0].name == "GA":
        letters = letters_of(statements[0], setup)
        if not letters or len(statements) < 2 or statements[1].name != "GR":
            return None
        kinds = {"C": Master.COMMANDED, "D": Master.AUXILIARY}
        master = Master.PATH if letters == "S" else kinds.get(letters[:-1], Master.ENCODER)
        axis, used = letters[-1] if letters != "S" else "X", 2
    ratio = per_axis(statements[used - 1], setup)
    return ((ElectronicGearing(master=master, axis=axis, ratio=ratio),), used) if ratio else None


def in_position(statements: Sequence[Command], setup: Setup) -> Found | None:
    """TW and MC of the same axes."""
    if len(statements) < 2 or statements[1].name != "MC":
        return None
    axes, given = letters_of(statements[1], setup), arguments_by_axis(statements[0])
    texts = {text_of(argument, setup, Dimension.TIME) for argument in given.values()}
    if set(axes) != set(given) or len(texts) != 1 or len(axes) == 0:
        return None
    made = WaitForCondition(kind=WaitKind.MOTION, axes=axes, finished=Finished.POSITION, time_out=texts.pop())
    return (made,), 2


PAIRS = {
    "CE": encoder,
    "MT": motor,
    "PF": position_format,
    "VF": variable_format,
    "DM": array,
    "DA": free,
    "RA": record,
    "CC": port,
    "CI": characters,
    "GA": gearing,
    "GR": gearing,
    "TW": in_position,
}


def pair(statements: Sequence[Command], setup: Setup) -> Found | None:
    """An instruction of codes, or of commands that belong together."""
    maker = PAIRS.get(statements[0].name)
    found = maker(statements, setup) if maker else None
    return found if found and makes(found[0], statements[: found[1]], setup) else None
