"""The dialogs of all instructions, for pictures: empty and with their example, on a small and on a large machine."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget

from codegen.instructions import ALL, CircularPath, ContourMode, ElectronicCam, SingleAxisMove
from codegen.laws import Law
from tests.widgets.form.clipping import FILLINGS, MODELS, machine_offers, open_dialog
from widgets.form.inspector import Inspector

PANEL = (1280, 800)  # the least screen of look.md, px


def display(folder: Path, scale: int) -> str:
    """The off-screen platform with a panel of 1280 x 800 at a scale; for QT_QPA_PLATFORM."""
    wide, high = (scale * length for length in PANEL)
    place = {"x": 0, "y": 0, "width": wide, "height": high}
    screen = {"name": "panel", **place, "logicalDpi": 96, "logicalBaseDpi": 96, "dpr": 1}
    path = folder / f"display-{scale}.json"
    path.write_text(json.dumps({"screens": [screen]}), encoding="utf-8")
    return f"offscreen:configfile={path}"


def dialog_scenes() -> Iterator[tuple[str, QWidget]]:
    """Name and dialog of every picture; each is closed when the next is asked for."""
    for model in MODELS:
        for kind in ALL:
            for filling in FILLINGS:
                dialog = open_dialog(kind, model, filling)
                yield f"instruction-{_name(kind.title)}-{model}-{filling}", dialog
                dialog.reject()


def helper_scenes() -> Iterator[tuple[str, QWidget]]:
    """What opens from a dialog: the expression builder, filling a column; an open arc, a filled cam, positions."""
    move = open_dialog(SingleAxisMove, "ssc4", "example")
    line = move.form.fields.cells["distance", ""].editor
    line.setValue("(_TPX/2)+LEN")
    line.changed.emit(line.text())
    line.build()
    line.builder.search.setText("position x")
    for name, text in (("_TPX", "1274"), ("LEN", "1.5")):
        QTest.keyClicks(line.builder.assumed[name], text)
    yield "expression-builder", line.builder
    move.reject()
    cam = open_dialog(ElectronicCam, "ssc4", "example")
    grid = cam.form.fields.cells["table", ""].editor
    grid.fill()
    filling = grid.fill_dialog
    filling.how.setCurrentIndex(filling.how.findData(Law.MODIFIED_SINE))
    for line_edit, text in ((filling.last, "27"), (filling.end, "2")):
        line_edit.selectAll()
        QTest.keyClicks(line_edit, text)
    yield "fill-a-column", filling
    filling.fill.click()
    grid.view.go_to(8, 0)
    yield "cam-filled", cam
    cam.reject()
    contour = open_dialog(ContourMode, "ssc4", "example")
    contour.form.fields.cells["table", ""].editor.added_up.click()
    yield "contour-positions", contour
    contour.reject()
    arc = open_dialog(CircularPath, "ssc4", "example")
    arc.form.fields.cells["segments", ""].editor.list.setCurrentRow(1)
    yield "arc-open", arc
    arc.reject()


def inspector_scenes() -> Iterator[tuple[str, QWidget]]:
    """The same forms in the narrow panel."""
    from codegen.program import Step

    inspector = Inspector(machine_offers("ssc4"))
    inspector.resize(288, 600)
    inspector.show()
    for kind in ALL:
        inspector.show_step(Step("s1", kind.example(), note="why it is here"), inspector.form.offers)
        yield f"inspector-{_name(kind.title)}", inspector
    inspector.close()


def _name(title: str) -> str:
    return title.lower().replace(" ", "-").replace("/", "-")
