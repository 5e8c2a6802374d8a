"""Every widget here is shown in the light theme."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtWidgets import QApplication

from app.theme import Choice, Theme


@pytest.fixture(autouse=True)
def light(qapp: QApplication) -> Iterator[None]:
    """The theme the widgets paint with."""
    theme = Theme(qapp, Choice.LIGHT)
    yield
    theme.deleteLater()
