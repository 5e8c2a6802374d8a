"""A studio whose axes have 500 counts per mm, and a scope by itself."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator
from pathlib import Path

import pytest
import shiboken6
from PySide6.QtWidgets import QApplication

from app.theme import Theme
from codegen.models import MODELS
from codegen.setup import Setup, Unit
from codegen.setup_axis import Axis
from tests.stage import Stage, make_studio
from tests.widgets.scope.hands import SCALE
from widgets.scope.body import Body


@pytest.fixture
def stage(qapp: QApplication, tmp_path: Path) -> Iterator[Stage]:
    made = make_studio(tmp_path)
    document = made.studio.session.document
    axis = dc.replace(document.setup.axes[0], unit=Unit.MM, counts_per_unit=str(SCALE))
    setup = dc.replace(document.setup, model="ssc2", axes=(axis,) * 4)
    made.studio.session.set_document(dc.replace(document, setup=setup), "Table")
    made.studio.window.show()
    made.go()
    yield made
    made.clear_away()


@pytest.fixture
def body(qapp: QApplication) -> Iterator[Body]:
    """The scope without a studio: for what is seen of a capture."""
    theme = Theme(qapp)
    made = Body()
    axis = Axis(unit=Unit.MM, counts_per_unit=str(SCALE))
    made.show_machine(MODELS["ssc2"], Setup(model="ssc2", axes=(axis,) * 4))
    made.resize(1180, 600)
    made.show()
    qapp.processEvents()
    yield made
    theme.release()
    made.hide()
    shiboken6.delete(made)
