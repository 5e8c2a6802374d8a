"""`twoletter backup` and `restore` from outside, over TCP to a served simulator."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.__main__ import main
from device.backup import load
from device.simulator.process import SimulatorProcess


def test_a_controller_is_backed_up_and_another_becomes_the_same(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.settings.data_folder", lambda: tmp_path / "data")
    program, file = tmp_path / "a.dmc", tmp_path / "kept.tlb"
    program.write_text("#A\nSP 20000\nEN\n")
    with SimulatorProcess("ssc1") as one:
        line = ["--port", one.address, "--control"]
        assert main(["download", str(program), *line]) == 0
        assert main(["backup", *line, "-o", str(file), "--note", "as delivered"]) == 0
        assert main(["backup", *line, "-o", str(file)]) == 2  # never over another without saying so
    backup = load(file)
    assert (backup.model, backup.note, backup.program) == ("ssc1", "as delivered", "#A\nSP 20000\nEN")
    capsys.readouterr()
    with SimulatorProcess("ssc1") as other:
        line = ["--port", other.address, "--control"]
        assert main(["restore", str(file), *line]) == 0
        assert "Restored and compared" in capsys.readouterr().out
        (before,) = (tmp_path / "data" / "backups" / "ssc1 1").iterdir()
        assert load(before).program == ""  # what was in the controller before is kept
        assert main(["upload", *line]) == 0
        assert capsys.readouterr().out == "#A\nSP 20000\nEN\n"


def test_a_machine_is_not_restored_without_control(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "kept.tlb"
    with SimulatorProcess("dmc1412") as one:
        assert main(["backup", "--port", one.address, "-o", str(file)]) == 0
        assert main(["restore", str(file), "--port", one.address]) == 2
    assert "needs --control" in capsys.readouterr().err


def test_a_file_that_is_no_backup_is_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "a.tlb"
    file.write_text("{}")
    assert main(["restore", str(file), "--port", "simulator:ssc1"]) == 2
    said = capsys.readouterr().err
    assert said == "twoletter: a.tlb is not a back-up of a controller: it does not say that it is one\n"
