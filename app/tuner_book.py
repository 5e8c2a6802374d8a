"""The logbook page: runs over each other, notes, back to earlier gains, data files and the commissioning report."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QWidget

from app.connection import Connection
from app.session import Session
from app.tick import Tick
from widgets.parts import files
from widgets.tuner.panel import MANUAL, TunerPanel

if TYPE_CHECKING:
    from device.tuning.bench import Measured
    from device.tuning.entry import Entry
    from device.tuning.logbook import Logbook
    from widgets.program.printing import PrintPreview

DATA = "Tables (*.csv);;NumPy (*.npz)"


class Book(QObject):
    """One file per machine: by serial number, else by the setup's name."""

    said = Signal(str)
    added = Signal(object)  # an Entry, for the recorder

    def __init__(
        self,
        connection: Connection,
        session: Session,
        panel: TunerPanel,
        folder: Path,
        parent: QWidget,
        now: Callable[[], datetime],
        tick: Tick,
    ) -> None:
        super().__init__(parent)
        self._tick = tick
        self._writer: ThreadPoolExecutor | None = None
        self._connection, self._session, self._panel = connection, session, panel
        self._folder, self._parent, self._now = folder, parent, now
        self._book: Logbook | None = None
        self.last: Measured | None = None  # what `Save data` writes
        self.preview: PrintPreview | None = None
        panel.save_wanted.connect(self.save_data)

    def join(self) -> None:
        """Once the panel has its pages."""
        page = self._panel.logbook
        page.shown.connect(self.show)
        page.note_wanted.connect(self.note)
        page.back_wanted.connect(self.back)
        page.report_wanted.connect(self.report)
        self.refresh()

    @property
    def book(self) -> Logbook:
        """Of the machine that is connected."""
        from device.tuning.logbook import Logbook, file_for

        controller, setup = self._connection.controller, self._session.document.setup
        serial = (controller.identity.serial or 0) if controller.identity is not None else 0
        file = file_for(self._folder, serial, setup.name, setup.model)
        if self._book is None or self._book.file != file:
            book = self._book = Logbook(file, self._later)
            if book.skipped:
                words = "A line" if book.skipped == 1 else f"{book.skipped} lines"
                self.said.emit(f"{words} of the logbook {file.name} cannot be read and stay as they are.")
        return self._book

    @property
    def machine(self) -> str:
        """What its runs are kept under."""
        return self.book.file.name

    def refresh(self) -> None:
        """The runs of the machine that is connected now."""
        self._panel.logbook.show_entries(self.book.entries)

    def add(self, entry: Entry) -> None:
        """One more run."""
        self.book.add(entry)
        self.added.emit(entry)
        self.refresh()

    def note(self, number: int, text: str) -> None:
        """What the operator says about a run."""
        self.book.note(number, text)
        self.refresh()

    def _later(self, write: Callable[[], None]) -> None:
        """In a thread of its own, one after the other: a disk may be slow. A full one is said, not raised."""

        def done(future: Future[None]) -> None:
            if failure := future.exception():
                why = getattr(failure, "strerror", None) or failure
                self.said.emit(f"The logbook {self.machine} could not be written, its newest line is lost: {why}.")

        if self._writer is None:
            self._writer = ThreadPoolExecutor(max_workers=1, thread_name_prefix="logbook")
        self._tick.when_written(self._writer.submit(write), done)

    def close(self) -> None:
        """At the end: the last line is on the disk, and nobody waits for another one."""
        if self._writer is not None:
            self._writer.shutdown()

    def show(self, numbers: Sequence[int]) -> None:
        """These runs over each other; the last is the chosen one, with its numbers."""
        from device.tuning.entry import gains_words
        from widgets.tuner.plots import Curve

        entries = [entry for number in numbers if (entry := self.book.find(number)) is not None]
        if not entries or self._panel.running:
            return
        curves = [Curve(each.response, f"{each.number}: {gains_words(each.gains)}", quiet=True) for each in entries]
        last = entries[-1]
        curves[-1] = Curve(last.response, f"{last.number}: {gains_words(last.gains)}")
        self._panel.show_curves(curves, last.metrics, last.gains.torque_limit)

    def back(self, number: int) -> None:
        """The gains of an earlier run into the fields."""
        entry = self.book.find(number)
        if entry is None:
            return
        if entry.axis != self._panel.axis and self._panel.axes.findText(entry.axis) >= 0:
            self._panel.axes.setCurrentText(entry.axis)
        self._panel.open_page(MANUAL)
        self._panel.manual.gains.show_gains(entry.gains)
        self._panel.show_result(f"The gains of run {number} are in the fields; “Use these gains” sets them.")

    def report(self) -> None:
        """The pages of the report, to be saved as PDF or printed."""
        from app.tuner_report import report_pages
        from widgets.program.printing import PrintPreview

        page, book = self._panel.logbook, self.book
        wanted = page.ticked or tuple(entry.number for entry in book.entries)
        entries = [entry for entry in book.entries if entry.number in wanted]
        setup = self._session.document.setup
        pages = report_pages(setup, entries, self._connection.controller.who, f"{self._now():%d %B %Y}")
        self.preview = PrintPreview("Commissioning report", pages, f"{setup.name or 'Axis'} tuning", self._parent)
        self.preview.setProperty("helpPage", "Tuner")
        self.preview.said.connect(self.said)
        self.preview.show()

    def save_data(self) -> None:
        """The last response into a file that the person chooses."""
        if self.last is None:
            self._panel.show_result("Only a response that was measured now can be saved; run a step first.", good=False)
            return
        proposed = Path.home() / f"{self._session.document.setup.name or 'step'} {self.last.axis}.csv"
        files.ask_save(self._parent, "Save data", DATA, partial(self._write, self.last), proposed, "csv")

    def _write(self, measured: Measured, path: Path) -> None:
        from device.capture_file import save

        try:
            save(path, measured.capture)
        except OSError as failure:
            self.said.emit(f"{path.name} cannot be written: {failure.strerror or failure}.")
            return
        self.said.emit(f"Saved {path.name}")
