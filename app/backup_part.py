"""Prove it, back-up and what is known of the EEPROM: made and joined here, handed to the studio as one part."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from app.backup_before import Keeping
from app.backup_compare import Comparing
from app.backup_eeprom import Eeprom
from app.backup_handover import Handing
from app.backups import Backups
from app.connection import Connection
from app.facts import Facts
from app.run import Ask, Run
from app.session import Session
from app.tick import Tick
from app.window import Window
from widgets.program.view import ProgramView


class BackupPart(QObject):
    """`look` is called with each tick."""

    said = Signal(str)

    def __init__(
        self,
        connection: Connection,
        run: Run,
        session: Session,
        ask: Ask,
        data: Path,
        tick: Tick,
        program: ProgramView,
        window: Window,
        now: Callable[[], datetime] = datetime.now,
    ) -> None:
        super().__init__(window)
        self._bar = window.run_bar
        self.keeping = Keeping(connection, run, ask, lambda: session.document.setup, data, now, self)
        self.eeprom = Eeprom(connection, run, session, data, now, self)
        self.backups = Backups(connection, run, self.keeping, ask, window)
        self.comparing = Comparing(connection, run, session, self.eeprom, window, now)
        self.handing = Handing(connection, session, tick, program, window, self.comparing.proof, now)
        run.before = self.keeping.before
        self._bar.badge.clicked.connect(self.comparing.show)
        for part in (self.keeping, self.eeprom, self.backups, self.handing):
            part.said.connect(self.said)

    def look(self, facts: Facts) -> None:
        """What was typed, what is under way, what is possible."""
        self.eeprom.look()
        self.backups.look(facts)
        self.comparing.look(facts)
        self.handing.look()
        self._bar.show_eeprom(self.eeprom.same_as_controller, self.eeprom.words)
