"""Stop codes and the error code in words, each with what to do next; nothing where there is nothing to say."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from codegen.twoletter.problems import ARRIVED, ERROR_TEXTS, FOUND, RUNNING, STOP_STEPS, STOP_TEXTS, error_step
from widgets.panel import set_text, show_role

if TYPE_CHECKING:
    from device.api import Row

QUIET = RUNNING | ARRIVED | FOUND
HEADING = "Stop and error codes"


@dataclass(frozen=True)
class Said:
    """One code in words, and the next step."""

    text: str
    step: str
    stale: bool = False

    @property
    def words(self) -> str:
        return f"{self.text} Next: {self.step}" if self.step else self.text


def said_of(row: Row, letters: Iterable[str], now: float) -> tuple[Said, ...]:
    """What the codes of the axes and of the controller say."""
    found = [_stop(row, letter, now) for letter in letters]
    return tuple(each for each in (*found, _error(row, now)) if each is not None)


def _stop(row: Row, letter: str, now: float) -> Said | None:
    key = f"stop_code.{letter.lower()}"
    value = row.value(key)
    if not math.isfinite(value) or int(value) in QUIET:
        return None
    code = int(value)
    words = STOP_TEXTS.get(code, "Unknown stop code")
    return Said(f"{letter}: {words} (code {code}).", STOP_STEPS.get(code, ""), row.stale(key, now))


def _error(row: Row, now: float) -> Said | None:
    value = row.value("error_code")
    if not math.isfinite(value) or not value:
        return None
    code = int(value)
    words = ERROR_TEXTS.get(code, "Unknown error")
    return Said(f"Error {code}: {words}.", error_step(code), row.stale("error_code", now))


class StopList(QWidget):
    """`show_said` is its setter; it hides itself while nothing is said."""

    more_wanted = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._said: tuple[Said, ...] = ()
        self._labels: list[tuple[QLabel, QLabel]] = []
        self.more = QPushButton("More")
        self.more.setProperty("role", "flat")
        self.more.setAccessibleName("More about error and stop codes")
        self.more.setToolTip("Opens the help page of all error and stop codes.")
        self.more.clicked.connect(self.more_wanted)
        heading = QLabel(HEADING)
        heading.setProperty("role", "heading")
        head = QHBoxLayout()
        head.addWidget(heading)
        head.addStretch(1)
        head.addWidget(self.more)
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(2)
        self._column.addLayout(head)
        self.hide()

    def show_said(self, said: Sequence[Said]) -> None:
        """Puts the rows up; nothing is touched that has not changed."""
        if tuple(said) == self._said:
            return
        self._said = tuple(said)
        while len(self._labels) < len(said):
            self._add()
        for number, (text, step) in enumerate(self._labels):
            there = number < len(said)
            text.setVisible(there)
            step.setVisible(there and bool(said[number].step))
            if there:
                set_text(text, said[number].text)
                set_text(step, f"Next: {said[number].step}")
                show_role(text, "quiet" if said[number].stale else "warning")
                show_role(step, "quiet" if said[number].stale else "")
        self.setVisible(bool(said))

    def words(self) -> list[str]:
        """What is said now, a line each."""
        return [each.words for each in self._said]

    def _add(self) -> None:
        text, step = QLabel(), QLabel()
        step.setContentsMargins(0, 0, 0, 6)
        for label in (text, step):
            label.setWordWrap(True)
            self._column.addWidget(label)
        self._labels.append((text, step))
