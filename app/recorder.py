"""The recorder of the studio: notes what is connected and what is done, opens recordings and plays them."""

from __future__ import annotations

import time
import zipfile
from collections.abc import Callable
from concurrent.futures import Future
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, TypeVar

from PySide6.QtCore import QObject, Signal

from app.background import in_background
from app.connection import Connection, Opened
from app.deeds import Deeds
from app.tick import Tick
from codegen.disk import FileUnreadable, save_bytes
from device.api import Controller, Kind
from device.recorder import MOST_BYTES, SUFFIX, Recorder
from device.recorder_play import CAPTURE, CONTROLLER, DID, LISTING, NOTICE, TUNING, Player, facts_of, replayed
from device.recorder_read import DAMAGE, Recording, RecordingUnreadable, joined, open_recording
from widgets.panel import Panel
from widgets.parts.files import ask_open, ask_save
from widgets.recorder.panel import Happening, RecorderPanel

if TYPE_CHECKING:
    from app.compose import Studio
    from device.api import Notice

T = TypeVar("T")
FILES = f"Recordings and bundles (*{SUFFIX} *.zip)"
SAVED = f"Recordings (*{SUFFIX})"
LOOK_TICKS = 60  # between two looks at how much is kept, about two seconds
WHO = {DID: "You", NOTICE: "Machine", CAPTURE: "Scope", TUNING: "Tuner"}
OWN = "what was recorded here"


class Ear(Panel):
    """Gets notices like every panel; shows nothing itself."""

    def __init__(self, recorder: Recorder) -> None:
        super().__init__()
        self._recorder = recorder
        self.hide()

    def notice(self, notice: Notice) -> None:
        if self.controller is not None and self.controller.kind is not Kind.REPLAY:
            self._recorder.note(NOTICE, {"kind": str(notice.kind), "text": notice.text})


class Recorded(QObject):
    """Owns the replay: `player` is the hand on it, None while nothing is played."""

    said = Signal(str)
    capture_wanted = Signal(bytes)  # one of the recording is to be shown

    def __init__(self, studio: Studio, recorder: Recorder, panel: RecorderPanel, folder: Callable[[], Path]) -> None:
        super().__init__(studio)
        self._connection: Connection = studio.connection
        self._careful, self._window = studio.leaving.careful, studio.window
        self._ask, self._files = studio.desk.ask, studio.files
        self._recorder, self._panel, self._folder = recorder, panel, folder
        self._clock = studio.clock
        self._threaded = True
        self._deeds = Deeds(studio, lambda words: recorder.note(DID, words))
        self.ear = Ear(recorder)
        self.player: Player | None = None
        self.recording: Recording | None = None
        self._told: object = None
        self._listing: str | None = None
        self._tick, self._working = studio.tick, False
        self._ticks = 0
        self._problem = ""
        self._join(studio.tick)

    # ------------------------------------------------------------ with each tick

    def once(self) -> None:
        """Notes what has changed; shows where the replay is."""
        self._note_controller(self._connection.controller)
        self._deeds.look()
        if self._recorder.problem != self._problem:  # said once, wherever the person looks
            self._problem = self._recorder.problem
            self.said.emit(self._problem or "The recorder records again.")
        if self._panel.isVisible():
            self._show()
        self._ticks += 1

    def _note_controller(self, controller: Controller) -> None:
        if controller.kind is Kind.REPLAY:
            return
        facts = facts_of(controller, self._connection.channel, self._connection.address)
        if facts != self._told:
            self._told = facts
            self._recorder.stand(CONTROLLER, facts)
        if controller.listing != self._listing:
            self._listing = controller.listing
            self._recorder.stand(LISTING, self._listing or "")

    def _show(self) -> None:
        player, recording = self.player, self.recording
        if player is not None and recording is not None:
            self._panel.show_place(
                player.place, recording.at(player.place), player.length, player.playing, player.speed
            )
        elif self._ticks % LOOK_TICKS == 0:
            self._panel.show_recorded(*self._kept())

    def _kept(self) -> tuple[str, str]:
        """How much there is, and what is wrong."""
        files = self._recorder.files()
        if not files:
            return "", self._recorder.problem
        try:
            size = sum(path.stat().st_size for path in files)
        except OSError:  # one went meanwhile
            size = 0
        began = self._recorder.since()
        since = time.strftime(", since %d %b %H:%M", time.localtime(began)) if began is not None else ""
        words = f"Recording, always on: {size / 1e6:.1f} MB of {MOST_BYTES / 1e6:.0f} MB{since}."
        return words, self._recorder.problem

    # ---------------------------------------------------------------- the replay

    def ask_open(self) -> None:
        """Which recording or bundle."""
        ask_open(self._window, "Open recording or bundle", FILES, self.open_path, self._folder())

    def open_path(self, path: Path) -> None:
        """Reads it beside the window's thread, then plays it."""
        self._work(lambda: self._opened(path), _go_on, self._tick.when_done)

    def replay_own(self) -> None:
        """What this computer has recorded up to now."""
        self._work(self._opened_own, _go_on, self._tick.when_done)

    def ask_save(self) -> None:
        """Where everything that is kept is to go."""
        name = f"recording-{time.strftime('%Y-%m-%d-%H%M')}{SUFFIX}"
        ask_save(self._window, "Save recording", SAVED, self.save, self._folder() / name, SUFFIX.removeprefix("."))

    def save(self, path: Path) -> None:
        """Everything that is kept, as one file."""
        self._work(lambda: save_bytes(path, self.kept()), partial(self._saved, path), self._tick.when_written)

    def kept(self) -> bytes:
        """The same as bytes, for a service bundle (beside the window's thread)."""
        self._recorder.flush()
        return joined(self._recorder.files())

    def seek(self, place: float) -> None:
        """Plays on from another place: as if it had been opened there."""
        if self.recording is None or self.player is None:
            return
        before = self.player
        self._play(self.recording, place)
        self.player.set_speed(before.speed)
        self.player.play(before.playing or before.place >= before.length)

    def _show_capture(self, place: float) -> None:
        notes = self.recording.notes if self.recording is not None else ()
        for note in notes:
            if note.kind == CAPTURE and note.place == place and isinstance(note.payload, bytes):
                self.capture_wanted.emit(note.payload)

    def _opened(self, path: Path) -> Callable[[], None]:
        try:
            recording = open_recording(path)
            program = _program_in(path)
        except RecordingUnreadable as reason:
            words = str(reason)
            return lambda: self._refuse(words)
        happenings = _happenings(recording)
        return lambda: self._begin(recording, happenings, program)

    def _opened_own(self) -> Callable[[], None]:
        recording = Recording(self.kept(), OWN)
        if not recording.length:
            return lambda: self._refuse("Nothing was recorded yet: connect a controller or the simulator first.")
        happenings = _happenings(recording)
        return lambda: self._begin(recording, happenings, "")

    def _saved(self, path: Path, future: Future[None]) -> None:
        reason = future.exception()
        if isinstance(reason, OSError):
            self.said.emit(f"The recording was not saved: {reason.strerror or reason} ({path})")
            return
        future.result()
        self.said.emit(f"Recording saved: {path}")

    def _work(
        self,
        what: Callable[[], T],
        then: Callable[[Future[T]], None],
        tell: Callable[[Future[T], Callable[[Future[T]], None]], None],
    ) -> None:
        """One thing at a time beside the window."""
        if self._working:
            self.said.emit("A recording is being read or written; a moment please.")
            return

        def done(future: Future[T]) -> None:
            self._working = False
            then(future)

        self._working = True
        tell(in_background(what), done)

    def _refuse(self, words: str) -> None:
        self.said.emit(words)
        if self.player is None:
            self._panel.show_recorded(self._kept()[0], words)

    def _begin(self, recording: Recording, happenings: list[Happening], program: str) -> None:
        self._careful("Replay a recording?", lambda: self._show_replay(recording, happenings, program))

    def _show_replay(self, recording: Recording, happenings: list[Happening], program: str) -> None:
        self._play(recording, 0.0)
        self._panel.show_recording(recording.name, recording.length, happenings, recording.problem)
        self.said.emit(recording.problem or f"Replay of {recording.name}: nothing can be sent.")
        if program:
            words = "The bundle holds the program that was open, with its setup: units and names of what is replayed."
            open_it = partial(self._files.careful, "Open the program of the bundle?", partial(self._open, program))
            self._ask("Open the program of the bundle too?", words, [("Open the program", open_it)])

    def _open(self, program: str) -> None:
        """A copy without a file of its own."""
        with TemporaryDirectory() as folder:
            path = Path(folder) / "program of the bundle.tlp"
            path.write_text(program, encoding="utf-8")
            self._files.open_copy(path)

    def _play(self, recording: Recording, place: float) -> None:
        controller, player = replayed(recording, place, clock=self._clock, threaded=self._threaded)
        self.player, self.recording = player, recording
        self._connection.adopt(Opened(controller), f"recording {recording.name}")

    def _exchanged(self, controller: Controller) -> None:
        """Something else is connected: the replay is over."""
        if controller.kind is not Kind.REPLAY and self.player is not None:
            self.player = self.recording = None
            self._panel.show_recorded(*self._kept())

    def _join(self, tick: Tick) -> None:
        panel = self._panel
        panel.open_wanted.connect(self.ask_open)
        panel.save_wanted.connect(self.ask_save)
        panel.replay_wanted.connect(self.replay_own)
        panel.leave_wanted.connect(self._connection.go_offline)
        panel.play_wanted.connect(self._pause)
        panel.speed_wanted.connect(lambda speed: self.player is not None and self.player.set_speed(speed))
        panel.place_wanted.connect(self.seek)
        panel.capture_wanted.connect(self._show_capture)
        self._connection.changed.connect(self._exchanged)
        tick.each(self.once)

    def _pause(self, on: bool) -> None:
        """At the end, Play begins again."""
        if self.player is None:
            return
        if on and self.player.place >= self.player.length:
            self.seek(0.0)
        elif self.player is not None:
            self.player.play(on)


def _go_on(future: Future[Callable[[], None]]) -> None:
    """What was read is shown."""
    future.result()()


def _happenings(recording: Recording) -> list[Happening]:
    """What the list tells (beside the window's thread: captures are looked into)."""
    found = []
    for note in recording.notes:
        capture = note.kind == CAPTURE and isinstance(note.payload, bytes)
        text = _capture_words(note.payload) if capture else _text(note.payload)
        if note.kind in WHO and text:
            found.append(Happening(note.place, note.at, WHO[note.kind], text, capture))
    return found


def _capture_words(data: Any) -> str:
    from device.capture_file import unpacked

    try:
        capture = unpacked(data)
    except FileUnreadable as reason:
        return f"A capture that cannot be read: {reason}."
    labels = ", ".join(channel.label for channel in capture.channels)
    return f"Captured {labels}: {capture.count} values a channel, {capture.trigger_text}."


def _text(payload: Any) -> str:
    """What a note says; of a tuning run its result."""
    if not isinstance(payload, dict):
        return str(payload)
    return str(payload.get("text") or payload.get("words") or "")


def _program_in(path: Path) -> str:
    """The program of a service bundle."""
    if not zipfile.is_zipfile(path):
        return ""
    try:
        with zipfile.ZipFile(path) as bundle:
            return bundle.read("program.tlp").decode("utf-8")
    except (KeyError, OSError, ValueError, *DAMAGE):
        return ""
