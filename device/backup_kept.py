"""Back-ups that were kept: a folder for each controller, the newest fifty in it, what each is at a glance."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from device.backup import SUFFIX, Backup, save
from device.identify import Identity

KEPT = 50  # for each controller
HEAD = 4096  # bytes of a file in which everything before the parameters stands
SIMULATED = "simulator"


@dataclass(frozen=True, slots=True)
class Kept:
    """One kept back-up by what its first lines tell; `broken` says why it tells nothing."""

    path: Path
    model: str = ""
    serial: int | None = None
    taken: str = ""
    note: str = ""
    reason: str = ""
    broken: str = ""


def controller_name(model: str, identity: Identity | None, simulated: bool = False) -> str:
    """The folder of one controller. One without a serial number shares it with its like: it cannot prove itself."""
    serial = identity.serial if identity is not None else None
    number = f"{model} {serial}" if serial else f"{model} without serial number"
    return f"{SIMULATED} {model}" if simulated else number


def keep(folder: Path, backup: Backup, now: datetime, most: int = KEPT) -> Path:
    """Writes it under a name that tells when, never over another; beyond `most` the oldest kept ones go."""
    folder.mkdir(parents=True, exist_ok=True)
    name = f"{now:%Y-%m-%d %H.%M.%S} {backup.model}"
    path = folder / f"{name}{SUFFIX}"
    count = 1
    while path.exists():
        count += 1
        path = folder / f"{name} ({count}){SUFFIX}"
    save(path, backup)
    found = sorted(folder.glob(f"*{SUFFIX}"), key=lambda each: each.stat().st_mtime)
    for old in found[:-most]:
        old.unlink(missing_ok=True)
    return path


def kept(folder: Path) -> list[Kept]:
    """All that were kept of one controller, newest first."""
    paths = sorted(folder.glob(f"*{SUFFIX}"), key=lambda each: (each.stat().st_mtime, each.name), reverse=True)
    return [glance(path) for path in paths]


def glance(path: Path) -> Kept:
    """What the first lines of a file tell, without reading thousands of array elements."""
    try:
        with path.open("rb") as file:
            head = file.read(HEAD).decode("utf-8-sig", errors="ignore")
    except OSError as reason:
        return Kept(path, broken=f"cannot be opened: {(reason.strerror or str(reason)).lower()}")
    found: dict[str, Any] = {}
    for name, text in re.findall(r'^  "(model|serial|taken|note|reason)": (.*?),?$', head, re.MULTILINE):
        try:
            found[name] = json.loads(text)
        except ValueError:
            continue
    texts = {name: found[name] for name in ("model", "taken", "note", "reason") if isinstance(found.get(name), str)}
    if "model" not in texts:
        return Kept(path, broken="is not a back-up")
    serial = found.get("serial")
    return Kept(path, serial=serial if isinstance(serial, int) else None, **texts)


def adds_nothing(newest: Backup, found: Backup) -> bool:
    """Whether everything found is in the newest one already (a quick one may have left out more)."""
    return (
        (newest.model, newest.serial, newest.program) == (found.model, found.serial, found.program)
        and found.parameters.items() <= newest.parameters.items()
        and found.variables.items() <= newest.variables.items()
        and found.arrays.items() <= newest.arrays.items()
    )
