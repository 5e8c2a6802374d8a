"""The operator terminal and the line to port 2."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QObject

from app.connection import Connection
from app.search import Candidate
from app.tick import Tick
from device.second_port import SecondPort
from widgets.operator.panel import CLOSED, SIMULATED, OperatorPanel

LOOK_TICKS = 60  # between two looks at which serial devices there are, about two seconds


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
        self._ticks = 0
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
            self.port = SecondPort.at(name)
        elif world is not None:
            self.port = SecondPort(world.second)
        self.once()

    def close(self) -> None:
        """No line to port 2 any more."""
        if self.port is not None:
            self.port.close()
            self.port = None
        self._panel.show_line(CLOSED, False, False)
        self._ticks = 0

    def once(self) -> None:
        """With every tick: what came is shown."""
        if self._panel.isVisible() and self._ticks % LOOK_TICKS == 0:
            own = self._connection.address
            self._panel.show_lines([port.device for port in self._ports() if port.device != own])
        self._ticks += self._panel.isVisible()
        if self.port is not None:
            data = self.port.pump()
            self._panel.show_line(self.port.text, self.port.open, self.port.failed)
            self._panel.received(data)

    def _send(self, data: bytes) -> None:
        if self.port is not None:
            self.port.send(data)
