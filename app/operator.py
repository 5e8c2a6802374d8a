"""The operator terminal and the line to port 2."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from functools import partial
from typing import TypeAlias

from PySide6.QtCore import QObject

from app.connection import Connection
from app.search import Candidate
from app.tick import Tick
from device.api import Kind
from device.second_port import LINE, SecondPort
from device.transport import Transport, open_transport
from widgets.operator.panel import CLOSED, SIMULATED, OperatorPanel

Opener: TypeAlias = Callable[[], Transport]


class Operator(QObject):
    """Opens and closes the line; it ends with the connection to the controller, so that STOP is never missing."""

    def __init__(
        self,
        connection: Connection,
        tick: Tick,
        panel: OperatorPanel,
        ports: Callable[[], Sequence[Candidate]],
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._connection, self._panel, self._ports = connection, panel, ports
        self.port: SecondPort | None = None
        self.tap: Callable[[Opener], Opener] = lambda opener: opener  # records what goes over the line
        self._listed: object = None  # what the devices were listed for
        self._listing: threading.Thread | None = None
        self._found: list[str] = []
        panel.connect_wanted.connect(self.open)
        panel.close_wanted.connect(self.close)
        panel.keys.connect(self._send)
        connection.changed.connect(lambda _: self.close())
        tick.each(self.once)

    def open(self, name: str) -> None:
        """The line of that name."""
        self.close()
        world = self._connection.world
        if name != SIMULATED:
            self.port = SecondPort(self.tap(partial(open_transport, name, LINE)))
        elif world is not None:
            self.port = SecondPort(self.tap(world.second))
        self.once()

    def close(self) -> None:
        """No line to port 2 any more."""
        if self.port is not None:
            self.port.close()
            self.port = None
        self._panel.show_line(CLOSED, False, False)

    def once(self) -> None:
        """With every tick: what came is shown."""
        self._list_devices()
        if self.port is not None:
            data = self.port.pump()
            self._panel.show_line(self.port.text, self.port.open, self.port.failed)
            self._panel.received(data)

    def _list_devices(self) -> None:
        """When the panel is shown, or something else is connected; beside the window's thread, as it may take long."""
        kind, own = self._connection.controller.kind, self._connection.address
        if self._listing is not None and not self._listing.is_alive():
            self._listing = None
            self._panel.show_lines([device for device in self._found if device != own])
        wanted = (kind, own) if self._panel.isVisible() else None
        if wanted == self._listed or self._listing is not None:
            return
        self._listed = wanted
        if wanted is None:
            return
        if kind is Kind.SIMULATOR:
            self._panel.show_lines([])
        else:
            self._listing = threading.Thread(target=self._look, name="ports", daemon=True)
            self._listing.start()

    def _look(self) -> None:
        self._found = [port.device for port in self._ports()]

    def _send(self, data: bytes) -> None:
        if self.port is not None:
            self.port.send(data)
