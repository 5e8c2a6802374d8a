"""A recording as a fake controller: its bytes go through link and wire again, and the windows show what they told.

Nothing can be sent to it: its door refuses everything, its line too.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from codegen.models import MODELS
from codegen.twoletter import nodes
from codegen.twoletter.parse import parse_line
from device import live
from device.asking import Prompt
from device.door import REVISION
from device.happenings import Kind, NoticeKind, State
from device.identify import Identity
from device.recorder_format import What, note_of
from device.wire import Expectation, Frame, Manners, Prompts, Proof, Revision, Shape, Upload
from device.wire import Kind as Answered

if TYPE_CHECKING:
    from device.api import Controller
    from device.recorder_read import Placed, Recording

SPEEDS = (0.5, 1.0, 2.0, 5.0, 20.0)
CATCH_UP_S = 3.0  # so much before a place is worked off at once, so that every value is there
FRAMED = re.compile(r"MG\{\^30\},\"([a-z0-9]{2})\"(.*),\{\^31\}$")
ENTERS = re.compile(r"MG\{\^30\},\"([a-z0-9]{2})\",\{\^31\};(DL)$")  # a download proves its DL
ITEM = re.compile(r",([^{}]+)\{F(\d+)\.(\d+)\}")
CONTROLLER, LISTING, NOTICE, DID = "controller", "listing", "notice", "did"  # kinds of notes
CAPTURE, TUNING = "capture", "tuning run"


class Player:
    """Where a recording is by now; can be paused and speeded up from any thread."""

    def __init__(
        self, name: str, length: float, place: float = 0.0, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self.name, self.length, self._clock = name, length, clock
        self._course = (min(max(place, 0.0), length), clock(), 1.0, True)  # place, since when, speed, playing

    @property
    def place(self) -> float:
        """Seconds from the beginning."""
        place, since, speed, playing = self._course
        return min(place + (self._clock() - since) * speed, self.length) if playing else place

    @property
    def playing(self) -> bool:
        return self._course[3] and self.place < self.length

    @property
    def speed(self) -> float:
        return self._course[2]

    def play(self, on: bool) -> None:
        """Goes on, or stands still."""
        self._course = (self.place, self._clock(), self.speed, on)

    def set_speed(self, speed: float) -> None:
        """How much faster than it was."""
        self._course = (self.place, self._clock(), speed, self._course[3])


class Heard:
    """What the bytes and notes of a recording tell its controller (on the link's thread)."""

    def __init__(self, controller: Controller, recording: Recording, place: float) -> None:
        self._c, self._recording, self._begin = controller, recording, place
        self._channel = -1
        self._keys: tuple[str, ...] = ()  # of the frame that is on its way
        self._line = bytearray()
        self._program = False  # lines go into the program memory
        self._entry = ""
        self._at = place  # of the record that was told last
        self._quick, self._last = "", 0.0

    # ----------------------------------------------------- as the link's owner

    def opened(self) -> None:
        """What was the case at the place where it begins."""
        self._c.state, self._c.state_text = State.LOST, "Nothing was connected then."
        for kind in (CONTROLLER, LISTING):
            note = self._recording.before(kind, self._begin)
            if note is not None:
                self._note(kind, note.payload)

    def lost(self, sentence: str, *, refused: bool) -> None:
        """The program failed inside while it played: nothing more comes."""
        self._c.state, self._c.state_text = State.LOST, sentence

    def text(self, line: str) -> None:
        """Told by the notes."""

    def standing(self, rest: str) -> None:
        """Told by the notes."""

    def unclear(self, lines: list[str]) -> None:
        """Told by the notes."""

    def sent(self, data: bytes, source: str) -> None:
        """Nothing is ever sent."""

    # ------------------------------------------------------------ the recording

    def tell(self, placed: Placed) -> bool:
        """The next record; whether its bytes are of the controller that is shown."""
        record, self._at = placed.record, placed.place
        if record.what is What.NOTE:
            kind, payload = note_of(record.data)
            self._note(kind, payload, told=placed.place >= self._begin)
            return False
        if record.channel != self._channel:
            return False
        if record.what is What.SENT:
            self._left(record.data)
        return True

    def settle(self) -> None:
        """The answer to what was sent last, once it is there."""
        answer = self._c.link.wire.answer()
        if answer is None:
            return
        if answer.kind is Answered.VALUES and self._keys:
            self._values(dict(zip(self._keys, answer.values, strict=True)))
        elif answer.kind in (Answered.ACCEPTED, Answered.REFUSED) and self._entry:
            text = f"{answer.text}\n:".lstrip("\n") if answer.kind is Answered.ACCEPTED else "?"
            self._c.link.note("<", text, "user")
        self._keys, self._entry = (), ""

    def _values(self, values: Mapping[str, float]) -> None:
        poller, now = self._c.poller, self._at
        poller.ring.write({**live.beside(values), **values}, now)
        first = next(iter(values))
        if first == self._quick and now > self._last:
            period = now - self._last
            poller.ring.period_s += (period - poller.ring.period_s) / (8 if poller.ring.period_s else 1)
            poller.ring.turn_s = 10 * poller.ring.period_s
            poller.rate_hz = 1 / max(poller.ring.period_s, 1e-3)
        if live.split(first)[0].quick:
            self._quick, self._last = first, now

    def _left(self, data: bytes) -> None:
        """Bytes that left then; a whole line tells what is to be expected."""
        self._line += data
        while self._line:
            ends = [place + len(mark) for mark in (b"\r", REVISION, b"\\") if (place := self._line.find(mark)) >= 0]
            if not ends:
                return
            line = bytes(self._line[: min(ends)])
            del self._line[: min(ends)]
            self._sent(line)

    def _sent(self, line: bytes) -> None:
        text = line.decode("ascii", "replace").rstrip("\r")
        if self._program:
            self._program = not line.endswith(b"\\")
            self._c.link.note(">", text, "download")
            return
        expected, keys = expected_of(line)
        shown = ENTERS.sub(r"\2", FRAMED.sub("", text).rstrip(";"))
        self._program = shown == "DL"
        self._entry = "" if not shown else text
        self._keys = keys
        self._c.link.wire.expect(expected, text)
        self._c.link.note(">", shown or text, "user" if shown else "poll")

    def _note(self, kind: str, payload: Any, told: bool = False) -> None:
        if kind == LISTING and isinstance(payload, str):
            self._c.set_listing(payload or None)
        elif kind == CONTROLLER and isinstance(payload, dict):
            self._standing(payload)
        elif kind == NOTICE and isinstance(payload, dict) and told:
            known = [each for each in NoticeKind if each == payload.get("kind")]
            if known:
                self._c.notify(known[0], str(payload.get("text", "")))

    def _standing(self, facts: Mapping[str, Any]) -> None:
        """What was connected, and how."""
        c = self._c
        channel = facts.get("channel")
        if channel != self._channel:
            self._channel = channel if isinstance(channel, int) else 0
            self._line.clear()
            c.link.wire.forget()
        model, identity = MODELS.get(str(facts.get("model"))), facts.get("identity")
        if isinstance(identity, dict):
            axes, serial = str(identity.get("axes", "")), identity.get("serial")
            c.identity = Identity(str(identity.get("text", "")), model, axes, serial if serial else None)
        c.take_model(model)
        known = [each for each in State if each == facts.get("state")]
        c.state = known[0] if known else State.LOST
        c.state_text = str(facts.get("words", ""))
        question = facts.get("question")
        c.waiting.prompt = Prompt(question) if isinstance(question, str) else None


def facts_of(controller: Controller, channel: int, address: str) -> dict[str, Any]:
    """What a recording has to know of a controller, to be noted whenever it has changed."""
    identity, prompt = controller.identity, controller.pending_prompt
    return {
        "kind": str(controller.kind),
        "address": address,
        "channel": channel,
        "baud": controller.line.baud,
        "state": str(controller.state),
        "words": controller.state_text,
        "control": controller.control,
        "model": controller.model.name if controller.model is not None else "",
        "identity": None if identity is None else {
            "text": identity.text, "axes": identity.axes, "serial": identity.serial,
        },
        "question": prompt.text if prompt is not None else None,
    }  # fmt: skip


def expected_of(line: bytes) -> tuple[Expectation | None, tuple[str, ...]]:
    """What the answer to a line that was sent looks like; of a framed read also the keys of its values."""
    if line == REVISION:
        return Revision(), ()
    text = line.decode("ascii", "replace").rstrip("\r")
    if line.startswith((b"\x11", b"!")):  # a stop from any state: nobody waited for its prompts
        return None, ()
    found = ENTERS.match(text)
    if found is not None:
        return Frame(found[1], ()), ()
    found = FRAMED.search(text)
    if found is None:
        statements = parse_line(text).statements
        names = [each.name for each in statements if isinstance(each, nodes.Command)]
        return (Upload() if "UL" in names or "QU" in names else Prompts(max(len(statements), 1))), ()
    items = ITEM.findall(found[2])
    before = [each for each in parse_line(text[: found.start()]).statements if not isinstance(each, nodes.Nothing)]
    if items or not before:
        shapes = tuple(Shape(int(digits), int(decimals)) for _, digits, decimals in items)
        keys = tuple(KEYS.get(expression, "") for expression, _, _ in items)
        return Frame(found[1], shapes, len(before)), keys if all(keys) else ()
    return Proof(found[1], len(before)), ()


def _keys() -> dict[str, str]:
    """The key of each expression that live values are read with."""
    rows = [row for row in live.ROWS if row.name != live.AT]
    axes = {row.expression.format(axis=axis): live.key(row.name, axis) for row in rows for axis in "XYZW"}
    return {**axes, **{row.expression: row.name for row in rows if not row.per_axis}}


KEYS = _keys()


def replayed(
    recording: Recording,
    place: float = 0.0,
    *,
    clock: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], None] = time.sleep,
    threaded: bool = True,
) -> tuple[Controller, Player]:
    """A controller that only repeats what was recorded, from a place on, and the hand on it."""
    from device.api import Controller
    from device.transport import LineSettings
    from device.transport.replay import Replay

    player = Player(recording.name, recording.length, place, clock)
    note = recording.before(CONTROLLER, place)
    facts = note.payload if note is not None and isinstance(note.payload, dict) else {}
    baud = facts.get("baud")
    line = LineSettings(baud=baud if isinstance(baud, int) else None)
    made: list[Heard] = []

    def hears(controller: Controller) -> Heard:
        made.append(Heard(controller, recording, player.place))
        return made[0]

    def opener() -> Replay:
        records = recording.records(max(place - CATCH_UP_S, 0.0))
        return Replay(records, player, made[0].tell, made[0].settle, sleep)

    return (
        Controller(
            opener, kind=Kind.REPLAY, line=line, clock=lambda: player.place, hears=hears, manners=Manners(),
            threaded=threaded,
        ),
        player,
    )  # fmt: skip
