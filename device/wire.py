"""Bytes ↔ replies: pairs what the controller sends with what was asked; no input or output here.

Live reads are framed: `MG{^30},"k7",_TPX{F10.0},{^31}` answers `<30>k7 0000000021<31>` CR LF and a prompt. The two
letters change with every request, every number has a fixed width, and both ends are marked, so text that a program
sends in between can delay or spoil a read (it is then discarded as uncertain) but never be taken for one. Typed
commands are followed by an empty frame on the same line: the controller drops the rest of a refused line, so the
frame proves that the command was accepted. Unsolicited text is what is left. Bit 7, which some controllers set on
unsolicited text, is masked.
"""

from __future__ import annotations

import re
import string
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from itertools import groupby
from operator import itemgetter

from device.leftover import Leftover, refusal
from device.undecided import ANYTHING, NOTHING, Dropped, Reading

OPEN, CLOSE = 30, 31  # the characters that frame a read
IGNORED = b"\x00\x11\x13"  # fill and flow-control characters
MARKED_END = "\x1a(?:\r\n)?(?P<text>(?:[^:\r\n][^\r\n]*\r\n)*):"  # its prompt may follow a program's text
ANY_END = "\x1a(?P<text>[^:]*):?"  # its prompt stands within a line of that text, or was lost
LONG_BEHIND = 256  # characters behind the control-Z: more than a full output buffer of text


@dataclass(frozen=True, slots=True)
class Shape:
    """How a number comes: a sign column, digits, and decimals after a point."""

    digits: int = 10
    decimals: int = 4

    @property
    def format(self) -> str:
        return f"{{F{self.digits}.{self.decimals}}}"

    @property
    def width(self) -> int:
        return 1 + self.digits + (self.decimals + 1 if self.decimals else 0)

    @property
    def pattern(self) -> str:
        return f"([ -][0-9]{{{self.digits}}}" + (f"\\.[0-9]{{{self.decimals}}})" if self.decimals else ")")


@dataclass(frozen=True, slots=True)
class Frame:
    """Expects the framed values of one read, behind the prompts of commands that travel before it in its line."""

    nonce: str
    shapes: tuple[Shape, ...]
    before: int = 0


@dataclass(frozen=True, slots=True)
class Proof:
    """Expects the answer of a line of `prompts` statements, then the empty frame that proves it was accepted.

    Lines that look like its `reply` are the answer's; what else came in between is a program's text. `count`: how
    many lines it has, where that is known.
    """

    nonce: str
    prompts: int = 1
    reply: str = ANYTHING
    count: int | None = None


@dataclass(frozen=True, slots=True)
class Prompts:
    """Expects this many prompts, or one `?`."""

    count: int = 1


@dataclass(frozen=True, slots=True)
class Upload:
    """Expects program lines up to control-Z and a prompt.

    `prints`: a program that runs may print in between; whoever asks tells the `Answer.reading` apart. `known`: the
    program, as far as it is known; `reply`: what its lines look like.
    """

    prints: bool = False
    known: str | None = None
    reply: str = ANYTHING


@dataclass(frozen=True, slots=True)
class Revision:
    """Expects one line of text and a prompt, as after control-R control-V."""


Expectation = Frame | Proof | Prompts | Upload | Revision


class Kind(Enum):
    VALUES = "values"
    ACCEPTED = "accepted"
    REFUSED = "refused"
    UNCERTAIN = "uncertain"  # something came, but it cannot be told apart from a program's text
    SILENT = "silent"  # nothing came


@dataclass(frozen=True, slots=True)
class Answer:
    """What came back for one expectation."""

    kind: Kind
    values: tuple[float, ...] = ()
    text: str = ""  # of values: what came behind their prompt
    behind: str = ""  # of an upload: a program's text that came right behind it
    certain: bool = True
    refused: bool = False  # of uncertain: something stood there like a refusal, and was taken out of the text
    reading: Reading | None = None  # of an upload beside a program that prints: to be decided


@dataclass(frozen=True, slots=True)
class Manners:
    """How a controller answers where the manuals leave it open; the simulator's profile has the same settings."""

    prompt_per_command: bool = True
    error_ends_line: bool = True
    upload_marked: bool = True  # UL ends with control-Z
    answers_marked: bool = False  # CW1 sets bit 7 also of answers to MG


def nonces() -> Iterator[str]:
    """Two-letter marks that come again only after 1296 others."""
    letters = string.ascii_lowercase + string.digits
    while True:
        for first in letters:
            for second in letters:
                yield second + first


def framed(nonce: str, reads: Sequence[tuple[str, Shape]]) -> str:
    """The command that sends expressions in a frame."""
    items = "".join(f",{expression}{shape.format}" for expression, shape in reads)
    return f'MG{{^{OPEN}}},"{nonce}"{items},{{^{CLOSE}}}'


FRAME_COLUMNS = len(framed("xx", ()))


def fitting(reads: Sequence[tuple[str, Shape]], columns: int) -> Iterator[list[tuple[str, Shape]]]:
    """The reads in as few lines as fit into so many columns."""
    line: list[tuple[str, Shape]] = []
    for read in reads:
        if line and len(framed("xx", [*line, read])) > columns:
            yield line
            line = []
        line.append(read)
    if line:
        yield line


class Wire:
    """Takes bytes as they come and gives answers and texts."""

    def __init__(self, manners: Manners | None = None) -> None:
        self.manners = manners or Manners()
        self._buffer = bytearray()
        self._marked = bytearray()
        self._expected: Expectation | None = None
        self._question = False
        self.left = Leftover()

    # ------------------------------------------------------------- expecting

    def expect(self, expectation: Expectation | None, sent: str = "") -> None:
        """What the next answer is for, and the line that was sent (to know its echo)."""
        self._release(len(self._buffer))
        self._expected = expectation
        self._question = False
        if isinstance(expectation, Frame) and self.manners.prompt_per_command:
            self.left.owe(expectation.before)
        if sent:
            self.left.echoes.append(sent)
            self.left.echoed = False

    @property
    def question(self) -> bool:
        """Whether a `?` came since the last expectation: perhaps a refusal."""
        return self._question

    def feed(self, data: bytes) -> None:
        for byte in data:
            code = byte & 0x7F
            if code not in IGNORED:
                self._buffer.append(code)
                self._marked.append(byte >> 7)
                self._question |= code == 0x3F
        if self._expected is None:
            self._release(len(self._buffer))
        elif isinstance(self._expected, Frame):
            places = [place for place in (self._buffer.find(OPEN), self._buffer.find(b"?")) if place >= 0]
            self._release(min(places, default=len(self._buffer)))  # a `?` may be the refusal

    def answer(self) -> Answer | None:
        """The answer to the present expectation, once it is complete."""
        expected = self._expected
        if isinstance(expected, Frame):
            found = self._frame(expected)
        elif isinstance(expected, Proof):
            found = self._proof(expected)
        elif isinstance(expected, Prompts):
            found = self._prompts(expected.count if self.manners.prompt_per_command else 1)
        elif isinstance(expected, Upload):
            found = self._upload()
        elif isinstance(expected, Revision):
            found = self._revision()
        else:
            return None
        if found is not None:
            self._expected = None
            self._release(len(self._buffer))
        return found

    def drop(self) -> None:
        """Ends the expectation at once: its answer may still come, and is no text."""
        expected, self._expected = self._expected, None
        if expected is not None:
            self.left.dropped(_dropped(expected))
        if isinstance(expected, Proof | Prompts):
            self.left.owe(self._prompts_of(expected))
        self._release(len(self._buffer))

    def give_up(self) -> Answer:
        """Ends the expectation without its answer: what came is text, and the answer says uncertain or silent."""
        came = bytes(self._buffer).decode("ascii")
        something = bool(came) or self._question
        came += "?" if self._question and "?" not in came else ""
        expected, self._expected = self._expected, None
        refused = isinstance(expected, Frame | Proof) and self._take_refusal(expected)
        if not refused and isinstance(expected, Proof | Prompts):
            self.left.owe(self._prompts_of(expected))
        elif isinstance(expected, Upload):
            self.left.dropped(_dropped(expected))
        self._release(len(self._buffer))
        kind = Kind.UNCERTAIN if something else Kind.SILENT
        return Answer(kind, text=came, certain=False, refused=refused)

    def forget(self) -> None:
        """Throws away everything, as after a lost link."""
        self._drop(len(self._buffer))
        self._expected, self._question = None, False
        self.left.forget()

    # --------------------------------------------------------------- parsing

    def _frame(self, expected: Frame) -> Answer | None:
        head = bytes([OPEN]) + expected.nonce.encode()
        start = self._buffer.find(head)
        if start < 0:
            return None
        body = start + len(head)
        length = sum(shape.width for shape in expected.shapes) + 3
        if len(self._buffer) - body < length + 1:
            return None  # the prompt belongs to it
        pattern = "".join(shape.pattern for shape in expected.shapes) + f"{chr(CLOSE)}\r\n"
        match = re.fullmatch(pattern, bytes(self._buffer[body : body + length]).decode("ascii"))
        if match is None:
            self._release(start)
            self._drop(len(head))
            return Answer(Kind.UNCERTAIN, certain=False)
        self._release(start)
        self._drop(len(head) + length)
        self._take_prompt()
        values = tuple(float(group.replace(" ", "")) for group in match.groups())
        return Answer(Kind.VALUES, values, text=self._buffer.decode("ascii"))

    def _proof(self, expected: Proof) -> Answer | None:
        mark = bytes([OPEN]) + expected.nonce.encode() + bytes([CLOSE]) + b"\r\n"
        start = self._buffer.find(mark)
        if start < 0 or len(self._buffer) == start + len(mark):
            return None
        window = self._window(start)
        self._take(start)
        self._drop(len(mark))
        if self.left.waits and expected.reply == NOTHING:  # prompts of what was dropped, then ours
            self.left.owe(self._prompts_of(expected))
            self.left.add(window)
            self._take_prompt()
            return Answer(Kind.ACCEPTED)
        window = self.left.unprompted(window)  # prompts of a stop, which nobody waited for
        self._take_prompt()
        if not self.manners.error_ends_line and (place := window.find("?")) >= 0:
            self.left.add(window[:place] + window[place + 1 :].replace(":", ""))
            return Answer(Kind.REFUSED)  # what stands behind it was carried out, so the frame proves nothing
        text, exact = _without_prompts(window, expected.prompts if self.manners.prompt_per_command else 0)
        whole = expected.reply == ANYTHING
        if whole and expected.count is not None and text.count("\r\n") > expected.count:
            reply, other, exact = *_last_lines(text, expected.count), False
        else:
            reply, other = (text, "" if exact else text) if whole else _parted(text, expected.reply)
        self.left.add(other)
        shown = reply.replace("\r\n", "\n").rstrip("\n")
        return Answer(Kind.ACCEPTED, text=shown, certain=exact or not whole)

    def _prompts(self, count: int) -> Answer | None:
        window = self._window(len(self._buffer))
        place, seen = 0, 0
        data: list[str] = []
        while place < len(window):
            if window[place] in ":?":
                refused = window[place] == "?"
                seen, place = seen + 1, place + 1
                if refused or seen == count:
                    rest = window[place:]
                    self._take(len(self._buffer))
                    self.left.add(rest)
                    kind = Kind.REFUSED if refused else Kind.ACCEPTED
                    return Answer(kind, text="\n".join(data), certain=not data and not rest)
                continue
            end = window.find("\r\n", place)
            if end < 0:
                return None
            data.append(window[place:end])
            place = end + 2
        return None

    def _upload(self) -> Answer | None:
        marked = self.manners.upload_marked
        if len(self._buffer) > 1 and (0x1A not in self._buffer if marked else self._buffer[-1:] not in b":?"):
            return None  # a long listing is looked at once, at its end
        window = self._window(len(self._buffer))
        match = re.search(MARKED_END if marked else "(?:^|(?<=\r\n)(?:\r\n)?):$", window)
        if match is None and marked and len(window) - window.find("\x1a") > LONG_BEHIND:
            match = re.search(ANY_END, window)
        if match is None:
            if window == "?":
                self._drop(len(self._buffer))
                return Answer(Kind.REFUSED)
            return None
        self._take(len(self._buffer))
        program, reading = window[: match.start()], None
        if isinstance(self._expected, Upload) and self._expected.prints:
            reading = self.left.reading(program)
        else:
            program = self.left.without_end(program)
        self.left.add(text := (match["text"] if marked else "") + window[match.end() :])
        return Answer(Kind.ACCEPTED, text=program, behind=text, reading=reading)

    def _revision(self) -> Answer | None:
        window = self._window(len(self._buffer))
        match = re.search(r"([^\r\n:?][^\r\n]*)\r\n:", window)
        if match is None:
            return None
        self._take(len(self._buffer))
        self.left.add(window[: match.start()])
        self.left.add(window[match.end() :])
        return Answer(Kind.ACCEPTED, text=match.group(1).strip())

    # ---------------------------------------------------------------- pieces

    def _take_prompt(self) -> None:
        """The prompt of a frame follows it; where other text came in between, it is owed."""
        self.left.settled()
        if self._buffer[:1] == b":":
            self._drop(1)
        else:
            self.left.owe(1)

    def _prompts_of(self, expected: Proof | Prompts) -> int:
        count = expected.prompts if isinstance(expected, Proof) else expected.count
        return count if self.manners.prompt_per_command else 1

    def _take_refusal(self, expected: Frame | Proof) -> bool:
        """The refusal of what is given up is no text; a frame that comes all the same gives it back."""
        ours = zip(self._buffer, self._marked, strict=True)
        came = "".join("\0" if marked and byte in b":?" else chr(byte) for byte, marked in ours)
        prompts = expected.before + 1 if isinstance(expected, Frame) else self._prompts_of(expected)
        place = refusal(came, prompts)
        if place is None:
            return False
        start, end = place
        if isinstance(expected, Proof):
            self.left.owe(prompts - (end - start))  # what was accepted before text came in between
        self._release(start)
        self._drop(end - start)
        self.left.settled()
        self.left.taken[expected.nonce] = came[start:end]
        return True

    def _window(self, end: int) -> str:
        """What came before `end`, without marked characters and without the echo of the line sent."""
        mine = self.manners.answers_marked
        plain = bytes(b for b, marked in zip(self._buffer[:end], self._marked[:end], strict=True) if not marked or mine)
        text = plain.decode("ascii")
        echoes = self.left.echoes
        if echoes and text.startswith(echoes[-1]):
            text = re.sub("^\r\n?", "", text[len(echoes[-1]) :])
            self.left.echoed = True
        return text

    def _take(self, count: int) -> None:
        """Drops what an answer was made of; what is marked in it is a program's text."""
        if not self.manners.answers_marked:
            marked = zip(self._buffer[:count], self._marked[:count], strict=True)
            self.left.add("".join(chr(byte) for byte, mark in marked if mark), marked=True)
        self._drop(count)

    def _drop(self, count: int) -> None:
        del self._buffer[:count]
        del self._marked[:count]

    def _release(self, count: int) -> None:
        """The first bytes of the buffer are unsolicited text."""
        if count and self.left.waits and not self.manners.answers_marked:
            for marked, run in groupby(zip(self._buffer[:count], self._marked[:count], strict=True), itemgetter(1)):
                self.left.add("".join(chr(byte) for byte, _ in run), marked=bool(marked))
            self._drop(count)
        elif count:
            text = bytes(self._buffer[:count]).decode("ascii")
            self._drop(count)
            self.left.add(text)


def _dropped(expected: Expectation) -> Dropped:
    """What may still come of an exchange that ends without its answer."""
    if isinstance(expected, Frame):
        return Dropped(expected.nonce, NOTHING)  # a frame shows itself
    if isinstance(expected, Proof):
        return Dropped(expected.nonce, expected.reply, expected.count)
    if isinstance(expected, Upload):
        return Dropped("", expected.reply, listing=True, known=expected.known)
    return Dropped("")


def _last_lines(text: str, count: int) -> tuple[str, str]:
    """So many lines, which stand right before the prompt, and the text before them."""
    lines = text.split("\r\n")
    rest = lines.pop()
    at = len(lines) - count
    return "".join(f"{line}\r\n" for line in lines[at:]), "".join(f"{line}\r\n" for line in lines[:at]) + rest


def _parted(text: str, reply: str) -> tuple[str, str]:
    """The lines that look like the reply, and the rest."""
    *lines, last = text.split("\r\n")
    ours = [line for line in lines if re.fullmatch(reply, line)]
    others = [line for line in lines if not re.fullmatch(reply, line)]
    return "".join(f"{line}\r\n" for line in ours), "".join(f"{line}\r\n" for line in others) + last


def _without_prompts(window: str, prompts: int) -> tuple[str, bool]:
    """The data lines of an accepted line's answer, and whether nothing else was in it."""
    exact = re.fullmatch("((?:[^\r\n:?]*\r\n)*):" * prompts, window) if prompts < 40 else None
    if exact is not None:
        data = "".join(group for group in exact.groups() if group)
        return data, True
    for _ in range(prompts):
        if window.endswith(":"):
            window = window[:-1]
        elif (place := window.rfind("\n:")) >= 0:
            window = window[: place + 1] + window[place + 2 :]
        else:
            window = window.replace(":", "", 1)
    return window, False
