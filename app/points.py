"""The saved points of a machine: one file for every setup's name and serial number, written whole or not at all."""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Mapping
from pathlib import Path

from codegen.disk import save_text
from codegen.points import Point, PointsUnreadable, dumps, loads, name_problem, point_at
from codegen.setup import Setup


class Points:
    """Those of the machine that is set up now; every failure is a sentence, and what is on disk stays as it was."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._path: Path | None = None
        self.points: tuple[Point, ...] = ()
        self._unreadable = ""

    def open(self, setup: Setup) -> str:
        """The points of this machine; why they cannot be read, or nothing."""
        path = self._folder / f"{file_name(setup)}.json"
        if path == self._path and not self._unreadable:
            return ""
        self._path, self.points, self._unreadable = path, (), ""
        try:
            self.points = loads(path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            return ""
        except (OSError, UnicodeDecodeError, PointsUnreadable) as error:
            self._unreadable = f"{path}: {error} Nothing is saved over it; move the file away to start anew."
        return self._unreadable

    def save_here(self, name: str, counts: Mapping[str, int], setup: Setup) -> str:
        """One more point; why not, or nothing."""
        problem = name_problem(name, (each.name for each in self.points))
        return problem or self._write((*self.points, point_at(name, counts, setup)))

    def rename(self, before: str, name: str) -> str:
        """The same place under another name; why not, or nothing."""
        problem = name_problem(name, (each.name for each in self.points if each.name != before))
        renamed = tuple(dc.replace(each, name=name.strip()) if each.name == before else each for each in self.points)
        return problem or self._write(renamed)

    def delete(self, name: str) -> str:
        """Without this one; why not, or nothing."""
        return self._write(tuple(each for each in self.points if each.name != name))

    def _write(self, points: tuple[Point, ...]) -> str:
        if self._path is None:
            return "No machine is set up."
        if self._unreadable:
            return self._unreadable
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            save_text(self._path, dumps(points))
        except OSError as error:
            return f"The points cannot be saved: {self._path}: {error.strerror or error}."
        self.points = points
        return ""


def file_name(setup: Setup) -> str:
    """Letters, digits and dashes for what a machine is called, so that every system takes it."""
    words = " ".join(each for each in (setup.name.strip() or setup.model, setup.serial_number.strip()) if each)
    return re.sub(r"[^a-z0-9]+", "-", words.casefold()).strip("-") or setup.model
