"""Loading without reading every source."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

TOLD = """
import inspect
import PySide6.QtCore
from app.quick import spare_reading
read = []
inspect.getsource = lambda module: read.append(module.__name__) or ""
import unheard_first
print("unheard_first" in read)
spare_reading()
import unheard_second
print("unheard_second" in read, repr(unheard_second.QObject().objectName()))
"""


def test_no_source_is_read_for_nothing(tmp_path: Path) -> None:
    """In a process of its own, as it holds for all that is loaded afterwards."""
    for name in ("unheard_first", "unheard_second"):
        (tmp_path / f"{name}.py").write_text("from PySide6.QtCore import QObject\n", encoding="utf-8")
    around = {**os.environ, "PYTHONPATH": os.pathsep.join((str(Path(__file__).parents[2]), str(tmp_path)))}
    run = subprocess.run([sys.executable, "-c", TOLD], env=around, capture_output=True, text=True, timeout=60)
    first, second = run.stdout.splitlines()
    assert first == "True"  # as PySide does by itself; once it does not, app/quick.py can go
    assert second == "False ''"
