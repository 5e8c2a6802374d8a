"""The scope's hands: captures on the controller, the live roll, files; every refusal is a sentence in the panel."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, QSize, QTimer, Signal
from PySide6.QtWidgets import QDockWidget

from app.background import in_background
from app.connection import Connection
from app.session import Session
from app.settings import Settings
from app.tick import Tick, failure_of
from codegen.disk import FileUnreadable
from device.api import Controller, Kind
from widgets.parts.files import ask_open, ask_save
from widgets.scope.panel import ScopePanel

if TYPE_CHECKING:
    from concurrent.futures import Future

    from PySide6.QtWidgets import QWidget

    from device.capture import Capture, Channel, Plan
    from device.capturing import CaptureJob
    from device.roll import Roll
    from widgets.scope.body import Body

OWNER = "scope"  # of what is watched live
CHOSEN = "scope"  # the setting
SETTLE_MS = 500  # typing a number is one change of the settings
CAPTURES = "Captures (*.csv *.npz)"
PARTLY_S = 0.4  # between two pictures of a capture under way
ROOM = QSize(1180, 720)  # of the window of its own
WORTH_S = 5.0  # a channel that was watched so long is kept when another takes its place
KEPT = 200  # captures that are kept in files by themselves; the oldest go


class Scope(QObject):
    """One capture at a time; what was captured is also kept in a file at once."""

    said = Signal(str)

    def __init__(
        self,
        connection: Connection,
        session: Session,
        tick: Tick,
        panel: ScopePanel,
        folder: Path,
        clock: Callable[[], float],
        window: QWidget,
        settings: Settings,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._connection, self._session, self._tick = connection, session, tick
        self._panel, self._folder, self._clock, self._window = panel, folder, clock, window
        self._settings, self._settling = settings, QTimer(self)
        self._settling.setSingleShot(True)
        self._settling.setInterval(SETTLE_MS)
        self._settling.timeout.connect(self.remember)
        self.job: CaptureJob | None = None
        self.roll: Roll | None = None
        self.note: Callable[[str, bytes], None] = lambda kind, what: None  # to the recorder
        self._watched: Controller | None = None
        self._rolled: Sequence[Channel] = ()  # what is watched of it
        self._drawn_at = 0.0
        self._read, self._placed = 0, False
        panel.opened.connect(self._opened)
        connection.changed.connect(self._attach)
        tick.each(self.look)

    def bring(self, dock: QDockWidget) -> None:
        """In front; the first time in a window of its own, because curves want room."""
        if not self._placed and not dock.isFloating() and dock.height() < ROOM.height():
            dock.setFloating(True)
            dock.resize(ROOM.boundedTo(self._window.screen().availableSize() * 0.95))
        self._placed = True

    @property
    def _body(self) -> Body:
        assert self._panel.body is not None
        return self._panel.body

    def _opened(self) -> None:
        body = self._body
        body.capture_wanted.connect(self.capture)
        body.finish_wanted.connect(lambda: self.job and self.job.finish())
        body.cancel_wanted.connect(lambda: self.job and self.job.cancel())
        body.live_wanted.connect(self.live)
        body.save_wanted.connect(self._save)
        body.open_wanted.connect(self._open)
        body.restore(self._settings.get(CHOSEN))
        body.chosen.connect(self._settling.start)

    def remember(self) -> None:
        """What was chosen, for the next start."""
        self._settling.stop()
        if self._panel.body is not None:
            self._settings.set(CHOSEN, self._panel.body.state())

    # ------------------------------------------------------------------ a capture

    def capture(self, plan: Plan) -> None:
        """Begins one; the panel shows how it goes."""
        from device.capturing import capture

        if self.job is not None:
            return
        controller = self._connection.controller
        controller.used()
        job = self.job = capture(controller, plan, setup=self._session.document.working_setup)
        self._read = 0
        self._body.show_progress(job.phase, 0.0, job.remaining_s)
        self._tick.when_done(job.future, partial(self._done, job))

    def _done(self, job: CaptureJob, future: Future[Any]) -> None:
        if job is not self.job:
            return
        self.job = None
        failure, part = failure_of(future), job.partial()
        capture: Capture | None = part if failure else future.result()
        if capture is not None:
            name = self._keep(capture)
            self._body.add(capture)
            self.note("capture", self._packed(name, capture))
            words = (
                f"{capture.count} values a channel" + ("" if capture.complete else ", a part") + f"; kept as {name}."
            ) + (f" {capture.note}" if capture.note else "")
            self._body.show_result(failure or words, good=not failure)
        else:
            self._body.show_result(failure, good=False)
        if failure:
            self.said.emit(failure)

    def look(self) -> None:
        """With each tick: how far a capture is, and what is new in the live roll."""
        if self.job is not None and self._panel.in_sight:
            job, now = self.job, self._clock()
            self._body.show_progress(job.phase, job.fraction, job.remaining_s)
            if now - self._drawn_at >= PARTLY_S:
                self._drawn_at = now
                part = job.partial()
                if part is not None and part.count != self._read:
                    self._read = part.count
                    self._body.show_partial(part)
        roll, controller = self.roll, self._connection.controller
        if roll is not None and roll.take(controller.poller.ring) and self._panel.in_sight:
            self._body.roll_on(self._clock())

    # -------------------------------------------------------------------- live

    def live(self, on: bool) -> None:
        """The chosen channels continuously, as fast as the line carries; or no longer, then they are kept."""
        from device.roll import Roll

        controller, body = self._connection.controller, self._body
        keys = [channel.live_key for channel in body.live_channels]
        goes_on, former, channels = self.roll if self._watched is controller else None, self._watched, self._rolled
        if self._watched is not None:
            self._watched.hurry(False)
            self._watched.watch(OWNER, ())
            self._watched = None
        before, self.roll = self.roll, None
        if on and keys and controller.kind is not Kind.OFFLINE:
            self.roll = Roll(keys, before=goes_on)
            self._watched, self._rolled = controller, body.live_channels
            controller.watch(OWNER, keys, each_round=keys)
            controller.hurry(True)
        if before is not None and former is not None:
            self._keep_roll(before, [each for each in channels if self._ends(before, each)], former)
        body.show_roll(self.roll)
        without = [channel.label for channel in body.choices.channels if not channel.live_key]
        if on and not keys:
            body.show_result("Choose a channel that can be watched first.", good=False)
        elif on and without:
            body.show_result(f"Live without {' and '.join(without)}: the controller tells it only in captures.")

    def _ends(self, before: Roll, channel: Channel) -> bool:
        """Whether nothing comes to it any more; what was only passed over in a list is not worth keeping."""
        if self.roll is None:
            return True
        return channel.live_key not in self.roll.tracks and before.tracks[channel.live_key].lasts_s >= WORTH_S

    def _keep_roll(self, roll: Roll, channels: Sequence[Channel], controller: Controller) -> None:
        """What was seen live stays in the list, to be looked at, laid over and saved."""
        from device.curves import curves

        if not channels:
            return
        told, derived = self._told(controller), self._body.choices.shown

        made: list[Capture] = []

        def work() -> str:
            made.append(replace(roll.capture(channels, -math.inf, math.inf), **told))
            curves(made[0], derived)  # known by the time they are drawn
            return self._filed(made[0], " live") if made[0].count > 1 else ""

        self._tick.when_written(in_background(work), partial(self._kept_roll, made))

    def _kept_roll(self, made: list[Capture], future: Future[str]) -> None:
        failure = future.exception()
        if isinstance(failure, OSError):
            name = _no_file(failure)
            self.said.emit(f"What was seen live is in {name}.")
        else:
            name = future.result()
        if made[0].count > 1:
            self._body.add(made[0], f"Live {made[0].when[11:]}", show=self.roll is None)
            if self.roll is None and self.job is None:
                words = f"{made[0].count} values seen live; kept as {name}."
                self._body.show_result(words, good=failure is None)

    def end(self) -> None:
        """The window is about to close: what was chosen last and what is seen live are kept."""
        if self.roll is not None:
            self.live(False)
        if self._settling.isActive():
            self.remember()

    def _told(self, controller: Controller) -> dict[str, Any]:
        """Where a stretch of the roll comes from."""
        return {
            "model": controller.model.name if controller.model is not None else "",
            "controller": controller.who,
            "when": datetime.now().isoformat(sep=" ", timespec="seconds"),
            "setup": self._session.document.working_setup,
        }

    def _attach(self, controller: Controller) -> None:
        """Another controller: nothing of the former goes on."""
        if self._panel.body is not None and self.roll is not None:
            self.live(False)

    # -------------------------------------------------------------------- files

    def _keep(self, capture: Capture) -> str:
        """Every capture goes into a file, so that none is lost; the name of the file, or why there is none."""
        try:
            return self._filed(capture)
        except OSError as reason:
            return _no_file(reason)

    def _filed(self, capture: Capture, sort: str = "") -> str:
        """The name of its file; raises OSError."""
        from device.capture_file import save

        stem = (capture.when.replace(":", ".") or "capture") + sort
        path = self._folder / f"{stem}.npz"
        number = 1
        while path.exists():
            number += 1
            path = self._folder / f"{stem} ({number}).npz"
        self._folder.mkdir(parents=True, exist_ok=True)
        save(path, capture)
        for old in sorted(self._folder.glob("*.npz"))[:-KEPT]:
            old.unlink(missing_ok=True)
        return path.name

    def _packed(self, name: str, capture: Capture) -> bytes:
        """The file that was just kept, or what would have been in it."""
        from device.capture_file import packed

        try:
            return (self._folder / name).read_bytes()
        except OSError:
            return packed(capture)

    def show_recorded(self, data: bytes) -> None:
        """A capture out of a recording."""
        from device.capture_file import unpacked

        self._panel.making.finish()
        try:
            capture = unpacked(data)
        except FileUnreadable as reason:
            self._body.show_result(f"The recorded capture cannot be shown: {reason}.", good=False)
            return
        self._body.add(capture, f"Recorded {capture.when[11:]}")
        self._body.show_result(f"Of the recording: {capture.count} values a channel, captured {capture.when}.")

    def _save(self, capture: Capture) -> None:
        if capture.moments is not None and not capture.when:
            capture = replace(capture, **self._told(self._connection.controller))
        stem = capture.when.replace(":", ".") or "capture"
        proposed = Path.home() / f"{stem}.csv"
        ask_save(self._window, "Save capture", CAPTURES, partial(self.save, capture), proposed, "csv")

    def save(self, capture: Capture, path: Path) -> None:
        """In a thread of its own: an hour of live values is a large text."""
        from device.capture_file import save

        self._body.show_result(f"{path.name} is being written.")
        self._tick.when_written(in_background(partial(save, path, capture)), partial(self._saved, path))

    def _saved(self, path: Path, future: Future[Any]) -> None:
        failure = future.exception()
        if isinstance(failure, OSError):
            why = (failure.strerror or str(failure)).lower()
            self._body.show_result(f"Not saved: {path.name}: {why}.", good=False)
        elif failure is not None:
            raise failure
        else:
            self._body.show_result(f"Saved as {path.name}.")

    def _open(self) -> None:
        folder = self._folder if self._folder.is_dir() else None
        ask_open(self._window, "Open capture", CAPTURES, self.open, folder)

    def open(self, path: Path) -> None:
        """An earlier capture is shown; of a file that is none, one sentence says why. It is read beside the window."""
        from device.capture_file import load
        from device.curves import curves

        derived = self._body.choices.shown

        def read() -> Capture:
            found = load(path)
            curves(found, derived)  # known by the time they are drawn
            return found

        self._tick.when_done(in_background(read), partial(self._opened_file, path))

    def _opened_file(self, path: Path, future: Future[Any]) -> None:
        failure = future.exception()
        if isinstance(failure, FileUnreadable):
            self._body.show_result(f"{failure}.", good=False)
            return
        capture: Capture = future.result()
        self._body.add(capture, path.name)
        self._body.show_result(f"{path.name}: {capture.count} values a channel.")


def _no_file(reason: OSError) -> str:
    return f"no file ({(reason.strerror or str(reason)).lower()})"
