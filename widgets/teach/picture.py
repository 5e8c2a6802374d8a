"""The picture of the table's path, in a column that scrolls."""

from __future__ import annotations

from PySide6.QtCore import QSize

from widgets.parts.plot import Plot


class PathPicture(Plot):
    """Wants no more than its least height, and takes what is left; a diagram's usual wish is a window."""

    def sizeHint(self) -> QSize:
        return self.minimumSize()
