"""Questions of a program: an `IN` takes the next line as its answer, so nothing else may be sent while one waits.

What is sent travels for some milliseconds; a program that is about to reach an `IN` would take a read on its way for
the answer. So reading goes on only where the listing proves that the program, from where it was last seen, cannot
reach an `IN` of our port (or live data on it).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from codegen.twoletter import nodes
from codegen.twoletter.parse import parse
from device.leftover import FAULT

UNAWAITED = re.compile("[:?]*" + FAULT.pattern)  # an error behind nothing but prompts and refusals
MAY_ASK = re.compile(r"(?m)(?:^|;)[ \t]*(?:I[ \t]*N|C[ \t]*I)")  # a text without this asks nothing and needs no parsing
AUTOMATIC = ("LIMSWI", "POSERR", "ININT", "MCTIME", "CMDERR", "COMINT", "AUTO")


@dataclass(frozen=True, slots=True)
class Question:
    """An `IN` of our port: its line and the text it sends."""

    line: int
    prompt: str


class Listing:
    """What a program in the controller may ask, and from which lines."""

    def __init__(self, text: str) -> None:
        self.text = text
        self._lines = parse(text).lines if MAY_ASK.search(text) else ()
        self._labels = dict(self._find_labels())
        self.questions = tuple(self._find_questions())
        self.takes_port = any(_opens_data_mode(s) for line in self._lines for s in line.statements)
        self._next = [self._successors(number) for number in range(len(self._lines))]
        self._always = self._entries()
        self._known: dict[frozenset[int], bool] = {}

    def may_ask(self, start: frozenset[int] | None) -> bool:
        """Whether a question can be reached from these lines (None: from anywhere)."""
        if self.takes_port:
            return True
        if not self.questions:
            return False
        if start is None:
            return True
        if start not in self._known:
            lines = self.reachable(start | self._always)
            self._known[start] = any(question.line in lines for question in self.questions)
        return self._known[start]

    def reachable(self, start: frozenset[int]) -> frozenset[int]:
        seen: set[int] = set()
        todo = [line for line in start if 0 <= line < len(self._lines)]
        while todo:
            line = todo.pop()
            if line not in seen:
                seen.add(line)
                todo += [after for after in self._next[line] if after not in seen]
        return frozenset(seen)

    def waiting(self, rest: str) -> tuple[int, ...]:
        """The lines of the questions whose text this ends with."""
        shown = rest.strip()
        return tuple(q.line for q in self.questions if shown.endswith(q.prompt.strip()))

    def asked(self, line: int) -> str:
        """The text of the question in a line."""
        return next((question.prompt for question in self.questions if question.line == line), "")

    def holds(self, line: int, text: str) -> bool:
        """Whether this text is what stands in that line."""
        lines = self.text.split("\n")
        return line < len(lines) and bool(text) and lines[line].strip() == text.strip()

    def ends_at(self, line: int, text: str) -> bool:
        """Whether an error told with this line and text ends its thread: it is ours, and no #CMDERR takes it."""
        return "CMDERR" not in self._labels and self.holds(line, text)

    def after(self, lines: tuple[int, ...]) -> frozenset[int]:
        """Where thread 0 may be once one of these questions is answered."""
        doubled = {line for line in lines if [q.line for q in self.questions].count(line) > 1}
        return frozenset(doubled | {after for line in lines if line < len(self._lines) for after in self._next[line]})

    def entry(self, target: str) -> frozenset[int]:
        """The line an Execute starts at: a label with `#`, a number, or the first line."""
        if target.startswith("#"):
            return frozenset({self._labels.get(target[1:], 0)})
        return frozenset({int(target)}) if target.isdigit() else frozenset({0})

    def _find_labels(self) -> Iterator[tuple[str, int]]:
        for number, line in enumerate(self._lines):
            for statement in line.statements:
                if isinstance(statement, nodes.Label):
                    yield statement.name, number

    def _find_questions(self) -> Iterator[Question]:
        for number, line in enumerate(self._lines):
            for statement in line.statements:
                if isinstance(statement, nodes.Command) and statement.name == "IN" and not _port_two(statement):
                    texts = [item.text for item in statement.arguments if isinstance(item, nodes.String)]
                    yield Question(number, texts[0] if texts else "")

    def _entries(self) -> frozenset[int]:
        """Lines that thread 0 may come to at any time: automatic routines and what other threads start."""
        found = {self._labels[name] for name in AUTOMATIC if name in self._labels}
        for line in self._lines:
            for statement in line.statements:
                if isinstance(statement, nodes.Command) and statement.name == "XQ":
                    found |= set(self._targets(statement))
        return frozenset(found)

    def _targets(self, statement: nodes.Command) -> Iterator[int]:
        target = statement.arguments[0] if statement.arguments else None
        if not isinstance(target, nodes.Target):
            yield 0
        elif target.label is not None:
            if target.label in self._labels:
                yield self._labels[target.label]
        elif isinstance(target.line, nodes.Number):
            yield target.line.scaled // nodes.ONE
        else:
            yield from range(len(self._lines))

    def _successors(self, number: int) -> tuple[int, ...]:
        found = {number + 1} if number + 1 < len(self._lines) else set()
        for statement in self._lines[number].statements:
            if not isinstance(statement, nodes.Command):
                continue
            if statement.name in ("JP", "JS"):
                found |= set(self._targets(statement))
                if statement.name == "JP" and len(statement.arguments) == 1:
                    found.discard(number + 1)
            elif statement.name in ("EN", "RE", "RI"):
                found.discard(number + 1)
                found |= set(self._returns())
        return tuple(sorted(line for line in found if 0 <= line < len(self._lines)))

    def _returns(self) -> Iterator[int]:
        """Lines after a subroutine call: where an end may go on."""
        for number, line in enumerate(self._lines):
            calls = [isinstance(s, nodes.Command) and s.name == "JS" for s in line.statements]
            if any(calls):
                yield number + 1
                if any(calls[:-1]):
                    yield number


def parted(line: str, listing: Listing | None) -> tuple[str, int, str]:
    """A line as the text before an error, the error's line and its text; -1 without an error.

    The text of a question has no line end, so an error may stand right behind it; it is told apart where the listing
    holds just that text in just that line. Prompts and refusals that nobody waited for, as after a stop, may stand
    before it.
    """
    if listing is not None:
        for found in FAULT.finditer(line):
            number, text = int(found.group(1)), line[found.end() :]
            if listing.holds(number, text):
                before = line[: found.start()].rstrip(":")
                return before if before.strip(":?") else "", number, text
    whole = UNAWAITED.match(line)
    return ("", int(whole.group(1)), line[whole.end() :]) if whole is not None else (line, -1, "")


def _port_two(statement: nodes.Command) -> bool:
    return any(isinstance(item, nodes.Port) and item.number == 2 for item in statement.arguments)


def _opens_data_mode(statement: nodes.Statement) -> bool:
    """`CI m,n,1` turns the main port into a data port: characters are no longer commands."""
    if not isinstance(statement, nodes.Command) or statement.name != "CI":
        return False
    if len(statement.arguments) < 3:
        return False
    third = statement.arguments[2]
    return not isinstance(third, nodes.Empty) and not (isinstance(third, nodes.Number) and third.scaled == 0)


@dataclass(frozen=True, slots=True)
class Prompt:
    """A question that waits: its text and the lines it may come from (none: not known)."""

    text: str
    lines: tuple[int, ...] = ()


class Waiting:
    """Whether something on the controller waits for our next line, or may at any moment."""

    def __init__(self) -> None:
        self.listing: Listing | None = None
        self.position: frozenset[int] | None = None  # lines of running threads; None: not known
        self.prompt: Prompt | None = None
        self.data_mode = False
        self.entry = ""  # DL, QD or ED: the controller takes lines for a program or an array
        self.free = False  # the person said that nothing is waiting
        self.unfinished = False  # a download broke off: the controller may still take lines for a program

    @property
    def question(self) -> str:
        """What waits now, as a sentence; nothing but its answer may be sent."""
        if self.prompt is not None:
            shown = f" “{self.prompt.text.strip()}”" if self.prompt.text.strip() else ""
            return f"The program waits for an answer{shown}."
        if self.entry:
            return f"The controller takes lines after {self.entry}, up to a backslash."
        return "The controller's port is in data mode." if self.data_mode else ""

    @property
    def imminent(self) -> str:
        """Why reading is suspended although no question is shown yet, as a sentence."""
        if self.unfinished:
            return "Live values rest: a download broke off and is being ended."
        if self.free or self.position == frozenset():
            return ""
        if self.listing is None:
            return ""
        if self.listing.may_ask(self.position):
            return "Live values rest: the running program may ask a question at any moment."
        return ""

    def threads(self, lines: frozenset[int]) -> None:
        """The lines of the running threads were read just now: so the port answers, and nothing waits."""
        self.position = lines
        self.free = False

    def started(self, target: str) -> None:
        """A program is about to be started at a label, a line or the beginning."""
        entry = self.listing.entry(target) if self.listing is not None else None
        self.position = None if entry is None or self.position is None else self.position | entry
        self.free = False

    def seen(self, rest: str) -> bool:
        """Text without a line end stands there; says whether it is a new question."""
        if self.prompt is not None or self.position == frozenset() or not rest.strip(" :?\r\n"):
            return False
        if self.listing is None:
            self.prompt = Prompt(rest.lstrip(" :?\r\n"))  # without the controller's own prompts
            return True
        lines = self.listing.waiting(rest)
        if not lines:
            return False
        self.prompt = Prompt(self.listing.asked(lines[0]), lines)
        return True

    def answered(self) -> None:
        """The answer was sent: the program goes on after its question."""
        if self.prompt is not None and self.listing is not None and self.prompt.lines:
            others = self.position or frozenset()
            self.position = self.listing.after(self.prompt.lines) | (others - self._asking(others))
        else:
            self.position = None
        self.prompt = None

    def failed(self, line: int, text: str) -> None:
        """The controller told of an error: the thread that was there has ended; others go on."""
        listing = self.listing
        if listing is None or self.position is None or not listing.ends_at(line, text):
            return
        if self.prompt is not None and line in self.prompt.lines:
            self.prompt = None
        self.position = frozenset(at for at in self.position if line not in listing.reachable(frozenset({at})))

    def _asking(self, lines: frozenset[int]) -> frozenset[int]:
        """Of these lines those from which the answered question was reached."""
        listing, prompt = self.listing, self.prompt
        if listing is None or prompt is None:
            return frozenset()
        asked = set(prompt.lines)
        return frozenset(line for line in lines if asked & listing.reachable(frozenset({line})))

    def restarted(self) -> None:
        """Reset, reconnected or stopped: nothing is known to wait."""
        self.position, self.prompt, self.data_mode, self.entry, self.free = None, None, False, "", False
