"""Threads, trippoints, subroutines, automatic routines and what they cost in time."""

from __future__ import annotations

import pytest

from device.simulator.plant import Plant
from tests.device.simulator.bench import MS, SAMPLE, Bench

COMMAND_MS = 0.5  # dmc-1412-1414.txt l.1351


def variable(bench: Bench, name: str) -> float:
    return bench.simulation.unit.state.variables[name] / 65536


def test_a_command_takes_half_a_millisecond() -> None:
    bench = Bench()
    bench.load("#A\nN=N+1\nJP#A")
    bench.simulation.unit.state.variables["N"] = 0
    bench.simulation.execute("#A")
    bench.wait(1000)
    assert variable(bench, "N") == 1000  # two commands, 1 ms, a turn


def test_threads_are_served_in_turn_and_share_the_time() -> None:
    bench = Bench()
    bench.load("#A\nXQ#B,1\nXQ#C,2\n#L\nN=N+1\nJP#L\n#B\nM=M+1\nJP#B\n#C\nK=K+1\nJP#C")
    bench.type("N=0;M=0;K=0\r")
    bench.simulation.execute("#A")
    bench.wait(3000)
    counts = [variable(bench, name) for name in "NMK"]
    assert max(counts) - min(counts) <= 2
    assert sum(counts) == pytest.approx(3000, abs=10)


@pytest.mark.parametrize(("model", "threads"), [("ssc4", 4), ("dmc1412", 2)])
def test_number_of_threads(model: str, threads: int) -> None:
    bench = Bench(model)
    bench.load("#A;JP#A")
    for number in range(threads):
        assert bench.ask(f"XQ#A,{number}") == ""
    assert bench.refused(f"XQ#A,{threads}") == 6
    assert bench.refused("XQ#A,1") == 19
    assert bench.ask("MG _HX0{F1.0},_XQ1{F3.0}") == " 1 000"
    bench.ask("HX1")
    assert bench.ask("MG _HX1{F1.0},_XQ1{F1.0}") == " 0-1"


def test_wait_is_counted_in_samples() -> None:
    bench = Bench()
    bench.load("#A\nSB1\nWT 100\nCB1\nEN")
    bench.simulation.execute("#A")
    bench.simulation.advance(512)  # SB1 at tick 512
    assert bench.simulation.unit.state.outputs == 1
    bench.simulation.advance(512 + 100 * SAMPLE - 1024)
    assert bench.simulation.unit.state.outputs == 1
    # WT at tick 1024, in sample 1: over with sample 101, and CB1 half a millisecond later
    bench.simulation.advance(101 * SAMPLE + 512 - bench.simulation.ticks - 1)
    assert bench.simulation.unit.state.outputs == 1
    bench.simulation.advance(1)
    assert bench.simulation.unit.state.outputs == 0


def test_at_makes_a_period_without_drift() -> None:
    bench = Bench("dmc1412")  # dmc-1412-1414.txt l.2644-2652
    bench.load("#A\nAT0\n#L\nAT 10\nSB1\nAT -40\nCB1\nT=TIME\nN=N+1\nJP#L,N<100\nEN")
    bench.type("N=0\r")
    bench.simulation.execute("#A")
    bench.simulation.run_until_idle(10_000 * MS)
    start = variable(bench, "T") - 4000
    assert 0 <= start <= 25


def test_time_words_follow_tm() -> None:
    bench = Bench()
    bench.ask("TM 2000")
    bench.load("#A\nT=TIME\nWT 100\nT=TIME-T\nEN")
    bench.simulation.execute("#A")
    before = bench.simulation.ticks
    bench.simulation.run_until_idle(10_000 * MS)
    assert variable(bench, "T") in (100, 101)
    assert (bench.simulation.ticks - before) / 1024 == pytest.approx(200 * 1000 / 1024, abs=4)


def test_subroutines_eight_deep_and_no_deeper() -> None:
    bench = Bench()
    bench.load('#A;JS#S;MG "UP";EN\n#S;N=N+1;JS#S,N<8;EN')
    bench.type("N=0;XQ#A\r")
    bench.wait(200)
    assert bench.texts() == ["UP"]
    bench.load("#A;JS#S;EN\n#S;N=N+1;JS#S,N<9;EN")
    bench.type("N=0;XQ#A\r")
    bench.wait(200)
    assert bench.texts()[-1] == "?001 #S;N=N+1;JS#S,N<9;EN"
    assert bench.ask("TC1") == "12 Subroutine more than 8 deep"


def test_zs_drops_returns() -> None:
    bench = Bench()
    assert bench.run('#A;JS#S;MG "BACK";EN\n#S;JS#T;MG "S";EN\n#T;Z=_ZS0;ZS1;Y=_ZS0;EN') == "end"
    assert (variable(bench, "Z"), variable(bench, "Y")) == (2, 1)
    assert bench.texts() == ["BACK"]


def test_an_error_stops_only_its_thread() -> None:
    bench = Bench()
    bench.load('#A\nXQ#B,1\n#L\nN=N+1\nJP#L\n#B\nWT 5\nPR 99999999999\nMG "NEVER"\nEN')
    bench.type("N=0\r")
    bench.simulation.execute("#A")
    bench.wait(100)
    assert bench.texts() == ["?007 PR 99999999999"]
    assert bench.simulation.errors[0]["thread"] == 1
    assert bench.simulation.errors[0]["code"] == 6
    assert bench.ask("MG _ED{F3.0}") == " 007"
    assert bench.simulation.unit.state.threads[0].running


def test_tc_reads_once_and_its_operand_often() -> None:
    bench = Bench()
    bench.type("bg\r")
    assert bench.ask("MG _TC{F3.0}") == " 001"
    assert bench.ask("MG _TC{F3.0}") == " 001"
    assert bench.ask("TC") == "001"
    assert bench.ask("TC") == "000"


def test_undefined_label_and_bad_line() -> None:
    bench = Bench()
    bench.load("#A;EN")
    assert bench.refused("XQ#B") == 10
    assert bench.refused("XQ 5") == 11
    assert bench.refused("JP#A") == 2
    assert bench.run("#A;JP#NO") == "error"
    assert bench.simulation.errors[-1]["code"] == 10


def test_program_only_and_port_only_commands() -> None:
    bench = Bench()
    for command in ("JP#A", "EN", "RE", "RI", "ZS", 'IN "X",Y'):
        assert bench.refused(command) == 2
    for command in ("DL", "UL", "LS", "ED", "BP", "RS"):
        bench.run(f"#A;{command};EN")
        assert bench.simulation.errors[-1]["code"] == 3, command


@pytest.mark.parametrize(("model", "goes_on"), [("dmc1412", True), ("ssc2", False)])
def test_bare_stop_in_a_program(model: str, goes_on: bool) -> None:
    bench = Bench(model)  # dmc-1412-1414.txt l.2814: the program goes on; SSC: programs end too
    bench.run('#A\nJG 1000\nBGX\nWT 50\nST\nAM\nMG "ON"\nEN')
    assert (bench.texts() == ["ON"]) is goes_on
    assert not bench.simulation.unit.moving()


@pytest.mark.parametrize("model", ["dmc1412", "ssc2"])
def test_bare_stop_from_the_port_ends_programs(model: str) -> None:
    bench = Bench(model)  # dmc-1412-1414.txt l.2516
    bench.load("#A\nJG 1000\nBGX\n#L;JP#L")
    bench.simulation.execute("#A")
    bench.wait(100)
    bench.type("STX\r")
    assert bench.simulation.unit.running()
    bench.type("ST\r")
    assert not bench.simulation.unit.running()


def test_trace() -> None:
    bench = Bench()
    bench.run("#A\nTR1\nV=1;W=2\n#B\nTR0\nEN")
    assert bench.texts() == ["002 V=1;W=2", "003 #B", "004 TR0"]  # each line (dmc-1412-1414.txt l.2672)


def test_input_takes_numbers_and_texts_from_port_one() -> None:
    bench = Bench()
    bench.load('#A\nIN "LENGTH",L\nIN "NAME",N{S4}\nMG L{F4.1},N{S}\nIN "AGAIN",L\nMG L\nEN')
    bench.type("XQ#A\r")
    assert bench.type("12.5\r") == "NAME"  # an answer has no prompt
    assert bench.type("WIRECUT\r") == " 0012.5WIRE\r\nAGAIN"
    assert bench.type("\r") == " 0000000012.5000\r\n"  # an empty answer keeps the old value
    assert bench.texts() == ["LENGTH", "NAME", " 0012.5WIRE", "AGAIN", " 0000000012.5000"]


def test_a_bad_answer_is_error_83_in_thread_0() -> None:
    bench = Bench()
    bench.load('#A\nIN "LENGTH",L\nEN')
    bench.type("XQ#A\r")
    assert bench.type("abc\r") == '?001 IN "LENGTH",L\r\n'
    assert bench.ask("TC1") == "83 Not a valid number"


def test_input_only_in_thread_0() -> None:
    bench = Bench()
    bench.load('#A\nIN "LENGTH",L\nEN')
    bench.type("XQ#A,1\r")
    assert bench.simulation.errors[-1]["code"] == 71


def test_wire_cutter() -> None:
    bench = Bench("dmc1412")  # dmc-1412-1414.txt l.4025-4035
    bench.load("#A\nAI1\nPR 6370\nSP 3185\nBG\nAM\nSB1\nWT 20\nCB1\nWT 80\nJP #A")
    bench.simulation.stimulus("in1", 0)
    bench.simulation.execute("#A")
    bench.wait(100)
    assert bench.position() == 0
    assert bench.simulation.state()["threads"][0]["waiting_for"] == "AI"
    for cut in (1, 2):
        bench.simulation.stimulus("in1", 1)
        bench.wait(10)
        bench.simulation.stimulus("in1", 0)
        # SP 3185 becomes 3184; 6370 counts at 3184 counts/s, ramps of 3184/256000 s
        seconds = 6370 / 3184 + 3184 / 256000
        bench.wait(seconds * 1000 + 5)
        assert bench.simulation.unit.state.outputs == 1
        assert bench.position() == cut * 6370
        bench.wait(25)
        assert bench.simulation.unit.state.outputs == 0
        bench.wait(100)
        assert bench.simulation.unit.running()


def test_limit_routine_is_called_while_driven_into_the_switch() -> None:
    bench = Bench("dmc1412", plants={"X": Plant(forward_limit=2000)})
    bench.load('#A\nJG 5000;BG\n#L;JP#L\n#LIMSWI\nMG "LIMIT",_SC{F2.0}\nRE')  # l.2988-2995
    bench.simulation.execute("#A")
    bench.wait(1000)
    assert bench.texts()[0] == "LIMIT 02"
    assert 2000 <= bench.position() <= 2100
    assert bench.refused("JG 100;BG") == 22
    assert bench.ask("JG -100;BG") == ":"


def test_position_error_routine() -> None:
    bench = Bench("dmc1412")
    bench.load('#A\nER 200;OE1\n#L;JP#L\n#POSERR\nMG "ERR",_SC{F2.0}\nWT 10\nSH\nRE')  # l.3008-3019
    bench.simulation.execute("#A")
    bench.wait(50)
    bench.simulation.stimulus("position_x", 500)
    bench.wait(500)
    assert bench.texts()[0] == "ERR 08"
    assert bench.simulation.state()["axes"]["X"]["motor_on"]
    assert bench.simulation.unit.state.threads[0].stack == []


def test_input_interrupt_is_armed_again_by_ri() -> None:
    bench = Bench("dmc1412")
    bench.load('#A\nII1\n#L;JP#L\n#ININT\nMG "INT"\n#W;JP#W,@IN[1]=0\nRI')  # l.3030-3042
    bench.simulation.execute("#A")
    bench.wait(20)
    assert bench.ask("TB") == "136"  # program running, interrupt enabled
    for count in (1, 2):
        bench.simulation.stimulus("in1", 0)
        bench.wait(20)
        assert bench.texts() == ["INT"] * count
        assert bench.ask("TB") == "132"  # in the interrupt routine
        bench.simulation.stimulus("in1", 1)
        bench.wait(20)


@pytest.mark.parametrize(("end", "time"), [("RI", 150), ("RI1", 500)])
def test_an_interrupted_trippoint_is_cleared_or_kept(end: str, time: int) -> None:
    bench = Bench("dmc1412")  # SSC manual: cleared unless RI1
    bench.load(f"#A\nII1\nWT 500\nT=TIME\n#L;JP#L\n#ININT\n{end}")
    bench.simulation.execute("#A")
    bench.samples(100)
    bench.simulation.stimulus("in1", 0)
    bench.samples(2)
    bench.simulation.stimulus("in1", 1)
    bench.samples(1000)
    assert variable(bench, "T") == pytest.approx(time, abs=50)


def test_mc_times_out() -> None:
    bench = Bench("dmc1412", plants={"X": Plant(coulomb_friction=100.0)})
    bench.run('#A\nTW 200\nPA 1000\nBG\nMC\nMG "END"\nEN\n#MCTIME\nMG "X Fell Short",_SC{F3.0}\nEN')  # l.3051
    assert bench.texts() == ["X Fell Short 099", "END"]


def test_command_error_routine_of_the_manual() -> None:
    bench = Bench("dmc1412")  # l.3069-3091
    bench.load(
        '#BEGIN\nIN "ENTER SPEED", SPEED\nJG SPEED;BG;\nJP #BEGIN\nEN\n#CMDERR\nJP#DONE,_ED<>2\nJP#DONE,_TC<>6\n'
        'MG "SPEED TOO HIGH"\nMG "TRY AGAIN"\nZS1\nJP #BEGIN\n#DONE\nZS0\nEN'
    )
    bench.type("XQ#BEGIN\r")
    bench.type("9000000\r")
    assert bench.texts() == ["ENTER SPEED", "SPEED TOO HIGH", "TRY AGAIN", "ENTER SPEED"]
    bench.type("5000\r", ms=200)
    assert bench.simulation.unit.moving()
    assert [error["handled"] for error in bench.simulation.errors] == [True]


def test_communication_interrupt_on_port_two() -> None:
    bench = Bench("dmc1412")  # l.3576-3636
    bench.load('#A\nCI ,2\n#L;JP#L\n#COMINT\nMG "GOT",P2CH{S1}\nEN,1')
    bench.simulation.execute("#A")
    bench.wait(10)
    for letter in "XS":
        bench.simulation.stimulus("type2", letter)
        bench.wait(10)
    assert bench.texts() == ["GOTX", "GOTS"]


def test_operator_data_of_port_one() -> None:
    bench = Bench("dmc1412")  # l.3529-3562
    bench.load("#A\nCI 0,0,1\n#W;JP#W,P1CD<2\nS=P1CD;N=P1NM;T=P1CD\nEN")
    bench.type("XQ#A\r")
    bench.type("12")
    assert bench.simulation.unit.running()
    bench.type(".5\r")
    assert [variable(bench, name) for name in "SNT"] == [3, 12.5, 0]
    assert bench.type("TP\r") == ""  # still data
    assert bench.type("\x1bTP\r") == " 0000000000\r\n:"  # ESC leaves the mode


@pytest.mark.parametrize("slice_ms", [None, 1, 37])
def test_a_run_ends_at_an_error_that_nothing_handles(slice_ms: int | None) -> None:
    bench = Bench()
    bench.load("#A\nXQ #T,1\n#L;JP #L\n#T\nWT 10\nSP 99999999\nEN")
    bench.simulation.execute("#A")
    end = "time"
    while end == "time" and bench.simulation.ticks < 10_000 * MS:
        end = bench.simulation.run_until_idle(10_000 * MS if slice_ms is None else slice_ms * MS)
    assert end == "error"
    assert bench.simulation.ticks / MS == pytest.approx(11, abs=2)


def test_a_message_without_line_end_is_told_too() -> None:
    bench = Bench("ssc1")
    bench.run('MG "A"{N}\nMG "B"\nMG "C"{N}\nMG {P2}"D"{N}\nEN')
    state = bench.simulation.state()
    assert [(port, text) for _, port, text in state["messages"]] == [(1, "AB"), (1, "C"), (2, "D")]
