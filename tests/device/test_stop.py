"""STOP from every state of the line, with nothing moving, a long move and a jog (safety.md, 1)."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from device.api import StopState
from device.simulator.plant import Place, Plant
from device.stop import stop_bytes
from tests.device.bench import Bench

PROGRAM = """#A
MG "RUN:?"
WT 20
JP #A
#I
IN "HOW MANY",N
JP #I
#S
IN "NAME",N{S6};WT 5
JP #S
#T
IN "NAME",N{S6}
JP #T"""
TYPED = {  # what the link itself has sent
    "download": ["DL", "#NEW", "PR 100"],
    "array download": ["DM Q[10]", "QD Q[],0,9", "1"],
    "editor": ["ED 1"],
    "running program": ["XQ #A"],
    "waiting for a number": ["XQ #I"],
    "waiting for a text": ["XQ #S"],
    "data mode": ["XQ #A", "CI ,,1"],
}
ON_THE_LINE = {  # what the line carries behind the link's back
    "command mode": b"",
    "half-typed line": b"PR 100",
    "half-typed begin": b"BG",
    "XOFF": b"\x13",
    "port busy": b"WT 2000\r",
}
LINE_STATES = (*TYPED, *ON_THE_LINE)
MOTION = {"still": "", "move": "PR 4000000;SP 100000;BG X", "jog": "JG 50000;BG X"}


def set_up(motion: str, **more: object) -> Bench:
    bench = Bench("ssc4", **more).ready()
    bench.result(bench.controller.download(PROGRAM).future)
    bench.ask("SH")
    if MOTION[motion]:
        bench.ask(MOTION[motion])
    return bench


def put_into(bench: Bench, state: str) -> None:
    for line in TYPED.get(state, []):
        bench.result(bench.controller.ask(line))
    bench.simulation.receive(1, ON_THE_LINE.get(state, b""))
    bench.simulation.advance(1_024_000 // 10)


@pytest.mark.parametrize("motion", MOTION)
@pytest.mark.parametrize("state", LINE_STATES)
def test_everything_stands_still_and_no_stop_is_in_the_program(state: str, motion: str) -> None:
    bench = set_up(motion)
    put_into(bench, state)
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED, 8.0)
    assert bench.still()
    held = bench.result(bench.controller.upload().future)
    assert "ST" not in [part.strip() for line in held.splitlines() for part in line.split(";")]


@pytest.mark.parametrize("motion", MOTION)
def test_from_a_known_command_mode_only_the_plain_stop_is_sent(motion: str) -> None:
    bench = set_up(motion)
    bench.run(0.3)
    bench.sent.clear()
    bench.controller.stop()
    bench.run(0.02)
    assert bytes(bench.sent).startswith(b"ST\r")


def test_the_table_of_bytes() -> None:
    assert stop_bytes(True) == b"ST\r"
    assert stop_bytes(False) == b"\x11\x1b\x5cST\rST\r"
    assert stop_bytes(True, chained=True) == b"!ST\r"
    assert stop_bytes(False, abort=True) == b"\x11\x1b\x5cAB\rAB\r"


def test_queued_commands_fail_as_stopped_and_never_leave() -> None:
    bench = set_up("jog")
    queued = [bench.controller.ask(f"SP {speed}") for speed in (1000, 2000, 3000)]
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED)
    for future in queued:
        with pytest.raises(Exception, match="STOP was pressed"):
            future.result(0)
    assert b"SP 2000" not in bench.sent


def test_a_second_press_aborts() -> None:
    bench = set_up("jog")
    bench.ask("DC 1024")
    bench.controller.stop()
    bench.run(0.3)
    assert not bench.still()
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED, 2.0)
    assert bench.still()
    assert b"AB\r" in bench.sent


def test_no_stillness_within_the_stopping_time_aborts() -> None:
    bench = set_up("jog")
    bench.ask("DC 1024")
    bench.controller.stopping_time_s = 0.5
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED, 3.0)
    assert b"AB\r" in bench.sent


def held_by_cts(bench: Bench) -> None:
    """The driver takes what fits into its buffer, and nothing of it leaves."""
    held = bytearray()

    def write(data: bytes) -> int:
        held.extend(data)
        return len(data)

    bench.loopback.write = write  # type: ignore[method-assign]
    bench.loopback.unsent = lambda: len(held)  # type: ignore[method-assign]
    bench.loopback.discard_output = held.clear  # type: ignore[method-assign]


SILENT = {
    "cable out": lambda bench: setattr(bench.loopback, "unplugged", True),
    "controller off": lambda bench: bench.simulation.stimulus("reset", 0),
    "CTS held": held_by_cts,
}


@pytest.mark.parametrize("silence", SILENT)
@pytest.mark.parametrize("state", ["command mode", "running program", "XOFF"])
def test_without_an_answer_it_is_not_confirmed_within_half_a_second(state: str, silence: str) -> None:
    bench = set_up("jog")
    put_into(bench, state)
    SILENT[silence](bench)
    start = bench.loopback.clock()
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.NOT_CONFIRMED, 1.0)
    assert bench.loopback.clock() - start <= 0.51


def test_during_a_burn_it_is_not_confirmed_and_confirmed_afterwards() -> None:
    bench = set_up("still")
    bench.simulation.receive(1, b"BP\r")
    bench.simulation.advance(1_024_000 // 20)
    start = bench.loopback.clock()
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is not StopState.STOPPING, 1.0)
    assert bench.controller.stop_state is StopState.NOT_CONFIRMED
    assert bench.loopback.clock() - start <= 0.51
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED, 15.0)
    assert bench.still()


def test_without_a_link_it_never_claims_anything() -> None:
    bench = Bench("ssc4")
    bench.controller.stop()
    assert bench.controller.stop_state is StopState.NOT_CONFIRMED


def test_a_program_that_takes_every_line_as_an_answer_is_not_called_stopped() -> None:
    """`IN` of a text in a tight loop is waiting again before a second ST is complete at 19200 baud."""
    bench = set_up("still")
    bench.result(bench.controller.ask("XQ #T"))
    bench.run(0.2)
    bench.controller.stop()
    bench.run(1.0)
    assert not bench.still()
    assert bench.controller.stop_state is StopState.NOT_CONFIRMED


def test_a_long_deceleration_is_waited_for_and_not_cut_short() -> None:
    """50 000 counts/s with DC 16 384 take 3.05 s to stop."""
    bench = set_up("jog")
    bench.run(1.0)
    bench.ask("DC 16384")
    bench.controller.stop()
    start = bench.loopback.clock()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED, 6.0)
    assert bench.loopback.clock() - start > 2.5
    assert b"AB\r" not in bench.sent
    assert bench.still()


def test_pressed_again_long_after_an_unconfirmed_stop_it_stops_gently() -> None:
    bench = set_up("jog")
    bench.loopback.unplugged = True
    bench.controller.stop()
    bench.run(20.0)
    assert bench.controller.stop_state is StopState.NOT_CONFIRMED
    bench.loopback.unplugged = False
    bench.run(5.0)
    bench.sent.clear()
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED)
    assert b"AB\r" not in bench.sent


def test_after_the_next_command_the_button_is_ready_again() -> None:
    bench = set_up("still")
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED)
    bench.ask("TPX")
    assert bench.controller.stop_state is StopState.STOPPED
    bench.ask("SH")
    assert bench.controller.stop_state is StopState.READY


def coordinated(bench: Bench) -> None:
    bench.ask("LM XY")
    bench.ask("LI 400000,300000;LE")
    bench.ask("VS 20000;BGS")


def geared(bench: Bench) -> None:
    """Y follows the auxiliary encoder of X, which somebody turns."""
    bench.ask("GA DX")
    bench.ask("GR ,2")
    bench.simulation.stimulus("aux_speed_x", 5000)


def contoured(bench: Bench) -> None:
    bench.ask("CM X")
    bench.ask("DT 8;CD 20000")


@pytest.mark.parametrize("moving", [coordinated, geared, contoured])
def test_other_kinds_of_motion_stand_still_too(moving: Callable[[Bench], None]) -> None:
    bench = set_up("still", plants={"X": Plant(auxiliary=Place.EXTERNAL)})
    moving(bench)
    bench.run(0.1)
    before = [axis["commanded"] for axis in bench.simulation.state()["axes"].values()]
    bench.run(0.05)
    assert [axis["commanded"] for axis in bench.simulation.state()["axes"].values()] != before
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED, 8.0)
    before = [axis["commanded"] for axis in bench.simulation.state()["axes"].values()]
    bench.run(0.5)
    assert [axis["commanded"] for axis in bench.simulation.state()["axes"].values()] == before
    assert bench.still()


@pytest.mark.parametrize("starts", ["SH", "OF 1", "MT -1", "SB 1", "PR 100", "XQ", "SP 5000;BG X"])
def test_a_confirmed_stop_stands_until_something_may_begin(starts: str) -> None:
    bench = set_up("jog")
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED, 2.0)
    for command in ("MO", "SP 2000;KP 7", "KPX=6;FL 5000;OE 1", "ST;HX", "TP"):
        bench.ask(command)
        assert bench.controller.stop_state is StopState.STOPPED
    bench.result(bench.controller.ask(starts))
    assert bench.controller.stop_state is StopState.READY
