"""The recorder: all bytes both ways with their times, what the person did, captures; in a ring of files, always on.

Whoever has something to record only puts it into a queue; a thread of its own writes it twice a second. What a kill
can take is what was recorded since.
"""

from __future__ import annotations

import itertools
import os
import re
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypeAlias

from device.recorder_format import HEAD, Packer, Payload, Record, What, begins, note_bytes
from device.transport import Transport, Wired

MOST_BYTES = 50_000_000
MOST_S = 24 * 3600.0
FILE_BYTES = 1_000_000
WRITE_S = 0.5
TOGETHER_S = 0.004  # pieces of one stream that come so close to each other are kept as one
QUEUE_BYTES = 65_536  # where no thread writes: so much waits at most
JUMP_S = 2.0  # the clock on the wall against our own: slept through by the computer, or set by somebody
SUFFIX = ".tape"
OURS = re.compile(rf"([0-9]{{15}})-[0-9]+\{SUFFIX}")  # a file of the ring; any other is somebody's

Queued: TypeAlias = tuple[float, What, int, "bytes | tuple[str, Payload]"]


class Recorder:
    """What is recorded goes to `folder`; `problem` says in one sentence why it does not."""

    def __init__(
        self,
        folder: Path,
        *,
        clock: Callable[[], float] = time.monotonic,
        wall: Callable[[], float] = time.time,
        most_bytes: int = MOST_BYTES,
        most_s: float = MOST_S,
        threaded: bool = True,
    ) -> None:
        self.folder, self.problem = folder, ""
        self._clock, self._wall, self._began = clock, wall, wall() - clock()
        self._most_bytes, self._most_s, self._threaded = most_bytes, most_s, threaded
        self._queue: deque[Queued] = deque()
        self._waiting = 0
        self._numbers = itertools.count(1)
        self._packer = Packer()
        self._standing: dict[str, Payload] = {}  # the newest note of each sort that every file has to begin with
        self._path: Path | None = None
        self._written = 0
        self._busy = threading.Lock()
        self._closing = threading.Event()
        self._thread: threading.Thread | None = None

    # ------------------------------------------------------- for every thread

    def channel(self) -> Channel:
        """What a line is recorded through; each has a number of its own."""
        return Channel(self, next(self._numbers) % 256)

    def note(self, kind: str, payload: Payload) -> None:
        """Something worth knowing: text, values (arrays too), or bytes; must not be changed afterwards."""
        self.add(What.NOTE, 0, (kind, payload))

    def stand(self, kind: str, payload: Payload) -> None:
        """A note of what is the case from now on; it is repeated in each file, whose older ones may be gone."""
        self._standing = {**self._standing, kind: payload}
        self.note(kind, payload)

    def add(self, what: What, channel: int, data: bytes | tuple[str, Payload]) -> None:
        """Puts it into the queue: all that it costs whoever records."""
        self._queue.append((self._clock(), what, channel, data))
        if self._threaded:
            if self._thread is None:
                self._start()
        else:
            self._waiting += len(data)
            if self._waiting > QUEUE_BYTES:
                self.flush()

    def flush(self) -> None:
        """Everything recorded so far is in the file system's hands."""
        with self._busy:
            self._write()

    def close(self) -> None:
        """At the end of the program."""
        self._closing.set()
        if self._thread is not None:
            self._thread.join(2.0)
        self.flush()

    def files(self) -> list[Path]:
        """The files of the ring, oldest first."""
        try:
            return sorted(path for path in self.folder.iterdir() if OURS.fullmatch(path.name))
        except OSError:
            return []

    def since(self) -> float | None:
        """When the oldest of what is kept was recorded, in seconds since 1970."""
        for path in self.files():
            try:
                with path.open("rb") as file:
                    return begins(file.read(HEAD.size))
            except OSError:  # it went meanwhile
                continue
        return None

    # ---------------------------------------------------------------- writing

    def _start(self) -> None:
        with self._busy:
            if self._thread is None and not self._closing.is_set():
                self._thread = threading.Thread(target=self._run, name="recorder", daemon=True)
                self._thread.start()

    def _run(self) -> None:
        while not self._closing.wait(WRITE_S):
            self.flush()

    def _write(self) -> None:
        taken = [self._queue.popleft() for _ in range(len(self._queue))]
        self._waiting = 0
        if not taken:
            return
        began = self._wall() - self._clock()
        if abs(began - self._began) > JUMP_S:
            self._began = began
        records = joined_pieces([self._record(each) for each in taken])
        try:
            if self._path is None or self._written >= FILE_BYTES or not self._path.exists():
                self._begin(records[0].at)
                standing = [self._record((taken[0][0], What.NOTE, 0, each)) for each in self._standing.items()]
                records = [*standing, *records]
            assert self._path is not None
            data = self._packer.pack(records)
            with self._path.open("ab") as file:
                file.write(data)
            self._written += len(data)
            self.problem = ""
        except OSError as reason:
            self._take_back()
            self.problem = f"Nothing is recorded: {reason.strerror or reason} ({self.folder})."

    def _take_back(self) -> None:
        """A block that is not whole goes from the file, so that a full disk is not filled with pieces of files."""
        path, self._path = self._path, None
        self._packer.afresh()
        if path is None:
            return
        try:
            if self._written:
                os.truncate(path, self._written)
                self._path = path
            else:
                path.unlink(missing_ok=True)
        except OSError:
            return  # the folder is gone: the next try makes it, and another file

    def _record(self, queued: Queued) -> Record:
        at, what, channel, data = queued
        return Record(self._began + at, what, channel, data if isinstance(data, bytes) else note_bytes(*data))

    def _begin(self, at: float) -> None:
        """The next file; those that are too old or too many go. Names go up even where the clock was set back."""
        self.folder.mkdir(parents=True, exist_ok=True)
        kept, files = 0, self.files()
        for path in reversed(files):
            try:
                facts = path.stat()
            except FileNotFoundError:  # another studio has taken it away
                continue
            kept += facts.st_size
            if kept > self._most_bytes - FILE_BYTES or facts.st_mtime < self._wall() - self._most_s:
                path.unlink(missing_ok=True)
        newest = OURS.fullmatch(files[-1].name) if files else None
        number = max(round(at * 1000), int(newest[1]) + 1 if newest else 0)
        self._path = self.folder / f"{number:015d}-{os.getpid()}{SUFFIX}"
        self._written = 0
        self._packer.afresh()


def joined_pieces(records: Sequence[Record]) -> list[Record]:
    """A line comes in pieces of a few bytes: those that follow each other without a gap become one."""
    found: list[Record] = []
    pieces: list[bytes] = []
    for record in records:
        last = found[-1] if found else None
        if (
            last is not None
            and record.what is last.what
            and record.what is not What.NOTE
            and record.channel == last.channel
            and record.at - last.at <= TOGETHER_S
        ):
            pieces.append(record.data)
            continue
        if last is not None and len(pieces) > 1:
            found[-1] = replace(last, data=b"".join(pieces))
        found.append(record)
        pieces = [record.data]
    if found and len(pieces) > 1:
        found[-1] = replace(found[-1], data=b"".join(pieces))
    return found


class Channel:
    """Wraps lines; all bytes of them are recorded under its number."""

    def __init__(self, recorder: Recorder, number: int) -> None:
        self._recorder, self.number = recorder, number

    def tap(self, opener: Callable[[], Transport]) -> Callable[[], Transport]:
        """Opens the same line, recorded."""
        return lambda: self.wrap(opener())

    def wrap(self, transport: Transport) -> Transport:
        """The same line, recorded."""
        self._recorder.note("opened", {"channel": self.number, "line": transport.description})
        return Tapped(transport, self._recorder, self.number)


class Tapped:
    """A line whose bytes are recorded as they come and as the system takes them."""

    def __init__(self, inner: Transport, recorder: Recorder, number: int) -> None:
        self._inner, self._add, self._number = inner, recorder.add, number

    @property
    def description(self) -> str:
        return self._inner.description

    def read(self, timeout_s: float) -> bytes:
        data = self._inner.read(timeout_s)
        if data:
            self._add(What.RECEIVED, self._number, data)
        return data

    def write(self, data: bytes) -> int:
        taken = self._inner.write(data)
        if taken:
            self._add(What.SENT, self._number, data[:taken])
        return taken

    def unsent(self) -> int:
        return self._inner.unsent()

    def discard_output(self) -> None:
        self._inner.discard_output()

    def clear_to_send(self) -> bool | None:
        """CTS, where the line has it."""
        return self._inner.clear_to_send() if isinstance(self._inner, Wired) else None

    def close(self) -> None:
        self._inner.close()
