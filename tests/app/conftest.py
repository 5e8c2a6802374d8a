"""A studio on a stage for every test that wants one."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from tests.long import is_long
from tests.stage import Stage, WhenWanted, make_studio


@pytest.fixture
def stage(
    qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> Iterator[Stage]:
    """Offline, the wire cutter open, shown.

    Every day without the panels at the machine until they are wanted, unless the module says that it is about WHOLE.
    """
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Path, "home", lambda: tmp_path)  # where files are proposed to be saved
    stage = make_studio(tmp_path)
    if not is_long() and not hasattr(request.module, "WHOLE"):
        stage.studio.late.making = WhenWanted(stage.studio.late.making)
    stage.studio.window.resize(1280, 800)
    stage.studio.window.show()
    stage.go()
    yield stage
    stage.clear_away()
