"""The host's end of a served controller's port 1: a TCP socket or a pseudo-terminal."""

from __future__ import annotations

import select
import socket
from typing import Protocol


class Line(Protocol):
    """The host's end of port 1."""

    address: str

    def wait(self, seconds: float, *, want: bool) -> None: ...
    def read(self, most: int) -> bytes: ...
    def write(self, data: bytes) -> bool: ...
    def close(self) -> None: ...


class TcpLine:
    """One client at a time; a newer one takes over, as a plug does."""

    def __init__(self, address: str) -> None:
        host, _, port = address.rpartition(":")
        self._listener = socket.create_server((host or "127.0.0.1", int(port)))
        self._listener.setblocking(False)
        self._client: socket.socket | None = None
        self._pending = bytearray()
        name = self._listener.getsockname()
        self.address = f"{name[0]}:{name[1]}"

    def wait(self, seconds: float, *, want: bool) -> None:
        """Until a client has something to say (when it is wanted), or the time is over."""
        watched = [self._listener]
        if want and self._client is not None:
            watched.append(self._client)
        readable, _, _ = select.select(watched, [], [], max(0.0, seconds))
        if self._listener in readable:
            self._accept()

    def _accept(self) -> None:
        try:
            client, _ = self._listener.accept()
        except OSError:  # it has gone again
            return
        self._drop()
        client.setblocking(False)
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._client = client

    def _drop(self) -> None:
        if self._client is not None:
            self._client.close()
        self._client = None
        self._pending.clear()

    def read(self, most: int) -> bytes:
        if self._client is None:
            return b""
        try:
            data = self._client.recv(most)
        except BlockingIOError:
            return b""
        except OSError:
            data = b""
        if not data:
            self._drop()
        return data

    def write(self, data: bytes) -> bool:
        """Sends; False while the client does not take it."""
        if self._client is None:
            return True
        self._pending += data
        try:
            if self._pending:
                del self._pending[: self._client.send(self._pending)]
        except BlockingIOError:
            return False
        except OSError:
            self._drop()
        return not self._pending

    def close(self) -> None:
        self._drop()
        self._listener.close()


def open_line(*, pty: bool, tcp: str | None) -> Line:
    """The pseudo-terminal (not on Windows) or the socket."""
    if pty:
        from device.simulator.terminal_line import TerminalLine

        return TerminalLine()
    return TcpLine(tcp or "127.0.0.1:0")
