"""A studio on a stage for every test that wants one."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from tests.stage import Stage, make_studio


@pytest.fixture
def stage(qtbot: QtBot, tmp_path: Path) -> Iterator[Stage]:
    """Offline, the wire cutter open, shown."""
    stage = make_studio(tmp_path)
    qtbot.addWidget(stage.studio.window)
    stage.studio.window.resize(1280, 800)
    stage.studio.window.show()
    stage.go()
    yield stage
    stage.studio.close()
