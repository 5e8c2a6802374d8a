"""Settings of motion, expressions and programs: each does what it says; the expected values are worked out here."""

from __future__ import annotations

from typing import Any

import pytest

from device.simulator.plant import Plant
from device.simulator.simulation import Simulation
from tests.device.simulator.bench import Bench
from tests.device.simulator.test_profile import bench_with


def with_plant(plant: Plant, name: str = "ssc2", **settings: Any) -> Bench:
    """A bench with a machine on X."""
    bench = bench_with(name, **settings)
    unit = bench.simulation.unit
    bench.simulation = Simulation(unit.model, {"X": plant}, profile=unit.profile)
    return bench


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


# ------------------------------------------------------------------- limits


@pytest.mark.parametrize(
    ("rule", "at_position", "at_begin"),
    [
        ("PA, PR, IP: error 6", 6, 0),
        ("PA, PR, IP: error 22", 22, 0),
        ("BG, IP: error 22", 0, 22),
        ("not refused", 0, 0),
    ],
)
def test_a_target_behind_a_software_limit(rule: str, at_position: int, at_begin: int) -> None:
    # dmc-1412-1414.txt l.4135: "will not accept position commands beyond the limit. Motion beyond the limit is also
    # prevented."
    bench = bench_with(target_beyond_limit=rule)

    def code(line: str) -> int:
        return 0 if bench.type(line + "\r").endswith(":") else int(bench.ask("TC"))

    bench.type("DP 0;FL 2000;BL -2000;SP 10000\r")
    for line in ("PA 2001", "PR 2001", "PA -2001", "PR -2001"):
        assert code(line) == at_position, line
        if not at_position:
            assert code("BG X") == at_begin, line
            bench.wait(1000)
            if not at_begin:
                assert code("PA 0;BG X") == 0
                bench.wait(1000)
    assert code("PA 2000") == 0 and code("BG X") == 0
    bench.wait(1000)
    assert bench.position() == 2000
    refused = at_position or at_begin
    assert code("IP 1") == refused
    bench.wait(1000)
    bench.type("FL 1000\r")  # the axis stands outside now: the way back is free
    assert code("PR 10") == at_position
    assert code("PR -500") == 0 and code("BG X") == 0
    bench.wait(1000)
    assert bench.position() == (1500 if refused else 1501)


def test_the_manuals_example_of_software_limits() -> None:
    # dmc-1412-1414.txt l.4140-4146: the motor jogs forward until it is stopped by the software limit at position 2000
    bench = Bench("dmc1412")
    bench.type("DP0;BL -2000;FL 2000;JG 2000;BG\r", 1500)
    assert bench.ask("SC") == "002"
    # passed in the sample after 2000, and down from 2000 counts/s at 256 000: 2000²/512000 = 8 counts more
    assert 2000 < bench.position() <= 2000 + 2 + 8 + 2
    assert bench.refused("BG") == 22
    # SSC manual l.2605: "If the limit is exceeded during motion, motion on that axis will decelerate to a stop"
    assert bench.type("JG -2000;BG\r", 100) == "::"
    bench.type("ST\r", 100)
    assert bench.type("SP 2000;PA 2500;BG\r", 1500) == ":::"
    assert 2000 < bench.position() <= 2012 and bench.ask("SC") == "002"


def test_limits_with_cn_1() -> None:
    for rule, shown in (("level", " 0"), ("not active", " 1")):
        bench = bench_with(limit_operand=rule)
        bench.type("CN 1\r")
        bench.simulation.stimulus("fls_x", 0)  # low: not active with CN 1
        bench.wait(5)
        assert bench.ask("MG _LFX{F1.0}") == shown


# ------------------------------------------------------------------- motion


def test_begin_of_several_axes() -> None:
    for whole in (True, False):
        bench = bench_with(begins_as_a_whole=whole)
        bench.type("MO Y;PR 1000,1000\r")
        assert bench.refused("BG XY") == 20
        bench.wait(500)
        assert bench.position() == (0 if whole else 1000)


def test_speeds_of_homing() -> None:
    # dmc-1412-1414.txt l.2323: "the slew speed specified by the JG or SP commands"
    for rule, line, speed in (
        ("last of JG and SP", "SP 4000;JG 6000", 6000),
        ("last of JG and SP", "JG 6000;SP 4000", 4000),
        ("last of JG and SP", "SP 4000;JG -6000", 6000),
        ("SP", "SP 4000;JG 6000", 4000),
        ("JG", "JG 6000;SP 4000", 6000),
    ):
        bench = bench_with(home_speed=rule)
        bench.type(f"{line};HM X;BG X\r", 200)
        assert abs(bench.simulation.unit.motion.commanded_velocity(0)) == speed, (rule, line)
    for rule, speed in (("last of JG and SP", 6000), ("SP", 4000), ("JG", 6000)):
        bench = bench_with(index_speed=rule)
        bench.type("SP 4000;JG 6000;FI X;BG X\r", 100)
        assert bench.simulation.unit.motion.commanded_velocity(0) == speed
    bench = bench_with()
    bench.type("SP 4000;JG 6000;FE X;BG X\r", 200)  # SSC manual l.1303: FE at SP
    assert abs(bench.simulation.unit.motion.commanded_velocity(0)) == 4000


def test_the_speed_of_homing_may_change() -> None:
    # of itself HM goes at SP, whatever JG was
    bench = bench_with()
    bench.type("SP 4000;JG 6000;HM X;BG X\r", 200)
    bench.type("SP 8000\r", 200)
    assert abs(bench.simulation.unit.motion.commanded_velocity(0)) == 8000


def test_the_end_of_homing() -> None:
    plant = Plant(index_at=-1900.0, viscous_friction=0.004, home_switch=(-1e9, -2000.0))
    for rule in ("at once", "decelerates"):
        bench = with_plant(plant, home_end=rule)
        bench.type("KP 20;KD 200;SP 500;AC 1000000;DC 1024;HM X;BG X\r", 8_000)
        assert bench.ask("SC X") == "010" and not bench.simulation.unit.motion.moving(0)
        # 256 counts/s down at 1024 counts/s²: 256²/2048 = 32 counts behind the index
        place = bench.position()
        assert place == 0 if rule == "at once" else 30 <= place <= 34


def test_rounding_of_rp() -> None:
    for rule, shown in (("nearest", 1), ("down", 0)):
        bench = bench_with(reference_rounding=rule)
        bench.type("AC 1024;SP 2;JG 2;BG X\r", 0)
        bench.samples(400)  # 2 counts/s for 400/1024 s, from the second sample on: 0.78 counts
        assert bench.position() == shown


def test_the_tail_of_a_smoothed_move() -> None:
    # IT 0.9999: what the filter owes at the end of the profile is far below half a count
    counts = {}
    for tail in (True, False):
        bench = bench_with(smoothing_tail=tail)
        bench.type("IT 0.9961;PR 3000;BG X\r", 0)
        bench.samples(5)
        for _ in range(1000):
            if bench.simulation.unit.motion.moving(0):
                bench.samples(1)
        counts[tail] = bench.simulation.unit.motion.sample
        assert bench.position() == 3000
    assert counts[True] == counts[False] + 1


def test_when_tp_is_read() -> None:
    # a plant without delay follows a jog; behind the sample the encoder is where the next sample finds it
    found = {}
    for rule in ("sample start", "sample end"):
        bench = bench_with(position_read=rule)
        bench.type("JG 100000;BG X\r", 200)
        first = bench.simulation.unit.motion.position(0)
        bench.samples(1)
        found[rule] = (first, bench.simulation.unit.motion.position(0))
    assert found["sample end"][0] == found["sample start"][1]
    assert found["sample start"][0] < found["sample end"][0]


def test_a_distance_that_is_not_reached() -> None:
    for ends in (True, False):
        bench = bench_with(distance_ends_with_move=ends)
        bench.load("#A\nPR 1000;BGX;AD 5000;EN")
        bench.simulation.execute("#A")
        bench.wait(1000)
        assert bench.simulation.unit.running() is not ends
    bench = bench_with(distance_ends_with_move=False)
    bench.load("#A\nN=0;PR 4000;BGX;AD 1000;AR 1000;N=_RPX;AMX;EN")
    bench.simulation.execute("#A")
    bench.wait(1000)
    assert 2000 <= bench.simulation.unit.state.variables["N"] // 65536 < 2000 + 30  # 25 counts a sample and a command


# ---------------------------------------------------------------- sequences


def test_the_plane() -> None:
    assert bench_with().type("VM XY\r") == ":"
    assert bench_with(plane_needs_tangent=True).refused("VM XY") == 50
    assert bench_with(plane_needs_tangent=True).type("VM XYN\r") == ":"


def test_the_ellipse() -> None:
    for rule, x in (("stretches", 3000), ("shrinks", 750)):
        bench = bench_with(ellipse=rule)
        bench.type("VM XY;ES 2,1;VP 1500,1000;VE;BGS\r", 1000)
        assert (bench.position(0), bench.position(1)) == (x, 1000)


def test_the_length_of_a_sequence() -> None:
    for rule, before, inside in (("all segments", 7000, 7000), ("segments to come", 7000, 4000)):
        bench = bench_with(sequence_length=rule)
        bench.type("VS 4000;LM XY;LI 3000,0;LI 0,4000;LE\r", 20)
        assert bench.ask("MG _LE{F5.0}") == f" {before:05d}"
        bench.type("BGS\r", 100)
        assert bench.ask("MG _LE{F5.0}") == f" {inside:05d}"


def test_empty_segments_and_their_speeds() -> None:
    assert bench_with().refused("LM XY;LI 0,0") == 30
    bench = bench_with(empty_segment="left out")
    assert bench.ask("LM XY;LI 0,0;MG _LM{F3.0}").endswith(" 511")
    for stays, speed in ((True, 4000), (False, 10000)):
        bench = bench_with(segment_speed_stays=stays)
        bench.type("VS 10000;LM XY;LI 400,0<4000;LI 9000,0;LE;BGS\r", 400)
        assert bench.simulation.unit.motion.commanded_velocity(0) == speed


def test_contour_refusals() -> None:
    for code in (39, 6):
        assert bench_with(contour_untimed_code=code).refused("CM X;CD 5") == code
    for code in (7, 42):
        assert bench_with(contour_full_code=code).refused("CM X;DT 8;CD 5;CD 5;CD 5") == code


def test_what_the_cam_follows() -> None:
    for rule in ("encoder", "commanded position"):
        bench = bench_with(cam_follows=rule)
        bench.type("EA X;EM 4000,0;EP 1000,0\r")
        for entry, place in enumerate((0, 1000, 2000, 1000, 0)):
            bench.type(f"ET[{entry}]=,{place}\r")
        bench.type("EB1;EG ,-1;MO X\r")
        bench.simulation.unit.motion.push(0, 500.0)  # by hand: only the encoder moves
        bench.wait(20)
        assert bench.position(1) == (500 if rule == "encoder" else 0)


def test_the_phase_operand() -> None:
    for unit, typed, shown in (("degrees", "90", " 090"), ("counts", "500", " 500")):
        bench = bench_with("dmc1412", phase_operand=unit)
        bench.type(f"BA X;BM 2000;BD {typed}\r" if unit == "degrees" else "BA X;BM 2000;BD 500\r")
        assert bench.ask("MG _BD{F3.0}") == shown
        assert bench.simulation.unit.motion.commutation.phase(0) == pytest.approx(90.0)  # 500 of 2000 counts


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
