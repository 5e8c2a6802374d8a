"""The recorder: what went over the line comes back byte for byte, survives kills and damage, and is never sent."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from device.api import Kind, State, StopState
from device.recorder import Recorder
from device.recorder_format import MARK, Flag, Packer, Record, What, find_blocks
from device.recorder_play import CONTROLLER, LISTING, NOTICE, expected_of, facts_of, replayed
from device.recorder_read import Recording, RecordingUnreadable, joined, open_recording
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
        return Recording(joined(self.recorder.files()), "test.tlr")


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


PROGRAM = "\n".join(["#A", "SH X", "#L", "PR 500;SP 20000;BG X;AM X", 'MG "PART ",N', "N=N+1", "JP #L", "EN"])


@pytest.mark.timeout(3600)
def test_a_recorded_while_replays_byte_for_byte(tmp_path: Path) -> None:
    """With a program that moves and talks, by the line's own time (long: an hour)."""
    seconds = count(15, 3600)
    tape = Taped(tmp_path, line=LineSettings(baud=19200))
    if is_long():
        tape.rig.simulation.motion.use(loop_for(True))
    tape.rig.controller.watch("all", ("position.x", "error.x", "moving.x", "inputs", "outputs", "switches.x"))
    tape.rig.start(PROGRAM)
    tape.go(seconds)
    recording = tape.recording()
    same(tape.kept, passed(recording))
    assert not recording.problem

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


# ------------------------------------------------------------------ the files


def blocks_of(amount: int, size: int = 2000) -> bytes:
    """Blocks of one record each, ten seconds apart; what they hold can not be compressed away."""
    packer = Packer()
    return b"".join(
        packer.pack([Record(WALL + 10 * n, What.RECEIVED, 1, bytes((n * 7 + k * k) % 251 for k in range(size)))])
        for n in range(amount)
    )


def test_damage_takes_only_what_it_hit(tmp_path: Path) -> None:
    whole = blocks_of(400)
    clean = [each.record for each in Recording(whole).records()]
    assert len(clean) == 400 and not Recording(whole).problem
    fresh = [block for block in find_blocks(whole)[0] if block.flags & Flag.FRESH]
    assert len(fresh) > 2
    hurt = bytearray(whole)
    hurt[fresh[1].start + 5] ^= 0x40  # one bit
    recording = Recording(bytes(hurt), "monday.tlr")
    left = [each.record for each in recording.records()]
    assert recording.problem == "A piece of monday.tlr can not be read; what is whole is played."
    begin = next(n for n, each in enumerate(clean) if each.at >= fresh[1].first)
    end = next(n for n, each in enumerate(clean) if each.at >= fresh[2].first)
    assert left == clean[:begin] + clean[end:]
    cut = Recording(whole[: len(whole) - 30])  # the end is missing
    assert [each.record for each in cut.records()] == clean[:-1] and cut.problem
    holes = bytes(b if n % 9000 > 40 else 0 for n, b in enumerate(whole))
    for each in Recording(holes).records():  # whatever is left is right
        assert each.record in clean


def test_every_cut_of_a_recording_can_be_opened(tmp_path: Path) -> None:
    whole = blocks_of(6, 40)
    clean = [each.record for each in Recording(whole).records()]
    for end in range(len(whole)):
        left = [each.record for each in Recording(whole[:end]).records()]
        assert left == clean[: len(left)]


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("empty.tlr", b"", "is no recording and no service bundle"),
        ("letter.txt", b"Dear Sir", "is no recording and no service bundle"),
        ("broken.tlr", MARK + b"\0" * 60, "holds nothing that can be read"),
    ],
)
def test_what_is_no_recording_is_said_in_a_sentence(tmp_path: Path, name: str, data: bytes, words: str) -> None:
    path = tmp_path / name
    path.write_bytes(data)
    with pytest.raises(RecordingUnreadable, match=words):
        open_recording(path)
    with pytest.raises(RecordingUnreadable, match="No such file"):
        open_recording(tmp_path / "missing.tlr")


def test_a_bundle_without_a_recording_is_said(tmp_path: Path) -> None:
    path = tmp_path / "old.zip"
    with zipfile.ZipFile(path, "w") as bundle:
        bundle.writestr("events.json", "[]")
    with pytest.raises(RecordingUnreadable, match=r"no recording in old\.zip"):
        open_recording(path)
    path.write_bytes(path.read_bytes()[:-30])
    with pytest.raises(RecordingUnreadable):
        open_recording(path)


def test_the_ring_keeps_the_newest(tmp_path: Path) -> None:
    now = [0.0]
    recorder = Recorder(
        tmp_path, clock=lambda: now[0], wall=lambda: WALL + now[0], most_bytes=3_000_000, most_s=1e12, threaded=False
    )
    recorder.stand(CONTROLLER, {"model": "ssc2", "channel": 1})
    noise = os.urandom(40_000)
    for n in range(150):  # 6 MB
        now[0] += 1.0
        recorder.add(What.RECEIVED, 1, noise[n:] + noise[:n])
    recorder.flush()
    assert sum(path.stat().st_size for path in recorder.files()) <= 3_000_000
    recording = Recording(joined(recorder.files()))
    records = [each.record for each in recording.records() if each.record.what is What.RECEIVED]
    assert records[-1].at == pytest.approx(WALL + 150) and len(records) < 80 and not recording.problem
    assert recording.before(CONTROLLER, 0.0) is not None  # told again in each file
    old = Recorder(tmp_path, wall=lambda: time.time() + 90_000, threaded=False)  # the day after
    old.note("did", "Connect")
    old.flush()
    assert len(old.files()) == 1


def test_a_folder_that_takes_nothing_is_said_and_nothing_stops(tmp_path: Path) -> None:
    place = tmp_path / "file"
    place.write_text("in the way")
    recorder = Recorder(place, threaded=False)
    recorder.note("did", "Connect")
    recorder.flush()
    assert recorder.problem.startswith("Nothing is recorded: ") and str(place) in recorder.problem


LIFE = """
import sys, time
from pathlib import Path
from device.recorder import Recorder
from device.recorder_format import What
recorder = Recorder(Path(sys.argv[1]))
n = 0
while True:
    n += 1
    recorder.add(What.RECEIVED, 1, b"%d " % n)
    print(n, time.time(), flush=True)
    time.sleep(0.002)
"""


@pytest.mark.paced
@pytest.mark.skipif(os.name != "posix", reason="SIGKILL")
def test_a_kill_takes_at_most_a_second(tmp_path: Path) -> None:
    """Killed at any moment, all that was recorded a second before is there and can be read."""
    worst = 0.0
    for trial in range(count(2, 30)):
        folder = tmp_path / str(trial)
        process = subprocess.Popen([sys.executable, "-c", LIFE, str(folder)], stdout=subprocess.PIPE, text=True)
        assert process.stdout is not None
        process.stdout.readline()
        time.sleep(1.1 + 0.07 * trial % 0.6)
        process.send_signal(signal.SIGKILL)
        told = [line.split() for line in process.stdout.read().splitlines() if line.count(" ") == 1]
        process.wait()
        recording = Recording(joined(Recorder(folder).files()))
        assert not recording.problem
        kept = b"".join(each.record.data for each in recording.records())
        numbers = [int(text) for text in kept.split()]
        assert numbers == list(range(1, len(numbers) + 1))
        moments = {int(number): float(at) for number, at in told}
        worst = max(worst, float(told[-1][1]) - moments.get(len(numbers), float(told[0][1])))
    record("recording lost by a kill, worst", "pytest tests/device/test_recorder.py", None, worst, "s")
    assert worst <= 1.0


@pytest.mark.alone
def test_recording_a_full_line_costs_a_hundredth_of_a_processor(tmp_path: Path) -> None:
    """38 400 baud both ways in pieces of four bytes: processor time, and how long the link's thread is held."""
    recorder = Recorder(tmp_path, threaded=False)
    seconds, pieces = count(60, 600), 38400 // 10 // 4
    reads = [b'MG{^30},"k7",_TPX{F10.0},{^31}\r'[n % 28 : n % 28 + 4] for n in range(pieces)]
    answers = [b"\x1ek7 00000%05d\x1f\r\n:" % (n * 37 % 99991) for n in range(pieces)]
    began, longest = time.process_time(), 0.0
    for _ in range(2 * seconds):
        for n in range(pieces // 2):
            before = time.perf_counter()
            recorder.add(What.SENT, 1, reads[n])
            recorder.add(What.RECEIVED, 1, answers[n][4:8])
            longest = max(longest, time.perf_counter() - before)
        recorder.flush()
    share = (time.process_time() - began) / seconds
    record("recording a full line of 38400, processor", "pytest tests/device/test_recorder.py", None, 100 * share, "%")
    print(f"a full line of 38400: {100 * share:.2f} % of a processor, longest {longest * 1e3:.2f} ms")
    assert share <= 0.01


def test_the_thread_writes_by_itself_and_ends(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path)
    recorder.note("did", "Connect")
    end = time.monotonic() + 5
    while not recorder.files() and time.monotonic() < end:
        time.sleep(0.02)
    assert Recording(joined(recorder.files())).notes[0].payload == "Connect"
    recorder.note("did", "Exit")
    recorder.close()
    assert [note.payload for note in Recording(joined(recorder.files())).notes] == ["Connect", "Exit"]
    assert not [thread for thread in threading.enumerate() if thread.name == "recorder" and thread.is_alive()]


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
