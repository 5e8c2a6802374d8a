"""The copy that survives a crash is written beside the window: a slow disk holds nobody up."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

import app.recovery
from app.session import Session
from codegen.disk import save_text
from codegen.instructions import Wait


class Disk:
    """Writes when it is let."""

    def __init__(self) -> None:
        self.asked, self.let = threading.Event(), threading.Event()
        self.full = False

    def __call__(self, path: Path, text: str) -> None:
        self.asked.set()
        assert self.let.wait(30)
        if self.full:
            raise OSError(28, "No space left on device")
        save_text(path, text)


@pytest.fixture
def disk(monkeypatch: pytest.MonkeyPatch) -> Iterator[Disk]:
    disk = Disk()
    monkeypatch.setattr(app.recovery, "save_text", disk)
    yield disk
    disk.let.set()


def begun(qtbot: QtBot, folder: Path, disk: Disk) -> Session:
    """A change whose copy is being written."""
    session = Session(recovery_folder=folder / "recovery", autosave_ms=10)
    session.insert([Wait(time="1")])
    qtbot.waitUntil(disk.asked.is_set, timeout=5000)
    return session


def copies(folder: Path) -> list[str]:
    return [file.read_text(encoding="utf-8") for file in (folder / "recovery").glob("*.recovery")]


def test_the_window_goes_on_while_a_copy_is_written(qtbot: QtBot, tmp_path: Path, disk: Disk) -> None:
    session = begun(qtbot, tmp_path, disk)
    session.insert([Wait(time="4711")])
    assert not copies(tmp_path)
    disk.let.set()
    qtbot.waitUntil(lambda: any("4711" in copy for copy in copies(tmp_path)), timeout=5000)
    session.close()
    assert not copies(tmp_path)


def test_an_older_copy_never_comes_after_a_newer_one(qtbot: QtBot, tmp_path: Path, disk: Disk) -> None:
    session = begun(qtbot, tmp_path, disk)
    session.insert([Wait(time="4711")])
    threading.Timer(0.1, disk.let.set).start()
    session.autosave_now()
    assert "4711" in copies(tmp_path)[0]
    qtbot.wait(200)
    assert "4711" in copies(tmp_path)[0]
    session.close()


def test_what_is_saved_meanwhile_leaves_no_copy(qtbot: QtBot, tmp_path: Path, disk: Disk) -> None:
    session = begun(qtbot, tmp_path, disk)
    threading.Timer(0.1, disk.let.set).start()
    session.save_as(tmp_path / "saved.tlp")
    qtbot.wait(200)
    assert not copies(tmp_path) and not session.dirty
    session.close()


def test_a_disk_that_is_full_is_said(qtbot: QtBot, tmp_path: Path, disk: Disk) -> None:
    session, disk.full = begun(qtbot, tmp_path, disk), True
    with qtbot.waitSignal(session.autosave_failed, timeout=5000) as said:
        disk.let.set()
    assert said.args == ["Unsaved work cannot be kept safe: No space left on device"]
    session.close()
