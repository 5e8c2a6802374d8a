"""An IN takes the next line as its answer: nothing else may be sent while one may be waiting (safety.md, 3)."""

from __future__ import annotations

import pytest

from device.api import LinkError, NotAllowed, NoticeKind
from device.asking import Listing, Waiting
from device.live import columns
from tests.device.bench import Bench

LOOP = """#A
N=0;TOTAL=0
#B
IN "HOW MANY",V
TOTAL=TOTAL+V;N=N+1
JP #B,N<50
EN"""


def asking(baud: int | None = 19200) -> Bench:
    """Everything that can be read is being read, and the program is running."""
    bench = Bench("ssc4", baud=baud).ready()
    controller = bench.controller
    controller.watch("all", columns(controller.model))
    bench.result(controller.download(LOOP).future)
    bench.run(1.0)
    bench.result(controller.execute("A", anyway=True))
    return bench


@pytest.mark.parametrize("baud", [9600, 19200, 38400, None])
def test_fifty_questions_get_exactly_their_fifty_answers(baud: int | None) -> None:
    bench = asking(baud)
    controller = bench.controller
    for answer in range(1, 51):
        bench.run_until(lambda: controller.pending_prompt is not None, 3.0)
        assert controller.pending_prompt is not None
        assert controller.pending_prompt.text.endswith("HOW MANY")
        bench.result(controller.answer(str(answer)))
        bench.run(0.15)
    state = bench.simulation.state()
    assert state["variables"]["TOTAL"] == sum(range(1, 51))
    assert state["errors"] == []


@pytest.mark.parametrize("moment", range(16))
def test_a_read_on_its_way_when_the_program_is_started_is_never_the_answer(moment: int) -> None:
    bench = Bench("ssc4").ready()
    controller = bench.controller
    controller.watch("all", columns(controller.model))
    bench.result(controller.download(LOOP).future)
    bench.run(0.5 + moment * 0.0041)
    bench.result(controller.execute("A", anyway=True))
    bench.run_until(lambda: controller.pending_prompt is not None, 3.0)
    assert bench.simulation.state()["errors"] == []
    assert bench.simulation.state()["variables"]["N"] == 0


def test_while_a_question_waits_values_go_stale_and_commands_are_refused() -> None:
    bench = asking()
    controller = bench.controller
    bench.run_until(lambda: controller.pending_prompt is not None)
    bench.sent.clear()
    bench.run(5.0)
    assert bench.sent == b""
    assert not controller.polling
    assert controller.last().stale("position.x", controller.clock())
    with pytest.raises(NotAllowed, match="waits for an answer"):
        bench.result(controller.ask("SP 1000"))
    assert any(notice.kind is NoticeKind.PROMPT for notice in controller.notices())


def test_while_a_program_may_ask_nothing_is_moved_read_or_downloaded_by_hand() -> None:
    bench = asking()
    controller = bench.controller
    with pytest.raises(LinkError, match=r"may ask|waits for"):
        bench.result(controller.motion.hold("X", 1000, 100_000, 100_000))
    with pytest.raises(LinkError, match="program is running"):
        bench.result(controller.download("#A\nEN").future)
    with pytest.raises(LinkError, match=r"may ask|waits for"):
        bench.result(controller.upload().future)
    with pytest.raises(LinkError, match=r"may ask|waits for"):
        bench.result(controller.read("_KPX"))
    assert bench.simulation.state()["errors"] == []


def test_halting_a_program_that_asks_answers_nothing_for_good() -> None:
    bench = asking()
    bench.run_until(lambda: bench.controller.pending_prompt is not None)
    assert bench.result(bench.controller.halt()).accepted
    assert bench.still()
    assert bench.controller.pending_prompt is None


def test_reading_goes_on_after_stop() -> None:
    bench = asking()
    controller = bench.controller
    bench.run_until(lambda: controller.pending_prompt is not None)
    controller.stop()
    bench.run_until(lambda: controller.pending_prompt is None and controller.polling)
    bench.run(1.0)
    assert not controller.last().stale("position.x", controller.clock())


def test_reading_goes_on_once_no_question_can_be_reached_any_more() -> None:
    bench = Bench("ssc4").ready()
    controller = bench.controller
    controller.watch("all", ["position.x"])
    bench.result(controller.download('#A\nIN "LENGTH",LEN\n#B\nWT 10\nJP #B').future)
    bench.result(controller.execute("A", anyway=True))
    bench.run_until(lambda: controller.pending_prompt is not None)
    bench.result(controller.answer("12"))
    bench.run(1.0)
    assert controller.polling
    assert not controller.last().stale("position.x", controller.clock())
    assert bench.simulation.state()["variables"]["LEN"] == 12


def test_a_program_without_questions_is_read_all_the_time() -> None:
    bench = Bench("ssc4").ready()
    controller = bench.controller
    controller.watch("all", ["position.x"])
    bench.result(controller.download('#A\nMG "12:30? "{N}\nWT 5\nJP #A').future)
    bench.result(controller.execute("A", anyway=True))
    bench.run(2.0)
    assert controller.pending_prompt is None
    assert not controller.last().stale("position.x", controller.clock())


def test_a_running_program_found_at_connecting_is_read_to_know_what_it_asks() -> None:
    bench = Bench("ssc4")
    bench.simulation.load_program('#A\nWT 3000\nIN "NOW",V\nEN')
    bench.simulation.execute("#A", 0)
    bench.run(1.0)
    assert not bench.controller.polling
    bench.run_until(lambda: bench.controller.pending_prompt is not None)
    assert bench.controller.pending_prompt is not None
    assert bench.controller.pending_prompt.lines == (2,)


def test_where_questions_can_be_reached_from() -> None:
    listing = Listing('#A\nIN "X",V\n#B\nWT 10\nJP #B\n#C\nJS #A\nEN\n#D\nIN{P2} "TWO",V\nEN')
    assert listing.may_ask(frozenset({0}))
    assert not listing.may_ask(frozenset({2}))
    assert listing.may_ask(frozenset({5}))
    assert not listing.may_ask(frozenset({8}))
    assert listing.may_ask(None)
    assert not Listing('#A\nMG "IN"\nEN').may_ask(None)


def test_an_automatic_routine_that_asks_may_ask_from_anywhere() -> None:
    listing = Listing('#A\nWT 10\nJP #A\n#POSERR\nIN "WHY",V\nRE')
    assert listing.may_ask(frozenset({0}))


def test_data_mode_of_the_port_stops_reading() -> None:
    bench = Bench("ssc4").ready()
    controller = bench.controller
    controller.watch("all", ["position.x"])
    bench.run(0.5)
    bench.result(controller.ask("CI ,,1"))
    bench.sent.clear()
    bench.run(1.0)
    assert bench.sent == b""
    with pytest.raises(NotAllowed, match="data mode"):
        bench.result(controller.ask("SP 1000"))


def test_lines_typed_after_dl_are_not_mixed_with_reads() -> None:
    bench = Bench("ssc4").ready()
    controller = bench.controller
    controller.watch("all", ["position.x"])
    for line in ("DL", "#A", "PR 100", "EN"):
        assert bench.result(controller.ask(line)).accepted
        bench.run(0.5)
    bench.result(controller.ask("\\"))
    assert bench.result(controller.upload().future).split() == ["#A", "PR", "100", "EN"]


def test_the_second_question_is_shown_without_the_controllers_prompts() -> None:
    bench = Bench("ssc4").ready()
    controller = bench.controller
    bench.result(controller.download('#A\nIN "Length?",LEN\nJP #A,LEN<0\nIN "Width?",W\nJP #A\nEN').future)
    bench.result(controller.execute("A", anyway=True))
    for expected, answer in (("Length?", "-1"), ("Length?", "5"), ("Width?", "7"), ("Length?", "1")):
        bench.run_until(lambda: controller.pending_prompt is not None)
        assert controller.pending_prompt is not None
        assert controller.pending_prompt.text == expected
        bench.result(controller.answer(answer))
    texts = [notice.text for notice in controller.notices() if notice.kind is NoticeKind.PROMPT]
    assert texts == ["Length?", "Length?", "Width?", "Length?"]


def test_a_question_of_an_unknown_program_is_shown_without_the_controllers_prompts() -> None:
    waiting = Waiting()
    assert waiting.seen(":?:Length?")
    assert waiting.prompt is not None
    assert waiting.prompt.text == "Length?"


def test_reading_goes_on_after_a_program_died_of_an_error_at_its_question() -> None:
    """`?` and the line: the thread has ended (dmc-1412-1414.txt, error handling), so nothing will ask."""
    bench = Bench("ssc4").ready()
    controller = bench.controller
    controller.watch("all", ["position.x"])
    bench.result(controller.download('#A\nWT 5\nIN "Length?",LEN\nJP #A\nEN').future)
    bench.result(controller.execute("A", anyway=True))
    bench.run_until(lambda: controller.pending_prompt is not None)
    bench.result(controller.answer("@@"))
    faults: list[str] = []
    while not faults:
        bench.run(0.1)
        faults += [notice.text for notice in controller.notices() if notice.kind is NoticeKind.FAULT]
    assert faults == ['?002 IN "Length?",LEN']
    bench.run(1.5)
    assert not controller.resting()
    assert controller.pending_prompt is None
    assert controller.polling
    assert not controller.last().stale("position.x", controller.clock())
    assert bench.result(controller.read("_TC"))[0] > 0
    assert not bench.simulation.state()["threads"][0]["running"]


def test_an_error_elsewhere_or_one_that_is_caught_ends_no_thread() -> None:
    listing = '#A\nIN "X",V\nJP #A\n#B\nWT 10\nJP #B\nEN'
    for text, told, left in (
        (listing, (4, "WT 10"), {0}),
        (listing, (1, "PR 7"), {0, 3}),
        (listing + "\n#CMDERR\nEN", (1, 'IN "X",V'), {0, 3}),
    ):
        waiting = Waiting()
        waiting.listing, waiting.position = Listing(text), frozenset({0, 3})
        waiting.failed(*told)
        assert waiting.position == left
