"""A port on a pseudo-terminal (not on Windows): any terminal program can open it as a serial device."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING

from codegen.rates import RATES

if TYPE_CHECKING:
    from device.simulator.lines import Watched


class TerminalLine:
    """The controller's side of a pseudo-terminal in raw mode; the other side is `address`."""

    def __init__(self) -> None:
        import pty
        import tty

        self._own, self._other = pty.openpty()
        tty.setraw(self._other)
        os.set_blocking(self._own, False)
        self._pending = bytearray()
        self.address = os.ttyname(self._other)

    def host_baud(self) -> int | None:
        """The speed the host has set its side to; None for one that is not known by name."""
        import termios

        named = termios.tcgetattr(self._own)[5]
        return next((rate for rate in RATES if getattr(termios, f"B{rate}") == named), None)

    def watched(self, *, want: bool) -> list[Watched]:
        """What can be waited for."""
        return [self._own] if want else []

    def arrived(self, readable: Sequence[Watched]) -> None:
        """Nobody has to be let in."""

    def read(self, most: int) -> bytes:
        try:
            return os.read(self._own, most)
        except BlockingIOError:
            return b""

    def write(self, data: bytes) -> bool:
        """Sends; False while nobody reads and the terminal's buffer is full."""
        self._pending += data
        if self._pending:
            try:
                del self._pending[: os.write(self._own, self._pending)]
            except BlockingIOError:
                return False
        return not self._pending

    def close(self) -> None:
        os.close(self._own)
        os.close(self._other)
