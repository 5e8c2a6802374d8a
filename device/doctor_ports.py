"""What the operating system knows of a serial port: who has it open, whose it is."""

from __future__ import annotations

import os
from pathlib import Path

PROCESSES = Path("/proc")
USUAL_GROUP = "dialout"


def holders(device: str, processes: Path = PROCESSES) -> list[str]:
    """The programs that have a device open besides this one, as far as the system tells (Linux).

    Whoever serves pseudo-terminals (a simulator, a terminal window) is at the other end of one and no rival.
    """
    real = os.path.realpath(device)
    found = []
    for process in processes.glob("[0-9]*"):
        if process.name != str(os.getpid()) and _has_open(process, real):
            found.append(f"{_name(process)} (process {process.name})")
    return sorted(found)


def _has_open(process: Path, real: str) -> bool:
    try:
        opened = {os.readlink(file) for file in (process / "fd").iterdir()}
        return real in opened and not any(name.endswith("/ptmx") for name in opened)
    except OSError:  # it has ended, or is somebody else's
        return False


def _name(process: Path) -> str:
    try:
        return (process / "comm").read_text().strip()
    except OSError:
        return "a program"


def group_of(device: str) -> str:
    """The group whose members may open it."""
    try:
        from grp import getgrgid  # not on Windows

        return getgrgid(os.stat(device).st_gid).gr_name
    except (ImportError, OSError, KeyError):
        return USUAL_GROUP
