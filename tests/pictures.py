"""Takes a picture of every window and dialog, light and dark, at 100 % and 200 %: `python -m tests.pictures OUT`.

`python -m tests.pictures --shown` takes those that README and help show, into resources/help/pictures.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING

from tests.dialog_pictures import PANEL

if TYPE_CHECKING:
    from PySide6.QtWidgets import QApplication, QWidget

    from tests.stage import Stage

SCALES = (1, 2)
THEMES = ("light", "dark")
AT_ONCE = 2  # processes
QUIET = "This plugin does not support"  # what the off-screen platform says again and again
# scenes that pages of the help show, in light colours: the picture's name, and the panel that is cut out of the window
SHOWN = {
    "panel-x-y-view": ("x-y-view", "X-Y view"),
    "panel-jog": ("jog", "Jog"),
    "panel-operator-panel": ("operator-terminal", "Operator terminal"),
    "scope-capture": ("scope", ""),
    "tuner-manual": ("tuner", "Tuner"),
    "commissioning-polarity": ("bring-an-axis-to-life", ""),
    "panel-teach": ("teach", "Teach"),
    "panel-display-codes": ("display", "Display"),
}


def main(arguments: list[str]) -> int:
    """Without --one: a process for every theme and scale, because the scale is fixed when Qt starts."""
    if arguments[:1] == ["--one"]:
        take(Path(arguments[1]), arguments[2], int(arguments[3]))
        return 0
    if arguments[:1] == ["--one-shown"]:
        take_shown(arguments[1])
        return 0
    if arguments[:1] == ["--shown"]:
        for theme in THEMES:
            _in_a_process("--one-shown", theme, scale=1)
        return 0
    out = Path(arguments[0] if arguments else "pictures")
    out.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(AT_ONCE) as several:
        for scale in SCALES:
            list(several.map(lambda theme, scale=scale: _one(out, theme, scale), THEMES))  # type: ignore[misc]
    print(f"{len(list(out.glob('*.png')))} pictures in {out}")
    return 0


def _one(out: Path, theme: str, scale: int) -> None:
    _in_a_process("--one", str(out), theme, str(scale), scale=scale)


def _in_a_process(*arguments: str, scale: int) -> None:
    from tests.dialog_pictures import display

    surroundings = {**os.environ, "QT_SCALE_FACTOR": str(scale)}
    with tempfile.TemporaryDirectory() as folder:
        if surroundings.get("QT_QPA_PLATFORM", "offscreen") == "offscreen":
            surroundings["QT_QPA_PLATFORM"] = display(Path(folder), scale)
        subprocess.run([sys.executable, "-m", "tests.pictures", *arguments], check=True, env=surroundings)


def take(out: Path, theme: str, scale: int) -> None:
    """Everything in one theme at one scale; what is larger than the least screen is an error, told at the end."""
    application, large = _application(), []
    with tempfile.TemporaryDirectory() as folder:
        for name, widget in scenes(Path(folder), theme):
            settle()
            widget.grab().save(str(out / f"{name}-{theme}-{scale}00.png"))
            if widget.width() > PANEL[0] or widget.height() > PANEL[1]:
                large.append(f"{name}: {widget.width()} x {widget.height()}")
    del application
    if large:
        raise SystemExit(f"larger than {PANEL[0]} x {PANEL[1]}, {theme}: {', '.join(large)}")


def _application() -> QApplication:
    from PySide6.QtCore import qInstallMessageHandler
    from PySide6.QtWidgets import QApplication

    qInstallMessageHandler(lambda _kind, _where, words: None if QUIET in words else print(words, file=sys.stderr))
    found = QApplication.instance()
    return found if isinstance(found, QApplication) else QApplication([])


def take_shown(theme: str) -> None:
    """The pictures of README and help: the studio with the simulator running the wire cutter; in light the panels."""
    import resources
    from tests.stage import make_studio

    application = _application()
    with tempfile.TemporaryDirectory() as folder:
        stage = make_studio(Path(folder), theme=theme)
        stage.studio.window.resize(1280, 800)
        stage.studio.window.show()
        settle()
        running(stage, "simulator")
        settle()
        name = "program" if theme == "light" else f"program-{theme}"
        stage.studio.window.grab().save(str(resources.path(f"help/pictures/{name}.png")))
        for scene, widget in _plane(stage) if theme == "light" else ():
            settle()
            if scene in SHOWN:
                name, panel = SHOWN[scene]
                shown = stage.studio.window.docks[panel] if panel else widget
                shown.grab().save(str(resources.path(f"help/pictures/{name}.png")))
        stage.studio.close()
    del application


def settle() -> None:
    """Lets layouts and singleshots happen, and what was given up go."""
    from PySide6.QtCore import QEvent
    from PySide6.QtWidgets import QApplication

    for _ in range(6):
        QApplication.processEvents()
        QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


def scenes(folder: Path, theme: str) -> Iterator[tuple[str, QWidget]]:
    """Name and widget of every picture, in an order in which each needs only the ones before."""
    from tests.stage import make_studio

    stage = make_studio(folder, theme=theme)
    studio, window = stage.studio, stage.studio.window
    window.resize(1280, 800)
    window.show()
    settle()
    yield "window-offline", window
    for kind in ("simulator", "machine"):
        running(stage, kind)
        yield f"window-{kind}", window
    yield from _states(stage)
    for dock, layout in (("Simulator", "Program"), ("Inspector", "Program"), ("Terminal", "Run"), ("Messages", "Run")):
        running(stage, "simulator")
        studio.desk.arrange(layout)
        stage.type("MG _TPX", "KP 5000", "TI")
        window.docks[dock].raise_()
        stage.go()
        yield f"panel-{dock.lower()}", window
    yield from _dialogs(stage)
    yield from _program(stage)
    yield from _plane(stage)
    studio.close()


def _program(stage: Stage) -> Iterator[tuple[str, QWidget]]:
    from tests.dialog_pictures import dialog_scenes, helper_scenes, inspector_scenes

    program = stage.studio.program
    for mode in ("both", "code"):
        program.set_view(mode)
        yield f"program-{mode}", stage.studio.window
    program.set_view("program")
    yield from dialog_scenes()
    yield from helper_scenes()
    yield from inspector_scenes()


def running(stage: Stage, kind: str) -> None:
    """The open program in a machine, executing, half-way through its move, everything read afresh."""
    from device.api import LineSettings

    studio = stage.studio
    rig = stage.connect(kind, studio.model(), line=LineSettings(baud=19200))
    stage.download()
    rig.type("OE 1")  # as in the setup: nothing is asked
    studio.run.execute()
    stage.until(lambda: rig.simulation.state()["axes"]["X"]["commanded"] > 1500)
    moment = stage.clock.now
    keys = ("position.x", "thread0")  # what the status bar shows, whatever panel is in front
    stage.until(lambda: all(rig.controller.last().time(key) > moment for key in keys))
    stage.go(12)


def _plane(stage: Stage) -> Iterator[tuple[str, QWidget]]:
    """A rounded rectangle as the X-Y view saw it."""
    import dataclasses as dc

    from tests.bar_pictures import bar_scenes
    from tests.panel_pictures import (
        commissioning_scenes,
        display_scenes,
        doctor_scenes,
        event_scenes,
        replay_scenes,
        scope_scenes,
        teach_scenes,
    )
    from tests.tuner_pictures import tuner_scenes

    studio, document = stage.studio, stage.studio.session.document
    axis = dc.replace(document.setup.axes[0], reverse_limit="-5", forward_limit="25")
    setup = dc.replace(document.setup, model="ssc2", axes=(axis,) * 4)
    studio.session.set_document(dc.replace(document, setup=setup), "A table")
    rig = stage.connect("simulator", "ssc2")
    studio.desk.bring("X-Y view")
    rig.type("VS 6000", "VA 100000", "VD 100000", "VM XY")
    rig.type("VP 6370,0", "CR 1911,270,90", "VP 8281,5733", "CR 1911,0,90", "VP 0,7644", "CR 1911,90,90")
    rig.type("VP -1911,1911", "CR 1911,180,90", "VE", "BGS")
    stage.until(lambda: rig.simulation.state()["axes"]["Y"]["commanded"] > 7600)
    yield "panel-x-y-view", studio.window
    yield from _jog(stage)
    yield from bar_scenes()
    yield from _operator(stage)
    yield from _values(stage)
    yield from event_scenes(stage)
    yield from doctor_scenes(stage)
    yield from scope_scenes(stage)
    yield from tuner_scenes(stage)
    yield from commissioning_scenes(stage)
    yield from teach_scenes(stage)
    yield from replay_scenes(stage)
    yield from display_scenes(stage)


def _jog(stage: Stage) -> Iterator[tuple[str, QWidget]]:
    """The pages of the jog panel; on the first an axis is held, on the others an end is looked at."""
    stage.until(lambda: not stage.rig.simulation.state()["axes"]["X"]["moving"])
    stage.studio.desk.bring("Jog")
    stage.go(5)
    panel = stage.studio.at_machine.jog
    assert panel.one is not None
    panel.one.hold_forward.pressed.emit()
    for _ in range(20):
        stage.go(1)
        panel.holder.renew()
    yield "panel-jog", stage.studio.window
    panel.one.hold_forward.let_go()
    stage.go(30)
    for number, name in ((1, "line"), (2, "arc"), (3, "stick"), (4, "points")):
        panel.buttons[number].click()
        stage.go()
        if panel.saved is not None:
            for place in ("Load", "Park"):
                panel.saved.name.setText(place)
                panel.saved.save.click()
            panel.saved.choose("Load")
            stage.go()
        yield f"panel-jog-{name}", stage.studio.window


def _values(stage: Stage) -> Iterator[tuple[str, QWidget]]:
    """Variables beside a recipe, and an array with its picture."""
    stage.rig.start("#A\nLEN=12.5\nCOUNT=1200\nDM POS[20]\nN=0\n#L;POS[N]=N*N;N=N+1;JP #L,N<20\nEN")
    stage.later(1)
    panel = stage.studio.at_machine.values
    stage.studio.desk.bring("Variables")
    panel.read.click()
    stage.until(lambda: "LEN 12.5" in panel.words())
    panel.table.setCurrentCell(panel.table.rowCount() - 1, 0)
    stage.until(lambda: panel.elements.rowCount() == 20)
    panel.show_recipe({"LEN": "13", "COUNT": "1200"})
    stage.go()
    yield "panel-variables", stage.studio.window


def _operator(stage: Stage) -> Iterator[tuple[str, QWidget]]:
    """Both forms of the operator terminal, with what a program wrote on its display."""
    keys = stage.studio.at_machine.keys
    stage.studio.desk.bring("Operator terminal")
    stage.go()
    keys.connect_button.click()
    stage.until(lambda: keys.connect_button.text() == "Disconnect")
    stage.rig.type('MG{P2}{^27},"E"{N}', 'MG{P2} "LENGTH (MM)  12.50"', 'MG{P2} "F1 START  F2 MENU"{N}')
    stage.until(lambda: "MENU" in keys.words())
    for form in ("Hand-held", "Panel"):
        keys.form.setCurrentText(form)
        stage.go()
        yield f"panel-operator-{form.lower()}", stage.studio.window


def _states(stage: Stage) -> Iterator[tuple[str, QWidget]]:
    from device.api import State, StopState

    button = stage.studio.window.header.stop
    rig = stage.connect("machine", scene="jogging")
    stage.controller.stop()
    stage.go(1)
    yield "stop-stopping", button
    stage.until(lambda: stage.controller.stop_state is StopState.STOPPED)
    stage.go()
    yield "stop-stopped", button
    rig.cut()
    stage.controller.stop()
    stage.later(0.6)
    stage.go(1)
    yield "stop-not-confirmed", button
    rig = stage.connect("machine", answers=False, openable=False)
    stage.until(lambda: stage.controller.state is State.LOST)
    stage.go()
    yield "stop-no-link", button
    yield "window-lost", stage.studio.window
    stage.question("simulator", stage.studio.model())
    stage.later(12.0)
    stage.go()
    yield "window-question", stage.studio.window


def _dialogs(stage: Stage) -> Iterator[tuple[str, QWidget]]:
    from app.crash import CrashDialog
    from tests.setup_pictures import setup_scenes

    studio = stage.studio
    desk, start = studio.desk, studio.start
    start.welcome_window().show_looking("Asking USB serial (/dev/ttyUSB0) at 9600 baud…")
    yield "welcome-looking", start.welcome
    start.welcome.show_question("/dev/ttyUSB1", "USB serial adapter")
    yield "welcome-question", start.welcome
    start.welcome.show_nothing("No controller answered at 9600 baud (/dev/ttyUSB0: no answer). Check cable and power.")
    yield "welcome-nothing", start.welcome
    start.show_serial()
    yield "serial-setup", start.serial
    studio.options.show()
    yield "settings", studio.options.page
    yield from setup_scenes(stage)
    answers: list[tuple[str, Callable[[], None]]] = [("Download and execute", lambda: None), ("Run it", lambda: None)]
    desk.ask("Which program?", "The program was changed since it was downloaded.", answers, "warning")
    yield "question", desk.question
    rig = stage.connect("machine", "ssc1", program="#A\nJG 5000\nBG X\nAM X\nEN", answers=False)
    rig.simulation.execute("#A")
    stage.go(60)
    yield "found-working", desk.question
    studio.actions["connect"].trigger()
    stage.go(30)
    yield "leaving", desk.question
    yield from _unsaved(stage)
    desk.show_upload("#A\nPR 6370\nBG X\nEN\n")
    yield "upload", desk.upload
    desk.show_help("Program window")
    stage.go(1)
    yield "help", desk.help
    yield "crash", CrashDialog("Python 3.11 on Linux\n\nTraceback …\nValueError: example", Path("crash.txt"))
    studio.window.docks["Display"].setFloating(True)
    yield "display-floating", studio.window.docks["Display"]
    studio.window.docks["Display"].setFloating(False)
    studio.desk.arrange("Program")


def _unsaved(stage: Stage) -> Iterator[tuple[str, QWidget]]:
    """Work a crash left behind, and a file that another program has changed meanwhile."""
    from datetime import datetime

    from app.recovery import Recovery

    studio = stage.studio
    path = studio.session.path
    assert path is not None
    for hour, original in ((9, path), (11, None)):
        Recovery(path.parent / "recovery").set_aside(studio.session.document, original, datetime(2026, 5, 4, hour, 30))
    studio.actions["recover"].trigger()
    assert studio.desk.unsaved is not None
    yield "unsaved-work", studio.desk.unsaved
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("CUTTER", "SLITTER"), encoding="utf-8")
    _until_bar(stage, True)
    yield "file-changed", studio.window
    path.write_text(text, encoding="utf-8")
    _until_bar(stage, False)


def _until_bar(stage: Stage, shown: bool) -> None:
    """The file system tells of a change when it likes."""
    from PySide6.QtTest import QTest

    for _ in range(200):
        if stage.studio.files.bar.isVisible() is shown:
            return
        QTest.qWait(20)
    raise AssertionError("the change of the file was not told")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
