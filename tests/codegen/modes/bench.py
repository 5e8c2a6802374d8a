"""Runs one instruction on the simulated controller and reads, over its serial port, what the controller then says.

What is known of the moment the program goes on behind the instruction is kept by the program itself: `T0` and `T1`
(TIME before and after) and `ATX` … `ATW` (commanded positions), `ENCX` … (encoders).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise

from codegen.document import Document
from codegen.generate import Listing, generate
from codegen.instructions import Instruction, Repeat, Subroutine, TwoLetterCode
from codegen.instructions.flow import RepeatMode
from codegen.models import model
from codegen.program import Program, Step
from codegen.setup import Axis, EncoderType, MotorType, Setup, Unit
from device.simulator.plant import Plant
from device.simulator.simulation import Simulation

MS = 1024  # ticks in a true millisecond
SAMPLES = 1024  # in a second at TM 1000; TIME counts them
TICKS = 1000  # in a sample at TM 1000

# X 4000 and Y 2000 counts/in (circles need ES), Z 10 counts/deg, W 100 counts/mm
MACHINE = Setup(
    model="ssc4",
    axes=(
        Axis(counts_per_unit="4000"),
        Axis(counts_per_unit="2000"),
        Axis(unit=Unit.DEGREE, counts_per_unit="10"),
        Axis(unit=Unit.MM, counts_per_unit="100"),
    ),
    input_names=("START", "", "", "", "", "", "", ""),
    output_names=("", "", "CUTTER", "", "", "", "", ""),
)
ONE_UNIT = Setup(model="ssc4", axes=(Axis(counts_per_unit="4000"),) * 4)
STEPPER = MACHINE.with_axis("Y", Axis(counts_per_unit="2000", motor=MotorType.STEPPER_LOW))
FULL = MACHINE.with_axis(
    "X",
    Axis(
        counts_per_unit="4000",
        motor=MotorType.SERVO_REVERSED,
        main_encoder=EncoderType.QUADRATURE_REVERSED,
        kp="9",
        ki="1",
        kd="70",
        fv="3",
        fa="2",
        smoothing="128",
        forward_limit="5",
        reverse_limit="-5",
        error_limit="0.5",
        torque_limit="8",
        integrator_limit="4",
    ),
)

World = tuple[tuple[float, str, float | str], ...]  # (seconds after the start, signal, value)
Steps = tuple[Instruction, ...]


class Seen:
    """The controller after a run: what it answers, what it sent, where its axes were."""

    def __init__(self, mode: Mode, instruction: Instruction | None) -> None:
        self.mode = mode
        self.listing: Listing = generate(document(mode, instruction))
        assert self.listing.is_complete, [each.message for each in self.listing.problems]
        machine = mode.setup
        steppers = {letter: Plant(drive="stepper") for letter in machine.letters if machine.axis(letter).is_stepper}
        self.simulation = Simulation(model(machine.model), {**mode.plants, **steppers}, baud=19200)
        self.track: list[tuple[int, ...]] = []
        self.sent = {1: "", 2: ""}
        self.second_port: list[int] = []  # characters in each slice
        self._run()

    def _run(self) -> None:
        simulation, world = self.simulation, sorted(self.mode.world)
        for number in range(1, 9):
            simulation.stimulus(f"in{number}", 1)
        simulation.load_program(self.listing.text)
        simulation.execute(0, 0)
        every = self.mode.every
        for number in range(round(self.mode.seconds * SAMPLES / every)):
            while world and world[0][0] * SAMPLES <= number * every:
                _, signal, value = world.pop(0)
                simulation.stimulus(signal, value)
            simulation.advance(every * TICKS)
            self._look()

    def _look(self) -> None:
        motion = self.simulation.unit.motion
        self.track.append(tuple(motion.reference(axis) for axis in range(len(self.mode.setup.letters))))
        for port in (1, 2):
            text = self.simulation.transmit(port).decode("latin-1")
            self.sent[port] += text
            if port == 2:
                self.second_port.append(len(text))

    def __getitem__(self, expression: str) -> float:
        """The value of an expression, asked for over port 1."""
        if expression not in self.known:
            answer = self.typed(f"MG {expression}{{F10.4}}")
            assert answer, f"no answer for {expression}"
            self.known[expression] = float(answer)
        return self.known[expression]

    @cached_property
    def known(self) -> dict[str, float]:
        return {}

    def typed(self, line: str) -> str:
        """What the controller answers to a line, without prompt and line end."""
        simulation = self.simulation
        simulation.transmit(1)
        simulation.receive(1, line.encode("latin-1") + b"\r")
        simulation.advance(200 * MS)
        text = simulation.transmit(1).decode("latin-1")
        assert text.endswith((":", "?")), (line, text)
        return text[:-1].strip("\r\n ")

    @property
    def errors(self) -> list[object]:
        """Program errors so far."""
        return list(self.simulation.errors)

    @property
    def waited(self) -> float:
        """Samples between the statement before the instruction and the one behind it."""
        return self["T1"] - self["T0"]

    def at(self, letter: str) -> float:
        """Commanded position when the program went on behind the instruction, counts."""
        return self[f"AT{letter}"]

    def speeds(self, letter: str) -> list[float]:
        """Commanded speed from look to look, counts/s."""
        place = self.mode.setup.letters.index(letter)
        way = [row[place] for row in self.track]
        return [(after - before) * SAMPLES / self.mode.every for before, after in pairwise(way)]


Oracle = Callable[[Seen, Seen, Setup], bool]


@dataclass(frozen=True)
class Mode:
    """One way an instruction can be used, and what its sentence promises."""

    does: Instruction
    says: str  # the sentence, typed by hand
    holds: Oracle
    first: Steps = ()  # steps before it, also in the run it is compared with
    then: Steps = ()  # steps behind it
    body: Steps = ()  # of a repeat or a subroutine
    routines: tuple[tuple[Subroutine, Steps], ...] = ()
    world: World = ()
    setup: Setup = MACHINE
    seconds: float = 1.0
    every: int = 10  # samples from look to look
    fails: bool = False  # an error of the program belongs to it
    stays: bool = True  # thread 0 goes on with an endless loop, so that routines can be called
    plants: dict[str, Plant] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """For the list of tests."""
        return f"{type(self.does).__name__}: {self.says[:60]}"


def code(text: str) -> TwoLetterCode:
    """Lines written by hand."""
    return TwoLetterCode(text=text)


KEEP = "\n".join(f"AT{letter}=_RP{letter}\nENC{letter}=_TP{letter}" for letter in "XYZW")


def steps(prefix: str, instructions: Steps) -> tuple[Step, ...]:
    """Instructions as steps."""
    return tuple(Step(f"{prefix}{number}", each) for number, each in enumerate(instructions))


def document(mode: Mode, instruction: Instruction | None) -> Document:
    """The program around an instruction; without it, what the effect is compared with."""
    letters = mode.setup.letters
    keep = "\n".join(line for line in KEEP.split("\n") if line[-1] in letters)
    early = mode.does.section == "C"
    configuration = steps("f", mode.first) if early else ()
    main = steps("m", (*(() if early else mode.first), TwoLetterCode(text="T0=TIME")))
    routines = tuple(
        Step(f"r{number}", start, body=steps(f"r{number}b", body)) for number, (start, body) in enumerate(mode.routines)
    )
    if isinstance(instruction, Subroutine):
        routines = (*routines, Step("it", instruction, body=steps("b", mode.body)))
    elif instruction is not None and instruction.section == "C":
        configuration = (*configuration, Step("it", instruction))
    elif instruction is not None:
        main = (*main, Step("it", instruction, body=steps("b", mode.body)))
    main = (*main, Step("k", TwoLetterCode(text=f"T1=TIME\n{keep}")), *steps("t", mode.then))
    if mode.stays:
        main = (*main, Step("e", Repeat(mode=RepeatMode.FOREVER), body=steps("w", (TwoLetterCode(text="WT 10"),))))
    return Document(Program("P", configuration=configuration, main=main, routines=routines), mode.setup)
