"""Every error code and stop code is brought about by something, or it is said why the simulator never says it."""

from __future__ import annotations

from pathlib import Path

import pytest

from codegen.models import model
from codegen.twoletter.problems import ERROR_TEXTS, STOP_TEXTS
from device.simulator.eeprom import Eeprom
from tests.device.simulator.bench import Bench
from tests.examples.script import Example, Player, read_examples

CASES = read_examples(Path(__file__).with_name("codes.txt"))
HERE = {14, 15, 62, 112, 114}  # by the tests below, and of test_commutation.py
NEVER = {
    8: "no command of these controllers is only valid while something runs",
    42: "a contour that gets no data waits for it (dmc-1412-1414.txt l.1975)",
    54: "? in a text is text",
    118: "a fault of another board",
}


@pytest.mark.parametrize("case", CASES, ids=str)
def test_code(case: Example) -> None:
    kind, _, number = case.lines.partition(":")
    player = Player(case)
    player.play()
    steps = " ".join(line for _, line in case.steps)
    told = (
        ("refused {} ", '["code"] == {}', "badprogram {}", "port TC1 -> {} ") if kind == "tc" else ("stop_code == {}",)
    )
    assert any(form.format(number) in steps + " " for form in told), "the case does not bring its code about"


def test_every_error_code_is_brought_about_or_has_a_reason() -> None:
    cases = {int(case.lines[3:]) for case in CASES if case.lines.startswith("tc")}
    assert cases | HERE | set(NEVER) == set(ERROR_TEXTS)
    assert not set(NEVER) & (cases | HERE)


def test_every_stop_code_is_brought_about() -> None:
    assert {int(case.lines[3:]) for case in CASES if case.lines.startswith("sc")} == set(STOP_TEXTS)


def test_too_many_labels_is_62() -> None:
    bench = Bench("dmc1412")
    bench.type("DL\r" + "".join(f"#L{number}\r" for number in range(model("dmc1412").labels + 1)) + "\\", ms=200)
    assert bench.ask("TC1") == "62 Too many labels"


def test_an_eeprom_that_can_not_be_written_is_15(tmp_path: Path) -> None:
    bench = Bench("dmc1412", eeprom=Eeprom(tmp_path / "no such folder" / "unit.eeprom"))
    assert bench.refused("BN") == 15


def test_a_damaged_eeprom_is_14_and_factory_values(tmp_path: Path) -> None:
    file = tmp_path / "unit.eeprom"
    bench = Bench("dmc1412", eeprom=Eeprom(file))
    bench.ask("KP 20")
    bench.type("BN\r", ms=500)
    file.write_text(file.read_text().replace("1310720", "1310721"))  # KP 20 as it is kept
    again = Bench("dmc1412", eeprom=Eeprom(file))
    assert again.ask("TC1") == "14 EEPROM check sum error"
    assert again.ask("KP?") == " 0006.00"
    again.ask("KP 30")
    again.type("BN\r", ms=500)
    whole = Bench("dmc1412", eeprom=Eeprom(file))
    assert whole.ask("KP?") == " 0030.00"
    assert whole.ask("TC") == "000"
