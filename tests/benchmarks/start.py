"""How long the studio takes until its first dialog can be used, against a bare window."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from tests.benchmarks.figure import Figure

ROOT = Path(__file__).resolve().parents[2]
ROUNDS = 3
BARE = """
import sys, time
import pyqtgraph
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication, QMainWindow
application = QApplication([])
window = QMainWindow()
window.setCentralWidget(pyqtgraph.PlotWidget())
window.resize(1200, 800)
window.show()
def ready():
    print(time.time(), flush=True)
    application.quit()
QTimer.singleShot(0, ready)
application.exec()
"""
# without looking for garbage until the window is there, and without reading sources, as `app.__main__` starts it
STUDIO = """
import gc, sys
gc.disable()
from app.quick import spare_reading
spare_reading()
from pathlib import Path
from tests.benchmarks.studio import main
sys.exit(main(Path(sys.argv[1])))
"""


def run(arguments: list[str], folder: str) -> tuple[float, dict[str, float]]:
    """Starts a process; seconds from its start to the time it prints, and what else it says.

    As after an installation, its compiled code is kept: in a folder of its own, whatever the surroundings say.
    """
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen", "PYTHONPYCACHEPREFIX": folder}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    began = time.time()
    done = subprocess.run(
        [sys.executable, *arguments], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr[-3000:]
    said = json.loads(done.stdout.strip().splitlines()[-1])
    if isinstance(said, dict):
        return said["dialog"] - began, {name: value - began for name, value in said.items()}
    return float(said) - began, {}


def start_figures() -> list[Figure]:
    """Ratio of the starts (best of three each, one round to warm up), and the wait for the simulator after it."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        studio = ["-c", STUDIO, folder]
        run(["-c", BARE], folder)
        cold = run(studio, folder)[0]
        bare = min(run(["-c", BARE], folder)[0] for _ in range(ROUNDS))
        starts = [run(studio, folder) for _ in range(ROUNDS)]
    best, times = min(starts, key=lambda each: each[0])
    note = f"{best:.2f} s against {bare:.2f} s, cold {cold:.2f} s"
    return [
        Figure("start to the first dialog, against a bare window", best / bare, "×", most=1.6, note=note),
        Figure("simulator ready after that", max(0.0, times["simulator"] - times["dialog"]), "s", most=1.5),
    ]
