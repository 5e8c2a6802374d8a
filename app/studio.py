"""Starts Qt and the studio."""

from __future__ import annotations

import sys
from functools import partial
from pathlib import Path

from PySide6.QtCore import QLocale, QTimer
from PySide6.QtWidgets import QApplication

import resources
from app.compose import RECORDINGS, Studio
from app.connection import connector, seeker
from app.help_pages import Pages
from app.search import Candidate
from app.settings import Settings, data_folder, settings_path
from app.which_model import known_models
from device.recorder import Recorder

SAMPLE = "examples/wire-cutter.tlp"
LOADING_MS = 1500  # until what opens later is loaded; sooner when it is opened
SETTLED_MS = 5000  # after this the start is over


def run_studio(file: Path | None, connect: str = "ask") -> int:
    """Opens the window and returns the exit code. `connect`: ask, offline, simulator[:MODEL] or port:PORT."""
    QLocale.setDefault(QLocale.c())
    application = QApplication.instance() or QApplication(sys.argv[:1])
    assert isinstance(application, QApplication)
    application.setApplicationName("Twoletter Studio")
    settings = Settings(settings_path())
    folder = data_folder()
    recorder = Recorder(folder / RECORDINGS)
    idle_s, known = partial(_idle_s, settings), partial(known_models, settings)
    connect_to = connector(folder / "programs", idle_s, known, recorder)
    seek = seeker(folder / "programs", idle_s, known, recorder)
    studio = Studio(application, settings, folder, connect_to, list_ports, Pages(), seek=seek, recorder=recorder)
    studio.crash.install()
    studio.window.show()
    studio.tick.start()
    QTimer.singleShot(0, lambda: begin(studio, file, connect))
    code = application.exec()
    studio.close()
    return int(code)


def begin(studio: Studio, file: Path | None, connect: str) -> None:
    """What the command line asked for, once the window is there."""
    studio.rubbish.keep()  # what is loaded by now is no garbage
    QTimer.singleShot(SETTLED_MS, studio.rubbish.keep)  # nor what the first connection loads: STOP waits for no search
    studio.loading.begin(LOADING_MS)
    studio.program.tree.setFocus()
    if file is not None:
        studio.files.open_path(file, at_once=True)  # what is connected may depend on it
    elif (left := studio.desk.left_behind()) is not None:
        studio.in_turn.hold(left)
    else:
        studio.session.open_copy(resources.path(SAMPLE))
    QTimer.singleShot(0, lambda: reach(studio, connect))  # what the person has clicked meanwhile goes first


def reach(studio: Studio, connect: str) -> None:
    """Connects as the command line asked for."""
    way, _, what = connect.partition(":")
    if way == "simulator":
        studio.start.use_simulator(what)
    elif way == "port":
        studio.start.open_port(what)
    elif way == "ask":
        studio.start.begin()


def _idle_s(settings: Settings) -> float:
    return 60.0 * float(settings.get("idle_minutes"))


def list_ports() -> list[Candidate]:
    """The serial ports of this computer."""
    from device.find import ports

    return [Candidate(port.device, port.description, port.used_before) for port in ports()]
