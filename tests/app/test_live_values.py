"""Values for the expression builder: read over the line, in Watch too, never while a program waits for an answer."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from app.live_values import LiveValuesReader
from tests.stage import Stage, make_studio


@pytest.fixture
def stage(qtbot: QtBot, tmp_path: Path) -> Iterator[Stage]:
    """A studio that is offline."""
    stage = make_studio(tmp_path)
    yield stage
    stage.clear_away()


def watched(stage: Stage, *texts: str) -> list[Mapping[str, float | str]]:
    """What is told of these texts from now on."""
    reader = LiveValuesReader(stage.studio.connection, stage.studio.tick)
    told: list[Mapping[str, float | str]] = []
    reader.watch(told.append, texts, told.append)
    return told


def test_offline_nothing_is_known(stage: Stage) -> None:
    told = watched(stage, "_TPX")
    stage.go()
    assert told[-1] == {}


def test_values_are_read_in_watch_and_nothing_else_is_sent(stage: Stage) -> None:
    rig = stage.connect("machine", program="#A\nDP 1234\nLEN=2.5\nEN\n#B\nDP 77\nEN")
    rig.simulation.execute("#A")
    stage.go(20)
    assert not stage.controller.control
    before = len(rig.lines)
    told = watched(stage, "_TPX", "LEN", "@IN[1]", "NONE", "P1CD")
    stage.until(lambda: told)
    assert told[-1]["_TPX"] == 1234 and told[-1]["LEN"] == 2.5 and told[-1]["@IN[1]"] in (0.0, 1.0)
    assert isinstance(told[-1]["NONE"], str) and told[-1]["NONE"]
    assert told[-1]["P1CD"] == "not read, because reading clears it"
    assert all(line.startswith("MG") or "_TC" in line or not line for line in rig.lines[before:-1])
    rig.simulation.execute("#B")
    stage.until(lambda: told[-1].get("_TPX") == 77)


def test_nothing_is_read_while_a_program_waits_for_an_answer(stage: Stage) -> None:
    rig = stage.question()
    before = list(rig.lines)
    told = watched(stage, "_TPX")
    stage.go(60)
    assert told and all(str(each["_TPX"]).startswith("not read: ") for each in told)
    assert rig.lines == before
