"""The window of back-ups: which there are, what is in one, compare, restore, and the steps to replace a controller."""

from __future__ import annotations

from concurrent.futures import Future
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QWidget

from app import facts as need
from app.backup_before import Keeping
from app.connection import Connection
from app.facts import Facts
from app.run import Ask, Run
from codegen.disk import FileUnreadable
from device.api import Controller, Job, Kind, State
from device.backing_up import Restored, backup_steps, restore_steps
from device.backup import SUFFIX, Backup, differences, load, misfits, save
from device.backup_kept import Kept, glance, kept
from device.backup_words import described, names, row_of, serial_words, summary
from device.tasks import Priority
from widgets.parts import files

if TYPE_CHECKING:
    from widgets.backup.replacing import Replacing
    from widgets.backup.window import BackupWindow

FILTER = f"Back-ups (*{SUFFIX})"
NONE_CHOSEN = "Choose a back-up first."
LOST = "Only what is burned is there after the next power-up: program, parameters and variables are burned apart."


class Backups(QObject):
    """Joins the window with the controller and the kept files; asks before anything is put back."""

    said = Signal(str)
    act = Signal(str)  # an action of the studio: "connect", "burn", "compare"

    def __init__(self, connection: Connection, run: Run, keeping: Keeping, ask: Ask, window: QWidget) -> None:
        super().__init__(window)
        self._connection, self._run, self._keeping, self._ask, self._parent = connection, run, keeping, ask, window
        self.window: BackupWindow | None = None
        self.replacing: Replacing | None = None
        self._kept: list[Kept] = []
        self._opened: list[Path] = []  # from files
        self._chosen: Backup | None = None
        self._state: object = None
        keeping.changed.connect(self._fill)

    # ---- showing

    def show(self) -> None:
        """The window, with what is kept of the connected controller."""
        from widgets.backup.window import BackupWindow

        if self.window is None:
            self.window = BackupWindow(self._parent)
            self.window.chosen.connect(self._choose)
            self.window.pressed.connect(self._press)
            self.window.cancelled.connect(self._run.cancel)
        self._fill()
        self.window.show()
        self.window.raise_()
        self.window.activateWindow()

    def look(self, facts: Facts) -> None:
        """With each tick: what is under way, and what is possible now."""
        window = self.window
        if window is None or not (window.isVisible() or (self.replacing is not None and self.replacing.isVisible())):
            return
        job = self._run.job
        window.show_work(facts.busy, job.fraction if job is not None else 0.0, can_cancel=job is not None)
        controller = self._connection.controller
        state = (controller, controller.identity, controller.state, facts, self._chosen)
        if state != self._state:
            before, self._state = self._state, state
            if not isinstance(before, tuple) or before[:2] != state[:2]:
                self._fill()
            self._show_possible(facts)

    def _fill(self) -> None:
        if self.window is None:
            return
        folder, controller = self._keeping.folder(), self._connection.controller
        self._kept = [glance(path) for path in self._opened] + (kept(folder) if folder is not None else [])
        who = controller.who if controller.kind is not Kind.OFFLINE else "Nothing is connected"
        self.window.show_controller(f"{who[:1].upper()}{who[1:]}")
        self.window.show_list([row_of(each) for each in self._kept])
        self._choose(0 if self._kept else -1)

    def _choose(self, row: int) -> None:
        window = self.window
        assert window is not None
        self._chosen = None
        window.show_compared("")
        if not 0 <= row < len(self._kept):
            window.show_fit("")
            return
        try:
            self._chosen = load(self._kept[row].path)
        except FileUnreadable as reason:
            window.show_parts([], str(reason))
            window.show_fit("")
            return
        window.show_parts([(part.title, part.lines, part.code) for part in described(self._chosen)])

    def _show_possible(self, facts: Facts) -> None:
        assert self.window is not None
        live, change = need.live(facts) or need.quiet(facts), need.control(facts) or need.quiet(facts)
        chosen = "" if self._chosen is not None else NONE_CHOSEN
        unfit = "; ".join(self._misfits())
        restore = chosen or change or (f"It does not fit: {unfit}." if unfit else "")
        reasons = {
            "Back up now": live,
            "Save a copy…": chosen,
            "Compare": chosen or live or (f"It does not fit: {unfit}." if unfit else ""),
            "Restore…": restore,
        }
        self.window.show_reasons(reasons)
        self.window.show_fit(self._fit_words(facts), bool(unfit))
        if self.replacing is not None:
            self.replacing.show_state(self._replace_words(), {**reasons, "Burn…": change, "Compare…": ""})

    def _misfits(self) -> list[str]:
        model = self._connection.controller.model
        return misfits(self._chosen, model) if self._chosen is not None and model is not None else []

    def _fit_words(self, facts: Facts) -> str:
        """Whether the chosen one fits what is connected, as a sentence."""
        if self._chosen is None:
            return ""
        if need.connected(facts):
            return f"{summary(self._chosen)}."
        unfit = self._misfits()
        if unfit:
            return f"It does not fit this controller: {'; '.join(unfit)}."
        return f"{summary(self._chosen)}. {self._serial_words()}".strip()

    def _serial_words(self) -> str:
        identity = self._connection.controller.identity
        now = identity.serial if identity is not None else None
        if self._chosen is None or self._chosen.serial == now:
            return ""
        return (
            f"It was taken of a controller with {serial_words(self._chosen.serial)}; this one has {serial_words(now)}."
        )

    # ---- doing

    def _press(self, what: str) -> None:
        assert self.window is not None
        match what:
            case "Back up now":
                self._keeping.now(self.window.note.text().strip(), self.window.note.clear)
            case "Open file…":
                files.ask_open(self.window, "Open a back-up", FILTER, self.open_file)
            case "Save a copy…":
                self._save_copy()
            case "Compare":
                self.compare()
            case "Restore…":
                self.ask_restore()
            case "Replace controller…":
                self.show_replacing()
            case _:
                self.act.emit({"Connect…": "connect", "Burn…": "burn", "Compare…": "compare"}[what])

    def open_file(self, path: Path) -> None:
        """A back-up from a file stands in front of the kept ones; one that is none is said."""
        try:
            load(path)
        except FileUnreadable as reason:
            self._ask("The back-up cannot be opened", f"{reason}.", (), "problem")
            return
        self._opened = [path, *(each for each in self._opened if each != path)]
        self._fill()

    def _save_copy(self) -> None:
        assert self.window is not None and self._chosen is not None
        chosen = self._chosen
        proposed = Path.home() / self._kept[self.window.row].path.name

        def write(path: Path) -> None:
            try:
                save(path, chosen)
            except OSError as reason:
                self._ask("The copy cannot be written", f"{path}: {reason.strerror or reason}.", (), "problem")
                return
            self.said.emit(f"Written: {path.name}")

        files.ask_save(self.window, "Save a copy of the back-up", FILTER, write, proposed, SUFFIX[1:])

    def compare(self) -> None:
        """Reads the controller and says what is otherwise than in the chosen back-up."""
        wanted, controller = self._chosen, self._connection.controller
        if wanted is None:
            return
        job: Job[Backup] = Job()
        steps = backup_steps(controller, job, running=True)
        job.future = controller.run(steps, Priority.DOWNLOAD, "download")
        self._run.begin("Reading the controller", job, partial(self._compared, wanted))

    def _compared(self, wanted: Backup, future: Future[Any]) -> None:
        if self.window is None:
            return
        found = list(differences(wanted, future.result()))
        partly = " What the back-up left out was not compared." if wanted.left_out else ""
        words = (
            f"The controller differs from the back-up in {len(found)} item{'s' * (len(found) != 1)}:"
            if found
            else f"The controller holds everything as it is in the back-up: {summary(wanted)}."
        )
        self.window.show_compared(f"{words}{partly}", found)

    def ask_restore(self) -> None:
        """Says what will happen, then does it when told to."""
        wanted, controller = self._chosen, self._connection.controller
        if wanted is None:
            return
        left = names(wanted.left_out)
        words = (
            f"Taken {wanted.taken}: {summary(wanted)}.",
            self._serial_words(),
            f"It is a quick one: {left} are not in it and stay as they are." if left else "",
            "The motors go off (a vertical axis may fall), then parameters, variables, arrays and program are "
            "replaced, read back and compared item by item. What is there now is kept first. Nothing is burned.",
        )
        answer = partial(self._keep_first, wanted, controller)
        text = " ".join(each for each in words if each)
        self._ask("Put this back-up into the controller?", text, [("Restore", answer)], "warning")

    def _keep_first(self, wanted: Backup, controller: Controller) -> None:
        self._keeping.before("before a restore", lambda _: self._restore(wanted, controller))

    def _restore(self, wanted: Backup, controller: Controller) -> None:
        if controller is not self._connection.controller or controller.state is not State.READY:
            self.said.emit("Not restored: another controller is connected now. Try again.")
            return
        job: Job[Restored] = Job()
        job.future = controller.run(restore_steps(controller, wanted, job), Priority.DOWNLOAD, "download")
        self._run.begin("Restoring", job, self._restored)

    def _restored(self, future: Future[Any]) -> None:
        done: Restored = future.result()
        self.said.emit(done.sentence)
        if self.window is not None:
            self.window.show_compared(f"{done.sentence} {LOST}", (*done.refused, *done.left))

    # ---- replacing

    def show_replacing(self) -> None:
        """The steps from an old controller to a new one."""
        from widgets.backup.replacing import Replacing

        if self.replacing is None:
            self.replacing = Replacing(self.window)
            self.replacing.pressed.connect(self._press)
        self._state = None
        self.replacing.show()
        self.replacing.raise_()

    def _replace_words(self) -> str:
        controller = self._connection.controller
        now = f"Connected: {controller.who}." if controller.kind is not Kind.OFFLINE else "Nothing is connected."
        if self._chosen is None:
            return f"{now} {NONE_CHOSEN}"
        taken = f"Back-up of {self._chosen.taken} ({serial_words(self._chosen.serial)}): {summary(self._chosen)}."
        unfit = self._misfits()
        return f"{now} {taken}" + (f" It does not fit: {'; '.join(unfit)}." if unfit else "")
