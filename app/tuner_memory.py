"""What the tuner remembers between two starts: axis, page, view, record, steps, targets; never gains."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QObject

from app.session import Session
from app.settings import Settings
from codegen.numbers import parse_number
from widgets.display.readings import unit_of
from widgets.tuner.panel import PAGES, TunerPanel

KEY = "tuner"  # the setting
MOST_TARGETS = 24  # axes of machines whose targets are kept


class Memory(QObject):
    """Puts into the panel what was there last time; `machine` names the one that is connected."""

    def __init__(
        self, settings: Settings, session: Session, panel: TunerPanel, machine: Callable[[], str], parent: QObject
    ) -> None:
        super().__init__(parent)
        self._settings, self._session, self._panel, self._machine = settings, session, panel, machine
        self._axis_recalled = False
        panel.axis_chosen.connect(self._axis_chosen)

    def join(self) -> None:
        """Once the panel has its pages: what was seen last is seen again, and what is chosen now is kept."""
        panel, kept = self._panel, self._kept()
        place = panel.box.seconds.findData(kept.get("seconds"))
        if place >= 0:
            panel.box.seconds.setCurrentIndex(place)
        panel.results.error.setChecked(kept.get("error") is True)
        panel.box.seconds.currentIndexChanged.connect(lambda _: self._keep("seconds", panel.box.record_s))
        panel.results.error_chosen.connect(lambda on: self._keep("error", on))
        panel.box.step.editingFinished.connect(self._keep_step)
        page = kept.get("page")
        if page in PAGES and PAGES.index(page) != panel.page:
            panel.open_page(PAGES.index(page))
        panel.page_opened.connect(lambda index: self._keep("page", PAGES[index]))

    @property
    def target(self) -> tuple[float, float] | None:
        """Crossover (rad/s) and phase margin (degrees) asked for last of this axis of this machine."""
        found = self._table("targets").get(self._machine_axis)
        good = isinstance(found, list) and len(found) == 2 and all(isinstance(each, int | float) for each in found)
        return (float(found[0]), float(found[1])) if good else None

    def keep_target(self, crossover: float, phase: float) -> None:
        """What the person asked for."""
        targets = self._table("targets")
        targets.pop(self._machine_axis, None)
        targets[self._machine_axis] = [crossover, phase]
        self._keep("targets", dict(list(targets.items())[-MOST_TARGETS:]))

    # ---- inside

    @property
    def _machine_axis(self) -> str:
        return f"{self._machine()} {self._panel.axis}"

    @property
    def _step_place(self) -> str:
        return f"{self._panel.axis} {unit_of(self._session.document.working_setup.axis(self._panel.axis))}"

    def _axis_chosen(self, axis: str) -> None:
        """The axis of last time, once; and the step that this axis had."""
        if not self._axis_recalled:
            self._axis_recalled = True
            before = self._kept().get("axis")
            if isinstance(before, str) and before != axis and self._panel.axes.findText(before) >= 0:
                self._panel.axes.setCurrentText(before)
                return
        else:
            self._keep("axis", axis)
        step = self._table("steps").get(self._step_place)
        if isinstance(step, str) and parse_number(step) is not None:
            self._panel.box.show_step(step)

    def _keep_step(self) -> None:
        text = self._panel.box.step.text().strip()
        if parse_number(text) is not None:
            self._keep("steps", {**self._table("steps"), self._step_place: text})

    def _kept(self) -> dict[str, Any]:
        found: dict[str, Any] = self._settings.get(KEY)
        return found

    def _table(self, name: str) -> dict[str, Any]:
        """Of the settings file, as far as it is what this program wrote."""
        found = self._kept().get(name)
        return dict(found) if isinstance(found, dict) else {}

    def _keep(self, name: str, value: Any) -> None:
        self._settings.set(KEY, {**self._kept(), name: value})
