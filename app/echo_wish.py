"""The echo box of the serial set-up: a controller that does otherwise is told so, as soon as it may be (EO)."""

from __future__ import annotations

from collections.abc import Callable

from app.connection import Connection
from device.api import State


class EchoWish:
    """What was chosen last; done once, for the controller on the port it was chosen for."""

    def __init__(self, connection: Connection, say: Callable[[str], None]) -> None:
        self._connection, self._say = connection, say
        self._port, self._on = "", False
        self._told = False

    def choose(self, port: str, on: bool) -> None:
        """A person connects to this port, and wants an echo or none."""
        self._port, self._on, self._told = port, on, False

    def look(self) -> None:
        """With each tick."""
        controller = self._connection.controller
        if not self._port or self._connection.address != self._port or controller.state is not State.READY:
            return
        if controller.link.echo.on is self._on:
            self._port = ""
        elif controller.control and not controller.resting():
            self._port = ""
            controller.ask(f"EO {int(self._on)}")
            self._say(f"Echo switched {'on' if self._on else 'off'} (EO {int(self._on)}), as in the serial setup.")
        elif not self._told:
            self._told = True
            does = "does not echo" if self._on else "echoes"
            self._say(f"The controller {does} what it receives; the serial setup changes that when you take Control.")
