"""What happened at a machine: one row each, with its cause and the next step; kept on disk, searchable.

Faults, limits, stop codes, errors of programs, resets, lost lines, stops of the operator, downloads and burns. The file
is only ever added to (`EventFile`); a later line with the same number completes an earlier one.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from enum import StrEnum
from pathlib import Path

MOST_BYTES = 1_000_000  # of the newer of two files: some 3000 events each


class What(StrEnum):
    """The sort of an event."""

    FAULT = "fault"
    LIMIT = "limit"
    STOPPED = "stop code"
    PROGRAM = "program error"
    REFUSED = "refused command"
    RESET = "reset"
    LOST = "lost link"
    BACK = "link"
    STOP = "operator STOP"
    DOWNLOAD = "download"
    BURN = "burn"


@dataclass(frozen=True, slots=True)
class Event:
    """One happening; `at` is the time of day in seconds since 1970, places are counts."""

    number: int
    at: float
    what: What
    text: str
    axis: str = ""
    places: Mapping[str, float] = field(default_factory=dict)
    thread: int | None = None
    line: int | None = None
    cause: str = ""
    step: str = ""
    machine: str = ""
    running: Mapping[str, int] = field(default_factory=dict)  # the line of each thread that ran then, by its number

    @property
    def lines(self) -> tuple[tuple[int | None, int], ...]:
        """Threads with their lines: the one it was told of, else all that ran."""
        if self.line is not None:
            return ((self.thread, self.line),)
        return tuple((int(thread), line) for thread, line in sorted(self.running.items()))

    @property
    def place(self) -> float | None:
        """Where the axis concerned was."""
        return self.places.get(self.axis)

    def holds(self, words: Iterable[str]) -> bool:
        """Whether every word stands somewhere in it, in any case."""
        lines = (f"thread {thread} line {line}" for thread, line in self.lines)
        whole = " ".join((self.what, self.text, self.axis, self.cause, self.step, self.machine, *lines)).casefold()
        return all(word.casefold() in whole for word in words)


class EventFile:
    """Events as lines of JSON: added to at once, bounded in size, readable after any kill.

    When the file is full it becomes the older one, which replaces the one before; so two of them are the most there is.
    """

    def __init__(self, path: Path, most_bytes: int = MOST_BYTES) -> None:
        self.path, self._most = path, most_bytes
        self.older = path.with_name(f"{path.stem}-older{path.suffix}")
        self._size: int | None = None

    def add(self, event: Event) -> None:
        """One line, handed to the system at once; raises OSError."""
        data = json.dumps(asdict(event), ensure_ascii=False, separators=(",", ":")).encode() + b"\n"
        if self._size is None:
            self._size = self._begin()
        if self._size and self._size + len(data) > self._most:
            self.path.replace(self.older)
            self._size = 0
        with self.path.open("ab") as file:
            file.write(data)
        self._size += len(data)

    def _begin(self) -> int:
        """The size of what is there; a line that a kill left half is ended, so that it spoils no other."""
        self.path.parent.mkdir(parents=True, exist_ok=True)
        if not self.path.exists():
            return 0
        with self.path.open("rb+") as file:
            size = file.seek(0, 2)
            if size:
                file.seek(size - 1)
                if file.read(1) != b"\n":
                    file.write(b"\n")
                    size += 1
        return size

    def load(self) -> list[Event]:
        """All events, oldest first; lines that cannot be read are left out."""
        found: dict[int, Event] = {}
        for path in (self.older, self.path):
            for event in _read(path):
                found[event.number] = event
        return sorted(found.values(), key=lambda event: event.number)


def _read(path: Path) -> Iterator[Event]:
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError:  # there is none, or none that can be read: writing tells why
        return
    for line in text.split("\n"):
        event = _event(line)
        if event is not None:
            yield event


def _event(line: str) -> Event | None:
    """One line; None where it is broken or of a later version."""
    try:
        kept = json.loads(line)
        return Event(**{**kept, "what": What(kept["what"])})
    except (ValueError, TypeError, KeyError):
        return None


class EventList:
    """The events there are, newest last; what is added goes to disk at once."""

    def __init__(self, file: EventFile | None = None) -> None:
        self._file = file
        self._events = {event.number: event for event in file.load()} if file is not None else {}
        self.problem = ""  # why the last one was not kept
        self.changes = 0  # how often something was added or completed

    def __len__(self) -> int:
        return len(self._events)

    @property
    def newest(self) -> int:
        """The number of the newest one; grows with each."""
        return max(self._events, default=0)

    def all(self) -> list[Event]:
        """Oldest first."""
        return list(self._events.values())

    def add(self, event: Event) -> Event:
        """Gives it a number and keeps it."""
        return self._keep(replace(event, number=self.newest + 1))

    def complete(self, number: int, **more: object) -> None:
        """What became known of an event later."""
        event = self._events.get(number)
        if event is not None:
            self._keep(replace(event, **more))  # type: ignore[arg-type]

    def search(self, text: str = "", kinds: Iterable[What] = (), axis: str = "", since: float = 0.0) -> list[Event]:
        """The events that hold all of these words, of these kinds, newest first."""
        words, wanted = text.split(), frozenset(kinds)
        return [
            event
            for event in reversed(self._events.values())
            if event.at >= since
            and (not wanted or event.what in wanted)
            and (not axis or event.axis == axis)
            and (not words or event.holds(words))
        ]

    def _keep(self, event: Event) -> Event:
        self._events[event.number] = event
        self.changes += 1
        if self._file is not None:
            try:
                self._file.add(event)
                self.problem = ""
            except OSError as reason:
                self.problem = f"Events are not kept on disk ({reason.strerror or reason})."
        return event
