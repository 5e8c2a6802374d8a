"""run: source and programs on the simulator in virtual time."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.__main__ import main
from codegen.files import save_setup
from codegen.setup import Axis, Setup, Unit
from resources import path as resource

CUTTER = str(resource("examples/wire-cutter.tlp"))
Said = pytest.CaptureFixture[str]
Write = Callable[[str, str], str]
KEYS = {
    "controller",
    "stopped",
    "virtual_seconds",
    "wall_seconds",
    "messages",
    "errors",
    "axes",
    "inputs",
    "outputs",
    "analog",
    "error_output",
    "variables",
    "strings",
    "arrays",
    "threads",
}


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Writes a file and returns its path."""

    def make(name: str, text: str) -> str:
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return str(path)

    return make


def ran(capsys: Said, *arguments: str, code: int = 0) -> dict[str, Any]:
    """The object that `run --json` prints."""
    assert main(["run", *arguments, "--json"]) == code, capsys.readouterr().err
    found: dict[str, Any] = json.loads(capsys.readouterr().out)
    return found


def test_source_without_a_setup_runs_on_a_factory_controller(write: Write, capsys: Said) -> None:
    """The factory value of OE is 0 (facts of the command list): AB 1 leaves the motor on."""
    found = ran(capsys, write("a.dmc", "JG 10000\nBGX\nWT 100\nAB 1\nV=_OEX\nEN\n"))
    assert found["variables"] == {"V": 0} and found["axes"]["X"]["motor_on"]


def test_a_run_goes_on_until_the_controller_is_back_after_a_reset(write: Write, capsys: Said) -> None:
    """What was not burned is gone then: variables and the program."""
    path, stimulus = write("a.dmc", "V=1\nWT 5000\nEN\n"), "ms,signal,value\n200,reset,0\n220,reset,1\n"
    found = ran(capsys, path, "--stimulus", write("s.csv", stimulus))
    assert found["stopped"] == "end" and 0.22 < found["virtual_seconds"] < 5
    assert found["variables"] == {} and not found["error_output"] and found["axes"]["X"]["motor_on"]


@pytest.mark.parametrize("line", ["LM 1", "VP 1", "CR 1", "GA 1", "CS 1", "LI", "VS 1*"])
def test_a_command_of_other_models_is_not_read_further(line: str, write: Write, capsys: Said) -> None:
    found = ran(capsys, write("a.dmc", f"{line}\nEN\n"), "--controller", "dmc1412", code=1)
    assert found["errors"][0]["code"] == 1


def test_json_has_exactly_the_documented_keys(write: Write, capsys: Said) -> None:
    found = ran(capsys, write("a.dmc", 'MG "HI"\nPR 10000\nBGX\nAMX\nV=2.5\nS="CAT"\nDM A[2]\nA[1]=7\nSB 3\nEN\n'))
    assert set(found) == KEYS
    assert found["controller"] == "ssc4" and found["stopped"] == "end"
    # 10000 counts at 25000 counts/s and 256000 counts/s²: 0.4 + 25000/256000 s
    assert abs(found["virtual_seconds"] - 0.4977) < 0.02
    assert [text for _, _, text in found["messages"]] == ["HI"] and found["messages"][0][1] == 1
    assert set(found["axes"]) == {"X", "Y", "Z", "W"}
    axis = found["axes"]["X"]
    assert set(axis) == {
        "commanded",
        "actual",
        "error",
        "velocity",
        "torque",
        "stop_code",
        "motor_on",
        "amp_enable",
        "moving",
    }
    assert axis["commanded"] == 10000 and axis["stop_code"] == 1 and not axis["moving"]
    assert found["outputs"] == 4 and found["inputs"] == 255 and len(found["analog"]) == 7
    assert found["variables"]["V"] == 2.5 and found["strings"] == {"S": "CAT"}
    assert found["arrays"] == {"A": [0, 7]}
    assert len(found["threads"]) == 4 and set(found["threads"][0]) == {"running", "line", "waiting_for"}


def test_an_error_nobody_handles_ends_the_run(write: Write, capsys: Said) -> None:
    # dmc-1412-1414.txt l.2711-2721: PR while moving is error 7, shown as ?003 PR5000
    path = write("a.dmc", "#A\nPR1000\nBGX\nPR5000\nEN\n")
    found = ran(capsys, path, "--controller", "dmc1412", code=1)
    assert found["stopped"] == "error"
    error = found["errors"][0]
    assert (error["thread"], error["line"], error["source"], error["code"]) == (0, 3, "PR5000", 7)
    assert error["text"] == "Command not valid while running"
    assert found["messages"][-1][2] == "?003 PR5000"


def test_a_handled_error_does_not(write: Write, capsys: Said) -> None:
    found = ran(capsys, write("a.dmc", "#A\nSP 99999999\nEN\n#CMDERR\nMG _TC{F3.0}\nZS0;EN\n"))
    assert found["stopped"] == "end" and found["errors"][0]["handled"] is True
    assert found["messages"][0][2].strip() == "006"


def test_lines_with_checker_findings_run_all_the_same(write: Write, capsys: Said) -> None:
    found = ran(capsys, write("a.dmc", 'JP #END\nPRR\n#END\nMG "OK"\nEN\n'))
    assert [text for _, _, text in found["messages"]] == ["OK"]


def test_time_is_a_limit(write: Write, capsys: Said) -> None:
    found = ran(capsys, write("a.dmc", "#A;JP#A\n"), "--time", "2")
    assert found["stopped"] == "time" and found["virtual_seconds"] == 2
    assert found["threads"][0]["running"]


def test_entry_starts_at_a_label(write: Write, capsys: Said) -> None:
    path = write("a.dmc", 'MG "TOP"\nEN\n#LOW\nMG "LOW"\nEN\n')
    assert [text for _, _, text in ran(capsys, path)["messages"]] == ["TOP"]
    assert [text for _, _, text in ran(capsys, path, "--entry", "LOW")["messages"]] == ["LOW"]
    assert [text for _, _, text in ran(capsys, path, "--entry", "#LOW")["messages"]] == ["LOW"]
    assert main(["run", path, "--entry", "NONE"]) == 2
    assert "NONE" in capsys.readouterr().err


STIMULUS = "ms,signal,value\n0,in1,0\n100,in1,1\n150,in1,0\n"


def test_stimulus_happens_at_its_time(write: Write, capsys: Said) -> None:
    path = write("a.dmc", 'AI 1\nT=TIME\nMG "GO"\nEN\n')
    found = ran(capsys, path, "--stimulus", write("s.csv", STIMULUS))
    assert 100 <= found["messages"][0][0] <= 103
    assert 102 <= found["variables"]["T"] <= 105  # samples: 100 ms are 102.4
    assert found["inputs"] == 255


def test_typed_answers_and_outside_forces(write: Write, capsys: Said) -> None:
    path = write("a.dmc", 'IN "LENGTH",LEN\nV=@AN[2]\nH=_HMX\nWT 200\nEN\n')
    stimulus = "ms,signal,value\n10,an2,2.5\n10,home_x,0\n50,type,12.5\\r\n150,position_x,40\n"
    found = ran(capsys, path, "--stimulus", write("s.csv", stimulus))
    assert found["variables"]["LEN"] == 12.5 and abs(found["variables"]["V"] - 2.5) < 0.01
    assert found["variables"]["H"] == 0


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("0,in1,0\n", "first line"),
        ("", "first line"),
        ("ms,signal,value\n0,in99,1\n", "no signal in99"),
        ("ms,signal,value\n10,in1,1\n5,in1,0\n", "line 3: not in time order"),
        ("ms,signal,value\nsoon,in1,1\n", "line 2"),
        ("ms,signal,value\n5,in1\n", "line 2"),
        ("ms,signal,value\nnan,in1,1\n", "line 2"),
        ("ms,signal,value\n-5,in1,1\n", "line 2"),
        ("ms,signal,value\n5,in1,2\n", "0 or 1"),
        ("ms,signal,value\n5,in1,0,5\n", "line 2: more than"),
        ("ms,signal,value\n5,an1,12\n", "-10 and 10"),
        ("ms,signal,value\n5,an1,inf\n", "line 2"),
        ("ms,signal,value\n5,an8,1\n", "no signal an8"),
        ("ms,signal,value\n5,in1,\0\n", "line 2"),
    ],
)
def test_unusable_stimulus(text: str, words: str, write: Write, capsys: Said) -> None:
    assert main(["run", write("a.dmc", "EN\n"), "--stimulus", write("s.csv", text)]) == 2
    said = capsys.readouterr().err
    assert words in said and said.count("\n") == 1


def test_signals_are_those_of_the_controller(write: Write, capsys: Said) -> None:
    path = write("a.dmc", "WT 20\nEN\n")
    for signal in ("in8", "an3", "load_y"):
        stimulus = write("s.csv", f"ms,signal,value\n1,{signal},1\n")
        assert main(["run", path, "--controller", "dmc1412", "--stimulus", stimulus]) == 2
        assert f"no signal {signal} on dmc1412" in capsys.readouterr().err
        assert main(["run", path, "--controller", "ssc2", "--stimulus", stimulus]) == 0


def test_trace_as_csv(write: Write, tmp_path: Path, capsys: Said) -> None:
    out = tmp_path / "t.csv"
    path = write("a.dmc", "PR 1000,500\nBGXY\nAMXY\nSB 2\nWT 20\nEN\n")
    ran(capsys, path, "--controller", "ssc2", "--trace", str(out))
    with out.open(newline="") as file:
        rows = list(csv.DictReader(file))
    names = ["commanded", "actual", "velocity", "torque"]
    wanted = ["ms", *(f"{axis}_{name}" for axis in "xy" for name in names), "inputs", "outputs"]
    assert list(rows[0]) == [*wanted, "thread0", "thread1", "thread2", "thread3"]
    steps = [float(b["ms"]) - float(a["ms"]) for a, b in pairwise(rows)]
    assert all(abs(step - 1000 / 1024) < 0.001 for step in steps)
    assert rows[-1]["x_commanded"] == "1000" and rows[-1]["y_commanded"] == "500"
    assert rows[-1]["outputs"] == "2" and rows[0]["outputs"] == "0" and rows[0]["inputs"] == "255"
    lines = [int(row["thread0"]) for row in rows]
    assert lines == sorted(lines[:-1]) + lines[-1:] and set(lines) - {-1} <= set(range(6)) and 2 in lines
    assert all(row["thread1"] == "-1" for row in rows)


def test_trace_as_arrays_every_tenth_sample(write: Write, tmp_path: Path, capsys: Said) -> None:
    out = tmp_path / "t.npz"
    ran(capsys, write("a.dmc", "JG 10000\nBGX\nWT 1024\nSTX\nAMX\nEN\n"), "--trace", str(out), "--every", "10")
    with np.load(out) as arrays:
        assert abs(np.diff(arrays["ms"]) - 10 * 1000 / 1024).max() < 0.001
        assert len({len(arrays[name]) for name in arrays.files}) == 1
        assert arrays["x_commanded"][-1] > 9000
        middle = len(arrays["ms"]) // 2
        assert abs(arrays["x_velocity"][middle] - 10000) < 500


def test_a_program_with_its_own_setup(write: Write, capsys: Said) -> None:
    found = ran(capsys, CUTTER, "--stimulus", write("s.csv", STIMULUS), "--time", "4")
    assert found["controller"] == "ssc1" and found["axes"]["X"]["commanded"] == 6370
    assert main(["run", CUTTER, "--stimulus", write("s.csv", STIMULUS), "--time", "4"]) == 0
    assert "commanded 6370 (10 in)" in capsys.readouterr().out


def changed_cutter(write: Write, old: str, new: str) -> str:
    """The wire cutter with one thing changed."""
    text = Path(CUTTER).read_text(encoding="utf-8")
    assert old in text
    return write("changed.tlp", text.replace(old, new))


def test_a_program_that_does_not_fit_the_controller(write: Write, capsys: Said) -> None:
    path = changed_cutter(write, '"model": "ssc1"', '"model": "ssc2"')
    path = write("y.tlp", Path(path).read_text().replace('"axis": "X"', '"axis": "Y"'))
    assert main(["run", path, "--time", "1"]) == 0
    assert main(["run", path, "--controller", "dmc1414"]) == 2
    said = capsys.readouterr().err
    assert "does not fit dmc1414" in said and "Y" in said and said.count("\n") == 1


def test_an_unfinished_step_does_not_run(write: Write, capsys: Said) -> None:
    assert main(["run", changed_cutter(write, '"time": "20"', '"time": ""')]) == 2
    said = capsys.readouterr().err
    assert "not finished" in said and said.count("\n") == 1


def test_a_wrong_setup_does_not_run(write: Write, tmp_path: Path, capsys: Said) -> None:
    path = changed_cutter(write, '"counts_per_unit": "637"', '"counts_per_unit": "abc"')
    for arguments in (["run", path], ["compile", path, "-o", str(tmp_path / "o.dmc")]):
        assert main(arguments) == 2
        said = capsys.readouterr().err
        assert "Counts per unit" in said and said.count("\n") == 1
    assert not (tmp_path / "o.dmc").exists()


def test_the_loop_rate_of_the_setup_keeps_the_english_true(write: Write, tmp_path: Path, capsys: Said) -> None:
    path = changed_cutter(write, '"sample_us": "1000"', '"sample_us": "500"')
    out = tmp_path / "t.csv"
    found = ran(capsys, path, "--stimulus", write("s.csv", STIMULUS), "--time", "4", "--trace", str(out))
    assert abs(found["axes"]["X"]["commanded"] - 6370) <= 1
    rows = list(csv.DictReader(out.open(newline="")))
    moving = [float(row["ms"]) for a, row in pairwise(rows) if row["x_commanded"] != a["x_commanded"]]
    # 10 in at 5 in/s and 400 in/s² last 2 s + 5/400 s, whatever the loop rate is
    assert abs(moving[-1] - moving[0] - 2012.5) < 10
    assert abs(float(rows[1]["ms"]) - float(rows[0]["ms"]) - 500 / 1024) < 0.001


def test_a_jump_to_nowhere_is_found_when_it_is_reached(write: Write, capsys: Said) -> None:
    path = changed_cutter(write, '"target": "A"', '"target": "NOPE"')
    found = ran(capsys, path, "--stimulus", write("s.csv", STIMULUS), "--time", "4", code=1)
    assert found["stopped"] == "error" and found["axes"]["X"]["commanded"] == 6370


def test_a_setup_gives_units_and_limits(write: Write, tmp_path: Path, capsys: Said) -> None:
    axis = Axis(unit=Unit.MM, counts_per_unit="100", forward_limit="20", error_limit="5.009")
    path = tmp_path / "machine.tls"
    save_setup(path, Setup(model="dmc1412").with_axis("X", axis))
    source = write("a.dmc", "KD 200\nDC 1024000\nJG 2000\nBGX\nAMX\nMG _ERX{F5.0}\nEN\n")
    assert main(["run", source, "--setup", str(path)]) == 0
    said = capsys.readouterr().out
    # dmc-1412-1414.txt l.4140-4146: the jog stops at the forward limit, 20 mm of 100 counts
    assert "stop code 2" in said and "(20" in said and " 00500" in said
    found = ran(capsys, source, "--setup", str(path))
    assert found["controller"] == "dmc1412" and 2000 <= found["axes"]["X"]["commanded"] <= 2010


def test_a_plant_file_is_what_hangs_on_the_axis(write: Write, capsys: Said) -> None:
    path = write("a.dmc", "TL 0.2\nJG 1000\nBGX\nWT 500\nEN\n")
    free = ran(capsys, path, "--time", "0.5")
    stuck = ran(capsys, path, "--time", "0.5", "--plant", write("p.toml", "[axis.x]\ncoulomb_friction = 0.05\n"))
    assert free["axes"]["X"]["actual"] > 100 and stuck["axes"]["X"]["actual"] == 0
    assert main(["run", path, "--plant", write("q.toml", "[axis.x]\nno_such_key = 1\n")]) == 2
    said = capsys.readouterr().err
    assert "no_such_key" in said and said.count("\n") == 1


def test_the_same_run_gives_the_same_bits(write: Write, tmp_path: Path, capsys: Said) -> None:
    path = write("a.dmc", "PR 1000\nBGX\nAMX\nV=_TPX\nEN\n")
    plant = write("p.toml", "[axis.x]\nencoder_noise = 2.0\n")
    one, two = tmp_path / "1.csv", tmp_path / "2.csv"
    ran(capsys, path, "--plant", plant, "--trace", str(one))
    ran(capsys, path, "--plant", plant, "--trace", str(two))
    assert one.read_bytes() == two.read_bytes()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["run", "missing.dmc"], "no such file"),
        (["run"], "FILE"),
        (["run", CUTTER, "--controller", "dmc9999"], "dmc9999"),
        (["run", CUTTER, "--time", "-1"], "--time"),
        (["run", CUTTER, "--time", "nan"], "--time"),
        (["run", CUTTER, "--time", "inf"], "--time"),
        (["run", CUTTER, "--trace", "no/such/folder/t.csv"], "no folder"),
        (["simulate", "--eeprom", "."], "."),
        (["simulate", "--eeprom", "missing/eeprom"], "there is no folder missing"),
        (["compile", "missing.dmc"], "missing.dmc: no such file"),
        (["run", ".", "--time", "1"], "is a folder"),
        (["run", CUTTER, "--trace", "t.doc"], ".npz"),
        (["run", CUTTER, "--setup", "missing.tls"], "missing.tls"),
        (["simulate", "--chain", "9"], "daisy"),
        (["simulate", "--tcp", "0.0.0.0:5000"], "this computer only"),
        (["simulate", "--tcp", "nonsense"], "HOST:PORT"),
        (["simulate", "--port2", "0.0.0.0:5000"], "--port2 0.0.0.0:5000: a simulated controller is served on this"),
        (["simulate", "--profile", "missing.toml"], "missing.toml: no such file"),
        (["simulate", "--baud", "0"], "--baud"),
        (["run", CUTTER, "--profile", "missing.toml"], "missing.toml: no such file"),
        (["run", CUTTER, "--plant", "missing.toml"], "missing.toml: no such file"),
        (["upload", "--port", "simulator", "--profile", "missing.toml"], "missing.toml: no such file"),
        (["terminal", "--port", "simulator", "--baud", "0"], "--baud"),
        (["conform", "--port", "socket://127.0.0.1:1"], "socket://127.0.0.1:1"),
        (["conform", "--port", "simulator:smartmotor"], "two-letter"),
        (["conform", "--port", "simulator", "-o", "p.txt"], ".toml"),
        (["download", CUTTER, "--port", "simulator:dmc9999"], "dmc9999"),
        (["backup", "--port", "simulator"], "-o"),
        (["--simulator", "dmc9999"], "dmc9999"),
        (["missing.tlp"], "missing.tlp"),
    ],
)
def test_unusable_arguments_are_one_line_and_code_two(arguments: list[str], words: str, capsys: Said) -> None:
    assert main(arguments) == 2
    said = capsys.readouterr().err
    assert said.startswith("twoletter: ") and said.count("\n") == 1 and words in said
