"""Diagrams that change together are painted one after the other, so that keys and clicks are answered in between."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QObject, QTimer
from PySide6.QtWidgets import QGraphicsView


class Turns:
    """Until it is its turn each stays on the screen as it was, unless it has to be painted for another reason."""

    def __init__(self, parent: QObject) -> None:
        self._waiting: list[QGraphicsView] = []
        self._timer = QTimer(parent, singleShot=True, interval=0)
        self._timer.timeout.connect(self._next)

    def change(self, views: Iterable[QGraphicsView]) -> None:
        """All that there are; what is drawn into them next waits. One that waits already keeps its place."""
        wanted = list(views)
        self._waiting = [each for each in self._waiting if each in wanted]
        self._wait(wanted)

    def bring(self, views: Iterable[QGraphicsView]) -> None:
        """These come into sight or get another size all at once: each has nothing in its place until its turn."""
        wanted = list(views)
        for view in wanted:
            view.setUpdatesEnabled(False)
        self._wait(wanted)

    def _wait(self, wanted: Iterable[QGraphicsView]) -> None:
        for view in wanted:
            if view not in self._waiting:
                view.setViewportUpdateMode(QGraphicsView.ViewportUpdateMode.NoViewportUpdate)
                self._waiting.append(view)
        self._timer.start()

    def _next(self) -> None:
        if not self._waiting:
            return
        view = self._waiting.pop(0)
        view.setViewportUpdateMode(QGraphicsView.ViewportUpdateMode.MinimalViewportUpdate)
        if view.updatesEnabled():
            view.viewport().repaint()
        else:
            view.setUpdatesEnabled(True)  # paints it with the next turn of the event loop
        if self._waiting:
            self._timer.start()
