"""Keeps a viewport from being painted whole while its content changes; who changes it says afterwards what is new."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QAbstractScrollArea

OFF = Qt.WidgetAttribute.WA_UpdatesDisabled  # set alone: `setUpdatesEnabled` would paint all in the end


@contextmanager
def still(area: QAbstractScrollArea) -> Iterator[None]:
    """Updates that Qt asks for in between are dropped; where it scrolled or got another size, all is painted.

    Views of Qt paint everything after rows or lines have come or gone, even far below what is seen.
    """
    viewport, bars = area.viewport(), (area.verticalScrollBar(), area.horizontalScrollBar())
    before = (viewport.size(), *[bar.value() for bar in bars])
    was = is_still(area)
    viewport.setAttribute(OFF, True)
    try:
        yield
    finally:
        viewport.setAttribute(OFF, was)
        if before != (viewport.size(), *[bar.value() for bar in bars]):
            viewport.update()


def is_still(area: QAbstractScrollArea) -> bool:
    """Whether updates are dropped now."""
    return area.viewport().testAttribute(OFF)
