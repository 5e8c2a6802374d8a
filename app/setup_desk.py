"""The setup window with what stands around it: document, file, controller. Offline it edits, online it compares."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable
from concurrent.futures import Future
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QWidget

from app import facts as need
from app.connection import Connection
from app.facts import Facts
from app.right_machine import RightMachine
from app.run import Ask
from app.session import Session
from app.setup_file import SetupFile, keep_last, last_setup
from app.tick import Tick, failure_of
from codegen.models import MODELS
from codegen.setup import Setup
from device.api import Controller, Kind

if TYPE_CHECKING:
    from codegen.rescale import Keep
    from codegen.setup_differences import Key, Line
    from device.setup_transfer import Reading, Sent
    from widgets.setup.window import SetupWindow

MOST_SHOWN = 12  # values in a question


class SetupDesk(QObject):
    """Owns the window; nothing is sent that was not chosen and confirmed, nothing is burned by the way."""

    said = Signal(str)

    def __init__(
        self,
        parent: QWidget,
        session: Session,
        connection: Connection,
        tick: Tick,
        ask: Ask,
        right: RightMachine,
        data: Path,
    ) -> None:
        super().__init__(parent)
        self._parent, self._session, self._connection, self._tick = parent, session, connection, tick
        self._ask, self._right, self._data = ask, right, data
        self.file = SetupFile(ask, self._folder, self)
        self.window: SetupWindow | None = None
        self.facts: Callable[[], Facts] = Facts  # told by whoever gathers them
        self.default: Setup | None = last_setup(data)
        self._reading: Reading | None = None
        self._read_from: Controller | None = None
        self.file.said.connect(self.said)
        self.file.opened.connect(self._opened)
        self.file.changed.connect(self._show_file)
        session.replaced.connect(self._another_program)

    # ---- the window

    def show(self) -> None:
        """The setup of the open program, or the window as it is open already."""
        if self.window is None or not self.window.isVisible():
            if self.window is not None:
                self.window.deleteLater()
            self.window = self._make()
            self.look()
            self._show_file()
            self.window.show()
            if not self._why_not_read():
                self.read(turn=False)
            return
        self.window.raise_()
        self.window.activateWindow()

    def look(self) -> None:
        """With every tick: what a connected controller allows now."""
        window = self.window
        if window is None or not window.isVisible():
            return
        from widgets.setup.window import Online

        window.grow()
        controller, facts = self._connection.controller, self.facts()
        if controller is not self._read_from:
            window.forget_readings()
            self._reading = self._read_from = None
        window.show_stop(controller.kind, controller.stop_state)
        identity = controller.identity
        serial = identity.serial if identity is not None else None
        window.show_online(Online(self._why_not_read(), need.control(facts) or need.quiet(facts), serial))

    def _why_not_read(self) -> str:
        """Why the controller cannot be read now; nothing when it can."""
        facts = self.facts()
        return need.live(facts) or need.quiet(facts)

    def _make(self) -> SetupWindow:
        from widgets.setup.window import SetupWindow

        document = self._session.document
        content = any((document.program.configuration, document.program.main, document.program.routines))
        window = SetupWindow(document.setup, content, self._parent)
        window.finished_setup.connect(self._finish)
        window.changed.connect(self._show_file)
        window.new_wanted.connect(self._new)
        window.open_wanted.connect(lambda: self._careful(lambda: self.file.open(window)))
        window.save_wanted.connect(lambda: self.file.save(window.setup, window))
        window.save_as_wanted.connect(lambda: self.file.save_as(window.setup, window))
        window.read_wanted.connect(lambda: self.read())
        window.burn_wanted.connect(self.burn)
        window.stop.stop.connect(self._connection.stop)
        return window

    def _show_file(self) -> None:
        if self.window is not None:
            self.window.show_file(self.file.name, self.file.unsaved(self.window.setup))

    def _opened(self, setup: Setup) -> None:
        if self.window is not None:
            self.window.show_setup(setup)

    def _new(self) -> None:
        def begin() -> None:
            self.file.forget()
            self._opened(Setup())

        self._careful(begin)

    def _careful(self, go_on: Callable[[], None]) -> None:
        """Asks first where the window shows what is kept nowhere."""
        window = self.window
        kept = (self._session.document.setup, Setup())
        saved = window is not None and self.file.path is not None and not self.file.unsaved(window.setup)
        if window is None or saved or window.setup in kept:
            go_on()
            return
        words = "What this window shows is neither in the program (Done) nor in a setup file (Save)."
        self._ask("Leave this setup?", words, [("Leave it", go_on)], "warning")

    def _another_program(self) -> None:
        """Another program has its own setup: a window about the one before closes."""
        if self.window is not None and self.window.isVisible():
            self.window.reject()
        self.file.forget()

    def _folder(self) -> Path:
        path = self._session.path
        return path.parent if path is not None else Path.home()

    # ---- done

    def _finish(self, setup: Setup, keep: Keep, keys: frozenset[Key]) -> None:
        from codegen.rescale import with_setup
        from codegen.setup_differences import lines_to_send

        if not keys:
            self._keep(setup, keep)
            return
        lines = lines_to_send(with_setup(self._session.document, setup, keep).setup, keys)
        reason = need.control(self.facts())
        only_keep = ("Keep it without sending", partial(self._keep, setup, keep))
        if reason:
            words = f"{len(lines)} values were chosen to be sent. {reason}"
            self._ask("Not sent to the controller", words, [only_keep], "warning")
            return
        send = ("Send and finish", partial(self._keep_and_send, setup, keep, lines))
        self._ask("Send the setup to the controller?", self._send_words(lines), [send, only_keep], "warning")

    def _keep_and_send(self, setup: Setup, keep: Keep, lines: tuple[Line, ...]) -> None:
        self._keep(setup, keep)
        self._right.careful("Send", partial(self._send, self._session.document.setup, lines))

    def _keep(self, setup: Setup, keep: Keep) -> None:
        """Into the document as one step of the history, and as the default of new programs."""
        from codegen.rescale import with_setup

        self._session.set_document(with_setup(self._session.document, setup, keep), "Change setup")
        self.default = self._session.document.setup
        complaint = keep_last(self._data, self.default)
        if complaint:
            self.said.emit(complaint)
        if self.file.unsaved(setup):
            self.said.emit(f"The setup is in the program; {self.file.name} does not have the changes (Save writes it).")
        if self.window is not None:
            self.window.accept()

    def _send_words(self, lines: tuple[Line, ...]) -> str:
        """What will be sent, and what that may do to the machine."""
        from codegen.setup_differences import cautions

        shown = [f"• {line.words}" for line in lines[:MOST_SHOWN]]
        more = [f"• and {len(lines) - MOST_SHOWN} more"] if len(lines) > MOST_SHOWN else []
        reading = self._reading
        on = reading.motors_on if reading is not None else ""
        letters = [each for each in dict.fromkeys(line.axis for line in lines if line.motor_off) if each in on]
        parts = [f"{words[:1].upper()}{words[1:]}." for words in cautions(lines)]
        if letters:
            parts.insert(
                0,
                f"The motor of {' and '.join(letters)} is switched off first and stays off; a vertical axis may fall.",
            )
        return "\n".join([*shown, *more, *(["", *parts] if parts else []), "", "Nothing is burned."])

    # ---- the controller

    def read(self, turn: bool = True) -> None:
        """What a connected controller holds, beside the setup; unasked (`turn` False) a failure shows nothing."""
        from device.setup_transfer import read_setup

        controller = self._connection.controller

        def done(future: Future[Any]) -> None:
            window = self.window
            if window is None or controller is not self._connection.controller:
                return
            failure = failure_of(future)
            if failure and turn:
                self._ask("The controller was not read", failure, (), "problem")
            if failure or not (turn or future.result().model == window.setup.model):
                return
            self._reading, self._read_from = future.result(), controller
            self._show_reading(controller, future.result(), turn)

        self._tick.when_done(read_setup(controller), done)

    def _show_reading(self, controller: Controller, reading: Reading, turn: bool = True) -> None:
        window = self.window
        assert window is not None  # the caller looked
        if reading.model != window.setup.model:
            theirs, ours = MODELS[reading.model].title, MODELS[window.setup.model].title
            words = f"This setup is for {ours}; connected is {theirs}. Only one model can be compared with itself."
            change = partial(self._take_model, controller, reading)
            self._ask("Another controller", words, [(f"Make it a setup for {theirs}", change)], "warning")
            return
        missing = f" Not told by it: {', '.join(reading.not_told)}." if reading.not_told else ""
        window.show_readings(reading.values, f"Read from {controller.who}.{missing}", turn)

    def _take_model(self, controller: Controller, reading: Reading) -> None:
        window = self.window
        if window is not None and controller is self._connection.controller:
            window.show_setup(dc.replace(window.setup, model=reading.model))
            self._show_reading(controller, reading)

    def _send(self, setup: Setup, lines: tuple[Line, ...]) -> None:
        from device.setup_transfer import send_setup

        controller = self._connection.controller

        def done(future: Future[Any]) -> None:
            failure = failure_of(future)
            if failure:
                self._ask("The setup was not sent", f"{failure} The setup itself is kept.", (), "problem")
                return
            sent: Sent = future.result()
            self.said.emit(sent.sentence)
            if not sent.complete:
                self._ask("Not everything was taken", sent.sentence, (), "problem")

        self._tick.when_done(send_setup(controller, setup, lines).future, done)

    def burn(self) -> None:
        """Reads once more, says what the next power-up will do, and burns when told to."""
        self._right.careful("Burn", self._ask_to_burn)

    def _ask_to_burn(self) -> None:
        from codegen.setup_differences import differences
        from device.setup_transfer import burn_words, read_setup

        controller = self._connection.controller

        def done(future: Future[Any]) -> None:
            if controller is not self._connection.controller or controller.model is None:
                return
            if failure := failure_of(future):
                self._ask("Nothing was burned", failure, (), "problem")
                return
            reading: Reading = future.result()
            setup = self.window.setup if self.window is not None else self._session.document.setup
            unsent = [each for each in differences(setup, reading.values) if each.states]
            words = burn_words(reading, controller.model, len(unsent) if setup.model == reading.model else 0)
            self._ask("Write to EEPROM?", words, [("Write to EEPROM", partial(self._burn, controller))], "warning")

        self._tick.when_done(read_setup(controller), done)

    def _burn(self, controller: Controller) -> None:
        from device.setup_transfer import burn_setup

        if controller is not self._connection.controller:
            self.said.emit("Not burned: another controller is connected now.")
            return

        def done(future: Future[Any]) -> None:
            failure = failure_of(future)
            reply = None if failure else future.result()
            if failure or not reply.accepted:
                self._ask("Nothing was burned", failure or reply.reason, (), "problem")
                return
            there = "simulator's" if controller.kind is Kind.SIMULATOR else "controller's"
            self.said.emit(f"Written into the {there} EEPROM: it is there after the next power-up.")

        self._tick.when_done(burn_setup(controller), done)
