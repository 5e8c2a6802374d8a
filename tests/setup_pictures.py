"""Pictures of the setup window: every page, what differs from a controller, the calculator, the question."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from PySide6.QtWidgets import QWidget

    from tests.stage import Stage


def setup_scenes(stage: Stage) -> Iterator[tuple[str, QWidget]]:
    """Every page of the setup, what differs from a controller, the calculator, and the question about the scale."""
    studio = stage.studio
    before = studio.session.document
    studio.session.set_setup(dc.replace(before.setup, model="ssc2"))
    rig = stage.connect("machine", "ssc2")
    rig.controller.take_control()
    rig.type("KP 12.5", "FL 20000", "MT ,-1")
    studio.setup.show()
    stage.go()
    window = studio.setup.window
    assert window is not None
    for page in window.pages[:-1]:
        window.open_page(page)
        stage.go()
        yield f"setup-{page.title.lower().replace(' ', '-')}", window
    stage.until(lambda: bool(window.comparing.readings))  # read when the window opened
    window.open_page(window.compare)
    stage.go()
    yield "setup-compared", window
    window.open_page(window.servo)
    yield "setup-servo-compared", window
    window.open_page(window.axes)
    window.axes.rows["X"].work_out.click()
    assert window.axes.calculator is not None
    window.axes.calculator.form.cells["pitch", ""].editor.setText("7")
    window.axes.calculator.form.cells["pitch", ""].editor.textEdited.emit("7")
    yield "setup-calculator", window.axes.calculator
    window.axes.calculator.take.click()
    window.done_button.click()
    yield "setup-scale-changed", window
    window.reject()
    studio.session.undo()
