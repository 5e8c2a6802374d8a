"""Handover: the page of author and revision, the pack on paper, and what a controller tells when it is met."""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Callable
from concurrent.futures import Future
from datetime import datetime
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

from app.connection import Connection
from app.session import Session
from app.tick import Tick, failure_of
from codegen.document import Document
from codegen.handover import Handover, stamp_of
from device.api import Controller, Kind, State
from device.identify import fence
from device.proof import proved
from device.tasks import Priority, Steps
from device.wire import Kind as AnswerKind

if TYPE_CHECKING:
    from app.window import Window
    from widgets.backup.handover import HandoverPage
    from widgets.program.printing import PrintPreview
    from widgets.program.view import ProgramView

LINE_S = 1.5


class Handing(QObject):
    """`look` is called with each tick; it reads the first line of a controller once for every connection."""

    said = Signal(str)

    def __init__(
        self,
        connection: Connection,
        session: Session,
        tick: Tick,
        program: ProgramView,
        window: Window,
        proof: Callable[[], tuple[str, ...]],
        now: Callable[[], datetime] = datetime.now,
    ) -> None:
        super().__init__(window)
        self._connection, self._session, self._tick, self._program = connection, session, tick, program
        self._parent, self._proof, self._now = window, proof, now
        self.page: HandoverPage | None = None
        self.preview: PrintPreview | None = None
        self._met: Controller | None = None
        session.document_changed.connect(self._document_changed)

    def show(self) -> None:
        """The page of the open program."""
        from widgets.backup.handover import HandoverPage

        if self.page is None:
            self.page = HandoverPage(f"{self._now():%Y-%m-%d}", self._parent)
            self.page.edited.connect(self._edited)
            self.page.pack_wanted.connect(self.show_pack)
        self.page.show_document(self._session.document)
        self.page.show()
        self.page.raise_()
        self.page.activateWindow()

    def show_pack(self) -> None:
        """The pack as it will be printed."""
        from widgets.program.printing import PrintPreview
        from widgets.program.printing_pack import pack_pages

        document = self._session.document
        pages = pack_pages(document, self._program.words, f"{self._now():%Y-%m-%d}", self._proof())
        revision = f" rev {document.handover.revision}" if document.handover.revision else ""
        name = re.sub(r"[^\w .-]", "_", f"{document.program.name or 'program'}{revision} handover")
        self.preview = PrintPreview("Handover pack", pages, name, self._parent)
        self.preview.setProperty("helpPage", "Handover")
        self.preview.said.connect(self.said)
        self.preview.show()

    def look(self) -> None:
        """Asks a controller that has just been met which program it holds, where its first line says so."""
        controller = self._connection.controller
        if controller is self._met or controller.kind in (Kind.OFFLINE, Kind.REPLAY):
            return
        if controller.state is not State.READY or controller.model is None:
            return
        self._met = controller
        if not controller.resting():
            self._tick.when_done(controller.run(_first_line(controller), Priority.USER, "poll"), self._told)

    def _told(self, future: Future[Any]) -> None:
        stamp = stamp_of(future.result()) if not failure_of(future) else None
        if stamp is None:
            return
        running = bool(self._connection.controller.waiting.position)
        self.said.emit(f"The controller {'runs' if running else 'holds'} {stamp.words}.")

    def _edited(self, handover: Handover) -> None:
        document = dc.replace(self._session.document, handover=handover)
        self._session.set_document(document, "Change handover", "handover")

    def _document_changed(self, _: Document | None, new: Document) -> None:
        if self.page is not None:
            self.page.show_document(new)


def _first_line(c: Controller) -> Steps[str]:
    """Line 0 of the program, which nothing needs to be stopped for; empty where there is none."""
    answer = yield from proved(c.nonces, "LS 0,0", LINE_S, 0.05, r"\s*0{1,3} .*")
    if answer.kind is not AnswerKind.ACCEPTED or "\n" in answer.text:
        yield from fence(c.nonces)
        return ""
    return re.sub(r"^\s*\d{1,3} ", "", answer.text.strip())
