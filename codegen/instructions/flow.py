"""The group Program Flow: labels, jumps, loops, subroutines, waiting for time."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc
from enum import StrEnum
from fractions import Fraction

from codegen.conversion import CALIBRATED_US
from codegen.fields import Choice, Condition, Dimension, Flag, InputNumber, LabelName, Number, Quantity, value
from codegen.instructions.instruction import Group, Instruction
from codegen.numbers import decimal, nearest, parse_number
from codegen.setup import Setup

SAMPLES_PER_MS = Fraction(1024, 1000)  # samples in a true millisecond at the calibrated loop rate


@dc.dataclass(frozen=True, kw_only=True)
class Label(Instruction):
    """A place to jump to."""

    title = "Label"
    group = Group.FLOW
    sentence = "Label {name}"
    help = "Marks a place in the program that Jump and Execute can name."

    name: str = value(
        LabelName(label="Name", defines=True, help="A letter and up to 6 letters or digits, in capitals."), ""
    )

    @classmethod
    def example(cls) -> Label:
        return cls(name="A")


@dc.dataclass(frozen=True, kw_only=True)
class Wait(Instruction):
    """Holds the program for a time."""

    title = "Wait"
    group = Group.FLOW
    sentence = "Wait {time}"
    help = (
        "Holds the program for a time. The controller counts samples, a little shorter than a millisecond; "
        "'exactly' sends the number of samples nearest to the time."
    )

    time: str = value(
        Quantity(label="Time", dimension=Dimension.TIME, axis="", help="How long, in ms (1000 ms are one second)."), ""
    )
    exactly: bool = value(
        Flag(
            label="True milliseconds",
            help="Convert true milliseconds to samples instead of sending the number as it is.",
        ),
        False,
    )

    def samples(self, setup: Setup) -> int | None:
        """How many samples are sent; None for an expression."""
        return samples_of(self.time, setup, self.exactly)

    def samples_note(self, setup: Setup) -> str:
        """`(20 samples = 19.5 ms)`"""
        return samples_note(self.time, setup, self.exactly)

    @classmethod
    def example(cls) -> Wait:
        return cls(time="20")


def samples_of(time: str, setup: Setup, exactly: bool = False) -> int | None:
    """A time in ms as the number of samples that is sent (a sample is TM/1 024 000 s); None for an expression."""
    number = parse_number(time)
    if number is None:
        return None
    return nearest(number * CALIBRATED_US / setup.sample * (SAMPLES_PER_MS if exactly else 1))


def samples_note(time: str, setup: Setup, exactly: bool = False) -> str:
    """What a time really is: ` (20 samples = 19.5 ms)`."""
    samples = samples_of(time, setup, exactly)
    if samples is None:
        return ""
    return f" ({samples} sample{'s' * (samples != 1)} = {decimal(samples * setup.sample / 1024, 1)} ms)"


class JumpKind(StrEnum):
    GO = "go"
    CALL = "call"


class JumpIf(StrEnum):
    ALWAYS = "always"
    INPUT = "input"
    CONDITION = "condition"


class InputLevel(StrEnum):
    HIGH = "high"
    LOW = "low"


LEVEL_WORDS = {InputLevel.HIGH: "high", InputLevel.LOW: "low"}


@dc.dataclass(frozen=True, kw_only=True)
class Jump(Instruction):
    """Goes on at a label, or calls a subroutine, always or on a condition."""

    title = "Jump"
    group = Group.FLOW
    sentence = "{kind} {target}[ if input {input} is {level}][ if {condition}]"
    help = "Goes on at a label, or calls a subroutine and comes back; always, by an input, or when a condition holds."

    kind: JumpKind = value(
        Choice(
            label="Jump",
            kind=JumpKind,
            words={JumpKind.GO: "To a label", JumpKind.CALL: "To a subroutine and back"},
            phrases={JumpKind.GO: "Go to", JumpKind.CALL: "Call"},
            help="To a label, or to a subroutine that returns here.",
        ),
        JumpKind.GO,
    )
    target: str = value(LabelName(label="Label", help="The label or subroutine."), "")
    when: JumpIf = value(
        Choice(
            label="When",
            kind=JumpIf,
            words={JumpIf.ALWAYS: "Always", JumpIf.INPUT: "By an input", JumpIf.CONDITION: "On a condition"},
            help="Always, by the state of an input, or when a condition holds.",
        ),
        JumpIf.ALWAYS,
    )
    input: str = value(
        InputNumber(label="Input", when={"when": JumpIf.INPUT}, help="Its number, or its name in the setup."), "1"
    )
    level: InputLevel = value(
        Choice(label="Is", kind=InputLevel, words=LEVEL_WORDS, when={"when": JumpIf.INPUT}, help="High or low."),
        InputLevel.HIGH,
    )
    condition: str = value(
        Condition(
            label="Condition",
            when={"when": JumpIf.CONDITION},
            help="For example LEN>5, or (A<B)&(C<D). Positions and speeds of the controller are counts here.",
        ),
        "",
    )

    @classmethod
    def example(cls) -> Jump:
        return cls(target="A", when=JumpIf.CONDITION, condition="LEN>5")


class RepeatMode(StrEnum):
    COUNT = "count"
    UNTIL = "until"
    WHILE = "while"
    FOREVER = "forever"


@dc.dataclass(frozen=True, kw_only=True)
class Repeat(Instruction):
    """Runs its steps again and again."""

    title = "Repeat"
    group = Group.FLOW
    sentence = "Repeat [{count} times|until {until}|while {condition}|{mode}]"
    help = "Runs the steps inside it a number of times, until or while a condition holds, or for ever."
    container = True

    mode: RepeatMode = value(
        Choice(
            label="Repeat",
            kind=RepeatMode,
            words={
                RepeatMode.COUNT: "A number of times",
                RepeatMode.UNTIL: "Until a condition holds (at least once)",
                RepeatMode.WHILE: "While a condition holds",
                RepeatMode.FOREVER: "for ever",
            },
            help="How often.",
        ),
        RepeatMode.COUNT,
    )
    count: str = value(
        Number(label="Times", low=1, high=2147483647, whole=True, when={"mode": RepeatMode.COUNT}, help="How often."),
        "10",
    )
    until: str = value(
        Condition(label="Until", when={"mode": RepeatMode.UNTIL}, help="Tested after each turn; ends when it holds."),
        "",
    )
    condition: str = value(
        Condition(
            label="While",
            when={"mode": RepeatMode.WHILE},
            help="Tested before each turn; ends when it no longer holds.",
        ),
        "",
    )

    @classmethod
    def example(cls) -> Repeat:
        return cls(count="10")


class Routine(StrEnum):
    USER = "user"
    ININT = "ININT"
    MCTIME = "MCTIME"
    POSERR = "POSERR"
    LIMSWI = "LIMSWI"
    CMDERR = "CMDERR"
    COMINT = "COMINT"


ROUTINE_WORDS = {
    Routine.USER: "A subroutine of mine",
    Routine.ININT: "When an input interrupts",
    Routine.MCTIME: "When in-position takes too long",
    Routine.POSERR: "When the following error is too large",
    Routine.LIMSWI: "When a limit switch is reached",
    Routine.CMDERR: "When a command fails",
    Routine.COMINT: "When a character arrives",
}


@dc.dataclass(frozen=True, kw_only=True)
class Subroutine(Instruction):
    """A part of the program that is called, by a Jump or by the controller itself."""

    title = "Subroutine"
    group = Group.FLOW
    section = "S"
    sentence = "Subroutine [{name}|{routine}]"
    help = (
        "Opens a subroutine: the following instructions go into it until an End closes it. The controller calls the "
        "system subroutines by itself, while a program runs."
    )
    container = True

    routine: Routine = value(
        Choice(
            label="Called",
            kind=Routine,
            words=ROUTINE_WORDS,
            phrases={
                each: f"{each.value} ({words[0].lower()}{words[1:]})"
                for each, words in ROUTINE_WORDS.items()
                if each is not Routine.USER
            },
            help="By a Jump, or by the controller when something happens.",
        ),
        Routine.USER,
    )
    name: str = value(
        LabelName(
            label="Name", defines=True, when={"routine": Routine.USER}, help="A letter and up to 6 letters or digits."
        ),
        "",
    )

    @property
    def label(self) -> str:
        """The label it starts with, without `#`."""
        return self.name if self.routine is Routine.USER else self.routine.value

    @classmethod
    def example(cls) -> Subroutine:
        return cls(name="CUT")


class EndOf(StrEnum):
    SUBROUTINE = "subroutine"
    ERROR = "error"
    INPUT = "input"
    COMMUNICATION = "communication"


_INTERRUPTS = (EndOf.ERROR, EndOf.INPUT, EndOf.COMMUNICATION)


@dc.dataclass(frozen=True, kw_only=True)
class End(Instruction):
    """Ends a subroutine."""

    title = "End"
    group = Group.FLOW
    sentence = "End of {of}[, {keep}][, {restore}]"
    help = "Goes back to where the subroutine was called, or ends the program when nothing was called."

    of: EndOf = value(
        Choice(
            label="End of",
            kind=EndOf,
            words={
                EndOf.SUBROUTINE: "subroutine",
                EndOf.ERROR: "error or limit subroutine",
                EndOf.INPUT: "input interrupt",
                EndOf.COMMUNICATION: "communication interrupt",
            },
            help="Which kind of subroutine ends here; each kind has its own end.",
        ),
        EndOf.SUBROUTINE,
    )
    keep: bool = value(
        Flag(
            label="Go on waiting",
            phrase="go on with an interrupted wait",
            when={"of": _INTERRUPTS},
            help="If the program was waiting when it was interrupted: wait on. Off: that wait is over.",
        ),
        False,
    )
    restore: bool = value(
        Flag(
            label="Enable the interrupt again",
            phrase="enable the interrupt again",
            when={"of": EndOf.COMMUNICATION},
            help="Let the next character interrupt again.",
        ),
        False,
    )

    @classmethod
    def example(cls) -> End:
        return cls()
