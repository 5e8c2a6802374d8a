"""The command line as somebody outside sees it: every documented call and option; serving in processes of their own."""

from __future__ import annotations

import csv
import json
import re
import select
import signal
import socket
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path

import numpy as np
import pytest

from app.__main__ import main
from resources import path as resource
from tests.app.cli import test_process
from tests.app.cli.test_process import COMMAND, ROOT
from tests.long import is_long

CUTTER = str(resource("examples/wire-cutter.tlp"))
SOURCE = '#A\nPR 1000\nBG X\nAM X\nMG "A"{N}\nMG "B"\nSB 3\nEN\n'
SIGNALS = [*(f"in{n}" for n in range(1, 9)), *(f"an{n}" for n in range(1, 8)), "fls_x", "rls_x", "home_x", "abort"]
SIGNALS += ["aux_x", "aux_speed_x", "position_x", "load_x", "type", "type2", "reset"]


def called(*arguments: str) -> subprocess.CompletedProcess[str]:
    """One call; a process each in the long run, and every day in test_process."""
    if is_long():
        return test_process.called(*arguments)
    with redirect_stdout(StringIO()) as out, redirect_stderr(StringIO()) as said:
        try:
            code = main(list(arguments))
        except SystemExit as leaving:
            code = int(leaving.code or 0)
    return subprocess.CompletedProcess(arguments, code, out.getvalue(), said.getvalue())


@pytest.fixture
def source(tmp_path: Path) -> Path:
    path = tmp_path / "a.dmc"
    path.write_text(SOURCE, encoding="utf-8")
    return path


@contextmanager
def served(*options: str, end: int = signal.SIGINT) -> Iterator[list[str]]:
    """`twoletter simulate`; the places it announces, one for each port."""
    with subprocess.Popen(
        [*COMMAND, "simulate", *options], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout
        try:
            lines = 2 if "--port2" in options else 1
            yield [process.stdout.readline().rsplit(" ", 1)[-1].strip() for _ in range(lines)]
        finally:
            process.send_signal(end)
            assert process.wait(20) == 0
            assert process.stderr and process.stderr.read() == ""


def talk(address: str, text: bytes, end: bytes) -> bytes:
    """Sends to a served controller; its answer up to an end."""
    host, port = address.split(":")
    with socket.create_connection((host, int(port)), timeout=20) as link:
        link.settimeout(20)
        link.sendall(text)
        came = b""
        while not came.endswith(end):
            more = link.recv(4096)
            assert more, came
            came += more
        return came


# ---------------------------------------------------------------------- files


def test_demo(tmp_path: Path) -> None:
    picture = tmp_path / "motion.svg"
    done = called("demo", "-o", str(picture))
    assert done.returncode == 0 and done.stderr == ""
    titles = [line for line in done.stdout.splitlines() if line.startswith("== ")]
    assert titles[:3] == ["== Program", "== Code", "== Timeline"] and titles[3].startswith("== Final state")
    assert "Move X by 10 in at 5 in/s" in done.stdout and "\nPR 6370\n" in done.stdout
    assert ElementTree.parse(picture).getroot().tag.endswith("svg")


def test_compile(tmp_path: Path) -> None:
    plain = called("compile", CUTTER)
    assert plain.returncode == 0 and plain.stdout.splitlines()[:2] == ["#CUTTER", "AC 254976"]
    out, where = tmp_path / "o.dmc", tmp_path / "map.json"
    done = called("compile", CUTTER, "-o", str(out), "--controller", "ssc4", "--compact", "--map", str(where))
    assert done.returncode == 0 and done.stdout == ""
    lines = out.read_text().splitlines()
    assert len(lines) < len(plain.stdout.splitlines()) and max(map(len, lines)) <= 80
    steps = json.loads(where.read_text())["lines"]
    assert [row["text"] for row in steps] == lines and [row["line"] for row in steps] == list(range(len(lines)))
    refused = called("compile", CUTTER, "--controller", "smartmotor")
    assert refused.returncode == 2 and refused.stderr.count("\n") == 1


def test_check(source: Path, tmp_path: Path) -> None:
    bad = tmp_path / "b.dmc"
    bad.write_text("#A\nPR 1;QQ 5\nEN\n")
    done = called("check", str(source), CUTTER, str(bad))
    assert done.returncode == 1
    shape = re.compile(r".+\.(dmc|tlp):\d+:\d+: (error|warning|hint) \S+ .+")
    assert all(shape.fullmatch(line) for line in done.stdout.splitlines())
    assert f"{bad}:2:6: error" in done.stdout
    rows = json.loads(called("check", "--json", str(bad)).stdout)
    assert {"file", "line", "column", "severity", "code", "message"} <= set(rows[0]) and rows[0]["line"] == 2
    assert called("check", str(source)).returncode == 0
    wide = tmp_path / "wide.dmc"
    wide.write_text("#A\n" + "V=1;" * 12 + "\nEN\n")
    assert called("check", str(wide)).returncode == 0
    assert called("check", str(wide), "--controller", "dmc1412").returncode == 1


def test_import_loses_nothing(tmp_path: Path) -> None:
    strange = tmp_path / "s.dmc"
    strange.write_text('#A\nPR 1000\nTN 5,6;ET[3]=4\nMG "X",V1{$4.2}\nEN\n')
    out = tmp_path / "s.tlp"
    assert called("import", str(strange), "-o", str(out), "--controller", "ssc4").returncode == 0
    back = called("compile", str(out)).stdout
    assert re.sub(r"\s", "", back.replace(";", "\n")) == re.sub(r"\s", "", strange.read_text().replace(";", "\n"))
    again = called("import", str(strange), "-o", str(out))
    assert again.returncode == 2 and "--force" in again.stderr


@pytest.mark.parametrize("call", ["check", "run", "download"])
def test_characters_that_no_controller_has(call: str, tmp_path: Path) -> None:
    path = tmp_path / "u.dmc"
    path.write_text('REM Größe\n#A\nMG "Größe"\nEN\n', encoding="utf-8")
    done = called(call, str(path), *(["--port", "simulator"] if call == "download" else []))
    assert done.returncode == (1 if call == "check" else 2)
    said = done.stdout if call == "check" else done.stderr
    assert said.count("\n") == 1 and "plain characters only" in said and ("line 3" in said or ":3:" in said)


# ------------------------------------------------------------------------ run


def test_run_prints_and_ends(source: Path) -> None:
    done = called("run", str(source), "--controller", "dmc1412", "--entry", "A", "--time", "5")
    assert done.returncode == 0 and done.stderr == ""
    assert re.search(r"ms  port 1  AB\n", done.stdout) and "commanded 1000" in done.stdout


def test_run_json_with_everything(source: Path, tmp_path: Path) -> None:
    stimulus, plant, trace = tmp_path / "s.csv", tmp_path / "p.toml", tmp_path / "t.npz"
    rows = [f"{10 + n},{name},{'X' if name.startswith('type') else 1}" for n, name in enumerate(SIGNALS)]
    stimulus.write_text("ms,signal,value\n" + "\n".join(rows) + "\n")
    plant.write_text('[axis.x]\ndrive = "current"\nviscous_friction = 0.006\n')
    options = ["--stimulus", str(stimulus), "--plant", str(plant), "--trace", str(trace), "--every", "4", "--json"]
    done = called("run", str(source), *options, "--controller", "ssc1", "--time", "0.02")
    assert done.returncode == 0
    found = json.loads(done.stdout)
    assert found["controller"] == "ssc1" and found["stopped"] == "time" and found["virtual_seconds"] == 0.02
    with np.load(trace) as arrays:
        assert {"ms", "x_commanded", "x_actual", "x_velocity", "x_torque", "inputs", "outputs"} <= set(arrays.files)
        assert len(arrays["ms"]) == 5  # 20 samples, every fourth


def test_run_traces_as_csv(source: Path, tmp_path: Path) -> None:
    trace = tmp_path / "t.csv"
    assert called("run", str(source), "--controller", "ssc1", "--trace", str(trace)).returncode == 0
    with trace.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert rows[-1]["x_commanded"] == "1000" and rows[-1]["outputs"] == "4"


def test_run_says_no(tmp_path: Path) -> None:
    path = tmp_path / "e.dmc"
    path.write_text("#A\nPR 1\nSP 99999999\nEN\n")
    done = called("run", str(path))
    assert done.returncode == 1 and "error 6 Number out of range in line 2: SP 99999999" in done.stdout
    done = called("run", str(path), "--json")
    assert done.returncode == 1 and json.loads(done.stdout)["errors"][0]["code"] == 6


def test_run_in_real_time(tmp_path: Path) -> None:
    path = tmp_path / "r.dmc"
    path.write_text('WT 1024\nMG "SECOND"\nEN\n')
    began = time.monotonic()
    done = called("run", str(path), "--real-time")
    assert done.returncode == 0 and "SECOND" in done.stdout and time.monotonic() - began > 1


# ----------------------------------------------------------------- simulate


@pytest.mark.paced
def test_simulate_with_everything(tmp_path: Path) -> None:
    profile, eeprom, plant = tmp_path / "mine.toml", tmp_path / "burned", tmp_path / "p.toml"
    profile.write_text('revision = "Rev 7.7q"\n')
    plant.write_text("[axis.x]\nviscous_friction = 0.006\n")
    options = ["--controller", "ssc2", "--tcp", "127.0.0.1:0", "--port2", "127.0.0.1:0", "--profile", str(profile)]
    options += ["--eeprom", str(eeprom), "--plant", str(plant), "--baud", "38400", "--no-handshake"]
    with served(*options, end=signal.SIGTERM) as (first, second):
        assert talk(first, b"\x12\x16", b":") == b"DMC1520 Rev 7.7q\r\n:"
        host, port = second.split(":")
        with socket.create_connection((host, int(port)), timeout=20) as operator:
            assert talk(first, b'MG{P2}"HELLO"\r', b":") == b":"
            assert operator.recv(100)[:1] == b"H"
        assert talk(first, b"KP 17;BN\r", b"::") == b"::"
    with served("--controller", "ssc2", "--eeprom", str(eeprom)) as (address,):
        assert talk(address, b"KP ?\r", b":") == b" 0017.00\r\n:"


def test_simulate_paces_its_line() -> None:
    with served("--controller", "ssc1", "--baud", "1200") as (address,):
        talk(address, b"\r", b":")
        began = time.monotonic()
        talk(address, b"TP\r", b"\r\n:")
        assert time.monotonic() - began > 17 * 10 / 1200  # 3 characters there, 14 back


def test_simulate_a_chain() -> None:
    with served("--controller", "dmc1412", "--chain", "3") as (address,):
        assert talk(address, b"%2\rV=5;V={F1.0}\r", b"\r\n:") == b":: 5\r\n:"


@pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminals")
def test_simulate_on_a_pseudo_terminal() -> None:
    import os

    with served("--controller", "ssc1", "--pty") as (name,):
        terminal = os.open(name, os.O_RDWR | os.O_NOCTTY)
        os.write(terminal, b"MG 6*7{F3.0}\r")
        came = b""
        while not came.endswith(b":"):
            assert select.select([terminal], [], [], 20)[0], came
            came += os.read(terminal, 100)
        os.close(terminal)
        assert came == b" 042\r\n:"


# ---------------------------------------------------------------- line tools


@pytest.mark.paced
def test_line_tools_on_a_chain(source: Path, tmp_path: Path) -> None:
    kept = tmp_path / "kept.dmc"
    with served("--controller", "ssc1", "--chain", "2") as (address,):
        line = ["--port", f"socket://{address}", "--address", "1", "--baud", "19200", "--handshake", "rts"]
        refused = called("download", str(source), *line)
        assert refused.returncode == 2 and "--control" in refused.stderr
        assert called("download", str(source), *line, "--control").returncode == 0
        assert called("upload", *line, "-o", str(kept)).returncode == 0
        assert kept.read_text() == SOURCE
        assert called("upload", *line, "-o", str(kept)).returncode == 2
        again = called("upload", *line, "-o", str(kept), "--force")
        assert again.returncode == 0, again.stderr
        typed = subprocess.run(
            [*COMMAND, "terminal", *line, "--control"],
            cwd=ROOT,
            input="MG 6*7{F3.0}\nbg\n",
            capture_output=True,
            text=True,
            timeout=60,
        )
        assert typed.returncode == 0
        assert typed.stdout.splitlines()[0].strip() == "042" and "Unrecognized command" in typed.stdout


@pytest.mark.paced
def test_conform(tmp_path: Path) -> None:
    flipped, found = tmp_path / "flipped.toml", tmp_path / "found.toml"
    flipped.write_text('status_sign = true\necho_return = "CR"\n')
    with served("--controller", "ssc1", "--profile", str(flipped)) as (address,):
        port = ["conform", "--port", f"socket://{address}"]
        done = called(*port, "-o", str(found))
        assert done.returncode == 1 and done.stderr == ""
        differs = [line for line in done.stdout.splitlines() if line.startswith("differs: ")]
        assert [line.split()[1] for line in differs] == ["echo_return", "status_sign"]
        assert "not seen: burn_parameters_ms" in done.stdout
        again = called(*port, "-o", str(found))
        assert again.returncode == 2 and "--force" in again.stderr
        assert talk(address, b"TB\r", b":") == b" 000\r\n:"
    with served("--controller", "ssc1", "--profile", str(found)) as (address,):
        assert talk(address, b"TB\r", b":") == b" 000\r\n:"
        assert talk(address, b"JG 500;BGX\r", b"::") == b"::"
        moving = called("conform", "--port", f"socket://{address}", "-o", str(tmp_path / "no.toml"))
        assert moving.returncode == 2
        assert moving.stderr.endswith("X moves; wait until everything stands and try again\n")


@pytest.mark.paced
@pytest.mark.long
def test_conform_with_the_simulator(tmp_path: Path) -> None:
    done = subprocess.run(
        [*COMMAND, "conform", "--port", "simulator:dmc1412", "--cw", "2"],
        cwd=tmp_path,
        env={"PYTHONPATH": str(ROOT), "PATH": ""},
        capture_output=True,
        text=True,
        timeout=180,
    )
    assert done.returncode == 0, done
    assert (tmp_path / "dmc1412-profile.toml").exists()


def test_ports_and_version() -> None:
    assert called("ports").returncode == 0
    assert re.fullmatch(r"twoletter \S+\n", called("--version").stdout)
