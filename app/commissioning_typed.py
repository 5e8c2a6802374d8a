"""What the buttons of every step need: numbers as they were typed, moves, registers that are set and read back."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import TYPE_CHECKING

from codegen.numbers import number_problem, parse_number, shown
from codegen.setup import Unit
from codegen.twoletter.fixed import ONE
from device.commissioning import judge, moves, settings
from device.commissioning.moves import Trial
from device.download import Job

if TYPE_CHECKING:
    from app.commissioning import Commissioning
    from device.commissioning.judge import Moved

UNITS = {"ER": "counts", "TL": "V", "OE": "", "MT": "", "KS": ""}


class NotTyped(Exception):
    """A field that has to be put right first; the text is the sentence."""


class Typed:
    """Orders of one kind; `desk` has record, controller and window."""

    def __init__(self, desk: Commissioning) -> None:
        self.desk = desk

    def number(self, name: str, label: str, usual: str = "") -> Fraction:
        text = self.desk.text(name, usual)
        number = parse_number(text)
        if number is None:
            raise NotTyped(f"{label}: {number_problem(text)}.")
        return number

    def whole(self, name: str, label: str, usual: str = "") -> int:
        number = self.number(name, label, usual)
        if number.denominator != 1:
            raise NotTyped(f"{label}: write a whole number.")
        return int(number)

    def assign(self, wanted: dict[str, int]) -> None:
        d = self.desk

        def done(result: tuple[Mapping[str, int], Mapping[str, int]]) -> None:
            former, there = result
            asked, held = ({name: self._told(name, each[name]) for name in each} for each in (wanted, there))
            finding = judge.judge_set(asked, held)
            was = tuple((f"{name} before", self._told(name, former[name])) for name in wanted)
            d.found(dc.replace(finding, facts=(*finding.facts, *was)))

        steps = settings.set_values(d.controller, d.record.axis, wanted, d.folder, d.now())
        d.run("Setting and reading back", steps, done)

    def move(self, trial: Trial, done: Callable[[Moved], None]) -> None:
        d = self.desk
        if trial.problem:
            raise NotTyped(f"Not moved: {trial.problem}")
        d.moved = d.measured = None
        job: Job[Moved] = Job()
        steps = moves.move(d.controller, trial, d.folder, d.now(), job)
        d.run(f"Axis {trial.axis} moves", steps, done, job)

    def torque(self) -> Fraction:
        return parse_number(self.desk.record.text("guards", "torque", "1")) or Fraction(1)

    def _told(self, name: str, value: int) -> str:
        """A register in words: `1 V`, `2000 counts`, `200 mm (200000 counts)`, `off` for a limit that is none."""
        if name in ("FL", "BL"):
            if abs(value // ONE) >= 2**31 - 1:
                return "off"
            axis, counts = self.desk.axis, value // ONE
            place = f"{shown(Fraction(counts) / axis.scale)} {axis.symbol}"
            return f"{counts} counts" if axis.unit is Unit.COUNT else f"{place} ({counts} counts)"
        number = f"{value / ONE:.3f}".rstrip("0").rstrip(".")
        return f"{number} {UNITS[name]}".strip()
