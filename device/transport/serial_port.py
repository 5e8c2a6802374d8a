"""A serial port (or a pseudo-terminal, which opens like one) through pyserial."""

from __future__ import annotations

import contextlib
import errno
import os
import sys

import serial

from device.transport import LineSettings, OpenFailed, TransportLost
from device.transport.holder import holder_of, rival_of

try:  # not on Windows; its error is no OSError
    from termios import error as terminal_error
except ImportError:
    terminal_error = OSError  # type: ignore[assignment,misc]

GONE = (serial.SerialException, OSError, TypeError, terminal_error)
PARITY = {"none": serial.PARITY_NONE, "even": serial.PARITY_EVEN, "odd": serial.PARITY_ODD}


class SerialPort:
    """One serial device, opened for us alone."""

    def __init__(self, device: str, line: LineSettings) -> None:
        self._device = device
        self._line = line
        try:
            self._port = serial.Serial(
                device,
                baudrate=line.baud or 115_200,
                bytesize=line.bits,
                parity=PARITY[line.parity],
                stopbits=line.stop_bits,
                rtscts=line.handshake in ("rts", "both"),
                xonxoff=line.handshake in ("xon", "both"),
                timeout=0,
                write_timeout=0,
                exclusive=None if sys.platform == "win32" else True,
            )
        except (serial.SerialException, OSError, ValueError) as reason:
            raise OpenFailed(why_not(device, reason)) from reason
        if rival := rival_of(device):
            self.close()
            raise OpenFailed(in_use(device, rival))

    @property
    def description(self) -> str:
        return f"{self._device} at {self._line.baud} baud"

    def read(self, timeout_s: float) -> bytes:
        try:
            self._port.timeout = timeout_s
            first = self._port.read(1)
            if not first:
                return b""
            waiting = self._port.in_waiting
            return bytes(first) + (bytes(self._port.read(waiting)) if waiting else b"")
        except GONE as reason:
            raise TransportLost(f"{self._device} is gone: is the cable still plugged in?") from reason

    def write(self, data: bytes) -> int:
        handle = getattr(self._port, "fd", None)  # not on Windows
        try:
            # pyserial's own write would try again for ever where a held line takes nothing
            written = self._port.write(data) if handle is None else os.write(handle, data)
        except (serial.SerialTimeoutException, BlockingIOError, InterruptedError):
            return 0
        except GONE as reason:
            raise TransportLost(f"{self._device} is gone: is the cable still plugged in?") from reason
        return len(data) if written is None else int(written)

    def unsent(self) -> int:
        try:
            return int(self._port.out_waiting)
        except GONE as reason:
            raise TransportLost(f"{self._device} is gone: is the cable still plugged in?") from reason

    def clear_to_send(self) -> bool | None:
        """CTS; None where there is no such wire (pseudo-terminals)."""
        try:
            return bool(self._port.cts)
        except GONE:
            return None

    def discard_output(self) -> None:
        """Throws it away; also goes on after an XOFF: what is sent next is a stop, and the XON may be lost."""
        with contextlib.suppress(*GONE):
            self._port.reset_output_buffer()
        if self._line.handshake in ("xon", "both"):
            with contextlib.suppress(*GONE):
                self._port.set_output_flow_control(False)  # Linux lets go only what it holds by this itself
                self._port.set_output_flow_control(True)

    def close(self) -> None:
        with contextlib.suppress(*GONE):
            self._port.reset_output_buffer()
        with contextlib.suppress(*GONE):
            self._port.close()


def why_not(device: str, reason: Exception) -> str:
    """Why the port did not open, and what helps, in one sentence."""
    number = getattr(reason, "errno", None)
    text = str(reason).lower()
    if number == errno.EACCES or "permission" in text or "access is denied" in text:
        if sys.platform == "win32":
            return in_use(device)
        return f'No permission to open {device}: run "sudo usermod -aG dialout $USER" and log in again.'
    if number == errno.EBUSY or "exclusively lock" in text or "busy" in text or number == errno.EWOULDBLOCK:
        return in_use(device, holder_of(device))
    if number == errno.ENOENT or "no such file" in text or "filenotfound" in text or "could not find" in text:
        return f"There is no port {device}; plug in the adapter or choose another port."
    return f"{device} did not open ({reason}); choose another port or check its settings."


def in_use(device: str, who: str = "") -> str:
    """Somebody else has it, by name where that is known."""
    return f"{device} is in use by {who or 'another program'}; close it there and try again."
