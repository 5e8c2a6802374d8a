"""What survives a reset: burned parameters, program and variables, in one file."""

from __future__ import annotations

import json
import os
import zlib
from pathlib import Path
from typing import Any, Final

PARTS: Final = ("parameters", "program", "variables", "arrays")


class EepromUnreadable(Exception):
    """The EEPROM file is damaged or of something else."""


class Eeprom:
    """Four independent parts, each a JSON value; with a path every burn is written at once and whole.

    `damaged` when the file's check sum was wrong: nothing of it is used (error 14 at power-up), until the next burn.
    """

    def __init__(self, path: Path | None = None) -> None:
        self.path = path
        self._parts: dict[str, Any] = {}
        self.damaged = False
        if path is not None and path.exists():
            self._parts, self.damaged = _read(path)

    def part(self, name: str) -> Any:
        """A burned part, or None."""
        return self._parts.get(name)

    def burn(self, **parts: Any) -> None:
        """Stores parts; a value None erases one."""
        for name, value in parts.items():
            if name not in PARTS:
                raise KeyError(name)
            if value is None:
                self._parts.pop(name, None)
            else:
                self._parts[name] = json.loads(json.dumps(value))
        self._write()

    def erase(self) -> None:
        """Master reset: factory state."""
        self._parts = {}
        self._write()

    def copy_parts(self) -> dict[str, Any]:
        """A copy for a snapshot; parts are replaced, never changed."""
        return dict(self._parts)

    def restore_parts(self, parts: dict[str, Any]) -> None:
        """Puts a snapshot's copy back; the file is written at the next burn."""
        self._parts = dict(parts)

    def _write(self) -> None:
        self.damaged = False
        if self.path is None:
            return
        beside = self.path.with_name(self.path.name + ".new")
        with beside.open("w", encoding="utf-8") as file:
            json.dump({"eeprom": 1, "check": _check_sum(self._parts), **self._parts}, file, indent=1)
            file.flush()
            os.fsync(file.fileno())
        beside.replace(self.path)


def _check_sum(parts: dict[str, Any]) -> int:
    return zlib.crc32(json.dumps(parts, sort_keys=True).encode())


def _read(path: Path) -> tuple[dict[str, Any], bool]:
    """The parts of a file, and whether its check sum is wrong (then none); files without one are taken as they are."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as reason:
        raise EepromUnreadable(f"{path.name}: not an EEPROM file ({reason})") from reason
    if not isinstance(content, dict) or content.get("eeprom") != 1:
        raise EepromUnreadable(f"{path.name}: not an EEPROM file")
    parts = {name: content[name] for name in PARTS if name in content}
    if content.get("check", _check_sum(parts)) != _check_sum(parts):
        return {}, True
    return parts, False


def read_eeproms(path: Path | None, count: int) -> list[Eeprom]:
    """One for each controller of a chain: FILE, FILE.1, FILE.2 …; in memory without a file."""
    if path is None:
        return [Eeprom() for _ in range(count)]
    return [Eeprom(path.with_name(f"{path.name}.{place}") if place else path) for place in range(count)]
