"""A recording that was opened: what is whole of it, its length, what happened in it, and its records from any place.

Places are seconds from the beginning; times in which nothing at all was recorded are left out of them.
"""

from __future__ import annotations

import zipfile
import zlib
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from device.recorder import SUFFIX
from device.recorder_format import MARK, MOST_BYTES, Flag, Payload, Record, What, find_blocks, note_of, unpack

QUIET_S = 30.0  # a longer time without anything is left out
GAP_S = 1.0  # what is left of it
IN_BUNDLE = "recording.tape"
MOST_READ = 500_000_000  # bytes
DAMAGE = (zipfile.BadZipFile, zlib.error, RuntimeError, NotImplementedError, EOFError)  # of a bundle


class RecordingUnreadable(Exception):
    """It cannot be opened; the text is the sentence to show."""


@dataclass(frozen=True, slots=True)
class Note:
    """Something noted, and where; `at` is in seconds since 1970."""

    place: float
    at: float
    kind: str
    payload: Payload


@dataclass(frozen=True, slots=True)
class Placed:
    """A record and its place."""

    place: float
    record: Record


class Recording:
    """Everything that is whole in these bytes."""

    def __init__(self, data: bytes, name: str = "") -> None:
        self.name = name
        self._data = data
        self._blocks, self.lost = find_blocks(data)
        self._starts = list(self._find_starts())
        self.length = self._starts[-1] + self._blocks[-1].last - self._blocks[-1].first if self._blocks else 0.0
        self.notes: tuple[Note, ...] = tuple(self._find_notes())

    @property
    def problem(self) -> str:
        """What is wrong with it, in one sentence, or nothing."""
        if not self.lost:
            return ""
        pieces = "A piece" if self.lost == 1 else f"{self.lost} pieces"
        return f"{pieces} of {self.name or 'this recording'} cannot be read; what is whole is played."

    def at(self, place: float) -> float:
        """The time of day at a place, in seconds since 1970."""
        if not self._blocks:
            return 0.0
        number = max(bisect_right(self._starts, place) - 1, 0)
        return self._blocks[number].first + place - self._starts[number]

    def before(self, kind: str, place: float) -> Note | None:
        """The newest note of this kind at or before a place; the very first one where there is none before."""
        found = [note for note in self.notes if note.kind == kind]
        return next((note for note in reversed(found) if note.place <= place), found[0] if found else None)

    def records(self, place: float = 0.0) -> Iterator[Placed]:
        """Everything from a place on, in its order."""
        begin = max(bisect_right(self._starts, place) - 1, 0)
        for number, raw in self._raw(begin):
            block, start = self._blocks[number], self._starts[number]
            for record in unpack(raw, block.first):
                at = start + record.at - block.first
                if at >= place:
                    yield Placed(at, record)

    # ----------------------------------------------------------------- inside

    def _find_starts(self) -> Iterator[float]:
        place, before = 0.0, None
        for block in self._blocks:
            if before is not None:
                gap = block.first - before.last
                place += before.last - before.first
                place += gap if 0 <= gap <= QUIET_S and not block.flags & Flag.SESSION else GAP_S
            yield place
            before = block

    def _raw(self, begin: int) -> Iterator[tuple[int, bytes]]:
        """Blocks from this one on, decompressed; a stream has to be read from its start."""
        stream = zlib.decompressobj()
        number = self._blocks[begin].chain if self._blocks else 0
        while number < len(self._blocks):
            block = self._blocks[number]
            if block.flags & Flag.FRESH:
                stream = zlib.decompressobj()
            try:
                raw = stream.decompress(self._data[block.start : block.start + block.size], MOST_BYTES)
            except zlib.error:  # the checksum was right, so it was written wrong: nothing of ours
                raw = b""
            if number >= begin:
                yield number, raw
            number += 1

    def _find_notes(self) -> Iterator[Note]:
        """Only streams that hold notes are looked into."""
        chains = sorted({block.chain for block in self._blocks if block.flags & Flag.NOTES})
        for chain in chains:
            for number, raw in self._raw(chain):
                block = self._blocks[number]
                if block.chain != chain:
                    break
                if not block.flags & Flag.NOTES:
                    continue
                for record in unpack(raw, block.first):
                    if record.what is What.NOTE:
                        kind, payload = note_of(record.data)
                        yield Note(self._starts[number] + record.at - block.first, record.at, kind, payload)


def joined(files: Sequence[Path]) -> bytes:
    """Files of the ring as one; one that goes away meanwhile is left out."""
    parts = []
    for path in files:
        try:
            parts.append(path.read_bytes())
        except OSError:
            continue
    return b"".join(parts)


def open_recording(path: Path) -> Recording:
    """A recording, or the one in a service bundle; raises RecordingUnreadable."""
    try:
        if path.stat().st_size > MOST_READ:
            raise RecordingUnreadable(f"{path.name} is larger than any recording this program writes.")
        data = _bundled(path) if zipfile.is_zipfile(path) else path.read_bytes()
    except OSError as reason:
        raise RecordingUnreadable(f"{path.name} cannot be opened: {reason.strerror or reason}.") from reason
    except DAMAGE as reason:
        raise RecordingUnreadable(f"{path.name} is a damaged bundle; ask for it again.") from reason
    recording = Recording(data, path.name)
    if not recording.length and not recording.notes:
        words = "holds nothing that can be read" if MARK in data else "is no recording and no service bundle"
        raise RecordingUnreadable(f"{path.name} {words}; choose a file ending in {SUFFIX} or a service bundle (.zip).")
    return recording


def _bundled(path: Path) -> bytes:
    with zipfile.ZipFile(path) as bundle:
        if IN_BUNDLE not in bundle.namelist():
            raise RecordingUnreadable(f"There is no recording in {path.name}; it is no service bundle of this program.")
        if bundle.getinfo(IN_BUNDLE).file_size > MOST_READ:
            raise RecordingUnreadable(f"The recording in {path.name} is larger than any this program writes.")
        return bundle.read(IN_BUNDLE)
