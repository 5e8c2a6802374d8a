"""Takes a picture of every window and dialog, light and dark, at 100 % and 200 %: `python -m tests.pictures OUT`."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

SCALES = (1, 2)
THEMES = ("light", "dark")


def main(arguments: list[str]) -> int:
    """Without --one: a process for every theme and scale, because the scale is fixed when Qt starts."""
    if arguments[:1] == ["--one"]:
        take(Path(arguments[1]), arguments[2], int(arguments[3]))
        return 0
    out = Path(arguments[0] if arguments else "pictures")
    out.mkdir(parents=True, exist_ok=True)
    for theme in THEMES:
        for scale in SCALES:
            surroundings = {"QT_QPA_PLATFORM": "offscreen", **os.environ, "QT_SCALE_FACTOR": str(scale)}
            command = [sys.executable, "-m", "tests.pictures", "--one", str(out), theme, str(scale)]
            subprocess.run(command, check=True, env=surroundings)
    print(f"{len(list(out.glob('*.png')))} pictures in {out}")
    return 0


def take(out: Path, theme: str, scale: int) -> None:
    """Everything in one theme at one scale."""
    from PySide6.QtWidgets import QApplication, QWidget

    application = QApplication.instance() or QApplication([])
    with tempfile.TemporaryDirectory() as folder:
        for name, widget in scenes(application, Path(folder), theme):
            settle()
            grabbed: QWidget = widget
            grabbed.grab().save(str(out / f"{name}-{theme}-{scale}00.png"))


def settle() -> None:
    """Lets layouts and singleshots happen."""
    from PySide6.QtWidgets import QApplication

    for _ in range(6):
        QApplication.processEvents()


def scenes(application: object, folder: Path, theme: str) -> Iterator[tuple[str, object]]:
    """Name and widget of every picture, in an order in which each needs only the ones before."""
    from tests.stage import make_studio

    stage = make_studio(folder, theme=theme)
    studio, window = stage.studio, stage.studio.window
    window.resize(1280, 800)
    window.show()
    settle()
    yield from _offline(stage)
    stage.connect()
    stage.go()
    yield "window-simulator", window
    for kind in ("machine", "replay"):
        stage.connect(kind)
        stage.go()
        yield f"window-{kind}", window
    yield from _states(stage)
    for dock, layout in (("Simulator", "Program"), ("Inspector", "Program"), ("Terminal", "Run"), ("Messages", "Run")):
        stage.connect("simulator")
        studio.desk.arrange(layout)
        stage.chatter()
        window.docks[dock].raise_()
        stage.go()
        yield f"panel-{dock.lower()}", window
    yield from _dialogs(stage)
    yield from _program(stage)
    studio.close()


def _program(stage: object) -> Iterator[tuple[str, object]]:
    from codegen.instructions import ALL

    program = stage.studio.program  # type: ignore[attr-defined]
    for mode in ("both", "code"):
        program.set_view(mode)
        yield f"program-{mode}", stage.studio.window  # type: ignore[attr-defined]
    program.set_view("program")
    for kind in ALL:
        dialog = program.dialogs.add(kind)
        yield f"instruction-{kind.title.lower().replace(' ', '-').replace('/', '-')}", dialog
        dialog.reject()


def _offline(stage: object) -> Iterator[tuple[str, object]]:
    yield "window-offline", stage.studio.window  # type: ignore[attr-defined]


def _states(stage: object) -> Iterator[tuple[str, object]]:
    from device.api import Prompt, StopState

    studio = stage.studio  # type: ignore[attr-defined]
    for state in (StopState.STOPPING, StopState.STOPPED, StopState.NOT_CONFIRMED, StopState.NO_LINK):
        stage.controller.stop_state = state  # type: ignore[attr-defined]
        stage.go()  # type: ignore[attr-defined]
        yield f"stop-{state.name.lower()}", studio.window.header.stop
    stage.controller.stop_state = StopState.READY  # type: ignore[attr-defined]
    stage.controller.pending_prompt = Prompt("Length in inches?", (12,))  # type: ignore[attr-defined]
    stage.later(12.0)  # type: ignore[attr-defined]
    stage.go()  # type: ignore[attr-defined]
    yield "window-question", studio.window
    stage.controller.pending_prompt = None  # type: ignore[attr-defined]
    stage.later(0.0)  # type: ignore[attr-defined]


def _dialogs(stage: object) -> Iterator[tuple[str, object]]:
    from app.crash import CrashDialog
    from codegen.setup import Unit

    studio = stage.studio  # type: ignore[attr-defined]
    desk, start = studio.desk, studio.start
    start.welcome_window().show_looking("Asking USB serial (/dev/ttyUSB0) at 9600 baud…")
    yield "welcome-looking", start.welcome
    start.welcome.show_question("/dev/ttyUSB1", "USB serial adapter")
    yield "welcome-question", start.welcome
    start.welcome.show_nothing("No controller answered at 9600 baud (/dev/ttyUSB0: no answer). Check cable and power.")
    yield "welcome-nothing", start.welcome
    start.show_serial()
    yield "serial-setup", start.serial
    desk.show_setup()
    yield "setup", desk.setup_page
    desk.setup_page.rows["X"].unit.setCurrentIndex(desk.setup_page.rows["X"].unit.findData(Unit.MM))
    desk.setup_page.rows["X"].scale.setText("25.4")
    desk.setup_page.done_button.click()
    yield "setup-scale-changed", desk.setup_page
    answers: list[tuple[str, Callable[[], None]]] = [("Download and execute", lambda: None), ("Run it", lambda: None)]
    desk.ask("Which program?", "The program was changed since it was downloaded.", answers, "warning")
    yield "question", desk.question
    desk.show_upload("#A\nPR 6370\nBG X\nEN\n")
    yield "upload", desk.upload
    desk.show_help("Program window")
    yield "help", desk.help
    yield "crash", CrashDialog("Python 3.11 on Linux\n\nTraceback …\nValueError: example", Path("crash.txt"))
    studio.window.docks["Display"].setFloating(True)
    yield "display-floating", studio.window.docks["Display"]
    studio.window.docks["Display"].setFloating(False)
    studio.desk.arrange("Program")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
