"""The tuner with its logbook and what an interrupted tuning left: made and joined here, with the first tick."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from app.former_offer import Offer
from app.late import TUNING
from app.tuner import Tuner
from app.tuner_book import Book
from app.tuner_memory import Memory
from widgets.tuner.panel import TunerPanel

if TYPE_CHECKING:
    from app.compose import Studio
    from device.tuning.entry import Entry


class TunerPart(QObject):
    """`panel` goes into a dock; everything else is joined already."""

    def __init__(self, studio: Studio, data: Path) -> None:
        super().__init__(studio)
        folder, now = data / TUNING, datetime.now
        connection, session, tick, ask = studio.connection, studio.session, studio.tick, studio.desk.ask
        self.panel = TunerPanel()
        self.book = Book(connection, session, self.panel, folder, studio.window, now, tick)
        self.memory = Memory(studio.settings, session, self.panel, lambda: self.book.machine, self)
        self.tuner = Tuner(
            connection, session, studio.run, tick, self.panel, self.book, self.memory, ask, studio.right.careful,
            folder, self, now,
        )  # fmt: skip
        self.offer = Offer(connection, tick, studio.in_turn.ask, folder, lambda: self.tuner.job is not None, self)
        self._recorder = studio.recorder
        self.book.added.connect(self._record)
        for part in (self.book, self.tuner, self.offer):
            part.said.connect(studio.desk.say)
        tick.each(self.tuner.look)
        tick.each(self.offer.look)

    def _record(self, entry: Entry) -> None:
        """A run stands in the recording as it stands in the logbook."""
        from device.tuning.entry import to_data

        self._recorder.note("tuning run", to_data(entry))
