"""A program is read while it runs and prints: what it prints is never taken for a line of it."""

from __future__ import annotations

import pytest

from device.api import LinkError, Priority
from device.download import READINGS, upload_steps
from tests.device.bench import Bench
from tests.long import is_long

PACES = (*range(2, 60), 90, 250)  # ms between two texts
TEXTS = ("TICK", "#B", "PR 1000")  # some could be lines of a program


def program(pace: int, text: str) -> str:
    """Half a second on the line at 9600 baud: most of the paces print into every reading."""
    return "\n".join([f'#A;WT {pace};MG "{text}";JP #A', *(f"NO LINE {number:02}" for number in range(35)), "EN"])


def running(pace: int, text: str, baud: int = 9600) -> tuple[Bench, str]:
    """The program runs and has begun to print."""
    bench = Bench("ssc2", baud=baud).ready()
    held = program(pace, text)
    bench.result(bench.controller.download(held).future)
    assert bench.result(bench.controller.ask("XQ #A")).accepted
    bench.run(0.3)
    return bench, held


def alone(bench: Bench) -> str:
    """One reading by itself."""
    c = bench.controller
    return str(bench.result(c.run(upload_steps(c.nonces, None), Priority.USER, "user"))).rstrip("\n")


@pytest.mark.parametrize("baud", [9600, 19200, 38400] if is_long() else [9600])
@pytest.mark.parametrize("text", TEXTS)
@pytest.mark.parametrize("pace", PACES if is_long() else (3, 25, 40, 90, 250))
def test_what_is_read_is_the_program_or_nothing(pace: int, text: str, baud: int) -> None:
    bench, held = running(pace, text, baud)
    try:
        read = bench.result(bench.controller.upload().future, 60.0)
    except LinkError as reason:
        assert str(reason) == "Not read: the running program prints in between. Halt it, or try again."
    else:
        assert read.rstrip("\n") == held
    assert bench.simulation.state()["threads"][0]["running"]


def test_texts_do_come_in_between() -> None:
    """One reading alone is wrong often enough; the same moments are read right above, or not at all."""
    bench, held = running(40, "PR 1000")
    wrong = 0
    for number in range(8):
        wrong += alone(bench) != held
        bench.run(0.011 * number)
    assert wrong > 0


def test_a_slow_talker_is_read() -> None:
    """A text every 2 s leaves room for two readings of half a second."""
    bench, held = running(2000, "TICK")
    assert bench.result(bench.controller.upload().future).rstrip("\n") == held


def test_what_stands_still_is_read_once() -> None:
    bench, held = running(250, "TICK")
    assert bench.result(bench.controller.ask("HX")).accepted
    bench.run(0.5)
    bench.controller.waiting.threads(frozenset())
    bench.sent.clear()
    assert bench.result(bench.controller.upload().future).rstrip("\n") == held
    assert bench.sent.count(b"UL\r") == 1


def test_a_program_that_may_ask_is_read_once() -> None:
    """A question that comes meanwhile would take the second reading for its answer; met while it runs, it is read."""
    bench = Bench("ssc2")
    bench.simulation.load_program('#A;WT 60000;IN "N",N;EN')
    bench.simulation.execute("#A")
    bench.ready()
    listing = bench.controller.waiting.listing
    assert listing is not None and listing.may_ask(None)
    assert bench.sent.count(b"UL\r") == 1 < READINGS
