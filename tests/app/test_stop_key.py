"""The types of Qt are made before the filter of the stop key can meet an object of them."""

from __future__ import annotations

import subprocess
import sys

LEFT = """
from PySide6 import QtCore, QtGui, QtWidgets
from app.stop_key import make_types
make_types()
met = (QtCore.QObject, QtCore.QEvent)
for module in (QtCore, QtGui, QtWidgets):
    made = set(vars(module))
    for name in dir(module):
        kind = getattr(module, name)
        if name not in made and isinstance(kind, type) and issubclass(kind, met):
            print(name)
"""


def test_no_type_of_an_object_or_event_is_left_to_the_filter() -> None:
    done = subprocess.run([sys.executable, "-c", LEFT], capture_output=True, text=True, check=True)
    assert done.stdout == ""
