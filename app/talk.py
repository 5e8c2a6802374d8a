"""What panels ask of the controller: typed commands, outputs, switches of the simulator, answers to questions."""

from __future__ import annotations

from concurrent.futures import Future
from typing import Any

from PySide6.QtCore import QObject, Signal

from app.connection import Connection
from app.tick import Tick, failure_of
from device.api import StopState
from widgets.terminal.terminal import TerminalPanel


class Talk(QObject):
    """Every failure becomes a sentence; nothing waits."""

    said = Signal(str)
    taken = Signal(str)  # a typed command that was accepted

    def __init__(
        self, connection: Connection, tick: Tick, terminal: TerminalPanel, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._connection, self._tick, self._terminal = connection, tick, terminal

    def typed(self, command: str) -> None:
        """A command of the terminal; its reply goes back there."""

        def done(future: Future[Any]) -> None:
            failure = failure_of(future)
            if failure:
                self._terminal.show_failure(command, failure)
            else:
                self._terminal.show_reply(command, future.result())
                if future.result().accepted:
                    self.taken.emit(command)

        self._tick.when_done(self._connection.controller.ask(command), done)

    def output(self, number: int, on: bool) -> None:
        """An output is to be switched."""
        self._expect(self._connection.controller.io.set_output(number, on), f"Output {number}")

    def io_control(self, on: bool) -> None:
        """Outputs switch when clicked, or not."""
        self._connection.controller.set_io_control(on)

    def control(self, on: bool) -> None:
        """Watch or Control."""
        controller = self._connection.controller
        if on:
            controller.take_control()
        else:
            controller.release_control()

    def answer(self, text: str) -> None:
        """The answer to a program that waits for one; never after STOP, where it would be a command."""
        controller = self._connection.controller
        if controller.stop_state is StopState.STOPPING or controller.pending_prompt is None:
            self.said.emit("The answer was not sent: no question waits for it any more.")
            return
        self._expect(controller.answer(text), "The answer")

    def not_waiting(self) -> None:
        """The person knows that no program waits."""
        self._connection.controller.resume_polling()

    def stimulus(self, signal: str, value: float) -> None:
        """Something outside the simulated controller changes."""
        world = self._connection.world
        if world is None:
            self.said.emit("The simulator is not running.")
            return
        try:
            world.stimulus(signal, value)
        except (OSError, ValueError, KeyError) as error:
            self.said.emit(f"The simulator did not take that: {error}")

    def _expect(self, future: Future[Any], what: str) -> None:
        def done(future: Future[Any]) -> None:
            failure = failure_of(future)
            reply = None if failure else future.result()
            if failure:
                self.said.emit(f"{what}: {failure}")
            elif reply is not None and not reply.accepted:
                self.said.emit(f"{what}: {reply.reason}")

        self._tick.when_done(future, done)
