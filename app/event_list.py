"""Events: heard with every tick, kept on disk, and given away with everything a service needs in one file."""

from __future__ import annotations

import json
import platform
import time
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import asdict
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QBuffer, QIODevice, QObject, Signal, qVersion
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QWidget

from app.about import version
from app.background import in_background
from app.connection import Connection
from app.session import Session
from app.tick import Tick
from codegen.disk import save_bytes
from codegen.files import dumps, setup_dumps
from device.api import EventList, Kind
from device.events import EventFile
from device.events_heard import EventsHeard
from device.recorder_read import IN_BUNDLE
from widgets.events.panel import EventsPanel
from widgets.panel import Panel
from widgets.parts.files import ask_save

if TYPE_CHECKING:
    from device.api import Controller, Notice

BUNDLES = "Service bundles (*.zip)"
READ_ME = """What is in here, for whoever helps:

events.json    what happened, newest last; places are counts, times seconds since 1970
traffic.txt    the lines that went over the wire last
program.tlp    the open program with its setup; code.dmc is what it compiles to
setup.tls      the setup alone
controller.dmc the program that was last read from the controller, where it is known
versions.txt   versions, operating system, controller
window.png     the window as it was
recording.tape the last hours: all bytes of the line, what was done; File > Open recording or bundle plays it
back-up.tlb    the newest back-up of this controller, where there is one
"""


class Ear(Panel):
    """Gets notices like every panel; shows nothing itself."""

    def __init__(self, heard: EventsHeard) -> None:
        super().__init__()
        self._heard = heard
        self.hide()

    def take(self, controller: Controller) -> None:
        super().take(controller)
        self._heard.begin(controller)

    def notice(self, notice: Notice) -> None:
        if self.controller is not None and self.controller.kind is not Kind.REPLAY:
            self._heard.happened(self.controller, notice)

    def look(self) -> None:
        """With each tick."""
        if self.controller is not None and self.controller.kind in (Kind.MACHINE, Kind.SIMULATOR):
            self._heard.look(self.controller)


class Happened(QObject):
    """Joins the list, its file, the panel and the bundle."""

    said = Signal(str)

    def __init__(
        self,
        connection: Connection,
        session: Session,
        tick: Tick,
        panel: EventsPanel,
        data: Path,
        window: QWidget,
    ) -> None:
        super().__init__(window)
        self._connection, self._session, self._window = connection, session, window
        self._data = data
        self.recording: Callable[[], bytes] = lambda: b""  # everything that is recorded
        self.events = EventList(EventFile(data / "events.jsonl"))
        self.ear = Ear(EventsHeard(self.events))
        self._tick = tick
        panel.show_events(self.events)
        panel.bundle_wanted.connect(self.ask_bundle)
        tick.each(self.once)

    def once(self) -> None:
        """With every tick."""
        self.ear.look()

    def ask_bundle(self) -> None:
        """Where the bundle is to go."""
        name = f"service-{time.strftime('%Y-%m-%d-%H%M')}.zip"
        ask_save(self._window, "Save service bundle", BUNDLES, self.save_bundle, Path.home() / name, "zip")

    def save_bundle(self, path: Path) -> None:
        """Gathers here, writes beside the window's thread."""
        from app.backup_before import FOLDER, folder_of

        parts, folder = self.parts(), folder_of(self._data / FOLDER, self._connection.controller)
        picture = self._window.grab().toImage()
        written = in_background(partial(self._write, path, parts, picture, folder))
        self._tick.when_written(written, partial(self._written, path))

    def _written(self, path: Path, future: Future[None]) -> None:
        failure = future.exception()
        if isinstance(failure, OSError):
            self.said.emit(f"The service bundle was not saved: {failure.strerror or failure} ({path})")
            return
        future.result()
        self.said.emit(f"Service bundle saved: {path}")

    def parts(self) -> dict[str, bytes]:
        """Every part of the bundle that is text, by its name."""
        controller, document = self._connection.controller, self._session.document
        traffic = "\n".join(
            f"{line.number} {line.direction} {line.source} {line.text}" for line in controller.traffic()
        )
        found = {
            "read-me.txt": READ_ME,
            "events.json": json.dumps([asdict(event) for event in self.events.all()], ensure_ascii=False, indent=1),
            "traffic.txt": traffic + "\n",
            "program.tlp": dumps(document),
            "code.dmc": self._session.listing.text + "\n",
            "setup.tls": setup_dumps(document.setup),
            "versions.txt": self._versions(controller),
        }
        if controller.listing is not None:
            found["controller.dmc"] = controller.listing + "\n"
        return {name: text.encode() for name, text in found.items()}

    def _versions(self, controller: Controller) -> str:
        identity = controller.identity
        facts: Mapping[str, str] = {
            "Twoletter Studio": version(),
            "Python": platform.python_version(),
            "Qt": qVersion(),
            "System": platform.platform(),
            "Connected to": f"{controller.kind.value} {self._connection.address}".strip(),
            "Controller": identity.text if identity is not None else "not known",
            "Serial number": str(identity.serial) if identity is not None and identity.serial else "not known",
            "Line": str(controller.line),
        }
        return "".join(f"{name}: {text}\n" for name, text in facts.items())

    def _write(self, path: Path, parts: Mapping[str, bytes], picture: QImage, folder: Path | None) -> None:
        from device.backup_kept import kept

        newest = next(iter(kept(folder)), None) if folder is not None else None
        backup = newest.path if newest is not None else None
        save_bytes(path, zipped({**parts, "window.png": _png(picture), IN_BUNDLE: self.recording()}, backup))


def zipped(parts: Mapping[str, bytes], backup: Path | None) -> bytes:
    """The parts as one file; a back-up that cannot be read any more is left out."""
    import zipfile

    whole = BytesIO()
    with zipfile.ZipFile(whole, "w", zipfile.ZIP_DEFLATED) as file:
        for name, data in parts.items():
            file.writestr(name, data)
        if backup is not None and backup.is_file():
            file.write(backup, "back-up.tlb")
    return whole.getvalue()


def _png(picture: QImage) -> bytes:
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    picture.save(buffer, "PNG")  # type: ignore[call-overload]
    return bytes(buffer.data().data())
