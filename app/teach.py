"""Teaching joined: who owns the table, what is recorded into it, its files, and the path over the X-Y view."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Callable, Iterable
from concurrent.futures import Future
from functools import partial
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject

from app.background import in_background
from app.connection import Connection
from app.run import Ask
from app.session import Session
from app.settings import Settings
from app.teach_chosen import Chosen
from app.teach_drive import TeachDrive
from app.teach_play import TeachPlay
from app.tick import Tick, failure_of
from codegen import teach, teach_file
from codegen.disk import FileUnreadable
from codegen.document import Document
from codegen.files import save as save_program
from codegen.generate import generate
from codegen.numbers import plain
from codegen.setup import Setup
from codegen.teach import Row, Table, exact
from codegen.teach_drive import Driving, pace_of, tolerance_counts
from codegen.teach_path import Seen, fitting
from codegen.teach_steps import drawn, module
from widgets.parts import files as choose
from widgets.plane.panel import PlanePanel
from widgets.teach.panel import PLACES, TeachPanel

TEACH_DATA = "Teach data (*.tlt)"
MODULES = "Modules (*.tlp)"
PATH = "Teach"
MOST_UNDONE = 100
TOGETHER_S = 0.0005  # read in one line
MOST_SEEN = 20_000  # readings of a way: ten minutes at thirty a second


class Teach(QObject):
    """Every change of the table is one step of its own undo."""

    def __init__(
        self,
        connection: Connection,
        session: Session,
        tick: Tick,
        panel: TeachPanel,
        plane: PlanePanel,
        ask: Ask,
        homed: Callable[[], Iterable[str]],
        folder: Callable[[], Path],
        data: Path,
        clock: Callable[[], float],
        settings: Settings,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._connection, self._session, self._tick = connection, session, tick
        self._panel, self._plane, self._ask, self._folder, self._clock = panel, plane, ask, folder, clock
        self._kept = data / "teach.tlt"  # the table as it was left: nothing that was taught is lost
        self.table = self._left()
        self._undone: list[Table] = []
        self._redone: list[Table] = []
        self._saved = self.table
        self._driving: tuple[Setup, Driving] | None = None  # for which machine
        self._chosen = Chosen(settings, panel)
        self._seen: list[Seen] | None = None  # of a way that is being recorded
        self._pending = False  # a place is recorded once the axes stand
        self.drive = TeachDrive(connection, tick, panel, clock, self.record, self.done, self)
        self.play = TeachPlay(connection, tick, panel, ask, homed, self)
        self._join()
        tick.each(self.look)
        connection.changed.connect(self._another)
        self._show()

    def _join(self) -> None:
        panel = self._panel
        panel.driving_changed.connect(self._set_driving)
        panel.way_chosen.connect(self._chosen.keep_way)
        panel.made.connect(self._chosen.show_way)
        panel.record_wanted.connect(self.record)
        panel.way_wanted.connect(self._way)
        panel.wait_added.connect(lambda text: self._add(Row(wait=text), f"Waits for input {text}."))
        panel.output_added.connect(self._output)
        panel.done_wanted.connect(self.done)
        panel.cell_typed.connect(self._typed)
        panel.rows_wanted.connect(self._rows)
        panel.file_wanted.connect(self._file)
        panel.io_control_wanted.connect(lambda on: self._connection.controller.set_io_control(on))
        self._session.document_changed.connect(lambda old, new: self._show())

    # ---- what is shown

    @property
    def setup(self) -> Setup:
        return self._session.document.working_setup

    def _show(self) -> None:
        setup = self.setup
        if self._driving is None or self._driving[0].axes != setup.axes:
            self._driving = setup, self._chosen.driving(setup)
            self._panel.show_driving(self._driving[1])
        if not self.table.rows and self.table.units != teach.units_of(setup):
            self.table = self._saved = Table(teach.units_of(setup))
        wrong = teach.problems(self.table, setup) if self.table.rows else ()
        self._panel.show_table(self.table, wrong, bool(self._undone))
        self._plane.show_path(PATH, () if wrong else drawn(self.table, setup))

    def _set_driving(self, driving: Driving) -> None:
        self._driving = self.setup, driving
        self._chosen.keep_driving(driving, self.setup)
        self._panel.show_driving(driving)

    # ---- the table

    def change(self, table: Table) -> None:
        """Another table; the one before comes back with Undo."""
        if table == self.table:
            return
        self._undone = [*self._undone[-MOST_UNDONE:], self.table]
        self._redone.clear()
        self._take(table)

    def _take(self, table: Table) -> None:
        self.table = table
        try:
            teach_file.save(self._kept, table)
        except OSError as error:
            words = f"The table could not be kept for the next start: {error.strerror or error}."
            self._panel.show_result(words, good=False)
        self._show()

    def _left(self) -> Table:
        """The table of the last time; an empty one where there is none, or none that can be read."""
        try:
            return teach_file.load(self._kept)
        except (FileUnreadable, OSError):
            return Table()

    def _another(self) -> None:
        """Another controller: what was seen of the one before is no way of this one."""
        self._seen, self._pending = None, False
        self._panel.show_way(False)

    def _add(self, row: Row, words: str) -> None:
        rows = len(self.table)
        self.change(teach.inserted(self.table, rows, (row,)))
        self._panel.show_result(f"Row {rows + 1}: {words}")
        if self._panel.parts is not None:
            self._panel.parts.view.go_to(rows)

    def _typed(self, row: int, column: str, text: str) -> None:
        self.change(teach.with_cell(self.table, row, column, text))

    def _rows(self, what: str, rows: list[int], cells: list[tuple[int, str]]) -> None:
        table = self.table
        if what == "insert":
            self.change(teach.inserted(table, rows[0] if rows else len(table), (Row(),)))
        elif what == "delete":
            self.change(teach.deleted(table, rows))
        elif what == "clear":
            for row, column in cells:
                table = teach.with_cell(table, row, column, "")
            self.change(table)
        elif what == "pace" and self._foreign:
            self._panel.show_result(f"Not changed. {self._foreign}", good=False)
        elif what == "pace":
            pace = pace_of(self._panel.driving)
            values = {name: getattr(pace, name) for name in ("speed", "acceleration", "deceleration")}
            self.change(teach.with_values(table, rows, values))
        elif what == "undo" and self._undone:
            self._redone.append(table)
            self._take(self._undone.pop())
        elif what == "redo" and self._redone:
            self._undone.append(table)
            self._take(self._redone.pop())

    # ---- recording

    @property
    def _foreign(self) -> str:
        """Why numbers of this machine must not come among these rows: they were taught in other units. Or nothing."""
        same = not self.table.rows or self.table.units == teach.units_of(self.setup)
        return "" if same else teach.unfit(self.table, self.setup)

    def record(self) -> None:
        """Where the axes are commanded to be, once they stand; a press while they still move waits for that."""
        if problem := self._panel.reason or self._panel.problem or self._foreign:
            self._panel.show_result(f"Not recorded. {problem.rstrip('.')}.", good=False)
        else:
            self._pending = True

    def look(self) -> None:
        """With every tick."""
        motion = self._connection.controller.motion
        if self._pending and not motion.ghost:
            self._pending = False
            motion.setup = self.setup
            self._tick.when_done(motion.look("XY"), self._recorded)
        if self._seen is not None:
            self._see()

    def _recorded(self, future: Future[Any]) -> None:
        if failure := failure_of(future):
            self._panel.show_result(failure, good=False)
            return
        setup, places = self.setup, future.result().commanded
        x, y = (teach.place_text(setup, letter, places[letter]) for letter in "XY")
        unit = teach.units_of(setup)[0]
        row = dc.replace(pace_of(self._panel.driving), x=x, y=y)
        self._add(row, f"X {x} {unit}, Y {y} {unit}.")

    def _output(self, text: str) -> None:
        """The row, and the outputs themselves where I/O control is on."""
        self._add(Row(output=text), f"Output {text}.")
        controller = self._connection.controller
        if not controller.io_control:
            return
        if teach.BYTE.match(text):
            future = controller.io.set_outputs(int(text, 16))
        else:
            future = controller.io.set_output(abs(int(text)), int(text) > 0)

        def told(done: Future[Any]) -> None:
            if failure := failure_of(done):
                self._panel.show_result(failure, good=False)

        self._tick.when_done(future, told)

    def done(self) -> None:
        """The end of teaching: nothing drives, nothing is recorded any more."""
        if self._seen is not None:
            self._way(False)
        self._panel.ended(f"Done: {len(self.table)} rows.")

    def end(self) -> None:
        """The window is about to close: a way that is being recorded goes into the table, which is kept."""
        if self._seen is not None:
            self._way(False)

    # ---- a whole way

    def _way(self, on: bool) -> None:
        """Begins to remember where the axes are, or makes rows of it."""
        if problem := self._foreign or (self._panel.problem if on else ""):
            self._seen = None
            self._panel.show_way(False)
            self._panel.show_result(f"Not recorded. {problem.rstrip('.')}.", good=False)
            return
        self._panel.show_way(on)
        self.drive.again()
        if on:
            self._seen = []
            self._panel.show_result("The whole way is recorded until you take the tick away.")
            return
        seen, self._seen = self._seen or [], None
        if len({each[1:] for each in seen}) < 2:
            self._panel.show_result("Nothing was recorded: the axes did not move.", good=False)
            return
        self._panel.show_result("The way becomes lines and arcs.")
        setup, driving, room = self.setup, self._panel.driving, teach.MOST_ROWS - len(self.table)

        def work() -> tuple[tuple[Row, ...], float]:
            found = fitting(seen, tolerance_counts(driving, setup), setup, pace_of(driving), room)
            teach.problems(Table(teach.units_of(setup), found[0]), setup)  # known by the time it is asked for
            return found

        self._tick.when_written(in_background(work), partial(self._thinned, len(seen), setup, driving))

    def _thinned(self, readings: int, setup: Setup, driving: Driving, future: Future[Any]) -> None:
        """A way as rows; where there would be too many, they are coarser, and that is said."""
        rows, tolerance = future.result()
        changed, full = setup.axes != self.setup.axes, len(self.table) + len(rows) > teach.MOST_ROWS
        if changed or full:
            why = "the setup was changed meanwhile" if changed else "the table has no room for it"
            self._panel.show_result(f"The way was not recorded: {why}.", good=False)
            return
        self.change(teach.inserted(self.table, len(self.table), rows))
        pauses = sum(1 for row in rows if row.pause)
        words = f"{readings} readings became {len(rows)} rows with {pauses} pauses."
        if tolerance > tolerance_counts(driving, setup):
            coarser = plain(exact(driving.tolerance) * round(tolerance / tolerance_counts(driving, setup)))
            unit = teach.units_of(setup)[0]
            words += f" Within {driving.tolerance} {unit} they would not fit; they are within {coarser} {unit}."
        self._panel.show_result(words)

    def _see(self) -> None:
        assert self._seen is not None
        row = self._connection.controller.last()
        x, y = (row.value(key) for key in PLACES)
        first, second = (row.time(key) for key in PLACES)
        if not (math.isfinite(x) and math.isfinite(y)):
            return
        last = self._seen[-1] if self._seen else None
        together = abs(first - second) < TOGETHER_S or (last is not None and (x, y) == last[1:])
        if together and (last is None or min(first, second) > last.seconds):
            self._seen.append(Seen(min(first, second), x, y))
        if len(self._seen) >= MOST_SEEN:
            self._way(False)

    # ---- files

    def _file(self, what: str) -> None:
        doing = {"new": self._new, "open": self._open, "save": self._save, "module": self._save_module}
        doing[what]()

    def _careful(self, title: str, call: Callable[[], None]) -> None:
        """Rows that were not saved are asked about."""
        if self.table.rows and self.table != self._saved:
            words = f"{len(self.table)} rows were not saved. Undo brings them back as long as the studio is open."
            self._ask(title, words, [("Go on", call)], "warning")
        else:
            call()

    def _new(self) -> None:
        self._careful("Start an empty teach table?", lambda: self.change(Table(teach.units_of(self.setup))))

    def _open(self) -> None:
        def choose_file() -> None:
            choose.ask_open(self._panel.window(), "Open teach data", TEACH_DATA, self.open, self._folder())

        self._careful("Open other teach data?", choose_file)

    def open(self, path: Path) -> None:
        """A file that was named; every failure is one sentence."""
        try:
            table = teach_file.load(path)
        except (FileUnreadable, OSError) as error:
            said = str(error) if isinstance(error, FileUnreadable) else f"{path.name}: {error.strerror or error}"
            self._ask("The teach data cannot be opened", f"{said.rstrip('.')}.", (), "problem")
            return
        if reason := teach.unfit(table, self.setup):
            self._ask("The teach data cannot be opened", f"{path.name}: {reason}", (), "problem")
            return
        self.change(table)
        self._saved = table
        self._panel.show_result(f"Opened {path.name}: {len(table)} rows.")

    def _save(self) -> None:
        proposed = self._folder() / "path.tlt"
        choose.ask_save(self._panel.window(), "Save teach data", TEACH_DATA, self.save, proposed, "tlt")

    def save(self, path: Path) -> None:
        """The table as a file."""
        if self._written(path, lambda: teach_file.save(path, self.table)):
            self._saved = self.table
            self._panel.show_result(f"Saved {path.name}: {len(self.table)} rows.")

    def _save_module(self) -> None:
        if self._panel.wrong:
            self._panel.show_result(f"Not saved as a module. {self._panel.wrong[0].sentence}", good=False)
            return
        proposed = self._folder() / "taught.tlp"
        choose.ask_save(self._panel.window(), "Save code as module", MODULES, self.save_module, proposed, "tlp")

    def save_module(self, path: Path) -> None:
        """The table as a program that File > Import module takes."""
        made: Document = module(self.table, self.setup, path.stem)
        listing = generate(made)
        if not listing.is_complete:
            problem = next(each for each in listing.problems if each.severity == "error")
            self._panel.show_result(f"Not saved as a module: {problem.message}.", good=False)
        elif self._written(path, lambda: save_program(path, made)):
            most = self.setup.limits.lines
            long = f" The controller holds {most}." if len(listing.lines) > most else ""
            self._panel.show_result(
                f"Saved {path.name}: {len(listing.lines)} lines of code. File > Import module takes it.{long}"
            )

    def _written(self, path: Path, write: Callable[[], None]) -> bool:
        try:
            write()
        except OSError as error:
            words = f"{path.name}: {error.strerror or error}."
            self._ask("The file cannot be written", words, (), "problem")
            return False
        return True
