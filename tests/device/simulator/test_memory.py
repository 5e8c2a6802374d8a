"""Downloads, uploads, lists, the editor and arrays over the wire: a state table of what every mode answers."""

from __future__ import annotations

import pytest

from codegen.models import model
from device.simulator.simulation import Simulation
from device.simulator.times import TICKS
from tests.device.simulator.bench import Bench

PROGRAM = "#A\rPR 700\rSP 2000\rBG\rEN\r"  # dmc-1412-1414.txt l.1003


def test_download_upload_list() -> None:
    bench = Bench("dmc1412")
    assert bench.type("DL\r") == ""
    assert bench.type(PROGRAM) == ""
    assert bench.type("\\") == ":"
    assert bench.type("UL\r") == "#A\r\nPR 700\r\nSP 2000\r\nBG\r\nEN\r\n\x1a:"
    assert bench.type("LS\r") == "000 #A\r\n001 PR 700\r\n002 SP 2000\r\n003 BG\r\n004 EN\r\n:"  # l.2474
    assert bench.type("LS 3\r") == "003 BG\r\n004 EN\r\n:"
    assert bench.type("LS #A,1\r") == "000 #A\r\n001 PR 700\r\n:"


@pytest.mark.parametrize("end", ["\\", "\x1a", "\x11", "\x04"])
def test_every_end_of_a_download(end: str) -> None:
    bench = Bench()
    assert bench.type("DL\r#A\rEN" + end) == ":"
    assert bench.ask("LS") == "000 #A\r\n001 EN"


def test_download_from_a_line_a_label_or_the_end() -> None:
    bench = Bench()
    bench.type("DL\r#A\rEN\r#B\rEN\r\\")
    assert bench.type("DL #\rNO end\r\\") == ":"
    assert bench.ask("LS 4") == "004 NO end"
    assert bench.type("DL #B\r#C\rEN\r\\") == ":"
    assert bench.ask("LS") == "000 #A\r\n001 EN\r\n002 #C\r\n003 EN"
    assert bench.type("DL 1\rWT 1\rEN\r\\") == ":"
    assert bench.ask("LS") == "000 #A\r\n001 WT 1\r\n002 EN"


@pytest.mark.parametrize(
    ("model", "lines", "code"),
    [
        ("dmc1412", ["#A", "NO " + "x" * 38, "EN"], 60),  # 40 characters, l.2425
        ("ssc4", ["NO " + "x" * 78], 60),  # 80 characters
        ("dmc1412", ["NO"] * 251, 60),  # 250 lines, l.2425
        ("ssc4", ["#A", "#A"], 61),
        ("ssc4", ["#1Square"], 61),  # l.2502
        ("dmc1412", [f"#L{n}" for n in range(127)], 62),  # 126 labels, l.2488
    ],
)
def test_what_does_not_fit_is_refused(model: str, lines: list[str], code: int) -> None:
    bench = Bench(model)
    assert bench.type("DL\r" + "\r".join(lines) + "\r\\", ms=200) == "?"
    assert int(bench.ask("TC")) == code


def test_what_just_fits_is_accepted() -> None:
    bench = Bench("dmc1412")
    lines = [f"#L{n}" for n in range(126)] + ["NO" + "x" * 38] * 124
    assert bench.type("DL\r" + "\r".join(lines) + "\r\\", ms=200) == ":"
    assert bench.ask("MG _DL{F3.0}") == " 000"


def test_host_comments_are_left_out_by_the_host_only() -> None:
    bench = Bench()  # dmc-1412-1414.txt l.2588-2616
    bench.load("#A\nREM host only\nNO kept\nEN")
    assert bench.ask("LS") == "000 #A\r\n001 NO kept\r\n002 EN"
    bench.type("DL\r#A\rREM sent as it is\rEN\r\\")
    bench.type("XQ#A\r")
    assert bench.texts() == ["?001 REM sent as it is"]
    assert bench.ask("TC1") == "1 Unrecognized command"


def test_download_and_edit_are_refused_while_a_program_runs() -> None:
    bench = Bench()
    bench.type("DL\r#A;JP#A\r\\")
    bench.type("XQ#A\r")
    for command in ("DL", "ED", "BP", "BN"):
        assert bench.refused(command) == 17
    bench.type("HX\r")
    assert bench.type("DL\r\\") == ":"


def test_the_editor_session_of_the_manual() -> None:
    bench = Bench("dmc1412")  # dmc-1412-1414.txt l.2711-2725
    assert bench.type("ED\r") == "000 "
    assert bench.type("#A\r") == "\r\n001 "
    assert bench.type("PR1000\rBGX\rPR5000\rEN\r") == "\r\n002 \r\n003 \r\n004 \r\n005 "
    assert bench.type("\x11") == "\r\n:"
    assert bench.type("XQ #A\r") == ":?003 PR5000\r\n"
    assert bench.type("TC1\r") == "7 Command not valid while running\r\n:"
    bench.wait(500)
    assert bench.type("ED 3\r") == "003 PR5000"
    assert bench.type("AMX;PR5000;BGX\r") == "\r\n004 EN"
    assert bench.type("\x11") == "\r\n:"
    assert bench.type("DP 0;XQ #A\r") == "::"
    bench.wait(1500)
    assert bench.position() == 6000


def test_editor_keys() -> None:
    bench = Bench()
    bench.type("DL\r#A\rWT 1\rEN\r\\")
    assert bench.type("ED #A\r") == "000 #A"
    assert bench.type("\r") == "\r\n001 WT 1"  # Enter goes on, l.2448
    assert bench.type("\x09") == "\r\n001 "  # ctrl-I inserts a line above, l.2458
    assert bench.type("SB1\r") == "\r\n002 WT 1"
    assert bench.type("\x10") == "\r\n001 SB1"  # ctrl-P goes back, l.2453
    assert bench.type("\x10\x10") == "\r\n000 #A\r\n000 #A"
    assert bench.type("\r\r\x04") == "\r\n001 SB1\r\n002 WT 1\r\n002 EN"  # ctrl-D deletes, l.2463
    assert bench.type("ST") == ""
    assert bench.type("\x11") == "\r\n:"  # the unsaved line is lost, l.2451
    assert bench.ask("LS") == "000 #A\r\n001 SB1\r\n002 EN"


def test_arrays_over_the_wire() -> None:
    bench = Bench()
    bench.type("DM A[4]\r")
    assert bench.type("QD A[]\r") == ""
    assert bench.type("1,2.5,-3\r$10\r\\") == ":"
    assert bench.ask("LZ1") == ""
    assert bench.type("QU A[],0,3,1\r") == " 1.0000, 2.5000,-3.0000, 16.0000\r\n\x1a:"
    assert bench.type("QU A[],1,2,0\r") == " 2.5000\r\n-3.0000\r\n\x1a:"
    assert bench.type("QD A[],2,3\r7,8,9\r\\") == "?"
    assert bench.ask("TC1") == "84 Too many elements"
    assert bench.type("QD A[]\rabc\r\\") == "?"
    assert bench.ask("TC1") == "83 Not a valid number"
    assert bench.refused("QU B[]") == 82


def test_array_space() -> None:
    bench = Bench("dmc1412")
    assert bench.ask("DM?").strip() == "01000"  # dmc-1412-1414.txt l.2691
    assert bench.type("DM POSX[100]\r") == ":"
    assert bench.ask("MG _DM{F4.0},_DA{F1.0}") == " 0900 5"
    assert bench.refused("DM B[901]") == 66
    assert bench.refused("DM POSX[5]") == 57
    for name in "BCDEF":
        bench.ask(f"DM {name}[1]")
    assert bench.refused("DM G[1]") == 67
    assert bench.ask("DM POSX[0]") == ""  # l.3341 frees it
    assert bench.ask("DM G[1]") == ""
    assert bench.refused("V1=G[1]") == 56
    assert bench.refused("V1=H[0]") == 82
    bench.ask("DA *[0]")
    assert bench.ask("MG _DM{F4.0},_DA{F1.0}") == " 1000 6"


def test_variable_space() -> None:
    bench = Bench("dmc1412")
    for number in range(126):  # dmc-1412-1414.txt l.3187
        bench.ask(f"V{number}={number}")
    assert bench.ask("MG _UL{F3.0}") == " 000"
    assert bench.refused("ONEMORE=1") == 67
    assert bench.ask("V3=4") == ""
    bench.ask("DA *")
    assert bench.ask("MG _UL{F3.0}") == " 126"


def test_lists_of_the_dmc1412() -> None:
    bench = Bench("dmc1412")
    bench.type("DL\r#A\rEN\r#BB\rEN\r\\")
    bench.type("LEN=2.5;DM POS[10]\r")
    assert bench.ask("LL") == "#A=0\r\n#BB=2"
    assert bench.ask("LV") == "LEN= 0000000002.5000"
    assert bench.ask("LA") == "POS[10]"


def test_a_program_that_frees_its_arrays_first_can_run_twice() -> None:
    simulation = Simulation(model("ssc1"))
    simulation.load_program("DA POS[]\nDM POS[10]\nPOS[9]=1\nEN")
    for _ in range(2):
        simulation.execute(0)
        assert simulation.run_until_idle(TICKS) == "end"
    assert simulation.state()["arrays"]["POS"] == [0] * 9 + [1]
