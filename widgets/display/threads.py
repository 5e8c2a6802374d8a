"""What the program is doing: the line each thread is on, and what it waits for."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from PySide6.QtWidgets import QLabel, QVBoxLayout, QWidget

from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.slow_mark import mark_of
from widgets.panel import set_text
from widgets.parts.look import look

NONE: Mapping[int, str] = {}


class ThreadList(QWidget):
    """One line a thread; `show_threads` is its setter."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._rows: list[QLabel] = []
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(2)

    def show_threads(self, lines: list[float], source: Sequence[str], sentences: Mapping[int, str] = NONE) -> None:
        """`lines`: line of each thread, -1 when it does not run, NaN when not known; `source`: the program's lines."""
        while len(self._rows) < len(lines):
            label = QLabel()
            label.setFont(look().body_font())
            label.setMinimumHeight(24)
            label.setWordWrap(True)
            self._rows.append(label)
            self._column.addWidget(label)
        for number, label in enumerate(self._rows):
            label.setVisible(number < len(lines))
            if number < len(lines):
                set_text(label, thread_words(number, lines[number], source, sentences))

    def words(self) -> list[str]:
        """What is shown now, one line a thread."""
        return [label.text() for label in self._rows if not label.isHidden()]


def thread_words(number: int, line: float, source: Sequence[str], sentences: Mapping[int, str] = NONE) -> str:
    """ "▲ Thread 0: line 4, Wait until input 1 is high (AI 1)", or the bare line where its instruction is not known."""
    if not math.isfinite(line):
        return f"?  Thread {number}: not known"
    if line < 0:
        return f"■  Thread {number}: not running"
    at = int(line)
    text = source[at].strip() if at < len(source) else ""
    mark = mark_of(source)
    slow = f" – {mark}" if mark else ""
    if at in sentences:
        return f"▲  Thread {number}: line {at}, {sentences[at]} ({text}){slow}"
    row = COMMANDS.get(text[:2].upper())
    waits = f"waiting: {row.title.lower()} " if row is not None and row.trippoint else ""
    return f"▲  Thread {number}: line {at}" + (f", {waits}({text})" if text else "") + slow
