"""How a recording is kept: blocks of records, each with a mark, a checksum and its times, so that damage stays small.

Blocks belong to a compressed stream that begins afresh every so often; what follows a damaged block can be read again
from the next fresh one. Files of blocks can be joined in any number.
"""

from __future__ import annotations

import json
import struct
import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum, IntFlag
from typing import Any, TypeAlias

MARK = b"\xf7TL1"
HEAD = struct.Struct("<4sIBIdd")  # mark, checksum of all that follows, flags, size, first and last moment
UNIT_S = 0.0001  # of the times inside a block
CHECKED = 8  # bytes of the head before what the checksum covers
STREAM_BYTES = 262_144  # of records, before the stream begins afresh
LATEST = 32_503_680_000.0  # s since 1970, the year 3000: a later moment was not written by us
MOST_BYTES = 64_000_000  # of records that one block may hold: more is no recording of ours

Payload: TypeAlias = "str | bytes | Mapping[str, Any]"


class What(IntEnum):
    """The sort of a record."""

    RECEIVED = 0
    SENT = 1
    NOTE = 2


class Flag(IntFlag):
    """What is true of a block."""

    FRESH = 1  # its compressed stream begins here
    SESSION = 2  # a studio was started
    NOTES = 4  # it holds notes


@dataclass(frozen=True, slots=True)
class Record:
    """Bytes that came or left on a channel, or a note; `at` is in seconds since 1970."""

    at: float
    what: What
    channel: int
    data: bytes


@dataclass(frozen=True, slots=True)
class Block:
    """Where a block's data lie, and between which moments they were recorded; `chain` is the fresh block before it."""

    start: int
    size: int
    flags: Flag
    first: float
    last: float
    chain: int


def note_bytes(kind: str, payload: Payload) -> bytes:
    """A note as it is kept: its kind, how the payload is written, the payload."""
    if isinstance(payload, bytes):
        return f"{kind}\nb".encode() + payload
    if isinstance(payload, str):
        return f"{kind}\ns{payload}".encode("utf-8", "replace")
    return f"{kind}\nj{json.dumps(payload, ensure_ascii=False, separators=(',', ':'), default=_listed)}".encode()


def note_of(data: bytes) -> tuple[str, Payload]:
    """The kind of a note and what it says; a payload that cannot be read is its bytes."""
    head, _, rest = data.partition(b"\n")
    kind, way, body = head.decode("utf-8", "replace"), rest[:1], rest[1:]
    if way == b"s":
        return kind, body.decode("utf-8", "replace")
    if way == b"j":
        try:
            found = json.loads(body)
        except ValueError:
            return kind, body
        return kind, found if isinstance(found, dict) else body
    return kind, body


def _listed(value: object) -> object:
    """Arrays as lists; anything else in its own words."""
    to_list = getattr(value, "tolist", None)
    return to_list() if callable(to_list) else str(value)


class Packer:
    """Makes blocks of records."""

    def __init__(self) -> None:
        self._stream = zlib.compressobj(6)
        self._taken = STREAM_BYTES
        self._flags = Flag.SESSION

    def afresh(self) -> None:
        """The next block can be read without those before it (it begins a file)."""
        self._taken = STREAM_BYTES

    def pack(self, records: Sequence[Record]) -> bytes:
        """One block of these records, which are in the order of their times."""
        first, last = records[0].at, max(record.at for record in records)
        flags, self._flags = self._flags, Flag(0)
        if any(record.what is What.NOTE for record in records):
            flags |= Flag.NOTES
        if self._taken >= STREAM_BYTES:
            self._stream, self._taken = zlib.compressobj(6), 0
            flags |= Flag.FRESH
        raw = _columns(records, first)
        self._taken += len(raw)
        data = self._stream.compress(raw) + self._stream.flush(zlib.Z_SYNC_FLUSH)
        head = HEAD.pack(MARK, 0, flags, len(data), first, last)
        return MARK + struct.pack("<I", zlib.crc32(data, zlib.crc32(head[CHECKED:]))) + head[CHECKED:] + data


def find_blocks(data: bytes) -> tuple[list[Block], int]:
    """The blocks that are whole and can be read, and how many stretches between them cannot."""
    found: list[Block] = []
    lost, place, chain, whole = 0, 0, -1, True
    while place < len(data):
        start = data.find(MARK, place)
        block = _block(data, start) if start >= 0 else None
        if start != place or block is None:  # something lies here that is no block
            lost, whole, chain = lost + whole, False, -1
            if start < 0:
                break
            place = start + (start == place)
            continue
        place = block.start + block.size
        chain = len(found) if block.flags & Flag.FRESH else chain
        if chain < 0:  # its stream has lost its beginning
            continue
        whole = True
        found.append(Block(block.start, block.size, block.flags, block.first, block.last, chain))
    return found, lost


def _block(data: bytes, start: int) -> Block | None:
    """The block at this place, when it is whole."""
    if start + HEAD.size > len(data):
        return None
    _, checksum, flags, size, first, last = HEAD.unpack_from(data, start)
    begin = start + HEAD.size
    if begin + size > len(data):
        return None
    if zlib.crc32(data[begin : begin + size], zlib.crc32(data[start + CHECKED : begin])) != checksum:
        return None
    if not 0 <= first <= last <= LATEST:
        return None
    return Block(begin, size, Flag(flags & 7), first, last, -1)


def begins(head: bytes) -> float | None:
    """When the block with this head begins, in seconds since 1970."""
    if len(head) < HEAD.size or not head.startswith(MARK):
        return None
    first: float = HEAD.unpack(head)[4]
    return first if 0 <= first <= LATEST else None


def _columns(records: Sequence[Record], first: float) -> bytes:
    """Sorts, times and sizes of the records, then their data: likes beside likes are compressed best."""
    numbers = [len(records)]
    numbers += [record.channel * 4 + record.what for record in records]
    before = 0
    for record in records:
        now = max(round((record.at - first) / UNIT_S), before)
        numbers.append(now - before)
        before = now
    numbers += [len(record.data) for record in records]
    return b"".join([_packed(numbers), *(record.data for record in records)])


def _packed(numbers: Sequence[int]) -> bytes:
    """Seven bits a byte, the lowest first; the highest bit says that more follow."""
    found = bytearray()
    for number in numbers:
        while number > 0x7F:
            found.append(number & 0x7F | 0x80)
            number >>= 7
        found.append(number)
    return bytes(found)


class _Numbers:
    """Reads them again; IndexError beyond the end."""

    def __init__(self, raw: bytes) -> None:
        self.raw, self.place = raw, 0

    def take(self, count: int) -> list[int]:
        found = []
        for _ in range(count):
            number, shift = 0, 0
            while True:
                byte = self.raw[self.place]
                self.place += 1
                number |= (byte & 0x7F) << shift
                shift += 7
                if byte < 0x80:
                    break
            found.append(number)
        return found


def unpack(raw: bytes, first: float) -> Iterator[Record]:
    """The records of a block; ends where they make no sense."""
    numbers = _Numbers(raw)
    try:
        (count,) = numbers.take(1)
        sorts, steps, sizes = numbers.take(count), numbers.take(count), numbers.take(count)
    except IndexError:
        return
    at, place = 0, numbers.place
    for sort, step, size in zip(sorts, steps, sizes, strict=True):
        at += step
        if sort & 3 == 3 or place + size > len(raw):
            return
        yield Record(first + at * UNIT_S, What(sort & 3), sort >> 2, raw[place : place + size])
        place += size
