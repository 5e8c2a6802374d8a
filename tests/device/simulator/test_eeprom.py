"""Burning, reset and power-up: what survives, and what does not."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from device.simulator.eeprom import Eeprom, EepromUnreadable
from tests.device.simulator.bench import Bench


def test_parameters_survive_a_reset_and_positions_do_not() -> None:
    bench = Bench("ssc2")
    bench.ask("KP 20,30;SP 5000;LZ1;CN1;TM 2000;MOY;DP 77")
    assert bench.type("BN\r", ms=100) == ""  # about 250 ms, SSC manual l.1941
    assert bench.wait(200) == ":"
    bench.ask("KP 1,1;SP 6;LZ0;SHY")
    assert bench.type("RS\r", ms=100) == ""
    assert bench.wait(1000) == ":"
    assert bench.ask("KP ?,?") == " 20.00, 30.00"
    assert bench.ask("SP ?") == " 5000"
    assert bench.ask("TM ?") == " 2000"
    assert bench.ask("MG _MOX{F1.0},_MOY{F1.0}") == " 0 1"
    assert bench.ask("TPX") == " 0"


# Command, question and answer of everything that BN keeps (commands.md, BN contents; SA: dmc-1412-1414.txt l.1308).
BURNED = {
    "ssc2": [
        "AC 102400 AC? 00102400",
        "BL -500 BL? -0000000500",
        "CE 2 CE? 02",
        "CN 1 _LFX*0 0",
        "DC 102400 DC? 00102400",
        "DV 1 DV? 1",
        "ER 500 ER? 00500",
        "FA 10 FA? 0010.00",
        "FL 500 FL? 0000000500",
        "FV 10 FV? 0010",
        "GN 80 GN? 0080",
        "ZR 0.5 ZR? 0.5000",
        "IL 5 IL? 5.0000",
        "IT 0.5 IT? 0.5000",
        "KD 100 KD? 0100.00",
        "KI 2 KI? 0002.000",
        "KP 20 KP? 0020.00",
        "KS 4 KS? 4.000",
        "OE 1 OE? 1",
        "OF 1.25 OF? 1.2500",
        "OP 5 OP? 005",
        "PF 6 PF? 06.0",
        "SP 5000 SP? 00005000",
        "TL 5 TL? 5.0000",
        "TM 2000 TM? 02000",
        "TW 100 TW? 00100",
        "VA 102400 VA? 00102400",
        "VD 102400 VD? 00102400",
        "VF 5.2 VF? 05.2",
        "VS 5000 VS? 00005000",
        "VT 0.5 VT? 0.5000",
        "MO;AF1 AF? 1",
        "MO;MT-1 MT? -1.0",
        "MO _MOX 1",
    ],
    "dmc1412": ["KP 20 KP? 0020.00", "MO _MO 1", "OP 5 OP? 005", "TM 2000 TM? 02000"],
}
# What BN does not keep, with its factory value.
LOST = {
    "ssc2": [
        "PR 500 PR? 0000000000",
        "DP 500 TPX 0000000000",
        "DE 500 TDX 0000000000",
        "GACX;GR,2 _GRY 0",
        "JG 500 JG? 00025000",
        "EAX;EM400;EP50,0 EP? 00256",
        "VR0.5 VR? 01.0000",
    ],
    "dmc1412": ["EM 5,400 EM? 0000000000", "GR 2 GR? 000.0000", "CM;DT 3 DT? 0"],
}


def after_a_burn(controller: str, row: str) -> tuple[str, str]:
    """What is answered after the command was given and burned and the controller reset, and what should be."""
    command, question, wanted = row.rsplit(" ", 2)
    bench = Bench(controller)
    for each in command.split(";"):
        bench.ask(each)
    bench.type("BN\r", ms=400)
    bench.type("RS\r", ms=1200)
    asked = question if "?" in question or question in ("TPX", "TDX") else f"MG {question}{{F1.0}}"
    return bench.ask(asked).strip(), wanted


@pytest.mark.parametrize(("controller", "row"), [(name, row) for name, rows in BURNED.items() for row in rows])
def test_bn_keeps(controller: str, row: str) -> None:
    told, wanted = after_a_burn(controller, row)
    assert told == wanted


@pytest.mark.parametrize(("controller", "row"), [(name, row) for name, rows in LOST.items() for row in rows])
def test_bn_does_not_keep(controller: str, row: str) -> None:
    told, wanted = after_a_burn(controller, row)
    assert told == wanted


def test_bn_keeps_ports_switches_marks_zeros_and_the_address() -> None:
    bench = Bench("dmc1412")
    bench.ask("CC 1200,1,0,1;CN -1,1,1;CW 1,1;LZ 1;EO 0;SA 3;BA X;BM 500;BI 5;BB 30")
    bench.type("BN\r", ms=400)
    bench.type("RS\r", ms=1200)
    state = bench.simulation.unit.state
    assert state.port_two == [1200, 1, 0, 1]
    assert state.switches == [-1, 1, 1]
    assert (state.settings["CW1"], state.settings["CW2"]) == (1, 1)
    assert bench.simulation.unit.address == 3
    assert state.brushless
    assert [state.registers[name][0] // 65536 for name in ("BM", "BI", "BB")] == [500, 5, 30]
    assert bench.ask("LZ?").strip() == "1"


def test_what_is_not_burned_is_lost() -> None:
    bench = Bench()
    bench.ask("KP 20;V1=5")
    bench.load("#A;EN")
    bench.type("RS\r", ms=1100)
    assert bench.ask("KP?") == " 0006.00"
    assert bench.refused("V1=") == 57
    assert bench.type("LS\r") == ":"


def test_program_and_variables_in_a_file_start_by_themselves(tmp_path: Path) -> None:
    file = tmp_path / "unit.eeprom"
    bench = Bench("dmc1412", eeprom=Eeprom(file))
    bench.type('DL\r#AUTO\rMG "UP",LEN{F3.0},POS[1]{F2.0}\rEN\r\\')
    bench.ask("LEN=125;DM POS[3];POS[1]=7")
    assert bench.type("BV\r", ms=2000) == ":"  # variables and arrays, dmc-1412-1414.txt l.3213
    assert bench.type("BP\r", ms=12_000) == ":"
    assert json.loads(file.read_text())["program"][0] == "#AUTO"
    again = Bench("dmc1412", eeprom=Eeprom(file))  # l.2967
    assert again.wait(20) == "UP 125 07\r\n"
    assert not list(tmp_path.glob("*.new"))


def test_reset_restarts_the_clock() -> None:
    bench = Bench()
    bench.wait(5000)
    bench.type("RS\r", ms=1050)
    assert float(bench.ask("MG TIME{F6.0}")) < 200


def test_master_reset_erases_everything() -> None:
    bench = Bench()
    bench.ask("KP 20")
    bench.type("BN\r", ms=300)
    bench.type("\x12\x13", ms=1100)
    assert bench.ask("KP?") == " 0006.00"


def test_a_damaged_file_is_said_in_one_sentence(tmp_path: Path) -> None:
    file = tmp_path / "bad.eeprom"
    file.write_text('{"eeprom": 2}')
    with pytest.raises(EepromUnreadable, match=r"bad.eeprom: not an EEPROM file"):
        Eeprom(file)


def test_a_file_that_can_not_be_written_is_error_15(tmp_path: Path) -> None:
    bench = Bench(eeprom=Eeprom(tmp_path / "no such folder" / "unit.eeprom"))
    assert bench.refused("BN") == 15
    assert bench.simulation.notices[0].startswith("the EEPROM file cannot be written")
    bench.type("\x12\x13", ms=1100)
    assert bench.ask("KP?") == " 0006.00"
