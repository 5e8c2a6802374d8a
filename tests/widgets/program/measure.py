"""What 1000 steps cost the program window, painted: `python -m tests.widgets.program.measure`."""

from __future__ import annotations

import gc
import os
import random
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from tests.benchmarks.figure import Figure

if TYPE_CHECKING:
    from app.session import Session
    from widgets.program.view import ProgramView

SEED = 7
IN_SIGHT = 18  # rows
MODES = ("program", "both", "code")


def shown(mode: str) -> tuple[Session, ProgramView]:
    """A program window of 900 x 800 with 1000 steps."""
    from PySide6.QtWidgets import QApplication

    from app.session import Session
    from tests.benchmarks.editing import large_document
    from widgets.program.view import ProgramView

    session = Session(large_document())
    view = ProgramView(session)
    view.resize(900, 800)
    view.show()
    view.set_view(mode)
    QApplication.processEvents()
    gc.collect()
    gc.freeze()  # what a whole run of tests has left behind is not looked through again and again
    return session, view


def painted(action: Callable[[], object]) -> float:
    """Milliseconds of processor time until what the action changed is on the screen."""
    from PySide6.QtWidgets import QApplication

    began = time.process_time()
    action()
    QApplication.processEvents()
    return 1000 * (time.process_time() - began)


def edits(mode: str, count: int = 40) -> Figure:
    """Changing, adding, removing, moving, undo and redo in turn; every other edit among the rows in sight."""
    from codegen.instructions import Output, Wait
    from codegen.program import Place, Section

    session, view = shown(mode)
    chance = random.Random(SEED)

    def one() -> str:
        return chance.choice(session.document.program.main[1 : chance.choice((IN_SIGHT, None))]).id

    kinds: tuple[Callable[[], object], ...] = (
        lambda: session.replace(one(), Wait(time=str(chance.randrange(5000, 9000)))),
        lambda: session.insert([Output(output="2")], one()),
        lambda: session.remove([one()]),
        lambda: session.move([one()], Place(Section.MAIN, chance.randrange(1, 900))),
        session.undo,
        session.redo,
    )
    spent = [painted(edit) for _ in range(count) for edit in kinds]
    view.close()
    return _p95(f"an edit of 1000 steps to the screen, view {mode}", spent, 16)


def opening() -> Figure:
    """From the file to the screen."""
    from codegen import files

    session, view = shown("program")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "large.tlp"
        files.save(path, session.document)
        session.new()
        spent = min(painted(lambda: session.open(path)) for _ in range(3))
    view.close()
    return Figure("opening 1000 steps", spent, "ms", most=150)


def wheel(count: int = 200) -> Figure:
    """Steps of the mouse wheel through the program."""
    from PySide6.QtCore import QPoint, QPointF, Qt
    from PySide6.QtGui import QWheelEvent
    from PySide6.QtWidgets import QApplication

    _, view = shown("program")
    target, at, none = view.tree.viewport(), QPointF(100, 100), Qt.MouseButton.NoButton

    def turn() -> None:
        phase, plain = Qt.ScrollPhase.NoScrollPhase, Qt.KeyboardModifier.NoModifier
        event = QWheelEvent(at, at, QPoint(), QPoint(0, -120), none, plain, phase, False)
        QApplication.sendEvent(target, event)

    spent = [painted(turn) for _ in range(count)]
    assert view.tree.verticalScrollBar().value() > 10_000  # it did scroll
    view.close()
    return _p95("a step of the wheel through 1000 steps", spent, 16)


def undoing(count: int = 1000) -> Figure:
    """Every one of many edits is taken back."""
    from codegen.instructions import Output

    session, view = shown("program")
    before = session.document
    for _ in range(count):
        session.insert([Output(output="2")])
    spent = [painted(session.undo) for _ in range(count)]
    assert session.document is before
    view.close()
    return _p95(f"undoing one of {count} edits of 1000 steps", spent, 16)


def _p95(name: str, values: list[float], most: float) -> Figure:
    ordered = sorted(values)
    note = f"of {len(values)}; middle {ordered[len(ordered) // 2]:.1f}"
    return Figure(name, ordered[int(len(ordered) * 0.95)], "ms (p95)", most=most, note=note)


def main() -> int:
    """Prints every figure."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    from PySide6.QtWidgets import QApplication

    from app.theme import Choice, Theme

    application = QApplication([])
    worn = Theme(application, Choice.LIGHT)
    for mode in MODES:
        print(edits(mode))
    for figure in (opening(), wheel(), undoing()):
        print(figure)
    worn.release()
    return 0


if __name__ == "__main__":
    sys.exit(main())
