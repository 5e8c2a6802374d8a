"""The event list: each sort really caused on a simulated machine, kept on disk over a kill, found again."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from device.api import Kind, StopState, jog
from device.events import Event, EventFile, EventList, What
from device.events_heard import EventsHeard
from tests.device.bench import Bench


class Heard(Bench):
    """A bench with somebody who listens as the studio does."""

    def __init__(self, name: str = "ssc2", file: EventFile | None = None) -> None:
        super().__init__(name, kind=Kind.MACHINE)
        self.events = EventList(file)
        self.ear = EventsHeard(self.events, wall=lambda: 1000.0 + self.loopback.clock())
        self.ready()
        self.controller.take_control()
        self.controller.notices()
        self.ear.begin(self.controller)
        self.listen(2.5)

    def listen(self, seconds: float) -> Heard:
        end = self.loopback.clock() + seconds
        while self.loopback.clock() < end:
            self.run(0.03)
            for notice in self.controller.notices():
                self.ear.happened(self.controller, notice)
            self.ear.look(self.controller)
        return self

    def one(self, what: What) -> Event:
        found = self.events.search(kinds=[what])
        assert len(found) == 1, self.events.all()
        return found[0]


def test_a_quiet_machine_makes_no_events() -> None:
    heard = Heard()
    heard.ask("SH")
    heard.ask("PR 1000;BG X")
    heard.listen(3.0)
    assert heard.events.all() == []


@pytest.mark.parametrize(("signal_", "speed", "word"), [("fls_x", 20_000, "forward"), ("rls_x", -20_000, "reverse")])
def test_a_limit(signal_: str, speed: int, word: str) -> None:
    heard = Heard()
    heard.ask(f"SH;JG {speed};BG X")
    heard.listen(1.5)
    heard.simulation.stimulus(signal_, 0)
    heard.listen(2.5)
    event = heard.one(What.LIMIT)
    assert (event.axis, event.text) == ("X", f"Axis X stopped at its {word} limit.")
    place = heard.simulation.state()["axes"]["X"]["actual"]
    assert event.place == pytest.approx(place, abs=60)  # read while it settled
    assert "limit switch" in event.cause
    assert event.step.startswith("Move the axis back")
    assert 1000 < event.at < 1020


def test_the_abort_input() -> None:
    heard = Heard()
    heard.ask("SH;JG 20000;BG X")
    heard.listen(1.5)
    heard.simulation.stimulus("abort", 0)
    heard.listen(2.5)
    assert heard.events.search("abort input", axis="X")[0].what is What.STOPPED


def test_a_position_error_that_switches_the_motor_off() -> None:
    heard = Heard()
    heard.ask("SH;ER 200;OE 1")
    heard.listen(2.0)
    heard.ask("JG 20000;BG X")
    heard.listen(1.0)
    heard.simulation.stimulus("position_x", 5000)
    heard.listen(3.0)
    event = heard.one(What.FAULT)
    assert (event.axis, event.cause) == ("X", "Decelerating or stopped by off-on-error (OE1)")
    assert "KP" in event.step


def test_an_error_of_a_program_with_its_line_and_reason() -> None:
    heard = Heard()
    heard.result(heard.controller.download("#A\nMO\nWT 2000\nBG X\nEN").future)
    heard.controller.execute("A", anyway=True)
    heard.listen(6.0)
    event = heard.one(What.PROGRAM)
    assert (event.line, event.thread) == (3, 0)
    assert event.text == "Error in line 3: BG X"
    assert event.cause == "error 20, Begin not valid with motor off"
    assert event.step == "Switch the motor on (SH) before the move begins."
    assert heard.events.search(kinds=[What.REFUSED]) == []


@pytest.mark.parametrize("what", [What.LIMIT, What.STOP])
def test_what_the_program_was_at_is_kept_with_what_happened(what: What) -> None:
    """Line 4 waits for the move; nothing ran before."""
    heard = Heard()
    heard.result(heard.controller.download("#A\nSH\nSP 20000;PR 1000000\nBG X\nAM X\nEN").future)
    heard.listen(1.0)
    assert heard.one(What.DOWNLOAD).lines == ()
    heard.controller.execute("A", anyway=True)
    heard.listen(2.0)
    if what is What.STOP:
        heard.controller.stop()
    else:
        heard.simulation.stimulus("fls_x", 0)
    heard.listen(2.5)
    event = heard.one(what)
    assert event.lines == ((0, 4),) and set(event.places) == set("XY")
    assert heard.events.search("thread 0 line 4", kinds=[what]) == [event]


def test_a_command_that_is_refused() -> None:
    heard = Heard()
    assert not heard.result(heard.controller.ask("SP 99999999")).accepted
    heard.listen(2.5)
    assert heard.one(What.REFUSED).text == "Error 6: Number out of range."


def test_a_reset_a_lost_line_and_its_return() -> None:
    heard = Heard()
    heard.simulation.stimulus("reset", 0)
    heard.simulation.stimulus("reset", 1)
    heard.listen(4.0)
    assert "restarted" in heard.one(What.RESET).text
    assert "Home the axes" in heard.one(What.RESET).step
    heard.loopback.unplugged = True
    heard.listen(5.0)
    assert heard.one(What.LOST).step.startswith("Look at the cable")
    heard.loopback.unplugged = False
    heard.listen(5.0)
    assert "answers again" in heard.events.search(kinds=[What.BACK])[0].text


def test_stop_and_what_it_said() -> None:
    heard = Heard()
    heard.ask("SH;JG 20000;BG X")
    heard.controller.stop()
    heard.listen(3.0)
    assert heard.one(What.STOP).cause == str(StopState.STOPPED)
    heard.loopback.unplugged = True
    heard.controller.stop()
    heard.listen(2.0)
    newest = heard.events.search(kinds=[What.STOP])[0]
    assert newest.cause == str(StopState.NOT_CONFIRMED)
    assert "emergency stop" in newest.step


def test_a_download_and_a_burn() -> None:
    heard = Heard()
    heard.result(heard.controller.download("#A\nWT 60000\nEN").future)
    heard.ask("BN")
    heard.listen(1.0)
    assert "3 lines" in heard.one(What.DOWNLOAD).text
    assert "(BN)" in heard.one(What.BURN).text
    heard.result(heard.controller.execute("A", anyway=True))
    assert not heard.result(heard.controller.ask("BN")).accepted  # error 17: a program runs
    heard.listen(1.0)
    heard.one(What.BURN)


def test_what_a_hand_lets_go_is_no_event() -> None:
    heard = Heard()
    heard.ask("SH")
    heard.listen(1.0)
    heard.controller.motion.go(jog.by("X", 100_000, 20_000, 256_000, 256_000))
    heard.listen(1.5)
    heard.controller.motion.release()
    heard.listen(2.5)
    assert heard.events.all() == []


# ------------------------------------------------------------------- on disk

WRITER = """
import sys
from pathlib import Path
from device.events import Event, EventFile, EventList, What
events = EventList(EventFile(Path(sys.argv[1])))
while True:
    events.add(Event(0, 1.0, What.FAULT, "x" * 500))
    print(events.newest, flush=True)
"""


def test_everything_told_is_there_after_a_kill(tmp_path: Path) -> None:
    path = tmp_path / "events" / "events.jsonl"
    for _ in range(2):
        writer = subprocess.Popen(
            [sys.executable, "-c", WRITER, str(path)],
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, "PYTHONPATH": os.getcwd()},
        )
        assert writer.stdout is not None
        told = [int(writer.stdout.readline()) for _ in range(50)]
        writer.send_signal(signal.SIGKILL)
        writer.wait()
        writer.stdout.close()
        kept = EventList(EventFile(path))
        assert {event.number for event in kept.all()} >= set(told)


def test_a_line_that_was_left_half_spoils_no_other(tmp_path: Path) -> None:
    path = tmp_path / "events.jsonl"
    events = EventList(EventFile(path))
    first = events.add(Event(0, 1.0, What.LOST, "The cable is out.", places={"X": 5.0}))
    with path.open("ab") as file:
        file.write(b'{"number": 2, "at": 2.0, "wh')
    again = EventList(EventFile(path))
    assert again.all() == [first]
    second = again.add(Event(0, 3.0, What.BACK, "It is back."))
    assert second.number == 2
    assert EventList(EventFile(path)).all() == [first, second]


def test_the_files_stay_small_and_numbers_go_on(tmp_path: Path) -> None:
    path = tmp_path / "events.jsonl"
    events = EventList(EventFile(path, most_bytes=5000))
    for number in range(200):
        events.add(Event(0, float(number), What.FAULT, f"Fault {number}."))
    assert sum(file.stat().st_size for file in tmp_path.iterdir()) <= 10_000
    kept = EventList(EventFile(path, most_bytes=5000))
    numbers = [event.number for event in kept.all()]
    assert numbers == list(range(numbers[0], 201))
    assert len(numbers) >= 25
    assert kept.add(Event(0, 999.0, What.LOST, "")).number == 201


def test_what_becomes_known_later_is_kept_too(tmp_path: Path) -> None:
    events = EventList(EventFile(tmp_path / "events.jsonl"))
    number = events.add(Event(0, 1.0, What.PROGRAM, "Error in line 3")).number
    events.complete(number, cause="error 20", step="SH")
    assert EventList(EventFile(tmp_path / "events.jsonl")).all() == events.all()
    assert events.all()[0].cause == "error 20"
    assert len(events) == 1


def test_a_disk_that_takes_nothing_is_said(tmp_path: Path) -> None:
    (tmp_path / "folder").write_text("no folder")
    events = EventList(EventFile(tmp_path / "folder" / "events.jsonl"))
    events.add(Event(0, 1.0, What.LOST, "x"))
    assert len(events) == 1
    assert events.problem.startswith("Events are not kept on disk")


@pytest.mark.parametrize(
    ("search", "numbers"),
    [
        (lambda events: events.search("LIMIT x"), [1]),
        (lambda events: events.search(kinds=[What.LOST, What.LIMIT]), [3, 1]),
        (lambda events: events.search(axis="Y"), [2]),
        (lambda events: events.search(since=2.5), [3]),
        (lambda events: events.search(), [3, 2, 1]),
        (lambda events: events.search("cable limit"), []),
    ],
)
def test_searching(search: Callable[[EventList], list[Event]], numbers: list[int]) -> None:
    events = EventList()
    events.add(Event(0, 1.0, What.LIMIT, "Axis X stopped at its forward limit.", "X"))
    events.add(Event(0, 2.0, What.FAULT, "Axis Y", "Y", cause="off-on-error"))
    events.add(Event(0, 3.0, What.LOST, "The cable is out."))
    assert [event.number for event in search(events)] == numbers


def test_a_line_is_readable_by_other_programs(tmp_path: Path) -> None:
    path = tmp_path / "events.jsonl"
    EventList(EventFile(path)).add(Event(0, 1.5, What.LIMIT, "Grenze für X", "X", {"X": 2.0}))
    kept = json.loads(path.read_text(encoding="utf-8"))
    assert (kept["what"], kept["text"], kept["places"]) == ("limit", "Grenze für X", {"X": 2.0})
