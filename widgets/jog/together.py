"""The pages of two axes together: a straight line, a part of a circle."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Iterator
from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QApplication, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from codegen.fields import AXES, Dimension
from codegen.setup import Setup
from device.jog import Places, Plan
from widgets.display.readings import unit_of
from widgets.form.fields_form import FieldsForm
from widgets.form.offers import Offers
from widgets.jog import plans
from widgets.jog.ends import ends_words
from widgets.jog.one_axis import enable
from widgets.jog.speed import SpeedRow
from widgets.panel import set_text, show_role
from widgets.parts.look import look
from widgets.parts.pieces import Pieces, dressed

ALONG = ("radius", "speed", "acceleration", "deceleration")  # in the unit of the first axis


def units_of(setup: Setup) -> dict[str, str]:
    """The unit in which the numbers of each axis are typed."""
    return {letter: unit_of(setup.axis(letter)) for letter in AXES}


class TogetherPage(QWidget):
    """Fields, where it will end, Go and Stop; `make` turns the fields into a plan or says why not."""

    plan_wanted = Signal(object)
    stop_wanted = Signal()

    def __init__(
        self,
        item: Any,
        make: Callable[[Any, Setup], Plan | str],
        setup: Setup,
        parent: QWidget | None = None,
        at_once: bool = True,
    ) -> None:
        super().__init__(parent)
        self.item, self._fresh = item, item
        self._make, self._setup = make, setup
        self._units, self._letters = units_of(setup), setup.letters
        self.plan: Plan | None = None
        self.form = FieldsForm(Offers(setup), parent=self)
        self.form.edited.connect(self._edited)
        self.words, self.ends, self.fast = QLabel(), QLabel(), SpeedRow(presets=False)
        self._told_for: object = None
        self.go, self.halt = QPushButton("Go"), QPushButton("Stop")
        self._reason = ""
        self._lay_out()
        self.go.clicked.connect(self._go)
        self.halt.clicked.connect(self.stop_wanted)
        self.fast.chosen.connect(self._take_speed)
        self.making = Pieces(self._fill())
        if at_once:
            self.making.finish()

    def _fill(self) -> Iterator[None]:
        """In pieces."""
        yield
        yield from self.form.showing(self.item)
        self._edited(self.item)
        yield
        yield from dressed(self)

    def show_setup(self, setup: Setup, letters: str) -> None:
        """Another machine."""
        before, self._setup, self._units = self._units, setup, units_of(setup)
        self._letters = letters or setup.letters
        self.form.show_offers(Offers(setup))
        changed = [letter for letter in AXES if before[letter] != self._units[letter]]
        if changed and hasattr(self.item, "distances"):
            left = zip(AXES, self.item.distances, strict=True)
            self.item = dc.replace(
                self.item, distances=tuple("" if letter in changed else text for letter, text in left)
            )
        if self.item.axes[:1] in changed:
            self.item = self._begun_anew(self.item)
        self.form.show_item(self.item)
        self._edited(self.item)

    def show_usable(self, reason: str) -> None:
        """Why nothing may be moved now, or nothing."""
        self._reason = reason
        enable(self.go, reason or self.problem)
        enable(self.halt, reason)

    def show_ends(self, places: Places) -> None:
        """Where it would end from here, and which limit it passes."""
        key = (self.plan, places, self._setup)
        if key == self._told_for:
            return
        self._told_for = key
        words, passes = ends_words(self.plan, places, self._setup) if self.plan is not None else ("", False)
        set_text(self.ends, words)
        show_role(self.ends, "problem" if passes else "quiet")

    def looked_at(self) -> Plan | None:
        """The page has one move: shown while the mouse is over it or something in it has the focus."""
        inside = QApplication.focusWidget()
        focused = inside is not None and self.isAncestorOf(inside)
        return self.plan if focused or self.underMouse() else None

    @property
    def problem(self) -> str:
        """Why there is no plan, or nothing."""
        return "" if self.plan is not None else self.words.text()

    def _begun_anew(self, item: Any) -> Any:
        """What counts in the unit of the first axis, as at the start: a number never goes over into another unit."""
        return dc.replace(item, **{name: getattr(self._fresh, name) for name in ALONG if hasattr(item, name)})

    def _edited(self, item: Any) -> None:
        first, before = item.axes[:1], self.item.axes[:1]
        if first and before and self._units[first] != self._units[before]:
            item = self._begun_anew(item)
            self.form.show_item(item)
        self.item = self.form.item = item
        made = plans.missing(item.axes, self._letters) or self._make(item, self._setup)
        wrong = made if isinstance(made, str) else made.problem
        self.plan = None if isinstance(made, str) or made.problem else made
        set_text(self.words, wrong or ("; ".join(self.plan.commands) if self.plan is not None else ""))
        show_role(self.words, "problem" if self.plan is None else "quiet")
        axes = item.axes or self._setup.letters
        top = min(self._setup.bounds(Dimension.SPEED, letter)[1] for letter in axes)
        self.fast.show_speed(item.speed, float(top), unit_of(self._setup.axis(axes[0])))
        self.show_usable(self._reason)

    def _take_speed(self, text: str) -> None:
        self.item = dc.replace(self.item, speed=text)
        self.form.show_item(self.item)
        self._edited(self.item)

    def _go(self) -> None:
        if self.plan is not None and not self._reason:
            self.plan_wanted.emit(self.plan)

    def _lay_out(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        column.addWidget(self.form)
        column.addWidget(self.fast)
        for label in (self.ends, self.words):
            label.setWordWrap(True)
            column.addWidget(label)
        row = QHBoxLayout()
        for button in (self.go, self.halt):
            button.setMinimumHeight(look().space["touch"])
            row.addWidget(button, 1)
        column.addLayout(row)
        column.addStretch(1)
