"""What was chosen for teaching, from one start to the next; speeds only for axes with the same counts per unit."""

from __future__ import annotations

import dataclasses as dc
from typing import Any

from app.settings import Settings
from codegen.setup import Setup
from codegen.teach_drive import OF_THE_ROWS, Driving, beginning, field_problem
from widgets.teach.panel import TeachPanel

CHOSEN = "teach"  # the setting
MACHINES = "machines"  # speeds and tolerance of each, by what the axes count
WAY = ("source", "how")  # the stick, and the kind of play-back
OF_A_MACHINE = ("full", *OF_THE_ROWS)
MOST = 8  # machines; the oldest goes


class Chosen:
    """Reads and writes the setting; what does not fit stays as it is at first."""

    def __init__(self, settings: Settings, panel: TeachPanel) -> None:
        self._settings, self._panel = settings, panel

    def driving(self, setup: Setup) -> Driving:
        """What was set for a machine like this one, slow where there is nothing."""
        kept, first = self._settings.get(CHOSEN), beginning(setup)
        machine = _table(_table(kept, MACHINES), _name(setup))
        values = {field.name: kept.get(field.name) for field in dc.fields(Driving) if field.name not in OF_A_MACHINE}
        values |= {name: machine.get(name) for name in OF_A_MACHINE}
        right = {n: v for n, v in values.items() if isinstance(v, str) and not field_problem(n, v, setup)}
        return dc.replace(first, **right)

    def keep_driving(self, driving: Driving, setup: Setup) -> None:
        """For the next start."""
        kept, values = self._settings.get(CHOSEN), dc.asdict(driving)
        machines = {n: v for n, v in _table(kept, MACHINES).items() if n != _name(setup)}
        machines[_name(setup)] = {name: values.pop(name) for name in OF_A_MACHINE}
        self._settings.set(CHOSEN, {**kept, **values, MACHINES: dict(list(machines.items())[-MOST:])})

    def keep_way(self, source: str, how: int) -> None:
        """What it is driven with, and how it is played back."""
        self._settings.set(CHOSEN, {**self._settings.get(CHOSEN), **dict(zip(WAY, (source, how), strict=True))})

    def show_way(self) -> None:
        """What it was at the last start."""
        kept = self._settings.get(CHOSEN)
        source, how = (kept.get(name) for name in WAY)
        self._panel.choose_way(source if isinstance(source, str) else "", how if isinstance(how, int) else 0)


def _name(setup: Setup) -> str:
    """What X and Y count: `mm 1000, mm 1000`."""
    return ", ".join(f"{setup.axis(letter).symbol} {setup.axis(letter).scale}" for letter in "XY")


def _table(kept: dict[str, Any], name: str) -> dict[str, Any]:
    found = kept.get(name)
    return found if isinstance(found, dict) else {}
