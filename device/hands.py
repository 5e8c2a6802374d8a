"""What a person does with a controller besides asking and moving: programs and outputs."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from typing import TYPE_CHECKING

from device import commands
from device.asking import Listing
from device.commands import Reply
from device.download import Download, Downloaded, DownloadFailed, Job, held_program, program_lines, recover
from device.happenings import Badge, NoticeKind
from device.moving import refused
from device.tasks import LinkError, NotAllowed, Priority, Steps, Stopped

if TYPE_CHECKING:
    from device.api import Controller


class Memory:
    """Programs in and out, started and ended, and what survives switching off."""

    def __init__(self, controller: Controller) -> None:
        self._c = controller
        self.listing: str | None = None  # what the controller is known to hold
        self._held: list[str] = []  # its lines
        self._document: str | None = None
        self._shown: list[str] = []  # the lines of the document

    def set_listing(self, listing: str | None) -> None:
        """What the controller is known to hold (on the link's thread)."""
        self._held = program_lines(listing or "")
        self.listing = listing
        self._c.waiting.listing = Listing(listing) if listing is not None else None

    def show_listing(self, text: str) -> None:
        """The code of the document now."""
        if text != self._document:
            self._document, self._shown = text, program_lines(text)

    @property
    def badge(self) -> Badge:
        """How what the controller holds and the document stand to each other."""
        if self.listing is None or self._c.doubt:
            return Badge.UNKNOWN
        if self._document is None:
            return Badge.CHANGED
        return Badge.SAME if self._shown == self._held else Badge.CHANGED

    def execute(self, label: str | None, thread: int, anyway: bool) -> Future[Reply]:
        """Starts the verified program at a label; `anyway` runs what is in the controller."""
        if self.badge is not Badge.SAME and not anyway:
            changed = self.badge is Badge.CHANGED
            words = "has changed since the download" if changed else "in the controller is unknown"
            return refused(f"Not started: the program {words}. Download it, or run what is in the controller.")
        target = "" if label is None else (label if label.startswith("#") else f"#{label}")
        command = f"XQ {target}" + (f",{thread}" if thread or target else "") if target else "XQ"
        return self._c.ask(command)

    def halt(self) -> Future[Reply]:
        """Ends all programs, then all motion; as STOP does where a line could become an answer."""
        c = self._c
        if not c.resting():
            return c.run(commands.halt(c), Priority.USER, "user")
        halted: Future[Reply] = Future()
        c.stop(lambda still: halted.set_result(Reply("", still, still, 0, "" if still else "Not confirmed.")))
        return halted

    def download(
        self, listing: str, progress: Callable[[Job[Downloaded]], None] | None = None, old: str | None = None
    ) -> Job[Downloaded]:
        job: Job[Downloaded] = Job(progress)
        c = self._c
        download = Download(
            listing, job, model=c.model, line=c.line, nonces=c.nonces, clock=c.clock, folder=c.program_folder, old=old
        )
        job.future = c.run(self.downloading(download), Priority.DOWNLOAD, "download")
        return job

    def downloading(self, download: Download) -> Steps[Downloaded]:
        """The steps of a download, as part of a longer task as well."""
        c = self._c
        c.motion.let_go()
        if not c.control:
            raise NotAllowed("Not downloaded: this is Watch. Switch to Control first.")
        c.motion.unclaimed("Not downloaded")
        if c.resting() and not c.waiting.unfinished:
            raise DownloadFailed("Not downloaded: a program is running. Halt it first.")
        try:
            done = yield from download.steps()
        except LinkError as reason:
            if download.touched:
                c.set_listing(None)
            if download.unfinished and not isinstance(reason.__cause__, Stopped) and not isinstance(reason, NotAllowed):
                c.waiting.unfinished = True
                c.link.submit(recover(c.waiting, c.nonces), Priority.USER, "download")
            c.notify(NoticeKind.DOWNLOAD, str(reason))
            raise
        c.set_listing(download.text)
        c.notify(NoticeKind.DOWNLOAD, done.sentence)
        return done

    def upload(self, progress: Callable[[Job[str]], None] | None = None) -> Job[str]:
        job: Job[str] = Job(progress)
        job.future = self._c.run(self._uploading(job), Priority.DOWNLOAD, "download")
        return job

    def _uploading(self, job: Job[str]) -> Steps[str]:
        if self._c.resting():
            raise NotAllowed(f"Not read: {self._c.resting()}")
        text = yield from held_program(self._c.waiting, self._c.nonces, job)
        self._c.set_listing(text)
        return text

    def burn_program(self) -> Future[Reply]:
        """BP: up to 10 s; not while anything runs or moves."""
        return self._c.run(commands.by_hand(self._c, "BP", 15.0), Priority.USER, "user")

    def burn_parameters(self) -> Future[Reply]:
        return self._c.run(commands.by_hand(self._c, "BN", 3.0), Priority.USER, "user")

    def burn_variables(self) -> Future[Reply]:
        return self._c.run(commands.by_hand(self._c, "BV", 5.0), Priority.USER, "user")


class Io:
    """Outputs by hand."""

    def __init__(self, controller: Controller) -> None:
        self._c = controller

    def set_output(self, number: int, on: bool) -> Future[Reply]:
        """Switches one output; needs Control and I/O control."""
        if not self._c.io_control:
            return refused("Not sent: switch I/O control on to set outputs by hand.")
        return self._c.ask(f"{'SB' if on else 'CB'} {number}")

    def set_outputs(self, byte: int) -> Future[Reply]:
        """Switches all outputs at once, output 1 is the lowest bit; needs Control and I/O control."""
        if not self._c.io_control:
            return refused("Not sent: switch I/O control on to set outputs by hand.")
        return self._c.ask(f"OP {byte}")
