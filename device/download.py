"""Programs in and out of a controller: keep the old one, send, read back; a failure is one sentence."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Generic, TypeVar

from codegen.models import Model
from device.asking import Listing, Waiting
from device.door import LEAVE
from device.identify import fence, read_once
from device.tasks import LinkError, LinkLost, Refused, Send, Steps, Stopped, Wait
from device.transport import LineSettings
from device.undecided import Reading
from device.wire import Answer, Frame, Kind, Prompts, Shape, Upload, framed

T = TypeVar("T")
SETTLE_S = 0.05  # a refusal's way here at least: adapters keep bytes up to 16 ms (twice that), the controller needs 10
BEHIND_S = 0.02  # a refusal follows the proof on its line at once: adapters may keep it 16 ms, the controller 0.5
LONGEST_SETTLE_S = 0.5  # over slow networks
TRIES = 3  # to end a download that went wrong
READINGS = 8  # of a program that may print meanwhile
FEW = 3  # of them say what was printed, though not what the program is
UNEVEN_S = 0.007  # between two of them, once, twice, three times
MARGIN_S = 0.02  # beyond the way there and back that a read took just before
FENCE_BYTES = len(framed("xx", [("_TC", Shape(3, 0))])) + 1 + 11  # there and back


class DownloadFailed(LinkError):
    """The program is not, or not surely, in the controller; the text is the sentence to show."""


class Unsteady(LinkError):
    """No two readings of the program in the controller were the same; the shortest of them is the nearest."""

    def __init__(self, nearest: str) -> None:
        super().__init__("Not read: the running program prints in between. Halt it, or try again.")
        self.nearest = nearest


@dataclass(frozen=True, slots=True)
class Downloaded:
    """A verified download; `kept` is the file with the former program."""

    verified: bool
    sentence: str
    kept: Path | None
    seconds: float


class Job(Generic[T]):
    """Something that takes a while: how far it is, its end, and a way to cancel it."""

    def __init__(self, progress: Callable[[Job[T]], None] | None = None) -> None:
        self.future: Future[T] = Future()
        self.phase = "waiting"
        self.done = 0
        self.total = 0
        self.cancelled = False
        self._progress = progress

    @property
    def fraction(self) -> float:
        return self.done / self.total if self.total else 0.0

    def cancel(self) -> None:
        """Ends it at the next line."""
        self.cancelled = True

    def show(self, phase: str, done: int, total: int) -> None:
        self.phase, self.done, self.total = phase, done, total
        if self._progress is not None:
            self._progress(self)


def program_lines(listing: str) -> list[str]:
    """The lines that are sent: without REM lines and without empty lines at the end."""
    lines = [line.rstrip() for line in listing.replace("\r\n", "\n").replace("\r", "\n").split("\n")]
    kept = [line for line in lines if not re.match(r"\s*(REM\b|')", line)]
    while kept and not kept[-1]:
        kept.pop()
    return kept


def objection(lines: Sequence[str], model: Model | None) -> str:
    """Why these lines cannot be a program there, as one sentence, or nothing."""
    for number, line in enumerate(lines):
        if not line.isascii() or any(ord(letter) < 32 for letter in line):
            return f"Line {number} holds a letter the controller does not know: {line.strip()!r}."
        if "\\" in line:
            return f"Line {number} holds a backslash, which would end the download."
        if model is not None and len(line) > model.columns:
            return f"Line {number} has {len(line)} characters; this controller takes {model.columns}."
    if model is not None and len(lines) > model.lines:
        return f"The program has {len(lines)} lines; this controller takes {model.lines}."
    return ""


def difference(sent: Sequence[str], held: Sequence[str]) -> str:
    """The first difference of what was sent and what the controller holds, in words; nothing when they agree."""
    for number, (ours, theirs) in enumerate(zip(sent, held, strict=False)):
        if ours.rstrip() != theirs.rstrip():
            return f"line {number} is “{theirs}” in the controller, but “{ours}” was sent"
    if len(sent) != len(held):
        return f"the controller holds {len(held)} lines, {len(sent)} were sent"
    return ""


class Download:
    """One download as steps for the link."""

    def __init__(
        self,
        listing: str,
        job: Job[Downloaded],
        *,
        model: Model | None,
        line: LineSettings,
        nonces: Iterator[str],
        clock: Callable[[], float],
        folder: Path | None,
        today: Callable[[], datetime] = datetime.now,
        old: str | None = None,
    ) -> None:
        """`old`: the program in the controller, where a back-up has read it just before."""
        self.lines = program_lines(listing)
        self._job, self._model, self._line = job, model, line
        self._nonces, self._clock, self._folder, self._today = nonces, clock, folder, today
        self._old = old
        self._phase = "before anything was sent"
        self._settle_s, self._behind_s = SETTLE_S, BEHIND_S
        self.touched = False
        self.unfinished = False

    @property
    def text(self) -> str:
        """What the controller holds once it is verified."""
        return "\n".join(self.lines)

    def steps(self) -> Steps[Downloaded]:
        start = self._clock()
        problem = objection(self.lines, self._model)
        if problem:
            raise DownloadFailed(f"Not downloaded: {problem}")
        try:
            yield from self._nothing_runs()
            kept = yield from self._keep_old()
            try:
                yield from self._send(paced=False)
                yield from self._verify()
            except _Garbled:
                yield from self._back_to_commands()
                yield from self._send(paced=True)
                yield from self._verify()
        except _Garbled as reason:
            raise DownloadFailed(
                f"Not downloaded, tried twice: {reason}; the controller does not hold the program. {HELP}"
            ) from reason
        except (LinkLost, Stopped) as reason:
            raise DownloadFailed(self._broken(reason)) from reason
        seconds = self._clock() - start
        return Downloaded(True, f"{len(self.lines)} lines downloaded and verified.", kept, seconds)

    def _broken(self, reason: LinkError) -> str:
        cause = "STOP was pressed" if isinstance(reason, Stopped) else "the connection was lost"
        held = (
            "What the controller holds now is unknown; download again."
            if self.touched
            else "The old program is untouched."
        )
        return f"Download ended {self._phase}: {cause}. {held}"

    def _nothing_runs(self) -> Steps[None]:
        threads = self._model.threads if self._model is not None else 1
        reads = [(f"_XQ{n}", Shape(4, 0)) for n in range(threads)]
        answer = yield from read_once(self._nonces, *reads[: 2 if self._model and self._model.columns < 60 else 4])
        if answer.kind is not Kind.VALUES:
            raise LinkLost("no answer")
        if any(value >= 0 for value in answer.values):
            raise DownloadFailed("Not downloaded: a program is running. Halt it first.")
        start = self._clock()
        if (yield from fence(self._nonces)).kind is Kind.VALUES:
            way = self._clock() - start - FENCE_BYTES * self._line.byte_s
            self._settle_s = min(max(way + MARGIN_S, SETTLE_S), LONGEST_SETTLE_S)
            self._behind_s = min(max(way, BEHIND_S), LONGEST_SETTLE_S)

    def _keep_old(self) -> Steps[Path | None]:
        self._phase = "while the old program was read"
        self._job.show("reading the old program", 0, len(self.lines))
        old = self._old if self._old is not None else (yield from upload_steps(self._nonces, None))
        if self._folder is None or not old.strip():
            return None
        return write_dated(self._folder, old, self._today())

    def _send(self, paced: bool) -> Steps[None]:
        self._phase = "before the first line"
        total = len(self.lines)
        self.unfinished = True
        yield from self._begin_waiting() if paced else self._begin_proved()
        self.touched = True
        for number, line in enumerate(self.lines):
            self._phase = f"at line {number} of {total}"
            self._job.show("sending", number, total)
            if self._job.cancelled:
                yield from self._leave()
                raise DownloadFailed(
                    f"Download cancelled at line {number} of {total}: the controller holds only the lines before it."
                )
            answer = yield Send(line.encode("ascii") + b"\r", hold=True, watch_for=b"?:", stored=True)
            self._reply_where_none_belongs(answer, number)
            if paced:
                self._job.show("sending", number + 1, total)
                pause = (len(line) + 2) * self._line.byte_s
                pause += self._settle_s if number == 0 else pause + 0.02
                answer = yield Wait(pause, hold=True, watch_for=b"?:")
                self._reply_where_none_belongs(answer, number)
        self._phase = "after the last line"
        self._job.show("finishing", total, total)
        answer = yield Send(b"\\", Prompts(1), timeout_s=2.0, hold=True)
        if answer.kind is Kind.REFUSED:
            self.unfinished = False
            yield from self._explain()
        if answer.kind is Kind.SILENT:
            raise LinkLost("no answer")
        if answer.kind is not Kind.ACCEPTED or not answer.certain:
            raise _Garbled("the controller's answer was not clear")
        self.unfinished = False

    def _begin_proved(self) -> Steps[None]:
        """`DL` behind an empty frame: the frame proves that the line came in whole.

        In command mode every command is answered, after DL none is. So silence behind the frame proves download mode;
        a lost or refused DL shows itself right there, and no line of the program can become a command.
        """
        nonce = next(self._nonces)
        line = f"{framed(nonce, ())};DL\r".encode()
        answer = yield Send(line, Frame(nonce, ()), self._settle_s + 0.5, hold=True, refusal_s=0.05)
        if answer.kind is not Kind.VALUES or re.search("[?:]", answer.text):
            raise _Garbled("the controller did not go into download mode")
        settled = yield Wait(self._behind_s + 2 * self._line.byte_s, hold=True, watch_for=b"?:")
        self._reply_where_none_belongs(settled, -1)

    def _begin_waiting(self) -> Steps[None]:
        """`DL` alone, for a line that swallows characters; a refusal is waited for here and after the first line."""
        yield Send(b"DL\r", hold=True, watch_for=b"?")
        settled = yield Wait(self._settle_s + 4 * self._line.byte_s, hold=True, watch_for=b"?")
        self._reply_where_none_belongs(settled, -1)

    def _reply_where_none_belongs(self, answer: Answer, number: int) -> None:
        if answer.kind is Kind.REFUSED:
            if number <= 0:
                raise _Garbled("the controller did not go into download mode")
            where = f"the controller left download mode at line {number}"
            raise DownloadFailed(f"Download ended {self._phase}: {where} (was it switched off?). {HELP}")

    def _back_to_commands(self) -> Steps[None]:
        """Out of whatever the first try has left; a line that was held up may open the download only now."""
        for _ in range(TRIES):
            yield Send(LEAVE + b"\r")
            if (yield from fence(self._nonces)).kind is Kind.VALUES:
                return
        raise LinkLost("no answer")

    def _leave(self) -> Steps[None]:
        yield Send(b"\\", Prompts(1), timeout_s=1.0, hold=True)

    def _explain(self) -> Steps[None]:
        """The refusal at the end of DL, with the line it is about."""
        answer = yield from fence(self._nonces)
        code = int(answer.values[0]) if answer.kind is Kind.VALUES else 0
        raise Refused(code, f"The controller refused the program: {refusal(code, self.lines, self._model)}")

    def _verify(self) -> Steps[None]:
        self._phase = "while it was verified"
        self._job.show("verifying", len(self.lines), len(self.lines))
        held = yield from upload_steps(self._nonces, None)
        found = difference(self.lines, program_lines(held))
        if found:
            raise _Garbled(found)


HELP = "Download again; if it happens again, switch the handshake line on or choose a lower speed."


class _Garbled(LinkError):
    """What the controller holds is not what was sent."""


def refusal(code: int, lines: Sequence[str], model: Model | None) -> str:
    """What error 60, 61 or 62 at the end of a download is about."""
    labels = [(n, m.group(1)) for n, line in enumerate(lines) for m in re.finditer(r"(?:^|;)\s*#\s*(\w*)", line)]
    if code == 60:
        columns, most = (model.columns, model.lines) if model else (80, 1000)
        longest = max(range(len(lines)), key=lambda n: len(lines[n]), default=0)
        return (
            "error 60, a line is too long or there are too many "
            f"(at most {most} lines of {columns}; the longest is line {longest})."
        )
    if code == 61:
        seen: set[str] = set()
        for number, name in labels:
            if name in seen or not re.fullmatch("[A-Za-z][A-Za-z0-9]{0,6}", name):
                return f"error 61, the label #{name} in line {number} is double or not a name."
            seen.add(name)
        return "error 61, a label is double or not a name."
    if code == 62:
        return f"error 62, it has {len(labels)} labels; this controller takes {model.labels if model else 254}."
    return f"error {code}." if code else "it gave no reason."


def upload_steps(nonces: Iterator[str], job: Job[str] | None) -> Steps[str]:
    """The program in the controller; raises LinkLost without a clear answer."""
    return program_of((yield from _upload(job)))


def _upload(job: Job[str] | None, known: str | None = None, prints: bool = False) -> Steps[Answer]:
    if job is not None:
        job.show("reading", 0, 0)
    answer = yield Send(b"UL\r", Upload(prints, known), timeout_s=1.0, extends=True)
    if answer.kind is Kind.REFUSED:
        raise Refused(0, "The controller refused to send its program.")
    if answer.kind is not Kind.ACCEPTED:
        raise LinkLost("The controller did not send its program to the end.")
    return answer


def program_of(answer: Answer) -> str:
    """Its lines as they came."""
    return answer.text.replace("\r\n", "\n").replace("\r", "\n")


def held_program(
    waiting: Waiting, nonces: Iterator[str], job: Job[str] | None = None, most: int = READINGS
) -> Steps[str]:
    """The same while a program may run: what it prints can come between two lines.

    Text only ever adds to a reading, so the program is what came twice with no reading shorter than it, unless one of
    its lines is what stood behind a reading: a busy line adds the same again and again. A program that may ask is not
    read again: the second reading would be its answer. What was printed is told as text once the program is known.
    """
    known = waiting.listing.text if waiting.listing is not None else None
    if waiting.position == frozenset():
        return program_of((yield from _upload(job, known)))
    answers: list[Answer] = []
    program: str | None = None
    try:
        while program is None and len(answers) < most:
            if answers:
                yield Wait(UNEVEN_S * len(answers))  # out of step with what the program prints again and again
            answers.append((yield from _upload(job, known, prints=True)))
            first = answers[0].reading
            if first is not None and Listing(first.listing).may_ask(waiting.position):
                return first.decide_alone(known)
            program = _agreed(answers)
    finally:
        readings = [answer.reading for answer in answers if answer.reading is not None]
        for reading in readings:
            reading.decide(program if program is not None else _nearest(readings, known))
    if program is None:
        raise Unsteady(min(map(program_of, answers), key=len))
    return program


def _nearest(readings: Sequence[Reading], known: str | None) -> str | None:
    """What the text of readings that do not agree is told from: a program is not in them for sure, but near enough."""
    if known is not None and all(reading.holds(known) for reading in readings):
        return known
    shortest = min((reading.listing for reading in readings), key=len)
    return shortest if len(readings) >= FEW and all(reading.holds(shortest) for reading in readings) else None


def _agreed(answers: Sequence[Answer]) -> str | None:
    """The program, once two readings agree on it; the first line of one that began within a text may be its end."""
    texts = [program_of(answer) for answer in answers]
    shortest = min(texts, key=len)
    printed = tuple(line for answer in answers for line in answer.behind.splitlines())
    begun = all(answer.reading is not None and answer.reading.behind_text
                for answer, text in zip(answers, texts, strict=True) if text == shortest)  # fmt: skip
    return shortest if texts.count(shortest) > 1 and not begun and not _holds(shortest, printed) else None


def _holds(program: str, printed: Sequence[str]) -> bool:
    """Whether a line of it may be what was printed, the first one also its end, or the end of its line."""
    first, *others = program.split("\n")
    return any(text.endswith(first) for text in printed) or bool(set(others) & set(printed))


def recover(waiting: Waiting, nonces: Iterator[str]) -> Steps[None]:
    """Ends a download that broke off, again and again until the controller answers as in command mode."""
    while True:
        yield Send(LEAVE + b"\r")
        answer = yield from fence(nonces)
        if answer.kind is Kind.VALUES:
            waiting.unfinished = False
            return
        yield Wait(0.3)


def write_dated(folder: Path, text: str, now: datetime) -> Path:
    """Writes a program under a name that tells when; never over another."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{now:%Y-%m-%d %H.%M.%S}.dmc"
    count = 1
    while path.exists():
        count += 1
        path = folder / f"{now:%Y-%m-%d %H.%M.%S} ({count}).dmc"
    path.write_text(text.rstrip("\n") + "\n", encoding="ascii", errors="replace", newline="\n")
    return path
