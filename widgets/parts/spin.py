"""Spin boxes whose text stands where that of every other field stands; a style sheet cannot say it."""

from __future__ import annotations

from typing import TypeVar

from PySide6.QtWidgets import QAbstractSpinBox, QLineEdit

MARGINS = (8, 0, 4, 0)  # px
T = TypeVar("T", bound=QAbstractSpinBox)


def indented(box: T) -> T:
    """The same box."""
    line = box.findChild(QLineEdit)
    if line is not None:
        line.setTextMargins(*MARGINS)
    return box
