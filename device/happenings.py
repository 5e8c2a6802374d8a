"""What the windows see of a connection: its kind and state, the program badge, and notices."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Kind(StrEnum):
    MACHINE = "machine"
    SIMULATOR = "simulator"
    REPLAY = "replay"
    OFFLINE = "offline"


class State(StrEnum):
    OFFLINE = "offline"
    CONNECTING = "connecting"
    READY = "connected"
    LOST = "connection lost"


class Badge(StrEnum):
    """How the program in the controller stands to the document."""

    SAME = "same program"
    CHANGED = "changed since download"
    UNKNOWN = "unknown program"


class NoticeKind(StrEnum):
    MESSAGE = "message"
    UNCLEAR = "unclear"
    PROMPT = "question"
    FAULT = "fault"
    LOST = "lost"
    CONNECTED = "connected"
    IDENTIFIED = "identified"
    RESTARTED = "restarted"
    STOP = "stop"
    CONTROL = "control"
    DOWNLOAD = "download"


@dataclass(frozen=True, slots=True)
class Notice:
    """Something that happened, in one sentence."""

    kind: NoticeKind
    text: str
    at: float
