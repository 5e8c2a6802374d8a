"""Compares the open program and its setup with the controller and with what was burned; reading is all it does."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from datetime import datetime
from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QWidget

from app import facts as need
from app.backup_eeprom import Eeprom, lines_of
from app.connection import Connection
from app.facts import Facts
from app.run import Run
from app.session import Session
from codegen.difference_report import Held, Report, report
from codegen.difference_values import wanted
from codegen.twoletter.slow_mark import FULL
from device.api import Controller, Job, Kind
from device.backing_up import backup_steps
from device.backup import Backup
from device.backup_burned import keyed
from device.tasks import Priority

if TYPE_CHECKING:
    from widgets.compare.window import CompareWindow


class Comparing(QObject):
    """The window, and what was read for it."""

    show_step = Signal(str)

    def __init__(
        self,
        connection: Connection,
        run: Run,
        session: Session,
        eeprom: Eeprom,
        parent: QWidget,
        now: Callable[[], datetime] = datetime.now,
    ) -> None:
        super().__init__(parent)
        self._connection, self._run, self._session, self._eeprom = connection, run, session, eeprom
        self._parent, self._now = parent, now
        self.window: CompareWindow | None = None
        self._read: tuple[Controller, Backup, str] | None = None
        self._shown: tuple[object, ...] = ()

    def show(self) -> None:
        """What is known at once; the controller is read where that is possible."""
        from widgets.compare.window import CompareWindow

        if self.window is None:
            self.window = CompareWindow(self._parent)
            self.window.read_wanted.connect(self.read)
            self.window.cancelled.connect(self._run.cancel)
            self.window.step_wanted.connect(self._show_step)
        self._shown = ()
        self.window.show()
        self.window.raise_()
        self.window.activateWindow()

    def read(self) -> None:
        """Program, parameters and variables, also in Watch and while a program runs; not while one asks."""
        controller = self._connection.controller
        job: Job[Backup] = Job()
        job.future = controller.run(backup_steps(controller, job, running=True), Priority.DOWNLOAD, "download")
        self._run.begin("Reading the controller", job, partial(self._found, controller))

    def look(self, facts: Facts) -> None:
        """With each tick: the report is brought up to date when anything it says has changed."""
        window = self.window
        if window is None or not window.isVisible():
            return
        controller = self._connection.controller
        read = self._read if self._read is not None and self._read[0] is controller else None
        reason = need.live(facts) or need.quiet(facts)
        doing = facts.busy if facts.busy else ""
        window.show_read(reason if not doing else facts.busy, doing, read[2] if read is not None else "")
        document = self._session.document
        shown = (controller, controller.listing, controller.doubt, document, read, self._eeprom.known)
        if all(one is other for one, other in zip(shown, self._shown, strict=False)) and self._shown:
            return
        self._shown = shown
        window.show_report(self._report())

    def proof(self) -> tuple[str, ...]:
        """What is known now, in sentences; nothing while nothing is connected."""
        return self._report().summary if self._connection.controller.kind is not Kind.OFFLINE else ()

    def _report(self) -> Report:
        controller, document = self._connection.controller, self._session.document
        read = self._read if self._read is not None and self._read[0] is controller else None
        known = controller.listing if not controller.doubt else None
        held = Held(
            program=self._eeprom.told(known) if known is not None else None,
            parameters=keyed(read[1].parameters, controller.axes) if read is not None else None,
            variables=read[1].variables if read is not None else None,
            percent=self._run.held().percent if known is not None else FULL,
        )
        return report(lines_of(document), wanted(document.setup), held, self._eeprom.known, document.setup)

    def _found(self, controller: Controller, future: Future[Any]) -> None:
        self._read = (controller, future.result(), f"{self._now():%H:%M}")
        self._shown = ()

    def _show_step(self, number: int) -> None:
        assert self.window is not None and self.window.report is not None
        cell = self.window.report.program[number].cells[0]
        lines = lines_of(self._session.document)
        if cell is not None and 0 <= cell.first < len(lines) and lines[cell.first].step:
            self.show_step.emit(lines[cell.first].step)
