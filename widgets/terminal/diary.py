"""The terminal's lines in a file, as they come."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import IO


class Diary:
    """Adds to a file, line by line; ends by itself when it cannot be written any more."""

    def __init__(self, wall: Callable[[], time.struct_time] = time.localtime) -> None:
        self._wall = wall
        self._file: IO[str] | None = None
        self.path: Path | None = None
        self.problem = ""

    @property
    def open(self) -> bool:
        return self._file is not None

    def begin(self, path: Path) -> bool:
        """From now on into this file, behind what is in it; False with `problem` when it does not open."""
        self.end()
        self.problem = ""
        try:
            self._file = path.open("a", encoding="utf-8", newline="\n", buffering=1)
        except OSError as reason:
            self.problem = f"{path} cannot be written: {reason.strerror or reason}."
            return False
        self.path = path
        self.add("---", f"log of {time.strftime('%Y-%m-%d', self._wall())}")
        return True

    def add(self, sign: str, text: str) -> None:
        """One line with its time."""
        if self._file is None:
            return
        try:
            self._file.write(f"{time.strftime('%H:%M:%S', self._wall())} {sign} {text}\n")
        except OSError as reason:
            self.problem = f"{self.path} is not written any more: {reason.strerror or reason}."
            self.end()

    def end(self) -> None:
        """Closes it."""
        if self._file is not None:
            file, self._file = self._file, None
            try:
                file.close()
            except OSError as reason:
                self.problem = f"{self.path} was not written to its end: {reason.strerror or reason}."
