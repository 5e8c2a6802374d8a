"""The tick: visible panels only, everything once, futures in the window's own thread, crashes stop first."""

from __future__ import annotations

import math
import sys
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import QTimer
from pytestqt.qtbot import QtBot

from app.crash import CrashHook
from app.tick import OWNER, Tick, failure_of
from device.api import Notice, Row
from tests.rig import Rig
from tests.stage import Stage
from widgets.panel import Panel


class Spy(Panel):
    """Counts what it is given."""

    title = "Spy"

    def __init__(self, keys: tuple[str, ...]) -> None:
        super().__init__()
        self.keys, self.rows, self.heard = keys, 0, []  # type: ignore[var-annotated]

    def watches(self) -> tuple[str, ...]:
        return self.keys

    def refresh(self, row: Row) -> None:
        self.rows += 1

    def notice(self, notice: Notice) -> None:
        self.heard.append(notice.text)


def done(value: Any) -> Future[Any]:
    """A future that is finished already."""
    future: Future[Any] = Future()
    future.set_result(value)
    return future


@pytest.fixture
def rig() -> Rig:
    return Rig().ready()


@pytest.fixture
def tick(qtbot: QtBot, rig: Rig) -> Tick:
    tick = Tick()
    tick.attach(rig.controller)
    return tick


def test_only_visible_panels_are_refreshed_and_polled_for(qtbot: QtBot, tick: Tick, rig: Rig) -> None:
    shown, hidden = Spy(("position.x",)), Spy(("inputs",))
    for panel in (shown, hidden):
        qtbot.addWidget(panel)
        tick.add(panel)
    shown.resize(100, 100)
    shown.show()
    tick.once()
    assert (shown.rows, hidden.rows) == (1, 0)
    rig.until(lambda: rig.controller.last().value("position.x") == 0)
    rig.run(2.0)
    assert math.isnan(rig.controller.last().value("inputs"))
    shown.hide()
    tick.once()
    rig.run(1.5)  # once a second something is read in any case; what nobody wants is gone then
    assert math.isnan(rig.controller.last().value("position.x"))


def test_a_tick_asks_anew_only_when_something_else_is_shown(tick: Tick, rig: Rig) -> None:
    rig.controller.watch(OWNER, ("inputs",))  # as if somebody else had said so: a tick without a change leaves it
    tick.once()
    tick.once()
    assert rig.controller.poller.wanted() == ("inputs",)


def test_notices_reach_hidden_panels_too(qtbot: QtBot, tick: Tick, rig: Rig) -> None:
    panel = Spy(())
    qtbot.addWidget(panel)
    tick.add(panel)
    rig.run(0.5)
    tick.once()
    panel.heard.clear()
    rig.start('MG "LIMIT"\nEN')
    rig.run(0.5)
    tick.once()
    tick.once()
    assert panel.heard == ["LIMIT"]


def test_a_future_calls_back_once_it_is_done(tick: Tick) -> None:
    future: Future[int] = Future()
    seen: list[int] = []
    tick.when_done(future, lambda finished: seen.append(finished.result()))
    tick.once()
    assert seen == []
    future.set_result(5)
    tick.once()
    tick.once()
    assert seen == [5]


def test_a_callback_may_ask_for_the_next_one(tick: Tick) -> None:
    seen: list[str] = []

    def first(_: Future[str]) -> None:
        seen.append("first")
        tick.when_done(done("x"), lambda _: seen.append("second"))

    tick.when_done(done("x"), first)
    tick.once()
    tick.once()
    assert seen == ["first", "second"]


def test_failures_are_sentences() -> None:
    assert failure_of(done(1)) == ""
    failed: Future[int] = Future()
    failed.set_exception(OSError("cable out"))
    assert failure_of(failed) == "cable out"


def test_it_is_the_only_timer_of_the_shell(stage: Stage) -> None:
    ours = [timer for timer in stage.studio.findChildren(QTimer) if timer.interval() < 1000]
    running = [type(timer.parent()) for timer in ours if not timer.isSingleShot()]
    assert running == [Tick]  # what waits once for a pause touches no live data


def test_refreshing_twice_with_the_same_row_changes_nothing(stage: Stage) -> None:
    rig = stage.connect("simulator")
    rig.type("DP 6370")
    readout = stage.studio.display.axes["X"]
    stage.until(lambda: readout.position.text() == "10.000")  # 6370 counts at 637 an inch
    before = readout.position.text()
    changed: list[str] = []
    readout.position.setText = changed.append  # type: ignore[method-assign]
    stage.go()
    assert changed == []
    assert readout.position.text() == before


# ---------------------------------------------------------------- crashes


def crash(hook: CrashHook) -> None:
    try:
        raise ZeroDivisionError("bug")
    except ZeroDivisionError:
        kind, error, trace = sys.exc_info()
    assert kind is not None
    assert error is not None
    hook.take(kind, error, trace)


def test_a_crash_stops_first_then_writes_then_shows(qtbot: QtBot, tmp_path: Path) -> None:
    order: list[str] = []
    hook = CrashHook(tmp_path, lambda: order.append("stop" if not list(tmp_path.glob("*")) else "late"))
    hook._before = lambda *_: order.append("printed")
    crash(hook)
    assert order == ["stop", "printed"]
    (file,) = tmp_path.glob("crash-*.txt")
    assert "ZeroDivisionError: bug" in file.read_text()
    assert hook.dialogs[0].isVisible()
    assert not hook.dialogs[0].isModal()
    hook.dialogs[0].close()


def test_a_stop_that_crashes_too_is_still_written_and_shown(qtbot: QtBot, tmp_path: Path) -> None:
    def broken() -> None:
        raise RuntimeError("stop failed")

    hook = CrashHook(tmp_path, broken)
    hook._before = lambda *_: None
    with pytest.raises(RuntimeError):
        crash(hook)
    assert len(list(tmp_path.glob("crash-*.txt"))) == 1
    assert hook.dialogs[0].isVisible()
    hook.dialogs[0].close()


def test_a_crash_that_can_not_be_written_is_shown_all_the_same(qtbot: QtBot, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    hook = CrashHook(tmp_path / "file" / "crashes", lambda: None)
    hook._before = lambda *_: None
    crash(hook)
    assert hook.dialogs[0].isVisible()
    hook.dialogs[0].close()
