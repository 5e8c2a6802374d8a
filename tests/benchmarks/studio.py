"""A studio that is clicked the moment it is shown, and says when its dialog and its simulator were ready."""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

from PySide6.QtCore import QEvent, QPointF, Qt, QTimer
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QApplication

from app.compose import Studio
from app.connection import connector
from app.settings import Settings
from app.studio import begin
from codegen.generate import code
from codegen.instructions import ALL
from device.api import State
from widgets.form.dialog import InstructionDialog
from widgets.form.preview import Preview

PATIENCE_S = 30.0


def click(studio: Studio) -> None:
    """Double-clicks the first entry of the palette whose instruction writes code as it stands."""
    setup = studio.session.document.working_setup
    kind = next(each for each in ALL if code(each(), setup))
    palette = studio.program.instructions
    tree, item = palette.tree, palette.items[kind.title]
    tree.scrollToItem(item)
    place = QPointF(tree.visualItemRect(item).center())
    for what in (QEvent.Type.MouseButtonPress, QEvent.Type.MouseButtonRelease, QEvent.Type.MouseButtonDblClick):
        held = Qt.MouseButton.NoButton if what is QEvent.Type.MouseButtonRelease else Qt.MouseButton.LeftButton
        target = tree.viewport()
        event = QMouseEvent(
            what,
            place,
            QPointF(target.mapToGlobal(place.toPoint())),
            Qt.MouseButton.LeftButton,
            held,
            Qt.KeyboardModifier.NoModifier,
        )
        QApplication.postEvent(target, event)


def dialog_is_live() -> bool:
    """Whether a dialog with its sentence and code is on the screen."""
    for widget in QApplication.topLevelWidgets():
        if isinstance(widget, InstructionDialog) and widget.isVisible():
            preview = widget.findChild(Preview)
            return bool(preview and preview.sentence.text() and preview.code.text())
    return False


def main(folder: Path) -> int:
    """Shows the studio, clicks, waits; prints the two moments."""
    application = QApplication(sys.argv[:1])
    settings = Settings(folder / "settings.json")
    studio = Studio(application, settings, folder, connector(folder / "programs", lambda: 600.0), list, {})
    studio.window.show()
    studio.tick.start()
    QTimer.singleShot(0, lambda: click(studio))
    QTimer.singleShot(0, lambda: begin(studio, None, "simulator:ssc4"))
    times: dict[str, float] = {}
    began = time.time()

    def look() -> None:
        now = time.time()
        if "dialog" not in times and dialog_is_live():
            times["dialog"] = now
        if "simulator" not in times and studio.connection.controller.state is State.READY:
            times["simulator"] = now
        if len(times) == 2 or now - began > PATIENCE_S:
            application.quit()

    timer = QTimer()
    timer.timeout.connect(look)
    timer.start(1)
    application.exec()
    studio.close()
    print(json.dumps(times), flush=True)
    return 0 if len(times) == 2 else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
