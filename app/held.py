"""What the controller holds, in words: the open program, an earlier download of it, another one, none, or not known."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

from codegen.twoletter import nodes
from codegen.twoletter.parse import parse
from codegen.twoletter.slow_mark import FULL, percent_of
from device.api import Badge, Controller
from device.download import program_lines

MOST_SHOWN = 8  # lines of code in a question
REAL_FIRST = "Download the program as it is written first, and let it run once."
MOVES = "the machine may move as soon as it is switched on"


class Holding(Enum):
    """How the program in the controller stands to the open one."""

    SAME = "the open program"
    EARLIER = "the open program before it was changed"
    OTHER = "another program"
    SLOWED = "a program at a part of its speed"
    EMPTY = "no program"
    UNKNOWN = "not known"


@dataclass(frozen=True)
class Sent:
    """The program that was downloaded last from here."""

    name: str
    lines: tuple[str, ...]
    time: str  # of the day, "14:05"
    open: bool = True  # whether it is still the one that is open


@dataclass(frozen=True)
class Held:
    """What is known of the program in the controller."""

    holding: Holding = Holding.UNKNOWN
    lines: tuple[str, ...] = ()
    sent: Sent | None = None  # when it came from here
    labels: tuple[str, ...] = ()
    percent: int = FULL  # of the speed that was written

    @property
    def words(self) -> str:
        """Which program it is, for the middle of a sentence."""
        count = f"{len(self.lines)} line{'s' * (len(self.lines) != 1)}"
        slow = f" slowed to {self.percent} %" if self.percent < FULL else ""
        if self.sent is not None:
            return f"“{self.sent.name}”{slow} as it was downloaded at {self.sent.time} ({count})"
        label = f", first label #{self.labels[0]}" if self.labels else ""
        return f"another program than the open one{slow and ','}{slow} ({count}{label})"

    @property
    def shown(self) -> str:
        """Its first lines, for a question."""
        more = len(self.lines) - MOST_SHOWN
        rest = [f"… and {more} more line{'s' * (more != 1)}"] if more > 0 else []
        return "\n".join([*self.lines[:MOST_SHOWN], *rest])

    @property
    def power_up(self) -> str:
        """What the next power-up does once it is burned."""
        if "AUTO" in self.labels:
            return f"At the next power-up it starts by itself at #AUTO: {MOVES}."
        return "At the next power-up it is in the controller but does not start: it has no #AUTO."


def held_by(controller: Controller, sent: Sent | None) -> Held:
    """What the controller holds now; `sent`: what was downloaded last from here."""
    badge, listing = controller.program_badge, controller.listing
    if badge is Badge.UNKNOWN or listing is None:
        return Held()
    lines = tuple(program_lines(listing))
    from_here = sent if sent is not None and sent.lines == lines else None
    percent = percent_of(listing)
    if percent < FULL:
        holding = Holding.SLOWED
    elif badge is Badge.SAME:
        holding = Holding.SAME
    elif not lines:
        holding = Holding.EMPTY
    elif from_here is not None and from_here.open:
        holding = Holding.EARLIER
    else:
        holding = Holding.OTHER
    return Held(holding, lines, from_here, tuple(_labels(listing)), percent)


def burn_words(held: Held, name: str) -> str:
    """What will be burned, and what the next power-up does with it."""
    if held.holding is Holding.EMPTY:
        return (
            "There is no program in the controller: the open one was not downloaded. "
            "Burned, the program memory is empty after the next power-up, and nothing starts."
        )
    if held.holding is Holding.SLOWED:
        return f"The controller holds {held.words}. A slowed program is never burned. {REAL_FIRST}"
    if held.holding is Holding.SAME:
        return f"What is burned is the open program “{name}” ({len(held.lines)} lines). {held.power_up}"
    if held.holding is Holding.EARLIER:
        what = f"{held.words}, without the changes since then: they are not in the controller"
    else:
        what = f"what the controller holds: {held.words}"
    return f"What is burned is {what}. {held.power_up}\n\n{held.shown}"


def execute_words(held: Held) -> str:
    """Why Execute asks which program is meant."""
    tied = "Execute belongs to the program that was downloaded and verified."
    if held.holding is Holding.EMPTY:
        return f"There is no program in the controller. {tied}"
    if held.holding is Holding.SLOWED:
        return (
            f"The controller holds {held.words}. At full speed it moves {FULL / held.percent:g} times as fast: "
            "the program is sent again as it is written."
        )
    if held.holding is Holding.EARLIER:
        return f"The program was changed since. The controller holds {held.words}. {tied}\n\n{held.shown}"
    return f"The controller holds {held.words}. {tied}\n\n{held.shown}"


def slow_words(held: Held, percent: int) -> str:
    """What is sent before a slowed run, and what it leaves alone."""
    kept = f"It takes the place of what the controller holds: {held.words}. " if held.lines else ""
    return (
        f"The program is sent with every speed at {percent} %. {kept}"
        "Paths and places stay the same; accelerations and pauses too. It cannot be burned."
    )


def _labels(listing: str) -> Iterator[str]:
    for line in parse(listing).lines:
        for statement in line.statements:
            if isinstance(statement, nodes.Label):
                yield statement.name
