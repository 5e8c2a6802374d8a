"""Settings of expressions, programs and commands: each does what it says; the values are worked out here."""

from __future__ import annotations

import pytest

from tests.device.simulator.test_profile import bench_with

# -------------------------------------------------------------- expressions


def test_brackets() -> None:
    # SSC manual l.2635: parentheses can be nested four deep
    assert bench_with().ask("MG ((((1)))){F1.0}") == " 1"
    assert bench_with().refused("MG (((((1))))){F1.0}") == 59
    assert bench_with(bracket_levels=5).ask("MG (((((1))))){F1.0}") == " 1"
    assert bench_with(bracket_levels=1).refused("MG ((1)){F1.0}") == 59
    assert bench_with(bracket_levels=1).refused("MG @ABS[(1)]{F1.0}") == 59


def test_division() -> None:
    assert bench_with().refused("MG 1/0") == 6
    assert bench_with(division_by_zero="error 9").refused("A=1;B=0;C=A/B") == 9
    bench = bench_with(division_by_zero="largest number", cut="down")
    assert bench.ask("MG 1/0{F10.0}") == " 2147483648"  # 2147483647.99998 to the nearest
    assert bench.ask("MG -1/0{F10.0}") == "-2147483648"
    # a third is 21845.33/65536: cut to -21845 towards zero, to -21846 downwards; times 30000
    assert bench.ask("MG -1/3*30000{F5.2}") == "-10000.31"
    assert bench_with().ask("MG -1/3*30000{F5.2}") == "-09999.85"
    # 3 * -1/65536 / 2 is -1.5/65536: -1 towards zero, -2 downwards
    for cut, units in (("towards zero", -1), ("down", -2)):
        bench = bench_with(cut=cut)
        bench.ask("A=-1/65536;B=A*1.5*65536")
        assert bench.ask("MG B{F2.0}") == f"{units:03d}"


def test_an_axis_assignment() -> None:
    bench = bench_with()
    bench.ask("PRA=500")
    assert bench.ask("MG _PRX{F4.0}") == " 0000" and bench.ask("PRA=") == " 0000000500.0000"
    bench = bench_with(axis_assignment="command")
    bench.ask("PRB=500;SPEED=7")
    assert bench.ask("PR ?,?") == " 0000000000, 0000000500" and bench.ask("SPEED=") == " 0000000007.0000"
    assert bench.refused("PRB=") == 57


# ----------------------------------------------------------------- programs


def test_operands_of_threads() -> None:
    for operand, waits, expected in (
        (True, "the trippoint's", (" 2", " 001")),
        (False, "the trippoint's", (" 1", " 001")),
        (True, "the next command's", (" 2", " 002")),
    ):
        bench = bench_with(waiting_operand=operand, waiting_line=waits)
        bench.load("#A\nWT 500\nEN")
        bench.simulation.execute("#A")
        bench.wait(20)
        assert (bench.ask("MG _HX0{F1.0}"), bench.ask("MG _XQ0{F3.0}")) == expected
    assert bench_with(stack_operand=False).refused("MG _ZS0") == 58
    assert bench_with().ask("MG _ZS0{F1.0}") == " 0"


def test_a_label_that_is_not_there() -> None:
    for code in (10, 11):
        bench = bench_with(unknown_label_code=code)
        assert bench.refused("XQ #NOWHERE") == code
        bench.run("JS #NOWHERE\nEN")
        assert bench.simulation.errors[-1]["code"] == code


@pytest.mark.parametrize("labels", [True, False])
@pytest.mark.parametrize("form", ["000 text", "000text"])
def test_listed_and_traced_lines(labels: bool, form: str) -> None:
    gap = " " if " " in form else ""
    bench = bench_with(trace_labels=labels, listed_line=form)
    bench.load("#A\nV=1\nEN")
    assert bench.type("LS\r") == f"000{gap}#A\r\n001{gap}V=1\r\n002{gap}EN\r\n:"
    bench.type("TR 1\r")
    bench.simulation.execute("#A")
    shown = bench.wait(20)
    assert shown == (f"000{gap}#A\r\n" if labels else "") + f"001{gap}V=1\r\n002{gap}EN\r\n"


def test_the_text_of_in() -> None:
    for ends, sent in ((False, "N"), (True, "N\r\n")):
        bench = bench_with(prompt_ends_line=ends)
        bench.load('#A\nIN "N",V\nEN')
        bench.simulation.execute("#A")
        assert bench.wait(20) == sent


def test_where_cmderr_returns_to() -> None:
    program = "N=0;D=0\nSP 9000000\nD=1\nEN\n#CMDERR\nN=N+1\nJP#X,N>3\nEN\n#X;ZS0\nEN"
    for returns, calls, done in (("next command", 1, 1), ("same command", 4, 0)):
        bench = bench_with(command_error_return=returns)
        bench.run(program, seconds=2)
        variables = bench.simulation.unit.state.variables
        assert (variables["N"] // 65536, variables["D"] // 65536) == (calls, done)


def test_limswi_by_a_software_limit() -> None:
    for calls in (True, False):
        bench = bench_with(software_limit_routine=calls, target_beyond_limit="not refused")
        bench.type("N=0;FL 1000\r")
        bench.load("#A\nSP 10000;PR 5000;BGX;AMX\n#B\nWT 5\nJP#B,_BGX=1\nEN\n#LIMSWI\nN=N+1\nRE")
        bench.simulation.execute("#A")
        bench.wait(1000)
        assert (bench.simulation.unit.state.variables["N"] > 0) is calls
        assert bench.ask("SC X") == "002"


def test_limswi_by_a_switch_does_not_depend_on_it() -> None:
    bench = bench_with(software_limit_routine=False)
    bench.type("N=0\r")
    bench.load("#A\nJG 5000;BGX\n#B\nWT 5\nJP#B,_BGX=1\nEN\n#LIMSWI\nN=N+1\nRE")
    bench.simulation.execute("#A")
    bench.wait(100)
    bench.simulation.stimulus("fls_x", 0)
    bench.wait(500)
    assert bench.simulation.unit.state.variables["N"] > 0


# ---------------------------------------------------------------- commands


def test_what_is_burned() -> None:
    bench = bench_with(commands={"SP": {"burned": False}})
    bench.type("SP 5000;KP 9;BN\r", 400)
    bench.type("RS\r", 1500)
    assert (bench.ask("SP ?"), bench.ask("KP ?")) == (" 00025000", " 09.00".replace("09", "0009"))


def test_data_mode_of_port_1_needs_a_program() -> None:
    # dmc-1412-1414.txt l.3524: "This mode may only be used when executing an applications program"
    for alone in (False, True):
        bench = bench_with(data_mode_alone=alone)
        bench.load("#A\nWT 200\nEN")
        bench.type("CI ,,1\r")
        assert bench.type("MG P1CD{F1.0}\r") == ("" if alone else "-1\r\n:")
        bench.simulation.execute("#A")
        assert bench.type("NO\r") == ""
        bench.wait(300)  # the program has ended
        assert bench.type("NO\r") == ("" if alone else ":")
        assert bench.type("\x1bNO\r") == ":"


def test_the_tangent_beyond_a_turn() -> None:
    # a full circle twice, two counts a degree: 720 degrees on, or back to where one turn begins
    for turns, end in (("unwrapped", 90 + 720), ("within half a turn", 90 + 360)):
        bench = bench_with("ssc4", tangent_turns=turns)
        bench.type("VS 20000;VM XYZ;TN 2,0;CR 500,0,360;CR 500,0,360;VE\r")
        bench.type("PA ,,180;SP ,,8000;BG Z\r", 500)  # _TN: where the first segment begins, 90 degrees
        bench.type("BGS\r", 2000)
        assert bench.ask("SC Z") == "101"
        assert bench.position(2) == 2 * end


def test_the_format_of_qu() -> None:
    for rule, shown in (("VF", " 002.0"), ("10.4", " 0000000002.0000")):
        bench = bench_with(array_format=rule)
        bench.type("DM A[1];A[0]=2;VF 3.1\r")
        assert bench.type("QU A[]\r").startswith(shown + "\r\n")


def test_the_copyright() -> None:
    assert bench_with(copyright="C 1999").ask("CW") == "C 1999"
