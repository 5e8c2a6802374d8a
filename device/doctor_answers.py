"""What an answer to a carriage return is: a prompt, an echo, text of something else, garbage."""

from __future__ import annotations

import re
from enum import StrEnum

PROMPT = re.compile(rb"(?:^|[\r\n:?])[:?]$")
PLAIN = frozenset(range(0x20, 0x7F)) | frozenset(b"\r\n\t\x1a\x1e\x1f")
FILL = b"\x00\x11\x13"


class Answered(StrEnum):
    """What came back for a carriage return."""

    NOTHING = "nothing"
    PROMPT = "prompt"
    ECHO = "echo"
    TEXT = "text"
    GARBAGE = "garbage"


def judged(came: bytes) -> Answered:
    """What the answer to a carriage return is; bit 7 may mark text of a program."""
    kept = came.translate(None, FILL)
    if not kept:
        return Answered.NOTHING
    if kept == b"\r":
        return Answered.ECHO
    if PROMPT.search(bytes(byte & 0x7F for byte in kept)) and _plain(bytes(byte & 0x7F for byte in kept)):
        return Answered.PROMPT
    return Answered.TEXT if _plain(kept) and len(kept) > 3 else Answered.GARBAGE


def _plain(data: bytes) -> bool:
    return all(byte in PLAIN for byte in data)
