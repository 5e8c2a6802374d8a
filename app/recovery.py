"""Copies of unsaved work, and finding them again after a crash."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from concurrent.futures import Future
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from PySide6.QtCore import QLockFile

from app.background import in_background
from codegen.disk import FileUnreadable, save_text
from codegen.document import Document
from codegen.files import dumps, loads

SUFFIX = ".recovery"


@dataclass(frozen=True)
class Recovered:
    """Work that a session left behind without saving or closing."""

    file: Path
    original: str  # path of the program it belongs to; "" for one never saved
    when: datetime
    document: Document
    fingerprint: str = ""  # of the file the work began with

    @property
    def name(self) -> str:
        """As a person knows it: its file, else the program's own name."""
        return Path(self.original).name if self.original else self.document.program.name or "a new program"

    def belongs_to(self, path: Path) -> bool:
        """Whether it is unsaved work on that file."""
        return bool(self.original) and Path(self.original).resolve() == path.resolve()

    def is_newer_than_file(self) -> bool:
        """Whether the file was not written after this work was kept."""
        try:
            return datetime.fromtimestamp(Path(self.original).stat().st_mtime) <= self.when
        except OSError:
            return True


class Recovery:
    """The recovery file of this session; its lock tells other sessions that we are alive."""

    def __init__(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self.folder = folder
        self.file, self.lock = _free(folder)
        self._writing, self._turn = threading.Lock(), 0

    def write(self, document: Document, original: Path | None, now: datetime, fingerprint: str = "") -> None:
        """Keeps `document`; the former copy stays until the new one is complete on disk."""
        self._write(self._next(), document, original, now, fingerprint)

    def write_beside(
        self, document: Document, original: Path | None, now: datetime, fingerprint: str = ""
    ) -> Future[None]:
        """The same without waiting: a disk may take long. What is asked for later goes before."""
        turn = self._next()
        return in_background(lambda: self._write(turn, document, original, now, fingerprint))

    def set_aside(self, document: Document, original: Path | None, now: datetime, fingerprint: str = "") -> None:
        """Keeps unsaved work that makes room for other work, among what is found later."""
        file, lock = _free(self.folder)
        save_text(file, _kept(document, original, now, fingerprint))
        lock.unlock()

    def clear(self) -> None:
        """Nothing is unsaved."""
        self._next()
        with self._writing:
            self.file.unlink(missing_ok=True)

    def close(self) -> None:
        """The session ends in good order."""
        self.clear()
        self.lock.unlock()

    def found(self) -> tuple[Recovered, ...]:
        """What crashed sessions left, newest first."""
        return tuple(sorted(self._left_behind(), key=lambda each: each.when, reverse=True))

    def forget(self, recovered: Recovered) -> None:
        """Removes one of them."""
        recovered.file.unlink(missing_ok=True)

    def _next(self) -> int:
        self._turn += 1
        return self._turn

    def _write(self, turn: int, document: Document, original: Path | None, now: datetime, fingerprint: str) -> None:
        text = _kept(document, original, now, fingerprint)
        with self._writing:
            if turn == self._turn:
                save_text(self.file, text)

    def _left_behind(self) -> Iterator[Recovered]:
        for file in sorted(self.folder.glob(f"*{SUFFIX}")):
            lock = _lock(file)
            if file == self.file or not lock.tryLock(0):
                continue
            lock.unlock()
            try:
                kept = json.loads(file.read_text(encoding="utf-8"))
                when = datetime.fromisoformat(kept["when"])
                fingerprint = str(kept.get("fingerprint", ""))
                yield Recovered(file, kept["original"], when, loads(kept["document"]), fingerprint)
            except (OSError, ValueError, KeyError, TypeError, FileUnreadable):
                continue  # half a file of a crash while writing: the one before it was already replaced


def _kept(document: Document, original: Path | None, now: datetime, fingerprint: str) -> str:
    kept = {"original": str(original or ""), "fingerprint": fingerprint, "when": now.isoformat()}
    return json.dumps({**kept, "document": dumps(document)})


def _free(folder: Path) -> tuple[Path, QLockFile]:
    number = 1
    while True:
        file = folder / f"unsaved-{number}{SUFFIX}"
        lock = _lock(file)
        if not file.exists() and lock.tryLock(0):
            return file, lock
        number += 1


def _lock(file: Path) -> QLockFile:
    lock = QLockFile(str(file) + ".lock")
    lock.setStaleLockTime(0)
    return lock
