"""The file a program came from: whether somebody else has changed or removed it meanwhile."""

from __future__ import annotations

import hashlib
import threading
from enum import Enum
from pathlib import Path

from PySide6.QtCore import QFileSystemWatcher, QObject, QTimer, Signal

SETTLE_MS = 150  # writers work in several strokes: looked at when they pause
GLANCE_MS = 1000  # not every folder tells of its changes (network drives do not)


class Disk(Enum):
    """How the file stands to what was read from it, or written to it, last."""

    SAME = "as it was read or written"
    CHANGED = "changed by another program"
    GONE = "not there any more"


class FileOnDisk(QObject):
    """Watches one file and its folder (editors put a new file in the place of the old one); `changed` says so once."""

    changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.path: Path | None = None
        self.fingerprint = ""
        self.state = Disk.SAME
        self._seen = ""
        self._settle = QTimer(self, singleShot=True, interval=SETTLE_MS)
        self._settle.timeout.connect(self.look)
        self._glance = QTimer(self, interval=GLANCE_MS)
        self._glance.timeout.connect(self._look_for_a_change)
        self._signature = _signature(None)
        self._asking: threading.Thread | None = None
        self._told: tuple[Path | None, tuple[int, int, int]] | None = None  # what was found, for the next glance
        self._watcher = QFileSystemWatcher(self)
        self._watcher.fileChanged.connect(lambda _: self._settle.start())
        self._watcher.directoryChanged.connect(lambda _: self._settle.start())

    def follow(self, path: Path | None, known: str | None = None) -> None:
        """From now on this file; `known`: the fingerprint it should have (else the one that it has now)."""
        self.path = path
        now = fingerprint_of(path) if path is not None else ""
        self.fingerprint = now if known is None else known
        self._seen, self.state = now, self._judge(now)
        self._watch()
        self._signature = _signature(path)
        if path is None:
            self._glance.stop()
        else:
            self._glance.start()
        self.changed.emit()

    def _look_for_a_change(self) -> None:
        """Asks beside the window's thread: a network drive that hangs must not hold up STOP."""
        if self._asking is not None and self._asking.is_alive():
            return
        if self._told is not None and self._told[0] == self.path and self._told[1] != self._signature:
            self._settle.start()
        self._told = None
        self._asking = threading.Thread(target=self._ask, args=(self.path,), name="file on disk", daemon=True)
        self._asking.start()

    def _ask(self, path: Path | None) -> None:
        self._told = (path, _signature(path))

    def look(self) -> Disk:
        """Looks now; tells when it is not as before."""
        if self.path is not None:
            self._signature = _signature(self.path)
            now = fingerprint_of(self.path)
            if now != self._seen:
                self._seen, self.state = now, self._judge(now)
                self.changed.emit()
            self._watch()
        return self.state

    def _judge(self, now: str) -> Disk:
        if self.path is None or now == self.fingerprint:
            return Disk.SAME
        return Disk.CHANGED if now else Disk.GONE

    def _watch(self) -> None:
        """A file that was replaced has to be watched anew."""
        old = [*self._watcher.files(), *self._watcher.directories()]
        wanted = [] if self.path is None else [self.path.parent, *([self.path] if self._seen else [])]
        names = [str(each) for each in wanted if each.exists()]
        if sorted(old) != sorted(names):
            if old:
                self._watcher.removePaths(old)
            if names:
                self._watcher.addPaths(names)


def _signature(path: Path | None) -> tuple[int, int, int]:
    """What is cheap to ask of a file: time of its last change, size, which file it is; zeros when there is none."""
    try:
        found = path.stat() if path is not None else None
    except OSError:
        found = None
    return (found.st_mtime_ns, found.st_size, found.st_ino) if found is not None else (0, 0, 0)


def fingerprint_of(path: Path) -> str:
    """Of what is in the file; empty when it cannot be read."""
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return ""
