"""What is left of the bytes once every answer is taken out: a program's text, in lines and as it stands there.

Prompts and refusals that no exchange takes any more (behind a stop, behind a command that was given up) are no text:
they are owed, a number for each line that was sent, which ends with its last prompt or with its `?`.
"""

from __future__ import annotations

import re
from collections import deque

LATE = re.compile("\x1e([a-z0-9]{2})[ 0-9.-]*\x1f\r\n")
FAULT = re.compile(r"\?\s*([0-9]{3}) ")  # how the controller tells of an error: `?`, the line's number, its text
LONE_RETURN = re.compile("\r(?=[^\n])")  # as some echo it
REPLIES = re.compile("(?:^|(?<=[\r\n]))[:?]+")  # prompts and refusals stand where a line begins


class Leftover:
    """Takes text as it comes; gives lines, and what stands there without a line end."""

    def __init__(self) -> None:
        self._text = ""
        self._owed: deque[int] = deque()
        self._lines: deque[str] = deque()
        self._told: deque[str] = deque(maxlen=8)  # the last lines of text
        self.echoes: deque[str] = deque(maxlen=8)  # lines that were sent
        self.echoed = False  # whether the last line sent came back
        self.seen: deque[str] = deque(maxlen=16)  # marks of frames that came too late
        self.taken: dict[str, str] = {}  # by mark: what was taken for a refusal; text, if the frame comes after all

    def add(self, text: str) -> None:
        self._text = LONE_RETURN.sub("\r\n", LATE.sub(self._late, self._text + text))
        while "\n" in self._text:
            line, self._text = self._text.split("\n", 1)
            raw = line.rstrip("\r")
            line = self.unprompted(raw)
            if raw and not line:
                continue
            told = FAULT.match(line)  # an error tells the line of the program, which we may have sent a moment ago
            echo = "" if told else next((echo for echo in self.echoes if line.endswith(echo)), "")
            self.echoed |= bool(echo)
            if not echo or line != echo:
                self._lines.append(line.removesuffix(echo))
                self._told.append(self._lines[-1])

    def without_end(self, answer: str) -> str:
        """An answer without the end of a text that had begun before it; surely so where that text was told before."""
        end, line_end, rest = answer.partition("\n")
        if not line_end or not self._text or (self._text + end.rstrip("\r")) not in self._told:
            return answer
        self.add(end + line_end)
        return rest

    def lines(self) -> list[str]:
        """Complete lines since the last call."""
        found = list(self._lines)
        self._lines.clear()
        return found

    @property
    def rest(self) -> str:
        """Text without its line end so far: perhaps the question of an IN."""
        text, _ = _stripped(self._text, self._owed)
        return "" if any(echo.startswith(text) for echo in self.echoes) else text

    def take_rest(self) -> str:
        rest = self.rest
        self._text = ""
        return rest

    def forget(self) -> None:
        """The line is gone, and everything with it."""
        self._text = ""
        self._owed.clear()
        self._lines.clear()
        self.echoes.clear()
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
        self._text = self.unprompted(self._text)
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

    def _late(self, match: re.Match[str]) -> str:
        """A frame nobody waits for any more is no text, but its mark is remembered."""
        mark = match.group(1)
        self.seen.append(mark)
        if mark in self.taken:
            self._lines.append(self.taken.pop(mark))
        self.owe(1)
        return ""


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
