"""Which help page belongs to a widget."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

PROPERTY = "helpPage"


def topic_of(widget: QWidget | None) -> str | None:
    """The page of the nearest widget upwards that names one; None when none does.

    A widget whose page depends on where its cursor is has a method `help_page`.
    """
    while widget is not None:
        asked = getattr(widget, "help_page", None)
        page = (asked() if callable(asked) else "") or widget.property(PROPERTY)
        if page:
            return str(page)
        widget = widget.parentWidget()
    return None
