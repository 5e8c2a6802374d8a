"""One simulated controller with its machine: bytes and stimuli in, time by argument, bytes and facts out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from codegen.models import Model
from device.simulator import report, signals
from device.simulator.copying import clone
from device.simulator.eeprom import Eeprom
from device.simulator.motion import Motion
from device.simulator.plant import Plant
from device.simulator.twoletter import memory
from device.simulator.twoletter.behaviour.flow import BAD_LINE
from device.simulator.twoletter.memory import DownloadRefused
from device.simulator.twoletter.profile import Profile
from device.simulator.twoletter.records import ProgramError
from device.simulator.twoletter.state import AXES, CommandError, State
from device.simulator.twoletter.threads import Interpreter
from device.simulator.twoletter.unit import Unit
from device.simulator.uart import Uart

__all__ = ["CommandError", "DownloadRefused", "Simulation", "Snapshot"]


@dataclass(frozen=True, slots=True)
class Snapshot:
    """Everything of one moment; restoring it and running again gives the same."""

    state: State
    uarts: tuple[Uart, ...]
    motion: Any
    clock: tuple[int, int, int, int]
    eeprom: dict[str, Any]


class Simulation:
    """Joins interpreter, ports and motion; all of them run on the same ticks."""

    def __init__(
        self,
        model: Model,
        plants: Mapping[str, Plant] | None = None,
        eeprom: Eeprom | None = None,
        baud: int | None = None,
        seed: int = 0,
        compiled: bool | None = None,
        handshake: bool = True,
        profile: Profile | None = None,
    ) -> None:
        machines = [(plants or {}).get(letter, Plant()) for letter in AXES[: len(model.axes)]]
        jumpers = [machine.drive == "stepper" for machine in machines]
        self.model = model
        self.motion = Motion(len(model.axes), machines, seed=seed, compiled=compiled)
        profile = profile or Profile()
        received, waiting = profile.receive_buffer, profile.output_fifo
        self.uarts = (
            Uart(baud=baud, handshake=handshake, receive_size=received, output_size=waiting, xon_xoff=True),
            Uart(handshake=False, receive_size=received, output_size=waiting),
        )
        self.port.tells_xoff = profile.sends_xoff
        self.unit = Unit(model, self.motion, self.uarts, eeprom or Eeprom(), profile, jumpers)
        self.interpreter = Interpreter(self.unit)

    # -------------------------------------------------------------------- time

    @property
    def ticks(self) -> int:
        """Virtual time; 1024 ticks are a true millisecond."""
        return self.unit.clock.now

    def advance(self, ticks: int) -> None:
        """Carries out everything up to and including `ticks` from now; the same at any slicing."""
        self.interpreter.advance(self.ticks + ticks)

    def run_until_idle(self, limit_ticks: int) -> str:
        """Until no thread runs and nothing moves: "end"; at the limit "time"; "error" when a program error ends it."""
        limit = self.ticks + limit_ticks
        known = self.unit.records.unhandled
        while self.ticks < limit:
            self.interpreter.advance(limit, until_idle=True)
            if self.unit.records.unhandled > known:
                return "error"
            back = self.unit.state.reset_at
            if back >= 0:  # what runs after a reset is known when the controller is back
                self.interpreter.advance(min(limit, back + self.unit.clock.period))
            elif not self.unit.running():
                if not self.unit.moving() and self.unit.state.command_at < 0:
                    return "end"
                self._let_move(limit)
        return "time"

    def _let_move(self, limit: int) -> None:
        """To the sample in which an axis comes to rest where nothing else is due, else one sample on."""
        clock, motion, samples = self.unit.clock, self.unit.motion, 1
        if self.interpreter.rests():
            motion.guard_moves()
            while clock.tick + clock.period <= limit and not motion.guard_broken:
                clock.sync(limit)
            motion.drop_guards()
            samples = max(1, -(-(clock.tick - self.ticks) // clock.period))
        self.interpreter.advance(min(limit, self.ticks + samples * clock.period))

    def rest(self, records: int) -> None:
        """Between two slices of real time: the motion is brought up to now, old records are forgotten."""
        self.unit.clock.catch_up(self.ticks)
        self.unit.records.keep(records)

    # ------------------------------------------------------------------- bytes

    @property
    def port(self) -> Uart:
        """Port 1: the host's line."""
        return self.uarts[0]

    def line(self, port: int) -> Uart:
        """A port's end of its line."""
        return self.uarts[port - 1]

    @property
    def motions(self) -> tuple[Motion]:
        """All the motion there is."""
        return (self.motion,)

    def receive(self, port: int, data: bytes) -> None:
        """Characters handed to the line of a port now."""
        self.uarts[port - 1].receive(data, self.ticks)

    def transmit(self, port: int) -> bytes:
        """Characters that have left a port since the last call."""
        uart = self.uarts[port - 1]
        uart.run(self.ticks)
        return uart.transmit()

    # ----------------------------------------------------------- outside world

    def stimulus(self, signal: str, value: float | str) -> None:
        """Something happens to the machine now; signal names as in a stimulus file."""
        signals.apply(self, signal, value)

    # ----------------------------------------------------------------- program

    def load_program(self, text: str) -> None:
        """Puts a program into the memory as a download does; the host's comments are left out."""
        lines = tuple(line.rstrip("\r") for line in text.split("\n") if not memory.is_host_comment(line.rstrip("\r")))
        if lines and not lines[-1]:
            lines = lines[:-1]
        memory.check_program(lines, self.model)
        self.unit.halt_all()
        self.unit.set_program(lines)

    def execute(self, target: str | int = 0, thread: int = 0) -> None:
        """Starts a thread at a label ("#A") or line."""
        code = self.unit.code
        if isinstance(target, str):
            label = target.removeprefix("#")
            if label not in code.labels:
                raise CommandError(self.unit.profile.unknown_label_code)
            self.unit.start(thread, code.labels[label])
            return
        if not 0 <= target < len(code.start_of):
            raise CommandError(BAD_LINE if code.start_of else self.unit.profile.unknown_label_code)
        self.unit.start(thread, code.start_of[target])

    # ------------------------------------------------------------------- facts

    @property
    def messages(self) -> list[tuple[float, int, str]]:
        """Everything sent unasked: true milliseconds, port, text."""
        return self.unit.records.messages

    @property
    def errors(self) -> list[ProgramError]:
        """Errors of programs, also those that #CMDERR took."""
        return self.unit.records.errors

    @property
    def notices(self) -> list[str]:
        """What the simulator could not do and says so."""
        return self.unit.notices

    @property
    def on_trace(self) -> Callable[[int, int, int], None] | None:
        """Called with (ticks, thread, line) as a thread comes to a line; line -1 when it ends."""
        return self.unit.records.on_trace

    @on_trace.setter
    def on_trace(self, hook: Callable[[int, int, int], None] | None) -> None:
        self.unit.records.on_trace = hook

    def state(self) -> dict[str, Any]:
        """The state as `run --json` prints it."""
        return report.state(self)

    # --------------------------------------------------------------- snapshots

    def snapshot(self) -> Snapshot:
        """A copy of everything that is simulated (not of the records)."""
        clock = self.unit.clock
        return Snapshot(
            clone(self.unit.state),
            clone(self.uarts),
            self.motion.snapshot(),
            (clock.now, clock.tick, clock.sample, clock.period),
            self.unit.eeprom.copy_parts(),
        )

    def restore(self, snapshot: Snapshot) -> None:
        """Goes back to a snapshot."""
        unit = self.unit
        program = unit.state.program
        unit.state = clone(snapshot.state)
        for uart, saved in zip(self.uarts, snapshot.uarts, strict=True):
            for name in Uart.__slots__:
                setattr(uart, name, clone(getattr(saved, name)))
        self.motion.restore(snapshot.motion)
        unit.clock.now, unit.clock.tick, unit.clock.sample, unit.clock.period = snapshot.clock
        unit.eeprom.restore_parts(snapshot.eeprom)
        if unit.state.program != program:
            unit.set_program(unit.state.program)
        unit.changed = True
