"""One simulated controller, as its commands see it: state, motion, ports, memory and the ways to answer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from codegen.models import Model
from codegen.twoletter.fixed import ONE, places, string_text
from codegen.twoletter.format import format_number
from codegen.twoletter.nodes import Format
from codegen.twoletter.problems import ERROR_TEXTS
from device.simulator.eeprom import Eeprom
from device.simulator.motion import Motion
from device.simulator.times import TICKS_PER_MS
from device.simulator.twoletter import reset
from device.simulator.twoletter.arithmetic import others
from device.simulator.twoletter.clock import Clock
from device.simulator.twoletter.compile import Code, Op, compile_line, compile_program
from device.simulator.twoletter.names import SimulatedNames
from device.simulator.twoletter.profile import Profile
from device.simulator.twoletter.records import Records
from device.simulator.twoletter.state import CommandError, Frame, Port, Strand, Thread, Wait, fresh
from device.simulator.uart import Uart

if TYPE_CHECKING:
    from device.simulator.twoletter.state import State


UNSIGNED = frozenset({"TC", "TS", "TB", "SC", "TI"})  # replies without a sign column where status_sign is off
RETURN = b"\r\n"


class Unit:
    """Everything a command may look at or change. Motion is reached through `motion`, which first catches up."""

    def __init__(
        self,
        model: Model,
        motion: Motion,
        uarts: Sequence[Uart],
        eeprom: Eeprom,
        profile: Profile | None = None,
        jumpers: Sequence[bool] = (),
    ) -> None:
        self.profile = profile or Profile()
        self.model = model = self.profile.model(model)
        self.rows = self.profile.rows()
        self.worked_out = others(self.profile)
        self.clock = Clock(motion)
        self.uarts = uarts
        self.eeprom = eeprom
        self.stepper_jumpers = tuple(jumpers)
        self.chained = False  # one of a daisy chain: at power-up only address 0 listens
        self.jumper_address = 0  # JP20 of an SSC
        self.hall_mask = motion.commutation.hall_mask()
        self.records = Records()
        self.notices: list[str] = []
        self.state: State = fresh(model)
        self.names = SimulatedNames(self)
        self.changed = True  # something that the scheduler must look at has happened
        self.stalled = 0  # port whose FIFO is over-full since the last command
        self.routines: tuple[str, ...] = ()  # the automatic routines that the program has
        self.code = Code()
        self._lines: dict[str, list[Op]] = {}
        reset.power_up(self)

    # ------------------------------------------------------------------ motion

    @property
    def motion(self) -> Motion:
        """The motion, with every sample up to now taken."""
        clock = self.clock
        if clock.now >= clock.tick + clock.period:
            clock.catch_up(clock.now)
        return clock.motion

    @property
    def inputs(self) -> int:
        """Levels of the inputs, bit 0 = input 1; hall sensors drive theirs."""
        levels = self.state.inputs
        return levels & ~self.hall_mask | self.motion.inputs() & self.hall_mask if self.hall_mask else levels

    @property
    def address(self) -> int:
        """Its place in a daisy chain: SA, or the jumpers JP20 of an SSC (SSC manual l.1199)."""
        return self.jumper_address if self.model.family == "ssc" else self.state.settings["SA"] // ONE

    def choose_at_start(self) -> None:
        """Who is talked to before the first %n: the only one, or address 0."""
        self.state.selected = not self.chained or self.address == 0
        self.state.ports[0].silent = not self.state.selected

    def end_field(self) -> None:
        """BZ or BS is over: the motor is off, the phase here is that of the field."""
        if self.state.field_test is not None:
            self.state.field_test = None
            self.motion.commutation.release(0)

    @property
    def sample(self) -> int:
        """Number of the last sample."""
        return self.clock.sample_at(self.clock.now)

    def after_ms(self, milliseconds: int) -> int:
        """The tick so many true milliseconds from now."""
        return self.clock.now + milliseconds * TICKS_PER_MS

    def axes(self) -> range:
        return range(len(self.model.axes))

    def moving(self) -> bool:
        """Whether any axis moves."""
        motion = self.motion
        return any(motion.moving(axis) for axis in self.axes())

    def set_sample_time(self, period: int) -> None:
        """TM: the next sample comes a new period after the last; waits in samples follow."""
        self.motion  # noqa: B018  every sample up to now is taken with the old period
        self.clock.set_period(self.profile.period(period))
        self._move_waits()

    def take_clock(self, source: Clock) -> None:
        """An external sample clock: samples come when those of the source come."""
        clock = self.clock
        if clock.period == source.period and (clock.tick - source.tick) % source.period == 0:
            return
        self.motion  # noqa: B018
        clock.set_period(source.period)
        clock.tick = clock.now - (clock.now - source.tick) % source.period
        self._move_waits()

    def _move_waits(self) -> None:
        for strand in self.state.strands():
            if strand.wait is not None and strand.wait.sample >= 0:
                strand.wait.wake = max(self.clock.now, self.clock.tick_of(strand.wait.sample))
        self.changed = True

    # ----------------------------------------------------------------- program

    def set_program(self, lines: tuple[str, ...]) -> None:
        """Replaces the program memory; every thread must be still."""
        self.state.program = lines
        self.code = compile_program(lines, self)
        self.routines = tuple(name for name in ROUTINES if name in self.code.labels)
        self.changed = True

    def running(self) -> bool:
        """Whether any thread runs."""
        return any(thread.running for thread in self.state.threads)

    def start(self, number: int, pc: int) -> None:
        """XQ: starts a thread at an op of the program."""
        thread = self.state.threads[number]
        if thread.running:
            raise CommandError(19)
        if not self.code.line_of:
            raise CommandError(10)
        self.state.threads[number] = Thread(number, running=True, pc=pc)
        self.changed = True

    def halt(self, number: int) -> None:
        """HX n: ends a thread and forgets what it waited for."""
        thread = self.state.threads[number]
        for wait in (thread.wait, *(frame.wait for frame in thread.stack)):
            self.drop(wait)
            if wait is not None and wait.kind in FIELD_WAITS:
                self.end_field()
        line = self.code.line(thread.pc) if thread.running else thread.line
        if thread.running and self.records.on_trace is not None:
            self.records.on_trace(self.clock.now, number, -1)
        self.state.threads[number] = Thread(number, pc=thread.pc, line=line)
        self.changed = True

    def halt_all(self) -> None:
        for thread in self.state.threads:
            if thread.running:
                self.halt(thread.number)

    def drop(self, wait: Wait | None) -> None:
        """Takes a wait's watches off the motion."""
        if wait is not None:
            for watch in wait.watches:
                self.clock.motion.drop(watch)

    def call(self, thread: Thread, label: str, back: int) -> None:
        """Enters an automatic routine; the trippoint under way is kept for RE1, RI1, EN1."""
        if len(thread.stack) >= self.model.subroutine_levels:
            raise CommandError(12)
        thread.stack.append(Frame(back, label, thread.wait))
        thread.wait = None
        thread.pc = self.code.labels[label]
        self.changed = True

    def current_line(self, thread: Thread) -> int:
        """The line a thread is on: while it waits, the one with the trippoint."""
        behind = self.profile.waiting_line == "the trippoint's" and thread.wait is not None and thread.pc > 0
        pc = thread.pc - 1 if behind else thread.pc
        return self.code.line(pc)

    def line_ops(self, text: str) -> list[Op]:
        """A command line of a port, compiled once."""
        ops = self._lines.get(text)
        if ops is None:
            if len(self._lines) >= LINES_KEPT:
                self._lines.clear()
            ops = self._lines[text] = compile_line(text, self)
        return ops

    def listed(self, number: int) -> str:
        """A line of the program as LS and TR send it (dmc-1412-1414.txt l.2474)."""
        return f"{number:03d}{' ' if ' ' in self.profile.listed_line else ''}{self.code.lines[number]}"

    # ----------------------------------------------------------------- answers

    def answer(self, strand: Strand, text: str) -> None:
        """A line of data: to the port that asked, or unasked to port 1 when a program prints it."""
        if isinstance(strand, Port):
            self.reply(strand.number, text.encode("latin-1") + RETURN)
        else:
            self.unsolicited(1, text + "\r\n")

    def reply(self, port: int, data: bytes) -> None:
        """Bytes that a port expects; not from a controller that was not spoken to."""
        if self.state.ports[port - 1].silent:
            return
        uart = self.uarts[port - 1]
        uart.run(self.clock.now)
        uart.send(data, self.clock.now)
        if uart.room() < 0:
            self.stalled, self.changed = port, True

    def unsolicited(self, port: int, text: str, *, ends: bool = False) -> None:
        """Bytes nobody asked for (dmc-1412-1414.txt l.1325): CW decides about bit 7 and a full FIFO."""
        settings, uart = self.state.settings, self.uarts[port - 1]
        data = text.encode("latin-1")
        uart.run(self.clock.now)
        self.records.sent(self.clock.now, port, text)
        if ends:
            self.records.flush(port)
        if settings.get("CW1", 2) == 1:
            data = bytes(byte | 0x80 for byte in data)
        if settings.get("CW2", 0) == 1 and uart.room() < len(data):
            data = data[: max(0, uart.room())]
        uart.send(data, self.clock.now)
        if uart.room() < 0:
            self.stalled, self.changed = port, True

    def notice(self, text: str) -> None:
        """Something the host should tell its user, once."""
        if text not in self.notices:
            self.notices.append(text)

    # ----------------------------------------------------------------- formats

    def formatted(self, value: int, form: Format | None) -> str:
        """A variable as `V1=` sends it: by VF, or by its local format."""
        if form is not None:
            return self._local(value, form)
        digits, decimals, hexadecimal = places(self.state.settings["VF"])
        return format_number(value, digits, decimals, self.leading_zeros(), hexadecimal)

    def formatted_reply(self, name: str, reply: str, value: int, form: Format | None) -> str:
        """A reply by the format of its command's row."""
        if form is not None:
            return self._local(value, form)
        reply = self.rows[name].reply or reply
        if reply == "PF":
            digits, decimals, hexadecimal = places(self.state.settings["PF"])
        else:
            whole, _, rest = reply.partition(".")
            digits, decimals, hexadecimal = int(whole), int(rest or 0), False
        text = format_number(value, digits, decimals, self.leading_zeros(), hexadecimal)
        return text.lstrip(" ") if name in UNSIGNED and not self.profile.status_sign else text

    def _local(self, value: int, form: Format) -> str:
        if form.kind == "S":
            return string_text(value, form.digits or 6)
        return format_number(value, form.digits, form.decimals, True, form.kind == "$")

    def leading_zeros(self) -> bool:
        return not self.state.settings["LZ"]

    # ------------------------------------------------------------------- reset

    def revision(self) -> str:
        """The answer to ^R^V: type and firmware revision (form known, text inferred)."""
        if self.model.family == "ssc":
            return f"DMC15{len(self.model.axes)}0 {self.profile.revision}"
        return f"{self.model.name.upper()} {self.profile.revision}"

    def begin_reset(self) -> None:
        """RS or the reset input: everything stops; the controller is back after about a second."""
        reset.begin(self)

    def finish_reset(self) -> None:
        reset.finish(self)

    def master_reset(self) -> None:
        """^R^S: factory state, EEPROM erased."""
        try:
            self.eeprom.erase()
        except OSError as reason:
            self.notice(f"the EEPROM file cannot be written: {reason.strerror or reason}")
        reset.begin(self)

    def open_port_two(self) -> None:
        """Port 2 as CC has it; paced only when port 1 is."""
        baud, handshake = self.state.port_two[:2]
        paced = self.uarts[0].baud is not None
        self.uarts[1].handshake = bool(handshake)
        self.uarts[1].set_baud(baud if paced else None, self.clock.now)

    # ------------------------------------------------------------------ errors

    def fail(self, thread: Thread, code: int, pc: int) -> None:
        """A command of a program was refused: #CMDERR, or the thread ends and port 1 is told."""
        state = self.state
        line = self.code.line(pc)
        code = self.profile.code(code)
        state.error_code, state.error_line = code, line
        main = state.threads[0]
        handled = "CMDERR" in self.code.labels and main.running and not self._in_routine(main, "CMDERR")
        handled = handled and len(main.stack) < self.model.subroutine_levels
        source = self.code.lines[line] if line < len(self.code.lines) else ""
        self.records.errors.append(
            {
                "thread": thread.number,
                "line": line,
                "source": source,
                "code": code,
                "text": ERROR_TEXTS.get(code, ""),
                "handled": handled,
            }
        )
        if thread is not main or not handled:
            self.halt(thread.number)
        if handled:
            onward = pc + (self.profile.command_error_return == "next command")
            self.call(main, "CMDERR", min(onward, len(self.code.ops) - 1) if thread is main else main.pc)
        else:
            self.records.unhandled += 1
            self.unsolicited(1, f"?{line:03d} {source}\r\n")

    def _in_routine(self, thread: Thread, label: str) -> bool:
        return any(frame.kind == label for frame in thread.stack)


LINES_KEPT = 2000
FIELD_WAITS = ("BZ", "BS")
ROUTINES = ("LIMSWI", "POSERR", "ININT", "MCTIME", "CMDERR", "COMINT")
