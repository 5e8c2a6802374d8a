"""A TCP connection: a served simulator or a serial device server."""

from __future__ import annotations

import contextlib
import select
import socket

from device.transport import LineSettings, OpenFailed, TransportLost


class Tcp:
    """`socket://host:port`, sending at once."""

    def __init__(self, address: str, line: LineSettings, timeout_s: float = 3.0) -> None:
        self._address = address
        host, _, port = address.removeprefix("socket://").rpartition(":")
        if not host or not port.isdigit():
            raise OpenFailed(
                f"{address} is not an address; write socket://host:port, for example socket://127.0.0.1:5000."
            )
        try:
            self._socket = socket.create_connection((host, int(port)), timeout=timeout_s)
        except (OSError, OverflowError) as reason:
            raise OpenFailed(
                f"Nothing answers at {address} ({reason}); is it switched on and the number right?"
            ) from reason
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._socket.setblocking(False)

    @property
    def description(self) -> str:
        return self._address

    def read(self, timeout_s: float) -> bytes:
        try:
            ready, _, _ = select.select([self._socket], [], [], timeout_s)
            if not ready:
                return b""
            data = self._socket.recv(65536)
        except (BlockingIOError, InterruptedError):
            return b""
        except (OSError, ValueError) as reason:
            raise TransportLost(f"The connection to {self._address} broke ({reason}).") from reason
        if not data:
            raise TransportLost(f"{self._address} closed the connection.")
        return data

    def write(self, data: bytes) -> int:
        try:
            return self._socket.send(data)
        except (BlockingIOError, InterruptedError):
            return 0
        except OSError as reason:
            raise TransportLost(f"The connection to {self._address} broke ({reason}).") from reason

    def unsent(self) -> int:
        return 0

    def discard_output(self) -> None:
        """A socket cannot take back what was sent; the writer keeps it short instead."""

    def close(self) -> None:
        with contextlib.suppress(OSError):
            self._socket.close()
