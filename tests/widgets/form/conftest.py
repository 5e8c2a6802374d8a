"""Every widget here is shown in the light theme."""

from __future__ import annotations

import pytest
from PySide6.QtWidgets import QApplication

from app.theme import Choice, Theme


@pytest.fixture(autouse=True, scope="session")
def light(qapp: QApplication) -> Theme:
    """The theme the widgets paint with; one for all tests, as in the program."""
    return Theme(qapp, Choice.LIGHT)
