"""The inspector is narrow: its forms never need to be scrolled sideways, and nothing in them is cut at the side."""

from __future__ import annotations

import pytest
from pytestqt.qtbot import QtBot

from codegen.instructions import ALL, Instruction
from codegen.program import Step
from tests.widgets.form.clipping import machine_offers, settle
from widgets.form.inspector import Inspector

WIDTH = 288  # px, what the dock gives at 1280


@pytest.mark.parametrize("kind", ALL, ids=lambda kind: kind.__name__)
def test_a_narrow_form_fits_its_width(qtbot: QtBot, kind: type[Instruction]) -> None:
    inspector = Inspector(machine_offers("ssc4"))
    qtbot.addWidget(inspector)
    inspector.resize(WIDTH, 300)
    inspector.show()
    inspector.show_step(Step("s1", kind.example()), inspector.form.offers)
    settle()
    area = inspector.form.area
    assert area.inside.width() <= area.viewport().width()
