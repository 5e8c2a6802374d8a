"""New, open, save: what is asked before work could be lost, and what is said when a file cannot be read."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QBoxLayout, QMainWindow, QMenu

import resources
from app.background import in_background
from app.file_bar import FileBar
from app.in_use import user_of
from app.run import Ask
from app.session import ChangedOnDisk, NoPath, Session
from app.settings import Settings
from app.tick import Tick
from codegen.disk import FileUnreadable
from codegen.document import Document
from codegen.files import load
from codegen.generate import Listing, generate
from widgets.parts import files as choose

if TYPE_CHECKING:
    from widgets.terminal.code_window import CodeWindow

MOST_RECENT = 10
LARGE = 50_000  # bytes; some 300 steps


class Files(QObject):
    """Acts on the session; every failure becomes a sentence."""

    said = Signal(str)
    recent_changed = Signal()

    def __init__(self, session: Session, settings: Settings, ask: Ask, tick: Tick, parent: QMainWindow) -> None:
        super().__init__(parent)
        self._session, self._settings, self._ask, self._window = session, settings, ask, parent
        self._tick = tick
        self._reading: Future[tuple[Document, Listing]] | None = None
        self.bar = FileBar()
        self.comparison: CodeWindow | None = None
        centre = parent.centralWidget().layout()
        assert isinstance(centre, QBoxLayout)
        centre.insertWidget(0, self.bar)
        self.bar.reload.connect(self.reload)
        self.bar.compare.connect(self.compare)
        self.bar.save_as.connect(lambda: self.save_as())
        session.disk_changed.connect(self._show_disk)

    def new(self) -> None:
        """An empty program, after asking about unsaved work."""
        self.careful("Start a new program?", self._session.new)

    def open(self) -> None:
        """Asks for a file, after asking about unsaved work."""
        self.careful(
            "Open another program?",
            lambda: choose.ask_open(self._window, "Open program", choose.PROGRAMS, self.open_path, self.folder()),
        )

    def open_path(self, path: Path, at_once: bool = False) -> None:
        """Opens a file that was named; one that another studio has open is asked about."""
        user = user_of(path)
        if not user:
            self._open_path(path, at_once)
            return
        words = (
            f"{path.name} is open in another Twoletter Studio: {user}. "
            "Whoever saves last overwrites what the other has saved."
        )
        answers = (("Open a copy", partial(self.open_copy, path)), ("Open it anyway", partial(self._open_path, path)))
        self._ask("Somebody else works on this file", words, answers, "warning")

    def open_copy(self, path: Path) -> None:
        """What the file holds now, without its name: Save asks for one."""
        try:
            self._session.open_copy(path)
        except (FileUnreadable, OSError) as error:
            self._ask("The program cannot be opened", _sentence(error, path), (), "problem")

    def _open_path(self, path: Path, at_once: bool = False) -> None:
        """A large one is read beside the window, which goes on meanwhile."""
        self._reading = None
        if at_once or not path.is_file() or path.stat().st_size <= LARGE:
            self._take(path, lambda: self._session.open(path))
            return
        self.said.emit(f"{path.name} is being opened.")
        self._reading = in_background(partial(_read, path))
        self._tick.when_done(self._reading, partial(self._was_read, path, self._session.document))

    def _was_read(self, path: Path, before: Document, future: Future[tuple[Document, Listing]]) -> None:
        if future is not self._reading:
            return
        self._reading = None
        if self._session.document is not before:
            self.said.emit(f"{path.name} was not opened, because the program was changed meanwhile. Open it again.")
            return
        self._take(path, lambda: self._session.take(*future.result(), path))

    def _take(self, path: Path, take: Callable[[], None]) -> None:
        try:
            take()
        except (FileUnreadable, OSError) as error:
            self._ask("The program cannot be opened", _sentence(error, path), (), "problem")
            return
        self._remember(path)
        newer = [left for left in self._session.recoverable() if left.belongs_to(path) and left.is_newer_than_file()]
        if newer:
            left = newer[0]
            words = f"Unsaved work on {left.name} ({left.when:%Y-%m-%d %H:%M}) is newer than the file. It is kept."
            answers = (
                ("Recover it", partial(self._session.recover, left)),
                ("Throw it away", partial(self._session.forget, left)),
            )
            self._ask("Recover unsaved work?", words, answers, "file")

    def reload(self) -> None:
        """The file as it is on disk now; what was open stays within reach of Undo."""
        try:
            self._session.revert()
        except (FileUnreadable, OSError) as error:
            self._ask("The file cannot be reloaded", _sentence(error, self._session.path), (), "problem")
            return
        if self._session.path is not None:
            self.said.emit(f"Reloaded: {self._session.path.name}")

    def compare(self) -> None:
        """The code of the file beside the code of the open program."""
        path = self._session.path
        if path is None:
            return
        try:
            document = load(path)
        except (FileUnreadable, OSError) as error:
            self._ask("The file cannot be compared", _sentence(error, path), (), "problem")
            return
        from widgets.terminal.code_window import CodeWindow

        code = generate(document).text
        self.comparison = CodeWindow(f"{path.name} on disk", code, self._session.listing.text, self._window, "file")
        if code == self._session.listing.text and document != self._session.document:
            self.comparison.add_words("The setup, comments or names differ.")
        self.comparison.show()

    def save(self, then: Callable[[], None] | None = None) -> None:
        """Saves; without a name it asks for one first."""
        self._write(self._session.save, then)

    def save_as(self, then: Callable[[], None] | None = None) -> None:
        """Saves under a name that is asked for."""
        name = self._session.document.program.name or "program"
        proposed = self._session.path or self.folder() / f"{name.lower().replace(' ', '_')}.tlp"
        choose.ask_save(
            self._window,
            "Save program",
            choose.PROGRAMS,
            lambda path: self._save_to(path, then),
            proposed,
            "tlp",
        )

    def _save_to(self, path: Path, then: Callable[[], None] | None) -> None:
        """Under a name that was chosen; the window has asked about an existing file, but not whose it is."""

        def write() -> None:
            self._write(lambda: self._session.save_as(path, overwrite=True), then)

        user = user_of(path) if path.exists() else ""
        if user:
            words = f"{path.name} is open in another Twoletter Studio: {user}. Its work would be overwritten."
            answers = [("Save under another name", lambda: self.save_as(then)), ("Overwrite it", write)]
            self._ask("Somebody else works on this file", words, answers, "warning")
        else:
            write()

    def export_code(self, text: str | None = None) -> None:
        """Writes two-letter code (of the program unless given) into a file."""
        code = self._session.listing.text if text is None else text
        stem = self._session.path.stem if self._session.path is not None else "program"
        choose.ask_save(
            self._window,
            "Export code",
            choose.CODE,
            lambda path: self._export(path, code),
            self.folder() / f"{stem}.dmc",
            "dmc",
        )

    def careful(self, title: str, go_on: Callable[[], object]) -> None:
        """Goes on at once when nothing is unsaved, else asks."""
        if not self._session.dirty:
            go_on()
            return
        words = f"“{self._session.title.rstrip('*')}” has changes that are not saved."
        answers = (("Save", lambda: self.save(lambda: go_on() and None)), ("Do not save", lambda: go_on() and None))
        self._ask(title, words, answers, "warning")

    def _show_disk(self) -> None:
        path = self._session.path
        self.bar.show_disk(self._session.on_disk, path.name if path is not None else "", self._session.dirty)

    def fill_examples(self, menu: QMenu) -> None:
        """The programs that are shipped, by their names; each opens as a copy."""
        if menu.isEmpty():
            for path in sorted(resources.path("examples").glob("*.tlp")):
                program = load(path).program
                words = f"{program.name} – {program.description}" if program.description else program.name
                action = menu.addAction(words.replace("&", "&&"))
                action.triggered.connect(partial(self.careful, "Open an example?", partial(self.open_copy, path)))

    @property
    def recent(self) -> list[Path]:
        """Programs opened last that are still there."""
        return [path for name in self._settings.get("recent_files") if (path := Path(name)).is_file()]

    def _write(self, save: Callable[[], object], then: Callable[[], None] | None) -> None:
        try:
            save()
        except NoPath:
            self.save_as(then)
            return
        except ChangedOnDisk as changed:
            answers = (
                ("Save under another name", lambda: self.save_as(then)),
                ("Overwrite it", lambda: self._write(lambda: self._session.save(overwrite=True), then)),
            )
            self._ask("Somebody else changed this file", str(changed), answers, "warning")
            return
        except OSError as error:
            self._ask("The program cannot be saved", _sentence(error, self._session.path), (), "problem")
            return
        if self._session.path is not None:
            self._remember(self._session.path)
            self.said.emit(f"Saved: {self._session.path.name}")
        if then is not None:
            then()

    def _export(self, path: Path, code: str) -> None:
        try:
            path.write_text(code, encoding="ascii", errors="replace", newline="\n")
        except OSError as error:
            self._ask("The code cannot be written", _sentence(error, path), (), "problem")
            return
        self.said.emit(f"Written: {path.name}")

    def _remember(self, path: Path) -> None:
        others = [name for name in self._settings.get("recent_files") if name != str(path)]
        self._settings.set("recent_files", [str(path), *others][:MOST_RECENT])
        self.recent_changed.emit()

    def folder(self) -> Path:
        """Where programs are looked for first."""
        recent = self.recent
        return self._session.path.parent if self._session.path else recent[0].parent if recent else Path.home()


def _read(path: Path) -> tuple[Document, Listing]:
    """A program with its code, which takes longest; raises FileUnreadable."""
    document = load(path)
    return document, generate(document)


def _sentence(error: Exception, path: Path | None) -> str:
    if isinstance(error, OSError) and error.strerror:
        return f"{path}: {error.strerror}."
    said = str(error).rstrip(".")
    return f"{said}." if path is None or path.name in said else f"{path}: {said}."
