"""The tuning logbook of one machine: a line of JSON for every run and every note; nothing in it is ever rewritten."""

from __future__ import annotations

import dataclasses as dc
import json
import os
import re
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from device.tuning.entry import Entry, from_data, to_data


def at_once(write: Callable[[], None]) -> None:
    """Waits for the disk."""
    write()


class Logbook:
    """Reads a file once and adds to it; a line that a kill left half is skipped.

    `later` has a line written, in the order given; waiting for a slow disk is not for everybody.
    """

    def __init__(self, file: Path, later: Callable[[Callable[[], None]], None] = at_once) -> None:
        self.file, self._later = file, later
        self.entries: tuple[Entry, ...] = ()
        self.skipped = 0  # lines that could not be read
        self._load()

    def add(self, entry: Entry) -> Entry:
        """Keeps a run under the next number; the writing raises OSError where the file cannot be written."""
        kept = dc.replace(entry, number=max((each.number for each in self.entries), default=0) + 1)
        self._append({"run": to_data(kept)})
        self.entries += (kept,)
        return kept

    def note(self, number: int, text: str) -> None:
        """What the operator says about a run; the last note counts."""
        self._append({"note": number, "text": text})
        self._noted(number, text)

    def find(self, number: int) -> Entry | None:
        """The run of that number."""
        return next((each for each in self.entries if each.number == number), None)

    def _noted(self, number: int, text: str) -> None:
        self.entries = tuple(dc.replace(each, note=text) if each.number == number else each for each in self.entries)

    def _append(self, data: dict[str, Any]) -> None:
        self._later(partial(self._write, json.dumps(data, separators=(",", ":"), ensure_ascii=False).encode() + b"\n"))

    def _write(self, line: bytes) -> None:
        self.file.parent.mkdir(parents=True, exist_ok=True)
        with self.file.open("ab") as file:
            if file.tell() and not self._ends_whole():
                file.write(b"\n")
            file.write(line)
            file.flush()
            os.fsync(file.fileno())

    def _ends_whole(self) -> bool:
        with self.file.open("rb") as file:
            file.seek(-1, os.SEEK_END)
            return file.read(1) == b"\n"

    def _load(self) -> None:
        try:
            data = self.file.read_bytes() if self.file.exists() else b""
        except OSError:  # it may not be read, or is no file
            self.skipped = 1
            return
        for line in data.splitlines():
            try:
                told = json.loads(line)
                if "run" in told:
                    self.entries += (from_data(told["run"]),)
                else:
                    self._noted(int(told["note"]), str(told["text"]))
            except (ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError):
                self.skipped += 1


def file_for(folder: Path, serial: int, name: str, model: str) -> Path:
    """Where the runs of a machine are kept: by serial number, else by the machine's name in the setup."""
    key = f"serial {serial}" if serial else name.strip() or model
    return folder / f"{re.sub(r'[^A-Za-z0-9 _-]', '_', key)}.tuning.jsonl"
