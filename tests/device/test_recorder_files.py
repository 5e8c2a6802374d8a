"""The files of the recorder: damage stays small, a kill takes a second, the ring keeps the newest; its cost."""

from __future__ import annotations

import gc
import os
import signal
import struct
import subprocess
import sys
import threading
import time
import zipfile
import zlib
from pathlib import Path

import pytest

from codegen.models import MODELS
from device.api import State
from device.recorder import Recorder
from device.recorder_format import CHECKED, HEAD, MARK, Flag, Packer, Record, What, find_blocks, note_bytes
from device.recorder_play import CONTROLLER, replayed
from device.recorder_read import Recording, RecordingUnreadable, joined, open_recording
from tests.device.test_recorder import WALL
from tests.long import count, is_long, record
from tests.slower import slower


def blocks_of(amount: int, size: int = 2000) -> bytes:
    """Blocks of one record each, ten seconds apart; what they hold cannot be compressed away."""
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
    recording = Recording(bytes(hurt), "monday.tape")
    left = [each.record for each in recording.records()]
    assert recording.problem == "A piece of monday.tape cannot be read; what is whole is played."
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
        ("empty.tape", b"", "is no recording and no service bundle"),
        ("letter.txt", b"Dear Sir", "is no recording and no service bundle"),
        ("broken.tape", MARK + b"\0" * 60, "holds nothing that can be read"),
    ],
)
def test_what_is_no_recording_is_said_in_a_sentence(tmp_path: Path, name: str, data: bytes, words: str) -> None:
    path = tmp_path / name
    path.write_bytes(data)
    with pytest.raises(RecordingUnreadable, match=words):
        open_recording(path)
    with pytest.raises(RecordingUnreadable, match="No such file"):
        open_recording(tmp_path / "missing.tape")


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


def test_times_are_those_of_the_clock_on_the_wall(tmp_path: Path) -> None:
    """Our own clock stands while a computer sleeps; that of a panel computer is set by somebody."""
    own, wall = [1000.0], [WALL]
    recorder = Recorder(tmp_path, clock=lambda: own[0], wall=lambda: wall[0], threaded=False)
    for step in (1.0, 8 * 3600.0, -7200.0):  # awake, slept through, set back
        recorder.note("did", "Connect")
        recorder.flush()
        own[0] += 1.0
        wall[0] += step
    recorder.note("did", "Connect")
    recorder.flush()
    recording = Recording(joined(recorder.files()))
    assert [note.at - WALL for note in recording.notes] == [0.0, 1.0, 28_801.0, 21_601.0]
    assert [note.place for note in recording.notes] == [0.0, 1.0, 2.0, 3.0] and not recording.problem
    assert recorder.since() == WALL


def test_sessions_stay_in_their_order_though_the_clock_was_set_back(tmp_path: Path) -> None:
    for day, moment in enumerate((WALL, WALL - 90_000.0, WALL - 89_000.0)):
        recorder = Recorder(tmp_path, clock=lambda: 0.0, wall=lambda now=moment: now, threaded=False)
        recorder.note("did", f"session {day}")
        recorder.flush()
    notes = Recording(joined(recorder.files())).notes
    assert [note.payload for note in notes] == ["session 0", "session 1", "session 2"]
    assert [note.at for note in notes] == [WALL, WALL - 90_000.0, WALL - 89_000.0]


def test_files_that_somebody_put_there_are_left_alone(tmp_path: Path) -> None:
    """A recording that was saved into the folder of the ring is no part of it, and the ring never takes it away."""
    saved = tmp_path / "recording-2026-11-23-0710.tape"
    saved.write_bytes(blocks_of(3))
    os.utime(saved, (0.0, 0.0))
    recorder = Recorder(tmp_path, most_bytes=0, threaded=False)
    recorder.note("did", "Connect")
    recorder.flush()
    assert saved.exists() and saved not in recorder.files() and len(recorder.files()) == 1
    assert recorder.since() == pytest.approx(time.time(), abs=60)


def test_a_file_that_is_taken_away_meanwhile_takes_nothing_that_comes_after(tmp_path: Path) -> None:
    """By a person who tidies up, or by another studio whose ring was full."""
    recorder = Recorder(tmp_path, threaded=False)
    recorder.stand(CONTROLLER, {"model": "ssc2", "channel": 1})
    recorder.flush()
    recorder.files()[0].unlink()
    recorder.add(What.RECEIVED, 1, b"after")
    recorder.flush()
    recording = Recording(joined(recorder.files()))
    assert [each.record.data for each in recording.records()][-1] == b"after" and not recording.problem
    assert recording.before(CONTROLLER, 0.0) is not None


@pytest.mark.parametrize("first", [float("nan"), float("inf"), -1.0, 1e300])
def test_moments_that_no_clock_shows_are_damage(first: float) -> None:
    """A file of somebody else whose checksums are right all the same."""
    block = blocks_of(1)
    flags, size = HEAD.unpack_from(block)[2:4]
    rest = HEAD.pack(MARK, 0, flags, size, first, first)[CHECKED:] + block[HEAD.size :]
    recording = Recording(MARK + struct.pack("<I", zlib.crc32(rest)) + rest, "odd.tape")
    assert not list(recording.records()) and recording.problem


@pytest.mark.parametrize("channel", ["x", [1], None, 1e400])
def test_facts_that_make_no_sense_end_nothing(channel: object) -> None:
    facts = note_bytes(
        CONTROLLER, {"channel": channel, "model": "ssc2", "state": str(State.READY), "identity": {"serial": []}}
    )
    data = Packer().pack([Record(WALL, What.NOTE, 0, facts), Record(WALL + 1, What.RECEIVED, 1, b":")])
    now = [0.0]
    controller, _ = replayed(Recording(data), clock=lambda: now[0], sleep=lambda s: None, threaded=False)
    for _ in range(20):
        now[0] += 0.1
        controller.link.step()
    assert controller.state is State.READY and controller.model is MODELS["ssc2"]


def test_a_folder_that_takes_nothing_is_said_and_nothing_stops(tmp_path: Path) -> None:
    place = tmp_path / "file"
    place.write_text("in the way")
    recorder = Recorder(place, threaded=False)
    recorder.note("did", "Connect")
    recorder.flush()
    assert recorder.problem.startswith("Nothing is recorded: ") and str(place) in recorder.problem


@pytest.mark.skipif(os.name != "posix", reason="a limit of the system takes the place of a full disk")
def test_a_full_disk_leaves_whole_files_and_no_heap_of_empty_ones(tmp_path: Path) -> None:
    """Tried twice a second for as long as it is full; goes on by itself when there is room again."""
    import resource

    recorder = Recorder(tmp_path, threaded=False)
    blocks = [os.urandom(30_000) for _ in range(3)]
    recorder.add(What.RECEIVED, 1, blocks[0])
    recorder.flush()
    whole = recorder.files()[0].stat().st_size
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (whole + 10_000, hard))  # the next block gets in by a third
    try:
        for _ in range(5):
            recorder.add(What.RECEIVED, 1, blocks[1])
            recorder.flush()
        said = recorder.problem
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert said.startswith("Nothing is recorded: ")
    assert [path.stat().st_size for path in recorder.files()] == [whole]
    recorder.add(What.RECEIVED, 1, blocks[2])
    recorder.flush()
    recording = Recording(joined(recorder.files()))
    assert not recorder.problem and not recording.problem
    assert [each.record.data for each in recording.records()] == [blocks[0], blocks[2]]


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
    pace = 1.0 if is_long() else slower()
    gc.disable()  # as in the studio; what other tests left behind is not looked through here
    began, longest = time.process_time(), 0.0
    for _ in range(2 * seconds):
        for n in range(pieces // 2):
            before = time.perf_counter()
            recorder.add(What.SENT, 1, reads[n])
            recorder.add(What.RECEIVED, 1, answers[n][4:8])
            longest = max(longest, time.perf_counter() - before)
        recorder.flush()
    share = (time.process_time() - began) / seconds
    gc.enable()
    record("recording a full line of 38400, processor", "pytest tests/device/test_recorder.py", None, 100 * share, "%")
    print(f"a full line of 38400: {100 * share:.2f} % of a processor, longest {longest * 1e3:.2f} ms")
    assert share <= 0.01 * pace


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
