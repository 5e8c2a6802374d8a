"""What is left of the bytes once every answer is taken out: a program's text, in lines and as it stands there.

Prompts and refusals that no exchange takes any more (behind a stop, behind a command that was given up) are no text:
they are owed, a number for each line that was sent, which ends with its last prompt or with its `?`.
"""

from __future__ import annotations

import re
from collections import deque

from device.undecided import Dropped, Reading, Undecided

LATE = re.compile("\x1e([a-z0-9]{2})[ 0-9.-]*\x1f\r\n")
FAULT = re.compile(r"\?\s*([0-9]{3}) ")  # how the controller tells of an error: `?`, the line's number, its text
FRAMED = "{^30},"  # stands in every line that we frame, and in no other
LONE_RETURN = re.compile("\r(?=[^\n])")  # as some echo it
LISTED = re.compile("\x1a(?:\r\n|(?=[^\r])|(?=\r[^\n]))")  # the end of a listing
REPLIES = re.compile("(?:^|(?<=[\r\n]))[:?]+")  # prompts and refusals stand where a line begins


class Leftover:
    """Takes text as it comes; gives lines, and what stands there without a line end."""

    def __init__(self) -> None:
        self._text = ""
        self._owed: deque[int] = deque()
        self._lines: deque[str | Undecided] = deque()
        self._dropped: deque[Dropped] = deque()  # exchanges that ended without their answer, which may still come
        self._marked = ""  # beside them: text whose mark says that it is a program's, without its line end so far
        self._unclear: list[str] = []
        self._told: deque[str] = deque(maxlen=8)  # the last lines of text
        self.echoes: deque[str] = deque(maxlen=8)  # lines that were sent
        self.echoed = False  # whether the last line sent came back
        self._echoing = True  # whether lines come back, as the last answer has shown
        self.seen: deque[str] = deque(maxlen=16)  # marks of frames that came too late
        self.taken: dict[str, str] = {}  # by mark: what was taken for a refusal; text, if the frame comes after all

    def add(self, text: str, marked: bool = False) -> None:
        """`marked`: bit 7 says that nobody asked for it (CW 1)."""
        if marked and self._dropped:
            *lines, self._marked = (self._marked + text).split("\n")
            self._dropped[0].add([line.rstrip("\r") for line in lines], surely_text=True)
            return
        self._text += text
        while (late := LATE.search(self._text)) is not None:
            after, self._text = self._text[late.end() :], self._text[: late.start()]
            self._split()
            self._late(late.group(1))
            self._text += after
        while self._dropped and self._dropped[0].listing and (end := LISTED.search(self._text)) is not None:
            after, self._text = self._text[end.end() :], self._text[: end.start()]
            self._split()
            self._decide(self._dropped[0], whole=True)
            self.owe(1)
            self._text += after
        self._split()

    def _split(self) -> None:
        """Complete lines leave the text."""
        self._text = LONE_RETURN.sub("\r\n", self._text)
        while "\n" in self._text:
            line, self._text = self._text.split("\n", 1)
            raw = line.rstrip("\r")
            line = self.unprompted(raw)
            if raw and not line:
                continue
            told = FAULT.match(line)  # an error tells the line of the program, which we may have sent a moment ago
            echo = "" if told else next((echo for echo in self._echoes() if line.endswith(echo)), "")
            self.echoed |= bool(echo)
            if not echo or line != echo:
                self._tell(line.removesuffix(echo))

    def _echoes(self) -> list[str]:
        """Lines that may come back; where they do not, a program may print what was sent: all but our frames."""
        return [echo for echo in self.echoes if self._echoing or FRAMED in echo]

    def _tell(self, line: str) -> None:
        if self._dropped:
            self._dropped[0].add([line])
        else:
            self._lines.append(line)
            self._told.append(line)

    def without_end(self, answer: str) -> str:
        """An answer without the end of a text that had begun before it; surely so where that text was told before."""
        end, line_end, rest = answer.partition("\n")
        if not line_end or not self._text or (self._text + end.rstrip("\r")) not in self._told:
            return answer
        self.add(end + line_end)
        return rest

    def lines(self) -> list[str]:
        """Complete lines since the last call, up to the first of which it is not known yet whether they are text."""
        found: list[str] = []
        carried = ""
        while self._lines:
            first = self._lines[0]
            if isinstance(first, str):
                found.append(carried + first)
                carried = ""
            elif first.text is None:
                first.begun = carried + first.begun
                return found
            else:
                found += first.text
                carried = first.begun
                self._unclear += first.unclear
            self._lines.popleft()
        self._text = carried + self._text
        return found

    def unclear(self) -> list[str]:
        """Lines since the last call that may be a program's text or part of an answer: nobody can tell."""
        found, self._unclear = self._unclear, []
        return found

    # ------------------------------------------- what is told apart later on

    def reading(self, listing: str) -> Reading:
        """A program was read while it may print: what comes behind it waits until both are told apart."""
        begun, self._text = self.unprompted(self._text), ""
        reading = Reading(listing, begun, begun + listing.split("\n", 1)[0].rstrip("\r") in self._told)
        self._lines.append(reading)
        return reading

    def dropped(self, exchange: Dropped) -> None:
        """From here on lines may be the answer of an exchange that was dropped."""
        self._dropped.append(exchange)
        self._lines.append(exchange)

    @property
    def waits(self) -> bool:
        """Whether answers that nobody expects any more may still come."""
        return bool(self._dropped or self._owed)

    def _decide(self, last: Dropped | None, whole: bool = False) -> None:
        """Exchanges were answered up to this one, or all of them; `whole`: its end came, nothing of it is missing."""
        while self._dropped:
            exchange = self._dropped.popleft()
            exchange.decide(whole and exchange is last)
            if exchange is last:
                break
        if not self._dropped:
            self._text, self._marked = self._marked + self._text, ""

    @property
    def rest(self) -> str:
        """Text without its line end so far: perhaps the question of an IN."""
        if self._dropped or any(isinstance(each, Undecided) for each in self._lines):
            return ""
        text, _ = _stripped(self._text, self._owed)
        return "" if any(echo.startswith(text) for echo in self._echoes()) else text

    def take_rest(self) -> str:
        rest = self.rest
        self._text = ""
        return rest

    def forget(self) -> None:
        """The line is gone, and everything with it."""
        self._text = ""
        self._marked = ""
        self._owed.clear()
        self._dropped.clear()
        self._lines.clear()
        self.echoes.clear()
        self._echoing = True
        self.taken.clear()

    # ---------------------------------------------------------------- replies

    def owe(self, prompts: int) -> None:
        """A line of so many commands may still be answered, and nothing expects that."""
        if prompts:
            self._owed.append(prompts)

    def settled(self) -> None:
        """Something was answered, so everything sent before it has been: what has not come will not."""
        if self._text.endswith("\r"):
            self.add("\n")
        self._echoing = self.echoed
        self._text = self.unprompted(self._text)
        self._decide(None)
        self._owed.clear()
        self.taken.clear()

    def unprompted(self, line: str) -> str:
        """A line without owed replies at its beginning."""
        line, self._owed = _stripped(line, self._owed)
        return line

    def strip_question(self) -> None:
        """A refusal that is proved but did not stand like one: its `?` is taken out of the text."""
        place = self._text.rfind("?")
        if place >= 0:
            self._text = self._text[:place] + self._text[place + 1 :]

    def _late(self, mark: str) -> None:
        """A frame nobody waits for any more is no text, but its mark is remembered."""
        self.seen.append(mark)
        if mark in self.taken:
            self._lines.append(self.taken.pop(mark))
        answered = next((exchange for exchange in self._dropped if exchange.nonce == mark), None)
        if answered is not None:
            self._decide(answered, whole=True)
        self.owe(1)


def _stripped(line: str, owed: deque[int]) -> tuple[str, deque[int]]:
    """A line without the replies at its beginning that are owed, and what is owed then."""
    left = owed.copy()
    while left and line[:1] in (":", "?") and not FAULT.match(line):
        left[0] = 0 if line[0] == "?" else left[0] - 1
        if not left[0]:
            left.popleft()
        line = line[1:]
    return line, left


def refusal(text: str, prompts: int) -> tuple[int, int] | None:
    """Where in what came a line of so many commands stands refused: prompts and a `?` where a line begins.

    It stands more likely alone than before other text, and more likely late than early.
    """
    found = [
        (place + 1 == len(text), place, run.start())
        for run in REPLIES.finditer(text)
        for place in range(run.start(), run.end())
        if text[place] == "?" and not FAULT.match(text, place)
    ]
    if not found:
        return None
    _, place, start = max(found)
    before = place - len(text[start:place].rstrip(":")) - start
    return place - min(before, prompts - 1), place + 1
