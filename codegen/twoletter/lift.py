"""Source becomes steps: what an instruction would write word for word becomes that instruction, the rest stays code.

Every guess is proved: an instruction is taken only when the code it makes reads the same as the lines it replaces.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Sequence

from codegen.document import Document
from codegen.fields import AXES, SYSTEM_LABELS, PerAxisText
from codegen.generate import code
from codegen.instructions import (
    AutoExecution,
    BeginMotion,
    Comment,
    Drive,
    End,
    Execute,
    Instruction,
    Jump,
    Label,
    MathematicalEquation,
    MotionParameters,
    Output,
    SingleAxisMove,
    StopMotion,
    Subroutine,
    TwoLetterCode,
    UserInterface,
    Wait,
    WaitForCondition,
)
from codegen.instructions.flow import EndOf, InputLevel, JumpIf, JumpKind, Routine
from codegen.instructions.io import Level, OutputMode
from codegen.instructions.machine import Power
from codegen.instructions.math import Equation
from codegen.instructions.motion import Beginning, MoveMode, WaitFor, Which
from codegen.instructions.waits import Finished, WaitKind
from codegen.program import Program, Step, program_label
from codegen.setup import Setup, Unit
from codegen.twoletter.format import format_argument, format_expression
from codegen.twoletter.nodes import Assign, Axes, Command, Line, Number, Source, Statement, String, Target, Variable
from codegen.twoletter.nodes import Comment as CommentNode
from codegen.twoletter.nodes import Label as LabelNode
from codegen.twoletter.parse import parse

AUTO = "AUTO"
MOVES = {"PR": (MoveMode.BY, "distance"), "PA": (MoveMode.TO, "position"), "JG": (MoveMode.AT, "jog_speed")}
RATES = {"SP": "speed", "AC": "acceleration", "DC": "deceleration"}
Maker = Callable[[Command, str], Instruction | None]


def in_counts(setup: Setup) -> Setup:
    """A setup whose axes are in counts, so that numbers of the source stay what they are."""
    for letter in AXES:
        axis = setup.axis(letter)
        if not axis.is_set_up:
            setup = setup.with_axis(letter, dataclasses.replace(axis, unit=Unit.COUNT))
    return setup


def number(statement: Command) -> str | None:
    """The only argument, where it is a plain number."""
    arguments = statement.arguments
    return arguments[0].text if len(arguments) == 1 and isinstance(arguments[0], Number) else None


def letters(statement: Command, axes: str) -> str | None:
    """The axes a command names; all of a one-axis controller when it names none."""
    if not statement.arguments:
        return axes if len(axes) == 1 else None
    first = statement.arguments[0]
    return first.letters if isinstance(first, Axes) and len(statement.arguments) == 1 else None


def wait_input(statement: Command, _: str) -> Instruction | None:
    """AI with a number."""
    text = number(statement)
    level = InputLevel.LOW if text and text.startswith("-") else InputLevel.HIGH
    return WaitForCondition(kind=WaitKind.INPUT, input=text.lstrip("-"), level=level) if text else None


def wait_motion(statement: Command, axes: str) -> Instruction | None:
    """AM."""
    named = letters(statement, axes)
    return WaitForCondition(kind=WaitKind.MOTION, axes=named, finished=Finished.PROFILE) if named else None


def wait(statement: Command, _: str) -> Instruction | None:
    """WT with a number."""
    text = number(statement)
    return Wait(time=text) if text else None


def output(level: Level) -> Maker:
    """SB or CB."""

    def make(statement: Command, _: str) -> Instruction | None:
        text = number(statement)
        return Output(mode=OutputMode.CHANNEL, output=text, level=level) if text else None

    return make


def port(statement: Command, _: str) -> Instruction | None:
    """OP with a number."""
    text = number(statement)
    return Output(mode=OutputMode.PORT, byte=text) if text else None


def jump(kind: JumpKind) -> Maker:
    """JP or JS, with a condition or without."""

    def make(statement: Command, _: str) -> Instruction | None:
        label = getattr(statement.arguments[0], "label", None) if statement.arguments else None
        if not label:
            return None
        if len(statement.arguments) == 1:
            return Jump(kind=kind, target=label)
        return Jump(kind=kind, target=label, when=JumpIf.CONDITION, condition=format_argument(statement.arguments[1]))

    return make


def execute(statement: Command, _: str) -> Instruction | None:
    """XQ with a label and a thread."""
    match statement.arguments:
        case (Target(label=str(label)), Number(text=thread)):
            return Execute(label=label, thread=thread)
    return None


def drive(power: Power) -> Maker:
    """SH or MO with its axes."""

    def make(statement: Command, axes: str) -> Instruction | None:
        named = letters(statement, axes)
        return Drive(power=power, axes=named) if named else None

    return make


def equation(statement: Assign) -> Instruction:
    """`V=expression`"""
    target = format_expression(statement.target)
    return MathematicalEquation(equations=(Equation(variable=target, expression=format_expression(statement.value)),))


def per_axis(statement: Command) -> PerAxisText | None:
    """The plain numbers of a command at the places of their axes."""
    texts = [argument.text if isinstance(argument, Number) else "" for argument in statement.arguments]
    if len(texts) > len(AXES) or not any(texts):
        return None
    x, y, z, w = (*texts, *[""] * (len(AXES) - len(texts)))
    return x, y, z, w


def one_axis(statement: Statement) -> tuple[str, str] | None:
    """The axis and the number of a command that has only one."""
    texts = per_axis(statement) if isinstance(statement, Command) else None
    given = [(letter, text) for letter, text in zip(AXES, texts, strict=True) if text] if texts else []
    return given[0] if len(given) == 1 else None


def begin(statement: Command, axes: str) -> Instruction | None:
    """BG with its axes."""
    named = letters(statement, axes)
    return BeginMotion(which=Beginning.AXES, axes=named) if named else None


def stop(statement: Command, _: str) -> Instruction | None:
    """ST with its axes."""
    named = letters(statement, "")
    return StopMotion(which=Which.AXES, axes=named, wait=False) if named else None


def ask(statement: Command, _: str) -> Instruction | None:
    """IN with a prompt and a variable."""
    match statement.arguments:
        case (String(text=prompt), Variable(name=name)):
            return UserInterface(prompt=prompt, variable=name)
    return None


def end(of: EndOf) -> Maker:
    """EN, RE or RI without arguments."""
    return lambda statement, _: End(of=of) if not statement.arguments else None


MAKERS: dict[str, Maker] = {
    "AI": wait_input,
    "AM": wait_motion,
    "WT": wait,
    "SB": output(Level.ON),
    "CB": output(Level.OFF),
    "OP": port,
    "JP": jump(JumpKind.GO),
    "JS": jump(JumpKind.CALL),
    "BG": begin,
    "ST": stop,
    "XQ": execute,
    "SH": drive(Power.ENABLE),
    "MO": drive(Power.DISABLE),
    "IN": ask,
    "EN": end(EndOf.SUBROUTINE),
    "RE": end(EndOf.ERROR),
    "RI": end(EndOf.INPUT),
}


def plain(statements: list[Statement], axes: str) -> list[Statement]:
    """Statements for comparing, with what is understood written out: the axis of a one-axis controller, RE and RI 0."""

    def whole(each: Statement) -> Statement:
        if not isinstance(each, Command) or each.arguments:
            return each
        if each.name in ("BG", "AM") and len(axes) == 1:
            return dataclasses.replace(each, arguments=(Axes(axes),))
        if each.name in ("RE", "RI"):
            return dataclasses.replace(each, arguments=(Number(0, "0"),))
        return each

    return [whole(each) for each in statements]


def makes(instruction: Instruction, wanted: list[Statement], setup: Setup) -> bool:
    """Whether an instruction writes exactly these statements."""
    lines = code(instruction, setup)
    made = [statement for _, statement in parse("\n".join(lines)).statements()] if lines else []
    return plain(made, setup.letters) == plain(wanted, setup.letters)


def single(statement: Statement, setup: Setup) -> Instruction | None:
    """The instruction of one statement."""
    made: Instruction | None = None
    if isinstance(statement, LabelNode):
        return Label(name=statement.name)
    if isinstance(statement, CommentNode):
        if statement.mark != "NO":
            return Comment(text=statement.text.strip())
        made = Comment(text=statement.text.strip(), in_code=True)
    elif isinstance(statement, Command) and statement.name in MAKERS:
        made = MAKERS[statement.name](statement, setup.letters)
    elif isinstance(statement, Command) and statement.name in RATES and (texts := per_axis(statement)):
        made = MotionParameters(**{RATES[statement.name]: texts})
    elif isinstance(statement, Assign):
        made = equation(statement)
    return made if made and makes(made, [statement], setup) else None


def move(statements: list[Statement], setup: Setup) -> tuple[Instruction, int] | None:
    """A whole move of one axis at the beginning of these statements, and how many of them it is."""
    first = statements[0]
    if not isinstance(first, Command) or first.name not in MOVES or not (found := one_axis(first)):
        return None
    axis, text = found
    mode, name = MOVES[first.name]
    values: dict[str, str] = {name: text}
    flags: dict[str, object] = {"begin": False, "wait": WaitFor.NOTHING}
    best: tuple[Instruction, int] | None = None
    for count, each in enumerate(statements, 1):
        if count > 1:
            if not isinstance(each, Command):
                break
            value = one_axis(each)
            if each.name in RATES and value and value[0] == axis:
                values[RATES[each.name]] = value[1]
            elif each.name == "BG":
                flags["begin"] = True
            elif each.name == "AM":
                flags["wait"] = WaitFor.PROFILE
            else:
                break
        made = SingleAxisMove(axis=axis, mode=mode, **values, **flags)  # type: ignore[arg-type]
        if makes(made, statements[:count], setup):
            best = made, count
    return best


def instructions(source: Source, setup: Setup) -> Iterator[Instruction]:
    """The whole source as instructions; lines of several statements and what is not recognised stay code."""
    kept: list[str] = []
    lines = list(source.lines)
    place = 0
    while place < len(lines):
        line = lines[place]
        made, used = recognised(lines, place, setup)
        if made is None:
            if line.text.strip():
                kept.append(line.text)
            place += 1
            continue
        if kept:
            yield TwoLetterCode(text="\n".join(kept))
            kept = []
        yield made
        place += used
    if kept:
        yield TwoLetterCode(text="\n".join(kept))


def recognised(lines: Sequence[Line], place: int, setup: Setup) -> tuple[Instruction | None, int]:
    """The instruction that begins on this line, and how many lines it takes."""
    following: list[Statement] = []
    for line in lines[place : place + 8]:
        statements = line.statements
        if len(statements) != 1:
            break
        following.append(statements[0])
    if not following:
        return None, 1
    if found := move(following, setup):
        return found
    return single(following[0], setup), 1


def split_routines(found: list[Instruction]) -> tuple[list[Instruction], list[list[Instruction]]]:
    """Main steps and routines; everything is main where the rest is not cleanly made of routines."""
    ends = [place for place, each in enumerate(found) if isinstance(each, End)]
    if not ends or found[ends[0]] != End(of=EndOf.SUBROUTINE):
        return found, []
    main, rest = found[: ends[0]], found[ends[0] + 1 :]
    routines: list[list[Instruction]] = []
    while rest:
        last = next((place for place, each in enumerate(rest) if isinstance(each, End)), None)
        if last is None or not isinstance(rest[0], Label):
            return found, []
        routines.append(rest[: last + 1])
        rest = rest[last + 1 :]
    return main, routines


def routine_start(label: str) -> Subroutine:
    """The beginning of a routine: the system's or the user's own."""
    known = {each.value: each for each in Routine}
    return Subroutine(routine=known[label]) if label in known else Subroutine(name=label)


def as_code(instruction: Instruction) -> Instruction:
    """A label of the system's own that stands by itself stays code."""
    if isinstance(instruction, Label) and instruction.name in SYSTEM_LABELS:
        return TwoLetterCode(text=f"#{instruction.name}")
    return instruction


def lift(text: str, name: str, setup: Setup) -> Document:
    """Source as a document. The frame (first label, last EN) becomes the program's own where it can."""
    setup = in_counts(setup)
    found = list(instructions(parse(text), setup))
    auto = bool(found) and found[0] == Label(name=AUTO)
    if auto:
        found = found[1:]
    title = name
    if found and isinstance(found[0], Label) and program_label(Program(name=found[0].name)) == found[0].name:
        uses = [each for each in found if isinstance(each, Jump) and each.target == found[0].name]
        if not uses:
            title, found = found[0].name, found[1:]
    main, routines = split_routines(found)
    main = [as_code(each) for each in main]
    routines = [[routine[0], *(as_code(each) for each in routine[1:])] for routine in routines]
    return Document(assembled(title, auto, main, routines), setup)


def assembled(title: str, auto: bool, main: list[Instruction], routines: list[list[Instruction]]) -> Program:
    """The program of these parts."""
    ids = (f"s{number}" for number in range(1, 1_000_000))
    configuration = (Step(next(ids), AutoExecution()),) if auto else ()
    steps = tuple(Step(next(ids), each) for each in main)
    blocks = []
    for routine in routines:
        label = routine[0]
        assert isinstance(label, Label)
        own = next(ids)
        body = tuple(Step(next(ids), each) for each in routine[1:])
        blocks.append(Step(own, routine_start(label.name), body=body))
    return Program(name=title, configuration=configuration, main=steps, routines=tuple(blocks))
