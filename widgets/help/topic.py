"""Which help page belongs to a widget."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

PROPERTY = "helpPage"


def topic_of(widget: QWidget | None) -> str | None:
    """The page of the nearest widget upwards that names one; None when none does."""
    while widget is not None:
        page = widget.property(PROPERTY)
        if page:
            return str(page)
        widget = widget.parentWidget()
    return None
