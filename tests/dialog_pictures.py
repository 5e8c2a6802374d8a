"""The dialogs of all instructions, for pictures: empty and with their example, on a small and on a large machine."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from PySide6.QtWidgets import QWidget

from codegen.instructions import ALL
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
