"""The one timer that touches live data: thirty times a second it hands the newest row to whatever is visible."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Qt, QTimer

from app.docks import settle
from widgets.panel import Panel
from widgets.parts.pieces import BREATH_S

if TYPE_CHECKING:
    from device.api import Controller

PERIOD_MS = 33
OWNER = "panels"
NOTHING: tuple[frozenset[str], tuple[str, ...]] = (frozenset(), ())


class Tick(QObject):
    """Drains notices, refreshes visible panels, asks for what they need, and looks after futures."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._panels: list[Panel] = []
        self._each: list[Callable[[], None]] = []
        self._pending: list[tuple[Future[Any], Callable[[Future[Any]], None]]] = []
        self._writes: list[Future[Any]] = []
        self.unwritten = 0  # what could not be written
        self._controller: Controller | None = None
        self._to_show: list[Panel] = []  # of what is seen in them not all is of this controller yet
        self._watched = NOTHING
        self.around: Callable[[], AbstractContextManager[None]] = nullcontext
        self._timer = QTimer(self)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.setInterval(PERIOD_MS)
        self._timer.timeout.connect(self.once)

    def start(self) -> None:
        """Begins ticking."""
        self._timer.start()

    def stop(self) -> None:
        """No more ticks."""
        self._timer.stop()

    def add(self, panel: Panel) -> None:
        """A panel that wants rows and notices."""
        self._panels.append(panel)

    def each(self, call: Callable[[], None]) -> None:
        """Something to do with every tick, after the panels."""
        self._each.append(call)

    def attach(self, controller: Controller) -> None:
        """Works with another controller from now on; the panels show it one after the other."""
        self._controller = controller
        self._watched = NOTHING
        for panel in self._panels:
            panel.take(controller)
        self._to_show = [panel for panel in self._panels if type(panel).show_controller is not Panel.show_controller]
        for panel in self._to_show:
            panel.veil()

    def show_all(self) -> None:
        """For whoever cannot wait for the ticks: every panel shows the controller there is."""
        while self._to_show:
            self._show(self._to_show[0])

    def _show(self, panel: Panel) -> None:
        self._to_show.remove(panel)
        panel.show_controller()
        panel.unveil()

    def _show_next(self) -> bool:
        """One that is in sight, else as many as take no longer than a breath; False when all do."""
        if not self._to_show:
            return False
        seen = next((panel for panel in self._to_show if panel.in_sight), None)
        if seen is not None:
            self._show(seen)
            return True
        began = time.perf_counter()
        while self._to_show and time.perf_counter() - began < BREATH_S:
            self._show(self._to_show[0])
        return True

    def look(self, panel: Panel) -> None:
        """A panel has come to the front: what stood in it then may not hold any more, and is not seen for a moment."""
        if self._controller is not None and panel.making.done and panel not in self._to_show and panel in self._panels:
            panel.refresh(self._controller.last())

    def when_done(self, future: Future[Any], call: Callable[[Future[Any]], None]) -> None:
        """Calls back, here in the window's own thread, once the future is finished; cancelled ones are forgotten."""
        self._pending.append((future, call))

    def when_written(self, future: Future[Any], call: Callable[[Future[Any]], None]) -> None:
        """The same of what is on its way to the disk: the window waits for it before it closes."""
        self._writes.append(future)
        self.when_done(future, call)

    @property
    def writing(self) -> bool:
        """Whether something is still on its way to the disk."""
        return bool(self._writes)

    def once(self) -> None:
        """One tick; tests call it themselves."""
        with self.around():
            self._live()
            self._finish_futures()
            for call in self._each:
                call()
            settle()

    def _live(self) -> None:
        controller = self._controller
        if controller is None:
            return
        for notice in controller.notices():
            for panel in self._panels:
                panel.notice(notice)
        busy = self._show_next()
        shown = [panel for panel in self._panels if panel.in_sight and panel not in self._to_show]
        watched = frozenset(key for panel in shown for key in panel.watches())
        drawn = tuple(dict.fromkeys(key for panel in shown for key in panel.draws()))
        if (watched, drawn) != self._watched:
            self._watched = watched, drawn
            controller.watch(OWNER, sorted(watched), each_round=drawn)
        growing = next((panel for panel in shown if not panel.making.done), None)
        if growing is not None and not busy:
            growing.grow()  # alone: its first look at the row comes with the next tick, and so do other panels' pieces
        row = controller.last()
        for panel in shown:
            if panel is not growing and panel.making.done:
                panel.refresh(row)

    def _finish_futures(self) -> None:
        done = [pair for pair in self._pending if pair[0].done()]
        self._pending = [pair for pair in self._pending if pair not in done]
        for future, call in done:
            if future in self._writes:
                self._writes.remove(future)
                self.unwritten += future.cancelled() or future.exception() is not None
            if not future.cancelled():
                call(future)


def failure_of(future: Future[Any]) -> str:
    """Why a finished future failed, in a sentence; empty when it did not."""
    try:
        error = future.exception()
    except CancelledError:
        return "cancelled"
    return "" if error is None else str(error) or type(error).__name__
