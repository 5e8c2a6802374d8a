"""The group Configuration: communication, recorded data, the machine's own settings."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc
from enum import StrEnum

from codegen.fields import AxisName, Choice, Flag, ListOf, Number, VariableName, value
from codegen.instructions.instruction import Group, Instruction
from codegen.numbers import parse_number
from codegen.setup import Setup


class Link(StrEnum):
    PORT = "port"
    INTERRUPT = "interrupt"


class PortMode(StrEnum):
    GENERAL = "general"
    CHAIN = "chain"


class Baud(StrEnum):
    B300 = "300"
    B1200 = "1200"
    B4800 = "4800"
    B9600 = "9600"
    B19200 = "19200"
    B38400 = "38400"


class Interrupting(StrEnum):
    NONE = "none"
    LINE = "line"
    CHARACTER = "character"
    CLEAR = "clear"


INTERRUPT_WORDS = {
    Interrupting.NONE: "no interrupt",
    Interrupting.LINE: "on Enter",
    Interrupting.CHARACTER: "on every character",
    Interrupting.CLEAR: "forget what came in",
}
_PORT = {"what": Link.PORT}
_INTERRUPT = {"what": Link.INTERRUPT}


@dc.dataclass(frozen=True, kw_only=True)
class Communication(Instruction):
    """Sets up port 2, or lets characters interrupt the program."""

    title = "Communication"
    group = Group.CONFIGURATION
    section = "C"
    sentence = (
        "[Port 2 at {baud} baud[, {handshake}], {mode}[, {echo}]"
        "|Interrupt by characters: port 1 {first}, port 2 {second}[, {live}]]"
    )
    help = (
        "Port 2 must be set up before it is used. Characters can call the subroutine COMINT. With live data the "
        "studio, its terminal and Stop no longer reach the controller until the mode is left with \\ or Escape."
    )

    what: Link = value(
        Choice(
            label="What",
            kind=Link,
            words={Link.PORT: "Port 2", Link.INTERRUPT: "Interrupt by characters"},
            help="The second port, or interrupts by characters.",
        ),
        Link.PORT,
    )
    baud: Baud = value(Choice(label="Baud", kind=Baud, when=_PORT, help="Speed of port 2."), Baud.B9600)
    handshake: bool = value(
        Flag(label="Handshake", phrase="with handshake", when=_PORT, help="Hardware handshake of port 2."), False
    )
    mode: PortMode = value(
        Choice(
            label="Use",
            kind=PortMode,
            words={PortMode.GENERAL: "for messages and data", PortMode.CHAIN: "as a daisy chain"},
            when=_PORT,
            help="For an operator terminal, or to pass commands on to the next controller.",
        ),
        PortMode.GENERAL,
    )
    echo: bool = value(
        Flag(
            label="Echo",
            phrase="with echo",
            when={"what": Link.PORT, "mode": PortMode.GENERAL},
            help="Send characters back.",
        ),
        False,
    )
    first: Interrupting = value(
        Choice(
            label="Port 1",
            kind=Interrupting,
            words=INTERRUPT_WORDS,
            when=_INTERRUPT,
            help="What interrupts from port 1.",
        ),
        Interrupting.NONE,
    )
    second: Interrupting = value(
        Choice(
            label="Port 2",
            kind=Interrupting,
            words=INTERRUPT_WORDS,
            when=_INTERRUPT,
            help="What interrupts from port 2.",
        ),
        Interrupting.LINE,
    )
    live: bool = value(
        Flag(
            label="Live data on port 1",
            phrase="live data on port 1",
            when=_INTERRUPT,
            help="Characters on port 1 are data, no commands: the studio and its Stop no longer reach the controller.",
        ),
        False,
    )

    def own_warning(self, setup: Setup) -> tuple[str, str] | None:
        if self.what is Link.INTERRUPT and self.live:
            return "live", "Stop and the terminal no longer reach the controller while port 1 has live data"
        return None

    @classmethod
    def example(cls) -> Communication:
        return cls(baud=Baud.B19200, echo=True)


@dc.dataclass(frozen=True, kw_only=True)
class ExtendedIO(Instruction):
    """More inputs and outputs, which none of the controllers has."""

    title = "Extended I/O"
    group = Group.CONFIGURATION
    section = "C"
    sentence = "Extended I/O"
    help = "Sets up additional inputs and outputs of controllers that have them."
    needs = "None of these controllers has extended inputs and outputs"

    @classmethod
    def example(cls) -> ExtendedIO:
        return cls()


class Source(StrEnum):
    POSITION = "TP"
    COMMANDED = "SH"
    ERROR = "TE"
    AUXILIARY = "DE"
    LATCH = "RL"
    TORQUE = "TT"
    SWITCHES = "TS"
    STOP = "SC"
    STATUS = "NO"
    INPUTS = "TI"
    OUTPUTS = "OP"


SOURCE_WORDS = {
    Source.POSITION: "position",
    Source.COMMANDED: "commanded position",
    Source.ERROR: "following error",
    Source.AUXILIARY: "auxiliary encoder",
    Source.LATCH: "latched position",
    Source.TORQUE: "motor command",
    Source.SWITCHES: "switches",
    Source.STOP: "stop code",
    Source.STATUS: "status bits",
    Source.INPUTS: "inputs",
    Source.OUTPUTS: "outputs",
}
OF_AXIS = tuple(source for source in Source if source not in (Source.INPUTS, Source.OUTPUTS))


@dc.dataclass(frozen=True, kw_only=True)
class Recording:
    """One array and what is recorded in it."""

    sentence = "{source}[ of {axis}] in {array}"

    array: str = value(VariableName(label="Array", array=True, help="The array that is filled."), "")
    size: str = value(
        Number(
            label="Elements",
            low=1,
            high=8000,
            whole=True,
            literal=True,
            required=False,
            help="Dimensions the array here; empty when Variable and Array has done it.",
        ),
        "",
    )
    source: Source = value(
        Choice(label="Records", kind=Source, words=SOURCE_WORDS, help="What is recorded."), Source.POSITION
    )
    axis: str = value(AxisName(label="Of", when={"source": OF_AXIS}, help="The axis it is recorded of."), "X")


class Interval(StrEnum):
    MS2 = "1"
    MS4 = "2"
    MS8 = "3"
    MS16 = "4"
    MS32 = "5"
    MS64 = "6"
    MS128 = "7"
    MS256 = "8"


@dc.dataclass(frozen=True, kw_only=True)
class RecordData(Instruction):
    """Records values in arrays while the program goes on."""

    title = "Record Data"
    group = Group.CONFIGURATION
    section = "C/M"
    sentence = "Record {recordings} every {interval}[, {count} times][, {endless}]"
    help = "Records up to four values in arrays at a fixed interval, in the background, once or over and over."

    recordings: tuple[Recording, ...] = value(
        ListOf(label="Arrays", row=Recording, most=4, help="One to four arrays."), (Recording(),)
    )
    interval: Interval = value(
        Choice(
            label="Every",
            kind=Interval,
            words={each: f"{2 ** int(each)} samples" for each in Interval},
            help="The interval, a power of two of samples.",
        ),
        Interval.MS2,
    )
    endless: bool = value(
        Flag(label="Without end", phrase="over and over", help="Begin again when the arrays are full."), False
    )
    count: str = value(
        Number(
            label="How often",
            low=1,
            high=8000,
            whole=True,
            literal=True,
            required=False,
            help="How many values; empty fills the smallest array.",
        ),
        "",
    )

    @property
    def values(self) -> str:
        """How many values are recorded: as given, or as many as the smallest array made here holds."""
        sizes = [row.size.strip() for row in self.recordings]
        return self.count.strip() or (min(sizes, key=int) if all(map(str.isdecimal, sizes)) else "")

    def own_problem(self) -> tuple[str, str] | None:
        arrays = [row.array.strip() for row in self.recordings]
        if twice := next((each for each in arrays if arrays.count(each) > 1), None):
            return "recordings", f"Arrays: {twice} is there twice"
        sizes = [int(row.size) for row in self.recordings if row.size.strip().isdecimal()]
        if sizes and self.count.strip().isdecimal() and int(self.count) > min(sizes):
            return "count", f"How often must be at most {min(sizes)}, the elements of the smallest array"
        if self.endless and not self.values:
            return "count", "How often is missing (the size of the arrays that are filled over and over)"
        return None

    def setup_problem(self, setup: Setup) -> tuple[str, str] | None:
        made, limits = sum(int(parse_number(row.size) or 0) for row in self.recordings), setup.limits
        if made > limits.elements:
            return "recordings", f"Arrays: {made} elements together; the {limits.title} has room for {limits.elements}"
        if len(self.recordings) > limits.recorded_channels:
            return "recordings", f"Arrays: the {limits.title} records {limits.recorded_channels} at a time"
        return None

    @classmethod
    def example(cls) -> RecordData:
        return cls(
            recordings=(Recording(array="POS", size="500"), Recording(array="ERR", size="500", source=Source.ERROR))
        )


@dc.dataclass(frozen=True, kw_only=True)
class UserSetup(Instruction):
    """Sends what the machine's setup holds."""

    uses_setup = True

    title = "User Setup Settings"
    group = Group.CONFIGURATION
    section = "C"
    sentence = "Send from the machine's setup[{motors}][{encoders}][{pid}][{feed_forward}][{smoothing}][{limits}]"
    help = (
        "Sends settings of the machine's setup at the start of the program, so that programs for different machines "
        "can follow each other. Values that the setup leaves empty are not sent."
    )

    motors: bool = value(
        Flag(label="Motor types", phrase=" · motor types", help="Kind and polarity of the motors."), False
    )
    encoders: bool = value(Flag(label="Encoders", phrase=" · encoders", help="Kinds of the encoders."), False)
    pid: bool = value(Flag(label="PID gains", phrase=" · gains", help="Gains of the control loop."), True)
    feed_forward: bool = value(Flag(label="Feed forward", phrase=" · feed forward", help="Feed-forward gains."), True)
    smoothing: bool = value(Flag(label="Smoothing", phrase=" · smoothing", help="Smoothing of the profiles."), True)
    limits: bool = value(
        Flag(
            label="Limits",
            phrase=" · limits",
            help="Position, following error, torque, integrator, motor off on error.",
        ),
        True,
    )

    def own_problem(self) -> tuple[str, str] | None:
        chosen = (self.motors, self.encoders, self.pid, self.feed_forward, self.smoothing, self.limits)
        return None if any(chosen) else ("pid", "Choose what is sent")

    @classmethod
    def example(cls) -> UserSetup:
        return cls()
