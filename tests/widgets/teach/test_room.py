"""Nothing in the panel lies over another part of it, however low the dock is and however long a sentence."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

from PySide6.QtWidgets import QApplication

from tests.widgets.teach.bench import Bench


def test_what_stands_below_each_other_does_not_overlap(qapp: QApplication, tmp_path: Path) -> None:
    bench = Bench(tmp_path)
    bench.stage.studio.window.resize(1280, 800)
    parts = bench.connect().parts
    parts.fold.click()
    bench.panel.show_result("A sentence that is long enough to go on in a second and in a third line. " * 3)
    bench.stage.go(3)
    edits, files = parts.edits["insert"], parts.files["new"]
    assert parts.plot is not None
    column = (parts.play, parts.view, edits, files, parts.plot)
    places = sorted((each.geometry() for each in column), key=lambda place: place.top())
    assert all(above.bottom() < below.top() for above, below in pairwise(places))
    assert parts.view.height() >= parts.view.minimumHeight()
    bench.stage.clear_away()
