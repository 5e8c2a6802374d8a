"""Every simulated fact that is not motion: plain values, so that the whole state can be copied and compared."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, TypeAlias

from codegen.models import Model

AXES: Final = "XYZW"
FOREVER: Final = 1 << 62


class CommandError(Exception):
    """A command was refused with one of the controller's error codes."""

    def __init__(self, code: int) -> None:
        super().__init__(code)
        self.code = code


class NotYet(Exception):
    """A command of a program that must wait before it can be carried out."""

    def __init__(self, wait: Wait) -> None:
        super().__init__(wait.kind)
        self.wait = wait


@dataclass(slots=True)
class Wait:
    """What a thread or a port waits for."""

    kind: str  # the trippoint's letters, or "output", "input", "burn"
    wake: int = FOREVER  # tick at which it is over
    sample: int = -1  # sample number at which it is over (then `wake` follows TM)
    watches: tuple[int, ...] = ()  # motion watches, all of which must trip
    axes: tuple[int, ...] = ()
    number: int = 0  # input number, port number, distance
    level: bool = False
    reference: int = -1  # AT -n: what becomes the new reference
    variable: str = ""  # IN: where the answer goes
    element: int = -1
    characters: int = 0  # IN: 0 a number, else so many characters of text


@dataclass(slots=True)
class Frame:
    """A place to go back to."""

    pc: int
    kind: str  # "JS" or the automatic routine's label
    wait: Wait | None = None  # the trippoint that the routine interrupted


@dataclass(slots=True)
class Thread:
    number: int
    running: bool = False
    pc: int = 0
    wait: Wait | None = None
    stack: list[Frame] = field(default_factory=list)
    reference: int = 0  # AT 0, in samples
    line: int = -1  # the line last traced
    traced: bool = False  # the command at `pc` has been traced and waits for room in the output
    is_port: bool = False


@dataclass(slots=True)
class Port:
    """What one serial port is about to do; the characters themselves are in its UART."""

    number: int
    mode: str = "command"  # command, download, array, edit
    silent: bool = False  # another controller of the daisy chain answers
    text: bytearray = field(default_factory=bytearray)  # the line being received
    too_long: bool = False
    control: bool = False  # ^R was the last character
    pending: str | None = None  # the line being executed
    position: int = 0  # its next command
    wait: Wait | None = None
    reference: int = 0
    download: Download | None = None
    edit_line: int = 0
    edit_fresh: bool = True  # nothing typed yet on the line shown
    is_port: bool = True
    # operator data
    last_character: int = 0
    last_text: bytes = b""
    data_status: int = 0
    data_text: bytearray = field(default_factory=bytearray)
    running: bool = False  # for the scheduler: ports are never threads


Strand: TypeAlias = Thread | Port
"""Whatever has commands carried out for it."""


@dataclass(slots=True)
class Download:
    """A download under way: of a program (`array` empty) or of an array."""

    lines: list[str] = field(default_factory=list)
    before: tuple[str, ...] = ()
    after: tuple[str, ...] = ()
    error: int = 0
    array: str = ""
    index: int = 0
    last: int = 0


@dataclass(slots=True)
class FieldTest:
    """BZ or BS under way: a field held still draws the motor along."""

    kind: str
    volts: float
    start: int  # position at which it began
    stage: str = "zero"
    looks: int = 0
    mark: int = 0
    phase_ms: int = 0
    seen: list[tuple[int, int]] = field(default_factory=list)  # position and hall levels at each step of BS


@dataclass(slots=True)
class Recording:
    """RA, RD, RC: the channels, and how far the capture is."""

    arrays: list[str] = field(default_factory=list)
    sources: list[tuple[str, int]] = field(default_factory=list)  # operand, axis
    interval: int = 0  # samples between elements; 0: not recording
    sample: int = 0  # number of the sample that is taken next
    index: int = 0
    count: int = 0
    circular: bool = False


@dataclass(slots=True)
class State:
    """The controller without its motion; the registers hold 1/65536 as all its numbers do."""

    registers: dict[str, list[int]] = field(default_factory=dict)  # per axis
    settings: dict[str, int] = field(default_factory=dict)  # one value each
    modes: list[str] = field(default_factory=list)  # per axis, what the next BG does: PA PR JG HM FE FI
    last_speed: list[int] = field(default_factory=list)  # per axis, of the last JG or SP: speed of FI
    switches: list[int] = field(default_factory=lambda: [-1, -1, -1])  # CN
    port_two: list[int] = field(default_factory=lambda: [9600, 0, 0, 0])  # CC
    interrupts: list[int] = field(default_factory=lambda: [0, 0, 0])  # CI
    comint_armed: bool = False
    comint_due: bool = False
    inputs: int = 255  # levels, bit 0 = input 1
    gear_master: int = -1  # axis that is its own slaves' master, GA
    contour_timed: bool = False  # DT has been given
    cam_master: int = -1  # EA
    cam_cycle: int = 0
    cam_interval: list[int] = field(default_factory=lambda: [256, 0])  # EP
    tangent: list[int] = field(default_factory=lambda: [0, 0])  # TN
    recording: Recording = field(default_factory=Recording)
    selected: bool = True  # the last %n was this one's address
    brushless: bool = False  # BA
    field_test: FieldTest | None = None  # BZ, BS
    analog: list[int] = field(default_factory=lambda: [0] * 8)  # 1/65536 V
    abort_input: bool = True
    outputs: int = 0
    interrupt_mask: int = 0  # II
    interrupt_armed: bool = False
    variables: dict[str, int] = field(default_factory=dict)
    strings: set[str] = field(default_factory=set)  # variables last given text
    arrays: dict[str, list[int]] = field(default_factory=dict)
    program: tuple[str, ...] = ()
    threads: list[Thread] = field(default_factory=list)
    ports: list[Port] = field(default_factory=list)
    error_code: int = 0
    error_line: int = 0
    clock_offset: int = 0  # sample number at power-up: TIME counts from there
    turn: int = 0  # the strand that was served last
    command_at: int = -1  # tick at which the command in the interpreter is done; -1: none
    busy_until: int = 0  # tick until which the EEPROM is written and nothing else is done
    reset_at: int = -1  # tick at which a reset is over; -1: none under way

    def strands(self) -> list[Strand]:
        """Threads, then ports."""
        return [*self.threads, *self.ports]

    def waiting(self) -> list[Strand]:
        """Those that wait for something."""
        found: list[Strand] = []
        for thread in self.threads:  # no comprehension: this runs for every character
            if thread.wait is not None:
                found.append(thread)
        for port in self.ports:
            if port.wait is not None:
                found.append(port)
        return found


def fresh(model: Model) -> State:
    """The state before anything is loaded: threads and ports only."""
    state = State()
    state.inputs = (1 << model.inputs) - 1
    state.analog = [0] * model.analog_inputs
    state.threads = [Thread(number) for number in range(model.threads)]
    state.ports = [Port(1), Port(2)]
    return state
