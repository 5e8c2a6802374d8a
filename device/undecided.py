"""Lines of which it is known only later whether they are a program's text or belong to an answer.

A reading of a program that prints meanwhile is told apart once the program is known. Where an exchange was dropped
(STOP), its answer may still come, whole or in part: it is never the program's text.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

PRINTS = re.compile(r"(?m)MG|IN|BS|L[ALSV]|QU|QZ|T[A-Z]|UL|[?=]\s*(?:;|$)")  # what sends something to the port
ANYTHING, NOTHING = ".*", "(?!)"  # what the lines of a reply look like


class Undecided:
    """A place among the lines of text; what stands behind it waits."""

    def __init__(self, begun: str = "") -> None:
        self.begun = begun  # text before it without its line end, which goes on behind it
        self.text: list[str] | None = None  # a program's lines, once that is known
        self.unclear: list[str] = []  # they may be the answer's or the program's


class Reading(Undecided):
    """One reading of a program that may print meanwhile."""

    def __init__(self, listing: str, begun: str, end_was_told: bool) -> None:
        super().__init__(begun)
        self.listing = listing.replace("\r\n", "\n").replace("\r", "\n")
        self.behind_text = bool(begun)
        self.ends_text = bool(begun) and end_was_told  # its first line is surely the end of a text begun before

    def decide(self, program: str | None) -> None:
        """The program is known now; None: it is not, or does not stand in this reading."""
        if self.text is not None:
            return
        printed = between(_lines(self.listing), _lines(program)) if program is not None else None
        if printed is None:
            self.text, self.unclear = [], doubtful(self.listing)
            return
        texts, ending = printed
        if ending:
            texts[0], self.begun = self.begun.rstrip("\r") + texts[0], ""  # cut within its line end
        self.text = texts

    def holds(self, program: str) -> bool:
        """Whether all of a program stands in it."""
        return between(_lines(self.listing), _lines(program)) is not None

    def decide_alone(self, known: str | None = None) -> str:
        """It is taken for the program as it is, without what surely is none; `known`: the program as it was."""
        first, _, rest = self.listing.partition("\n")
        program = rest if self.ends_text else self.listing
        self.text = [self.begun.rstrip("\r") + first] if self.ends_text else []
        self.begun = "" if self.ends_text else self.begun
        printed = between(_lines(program), _lines(known)) if known is not None else None
        self.unclear = printed[0] if printed is not None else doubtful(program)
        return program


class Dropped(Undecided):
    """An exchange that ended without its answer.

    `reply`: what the answer's lines look like; `count`: how many there are, where that is known; `listing`: they end
    with a control-Z; `known`: the program that is read, as far as it is known.
    """

    def __init__(
        self,
        nonce: str,
        reply: str = ANYTHING,
        count: int | None = None,
        *,
        listing: bool = False,
        known: str | None = None,
    ) -> None:
        super().__init__()
        self.nonce, self.listing = nonce, listing
        self._reply, self._count, self._known = reply, count, known
        self._came: list[tuple[str, bool]] = []

    def add(self, lines: Sequence[str], surely_text: bool = False) -> None:
        self._came += [(line, surely_text) for line in lines]

    def decide(self, whole: bool) -> None:
        """`whole`: the answer has come to its end; else part of it or none."""
        possible = [at for at, (line, sure) in enumerate(self._came) if not sure and re.fullmatch(self._reply, line)]
        if self._known is not None:
            held = _places([self._came[at][0] for at in possible], _lines(self._known))
            possible = [possible[at] for at in held]
        elif self._count is not None and (whole or self._reply != ANYTHING):
            possible = possible[-self._count :] if self._count else []
        elif self._reply == ANYTHING:
            lines = [self._came[at][0] for at in possible]
            self.unclear = doubtful("\n".join(lines)) if self.listing else lines
        self.text = [line for at, (line, _) in enumerate(self._came) if at not in set(possible)]


def doubtful(listing: str) -> list[str]:
    """The lines of a reading that nobody can tell apart: none where the program prints nothing."""
    return _lines(listing) if PRINTS.search(listing) else []


def between(reading: Sequence[str], program: Sequence[str]) -> tuple[list[str], bool] | None:
    """The lines of a reading that are none of the program, and whether the first of them is its first line.

    None where the program does not stand in it. Which of two equal lines is the program's makes no difference.
    """
    held = _places(reading, program)
    if len(held) < len(program):
        return None
    places = set(held)
    return [line for at, line in enumerate(reading) if at not in places], bool(reading) and 0 not in places


def _lines(text: str) -> list[str]:
    return text.removesuffix("\n").split("\n")


def _places(reading: Sequence[str], program: Sequence[str]) -> list[int]:
    """Where the lines of a program stand in a reading, as far as it goes."""
    found: list[int] = []
    wanted = iter(program)
    line = next(wanted, None)
    for at, came in enumerate(reading):
        if line is not None and came.rstrip() == line.rstrip():
            found.append(at)
            line = next(wanted, None)
    return found
