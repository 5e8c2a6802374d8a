"""The setup's own file (`.tls`): opened, saved, never overwritten in silence; and the last setup as default."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QWidget

from app.run import Ask
from codegen.disk import FileUnreadable
from codegen.files import load_setup, save_setup, setup_dumps
from codegen.setup import Setup
from widgets.parts import files as choose

DEFAULT = "last-setup.tls"


class SetupFile(QObject):
    """One file at a time; every failure becomes a sentence."""

    said = Signal(str)
    opened = Signal(object)  # the Setup
    changed = Signal()

    def __init__(self, ask: Ask, folder: Callable[[], Path], parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._ask, self._folder = ask, folder
        self.path: Path | None = None
        self._held = ""  # what the file held when it was opened or saved

    @property
    def name(self) -> str:
        """For the title."""
        return self.path.name if self.path is not None else "not saved in a file"

    def unsaved(self, setup: Setup) -> bool:
        """Whether the file does not have this setup."""
        return self.path is not None and setup_dumps(setup) != self._held

    def forget(self) -> None:
        """A new setup has no file."""
        self.path, self._held = None, ""
        self.changed.emit()

    def open(self, parent: QWidget) -> None:
        """Asks for a file."""
        choose.ask_open(parent, "Open setup", choose.SETUPS, self.open_path, self._place())

    def open_path(self, path: Path) -> None:
        """Opens a file that was named."""
        try:
            setup = load_setup(path)
        except FileUnreadable as error:
            said = str(error).rstrip(".")
            words = said if path.name in said else f"{path.name}: {said}"
            self._ask("The setup cannot be opened", f"{words}.", (), "problem")
            return
        self._follow(path, setup)
        self.opened.emit(setup)
        self.said.emit(f"Opened: {path.name}")

    def save(self, setup: Setup, parent: QWidget) -> None:
        """Writes the file; without one, asks for its name."""
        if self.path is None:
            self.save_as(setup, parent)
        elif self._is_another(self.path):
            words = f"{self.path.name} was changed by another program since it was opened."
            answers = (
                ("Save under another name", lambda: self.save_as(setup, parent)),
                ("Overwrite it", lambda: self._write(self.path, setup)),
            )
            self._ask("Somebody else changed this file", words, answers, "warning")
        else:
            self._write(self.path, setup)

    def save_as(self, setup: Setup, parent: QWidget) -> None:
        """Writes under a name that is asked for."""
        stem = (setup.name.strip() or setup.model).lower().replace(" ", "_")
        proposed = self.path or self._place() / f"{stem}.tls"
        choose.ask_save(parent, "Save setup", choose.SETUPS, lambda path: self._write(path, setup), proposed, "tls")

    def _is_another(self, path: Path) -> bool:
        """Whether the file holds something else than it did; one that is gone is written again."""
        try:
            return path.read_text(encoding="utf-8-sig") != self._held
        except FileNotFoundError:
            return False
        except (OSError, UnicodeDecodeError):
            return True

    def _write(self, path: Path | None, setup: Setup) -> None:
        if path is None:
            return
        try:
            save_setup(path, setup)
        except OSError as error:
            self._ask("The setup cannot be saved", f"{path}: {error.strerror or error}.", (), "problem")
            return
        self._follow(path, setup)
        self.said.emit(f"Saved: {path.name}")

    def _follow(self, path: Path, setup: Setup) -> None:
        self.path, self._held = path, setup_dumps(setup)
        self.changed.emit()

    def _place(self) -> Path:
        return self.path.parent if self.path is not None else self._folder()


def last_setup(folder: Path) -> Setup | None:
    """The setup that was finished last; None when there is none that can be read."""
    path = folder / DEFAULT
    if not path.is_file():
        return None
    try:
        return load_setup(path)
    except FileUnreadable:
        return None


def keep_last(folder: Path, setup: Setup) -> str:
    """Keeps it as the default of new programs; why that is not possible, as a sentence."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        save_setup(folder / DEFAULT, setup)
    except OSError as error:
        return f"This setup cannot be kept as the default of new programs: {error.strerror or error}."
    return ""
