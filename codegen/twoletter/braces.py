"""What stands in braces: formats, characters, ports."""

from __future__ import annotations

import re

from codegen.twoletter.nodes import Character, Format, NoLineEnd, Port, Span
from codegen.twoletter.tokens import Cursor

_NUMBER_FORMAT = re.compile(r"([FZ$])(\d{1,2})(?:\.(\d))?\Z").match
_STRING_FORMAT = re.compile(r"S([1-6])?\Z").match
_CHARACTER = re.compile(r"\^(\d{1,3})\Z").match


def brace(cursor: Cursor) -> Format | Character | Port | NoLineEnd:
    """`{F4.2}`, `{$4.2}`, `{S3}`, `{^13}`, `{P2}`, `{N}`."""
    refused = cursor.refuse("bad-format", 53)
    later = cursor.refuse("later-form", 53, foreign=True)
    text, start, end = cursor.braces()
    span = Span(start, end)
    if text in ("P1", "P2"):
        return Port(int(text[1]), span)
    if text == "N":
        return NoLineEnd(span)
    if match := _STRING_FORMAT(text):
        return Format("S", int(match[1] or 6), 0, span)
    if match := _CHARACTER(text):
        if not 1 <= int(match[1]) <= 255:
            raise refused
        return Character(int(match[1]), span)
    match = _NUMBER_FORMAT(text)
    if match is None or int(match[2]) > 10 or int(match[3] or 0) > 4:
        raise refused
    if match[1] == "Z":
        raise later
    return Format(match[1], int(match[2]), int(match[3] or 0), span)


def local_format(cursor: Cursor) -> Format:
    """The local format of a printed value."""
    refused = cursor.refuse("bad-format", 53)
    node = brace(cursor)
    if not isinstance(node, Format):
        raise refused
    return node
