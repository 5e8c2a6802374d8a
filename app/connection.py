"""The one controller that is worked with, and how it is exchanged for another."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from PySide6.QtCore import QObject, Signal

from device.api import Controller, Kind
from device.transport import LineSettings, open_transport

SIMULATOR = "simulator:"


class World(Protocol):
    """The outside of a simulated controller."""

    def stimulus(self, signal: str, value: float | str) -> None: ...


@dataclass(frozen=True)
class Opened:
    """A controller on its way, and the world around it when it is simulated."""

    controller: Controller
    world: World | None = None


class Connector(Protocol):
    """How a controller is opened; returns at once."""

    def __call__(self, address: str, line: LineSettings) -> Opened: ...


class Connection(QObject):
    """Never changes by itself: a lost machine stays a lost machine until a person chooses something else."""

    changed = Signal(object)  # the new Controller

    def __init__(self, connect: Connector, offline: Callable[[], Controller], parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._connect = connect
        self._offline = offline
        self.address = ""
        self.world: World | None = None
        self.controller = offline()

    def open(self, address: str, line: LineSettings) -> None:
        """Closes what was there and connects; whether it answers shows in the controller's state."""
        self.adopt(self._connect(address, line), address)

    def open_simulator(self, model: str) -> None:
        """A simulated controller of that model."""
        self.open(f"{SIMULATOR}{model}", LineSettings(baud=None))

    def go_offline(self) -> None:
        """Closes the connection; a running program in the controller goes on."""
        if self.controller.kind is not Kind.OFFLINE:
            self.adopt(Opened(self._offline()), "")

    def adopt(self, opened: Opened, address: str) -> None:
        """Works with a controller that is open already."""
        before, self.controller = self.controller, opened.controller
        self.world, self.address = opened.world, address
        self.changed.emit(self.controller)
        before.close()

    def stop(self) -> None:
        """STOP, whatever is connected."""
        self.controller.stop()

    def close(self) -> None:
        """At the end of the program."""
        self.controller.close()


def connector(programs: Path, idle_s: Callable[[], float]) -> Connector:
    """Opens real lines and starts simulators; programs found in a controller are kept in `programs`."""

    def connect(address: str, line: LineSettings) -> Opened:
        if not address.startswith(SIMULATOR):
            controller = Controller.connect(address, line, program_folder=programs, idle_limit_s=idle_s())
            return Opened(controller)
        from device.simulator.process import SimulatorProcess

        process = SimulatorProcess(address.removeprefix(SIMULATOR))
        controller = Controller(
            lambda: open_transport(process.address, line),
            kind=Kind.SIMULATOR,
            line=line,
            program_folder=programs,
            own=process,
        )
        return Opened(controller, process)

    return connect
