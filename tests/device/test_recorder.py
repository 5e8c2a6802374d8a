"""The recorder: what went over the line comes back byte for byte, survives kills and damage, and is never sent."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from device.api import Kind, State, StopState
from device.recorder import Recorder
from device.recorder_format import What
from device.recorder_play import CONTROLLER, LISTING, NOTICE, expected_of, facts_of, replayed
from device.recorder_read import Recording, joined
from device.simulator.loops import loop_for
from device.tasks import NotAllowed
from device.transport import ONLY_WATCHED, LineSettings, Transport, TransportLost
from device.transport.replay import Replay
from device.wire import Frame, Proof, Revision, Shape
from tests.long import count, is_long, record
from tests.rig import Rig

Bytes = list[tuple[float, What, bytes]]
WALL = 1_700_000_000.0


class Beside:
    """Keeps what passes, independently of the recorder."""

    def __init__(self, inner: Transport, kept: Bytes, clock: Callable[[], float]) -> None:
        self._inner, self._kept, self._clock = inner, kept, clock

    def __getattr__(self, name: str) -> Any:
        return getattr(self._inner, name)

    def read(self, timeout_s: float) -> bytes:
        data = self._inner.read(timeout_s)
        if data:
            self._kept.append((self._clock(), What.RECEIVED, data))
        return data

    def write(self, data: bytes) -> int:
        taken = self._inner.write(data)
        self._kept.append((self._clock(), What.SENT, data[:taken]))
        return taken


class Taped:
    """A rig whose line is recorded, and what a studio would note of it."""

    def __init__(self, folder: Path, kind: str = "machine", **more: Any) -> None:
        self.kept: Bytes = []
        clock: list[Callable[[], float]] = [lambda: 0.0]
        self.recorder = Recorder(folder, clock=lambda: clock[0](), wall=lambda: WALL + clock[0](), threaded=False)
        channel = self.recorder.channel()
        self.number = channel.number
        self.rig = Rig(kind, tap=lambda line: channel.wrap(Beside(line, self.kept, lambda: clock[0]())), **more)
        clock[0] = self.rig.clock
        self._told: object = None
        self._listing: object = ""

    def go(self, seconds: float) -> None:
        """Time passes; looks ten times a second, as a studio's tick does."""
        end = self.rig.clock() + seconds
        while self.rig.clock() < end:
            self.rig.run(0.1)
            self.look()

    def look(self) -> None:
        controller = self.rig.controller
        facts = facts_of(controller, self.number, "/dev/ttyUSB0")
        if facts != self._told:
            self._told = facts
            self.recorder.stand(CONTROLLER, facts)
        if controller.listing != self._listing:
            self._listing = controller.listing
            self.recorder.stand(LISTING, controller.listing or "")
        for notice in controller.notices():
            self.recorder.note(NOTICE, {"kind": str(notice.kind), "text": notice.text})

    def recording(self) -> Recording:
        self.recorder.flush()
        return Recording(joined(self.recorder.files()), "test.tape")


class Played:
    """A replay whose time is in our hands."""

    def __init__(self, recording: Recording, place: float = 0.0) -> None:
        self.now = 100.0
        self.controller, self.player = replayed(
            recording, place, clock=lambda: self.now, sleep=self._sleep, threaded=False
        )
        self.came: Bytes = []

    def _sleep(self, seconds: float) -> None:
        self.now += seconds

    def go(self, seconds: float) -> None:
        end = self.now + seconds
        while self.now < end:
            self.controller.link.step()

    def through(self) -> None:
        """To the end, and everything that was due then."""
        while self.player.playing:
            self.controller.link.step()
        self.go(0.1)


def passed(recording: Recording) -> Bytes:
    """All bytes of a recording, with the time since it began to be recorded."""
    return [
        (each.record.at - WALL, each.record.what, each.record.data)
        for each in recording.records()
        if each.record.what is not What.NOTE
    ]


def same(one: Bytes, other: Bytes) -> None:
    """The same bytes in the same order, each within 5 ms of its time (pieces that touch are recorded as one)."""

    def each(kept: Bytes) -> list[tuple[float, What, int]]:
        return [(at, what, byte) for at, what, data in kept for byte in data]

    first, second = each(one), each(other)
    assert [byte[1:] for byte in first] == [byte[1:] for byte in second]
    assert max((abs(a[0] - b[0]) for a, b in zip(first, second, strict=True)), default=0.0) < 0.005


PROGRAM = "\n".join(["#A", "SH X;N=0", "#L", "PR 500;SP 20000;BG X;AM X", 'MG "PART ",N', "N=N+1", "JP #L", "EN"])


@pytest.mark.timeout(3600)
def test_a_recorded_while_replays_byte_for_byte(tmp_path: Path) -> None:
    """With a program that moves and talks, by the line's own time (long: an hour)."""
    seconds = count(10, 3600)
    tape = Taped(tmp_path, line=LineSettings(baud=19200))
    if is_long():
        tape.rig.simulation.motion.use(loop_for(True))
    tape.rig.controller.watch("all", ("position.x", "error.x", "moving.x", "inputs", "outputs", "switches.x"))
    tape.rig.start(PROGRAM)
    tape.go(seconds)
    recording = tape.recording()
    same(tape.kept, passed(recording))
    assert not recording.problem
    talked = b"".join(data for _, what, data in tape.kept if what is What.RECEIVED)
    assert tape.rig.running and talked.count(b"PART ") >= 2 * seconds, "the program did not move and talk all the time"

    played = Played(recording)
    heard: Bytes = []
    link = played.controller.link
    played.go(0.01)
    transport = link.transport
    assert isinstance(transport, Replay)
    tell = transport._tell

    def listen(placed: Any) -> bool:
        if placed.record.what is not What.NOTE:
            heard.append((placed.record.at - WALL, placed.record.what, placed.record.data))
        return tell(placed)

    transport._tell = listen
    played.through()
    every = passed(recording)
    assert transport.ended and heard == every[len(every) - len(heard) :] and len(every) - len(heard) < 20
    live, again = tape.rig.controller, played.controller
    assert again.kind is Kind.REPLAY and again.state is State.READY and again.identity == live.identity
    for key in ("position.x", "inputs", "outputs"):
        assert again.last().value(key) == live.last().value(key), key
    total = sum(len(data) for _, _, data in tape.kept)
    size = sum(path.stat().st_size for path in tape.recorder.files())
    record("recorded and replayed byte for byte", "pytest tests/device/test_recorder.py", None, seconds, "s")
    record("recording of an hour at 19200", "pytest tests/device/test_recorder.py", None, size / 1e6, "MB")
    print(f"{seconds} s: {total} bytes in {size} bytes of recording ({size / total:.3f})")


def test_nothing_can_be_sent_to_a_recording(tmp_path: Path) -> None:
    tape = Taped(tmp_path)
    tape.go(4)
    played = Played(tape.recording(), 2.0)
    played.go(1)
    controller = played.controller
    before = controller.link.transport
    assert isinstance(before, Replay) and controller.state is State.READY
    controller.take_control()
    assert not controller.control
    for future in (controller.ask("SH"), controller.read("_TPX"), controller.halt(), controller.burn_program()):
        played.go(0.1)
        with pytest.raises(NotAllowed, match="recording"):
            future.result(0)
    job = controller.download("#A\nEN")
    played.go(0.5)
    assert isinstance(job.future.exception(0), Exception)
    controller.notices()
    controller.stop()
    assert [each.text for each in controller.notices()] == ["There is nothing to stop: this is a recording."]
    assert controller.stop_state is StopState.NO_LINK
    with pytest.raises(TransportLost, match="recording"):
        before.write(b"ST\r")
    assert ONLY_WATCHED.count(".") == 1


def test_it_pauses_and_goes_faster_and_begins_anywhere(tmp_path: Path) -> None:
    tape = Taped(tmp_path)
    tape.rig.controller.watch("all", ("position.x",))
    tape.go(3)
    tape.rig.controller.take_control()
    tape.rig.type("SH X", "PR 5000", "SP 1000", "BG X")
    tape.go(8)
    recording = tape.recording()
    positions = {}
    for place in (4.0, 6.0, 9.0):
        played = Played(recording, place)
        played.go(0.2)
        positions[place] = played.controller.last().value("position.x")
        assert abs(played.controller.clock() - place) < 0.3
    assert 0 < positions[4.0] < positions[6.0] < positions[9.0] == 5000
    # two seconds at 1000 counts/s (SP, the read is at most one round of polling old)
    assert abs(positions[6.0] - positions[4.0] - 2000) < 150
    played.player.play(False)
    stood = played.player.place
    played.go(1)
    assert played.player.place == stood and not played.player.playing
    played = Played(recording, 1.0)
    played.player.set_speed(5.0)
    played.go(1.0)
    assert abs(played.player.place - 6.0) < 0.1


def test_what_was_said_and_done_is_in_its_notes(tmp_path: Path) -> None:
    tape = Taped(tmp_path)
    tape.recorder.note("did", "Terminal: SH X")
    tape.recorder.note("capture", {"names": ["position.x"], "values": [1.5, -2.0]})
    tape.recorder.note("picture", b"\x89PNG")
    tape.go(2)
    recording = tape.recording()
    found = {note.kind: note.payload for note in recording.notes}
    assert found["did"] == "Terminal: SH X" and found["picture"] == b"\x89PNG"
    assert found["capture"] == {"names": ["position.x"], "values": [1.5, -2.0]}
    assert recording.notes[0].at == pytest.approx(WALL, abs=1e-3) and recording.at(1.0) == pytest.approx(WALL + 1)
    said = [note.payload["text"] for note in recording.notes if note.kind == NOTICE and isinstance(note.payload, dict)]
    assert any(text.startswith("Connected to") for text in said)


def test_notices_and_messages_are_played_at_their_time(tmp_path: Path) -> None:
    tape = Taped(tmp_path)
    tape.go(2)
    tape.rig.start('#A\nWT 1000\nMG "HELLO"\nEN')
    tape.go(4)
    played = Played(tape.recording(), 2.0)
    played.go(0.5)
    assert not any("HELLO" in notice.text for notice in played.controller.notices())
    played.go(2)
    assert [notice.text for notice in played.controller.notices() if "HELLO" in notice.text] == ["HELLO"]
    assert any(line.direction == "*" and line.text == "HELLO" for line in played.controller.traffic())


def test_a_lost_line_is_shown_as_it_was(tmp_path: Path) -> None:
    tape = Taped(tmp_path)
    tape.go(3)
    tape.rig.cut()
    tape.go(5)
    played = Played(tape.recording(), 2.0)
    played.go(0.2)
    assert played.controller.state is State.READY
    played.through()
    assert played.controller.state is State.LOST and "does not answer" in played.controller.state_text


@pytest.mark.parametrize(
    ("line", "expected", "keys"),
    [
        (
            b'MG{^30},"k7",_TPX{F10.0},_TI{F3.0},{^31}\r',
            Frame("k7", (Shape(10, 0), Shape(3, 0))),
            ("position.x", "inputs"),
        ),
        (b'MG{^30},"aa",_BN{F10.0},{^31}\r', Frame("aa", (Shape(10, 0),)), ()),
        (b'PR 500;SP 200;MG{^30},"b1",{^31}\r', Proof("b1", 2), ()),
        (b'IP 50;MG{^30},"b2",_RPX{F10.0},{^31}\r', Frame("b2", (Shape(10, 0),), 1), ("commanded.x",)),
        (b'MG{^30},"b3",{^31};DL\r', Frame("b3", ()), ()),
        (b"\x12\x16", Revision(), ()),
        (b"\x11\x1b\\ST\rST\r", None, ()),
    ],
)  # fmt: skip
def test_what_is_expected_is_told_by_the_line_itself(line: bytes, expected: object, keys: tuple[str, ...]) -> None:
    assert expected_of(line) == (expected, keys)
