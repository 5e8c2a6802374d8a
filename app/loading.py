"""What panels are made of and takes long to load: loaded beside the window, before it is wanted."""

from __future__ import annotations

import threading
from collections.abc import Iterable
from functools import partial
from importlib import import_module

from PySide6.QtCore import QTimer

from app.background import beside

# numpy and pyqtgraph take most of the time; the others stand on them, or open with a click
MODULES = (
    "numpy.fft", "numpy.ma", "pyqtgraph", "widgets.parts.plot",
    "widgets.jog.one_axis", "widgets.teach.parts", "widgets.scope.body", "widgets.tuner.pages", "widgets.tuner.plots",
    "device.values", "device.tuning.run", "device.tuning.entry", "device.capturing", "device.roll",
    "device.setup_transfer", "widgets.setup.window", "widgets.help.panel", "app.commissioning",
    "app.commissioning_pages", "widgets.commissioning.window", "widgets.compare.window", "widgets.backup.window",
    "widgets.connect.serial_setup", "widgets.connect.doctor", "widgets.options.page", "widgets.editor.window",
    "widgets.program.printing_pack", "widgets.backup.handover", "app.help_tables",
)  # fmt: skip


class Loading:
    """Before `begin` everything is loaded by whoever uses it first."""

    def __init__(self, pages: Iterable[str] = ()) -> None:
        """`pages` of the help, which read their files when they are first asked for."""
        self._begun, self._pages = False, pages
        self._thread: threading.Thread | None = None

    def begin(self, after_ms: int) -> None:
        """Loads in a while, or as soon as somebody asks whether it is ready."""
        self._begun = True
        QTimer.singleShot(after_ms, self._load)

    @property
    def ready(self) -> bool:
        """Whether it is there; who needs it asks again."""
        if self._begun:
            self._load()
        return self._thread is None or not self._thread.is_alive()

    def _load(self) -> None:
        if self._thread is None:
            self._thread = threading.Thread(target=partial(load, self._pages), name="loading", daemon=True)
            self._thread.start()


def load(pages: Iterable[str] = ()) -> None:
    """Every module, one after the other, then the help."""
    beside(lambda: ([import_module(name) for name in MODULES], list(pages)))
