"""The simulated serial port: baud rate, buffers, overrun and handshake, in ticks."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import Final

from device.simulator.times import CHARACTER_BITS, TICKS
from device.simulator.uart_faults import Fault, mistimed, spoilt

NEVER: Final = 1 << 62
OUTPUT_FIFO: Final = 128  # characters, dmc-1412-1414.txt l.1333
RECEIVE_BUFFER: Final = 256  # characters; no manual says (inferred)
HOLD_MARGIN: Final = 16  # free places at which the host is told to wait
XON, CONTROL_R, XOFF = 0x11, 0x12, 0x13


@dataclass(slots=True)
class Uart:
    """One port. Fine times count 1/baud of a tick, so that every character ends at its exact time."""

    baud: int | None = None  # None: unpaced, characters take no time
    handshake: bool = True
    receive_size: int = RECEIVE_BUFFER
    output_size: int = OUTPUT_FIFO
    line: deque[int] = field(default_factory=deque)  # handed over by the host, not yet clocked in
    buffer: deque[int] = field(default_factory=deque)  # clocked in, not yet taken by the controller
    overruns: int = 0  # characters lost since the controller last looked
    incoming_end: int | None = None  # fine time at which the character on the line is complete
    line_free: int = 0  # fine time at which the last one was
    output: deque[int] = field(default_factory=deque)
    outgoing_end: int | None = None
    output_free: int = 0
    sent: bytearray = field(default_factory=bytearray)
    host_ready: bool = True  # RTS: the host takes characters
    xon_xoff: bool = False  # the host may hold output by XOFF
    tells_xoff: bool = False  # the host is held by XOFF, too
    told_xoff: bool = False
    stopped: bool = False  # the host sent XOFF
    last: int = 0  # the character before: ^R makes a command of XOFF
    history: deque[tuple[int, int]] = field(default_factory=lambda: deque(maxlen=64))  # tick, character clocked in

    fault: Fault = Fault.NONE  # of the connection
    host_baud: int | None = None  # the speed the host's port is set to, where that is known

    passing: bool = False  # what comes in is also for the next controller of a daisy chain
    passed: bytearray = field(default_factory=bytearray)

    # ------------------------------------------------------------ host's side

    def receive(self, data: bytes, now: int) -> None:
        """The host hands characters to the line at tick `now`; its driver sends XON also where CTS holds the rest."""
        data, back = spoilt(self.fault, data)
        self.sent += back
        if self._wrong_speed:
            assert self.host_baud is not None and self.baud is not None
            data = mistimed(data, self.host_baud, self.baud)
        if self.held and XON in data:
            self.stopped = False
            data = data.replace(bytes((XON,)), b"", 1)
            self._start_outgoing(now)
        self.line.extend(data)
        self._start_incoming(now)

    def transmit(self) -> bytes:
        """The characters that have left the port since the last call."""
        if not self.sent:
            return b""
        data = bytes(self.sent)
        self.sent.clear()
        if self._wrong_speed:
            assert self.host_baud is not None and self.baud is not None
            data = mistimed(data, self.baud, self.host_baud)
        return data

    @property
    def _wrong_speed(self) -> bool:
        known = self.baud is not None and self.host_baud is not None
        return self.fault is Fault.SPEED and known and self.baud != self.host_baud

    def set_host_ready(self, ready: bool, now: int) -> None:
        """Raises or drops the line by which the host lets characters come."""
        self.host_ready = ready
        self._start_outgoing(now)

    @property
    def may_send(self) -> bool:
        """False while the host's RTS inhibits sending; without handshake nobody looks at it."""
        return self.host_ready or not self.handshake

    @property
    def held(self) -> bool:
        """XOFF stopped the output, and CTS the input: only an XON helps."""
        return self.xon_xoff and self.stopped and not self.clear_to_send

    @property
    def clear_to_send(self) -> bool:
        """False while the controller asks the host to wait."""
        if self.fault is Fault.HELD:
            return False
        return not self.handshake or len(self.buffer) < self.receive_size - HOLD_MARGIN

    # ------------------------------------------------------ controller's side

    def take(self, now: int) -> int | None:
        """The next received character, or None."""
        if not self.buffer:
            return None
        byte = self.buffer.popleft()
        if self.told_xoff and self.clear_to_send:
            self._tell(XON, now)
        if self.incoming_end is None and self.line:
            self._start_incoming(now)
        return byte

    def take_passed(self) -> bytes:
        """What has come in for the next controller since the last call."""
        data = bytes(self.passed)
        self.passed.clear()
        return data

    def send(self, data: bytes, now: int) -> None:
        """Queues characters for the host."""
        self.output.extend(data)
        self._start_outgoing(now)

    def room(self) -> int:
        """Free places in the output FIFO; negative while more waits than it holds."""
        return self.output_size - len(self.output)

    def set_baud(self, baud: int | None, now: int) -> None:
        """Changes the rate; characters on their way start again."""
        self.baud = baud
        self.incoming_end = self.outgoing_end = None
        self.line_free = self.output_free = 0
        self._start_incoming(now)
        self._start_outgoing(now)

    def clear(self) -> None:
        """What a reset does: nothing waits any more."""
        self.buffer.clear()
        self.output.clear()
        self.outgoing_end = None
        self.stopped = self.told_xoff = False

    # -------------------------------------------------------------------- time

    def due_in(self) -> int:
        """The tick at which the next character is complete."""
        if self.incoming_end is None:
            return NEVER
        return -(-self.incoming_end // (self.baud or 1))

    def due_out(self) -> int:
        """The tick at which the next character has left."""
        if self.outgoing_end is None:
            return NEVER
        return -(-self.outgoing_end // (self.baud or 1))

    def run(self, now: int) -> None:
        """Completes every character due by `now`."""
        scale = self.baud or 1
        while self.incoming_end is not None and self.incoming_end <= now * scale:
            self._complete_incoming()
        while self.outgoing_end is not None and self.outgoing_end <= now * scale:
            self._complete_outgoing()

    def _character(self) -> int:
        return CHARACTER_BITS * TICKS if self.baud else 0

    def _start_incoming(self, now: int) -> None:
        if self.incoming_end is None and self.line and self.clear_to_send:
            self.incoming_end = max(now * (self.baud or 1), self.line_free) + self._character()

    def _complete_incoming(self) -> None:
        assert self.incoming_end is not None
        self.line_free = self.incoming_end
        byte = self.line.popleft()
        self.history.append((-(-self.line_free // (self.baud or 1)), byte))
        if self.passing:
            self.passed.append(byte)
        self._received(byte, -(-self.line_free // (self.baud or 1)))
        self.incoming_end = None
        if self.line and self.clear_to_send:
            self.incoming_end = self.line_free + self._character()

    def _received(self, byte: int, now: int) -> None:
        """XOFF and XON work at once, whatever the interpreter does; an XON that ends nothing may mean another thing."""
        before, self.last = self.last, byte
        if self.xon_xoff and before != CONTROL_R and (byte == XOFF or (byte == XON and self.stopped)):
            self.stopped = byte == XOFF
            self._start_outgoing(now)
        elif len(self.buffer) < self.receive_size:
            self.buffer.append(byte)
            if self.tells_xoff and not self.told_xoff and len(self.buffer) >= self.receive_size - HOLD_MARGIN:
                self._tell(XOFF, now)
        else:
            self.overruns += 1

    def _tell(self, character: int, now: int) -> None:
        """XOFF or XON to the host, ahead of everything that waits."""
        self.told_xoff = character == XOFF
        self.output.insert(0 if self.outgoing_end is None else 1, character)
        self._start_outgoing(now)

    def _start_outgoing(self, now: int) -> None:
        if self.outgoing_end is None and self.output and self.may_send and not self.stopped:
            self.outgoing_end = max(now * (self.baud or 1), self.output_free) + self._character()

    def _complete_outgoing(self) -> None:
        assert self.outgoing_end is not None
        self.output_free = self.outgoing_end
        self.sent.append(self.output.popleft())
        self.outgoing_end = None
        if self.output and self.may_send and not self.stopped:
            self.outgoing_end = self.output_free + self._character()
