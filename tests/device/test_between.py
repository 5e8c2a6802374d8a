"""What a program says while commands, reads and refusals are on their way: all of it is told, and nothing besides."""

from __future__ import annotations

from device.api import NoticeKind
from device.backing_up import exact
from device.proof import proved
from device.tasks import Priority, Steps
from device.wire import Kind
from tests.device.bench import Bench

COUNTS = '#A\nN=0\n#B\nN=N+1\nMG "LINE",N{F4.0}\nWT 7\nJP #B,N<100\nEN'


def told(bench: Bench) -> list[str]:
    return [notice.text for notice in bench.controller.notices() if notice.kind is NoticeKind.MESSAGE]


def counting() -> Bench:
    """A program sends a hundred numbered lines, 7 ms after each other."""
    bench = Bench("ssc4", baud=38400).ready()
    bench.result(bench.controller.download(COUNTS).future)
    bench.controller.notices()
    bench.result(bench.controller.execute("A", anyway=True))
    return bench


def all_of_it(bench: Bench) -> None:
    bench.run_until(lambda: bench.still(), 30.0)
    bench.run(0.3)
    assert told(bench) == [f"LINE {number:04d}" for number in range(1, 101)]
    assert bench.controller.link.wire.left.rest == ""


def test_a_command_that_tells_nothing_takes_no_text_for_its_answer() -> None:
    bench = counting()

    def settings() -> Steps[list[str]]:
        texts = []
        for speed in range(1000, 1020):
            answer = yield from proved(bench.controller.nonces, f"SP {speed};KP 6;V1={speed}", 1.0, 0.05)
            assert answer.kind is Kind.ACCEPTED
            texts.append(answer.text)
        return texts

    texts = bench.result(bench.controller.run(settings(), Priority.USER, "user"))
    assert texts == [""] * 20
    all_of_it(bench)


def test_exact_reads_beside_a_talking_program_are_right_and_take_nothing_from_it() -> None:
    bench = counting()
    bench.ask("V1=-2.5;SP 5000")

    def reads() -> Steps[list[object]]:
        values: list[object] = []
        for _ in range(12):
            values += yield from exact(bench.controller.nonces, ["V1", "_SPX", "V1+1"], 80)
        return values

    values = bench.result(bench.controller.run(reads(), Priority.USER, "user"))
    assert values == [-163840, 5000 * 65536, -98304] * 12  # in steps of 1/65536
    all_of_it(bench)


def test_refusals_beside_a_talking_program_leave_no_trace_in_its_text() -> None:
    bench = counting()

    def refused() -> Steps[list[Kind]]:
        kinds = []
        for _ in range(4):
            answer = yield from proved(bench.controller.nonces, "V1=5;QQ 5;V2=6", 1.0, 0.04)
            kinds.append(answer.kind)
        return kinds

    assert bench.result(bench.controller.run(refused(), Priority.USER, "user")) == [Kind.UNCERTAIN] * 4
    all_of_it(bench)


def test_a_refused_command_leaves_nothing_standing() -> None:
    bench = Bench("ssc4").ready()
    for command in ("QQ 5", "V1=5;QQ 5;V2=6", "MG _ZZZ", "MO;BG X"):
        assert not bench.result(bench.controller.ask(command)).accepted
        assert bench.controller.link.wire.left.rest == ""
