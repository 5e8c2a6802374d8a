"""Files on the disk: written whole or not at all."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path


class FileUnreadable(Exception):
    """A file that cannot be opened: one sentence for the person."""


def save_text(path: str | Path, text: str) -> None:
    """As UTF-8, with line ends as they are."""
    save_bytes(path, text.encode("utf-8"))


def save_bytes(path: str | Path, data: bytes) -> None:
    """Writes beside the file, then takes its place (also behind a symbolic link), keeping its permissions."""
    path = Path(os.path.realpath(path))
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=".part")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        _same_permissions(path, name)
        os.replace(name, path)
    finally:
        Path(name).unlink(missing_ok=True)
    _sync_folder(path.parent)


def _same_permissions(path: Path, name: str) -> None:
    mask = os.umask(0)
    os.umask(mask)
    os.chmod(name, path.stat().st_mode & 0o777 if path.exists() else 0o666 & ~mask)


def _sync_folder(folder: Path) -> None:
    """Makes the new name durable where the system knows how."""
    if os.name != "posix":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
