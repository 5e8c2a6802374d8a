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
    assert bench.simulation.notices[0].startswith("the EEPROM file can not be written")
    bench.type("\x12\x13", ms=1100)
    assert bench.ask("KP?") == " 0006.00"
