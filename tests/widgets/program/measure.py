"""What an edit of 1000 steps costs the program window: `python -m tests.widgets.program.measure [program|both]`."""

from __future__ import annotations

import os
import random
import sys
import time
from collections.abc import Callable

COUNT = 100  # edits of each kind
SEED = 7


def main(mode: str) -> int:
    """Prints middle and 95th percentile in milliseconds of processor time, without and with painting."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    from PySide6.QtWidgets import QApplication

    from app.session import Session
    from app.theme import Choice, Theme
    from codegen.instructions import Output, Wait
    from codegen.program import Place, Section
    from tests.benchmarks.editing import large_document
    from widgets.program.view import ProgramView

    application = QApplication([])
    worn = Theme(application, Choice.LIGHT)
    session = Session(large_document())
    view = ProgramView(session)
    view.resize(900, 800)
    view.show()
    view.set_view(mode)
    application.processEvents()
    chance = random.Random(SEED)

    def one() -> str:
        return chance.choice(session.document.program.main[1:]).id

    edits: dict[str, Callable[[], object]] = {
        "change": lambda: session.replace(one(), Wait(time=str(chance.randrange(5000, 9000)))),
        "insert": lambda: session.insert([Output(output="2")], one()),
        "remove": lambda: session.remove([one()]),
        "move": lambda: session.move([one()], Place(Section.MAIN, chance.randrange(1, 900))),
        "undo": session.undo,
        "redo": session.redo,
    }
    spent: dict[str, list[tuple[float, float]]] = {name: [] for name in edits}
    for _ in range(COUNT):
        for name, edit in edits.items():
            began = time.process_time()
            edit()
            told = time.process_time()
            application.processEvents()
            spent[name].append((1000 * (told - began), 1000 * (time.process_time() - began)))
    for name, pairs in spent.items():
        print(f"{name:7} {_figures([pair[0] for pair in pairs])}   painted {_figures([pair[1] for pair in pairs])}")
    worn.release()
    return 0


def _figures(values: list[float]) -> str:
    ordered = sorted(values)
    return f"{ordered[0]:5.1f} {ordered[len(ordered) // 2]:5.1f} ms (p95 {ordered[int(len(ordered) * 0.95)]:5.1f})"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1] if len(sys.argv) > 1 else "both"))
