"""Gearing, cam, contour, sequences, capture and latch, through their commands."""

from __future__ import annotations

import math

import pytest

from device.simulator.plant import Plant
from tests.device.simulator.bench import Bench

EXTERNAL = {"X": Plant(auxiliary="external")}


def test_gearing_of_the_dmc1412_follows_the_auxiliary_encoder() -> None:
    bench = Bench("dmc1412", plants=EXTERNAL)  # dmc-1412-1414.txt l.1793-1797
    bench.ask("GR 1.132")
    bench.simulation.stimulus("aux_speed_x", 1000)
    bench.wait(1000)
    assert bench.position() == pytest.approx(1.132 * int(bench.ask("LZ1;MG _TDX{F6.0}")[1:]), abs=15)
    assert bench.refused("GA X") == 1


def test_gearing_of_the_ssc() -> None:
    bench = Bench("ssc3")
    bench.ask("GACX;GR ,2,-1")
    bench.ask("PR 1000;BGX")
    bench.wait(500)
    assert (bench.position(1), bench.position(2)) == (2000, -1000)
    assert bench.refused("GR 1") == 46  # an axis cannot follow itself
    bench.ask("STY")
    assert bench.ask("GR ,?,?") == " 000.0000,-001.0000"


def test_cam_of_the_manual() -> None:
    bench = Bench("dmc1412", plants=EXTERNAL)  # dmc-1412-1414.txt l.1811-1879
    for command in ("EM 1500,6000", "EP 2000,0", "ET[0]=0", "ET[1]=3000", "ET[2]=2250", "ET[3]=1500"):
        bench.ask(command)
    assert bench.refused("EG 0") == 105
    bench.ask("EB1;EG -1")
    for master, slave in ((1000, 1500), (2000, 3000), (4000, 2250), (5000, 1875)):
        bench.simulation.stimulus("aux_x", master)
        bench.wait(5)
        assert bench.position() == slave
    assert bench.refused("EP 1000,0") == 100
    assert bench.refused("ET[257]=1") == 101
    bench.ask("EB0")
    assert bench.ask("MG _EB{F1.0}") == " 0"


def test_contour_records_join_without_a_gap() -> None:
    bench = Bench("dmc1412")  # commands.md 11
    bench.load("#A\nCM\nDT 2\nCD 12\nWC\nDT 3\nCD 24\nWC\nDT0;CD0\nAM\nT=TIME\nEN")
    bench.simulation.execute("#A")
    bench.simulation.run_until_idle(10_000_000)
    assert bench.position() == 36
    assert bench.simulation.state()["axes"]["X"]["stop_code"] == 51
    assert bench.refused("CD 5") == 41


def test_contour_data_without_a_time_is_error_39() -> None:
    bench = Bench("dmc1412")
    bench.ask("CM")
    assert bench.refused("CD 5") == 39


def test_linear_sequence() -> None:
    bench = Bench("ssc4")
    bench.run("#A\nLMXY\nVS 10000;VA 100000;VD 100000\nLI 1000,2000\nLI 500,500\nLE\nL=_LE\nBGS\nAMS\nEN")
    assert (bench.position(0), bench.position(1)) == (1500, 2500)
    length = bench.simulation.unit.state.variables["L"] / 65536
    assert length == int(math.hypot(1000, 2000) + math.hypot(500, 500))
    assert bench.ask("SCXY") == "101,101"


def test_vector_sequence() -> None:
    bench = Bench("ssc2")
    bench.run("#A\nVMXYN\nVP 1000,0\nCR 500,-90,180\nVE\nBGS\nAMS\nEN")
    assert (bench.position(0), bench.position(1)) == (1000, 1000)


@pytest.mark.parametrize(
    ("commands", "code"),
    [
        (["BGS"], 24),
        (["LMXY", "LI 0,0"], 30),
        (["LMXY", "VP 1,1"], 33),
        (["VMXY", "LI 1,1"], 33),
        (["LMXY", "LI 1,1,1"], 90),
        (["VMXY", "CR 5,0,90"], 6),
        (["LMXY", *["LI 1,1"] * 512], 32),
    ],
)
def test_errors_of_sequences(commands: list[str], code: int) -> None:
    bench = Bench("ssc2")
    for command in commands[:-1]:
        bench.ask(command)
    assert bench.refused(commands[-1]) == code


@pytest.mark.parametrize("command", ["LM XY", "VS 100", "CS", "AV 5"])
def test_the_dmc1412_has_no_sequences(command: str) -> None:
    assert Bench("dmc1412").refused(command) == 1  # commands.md 11


def test_capture_of_the_manual() -> None:
    bench = Bench("dmc1412")  # dmc-1412-1414.txt l.3451-3461
    bench.run(
        "#A\nDM XPOS[300]\nDM XERR[300]\nRA XPOS[],XERR[]\nRD _TP, _TE\nPR 10000\nRC1\nT=TIME\nBG\n"
        '#B;JP #B,_RC=1\nT=TIME-T\nMG "DONE"\nEN'
    )
    arrays = bench.simulation.state()["arrays"]
    assert bench.texts() == ["DONE"]
    assert bench.simulation.unit.state.variables["T"] // 65536 in range(598, 602)  # 300 samples of 2 ms
    assert arrays["XPOS"][0] == 0
    assert max(arrays["XPOS"]) >= 9990
    bench.wait(1)
    assert bench.ask("MG _RD{F3.0}") == " 300"


def test_errors_of_capture() -> None:
    bench = Bench("dmc1412")
    assert bench.refused("RA A[]") == 82
    bench.ask("DM A[10]")
    assert bench.refused("RC1") == 81
    bench.ask("RA A[];RD _TPX")
    assert bench.refused("RC1,11") == 6
    bench.ask("RC8,-10")
    assert bench.refused("RC1") == 80
    bench.wait(6000)
    assert bench.ask("RC?") == " 1"
    bench.ask("RC0")
    assert bench.ask("RC?") == " 0"


@pytest.mark.parametrize("edge", [-1, 1])
def test_latch_captures_at_its_edge(edge: int) -> None:
    bench = Bench("ssc2")  # dmc-1412-1414.txt l.2392-2411
    bench.ask(f"CN,,{edge};ALX;JG 10000;BGX")
    bench.wait(100)
    assert bench.ask("MG _ALX{F1.0}") == " 1"
    bench.simulation.stimulus("in1", 0)
    low = bench.simulation.unit.motion.position(0)
    bench.wait(50)
    bench.simulation.stimulus("in1", 1)
    high = bench.simulation.unit.motion.position(0)
    bench.wait(50)
    assert int(bench.ask("RLX")) == (low if edge == -1 else high)
    assert bench.ask("MG _ALX{F1.0}") == " 0"


@pytest.mark.parametrize("direction", [1, -1])
def test_ap_goes_on_over_the_wrap_of_the_master(direction: int) -> None:
    # SSC manual: AP waits until the position is crossed; with EB1 the master's position starts anew at each cycle, so
    # a place in the next cycle is crossed there and not where the count jumps from 6000 to 0
    for place in (100, 2000, 5990):
        bench = Bench("ssc2")
        bench.type("EA X;EM 6000,0;EP 2000,0;EB1\r")
        start = 5000 if direction > 0 else 1000
        bench.type(f"PR {start};SP 20000;BG X\r", 1500)
        assert bench.position(0) == start
        bench.load(f"#A\nPR {direction * 9000};BGX;AP {place};P=_TPX;R=_RPX;AMX;EN")
        bench.simulation.execute("#A")
        bench.wait(3000)
        variables = bench.simulation.unit.state.variables
        passed = (variables["P"] // 65536 - place) * direction % 6000
        # the way of a sample and of the command behind it at 20 000 counts/s: 20 and 10 counts
        assert 0 <= passed <= 40, (place, variables)
        assert not bench.simulation.unit.running()


def test_ap_outside_the_cycle_clears_at_the_end_of_the_move() -> None:
    bench = Bench("ssc2")
    bench.type("EA X;EM 6000,0;EP 2000,0;EB1\r")
    bench.load("#A\nPR 9000;SP 20000;BGX;AP -50;P=_BGX;EN")
    bench.simulation.execute("#A")
    bench.wait(3000)
    assert bench.simulation.unit.state.variables["P"] == 0
