"""In Watch only reads without side effects and STOP leave (safety.md, 2)."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen.twoletter.commands import COMMANDS
from device.api import Kind, NotAllowed, State, StopState
from device.door import only_reads
from tests.device.bench import Bench

READS = """TP|TPXY|RP|TE X|TV|TT|TS|TB|TI|SC|RL|KP ?|SP ?,?|PR ,?|V1=|A[3]=|MG _TPX{F10.4}|MG "HELLO",V1|MG TIME
LS|LS 5,9|UL|QU A[],0,5,1|TP;TE|DA ?|MG @AN[1]"""
OTHERS = """TC|TC1|SP 1000|SP 1000,?|BG|ST|AB|SH|MO|XQ|HX|DL|ED|RS|BN|BP|BV|SB 1|V1=5|A[0]=1|TP;BG X|MG P1ST|MG P1NM
MG{P2} "X"|AM|WT 100|DP 0|CI ,,1|JP 0|EO 1|CW 1|EB 1|DM A[5]|tp|%1|!TP|#A|NO TP|MG P2CD|PRX=100|AL"""


@pytest.mark.parametrize("command", READS.replace("\n", "|").split("|"))
def test_reads_may_leave(command: str) -> None:
    assert only_reads(command.encode() + b"\r")


@pytest.mark.parametrize("command", OTHERS.replace("\n", "|").split("|"))
def test_nothing_else_may_leave(command: str) -> None:
    assert not only_reads(command.encode() + b"\r")


def test_control_characters_and_half_lines_may_not_leave() -> None:
    for data in (b"\x12\x13", b"\\", b"\x11", b"TP", b"TP\rBG\r", b"\x1b", b"TP\x12\x13\r"):
        assert not only_reads(data)
    assert only_reads(b"\x12\x16")


@given(st.sampled_from(sorted(COMMANDS)), st.text(alphabet="0123456789,XYZWS- .#A;", max_size=8))
def test_no_command_with_values_passes(name: str, rest: str) -> None:
    told = {"TP", "RP", "TD", "TE", "TV", "TT", "TS", "TB", "TI", "SC", "RL", "LS", "LL", "LV", "LA", "UL", "QU", "MG"}
    line = f"{name}{rest}"
    if only_reads(line.encode() + b"\r"):
        assert name in told or "?" in line or line.strip(" ;") == ""


def test_a_machine_starts_in_watch_and_sends_only_reads() -> None:
    bench = Bench("ssc4", kind=Kind.MACHINE).ready()
    controller = bench.controller
    assert not controller.control
    controller.watch("all", controller.columns)
    controller.take_control()
    controller.release_control()
    for command in ("SP 5000", "BG", "V1=5", "SH", "RS", "DL"):
        with pytest.raises(NotAllowed, match="Watch"):
            bench.result(controller.ask(command))
    for job in (controller.download("#A\nEN").future, controller.execute("A", anyway=True), controller.halt()):
        with pytest.raises(NotAllowed, match="Watch"):
            bench.result(job)
    with pytest.raises(NotAllowed, match="Watch"):
        bench.result(controller.motion.hold("X", 1000, 100_000, 100_000))
    bench.run(3.0)
    for line in bytes(bench.sent).replace(b"\x12\x16", b"").split(b"\r")[:-1]:
        assert only_reads(line + b"\r"), line


def test_typed_reads_work_in_watch() -> None:
    bench = Bench("ssc4", kind=Kind.MACHINE).ready()
    assert bench.ask("TPX") == " 0000000000"
    assert bench.ask("SP ?") == " 00025000"


def test_stop_leaves_in_watch_and_with_a_question_waiting() -> None:
    bench = Bench("ssc4", kind=Kind.MACHINE).ready()
    bench.controller.stop()
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED)
    assert b"ST\r" in bench.sent


def test_simulators_start_in_control() -> None:
    assert Bench("ssc4").ready().controller.control


def test_control_falls_back_after_a_lost_connection_a_restart_and_idling() -> None:
    bench = Bench("ssc4", kind=Kind.MACHINE, idle_limit_s=5.0).ready()
    controller = bench.controller
    controller.take_control()
    bench.run(6.0)
    assert not controller.control
    controller.take_control()
    controller.link.drop("The cable was pulled.")
    assert not controller.control
    assert controller.state is State.LOST
    bench.run_until(lambda: controller.state is State.READY)
    assert not controller.control
    controller.take_control()
    bench.run(3.0)
    bench.simulation.stimulus("reset", 0)
    bench.simulation.stimulus("reset", 1)
    bench.run(4.0)
    assert not controller.control


def test_the_master_reset_never_leaves_as_a_typed_line() -> None:
    bench = Bench("ssc4").ready()
    for line in ("\x12\x13", "TP\x12\x13"):
        with pytest.raises(NotAllowed, match="erases"):
            bench.result(bench.controller.ask(line))


def test_outputs_need_their_own_switch() -> None:
    bench = Bench("ssc4").ready()
    with pytest.raises(NotAllowed, match="I/O control"):
        bench.result(bench.controller.io.set_output(1, True))
    bench.controller.set_io_control(True)
    assert bench.result(bench.controller.io.set_output(1, True)).accepted
    assert bench.simulation.state()["outputs"] & 1


TRIPPOINTS = ["AM", "AM X", "WT 100", "AI 5", "MC X", "BG X;AM X", "AD 100", "PR 5;BG;AS;SB1", "AT 0", " A M"]


@pytest.mark.parametrize("line", TRIPPOINTS)
def test_a_trippoint_typed_by_hand_never_leaves(line: str) -> None:
    """The port would take nothing, STOP included, until it trips (dmc-1412-1414.txt, example 8)."""
    bench = Bench("ssc4").ready()
    bench.ask("SH")
    bench.sent.clear()
    with pytest.raises(NotAllowed, match="STOP included, until it trips; use it in a program"):
        bench.result(bench.controller.ask(line))
    assert line.encode() not in bench.sent


def test_trippoints_in_a_program_are_downloaded() -> None:
    bench = Bench("ssc4").ready()
    assert bench.result(bench.controller.download("#A\nPR 10;BG X;AM X\nWT 5\nEN").future).verified
    for line in ("DL", "#B", "AM", "\\"):
        assert bench.result(bench.controller.ask(line)).accepted


def test_behind_a_trippoint_somebody_else_left_stop_is_not_confirmed_until_it_trips() -> None:
    bench = Bench("ssc4").ready()
    bench.ask("SH;JG 20000;BG X")
    bench.simulation.receive(1, b"AI -5\r")
    bench.run(0.2)
    bench.controller.stop()
    bench.run(2.0)
    assert bench.controller.stop_state is StopState.NOT_CONFIRMED
    bench.simulation.stimulus("in5", 0)
    bench.run_until(lambda: bench.controller.stop_state is StopState.STOPPED)
    assert bench.still()
