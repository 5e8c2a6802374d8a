"""Nothing is downloaded, executed or burned on another controller than the setup's before the person confirms it."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from app.connection import Connection
from app.session import Session
from device.api import Controller, Identity, Kind

if TYPE_CHECKING:
    from app.run import Ask

TITLE = "Is this the right machine?"


class RightMachine:
    """What was confirmed holds for this controller and this type and serial number in the setup."""

    def __init__(self, connection: Connection, session: Session, ask: Ask) -> None:
        self._connection, self._session, self._ask = connection, session, ask
        self._confirmed: tuple[object, ...] | None = None

    def careful(self, what: str, go_on: Callable[[], object]) -> None:
        """Does it where the setup was written for what is connected; otherwise asks. `what`: "Execute"."""
        words = self.doubt()
        if not words or self._key() == self._confirmed:
            go_on()
            return
        answers = [(f"{what} anyway", partial(self._confirm, self._key(), go_on))]
        self._ask(
            TITLE, f"{words} Numbers made for one machine can drive another one into its end.", answers, "warning"
        )

    def doubt(self) -> str:
        """How what is connected differs from what the setup was written for, as a sentence, or nothing."""
        setup, controller = self._session.document.setup, self._connection.controller
        if controller.kind is Kind.SIMULATOR:  # nothing can be damaged: any of the type will do
            setup = dc.replace(setup, serial_number="")
        return controller.mismatch(setup)

    def _confirm(self, key: tuple[object, ...], go_on: Callable[[], object]) -> None:
        if key == self._key():  # nothing else was connected or opened while the question stood there
            self._confirmed = key
            go_on()

    def _key(self) -> tuple[Controller, Identity | None, str, str]:
        setup, controller = self._session.document.setup, self._connection.controller
        return (controller, controller.identity, setup.model, setup.serial_number)
