"""The conformance check: against a simulator that differs in one setting, it finds exactly that one."""

from __future__ import annotations

import random
from typing import Any

import pytest

from codegen.models import model
from codegen.twoletter.commands import COMMANDS
from device.conform import Report, Unfit, conform
from device.conform_checks import RANGES, REFUSED
from device.simulator.simulation import Simulation
from device.simulator.twoletter.profile import DEFAULTS, SETTINGS, Profile
from device.simulator.twoletter.profile_file import profile_text, read_profile
from device.transport.loopback import Loopback
from tests.long import count, is_long

NUMBERS = {"line_characters": 60, "serial_number": 4711, "labels": 200, "bracket_levels": 7}
TEXTS = {"revision": "Rev 1.0i", "copyright": "COPYRIGHT 1998"}
FORMATS = {name: row.reply for name, row in COMMANDS.items() if row.reply not in (None, "PF")}
LIMITS = [("TW", 32766), ("TW", 40000), ("VA", 1024000), ("VA", 68431872), ("VR", 5), ("VR", 20)]
LIMITS += [("FA", 4095), ("FA", 16000), ("FV", 2047), ("FV", 20000)]


def checked(profile: Profile | None = None, name: str = "ssc2", **more: Any) -> Report:
    """The report about a simulated controller of that kind."""
    line = Loopback(Simulation(model(name), profile=profile))
    return conform(line, clock=line.clock, **more)


class Late(Loopback):
    """A busy computer: now and then the script has waited in vain, and what came is there at its next look."""

    def __init__(self, simulation: Simulation, chance: random.Random) -> None:
        super().__init__(simulation)
        self._chance, self._held, self.times = chance, b"", 0

    def read(self, timeout_s: float) -> bytes:
        came, self._held = self._held or super().read(timeout_s), b""
        if came and timeout_s and self._chance.random() < LATE:
            self.times += 1
            came, self._held = b"", came
        return came


def others(name: str) -> list[Any]:
    """Every other value that a setting can have."""
    default = DEFAULTS[name]
    if isinstance(default, bool):
        return [not default]
    if SETTINGS[name].choices:
        return [choice for choice in SETTINGS[name].choices if choice != default]
    return [NUMBERS[name]] if name in NUMBERS else [TEXTS[name]]


LATE = 0.02  # of all looks at the line
FLIPS = [(name, value) for name, each in SETTINGS.items() if not each.unseen for value in others(name)]


@pytest.mark.parametrize("name", ["ssc1", "ssc4", "dmc1412"])
def test_the_simulator_agrees_with_itself(name: str) -> None:
    report = checked(name=name, cw=2)
    assert report.differences == [] and report.odd == []
    assert report.profile == Profile()


def test_everything_without_a_reason_is_seen() -> None:
    report = checked(name="ssc2", cw=2)
    assert {name for name, each in SETTINGS.items() if not each.unseen} <= set(report.seen)
    said = " ".join(report.unseen)
    assert all(name in said for name, each in SETTINGS.items() if each.unseen)
    assert all(report.unseen.values())


@pytest.mark.parametrize(("name", "value"), FLIPS)
def test_exactly_the_setting_that_differs_is_found(name: str, value: Any) -> None:
    flipped = Profile(**{name: value})
    report = checked(flipped, cw=2)
    assert [(each.name, each.found) for each in report.differences] == [(name, value)]
    assert report.odd == []
    assert read_profile(profile_text(report.profile)) == flipped


@pytest.mark.parametrize("code", [*REFUSED, 56, 66, 90] if is_long() else [11, 56, 90])
def test_exactly_the_error_code_that_differs_is_found(code: int) -> None:
    flipped = Profile(codes={code: 100})
    report = checked(flipped)
    assert [(each.name, each.found) for each in report.differences] == [(f"codes.{code}", 100)]
    assert report.profile == flipped and report.odd == []


@pytest.mark.parametrize("command", FORMATS if is_long() else ["SP", "TI", "KS", "DM", "TV"])
def test_exactly_the_format_that_differs_is_found(command: str) -> None:
    whole, _, decimals = str(FORMATS[command]).partition(".")
    flipped = Profile(commands={command: {"reply": f"{int(whole) % 10 + 1}.{decimals}"}})
    report = checked(flipped)
    assert [each.name for each in report.differences] == [f"commands.{command}.reply"]
    assert report.profile == flipped and report.odd == []


@pytest.mark.parametrize(("command", "high"), LIMITS if is_long() else LIMITS[:4])
def test_exactly_the_limit_that_differs_is_found(command: str, high: float) -> None:
    flipped = Profile(commands={command: {"high": high}})
    report = checked(flipped)
    assert [(each.name, each.found) for each in report.differences] == [(f"commands.{command}.high", high)]
    assert report.profile == flipped and report.odd == []


def test_every_range_is_flipped() -> None:
    assert {command for command, _ in LIMITS} == set(RANGES)


def test_the_rounding_that_differs_is_found() -> None:
    flipped = Profile(commands={"AC": {"step": 1}})
    assert checked(flipped).profile == flipped


def test_several_differences_at_once() -> None:
    flipped = Profile(
        status_sign=True,
        program_end="CR LF",
        echo_return="CR",
        line_characters=100,
        codes={52: 53},
        commands={"SP": {"reply": "7.0"}, "FV": {"high": 4095}},
    )
    assert checked(flipped).profile == flipped


@pytest.mark.parametrize("seed", range(count(2, 50)))
def test_answers_that_are_handed_over_late_are_not_misread(seed: int) -> None:
    simulation = Simulation(model("ssc1"), profile=Profile(status_sign=True, echo_return="CR"))
    before = dict(simulation.unit.state.settings)
    line = Late(simulation, random.Random(seed))
    report = conform(line, clock=line.clock, cw=2)
    assert line.times >= 3
    assert [each.name for each in report.differences] == ["echo_return", "status_sign"] and report.odd == []
    assert simulation.unit.state.settings == before


@pytest.mark.parametrize("echo", [0, 1])
@pytest.mark.parametrize("zeros", [0, 1])
def test_what_is_touched_is_set_back(echo: int, zeros: int) -> None:
    simulation = Simulation(model("ssc2"))
    line = Loopback(simulation)
    setting = f"EO {echo};LZ {zeros};CW 1;AC 99328;TW 500;VR 2.5;FA 7;PF 8.2;OP 5;V1=7;DM MINE[3]\r"
    simulation.receive(1, setting.encode())
    simulation.advance(1_024_000)
    simulation.transmit(1)
    before, motion = simulation.unit.state, simulation.motion
    kept = (dict(before.settings), {name: list(values) for name, values in before.registers.items()})
    report = conform(line, clock=line.clock, cw=1)
    assert report.differences == [] and report.odd == []
    after = simulation.unit.state
    assert (after.settings, after.registers) == kept
    assert after.variables == {"V1": 7 * 65536} and set(after.arrays) == {"MINE"}
    assert after.outputs == 5 and after.program == () and simulation.unit.eeprom.copy_parts() == {}
    assert [motion.reference(axis) for axis in range(2)] == [0, 0]


def test_a_program_that_runs_is_left_alone() -> None:
    simulation = Simulation(model("ssc1"))
    simulation.load_program("#A\nWT 100\nJP#A")
    simulation.execute("#A", 2)
    line = Loopback(simulation)
    with pytest.raises(Unfit, match="a program runs in thread 2"):
        conform(line, clock=line.clock)
    assert simulation.unit.running()


@pytest.mark.parametrize("commands", ["JG ,100;BG Y", "GA X;GR ,1;JG 500;BG X", "LM XY;LI 90000,0;LE;BG S"])
def test_a_machine_that_moves_is_left_alone(commands: str) -> None:
    simulation = Simulation(model("ssc2"))
    simulation.receive(1, commands.encode() + b"\r")
    simulation.advance(300_000)
    line = Loopback(simulation)
    with pytest.raises(Unfit, match="moves"):
        conform(line, clock=line.clock)
    assert simulation.unit.moving()


def test_a_move_that_begins_meanwhile_ends_the_check() -> None:
    simulation = Simulation(model("ssc1"))
    simulation.load_program("#A\nEN")
    line = Loopback(simulation)

    def begin(title: str) -> None:
        if title == "numbers":
            simulation.motion.begin_position(0, 1_000_000)

    with pytest.raises(Unfit, match="X moves"):
        conform(line, clock=line.clock, progress=begin)
    assert simulation.unit.state.settings["LZ"] == 0


def test_nobody_there_is_one_sentence() -> None:
    line = Loopback(Simulation(model("ssc1")))
    line.unplugged = True
    with pytest.raises(Unfit, match="nothing that speaks two-letter code answers"):
        conform(line, clock=line.clock)


def test_an_unknown_type_needs_to_be_told() -> None:
    simulation = Simulation(model("ssc1"))
    line = Loopback(simulation)
    simulation.unit.revision = lambda: "ACME 7"  # type: ignore[method-assign]
    with pytest.raises(Unfit, match="'ACME 7', which is no known type"):
        conform(line, clock=line.clock)
    report = conform(line, clock=line.clock, model=model("ssc1"))
    assert report.profile.revision == "7"


def test_over_a_slow_line() -> None:
    line = Loopback(Simulation(model("ssc1"), baud=1200))
    report = conform(line, clock=line.clock, byte_s=10 / 1200)
    assert report.differences == [] and report.odd == []
    assert line.clock() < 180  # at 9600 and above within the two minutes an owner is asked for


def test_two_minutes_are_enough() -> None:
    line = Loopback(Simulation(model("ssc4"), baud=9600))
    report = conform(line, clock=line.clock, byte_s=10 / 9600, cw=2)
    assert report.differences == [] and report.odd == []
    assert line.clock() < 120
