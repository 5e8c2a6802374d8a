"""Before a download, a burn or a restore: what it replaces is kept first; the only place that writes kept back-ups."""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import Future
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, Signal

from app.connection import Connection
from app.run import Ask, Run
from app.tick import failure_of
from codegen.disk import FileUnreadable
from codegen.files import setup_dumps
from codegen.setup import Setup
from device.api import Controller, Job, Kind, NotAllowed, State
from device.backing_up import backup_steps
from device.backup import Backup, load
from device.backup_kept import adds_nothing, controller_name, keep, kept
from device.tasks import Priority

BUDGET_S = 0.6  # what a download may take longer; the rest is left out, and named
DOWNLOAD = "before a download"
FOLDER = "backups"


class Keeping(QObject):
    """Takes back-ups and keeps them by controller."""

    said = Signal(str)
    changed = Signal()  # there is one more

    def __init__(
        self,
        connection: Connection,
        run: Run,
        ask: Ask,
        setup: Callable[[], Setup],
        folder: Path,
        now: Callable[[], datetime] = datetime.now,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._connection, self._run, self._ask, self._setup, self._now = connection, run, ask, setup, now
        self._root = folder / FOLDER

    def folder(self) -> Path | None:
        """Where those of the connected controller are; None while there is none, or its type is not known."""
        controller = self._connection.controller
        return folder_of(self._root, controller)

    def before(self, reason: str, go_on: Callable[[str | None], None]) -> None:
        """Keeps what is there, then goes on with the program that was read; asks when it cannot be kept."""
        controller = self._connection.controller
        if controller.state is not State.READY or controller.model is None or not controller.control:
            go_on(None)  # what comes next says why it is not possible
            return

        def failed(future: Future[Any]) -> None:
            words = failure_of(future)
            if isinstance(future.exception(), NotAllowed):
                go_on(None)  # something runs or moves: what comes next refuses, with its own words
            elif "cancelled" in words:
                self.said.emit(words)
            else:
                self._doubt(reason, words, go_on)

        def finished(future: Future[Any]) -> None:
            found: Backup = future.result()
            words = self._write(controller, found)
            if words:
                self._doubt(reason, words, partial(go_on, found.program))
            elif controller is self._connection.controller:
                go_on(found.program)

        budget = BUDGET_S if reason == DOWNLOAD else math.inf
        self._run.begin("Backing up", self._job(controller, reason, "", budget), finished, failed)

    def now(self, note: str, then: Callable[[], None] = lambda: None) -> None:
        """Everything the controller holds, because a person wants it."""
        controller = self._connection.controller

        def finished(future: Future[Any]) -> None:
            words = self._write(controller, future.result(), always=True)
            self.said.emit(words or "Backed up.")
            if not words:
                then()

        self._run.begin("Backing up", self._job(controller, "", note, math.inf), finished)

    def _job(self, controller: Controller, reason: str, note: str, budget_s: float) -> Job[Backup]:
        job: Job[Backup] = Job()
        steps = backup_steps(
            controller,
            job,
            note,
            self._connection.address,
            setup=setup_dumps(self._setup()),
            reason=reason,
            budget_s=budget_s,
            taken=self._now(),
        )
        job.future = controller.run(steps, Priority.DOWNLOAD, "download")
        return job

    def _write(self, controller: Controller, found: Backup, always: bool = False) -> str:
        """Keeps it, unless the newest one holds the same; why that failed, or nothing."""
        folder = folder_of(self._root, controller)
        if folder is None or not (always or found.program or found.variables):
            return ""  # an empty controller: nothing is lost
        try:
            newest = next(iter(kept(folder)), None) if not always else None
            if newest is not None and not newest.broken and _same(newest.path, found):
                return ""
            keep(folder, found, self._now())
        except OSError as reason:
            return f"The back-up cannot be written: {(reason.strerror or str(reason)).lower()}."
        self.changed.emit()
        return ""

    def _doubt(self, reason: str, words: str, go_on: Callable[..., None]) -> None:
        what = reason.removeprefix("before a ")
        self._ask(
            "Nothing was kept",
            f"{words} What the controller holds now would be lost.",
            [(f"Go on with the {what}", lambda: go_on() if isinstance(go_on, partial) else go_on(None))],
            "warning",
        )


def folder_of(root: Path, controller: Controller) -> Path | None:
    """Where the back-ups of a controller are."""
    if controller.model is None or controller.kind in (Kind.OFFLINE, Kind.REPLAY):
        return None
    return root / controller_name(controller.model.name, controller.identity, controller.kind is Kind.SIMULATOR)


def _same(path: Path, found: Backup) -> bool:
    try:
        return adds_nothing(load(path), found)
    except FileUnreadable:
        return False
