"""The command as a process of its own: exit codes, no display, serving, and a short start."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
COMMAND = [sys.executable, "-m", "app"]


def called(*arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """One call, with a bare environment."""
    keep = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    keep.pop("QT_QPA_PLATFORM", None)
    return subprocess.run(
        [*COMMAND, *arguments], cwd=ROOT, env={**keep, **environment}, capture_output=True, text=True, timeout=120
    )


def test_without_a_display_one_line_names_the_demo() -> None:
    done = called()
    if sys.platform.startswith("linux"):
        assert done.returncode == 2
        assert done.stderr.count("\n") == 1 and "twoletter demo" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_display_that_does_not_answer_is_none() -> None:
    done = called("--offline", DISPLAY=":97531")
    if sys.platform.startswith("linux"):
        assert done.returncode == 2 and done.stderr.count("\n") == 1 and "twoletter demo" in done.stderr


def test_version() -> None:
    done = called("--version")
    assert done.returncode == 0 and done.stdout.startswith("twoletter ")


def test_run_as_a_process(tmp_path: Path) -> None:
    source = tmp_path / "a.dmc"
    source.write_text("PR 100\nBGX\nAMX\nEN\n")
    done = called("run", str(source), "--json")
    assert done.returncode == 0 and json.loads(done.stdout)["axes"]["X"]["commanded"] == 100


def test_a_closed_pipe_is_no_traceback(tmp_path: Path) -> None:
    source = tmp_path / "a.dmc"
    source.write_text("N=0\n#A\nMG N\nN=N+1\nJP#A,N<5000\nEN\n")
    process = subprocess.Popen([*COMMAND, "run", str(source)], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdout and process.stderr
    process.stdout.readline()
    process.stdout.close()
    said = process.stderr.read().decode()
    process.wait(60)
    assert "Traceback" not in said


def test_a_full_disk_is_one_line(tmp_path: Path) -> None:
    source = tmp_path / "a.dmc"
    source.write_text("EN\n")
    assert source.exists()
    if Path("/dev/full").exists():
        with Path("/dev/full").open("w") as full:
            done = subprocess.run(
                [*COMMAND, "run", str(source)], cwd=ROOT, stdout=full, stderr=subprocess.PIPE, text=True, timeout=60
            )
        assert done.returncode == 2 and done.stderr.startswith("twoletter: ") and done.stderr.count("\n") == 1


def test_calls_on_files_do_not_load_qt() -> None:
    script = (
        "import sys; from app.__main__ import main; code = main(['check', 'resources/examples/wire-cutter.tlp']); "
        "print([name for name in sys.modules if name.startswith(('PySide6', 'numba', 'pyqtgraph'))], code)"
    )
    done = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, timeout=60)
    assert done.stdout.splitlines()[-1] == "[] 0", done.stderr


def test_simulate_serves_a_controller_until_interrupted() -> None:
    process = subprocess.Popen(
        [*COMMAND, "simulate", "--controller", "dmc1412", "--tcp", "127.0.0.1:0"],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout
    try:
        line = process.stdout.readline()
        assert line.startswith("listening on 127.0.0.1:"), line
        host, port = line.removeprefix("listening on ").strip().split(":")
        with socket.create_connection((host, int(port)), timeout=10) as link:
            link.settimeout(10)
            link.sendall(b"MG 6*7{F3.0}\r")
            came = b""
            while not came.endswith(b":"):
                came += link.recv(100)
        # dmc-1412-1414.txt l.1346: data, CR, LF, prompt
        assert came == b" 042\r\n:"
    finally:
        process.send_signal(signal.SIGINT)
        code = process.wait(20)
    assert code == 0
