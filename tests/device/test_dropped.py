"""STOP in the midst of an exchange, a program read while it prints: the program's text is told whole, and only that."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from device.api import Controller, LinkError, NoticeKind, Priority, StopState
from device.backing_up import exact, listed
from device.download import held_program
from device.proof import proved
from device.tasks import Send, Steps
from device.undecided import Dropped, Reading
from device.wire import Frame, Proof, Shape, Upload, Wire, framed
from tests.device.bench import Bench
from tests.long import is_long

COUNTS = '#A\nN=0\n#B\nN=N+1\nMG "LINE",N{F4.0}\nWT 7\nJP #B,N<4000\nEN\n#Q\nWT 60000\nEN'
NAMES = ["_SPX", "_ACX", "_KPX", "_SPY", "_ACY"]


def _exact(c: Controller) -> Steps[object]:
    return (yield from exact(c.nonces, NAMES, 80))


def _upload(c: Controller) -> Steps[object]:
    return (yield from held_program(c.waiting, c.nonces))


def _variables(c: Controller) -> Steps[object]:
    assert c.model is not None
    return (yield from listed(c, c.model, ""))


def _read(c: Controller) -> Steps[object]:
    nonce, reads = next(c.nonces), [("_SPX", Shape(10, 0)), ("_ACX", Shape(10, 0))]
    return (yield Send(framed(nonce, reads).encode() + b"\r", Frame(nonce, tuple(shape for _, shape in reads))))


READS: dict[str, Callable[[Controller], Steps[object]]] = {
    "exact": _exact, "upload": _upload, "variables": _variables, "frame": _read,
}  # fmt: skip
STRIDE = {"#A": 7, "#Q": 5}  # rounds of the link from one trial to the next


def talking(baud: int = 38400, pace: int = 7) -> Bench:
    bench = Bench("ssc2", baud=baud).ready()
    bench.result(bench.controller.download(COUNTS.replace("WT 7", f"WT {pace}")).future)
    bench.controller.notices()
    return bench


def told(bench: Bench) -> list[str]:
    return [each.text for each in bench.controller.notices() if each.kind in (NoticeKind.MESSAGE, NoticeKind.UNCLEAR)]


def rest(bench: Bench) -> str:
    return bench.controller.link.wire.left.rest


def numbered(bench: Bench, texts: list[str]) -> None:
    """Every line the program has printed, once, and nothing else; it may be stopped before it prints a number."""
    assert texts == [f"LINE {number:04d}" for number in range(1, len(texts) + 1)]
    assert float(bench.ask("MG N{F5.0}")) - len(texts) in (0.0, 1.0)
    assert rest(bench) == ""


@pytest.mark.parametrize("label", ["#A", "#Q"])
@pytest.mark.parametrize("read", READS)
def test_stop_at_every_moment_of_a_read_leaves_nothing_of_it_in_the_text(read: str, label: str) -> None:
    bench, steps, ended = talking(), 0, False
    while not ended:
        steps += 1 if is_long() else STRIDE[label]
        bench.ask("HX")
        bench.ask(f"XQ {label}")
        bench.run(0.05)
        future = bench.controller.run(READS[read](bench.controller), Priority.USER, "user")
        for _ in range(steps):
            bench.step()
        ended = future.done()
        bench.controller.stop()
        bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED, 5.0)
        bench.run(0.1)
        texts = told(bench)
        if label == "#A":
            numbered(bench, texts)
        else:
            assert texts == [], steps


@pytest.mark.parametrize("steps", [*range(1, 60)] if is_long() else [2, 9, 16, 23, 30])
def test_stop_in_the_midst_of_a_typed_question_says_what_nobody_can_tell(steps: int) -> None:
    """Its answer may look like anything: whole, it is one line; cut off, what came is told as what it may be."""
    bench = talking()
    bench.ask("XQ #A")
    bench.run(0.05)
    bench.controller.notices()
    asked = bench.controller.run(proved(bench.controller.nonces, "MG _SPX,_ACX", 1.0), Priority.USER, "user")
    for _ in range(steps):
        bench.step()
    stopped_in_it = not asked.done()
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED, 5.0)
    bench.run(0.1)
    notices = bench.controller.notices()
    texts = [each.text for each in notices if each.kind is NoticeKind.MESSAGE]
    unclear = [each.text for each in bench.controller.traffic() if each.source == "unclear"]
    assert not [text for text in texts if not text.startswith("LINE ")]
    assert bool(unclear) == any(each.kind is NoticeKind.UNCLEAR for each in notices)
    numbers = sorted(int(text[5:]) for text in [*texts, *unclear] if text.startswith("LINE "))
    assert numbers == list(range(numbers[0], numbers[-1] + 1))
    assert float(bench.ask("MG N{F5.0}")) - numbers[-1] in (0.0, 1.0)
    assert stopped_in_it or not unclear


@pytest.mark.parametrize("baud", [9600, 19200, 38400] if is_long() else [19200])
@pytest.mark.parametrize("pace", range(20, 60, 3) if is_long() else [20, 33])
def test_no_line_is_missing_while_the_program_is_read_again_and_again(baud: int, pace: int) -> None:
    """Lines that come before a listing, between its lines and behind it are all told, in their order."""
    bench = talking(baud, pace)
    bench.ask("XQ #A")
    read: list[str] = []
    texts: list[str] = []
    for _ in range(40 if is_long() else 6):
        try:
            read.append(bench.result(bench.controller.upload().future, 60.0))
        except LinkError as reason:
            assert "prints in between" in str(reason)
        texts += told(bench)
    assert len(read) > 2 or baud == 9600  # where a program prints into every reading
    held = COUNTS.replace("WT 7", f"WT {pace}")
    assert all(text.rstrip("\n") == held for text in read)
    reply = bench.result(bench.controller.ask("UL"))
    assert reply.text.rstrip("\n") == held
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED, 5.0)
    bench.run(0.1)
    numbered(bench, texts + told(bench))


@pytest.mark.parametrize("pace", range(20, 60, 3) if is_long() else [33])
def test_who_connects_to_a_talking_program_misses_none_of_its_lines(pace: int) -> None:
    first = talking(pace=pace)
    first.ask("XQ #A")
    second = Bench("ssc2", simulation=first.simulation, baud=38400).ready()
    second.run(0.2)
    second.controller.stop()
    second.run_until(lambda: second.controller.stop_state is StopState.STOPPED, 5.0)
    texts = told(second)
    numbers = [int(text.removeprefix("LINE ")) for text in texts if len(text) == len("LINE 0000")]
    assert len(numbers) > 5
    assert numbers == list(range(numbers[0], numbers[-1] + 1))
    assert len(texts) - len(numbers) <= 1  # the end of a line that came before anybody listened
    assert second.controller.waiting.listing is not None
    assert second.controller.waiting.listing.text.rstrip("\n") == COUNTS.replace("WT 7", f"WT {pace}")


# ---------------------------------------------------------------------------- the pieces


def fed(wire: Wire, data: bytes) -> list[str]:
    wire.feed(data)
    return wire.left.lines()


@pytest.mark.parametrize("cut", range(0, 60, 3))
def test_what_a_dropped_answer_looks_like_is_no_text_wherever_it_was_cut(cut: int) -> None:
    stream = b"HELLO 1\r\n $0000000A.8000\r\n:\x1eab\x1f\r\n:HELLO 2\r\n"
    wire = Wire()
    wire.expect(Proof("ab", 1, r"\s*\$[0-9A-F]{8}\.[0-9A-F]{4}", 1))
    wire.feed(stream[:cut])
    if wire.answer() is None:
        wire.drop()
        wire.expect(None, "ST")
    found = [*wire.left.lines(), *fed(wire, stream[cut:])]
    assert found == ["HELLO 1", "HELLO 2"]
    assert wire.left.unclear() == []


def test_a_program_that_prints_what_looks_like_the_answer_loses_only_the_answer() -> None:
    """The answer of one MG is one line, the last before its frame."""
    wire = Wire()
    wire.expect(Proof("ab", 1, r"\s*\$[0-9A-F]{8}\.[0-9A-F]{4}", 1))
    wire.drop()
    assert fed(wire, b" $00000001.0000\r\n $0000000A.8000\r\n:\x1eab\x1f\r\n:") == [" $00000001.0000"]


def test_text_that_is_marked_is_told_whatever_was_dropped() -> None:
    """CW1 sets bit 7 of what a program sends (dmc-1412-1414.txt l.1332), so even half a listing is no question."""
    marked = bytes(byte | 0x80 for byte in b"#A\r\n")
    wire = Wire()
    wire.expect(Upload())
    wire.feed(b"#A\r\nMG 1\r\n" + marked[:2])
    wire.drop()
    assert fed(wire, marked[2:] + b"EN\r\n\x1a\r\n:") == ["#A"]
    assert wire.left.unclear() == ["#A", "MG 1", "EN"]  # without a mark nobody can tell


def test_half_a_listing_of_a_program_that_is_known_is_told_apart() -> None:
    wire = Wire()
    wire.expect(Upload(known="#A\nMG 1\nEN\n"))
    wire.feed(b"#A\r\nHEL")
    wire.drop()
    assert fed(wire, b"LO\r\nMG 1\r\nEN\r\n\x1aHE") == ["HELLO"]
    assert fed(wire, b"RE\r\n:") == ["HERE"]
    assert wire.left.unclear() == []


def test_half_a_listing_of_a_program_that_prints_nothing_is_no_text() -> None:
    wire = Wire()
    wire.expect(Upload())
    wire.drop()
    assert fed(wire, b"#A\r\nPR 1000;BG X;AM X\r\nEN\r\n\x1a\r\n:") == []
    assert wire.left.unclear() == []


def test_the_end_of_a_text_stands_before_the_listing() -> None:
    reading = Reading("NE 5\r\n#A\r\nONE\r\nEN\r\n", "LI", end_was_told=False)
    reading.decide("#A\nEN\n")
    assert (reading.text, reading.begun) == (["LINE 5", "ONE"], "")


def test_a_text_without_its_end_goes_on_behind_the_listing() -> None:
    wire = Wire()
    wire.feed(b"LI")
    wire.expect(Upload(prints=True))
    wire.feed(b"#A\r\nEN\r\n\x1a\r\n:")
    answer = wire.answer()
    assert answer is not None and answer.reading is not None
    assert fed(wire, b"NE 5\r\n") == []  # it waits
    answer.reading.decide("#A\nEN\n")
    assert wire.left.lines() == ["LINE 5"]


def test_a_program_may_print_what_was_sent() -> None:
    """Lines come back only where EO 1 says so (dmc-1412-1414.txt l.1348); else they are the program's."""
    bench = talking()
    bench.result(bench.controller.download('#A\nMG "FAST"\nMG "TP"\nMG "SP 5"\nEN').future)
    bench.ask("SP 5")
    bench.ask("TP")
    bench.controller.notices()
    bench.ask("XQ #A")
    bench.run(0.1)
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED, 5.0)
    assert told(bench) == ["FAST", "TP", "SP 5"]


def test_a_count_that_is_not_whole_is_unclear() -> None:
    dropped = Dropped("ab", count=1)
    dropped.add(["12", "13"])
    dropped.decide(whole=False)
    assert (dropped.text, dropped.unclear) == ([], ["12", "13"])
