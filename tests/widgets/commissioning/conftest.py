"""A studio with a table in mm, 1000 counts in each."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication

from codegen.setup import Unit
from tests.stage import Stage, make_studio


@pytest.fixture
def stage(qapp: QApplication, tmp_path: Path) -> Iterator[Stage]:
    made = make_studio(tmp_path)
    document = made.studio.session.document
    axis = dc.replace(document.setup.axes[0], unit=Unit.MM, counts_per_unit="1000")
    setup = dc.replace(document.setup, axes=(axis,) * 4)
    made.studio.session.set_document(dc.replace(document, setup=setup), "Machine")
    made.studio.window.resize(1280, 900)
    made.studio.window.show()
    made.go()
    yield made
    made.clear_away()
