"""Something that takes long to make, made piece by piece, so that the window never waits for the whole."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QWidget

BREATH_S = 0.006  # of work, before the window has a turn
AT_ONCE = 16  # widgets that are dressed in one go
DRESSED = Qt.WidgetAttribute.WA_WState_Polished


class Pieces:
    """`making` yields after each piece; whoever owns it asks for the next one with each tick."""

    def __init__(self, making: Iterator[object]) -> None:
        self._making = making
        self.done = False

    def step(self) -> bool:
        """Makes the next piece; True once there is nothing left to make."""
        if not self.done:
            self.done = next(self._making, self) is self
        return self.done

    def wanted(self) -> bool:
        """Somebody waits for it: whether there is nothing left to make."""
        return self.done

    def each(self) -> Iterator[None]:
        """For what is itself made in pieces, of which this is a part."""
        while not self.step():
            yield

    def finish(self) -> None:
        """All that is left, for whoever cannot wait for the ticks."""
        while not self.step():
            pass


def in_breaths(
    making: Iterator[object], clock: Callable[[], float] = time.perf_counter, breath_s: float = BREATH_S
) -> Iterator[None]:
    """The same in fewer pieces: small ones together, as far as they take no longer than a breath."""
    began = clock()
    for _ in making:
        if clock() - began >= breath_s:
            yield
            began = clock()


def dressed(widget: QWidget) -> Iterator[None]:
    """Puts the style sheet on all that is in a widget before it is shown, a few at a time."""
    while bare := [each for each in widget.findChildren(QWidget) if not each.testAttribute(DRESSED)]:
        for each in bare[:AT_ONCE]:
            each.ensurePolished()
        yield
