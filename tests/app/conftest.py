"""A studio on a stage for every test that wants one."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from tests.stage import Stage, make_studio


@pytest.fixture
def stage(qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Stage]:
    """Offline, the wire cutter open, shown."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Path, "home", lambda: tmp_path)  # where files are proposed to be saved
    stage = make_studio(tmp_path)
    stage.studio.window.resize(1280, 800)
    stage.studio.window.show()
    stage.go()
    yield stage
    stage.clear_away()
