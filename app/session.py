"""The open program and its file: opened, saved, kept safe while it is not saved; nothing is overwritten in silence."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Future
from datetime import datetime
from pathlib import Path

from PySide6.QtCore import QObject, QTimer, Signal

from app.disk import Disk, FileOnDisk
from app.edited import Edited
from app.in_use import Claim
from app.recovery import Recovered, Recovery
from codegen import files
from codegen.document import Document
from codegen.generate import Listing
from codegen.history import History
from codegen.setup import Setup

AUTOSAVE_MS = 1000
LOOKED_AT_MS = 50  # whether a copy that is written beside the window could be


class NoPath(Exception):
    """The program has never been saved: it needs a name first."""


class ChangedOnDisk(Exception):
    """Somebody else wrote the file since it was opened; saving would overwrite that."""


class Session(Edited):
    """What is edited, with the file it came from and the copy that survives a crash."""

    replaced = Signal()  # another document was begun: new, opened, recovered
    disk_changed = Signal()  # the file is not as it was, or is again
    autosave_failed = Signal(str)

    def __init__(
        self,
        document: Document | None = None,
        *,
        recovery_folder: Path | None = None,
        clock: Callable[[], float] = time.monotonic,
        now: Callable[[], datetime] = datetime.now,
        autosave_ms: int = AUTOSAVE_MS,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(document if document is not None else Document(), clock, parent)
        self._now = now
        self._saved: Document = self.document
        self._file = FileOnDisk(self)
        self._file.changed.connect(self.disk_changed)
        self._claim = Claim()
        self._recovery = Recovery(recovery_folder) if recovery_folder is not None else None
        self._autosave = QTimer(self, singleShot=True, interval=autosave_ms)
        self._autosave.timeout.connect(self._keep_beside)
        self._keeping: Future[None] | None = None
        self._kept = QTimer(self, interval=LOOKED_AT_MS)
        self._kept.timeout.connect(self._look_after)
        self.document_changed.connect(self._keep_soon)

    # ---- what is open

    @property
    def dirty(self) -> bool:
        """Whether there is anything that the file does not have."""
        return self.document is not self._saved and self.document != self._saved

    @property
    def path(self) -> Path | None:
        """The file it was opened from or saved to."""
        return self._file.path

    @property
    def on_disk(self) -> Disk:
        """Whether somebody else has changed or removed the file."""
        return self._file.state

    @property
    def title(self) -> str:
        """For the window: the file's name, with a star while there are unsaved changes."""
        name = self.path.name if self.path is not None else self.document.program.name or "New program"
        return f"{name}*" if self.dirty else name

    # ---- file

    def new(self, setup: Setup | None = None) -> None:
        """An empty program for the same machine."""
        document = Document(setup=setup or self.document.setup)
        self._start(document, None, saved=True)

    def open(self, path: Path) -> None:
        """Opens a program; raises FileUnreadable and leaves everything as it was."""
        document = files.load(path)
        self._start(document, path.absolute(), saved=True)

    def take(self, document: Document, listing: Listing, path: Path) -> None:
        """Opens a program that was read before, with its code."""
        self._listing = (document, listing)
        self._start(document, path.absolute(), saved=True)

    def open_copy(self, path: Path) -> None:
        """Opens an example: it has no file of its own, so Save asks for a name; raises FileUnreadable."""
        self._start(files.load(path), None, saved=True)

    def save(self, *, overwrite: bool = False) -> None:
        """Writes the file; refuses when it has never been named, or when somebody else has changed it."""
        if self.path is None:
            raise NoPath("The program has no file yet")
        if not overwrite and self._file.look() is Disk.CHANGED:
            raise ChangedOnDisk(f"{self.path.name} was changed by another program since it was opened.")
        self._write(self.path)

    def save_as(self, path: Path, *, overwrite: bool = False) -> None:
        """Writes another file; one that is there is only replaced when asked to."""
        if path.exists() and not overwrite:
            raise FileExistsError(f"{path.name} is there already")
        self._write(path)

    def revert(self) -> None:
        """Takes the file as it is on disk; the present state stays in the history."""
        if self.path is not None:
            document = files.load(self.path)
            self.set_document(document, f"Reload {self.path.name}")
            self._saved = self.document
            self._file.follow(self.path)
            self._after_save()

    # ---- unsaved work

    def recoverable(self) -> tuple[Recovered, ...]:
        """What crashed sessions left behind, newest first."""
        return self._recovery.found() if self._recovery is not None else ()

    def recover(self, recovered: Recovered) -> None:
        """Opens what was left behind; it stays unsaved, under its old name."""
        original = Path(recovered.original) if recovered.original else None
        if self.dirty and self._recovery is not None:
            self._recovery.set_aside(self.document, self.path, self._now(), self._file.fingerprint)
        self._start(recovered.document, original, saved=False)
        self._file.follow(original, recovered.fingerprint)  # what the work began with: a newer file is asked about
        self.autosave_now()
        self.forget(recovered)

    def forget(self, recovered: Recovered) -> None:
        """Removes what was left behind."""
        if self._recovery is not None:
            self._recovery.forget(recovered)

    def autosave_now(self) -> None:
        """Writes the recovery copy now."""
        self._autosave.stop()
        if self._recovery is None:
            return
        try:
            if self.dirty:
                self._recovery.write(self.document, self.path, self._now(), self._file.fingerprint)
            else:
                self._recovery.clear()
        except OSError as failure:
            self._not_kept(failure)

    def close(self) -> None:
        """The session ends in good order: no recovery copy stays behind."""
        self._autosave.stop()
        self._kept.stop()
        self._claim.release()
        if self._recovery is not None:
            self._recovery.close()

    # ---- inside

    def _keep_soon(self) -> None:
        if not self._autosave.isActive():
            self._autosave.start()

    def _keep_beside(self) -> None:
        if self._recovery is None or not self.dirty:
            self.autosave_now()
        else:
            self._keeping = self._recovery.write_beside(self.document, self.path, self._now(), self._file.fingerprint)
            self._kept.start()

    def _look_after(self) -> None:
        if self._keeping is None or not self._keeping.done():
            return
        self._kept.stop()
        failure = self._keeping.exception()
        if isinstance(failure, OSError):
            self._not_kept(failure)
        elif failure is not None:
            raise failure

    def _not_kept(self, failure: OSError) -> None:
        self.autosave_failed.emit(f"Unsaved work cannot be kept safe: {failure.strerror or failure}")

    def _start(self, document: Document, path: Path | None, *, saved: bool) -> None:
        old = self.document
        self.history = History(document)
        self._saved = document if saved else Document()
        self.open_body = self.before = None
        self._file.follow(path)
        self._claim.take(path)
        self.replaced.emit()
        self.document_changed.emit(old, document)
        self.insertion_changed.emit()
        self._after_save()

    def _write(self, path: Path) -> None:
        files.save(path, self.document)
        self._saved = self.document
        self._file.follow(path.absolute())
        self._claim.take(path.absolute())
        self._after_save()

    def _after_save(self) -> None:
        self.autosave_now()
        self.history_changed.emit()
