"""A note beside an open file: who has it open. Another studio reads it before it opens the same file."""

from __future__ import annotations

import os
import socket
from pathlib import Path

from PySide6.QtCore import QFileInfo, QLockFile

import resources

SHIPPED = resources.path("examples").absolute()  # nobody works on what is shipped; the folder stays as it is


def note_of(path: Path) -> Path:
    """Where the note of a file lies: host, process and program, and by its owner the person."""
    return path.with_name(f".{path.name}.in-use")


def user_of(path: Path) -> str:
    """Who else has the file open, for the middle of a sentence; nothing when nobody has, or a crash left the note."""
    lock = _lock(path)
    if lock.tryLock(0):
        lock.unlock()
        return ""
    pid, host, _ = _told_by(lock)
    if not pid or (pid, host) == (os.getpid(), socket.gethostname()):
        return ""  # no note can be written there, or it is ours
    note = QFileInfo(str(note_of(path)))
    person, since = note.owner() or "somebody", note.lastModified().toString("yyyy-MM-dd HH:mm")
    place = "this computer" if host == socket.gethostname() else host
    return f"{person} on {place} (process {pid}), since {since}"


class Claim:
    """The note of the file that is open here; a folder that takes none has none, and a note of others stays."""

    def __init__(self) -> None:
        self._path: Path | None = None
        self._lock: QLockFile | None = None

    def take(self, path: Path | None) -> None:
        """From now on this file is open here, and the one before no longer."""
        if path == self._path:
            return
        self.release()
        self._path = path
        if path is not None and path.parent.is_dir() and not path.is_relative_to(SHIPPED):
            lock = _lock(path)
            self._lock = lock if lock.tryLock(0) else None

    def release(self) -> None:
        """Our note goes."""
        if self._lock is not None:
            self._lock.unlock()
        self._path = self._lock = None


def _lock(path: Path) -> QLockFile:
    lock = QLockFile(str(note_of(path)))
    lock.setStaleLockTime(0)  # however long ago: a note goes with its process, not with time
    return lock


def _told_by(lock: QLockFile) -> tuple[int, str, str]:
    """Process, host and program; zero where there is no note that can be read."""
    found: object = lock.getLockInfo()  # Qt's own form of it takes places to write to
    return found if isinstance(found, tuple) and len(found) == 3 else (0, "", "")
