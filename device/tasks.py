"""What runs on the link: steps written as generators that yield what to send and get its answer."""

from __future__ import annotations

from collections.abc import Callable, Generator
from concurrent.futures import Future
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any, Generic, TypeAlias, TypeVar

from device.wire import Answer, Expectation

T = TypeVar("T")


class LinkError(Exception):
    """Something that ends an exchange; the text is one sentence to show."""


class LinkLost(LinkError):
    """The controller cannot be reached or does not answer."""


class Stopped(LinkError):
    """Dropped because STOP was pressed."""


class NotAllowed(LinkError):
    """Not sent: Watch, a waiting question, or a rule of the program."""


class Refused(LinkError):
    """The controller answered `?`."""

    def __init__(self, code: int, text: str) -> None:
        super().__init__(text)
        self.code = code


class Priority(IntEnum):
    """Who goes first."""

    STOP = 0
    LEASE = 1
    USER = 2
    DOWNLOAD = 3
    POLL = 4


@dataclass(frozen=True, slots=True)
class Send:
    """Bytes to send and what to wait for.

    Without `expect` the answer comes as soon as the bytes are handed over. `hold` keeps the line for this task.
    `extends`: the time-out starts again with every byte that comes.
    `watch_for`: any of these bytes, coming while the task holds the line, ends the step as refused.
    `refusal_s`: a `?` followed by so much silence ends the wait early, as uncertain.
    `stored`: a line of a program, which is kept and not carried out.
    `stops`: it only ends a motion begun by hand, so it leaves in Watch as well.
    """

    data: bytes
    expect: Expectation | None = None
    timeout_s: float = 0.5
    hold: bool = False
    extends: bool = False
    watch_for: bytes = b""
    answers_prompt: bool = False
    refusal_s: float = 0.0
    stored: bool = False
    stops: bool = False


@dataclass(frozen=True, slots=True)
class Wait:
    """Nothing for a while; `hold` keeps the line meanwhile."""

    seconds: float
    hold: bool = False
    watch_for: bytes = b""


Step: TypeAlias = Send | Wait
Steps: TypeAlias = Generator[Step, Answer, T]


@dataclass(eq=False, slots=True)
class Task(Generic[T]):
    """Steps on their way, with the future that gets their result."""

    steps: Steps[T]
    priority: Priority
    source: str
    future: Future[T] = field(default_factory=Future)
    step: Step | None = None
    due: float = 0.0
    number: int = 0
    then: Callable[[Task[Any]], None] | None = None


def data_line(text: str) -> bytes:
    """A line as it is sent; raises NotAllowed for what cannot be typed."""
    try:
        return text.encode("ascii") + b"\r"
    except UnicodeEncodeError as reason:
        raise NotAllowed(f"The controller knows no “{text[reason.start]}”; write plain letters.") from reason
