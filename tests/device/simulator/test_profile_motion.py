"""Settings of motion: each does what it says; the expected values are worked out here."""

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
