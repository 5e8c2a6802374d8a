"""terminal, download, upload and ports: calls that talk to a controller."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.__main__ import main
from device.simulator.process import SimulatorProcess
from resources import path as resource

CUTTER = str(resource("examples/wire-cutter.tlp"))
Said = pytest.CaptureFixture[str]


@pytest.fixture
def controller() -> Iterator[SimulatorProcess]:
    """A simulated controller on a TCP port, which looks like a machine to who connects there."""
    with SimulatorProcess("ssc1") as process:
        yield process


def test_terminal_sends_lines_and_shows_answers(monkeypatch: pytest.MonkeyPatch, capsys: Said) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO("MG 6*7{F3.0}\nDP 21\nTPX\nbg\n"))
    assert main(["terminal", "--port", "simulator:dmc1412"]) == 0
    lines = capsys.readouterr().out.splitlines()
    # dmc-1412-1414.txt l.3770, l.1396-1403
    assert lines[0].strip() == "042" and lines[1] == " 0000000021"
    assert lines[2].startswith("? ") and "Unrecognized command" in lines[2]


def test_terminal_answers_a_prompt(monkeypatch: pytest.MonkeyPatch, capsys: Said, tmp_path: Path) -> None:
    source = tmp_path / "ask.dmc"
    source.write_text('#A\nIN "LENGTH",LEN\nMG "GOT",LEN{F3.0}\nEN\n')
    with SimulatorProcess("dmc1412") as process:
        assert main(["download", str(source), "--port", process.address, "--control"]) == 0
        monkeypatch.setattr("sys.stdin", io.StringIO("XQ #A\n"))
        assert main(["terminal", "--port", process.address, "--control"]) == 0
        assert "LENGTH" in capsys.readouterr().out
        process.stimulus("type", "12\r")
        assert process.state()["threads"][0]["running"] or process.state()["variables"]["LEN"] == 12


def test_download_needs_control_on_a_machine(controller: SimulatorProcess, capsys: Said) -> None:
    assert main(["download", CUTTER, "--port", controller.address]) == 2
    said = capsys.readouterr().err
    assert "--control" in said and said.count("\n") == 1
    assert main(["upload", "--port", controller.address]) == 0
    assert capsys.readouterr().out.strip() == ""


def test_download_and_upload_again(controller: SimulatorProcess, tmp_path: Path, capsys: Said) -> None:
    assert main(["download", CUTTER, "--port", controller.address, "--control"]) == 0
    assert "verified" in capsys.readouterr().out
    kept = tmp_path / "kept.dmc"
    assert main(["upload", "--port", controller.address, "-o", str(kept)]) == 0
    assert main(["compile", CUTTER]) == 0
    assert kept.read_text() in capsys.readouterr().out
    assert kept.read_text().splitlines()[0] == "#CUTTER"
    assert main(["upload", "--port", controller.address, "-o", str(kept)]) == 2
    assert "--force" in capsys.readouterr().err
    assert main(["upload", "--port", controller.address, "-o", str(kept), "--force"]) == 0


def test_download_to_a_simulator_needs_no_control(capsys: Said) -> None:
    assert main(["download", CUTTER, "--port", "simulator:ssc1"]) == 0
    assert "15 lines" in capsys.readouterr().out


def test_a_program_the_controller_can_not_hold(tmp_path: Path, controller: SimulatorProcess, capsys: Said) -> None:
    source = tmp_path / "wide.dmc"
    source.write_text("#A\n" + "V=1;" * 30 + "\nEN\n")
    assert main(["download", str(source), "--port", controller.address, "--control"]) == 1
    said = capsys.readouterr().err
    assert "80" in said and said.count("\n") == 1


@pytest.mark.parametrize("port", ["/dev/no-such-port", "socket://127.0.0.1:1"])
def test_nobody_there_is_one_sentence(port: str, capsys: Said) -> None:
    assert main(["upload", "--port", port]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"twoletter: {port}: ") and said.count("\n") == 1


def test_ports_lists_what_is_there(capsys: Said) -> None:
    assert main(["ports"]) == 0
    assert capsys.readouterr().out.strip()
