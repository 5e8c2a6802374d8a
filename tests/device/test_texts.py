"""What a program says, and what is said of the link: questions, errors and refusals are told apart."""

from __future__ import annotations

import pytest

from device.api import LinkLost, NotAllowed, NoticeKind, State, StopState
from device.asking import Listing, parted
from tests.device.bench import Bench

PROGRAM = """#TALK
MG "READY?"
WT 20
JP #TALK
#ASK
IN "LENGTH?",L
EN
#BLANK
IN L
EN"""


def programmed() -> Bench:
    bench = Bench("ssc2").ready()
    bench.result(bench.controller.download(PROGRAM).future)
    bench.controller.notices()
    return bench


def told(bench: Bench, *kinds: NoticeKind) -> list[tuple[NoticeKind, str]]:
    return [(notice.kind, notice.text) for notice in bench.controller.notices() if notice.kind in kinds]


@pytest.mark.parametrize("waited_s", [0.0, 0.012, 0.03, 0.5])
@pytest.mark.parametrize(("label", "line", "text"), [("#ASK", 5, 'IN "LENGTH?",L'), ("#BLANK", 8, "IN L")])
def test_the_error_that_a_stop_causes_in_a_question_is_told_as_an_error(
    label: str, line: int, text: str, waited_s: float
) -> None:
    """`ST` is no number: error 83 in the line of the IN, sent as `?` and three digits (dmc-1412-1414.txt l.2719)."""
    bench = programmed()
    bench.result(bench.controller.ask(f"XQ {label}"))
    bench.run(waited_s)
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED)
    bench.run(0.2)
    assert bench.still()
    notices = told(bench, NoticeKind.FAULT, NoticeKind.MESSAGE)
    faults = [said for kind, said in notices if kind is NoticeKind.FAULT]
    assert faults in ([], [f"?{line:03d} {text}"])  # none where the stop itself came first
    assert not [said for kind, said in notices if kind is NoticeKind.MESSAGE and "IN" in said]
    assert faults or waited_s < 0.5


@pytest.mark.parametrize(
    ("line", "parts"),
    [
        ('LENGTH??005 IN "LENGTH?",L', ("LENGTH?", 5, 'IN "LENGTH?",L')),
        ("?008 IN L", ("", 8, "IN L")),
        (":?007 QQ 5", ("", 7, "QQ 5")),  # behind a prompt that a stop left; the line is none of the listing
        ("::???007 QQ 5", ("", 7, "QQ 5")),  # and behind refusals
        ("::???008 IN L", ("", 8, "IN L")),
        ("READY?", ("READY?", -1, "")),
        ("PART ?012 OF 20", ("PART ?012 OF 20", -1, "")),  # the program's own words: line 12 is another
    ],
)
def test_an_error_behind_other_text(line: str, parts: tuple[str, int, str]) -> None:
    assert parted(line, Listing(PROGRAM)) == parts


def test_connecting_and_reading_say_nothing_of_stop() -> None:
    bench = programmed()
    bench.run(1.0)
    assert told(bench, NoticeKind.STOP) == []
    fresh = Bench("ssc2").ready()
    assert told(fresh, NoticeKind.STOP) == []
    fresh.controller.stop()
    fresh.run_until(lambda: fresh.controller.stop_state is StopState.STOPPED)
    assert [text for _, text in told(fresh, NoticeKind.STOP)] == ["STOP: stopping….", "STOP: stopped (confirmed)."]


@pytest.mark.parametrize("pressed_s", [0.05, 0.5, 1.5, 4.0])
def test_stop_on_a_dead_port_leaves_the_word_that_it_is_dead(pressed_s: float) -> None:
    bench = Bench("ssc2")
    bench.loopback.unplugged = True
    bench.run(pressed_s)
    bench.controller.stop()
    for _ in range(100):
        bench.run(0.2)
        assert "STOP" not in bench.controller.state_text
    assert bench.controller.state is State.LOST
    assert "Nothing that speaks" in bench.controller.state_text
    assert bench.controller.stop_state is StopState.NOT_CONFIRMED


def test_a_stop_that_nobody_answers_says_at_once_that_the_link_is_lost() -> None:
    bench = programmed()
    bench.run(1.0)
    bench.loopback.unplugged = True
    bench.controller.stop()
    bench.run(2.0)
    assert (bench.controller.state, bench.controller.state_text) == (State.LOST, "The controller does not answer.")
    assert bench.controller.stop_state is StopState.NOT_CONFIRMED
    bench.loopback.unplugged = False
    bench.run_until(lambda: bench.controller.state is State.READY, 20.0)


def test_the_reason_of_a_refused_start_is_its_own() -> None:
    bench = programmed()
    bench.result(bench.controller.ask("QQ"))  # error 1 stands there from now on
    bench.ask("XQ #TALK")
    again = bench.result(bench.controller.ask("XQ #ASK"))
    assert (again.accepted, again.code) == (False, 19)
    third = bench.result(bench.controller.ask("XQ #ASK,0"))
    assert (third.accepted, third.code) == (False, 19)
    missing = bench.result(bench.controller.ask("XQ #NONE,1"))
    assert (missing.accepted, missing.code) == (False, 10)


def test_a_start_that_never_arrived_is_not_refused_for_an_older_reason() -> None:
    """The program that runs says `READY?` meanwhile, and error 1 is an old one."""
    bench = programmed()
    bench.ask("XQ #TALK")
    bench.result(bench.controller.ask("QQ"))
    receive = bench.simulation.receive

    def deaf(port: int, data: bytes) -> None:
        receive(port, b"" if b"XQ #" in data else data)

    bench.simulation.receive = deaf  # type: ignore[method-assign]
    with pytest.raises(LinkLost, match=r"No clear answer|No answer"):
        bench.result(bench.controller.ask("XQ #ASK,1"))


def test_a_late_answer_to_the_first_question_who_is_there() -> None:
    bench = Bench("ssc2")
    receive, lost = bench.simulation.receive, [True]

    def deaf_at_first(port: int, data: bytes) -> None:
        if data == b"\x12\x16" and lost.pop():
            lost.append(False)
            return
        receive(port, data)

    bench.simulation.receive = deaf_at_first  # type: ignore[method-assign]
    bench.ready()
    assert bench.sent.count(b"\x12\x16") == 2
    assert bench.controller.model is not None
    assert bench.controller.model.name == "ssc2"


def test_without_a_question_no_answer_leaves() -> None:
    bench = programmed()
    bench.sent.clear()
    with pytest.raises(NotAllowed, match="No question is waiting"):
        bench.result(bench.controller.answer("ST"))
    assert b"ST" not in bench.sent
