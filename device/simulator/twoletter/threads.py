"""The interpreter: which thread or port is served when, what they wait for, and the automatic routines."""

from __future__ import annotations

from codegen.twoletter.evaluate import EvaluationError
from device.simulator.times import COMMAND
from device.simulator.twoletter import behaviour, routines, wire
from device.simulator.twoletter.behaviour import recording
from device.simulator.twoletter.idling import Idling
from device.simulator.twoletter.state import FOREVER, CommandError, NotYet, Port, Strand, Thread, Wait
from device.simulator.twoletter.unit import Unit


class Interpreter:
    """One command at a time, COMMAND ticks each, in turn among threads 0.. and port 1.

    Between commands nothing happens but samples, characters and waits that end; each at its own tick, so that the
    result does not depend on how `advance` is sliced. At an equal tick a sample precedes a command.
    """

    def __init__(self, unit: Unit) -> None:
        self.unit = unit
        self.idling = Idling(unit)
        self._alarmed = True  # a condition of an automatic routine may hold: look after every sample

    # -------------------------------------------------------------------- time

    def advance(self, end: int, *, until_idle: bool = False) -> None:
        """Carries out everything due up to and including tick `end`; or until no thread runs or an error ends one."""
        unit = self.unit
        clock, known = unit.clock, unit.records.unhandled
        while True:
            self._settle()
            if until_idle and (not unit.running() or unit.records.unhandled > known):
                return
            waiting = unit.state.waiting()
            due = self._next_event(waiting)
            command_at = unit.state.command_at
            target = min(due, end if command_at < 0 else min(command_at, end))
            if self._watching(waiting):
                if self._sync(target):
                    continue
            else:
                clock.now = target
            if clock.now == command_at:
                self._commands(min(due, end))
            elif clock.now >= end and due > end:
                return

    def _sync(self, target: int) -> bool:
        """Runs the motion towards `target`, up to the first sample that ends a wait or calls a routine; True then."""
        clock = self.unit.clock
        if clock.tick + clock.period <= clock.now:
            clock.catch_up(clock.now)
        while target >= clock.tick + clock.period:
            if clock.sync(clock.tick + clock.period if self._alarmed else target) or self._alarmed:
                clock.now = max(clock.now, clock.tick)
                if self._after_sample():
                    return True
        clock.now = target
        return False

    def _next_event(self, waiting: list[Strand]) -> int:
        """The next tick at which something other than a command is due."""
        unit = self.unit
        state = unit.state
        due = state.reset_at if state.reset_at >= 0 else FOREVER
        if state.recording.interval:
            due = min(due, unit.clock.tick_of(state.recording.sample))
        for uart in unit.uarts:
            if uart.incoming_end is not None:
                due = min(due, uart.due_in())
        for strand in waiting:
            wait = strand.wait
            assert wait is not None
            if wait.wake < due:
                due = wait.wake
            if wait.kind == "output":
                due = min(due, unit.uarts[wait.number - 1].due_out())
        return max(due, unit.clock.now)

    def rests(self) -> bool:
        """Nothing is due but samples, and none of them can call anything."""
        state = self.unit.state
        waiting = state.waiting()
        return state.command_at < 0 and not waiting and self._next_event(waiting) == FOREVER and not self._ready()

    def _settle(self) -> None:
        """Brings ports and waits up to now, and gives the interpreter its next command."""
        unit = self.unit
        now = unit.clock.now
        if unit.changed:
            self._alarmed, unit.changed = True, False
        if 0 <= unit.state.reset_at <= now:
            unit.finish_reset()
        state = unit.state
        while state.recording.interval and unit.clock.tick_of(state.recording.sample) <= now:
            recording.take(unit)
        for uart, port in zip(unit.uarts, state.ports, strict=True):
            if uart.incoming_end is not None or uart.outgoing_end is not None:  # most of the time the lines are quiet
                uart.run(now)
            if uart.buffer or uart.overruns:
                wire.take_characters(unit, port)
        if state.comint_due:
            routines.call_comint(unit)
        for strand in state.waiting():
            wait = strand.wait
            if wait is not None and (wait.wake <= now or (wait.kind == "output" and self._has_room(wait))):
                self.release(strand)
        if state.command_at < 0 and self._ready():
            state.command_at = max(now, state.busy_until) + COMMAND

    def _has_room(self, wait: Wait) -> bool:
        return self.unit.uarts[wait.number - 1].room() >= 0

    def _ready(self) -> list[Strand]:
        state = self.unit.state
        if state.reset_at >= 0:
            return []
        ready: list[Strand] = []
        for thread in state.threads:  # no comprehension: this runs for every character
            if thread.running and thread.wait is None:
                ready.append(thread)
        for port in state.ports:
            if port.pending is not None and port.wait is None:
                ready.append(port)
        return ready

    # ---------------------------------------------------------------- commands

    def _commands(self, limit: int) -> None:
        """Carries out the command that is due now, and those behind it as long as nothing else happens."""
        unit = self.unit
        state = unit.state
        ready = self._ready()
        if not ready:
            state.command_at = -1
            return
        unit.changed, unit.stalled = False, 0  # an echo that found no room is nobody's command
        plain = not any(isinstance(strand, Port) for strand in ready) and not self._traces()
        if plain:
            self._burst(ready, limit, watched=self._watching(state.waiting()))
        else:
            self._one(self._in_turn(ready))
        if self._ready():
            state.command_at = max(state.command_at, state.busy_until + COMMAND)
        else:
            state.command_at = -1

    def _traces(self) -> bool:
        return self.unit.state.settings["TR"] != 0 or self.unit.records.on_trace is not None

    def _place(self, strand: Strand) -> int:
        return len(self.unit.state.threads) + strand.number if isinstance(strand, Port) else strand.number

    def _in_turn(self, ready: list[Strand]) -> Strand:
        """The first ready one behind the one served last."""
        turn = self.unit.state.turn
        return min(ready, key=lambda strand: (self._place(strand) <= turn, self._place(strand)))

    def _burst(self, ready: list[Strand], limit: int, *, watched: bool) -> None:
        """Serves threads round and round, one command each, until one of them changes what is ready."""
        unit = self.unit
        state, clock, ops = unit.state, unit.clock, unit.code.ops
        at, index = state.command_at, ready.index(self._in_turn(ready))
        threads = [strand for strand in ready if isinstance(strand, Thread)]
        thread, count = threads[index], len(threads)
        next_sample = clock.tick + clock.period if watched else FOREVER
        try:
            while at <= limit and not unit.changed:
                if at >= next_sample:
                    if self._overtaken(at):
                        break
                    next_sample = clock.tick + clock.period
                thread = threads[index]
                clock.now, pc = at, thread.pc
                thread.pc = following = ops[pc](thread)
                at += COMMAND
                index = index + 1 if index + 1 < count else 0
                if following <= pc and self.idling.due() and not unit.changed:
                    left_out, over = self._leap(threads, index, at, limit, watched=watched)
                    at, index = at + left_out * COMMAND, (index + left_out) % count
                    thread = threads[index - 1]
                    if over:
                        break
                    next_sample = clock.tick + clock.period if watched else FOREVER
        except (CommandError, EvaluationError) as refusal:
            unit.fail(thread, refusal.code, thread.pc)
            at += COMMAND
        except NotYet as pause:
            thread.wait = pause.wait
            unit.changed = True
            at += COMMAND
        state.command_at, state.turn = at, thread.number
        self._stall(thread)

    def _overtaken(self, at: int) -> bool:
        """Takes the samples before the command at tick `at`; True when one of them comes first."""
        clock = self.unit.clock
        if self._alarmed:
            return self._sync(at)
        if not clock.sync(at):
            return False
        clock.now = max(clock.now, clock.tick)
        return self._after_sample() or clock.tick + clock.period <= at

    def _leap(self, threads: list[Thread], index: int, at: int, limit: int, *, watched: bool) -> tuple[int, bool]:
        """Leaves out commands of threads that only wait: how many, and whether a sample comes before the next one."""
        if watched and self._alarmed:
            return 0, False
        clock, leap = self.unit.clock, self.idling.leap(threads, index, at, limit, watched=watched)
        at += leap.commands * COMMAND
        if leap.commands:
            clock.now = at - COMMAND
        if not leap.tripped:
            return leap.commands, False
        clock.now = max(clock.now, clock.tick)
        return leap.commands, self._after_sample() or clock.tick + clock.period <= at

    def _stall(self, strand: Strand) -> None:
        """The output FIFO is over-full: whoever sent last waits for room (dmc-1412-1414.txt l.1335)."""
        port, self.unit.stalled = self.unit.stalled, 0
        if port and strand.wait is None:
            strand.wait = Wait("output", number=port)

    def _one(self, strand: Strand) -> None:
        state = self.unit.state
        state.command_at += COMMAND
        state.turn = self._place(strand)
        if isinstance(strand, Port):
            self._port_command(strand)
        elif self._traced(strand):
            self._thread_command(strand)

    def _thread_command(self, thread: Thread) -> None:
        unit, pc = self.unit, thread.pc
        try:
            thread.pc = unit.code.ops[pc](thread)
        except (CommandError, EvaluationError) as refusal:
            unit.fail(thread, refusal.code, pc)
        except NotYet as pause:
            thread.wait = pause.wait
            unit.changed = True
        thread.traced = False
        self._stall(thread)

    def _traced(self, thread: Thread) -> bool:
        """Shows a line about to begin (dmc-1412-1414.txt l.2672); False while there is no room for it."""
        unit = self.unit
        line = unit.code.line(thread.pc)
        first = line < len(unit.code.start_of) and unit.code.start_of[line] == thread.pc
        if thread.traced or (line == thread.line and not first):
            return True
        thread.line, thread.traced = line, True
        labels = [number for number in range(line) if first and unit.code.start_of[number] == thread.pc]
        labels = labels if unit.profile.trace_labels else []
        for number in (*labels, line):  # a line of labels only is passed on the way
            if unit.records.on_trace is not None:
                unit.records.on_trace(unit.clock.now, thread.number, number)
            if unit.state.settings["TR"] and number < len(unit.code.lines):
                unit.unsolicited(1, unit.listed(number) + "\r\n")
                self._stall(thread)
        return thread.wait is None

    def _port_command(self, port: Port) -> None:
        unit = self.unit
        assert port.pending is not None
        ops = unit.line_ops(port.pending)
        try:
            ops[port.position](port)
        except (CommandError, EvaluationError) as refusal:
            self._refuse(port, refusal.code)
        else:
            self._stall(port)
            if port.wait is None:
                self._prompt(port)

    def _prompt(self, port: Port) -> None:
        """A command from a port is done: its prompt, and the next of the line."""
        if port.mode != "command" or port.pending is None:
            self._end_line(port)
            return
        unit = self.unit
        last = port.position + 1 >= len(unit.line_ops(port.pending))
        if last or unit.profile.prompt_per_command:
            unit.reply(port.number, wire.ACCEPTED)
        if unit.profile.error_code_cleared_by_good_command:
            unit.state.error_code = 0
        unit.stalled = 0
        self._next_of_line(port)

    def _next_of_line(self, port: Port) -> None:
        port.position += 1
        if port.pending is None or port.position >= len(self.unit.line_ops(port.pending)):
            self._end_line(port)

    def _end_line(self, port: Port) -> None:
        port.pending, port.position = None, 0
        port.silent = port.number == 1 and not self.unit.state.selected
        wire.take_characters(self.unit, port)
        self.unit.changed = True

    # ------------------------------------------------------------------- waits

    def release(self, strand: Strand) -> None:
        """A wait is over."""
        unit, wait = self.unit, strand.wait
        assert wait is not None
        strand.wait = None
        unit.drop(wait)
        unit.changed = True
        if wait.kind in behaviour.ENDS and not self._goes_on(strand, wait):
            return
        if isinstance(strand, Port):
            self._prompt(strand)
        if wait.kind == "MC":
            routines.call_when_late(self.unit, wait)

    def _goes_on(self, strand: Strand, wait: Wait) -> bool:
        """Carries on with a command that takes several steps; True when it is done and was not refused."""
        unit = self.unit
        try:
            behaviour.ENDS[wait.kind](unit, strand, wait)
        except CommandError as refusal:
            if isinstance(strand, Port):
                self._refuse(strand, refusal.code)
            else:
                unit.fail(strand, refusal.code, strand.pc - 1)
            return False
        return strand.wait is None

    def _refuse(self, port: Port, code: int) -> None:
        profile = self.unit.profile
        self.unit.state.error_code = profile.code(code)
        self.unit.reply(port.number, wire.REFUSED)
        if profile.error_ends_line:
            self._end_line(port)
        else:
            self._next_of_line(port)

    def _watching(self, waiting: list[Strand]) -> bool:
        """Whether the motion can end a wait or call a routine, so that it must keep up with the commands."""
        for strand in waiting:
            if strand.wait is not None and strand.wait.watches:
                return True
        return routines.watched(self.unit)

    def _after_sample(self) -> bool:
        """Ends waits whose watches have tripped and calls routines; True when anything happened."""
        unit = self.unit
        motion, happened = unit.clock.motion, False
        for strand in unit.state.waiting():
            wait = strand.wait
            if wait is not None and wait.watches and all(motion.tripped(watch) for watch in wait.watches):
                self.release(strand)
                happened = True
        motion.forget_events()
        self._alarmed = False
        if unit.routines and unit.state.threads[0].running:
            called, self._alarmed = routines.call_due(unit)
            happened |= called
        return happened
