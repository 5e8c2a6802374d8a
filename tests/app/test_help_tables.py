"""Connectors and troubleshooting: known pins as the manuals print them, every code has its words."""

from __future__ import annotations

import pytest

from app.help_pages import Pages
from app.help_tables import advice, pages, pin, table
from codegen.twoletter.tables import ERROR_TEXTS, STOP_TEXTS

SIZES = {  # pins that the manuals' headings name
    "J2 Main, 60-pin ribbon cable": 60,
    "J3 Auxiliary encoders, 20-pin ribbon cable": 20,
    "J4 Drives, 20-pin ribbon cable": 20,
    "J5 General inputs and outputs, 26-pin ribbon cable": 26,
    "J3 General, 37-pin D (DMC-1412)": 37,
    "J3 General, screw terminals (DMC-1414)": 40,
    "J5 Power, 7-pin Molex (DMC-1412)": 7,
    "J2 Power, 5-pin (DMC-1414)": 5,
}


@pytest.mark.parametrize(
    ("connector", "number", "signal"),
    [
        ("J2 Main, 60-pin ribbon cable", 3, "Error"),  # ssc l.2585: "the error output (J2, pin 3)"
        ("J2 Main, 60-pin ribbon cable", 20, "Input 1 or latch X"),  # l.966
        ("J2 Main, 60-pin ribbon cable", 24, "Abort input"),  # l.968
        ("J2 Main, 60-pin ribbon cable", 25, "Motor command X"),  # l.1005
        ("J2 Main, 60-pin ribbon cable", 33, "A+ X"),  # l.1006
        ("J2 Main, 60-pin ribbon cable", 56, "I- W"),  # l.984
        ("J2 Main, 60-pin ribbon cable", 60, "Zero volt reference"),  # l.986
        ("J3 Auxiliary encoders, 20-pin ribbon cable", 18, "A+ auxiliary X"),  # l.996
        ("J4 Drives, 20-pin ribbon cable", 13, "PWM or step Z"),  # l.1052: STEP Z 13
        ("J4 Drives, 20-pin ribbon cable", 15, "5 V"),  # l.1048
        ("J5 General inputs and outputs, 26-pin ribbon cable", 19, "Input 7"),  # l.1064
        ("J5 General inputs and outputs, 26-pin ribbon cable", 26, "Input common"),  # l.981
        ("J3 General, 37-pin D (DMC-1412)", 9, "Input 1 and latch (low)"),  # dmc l.4849
        ("J3 General, 37-pin D (DMC-1412)", 21, "Motor command (servo)"),  # l.4842; l.1194 names pin 21 for ACMD too
        ("J3 General, 37-pin D (DMC-1412)", 37, "Abort (low)"),  # l.4861
        ("J3 General, screw terminals (DMC-1414)", 19, "Input 1 or latch"),  # l.4914
        ("J3 General, screw terminals (DMC-1414)", 37, "Motor command"),  # l.4933
    ],
)
def test_known_pins(connector: str, number: int, signal: str) -> None:
    assert pin(connector, number) == signal


def test_every_connector_has_as_many_pins_as_its_name_says() -> None:
    found = {each["title"]: len(each["pins"]) for each in table("wiring")["connector"]}
    assert {title: found[title] for title in SIZES} == SIZES
    assert all(count == 9 for title, count in found.items() if "9-pin" in title)
    assert all(each["lines"] for each in (*table("wiring")["connector"], *table("wiring")["wiring"]))


def test_drives_are_wired_to_pins_that_carry_these_signals() -> None:
    """The tables of drives and of connectors were typed from different figures: they must agree."""
    for wires, connector in (
        ("An Axiom servo drive", "J2 Main, 60-pin ribbon cable"),
        ("An MSD microstepper drive", "J4 Drives, 20-pin ribbon cable"),
    ):
        rows = next(each["rows"] for each in table("wiring")["wiring"] if each["title"] == wires)
        for name, *numbers, _ in rows:
            for letter, number in zip("XYZW", numbers, strict=True):
                signal = pin(connector, int(number))
                own = signal if "olt" in name or "5 V" in name else signal.removesuffix(f" {letter}")
                assert name.lower() in own.lower() and (own is signal or signal.endswith(letter)), (wires, name, signal)


def test_advice_belongs_to_codes_that_exist() -> None:
    told = table("troubleshooting")["advice"]
    assert {int(code) for code in told["error"]} <= set(ERROR_TEXTS)
    assert {int(code) for code in told["stop"]} <= set(STOP_TEXTS)
    assert "AM" in advice("error", 7) and advice("stop", 0) == ""


def test_codes_lead_to_troubleshooting_and_back() -> None:
    shipped = Pages()
    assert set(pages()) <= set(shipped)
    assert "(page:Troubleshooting)" in shipped["Error and stop codes"]
    assert "(page:Error%20and%20stop%20codes)" in shipped["Troubleshooting"]
