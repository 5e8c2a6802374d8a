"""The profile: every recalled or inferred fact is a setting that does what it says, kept in a readable file."""

from __future__ import annotations

import random
import re
from pathlib import Path
from typing import Any

import pytest

from codegen.models import model
from codegen.twoletter.commands import COMMANDS
from device.simulator.process import SimulatorProcess
from device.simulator.simulation import Simulation
from device.simulator.twoletter.profile import DEFAULTS, SETTINGS, Profile, ProfileWrong
from device.simulator.twoletter.profile_file import ProfileUnreadable, load_profile, profile_text, read_profile
from tests.device.simulator.bench import MS, Bench
from tests.device.simulator.test_fuzz import LEAVE, QUIET, command
from tests.device.simulator.test_server import connect, until
from tests.long import count

BY_TABLE = re.compile(r"format|default|range|numbers|\d{2}|editions|moving|public")  # what [commands.X] corrects


def bench_with(name: str = "ssc2", **settings: Any) -> Bench:
    """A bench whose controller has these settings."""
    bench = Bench()
    bench.simulation = Simulation(model(name), profile=Profile(**settings))
    return bench


# ---------------------------------------------------------------------- file


def test_what_is_written_is_read_again() -> None:
    profile = Profile(
        line_characters=200,
        status_sign=True,
        revision='Rev "3" \\x',
        velocity_feed_v=2e-6,
        program_end="CR LF",
        codes={57: 9},
        commands={"SP": {"reply": "7.0", "default": 20000}, "VD": {"moving": True}},
    )
    text = profile_text(profile, "a controller")
    assert read_profile(text) == profile
    assert text.startswith("# a controller\n")
    assert "# longest command line of a port" in text
    assert read_profile(profile_text(Profile())) == Profile()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("line_character = 80", "there is no setting line_character"),
        ("line_characters = 9", "line_characters is a whole number from 10 to 512, not 9"),
        ('line_characters = "80"', 'not "80"'),
        ("line_characters = true", "not true"),
        ("status_sign = 1", "status_sign is true or false, not 1"),
        ('echo_return = "LF"', 'echo_return is "CR LF" or "CR", not "LF"'),
        ("output_fifo = 100", "output_fifo is 128 or 512, not 100"),
        ("velocity_feed_v = nan", "velocity_feed_v is a number from 0 to 1, not nan"),
        ('revision = "a\\u0007"', "revision is printable text"),
        ("[codes]\n57 = 999", "999 is no error code"),
        ("[codes]\n57 = true", "no pair of error codes"),
        ('[codes]\n"-1" = 6', "no pair of error codes"),
        ("codes = 5", "codes is a table"),
        ("[commands.QQ]\nhigh = 5", "there is no command QQ"),
        ("[commands.SP]\nspeed = 5", "speed of SP cannot be corrected"),
        ("[commands.TP]\nreply = '8.0'", "reply of TP cannot be corrected"),
        ("[commands.SP]\nreply = '8'", "reply of SP is a format"),
        ("[commands.SP]\nreply = '11.0'", "reply of SP is a format"),
        ("[commands.SP]\nlow = 'a'", "low of SP is a number"),
        ("[commands.VD]\nmoving = 1", "moving of VD is true or false"),
        ("[commands]\nSP = 5", "commands.SP is a table"),
        ("line_characters = ", "not a profile"),
    ],
)
def test_what_is_wrong_is_one_sentence(text: str, words: str) -> None:
    with pytest.raises(ProfileUnreadable) as refused:
        read_profile(text, "mine.toml")
    said = str(refused.value)
    assert said.startswith("mine.toml: ") and words in said and "\n" not in said


def test_a_file_that_is_none(tmp_path: Path) -> None:
    with pytest.raises(ProfileUnreadable, match=r"no-such\.toml: no such file"):
        load_profile(tmp_path / "no-such.toml")
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ProfileUnreadable, match=r"binary\.toml: not a text file"):
        load_profile(tmp_path / "binary.toml")


def test_a_wrong_value_is_refused_in_code_too() -> None:
    with pytest.raises(ProfileWrong):
        Profile(overflow="explodes")


@pytest.mark.alone
def test_a_served_simulator_loads_it(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text('revision = "Rev 7.7q"\n', encoding="utf-8")
    with SimulatorProcess("ssc1", profile=path) as simulator:
        client = connect(simulator.address)
        client.sendall(b"\x12\x16")
        assert until(client, b":") == b"DMC1510 Rev 7.7q\r\n:"


# ------------------------------------------------------------------ complete


def test_every_setting_says_what_it_is() -> None:
    for name, setting in SETTINGS.items():
        assert setting.doc and setting.source, name
        assert "recall" in setting.source or "inferred" in setting.source or "l." in setting.source, name
        assert not setting.choices or DEFAULTS[name] in setting.choices, name


def test_every_marked_fact_of_the_table_can_be_corrected() -> None:
    named = {row for setting in SETTINGS.values() for row in setting.rows}
    known = {"LL", "LA", "LV"}
    left = [
        name
        for name, row in COMMANDS.items()
        if row.profile and name not in named | known and not BY_TABLE.search(row.profile) and row.reply in (None, "PF")
    ]
    assert left == []


# -------------------------------------------------------------- what they do


def test_output_fifo() -> None:
    bench = bench_with(output_fifo=512)
    bench.load('#A\nN=0\n#B\nMG "0123456789012345678901234567890123456789"\nN=N+1\nJP#B,N<50\nEN')
    bench.simulation.uarts[0].set_host_ready(False, 0)
    bench.simulation.execute("#A")
    bench.wait(2000)
    assert bench.simulation.unit.state.variables["N"] // 65536 in (12, 13)  # 512 places, 42 characters each


def test_defaults_after_a_master_reset() -> None:
    bench = bench_with(leading_zeros_removed=1, echo=1, mark=1, port_two_baud=19200, commands={"KP": {"default": 12.5}})
    assert bench.type("KP ?\r").replace("\r\n", "|") == "KP ?| 12.50|:"
    bench.type("\x12\x13", 1500)
    assert bench.simulation.unit.state.settings["CW1"] == 1
    assert bench.simulation.unit.state.port_two[0] == 19200


def test_burning_times() -> None:
    bench = bench_with(burn_parameters_ms=700)
    assert bench.type("BN\r", 650) == ""
    assert bench.wait(60) == ":"


def test_outputs_that_are_not_burned() -> None:
    for burns, after in ((True, " 005"), (False, " 000")):
        bench = bench_with(burns_outputs=burns)
        bench.type("OP 5;BN\r", 400)
        bench.type("RS\r", 1500)
        assert bench.ask("OP ?") == after


def test_codes_of_programs() -> None:
    bench = bench_with(off_the_end_code=11, bad_input_code=6, codes={7: 100})
    bench.run("V=1")
    assert bench.simulation.errors[-1]["code"] == 11
    bench.load('#A\nIN "N",N\nEN')
    bench.simulation.execute("#A")
    bench.wait(20)
    bench.type("ABC\r")
    assert bench.simulation.errors[-1]["code"] == 6
    bench.type("PR 50000;BGX;PR 5\r")
    assert bench.ask("TC1").startswith("100 ")


def test_the_fields_of_en() -> None:
    program = "#A\nCI ,2\n#B\nJP#B\n#COMINT\nN=N+1\nEN {}"
    for order, field, calls in (
        ("trippoint,interrupt", "0,1", 3),
        ("trippoint,interrupt", "1,0", 1),
        ("interrupt,trippoint", "1,0", 3),
        ("interrupt,trippoint", "0,1", 1),
    ):
        bench = bench_with(end_fields=order)
        bench.type("N=0\r")
        bench.load(program.format(field))
        bench.simulation.execute("#A")
        bench.wait(20)
        for _ in range(3):
            bench.simulation.receive(2, b"x")
            bench.wait(20)
        assert bench.simulation.unit.state.variables["N"] // 65536 == calls, (order, field)


def test_an_interrupt_that_comes_again() -> None:
    program = "#A\nII 1\n#B\nJP#B\n#ININT\nN=N+1\nZS0;JP#B"  # left without RI
    for once in (True, False):
        bench = bench_with(interrupt_once=once)
        bench.type("N=0\r")
        bench.load(program)
        bench.simulation.execute("#A")
        bench.wait(20)
        bench.simulation.stimulus("in1", 0)
        bench.wait(50)
        count = bench.simulation.unit.state.variables["N"] // 65536
        assert (count == 1) if once else (count > 1)


def test_the_argument_of_ab() -> None:
    for keeps in (0, 1):
        bench = bench_with(abort_keeps_programs=keeps)
        for argument in (0, 1):
            bench.load("#A\nJP#A")
            bench.simulation.unit.halt_all()
            bench.simulation.execute("#A")
            bench.type(f"AB {argument}\r")
            assert bench.simulation.unit.running() is (argument == keeps)


def test_limits_of_ts_with_cn_1() -> None:
    # 15: both limits "not active", home, latch not armed (dmc-1400 pages); with CN 1 and open switches _LF reads 1
    for follows in (False, True):
        bench = bench_with(limits_follow_level=follows)
        bench.type("CN 1\r")
        inactive = int(bench.ask("TSX")) & 12
        bench.simulation.stimulus("fls_x", 0)
        bench.wait(5)
        assert (int(bench.ask("TSX")) & 8) != (inactive & 8)
        assert (inactive == 12) is follows


def test_the_direction_of_fe() -> None:
    ways = {}
    for rule in ("table", "sentence"):
        bench = bench_with(edge_direction=rule)
        bench.type("SP 1000;FEX;BGX\r", 300)
        ways[rule] = bench.position()
    assert ways["table"] * ways["sentence"] < 0


def test_feed_forward_scales() -> None:
    torque = {}
    for volts in (1.22e-6, 2.44e-6):
        bench = bench_with(velocity_feed_v=volts)
        bench.type("KP 0;KD 0;KI 0;FV 10;JG 30000;BGX\r", 400)
        torque[volts] = bench.simulation.state()["axes"]["X"]["torque"]
    assert torque[1.22e-6] == pytest.approx(0.366, abs=0.002)  # dmc-1412-1414.txt: FV 10 at 30 000 counts/s
    assert torque[2.44e-6] == pytest.approx(0.732, abs=0.004)


def test_what_is_refused_while_moving() -> None:
    assert bench_with().type("LM XY;LI 9000,0;LE;BGS;VD 102400\r").endswith("?")
    assert bench_with(commands={"VD": {"moving": True}}).type("LM XY;LI 9000,0;LE;BGS;VD 102400\r").endswith(":")


def test_labels_and_variables() -> None:
    bench = bench_with(labels=10, variables=2)
    assert bench.ask("MG _DL{F3.0}") == " 010" and bench.ask("MG _UL{F3.0}") == " 002"
    bench.ask("A=1;B=1")
    assert bench.refused("C=1") == 67
    assert Bench("dmc1412").ask("MG _DL{F3.0}") == " 126"  # the manual states it: l.2560


def test_a_small_receive_buffer() -> None:
    bench = Bench(baud=38400, handshake=False)
    bench.simulation = Simulation(model("ssc1"), baud=38400, handshake=False, profile=Profile(receive_buffer=32))
    bench.type("WT 500\r", ms=20)
    assert "?" in bench.type("NO 1\r" * 12, ms=100)  # 60 characters while the port waits


def test_a_reset_takes_its_time() -> None:
    bench = bench_with(reset_ms=300)
    bench.type("RS\r", 290)
    assert bench.simulation.transmit(1) == b""
    bench.simulation.advance(30 * MS)
    assert bench.simulation.transmit(1) == b":"


def other(name: str) -> Any:
    """A value that is not the default."""
    default = DEFAULTS[name]
    if isinstance(default, bool):
        return not default
    if SETTINGS[name].choices:
        return next(choice for choice in SETTINGS[name].choices if choice != default)
    if isinstance(default, float):
        return default * 2
    return "Rev 9" if isinstance(default, str) else max(SETTINGS[name].low, default // 2)


@pytest.mark.parametrize("name", SETTINGS)
def test_with_any_setting_it_can_be_stopped(name: str) -> None:
    chance = random.Random(name)
    bench = bench_with(**{name: other(name)})
    bench.load("#A\nN=@INT[N-0.5]+@RND[N*3]\nMG N\nWT 2\nJP#A")
    for _ in range(count(60, 2000)):
        bench.type(command(chance) + "\r", ms=chance.choice([0, 2, 5]))
        if not bench.simulation.unit.running():
            bench.type("N=0;XQ#A\r", ms=3)
    for _ in range(2):
        bench.type(f"{LEAVE}%{bench.simulation.unit.address}\r{QUIET}", ms=1500)
    assert bench.type("MG 6*7{F3.0}\r").replace("MG 6*7{F3.0}\r", "").strip("\r\n: ") == "042"
    assert not bench.simulation.unit.running() and not bench.simulation.unit.moving()
