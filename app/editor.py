"""The code editor: its files, and what goes to and comes from the controller."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QCloseEvent
from PySide6.QtWidgets import QWidget

from app.checking import Checked, Checking
from app.connection import Connection
from app.facts import Facts
from app.run import Ask, Run
from app.session import Session
from codegen.disk import save_text
from codegen.models import MODELS
from device.api import Kind, State
from widgets.parts.files import CODE, ask_open, ask_save

if TYPE_CHECKING:
    from widgets.editor.window import EditorWindow

LARGEST = 1_000_000  # bytes
OFFLINE = "Nothing is connected."
WATCHED = "This is Watch: switch to Control first."
CHANGES = ("Download", "Execute", "Burn")


class Editor(QObject):
    """One window; made when it is first wanted."""

    said = Signal(str)

    def __init__(
        self,
        connection: Connection,
        session: Session,
        run: Run,
        ask: Ask,
        insert: Callable[[Path], None],
        folder: Callable[[], Path],
        data: Path,
        parent: QWidget,
    ) -> None:
        super().__init__(parent)
        self._connection, self._session, self._run, self._ask = connection, session, run, ask
        self._insert, self._folder, self._data, self._parent = insert, folder, data, parent
        self.window: EditorWindow | None = None
        self.checking = Checking(self._checked)
        self._sending: str | None = None  # what is sent once it is checked

    def show(self) -> None:
        """The editor in front; empty at first."""
        if self.window is None:
            from widgets.editor.window import EditorWindow

            self.window = EditorWindow(self._parent)
            self.window.wanted.connect(self._do)
            self.window.closing.connect(self._closing)
            self.window.text.check_wanted.connect(self.checking.ask)
            self.window.text.check_now()
        self.window.show()
        self.window.raise_()
        self.window.activateWindow()

    def look(self, facts: Facts) -> None:
        """With every tick: what can be done now, and for which controller the code is."""
        self.checking.look()
        if self.window is None or not self.window.isVisible():
            return
        controller = self._connection.controller
        self.window.show_model(controller.model or MODELS[self._session.document.setup.model])
        reasons = dict.fromkeys(("Upload", "Download", "Compare", "Execute", "Halt", "Burn"), "")
        linked = controller.kind is not Kind.OFFLINE and controller.state is State.READY
        for name in reasons:
            if not linked:
                reasons[name] = OFFLINE
            elif name in (*CHANGES, "Halt") and not controller.control:
                reasons[name] = WATCHED
            elif facts.busy and name != "Halt":
                reasons[name] = f"{facts.busy}; wait for its end."
        self.window.show_reasons(reasons)

    # ---- what the buttons do

    def _do(self, name: str) -> None:
        {
            "Open…": lambda: self._careful(self._ask_open), "Save": self.save, "Save as…": self._ask_save,
            "Print…": self._print, "Insert into the program": self._insert_it, "Upload": self._upload,
            "Download": self._download, "Compare": self._compare, "Execute": self._run.execute,
            "Halt": self._run.halt, "Burn": self._run.burn,
        }[name]()  # fmt: skip

    def _ask_open(self) -> None:
        ask_open(self._shown, "Open code", f"{CODE};;Text (*.txt *.gal)", self.open, self._folder())

    def open(self, path: Path) -> None:
        """A file of code; every failure is one sentence, and what was there stays."""
        try:
            data = path.read_bytes()
            if len(data) > LARGEST:
                raise ValueError(f"it has {len(data)} bytes; a controller holds a thousand lines")
            text = data.decode("utf-8-sig")
        except (OSError, ValueError) as reason:
            why = (
                "it is no text"
                if isinstance(reason, UnicodeDecodeError)
                else getattr(reason, "strerror", None) or reason
            )
            self._shown.say(f"{path.name} was not opened: {why}.")
            return
        self._shown.show_text(text.replace("\r\n", "\n").replace("\r", "\n").rstrip("\n"), path)

    def save(self) -> None:
        """Into its file, or into one that is asked for."""
        if self._shown.path is None:
            self._ask_save()
        else:
            self.save_as(self._shown.path)

    def _ask_save(self) -> None:
        proposed = self._shown.path or self._folder() / "program.dmc"
        ask_save(self._shown, "Save code", CODE, self.save_as, proposed, "dmc")

    def save_as(self, path: Path) -> None:
        """Whole or not at all."""
        try:
            save_text(path, self.text + "\n")
        except OSError as reason:
            self._shown.say(f"{path.name} was not saved: {reason.strerror or reason}.")
            return
        self._shown.show_saved(path)
        self._shown.say(f"{path.name} is saved.")

    def _print(self) -> None:
        from widgets.editor.paper import preview

        name = self._shown.path.name if self._shown.path is not None else "Code"
        preview(self._shown, name, self.text, time.strftime("%Y-%m-%d")).show()

    def _insert_it(self) -> None:
        """As a module of the open program; it goes through a file, as any module does."""
        path = self._data / "editor.dmc"
        try:
            save_text(path, self.text + "\n")
        except OSError as reason:
            self._shown.say(f"The code was not inserted: {reason.strerror or reason}.")
            return
        self._insert(path)

    def _upload(self) -> None:
        self._careful(lambda: self._read(lambda text: self._shown.show_text(text, None, changed=bool(text))))

    def _compare(self) -> None:
        self._read(self._show_difference)

    def _show_difference(self, text: str) -> None:
        from widgets.terminal.code_window import CodeWindow

        CodeWindow("The program in the controller", text, self.text, self._shown).show()

    def _read(self, call: Callable[[str], None]) -> None:
        job = self._connection.controller.upload()
        self._run.begin("Uploading", job, lambda done: call(str(done.result()).rstrip("\n")))

    def _download(self) -> None:
        """As soon as exactly this text is checked."""
        self._sending = self._shown.text.toPlainText()
        self._shown.say("Checked first; then it is sent.")
        if self.checking.knows(self._sending, self._shown.text.model) is None:
            self._shown.text.check_now()
        self._send_when_checked()

    def _checked(self, found: Checked) -> None:
        """Of a text that was changed meanwhile another check is on its way, or will be."""
        if found.text == self._shown.text.toPlainText():
            self._shown.show_checked(found.names, found.problems)
        self._send_when_checked()

    def _send_when_checked(self) -> None:
        text, shown = self._sending, self._shown
        if text is None:
            return
        if text != shown.text.toPlainText():
            self._sending = None
            shown.say("The code was changed while it was checked: press Download again.")
            return
        found = self.checking.knows(text, shown.text.model)
        if found is None:
            return
        self._sending = None
        if found.error is not None:
            words = f"Line {found.error.line}: {found.error.message}"
            answers = [("Download anyway", lambda: self._send(text))]
            self._ask("Download code with errors?", words, answers, "warning")
        else:
            self._send(text)

    def _send(self, text: str) -> None:
        self._run.download_text(text.rstrip("\n"), self._downloaded)

    def _downloaded(self, done: Future[Any]) -> None:
        self._shown.say(done.result().sentence)

    # ---- inside

    @property
    def text(self) -> str:
        """What is edited, without empty lines at the end."""
        return self._shown.text.toPlainText().rstrip("\n")

    @property
    def _shown(self) -> EditorWindow:
        assert self.window is not None
        return self.window

    def _careful(self, go_on: Callable[[], object]) -> None:
        """What is not saved is asked about first."""
        if self.window is None or not self.window.dirty:
            go_on()
            return
        answers = [("Do not keep it", lambda: go_on()), ("Save first", self.save)]
        self._ask("The code is not saved", "The changes in the code editor are in no file yet.", answers, "warning")

    def careful(self, go_on: Callable[[], object]) -> None:
        """Before the studio ends: the same, and then its window holds nobody up."""
        self._careful(lambda: (self._close() if self.window is not None else None, go_on()))

    def _closing(self, event: QCloseEvent) -> None:
        if self.window is not None and self.window.dirty:
            event.ignore()
            self._careful(self._close)

    def _close(self) -> None:
        self._shown.text.document().setModified(False)
        self._shown.close()
