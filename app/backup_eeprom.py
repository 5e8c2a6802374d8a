"""What is known of the EEPROM: what this studio burned, by serial number; everything else is unknown."""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Callable
from concurrent.futures import Future
from datetime import datetime
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, Signal

from app.backup_before import FOLDER, folder_of
from app.connection import Connection
from app.follow import kept_lines, sentences_of
from app.run import Run
from app.session import Session
from codegen.difference import Line, Lines
from codegen.difference_report import Burned
from codegen.document import Document
from codegen.generate import Listing, generate
from codegen.twoletter import nodes
from codegen.twoletter.parse import parse, parse_line
from device.api import Badge, Controller, Job, Kind, State
from device.backing_up import backup_steps
from device.backup import Backup
from device.backup_burned import keyed, load_burned, save_burned
from device.download import program_lines
from device.tasks import Priority

ERASE = re.compile(r"\x13|\^R\^S", re.IGNORECASE)


class Eeprom(QObject):
    """`known` is what was burned from here, as far as nothing since makes it doubtful."""

    said = Signal(str)

    def __init__(
        self,
        connection: Connection,
        run: Run,
        session: Session,
        folder: Path,
        now: Callable[[], datetime],
        parent: QObject,
    ) -> None:
        super().__init__(parent)
        self._connection, self._run, self._session, self._now = connection, run, session, now
        self._root = folder / FOLDER
        self.known = Burned()
        self.sent: Lines = ()  # the program that was downloaded last, with its words
        self._who: object = None
        self._burning: frozenset[str] = frozenset()  # typed, not answered yet
        self._to_read: frozenset[str] = frozenset()  # burned, and not known which values
        self._heard = 0
        self._judged: tuple[tuple[object, ...], bool | None] | None = None
        run.downloaded.connect(lambda listing: self._downloaded(listing))
        run.burned.connect(self.burned)

    def look(self) -> None:
        """With each tick: who is connected, and what was typed that changes the EEPROM."""
        controller = self._connection.controller
        who = (controller, controller.identity, controller.model)
        if who != self._who:
            self._who, self._heard = who, 0
            self._burning = self._to_read = frozenset()
            folder = self._folder(controller)
            self.known = load_burned(folder) if folder is not None else Burned()
        for entry in controller.traffic(self._heard):
            self._heard = entry.number
            if entry.source == "user" and entry.direction == ">":
                self._hear(entry.text)
            elif entry.source == "user" and self._burning:
                if not entry.text.lstrip().startswith("?"):
                    self._to_read |= self._burning
                self._burning = frozenset()
        if self._to_read and not self._run.doing and controller.state is State.READY and not controller.resting():
            self._read(controller)

    def burned(self) -> None:
        """The program in the controller is burned."""
        controller = self._connection.controller
        if controller.listing is None:
            self._keep(dc.replace(self.known, program=None, name="", program_when=""))
            return
        lines = self.told(controller.listing)
        name = self._run.held().sent
        when = f"{self._now():%Y-%m-%d %H:%M}"
        label = next(
            (line.text[1:] for line in lines if line.text.startswith("#") and line.text != "#AUTO"), "a program"
        )
        self._keep(dc.replace(self.known, program=lines, name=name.name if name else label, program_when=when))

    def told(self, listing: str) -> Lines:
        """A program of the controller with the words known of its lines: the file's, or the last download's."""
        texts = program_lines(listing)
        if self._connection.controller.program_badge is Badge.SAME:
            return lines_of(self._session.document)
        if [line.text for line in self.sent] == texts:
            return self.sent
        return tuple(Line(text) for text in texts)

    @property
    def same_as_controller(self) -> bool | None:
        """Whether the program in the EEPROM is the one in the controller; None where one of them is not known."""
        controller = self._connection.controller
        key = (self.known, controller.listing, controller.doubt)
        if self._judged is None or any(one is not other for one, other in zip(self._judged[0], key, strict=True)):
            same = None
            if self.known.program is not None and controller.listing is not None and not controller.doubt:
                same = [line.text for line in self.known.program] == program_lines(controller.listing)
            self._judged = (key, same)
        return self._judged[1]

    @property
    def words(self) -> str:
        """What is known of the EEPROM, as a sentence."""
        if self.known.program is None:
            return "What program is in the EEPROM is not known: this studio has not burned it."
        return f"The EEPROM holds “{self.known.name}” as burned from here on {self.known.program_when}."

    def _downloaded(self, listing: Listing) -> None:
        document = self._session.document
        if listing is self._session.listing:
            self.sent = lines_of(document)
        else:
            self.sent = tuple(Line(text) for text in program_lines(listing.text))

    def _hear(self, text: str) -> None:
        """A line that a person sent; what a program may burn is not known either."""
        if ERASE.search(text):
            self._keep(Burned())
            return
        names = {each.name for each in parse_line(text.strip()).statements if isinstance(each, nodes.Command)}
        if "XQ" in names and self._connection.controller.listing is not None:
            names |= _commands(self._connection.controller.listing) - {"BP"}
        known = self.known
        self._burning = frozenset(names & {"BN", "BV"}) if "XQ" not in names else frozenset()
        if "BP" in names and not self._run.doing.startswith("Burning"):
            known = dc.replace(known, program=None, name="", program_when="")
        if "BN" in names:
            known = dc.replace(known, parameters=None, parameters_when="")
        if "BV" in names:
            known = dc.replace(known, variables=None, variables_when="")
        if known != self.known:
            self._keep(known)

    def _read(self, controller: Controller) -> None:
        """What has just been burned is read and remembered: it cannot be read from the EEPROM."""
        what, self._to_read = self._to_read, frozenset()
        job: Job[Backup] = Job()
        job.future = controller.run(backup_steps(controller, job, running=True), Priority.DOWNLOAD, "download")
        when = f"{self._now():%Y-%m-%d %H:%M}"

        def finished(future: Future[Any]) -> None:
            found: Backup = future.result()
            if controller is not self._connection.controller or controller.doubt:
                return
            known = self.known
            if "BN" in what:
                known = dc.replace(known, parameters=keyed(found.parameters, controller.axes), parameters_when=when)
            if "BV" in what:
                known = dc.replace(known, variables=found.variables, variables_when=when)
            self._keep(known)

        self._run.begin("Noting what was burned", job, finished)

    def _keep(self, known: Burned) -> None:
        self.known = known
        folder = self._folder(self._connection.controller)
        if folder is None:
            return
        try:
            save_burned(folder, known)
        except OSError as reason:
            self.said.emit(f"What was burned cannot be remembered: {(reason.strerror or str(reason)).lower()}.")

    def _folder(self, controller: Controller) -> Path | None:
        """Only a machine with a serial number can be told again; a simulator's EEPROM ends with it."""
        identity = controller.identity
        sure = controller.kind is Kind.MACHINE and identity is not None and bool(identity.serial)
        return folder_of(self._root, controller) if sure else None


def lines_of(document: Document) -> Lines:
    """The lines of a document as they are sent, each with the sentence of its instruction."""
    listing = generate(document)
    kept = kept_lines(listing)
    words = sentences_of(document, kept)
    texts = program_lines(listing.text)
    return tuple(
        Line(text, words.get(number, ""), listing.lines[kept[number]].step if number < len(kept) else "")
        for number, text in enumerate(texts)
    )


def _commands(listing: str) -> set[str]:
    return {each.name for _, each in parse(listing).statements() if isinstance(each, nodes.Command)}
