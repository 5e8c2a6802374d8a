"""The host's end of a served controller's ports: TCP sockets or pseudo-terminals."""

from __future__ import annotations

import select
import socket
import time
from collections.abc import Sequence
from typing import Protocol, TypeAlias

Watched: TypeAlias = "socket.socket | int"


class Line(Protocol):
    """The host's end of one port."""

    address: str

    def host_baud(self) -> int | None: ...
    def watched(self, *, want: bool) -> list[Watched]: ...
    def arrived(self, readable: Sequence[Watched]) -> None: ...
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

    def host_baud(self) -> int | None:
        """A socket has no speed."""
        return None

    def watched(self, *, want: bool) -> list[Watched]:
        """A new client may come at any time; what the present one says only when it is wanted."""
        return [self._listener, self._client] if want and self._client is not None else [self._listener]

    def arrived(self, readable: Sequence[Watched]) -> None:
        """Lets in who knocks."""
        if self._listener not in readable:
            return
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


def wait(lines: Sequence[tuple[Line, bool]], seconds: float) -> None:
    """Until one of the lines that are wanted has something to say, somebody new knocks, or the time is over."""
    watched = [each for line, want in lines for each in line.watched(want=want)]
    if not watched:
        time.sleep(max(0.0, seconds))
        return
    readable, _, _ = select.select(watched, [], [], max(0.0, seconds))
    for line, _ in lines:
        line.arrived(readable)


def open_line(*, pty: bool, tcp: str | None) -> Line:
    """The pseudo-terminal (not on Windows) or the socket."""
    if pty:
        from device.simulator.terminal_line import TerminalLine

        return TerminalLine()
    return TcpLine(tcp or "127.0.0.1:0")


def open_second(place: str) -> Line:
    """The line of port 2: `pty`, or HOST:PORT."""
    return open_line(pty=place == "pty", tcp=place)
