"""The door of the link: in Watch only harmless reads and STOP leave; to a waiting question only its answer."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import lru_cache

from codegen.twoletter import nodes
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.parse import parse_line

REVISION = b"\x12\x16"
LEAVE = b"\x11\x1b\x5c"  # leaves editor, data mode and download; nothing in command mode
MASTER_RESET = b"\x12\x13"

ADDRESSES = re.compile(rb"(?:^|;)[ ]*%[ ]*[0-9]")  # a line that chooses a controller of a daisy chain
TELLS = frozenset(name for name, row in COMMANDS.items() if row.tells) - {"TC"}  # reading TC clears it
LISTS = frozenset(["LS", "LL", "LV", "LA", "UL", "QU"])
CONSUMING = frozenset(["P1ST", "P1NM", "P1CD", "P2ST", "P2NM", "P2CD"])  # reading a string or number clears its status


@lru_cache(maxsize=2048)
def only_reads(data: bytes) -> bool:
    """Whether these bytes can change nothing: listed reads, queries, or the revision."""
    if data in (REVISION, LEAVE + b"\r", b"\r"):
        return True
    if not data.endswith(b"\r") or not data.isascii() or any(byte < 0x20 for byte in data[:-1]):
        return False
    line = parse_line(data[:-1].decode("ascii"))
    return all(_reads(statement) for statement in line.statements)


@lru_cache(maxsize=2048)
def waits(data: bytes) -> str:
    """The trippoint in a line, if there is one: the port takes nothing else before it trips."""
    if not data.isascii():
        return ""
    line = data.decode("ascii").rstrip("\r")
    for text in (line, line.replace(" ", "")):  # blanks mean nothing outside quotes
        for statement in parse_line(text).statements:
            name = statement.name if isinstance(statement, nodes.Command) else ""
            if name in COMMANDS and COMMANDS[name].trippoint:
                return name
    return ""


def _reads(statement: nodes.Statement) -> bool:
    if isinstance(statement, nodes.Nothing):
        return True
    if isinstance(statement, nodes.Print):
        return _harmless(statement.target)
    if not isinstance(statement, nodes.Command) or statement.axis is not None or statement.index is not None:
        return False
    if statement.name == "MG":
        return all(_message_item(item) for item in statement.arguments)
    if statement.name in LISTS:
        return True
    if statement.name in TELLS:
        return all(
            isinstance(item, nodes.Axes | nodes.Format | nodes.Query) or _constant(item) for item in statement.arguments
        )
    queries = [item for item in statement.arguments if not isinstance(item, nodes.Empty | nodes.Format)]
    return bool(queries) and all(isinstance(item, nodes.Query) for item in queries)


def _message_item(item: nodes.Argument) -> bool:
    if isinstance(item, nodes.String | nodes.Character | nodes.NoLineEnd):
        return True
    if isinstance(item, nodes.Port):
        return item.number == 1  # whatever hangs on port 2 is no business of a read
    if isinstance(item, nodes.Formatted):
        return _harmless(item.expression)
    return _harmless(item)


def _constant(item: nodes.Argument) -> bool:
    return isinstance(item, nodes.Number)


def _harmless(item: object) -> bool:
    """An expression that only looks: no keyword whose reading clears something."""
    if isinstance(item, nodes.Number | nodes.String | nodes.Variable | nodes.Operand):
        return True
    if isinstance(item, nodes.Keyword):
        return item.name not in CONSUMING
    if isinstance(item, nodes.Element):
        return item.index is not None and _harmless(item.index)
    if isinstance(item, nodes.Function):
        return _harmless(item.argument)
    if isinstance(item, nodes.Negative):
        return _harmless(item.operand)
    if isinstance(item, nodes.Binary):
        return _harmless(item.left) and _harmless(item.right)
    return isinstance(item, nodes.Group) and _harmless(item.inner)


def choose(unit: int) -> bytes:
    """The line that says which controller of a daisy chain is talked to (dmc-1412-1414.txt l.1304)."""
    return f"%{unit}\r".encode()


class Door:
    """Decides for every send; the link asks it, and nothing leaves around it."""

    def __init__(self, unit: int | None = None) -> None:
        self._choose_unit = choose(unit) if unit is not None else b""  # ours on a daisy chain
        self.control = False
        self.closed = ""  # why nothing at all leaves, STOP included: there is no controller behind it
        self.question = ""  # why only an answer may leave, in words
        self.resting: Callable[[], str] = lambda: ""  # why live reads rest now
        self.erasing = False  # the confirmed action that erases the memory sets it for its one send

    def refusal(
        self, data: bytes, *, stop: bool, answer: bool, poll: bool = False, stored: bool = False, ends: bool = False
    ) -> str:
        """Why these bytes may not leave, as one sentence, or nothing."""
        if self.closed:
            return self.closed
        if stop:
            return ""
        if answer:
            return "" if self.question else "No question is waiting for an answer."
        if self.question:
            return f"Not sent: {self.question} Answer it, or press STOP."
        if poll and self.resting():
            return self.resting()
        if MASTER_RESET in data and not self.erasing:
            return "Control-R control-S erases the controller's memory; it is sent only by its own confirmed action."
        if not self.control and not ends and data != self._choose_unit and not only_reads(data):
            return "Not sent: this is Watch. Switch to Control to move, set or download."
        if b"%" in data and data != self._choose_unit and not stored and ADDRESSES.search(data):
            return "Another address of a daisy chain is chosen where you connect: everything shown here is of this one."
        trippoint = "" if stored else waits(data)
        if trippoint:
            return f"{trippoint} typed here would hold this line, STOP included, until it trips; use it in a program."
        return ""
