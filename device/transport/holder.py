"""Which program has a serial port open, where the system tells (Linux: the open files of every process)."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

PROCESSES = Path("/proc")
PSEUDO = "/dev/pts/"  # both ends of a pseudo-terminal belong to programs; the one behind it is no rival


def holder_of(device: str, processes: Path = PROCESSES) -> str:
    """ "minicom (process 4711)", or nothing when nobody else has it open or that is not known."""
    return next(_holders(os.path.realpath(device), processes), "")


def rival_of(device: str) -> str:
    """The same for a port that opened all the same: not every program locks what it uses."""
    real = os.path.realpath(device)
    return "" if real.startswith(PSEUDO) else holder_of(real)


def _holders(real: str, processes: Path) -> Iterator[str]:
    own = str(os.getpid())
    try:
        numbers = [each.name for each in processes.iterdir() if each.name.isdecimal() and each.name != own]
    except OSError:
        return
    for number in sorted(numbers, key=int):
        if _has_open(processes / number, real):
            yield f"{_name(processes / number)} (process {number})"


def _has_open(process: Path, real: str) -> bool:
    try:
        return any(_target(each) == real for each in (process / "fd").iterdir())
    except OSError:  # it has ended, or belongs to somebody else
        return False


def _target(link: Path) -> str:
    try:
        return os.readlink(link)
    except OSError:
        return ""


def _name(process: Path) -> str:
    """The program as a person started it: the studio is run by Python."""
    try:
        words = (process / "cmdline").read_bytes().decode("utf-8", errors="replace").split("\0")
        short = (process / "comm").read_text(encoding="utf-8", errors="replace").strip()
    except OSError:
        return "another program"
    if short.startswith("python") and any(word in ("app", "twoletter") or word.endswith("/studio") for word in words):
        return "another Twoletter Studio"
    return short or "another program"
