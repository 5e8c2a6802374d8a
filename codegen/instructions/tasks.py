"""The group Program Flow: threads, interrupts, the stack, the screen."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc
from enum import StrEnum

from codegen.fields import Choice, InputNumber, LabelName, ListOf, Number, value
from codegen.instructions.instruction import Group, Instruction
from codegen.instructions.operator import PORT_PHRASES, PORT_WORDS, Port
from codegen.setup import Setup


class Terminal(StrEnum):
    HANDHELD = "handheld"
    ANSI = "ansi"


@dc.dataclass(frozen=True, kw_only=True)
class ClearScreen(Instruction):
    """Clears the operator's screen."""

    title = "Clear Screen"
    group = Group.FLOW
    sentence = "Clear the screen of the {terminal}[ {port}]"
    help = "Clears the operator's terminal, or the terminal window of the studio."

    port: Port = value(
        Choice(label="Port", kind=Port, words=PORT_WORDS, phrases=PORT_PHRASES, help="Where the screen is."), Port.MAIN
    )
    terminal: Terminal = value(
        Choice(
            label="Screen",
            kind=Terminal,
            words={Terminal.HANDHELD: "operator terminal", Terminal.ANSI: "terminal window"},
            help="The hand-held operator terminal, or a terminal window on a computer.",
        ),
        Terminal.ANSI,
    )

    @classmethod
    def example(cls) -> ClearScreen:
        return cls()


@dc.dataclass(frozen=True, kw_only=True)
class Execute(Instruction):
    """Starts another part of the program beside this one."""

    title = "Execute"
    group = Group.FLOW
    sentence = "Start {label} in thread {thread}"
    help = "Starts a part of the program at a label; it runs beside this one in a thread of its own."

    label: str = value(LabelName(label="Label", help="Where the thread begins."), "")
    thread: str = value(
        Number(label="Thread", low=0, high=3, whole=True, literal=True, help="0 to 3; 0 is the main one."), "1"
    )

    def own_warning(self, setup: Setup) -> tuple[str, str] | None:
        if self.thread.strip() == "0":
            return "thread", "Thread 0 is the program itself: it can be started only after it has ended"
        return None

    @classmethod
    def example(cls) -> Execute:
        return cls(label="WATCH")


class Halted(StrEnum):
    ONE = "one"
    ALL = "all"


@dc.dataclass(frozen=True, kw_only=True)
class HaltTask(Instruction):
    """Ends a thread."""

    title = "Halt Task"
    group = Group.FLOW
    sentence = "[Halt thread {thread}|Halt {which}]"
    help = "Ends one thread or all of them, this one included. Motion goes on."

    which: Halted = value(
        Choice(
            label="What",
            kind=Halted,
            words={Halted.ONE: "One thread", Halted.ALL: "all threads"},
            help="One thread, or all.",
        ),
        Halted.ONE,
    )
    thread: str = value(
        Number(
            label="Thread",
            low=0,
            high=3,
            whole=True,
            literal=True,
            when={"which": Halted.ONE},
            help="0 to 3; 0 is the main one.",
        ),
        "1",
    )

    @classmethod
    def example(cls) -> HaltTask:
        return cls()


@dc.dataclass(frozen=True, kw_only=True)
class InterruptInput:
    """One input that interrupts."""

    sentence = "{input}"

    input: str = value(InputNumber(label="Input", help="Its number, or its name in the setup."), "1")


class Interrupts(StrEnum):
    SOME = "some"
    NONE = "none"


@dc.dataclass(frozen=True, kw_only=True)
class Interrupt(Instruction):
    """Lets inputs interrupt the program."""

    title = "Interrupt"
    group = Group.FLOW
    sentence = "[Let input {inputs} interrupt the program|Let {which} interrupt the program]"
    help = (
        "When one of these inputs goes low, the subroutine ININT is called; a wait that was going on is over unless "
        "its End keeps it. The interrupt comes back with that End."
    )

    which: Interrupts = value(
        Choice(
            label="Inputs",
            kind=Interrupts,
            words={Interrupts.SOME: "These inputs", Interrupts.NONE: "no input"},
            help="These inputs, or none any more.",
        ),
        Interrupts.SOME,
    )
    inputs: tuple[InterruptInput, ...] = value(
        ListOf(
            label="Inputs",
            row=InterruptInput,
            joint=" and ",
            most=8,
            when={"which": Interrupts.SOME},
            help="Any of them interrupts.",
        ),
        (InterruptInput(),),
    )

    @classmethod
    def example(cls) -> Interrupt:
        return cls(inputs=(InterruptInput(input="1"), InterruptInput(input="4")))


class Levels(StrEnum):
    ONE = "one"
    ALL = "all"


@dc.dataclass(frozen=True, kw_only=True)
class ZeroStack(Instruction):
    """Forgets where subroutines were called."""

    title = "Zero Subroutine Stack"
    group = Group.FLOW
    sentence = "Forget {levels}"
    help = "Forgets where the subroutine was called, so that the program goes on here instead of going back."

    levels: Levels = value(
        Choice(
            label="Forget",
            kind=Levels,
            words={Levels.ONE: "the last call", Levels.ALL: "all calls"},
            help="The last call only, or all of them.",
        ),
        Levels.ONE,
    )

    @classmethod
    def example(cls) -> ZeroStack:
        return cls()
