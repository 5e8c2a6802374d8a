"""Gains into the controller: into its memory, and into its EEPROM after a question that says what that burns."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject

from app.connection import Connection
from app.run import Ask
from app.tick import Tick, failure_of
from device.api import Controller
from widgets.tuner.panel import TunerPanel

if TYPE_CHECKING:
    from device.tuning.loop import Gains


class IntoController(QObject):
    """`careful` asks first whether it is the right machine; `read` shows afterwards what it holds."""

    def __init__(
        self,
        connection: Connection,
        tick: Tick,
        panel: TunerPanel,
        ask: Ask,
        careful: Callable[[str, Callable[[], object]], None],
        read: Callable[[], None],
        parent: QObject,
    ) -> None:
        super().__init__(parent)
        self._connection, self._tick, self._panel, self._ask = connection, tick, panel, ask
        self._careful, self._read = careful, read
        panel.use_wanted.connect(self._use)
        panel.burn_wanted.connect(self._burn)

    def _use(self, axis: str, gains: Gains) -> None:
        self._careful("Set gains", partial(self._set, axis, gains))

    def _set(self, axis: str, gains: Gains) -> None:
        from device.tuning.run import use_gains

        def done(future: Future[Any]) -> None:
            failure = failure_of(future)
            self._panel.show_result(failure or future.result(), good=not failure)
            self._read()

        self._tick.when_done(use_gains(self._connection.controller, axis, gains), done)

    def _burn(self, axis: str, gains: Gains) -> None:
        from device.setup_transfer import burn_words, read_setup
        from device.tuning.entry import gains_words

        controller = self._connection.controller

        def told(future: Future[Any]) -> None:
            failure = failure_of(future)
            if failure or controller.model is None or controller is not self._connection.controller:
                self._panel.show_result(f"Nothing was burned. {failure}", good=False)
                return
            words = f"Axis {axis} gets {gains_words(gains)}. {burn_words(future.result(), controller.model, 0)}"
            answers = [("Write to EEPROM", lambda: self._burn_now(controller, axis, gains))]
            self._ask("Save the PID gains?", words, answers, "warning")

        self._careful("Burn", lambda: self._tick.when_done(read_setup(controller), told))

    def _burn_now(self, controller: Controller, axis: str, gains: Gains) -> None:
        from device.tuning.run import burn

        def done(future: Future[Any]) -> None:
            failure = failure_of(future)
            reply = None if failure else future.result()
            good = reply is not None and reply.accepted
            words = "The gains are in the EEPROM: they are there after the next power-up." if good else (
                f"Nothing was burned. {failure or reply.reason}"
            )  # fmt: skip
            self._panel.show_result(words, good=good)
            self._read()

        if controller is self._connection.controller:
            self._tick.when_done(burn(controller, axis, gains), done)
