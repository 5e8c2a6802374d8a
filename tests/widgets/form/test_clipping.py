"""No dialog cuts anything: every label, button and line stands whole inside it, and nothing scrolls."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest
from pytestqt.qtbot import QtBot

from codegen.instructions import ALL, Instruction, MotionParameters
from tests.widgets.form.clipping import FORMS, PANEL, cut, open_dialog, settle
from widgets.form import room

EVERY = pytest.mark.parametrize("kind", ALL, ids=lambda kind: kind.__name__)


@pytest.fixture(autouse=True)
def panel(monkeypatch: pytest.MonkeyPatch) -> None:
    """A screen of 1280 x 800."""
    monkeypatch.setattr(room, "screen_of", lambda widget: PANEL)


@EVERY
@pytest.mark.parametrize(("model", "filling"), FORMS)
def test_a_dialog_shows_everything_whole(qtbot: QtBot, kind: type[Instruction], model: str, filling: str) -> None:
    dialog = open_dialog(kind, model, filling)
    qtbot.addWidget(dialog)
    assert list(cut(dialog)) == []


@EVERY
def test_a_dialog_grows_with_what_it_shows(qtbot: QtBot, kind: type[Instruction]) -> None:
    dialog = open_dialog(kind, "ssc4", "empty")
    qtbot.addWidget(dialog)
    dialog.form.show_instruction(kind.example())
    settle()
    assert list(cut(dialog)) == []


def test_the_measure_finds_what_is_cut(qtbot: QtBot) -> None:
    dialog = open_dialog(MotionParameters, "ssc4", "example")
    qtbot.addWidget(dialog)
    dialog.fit = lambda: None  # type: ignore[method-assign]
    dialog.setFixedSize(360, 300)
    settle()
    found = list(cut(dialog))
    assert any("Deceleration" in what and "leaves" in what for what in found)
    assert "the fields scroll" in found


def test_at_200_percent_in_the_dark_theme_nothing_is_cut_either() -> None:
    surroundings = {**os.environ, "QT_QPA_PLATFORM": "offscreen", "QT_SCALE_FACTOR": "2"}
    command = [sys.executable, "-m", "tests.widgets.form.clipping", "dark"]
    done = subprocess.run(command, env=surroundings, capture_output=True, text=True, check=True, timeout=120)
    assert done.stdout == ""
