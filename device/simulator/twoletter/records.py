"""What the host learns beside the bytes: messages, program errors and the lines that threads come to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypedDict

from device.simulator.times import milliseconds


class ProgramError(TypedDict):
    """An error of a program, as `run --json` shows it."""

    thread: int
    line: int
    source: str
    code: int
    text: str
    handled: bool


@dataclass(slots=True)
class Records:
    """Grows only; not part of the simulated state."""

    messages: list[tuple[float, int, str]] = field(default_factory=list)
    errors: list[ProgramError] = field(default_factory=list)
    unhandled: int = 0  # errors that ended a thread
    on_trace: Callable[[int, int, int], None] | None = None
    _open: dict[int, tuple[float, str]] = field(default_factory=dict)

    def sent(self, ticks: int, port: int, text: str) -> None:
        """Something was sent unasked; pieces without a line end join the next."""
        began, before = self._open.pop(port, (milliseconds(ticks), ""))
        *whole, rest = (before + text).split("\r\n")
        for line in whole:
            self.messages.append((began, port, line))
            began = milliseconds(ticks)
        if rest:
            self._open[port] = (began, rest)

    def told(self) -> list[tuple[float, int, str]]:
        """All messages, also those whose line has not ended yet."""
        return [*self.messages, *((began, port, text) for port, (began, text) in sorted(self._open.items()))]

    def keep(self, count: int) -> None:
        """Forgets all but the newest messages and errors."""
        if len(self.messages) > 2 * count:
            del self.messages[:-count]
        if len(self.errors) > 2 * count:
            del self.errors[:-count]

    def flush(self, port: int) -> None:
        """Ends a message that has no line end, as a prompt has none."""
        began, text = self._open.pop(port, (0.0, ""))
        if text:
            self.messages.append((began, port, text))
