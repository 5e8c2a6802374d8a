"""Import Module: another program or two-letter code becomes a part of the open one, as one step of Undo."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QWidget

from app.run import Ask
from app.session import Session
from codegen.disk import FileUnreadable
from codegen.document import Document
from codegen.files import load
from codegen.program import Section
from widgets.parts import files as choose

if TYPE_CHECKING:
    from codegen.modules import Plan
    from widgets.program.import_window import ImportWindow

MODULES = "Programs and two-letter code (*.tlp *.dmc *.txt *.gal)"
LARGEST = 1_000_000  # bytes; a controller takes a thousand lines


class Importing(QObject):
    """Asks for the file, shows what gets another name, then changes the document."""

    said = Signal(str)
    placed = Signal(object)  # ids of the new steps

    def __init__(self, session: Session, ask: Ask, window: QWidget) -> None:
        super().__init__(window)
        self._session, self._ask, self._window = session, ask, window
        self.shown: ImportWindow | None = None

    def ask_file(self, folder: Path) -> None:
        """Which module."""
        choose.ask_open(self._window, "Import module", MODULES, self.take, folder)

    def take(self, path: Path) -> None:
        """A module that was named; every failure is one sentence."""
        from codegen.modules import plan

        try:
            module = read_module(path, self._session.document)
        except (FileUnreadable, OSError) as error:
            said = str(error) if isinstance(error, FileUnreadable) else f"{path.name}: {error.strerror or error}"
            self._ask("The module cannot be imported", f"{said.rstrip('.')}.", (), "problem")
            return
        made = plan(self._session.document, module)
        if made.cannot:
            self._ask("The module cannot be imported", f"{path.name}: {made.cannot}.", (), "problem")
        elif not any(True for _ in made.document.program.steps()):
            self._ask("The module cannot be imported", f"{path.name} holds no instruction.", (), "problem")
        elif made.renames or made.left_out:
            self._show(path, made)
        else:
            self._put_in(path.name, made, frozenset())

    def _show(self, path: Path, made: Plan) -> None:
        from widgets.program.import_window import ImportWindow

        self.shown = ImportWindow(_words(path.name, made), made.renames, self._window)
        before = self._session.document
        self.shown.confirmed.connect(partial(self._confirmed, path, before, made))
        self.shown.show()

    def _confirmed(self, path: Path, before: Document, made: Plan, shared: frozenset[str]) -> None:
        if before is not self._session.document:  # what was shown may not be so any more
            self.said.emit("The program was changed meanwhile: look at the names again.")
            self.take(path)
        else:
            self._put_in(path.name, made, shared)

    def _put_in(self, name: str, made: Plan, shared: frozenset[str]) -> None:
        from codegen.instructions import TwoLetterCode
        from codegen.modules import imported

        document = self._session.document
        place = self._session.next_place(TwoLetterCode(), section=Section.MAIN)
        new, ids = imported(document, made, place, shared)
        self._session.set_document(new, f"Import {name}")
        self.placed.emit(ids)
        count = len(ids)
        self.said.emit(f"Imported from {name}: {count} step{'s' * (count != 1)}. Ctrl+Z takes all of it back.")


def read_module(path: Path, host: Document) -> Document:
    """A program file, or code that is turned into instructions for the same machine."""
    if path.suffix.lower() == ".tlp":
        return load(path)
    from codegen.twoletter.lift import lift

    with path.open("rb") as file:
        data = file.read(LARGEST + 1)
    if len(data) > LARGEST or b"\0" in data:
        raise FileUnreadable(f"{path.name} is not two-letter code")
    return lift(data.decode("utf-8-sig", errors="replace"), path.stem, host.setup)


def _words(name: str, made: Plan) -> str:
    parts = [f"{name}:"]
    if made.renames:
        parts.append("these names are used in the program already. In the module they become others.")
    if made.left_out:
        parts.append(f"Left out, because a program has it once: {', '.join(made.left_out)}.")
    return " ".join(parts)
