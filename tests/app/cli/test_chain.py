"""Calls that talk to one controller of a daisy chain."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.__main__ import main
from device.simulator.process import SimulatorProcess

pytestmark = pytest.mark.paced


def test_download_to_one_of_a_chain(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = tmp_path / "second.dmc"
    source.write_text("#A\nPR 700;BGX;AMX\nEN\n")
    with SimulatorProcess("dmc1412", chain=2) as process:
        line = ["--port", process.address]
        assert main(["download", str(source), *line, "--address", "1", "--control"]) == 0
        assert "3 lines" in capsys.readouterr().out
        assert main(["upload", *line, "--address", "0"]) == 0
        assert capsys.readouterr().out.strip() == ""
        assert main(["upload", *line, "--address", "1"]) == 0
        assert capsys.readouterr().out.splitlines() == ["#A", "PR 700;BGX;AMX", "EN"]
