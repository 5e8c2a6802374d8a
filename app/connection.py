"""The one controller that is worked with, and how it is exchanged for another."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from PySide6.QtCore import QObject, Signal

from codegen.models import MODELS
from device.api import Controller, Kind
from device.transport import LineSettings, OpenFailed, Transport, open_transport

if TYPE_CHECKING:
    from device.recorder import Recorder
    from device.simulator.process import SimulatorProcess

SIMULATOR = "simulator:"


class World(Protocol):
    """The outside of a simulated controller."""

    def stimulus(self, signal: str, value: float | str) -> None: ...
    def state(self) -> dict[str, Any]: ...
    def second(self) -> Transport:
        """The line to port 2; raises OpenFailed."""
        ...


@dataclass(frozen=True)
class Opened:
    """A controller on its way, the world around it when it is simulated, and where its line is recorded."""

    controller: Controller
    world: World | None = None
    channel: int = 0


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
        self.address, self.channel = "", 0
        self.world: World | None = None
        self.controller = offline()

    def open(self, address: str, line: LineSettings) -> None:
        """Closes what was there and connects; whether it answers shows in the controller's state."""
        self.adopt(self._connect(address, line), address)

    def open_simulator(self, model: str, line: LineSettings) -> None:
        """A simulated controller of that model, behind a line as fast as that one."""
        self.open(f"{SIMULATOR}{model}", line)

    def go_offline(self) -> None:
        """Closes the connection; a running program in the controller goes on."""
        if self.controller.kind is not Kind.OFFLINE:
            self.adopt(Opened(self._offline()), "")

    def adopt(self, opened: Opened, address: str) -> None:
        """Works with a controller that is open already."""
        before, self.controller = self.controller, opened.controller
        self.world, self.address, self.channel = opened.world, address, opened.channel
        self.changed.emit(self.controller)
        before.leave()

    def stop(self) -> None:
        """STOP, whatever is connected."""
        self.controller.stop()

    def close(self) -> None:
        """At the end of the program."""
        self.controller.close()


class Simulated:
    """A simulator process of our own behind a paced serial line (a socket where there are no pseudo-terminals).

    It is started on the link's thread because that takes a moment.
    """

    def __init__(self, model: str, line: LineSettings) -> None:
        self._model, self._line = model, line
        self._process: SimulatorProcess | None = None
        self._closed = False

    def open(self) -> Transport:
        """Starts the process, also again when it has ended, and connects to it."""
        if self._process is not None:
            try:
                return open_transport(self._process.address, self._line)
            except OpenFailed:
                self._process.close()
        self._process = process = self._start()
        if self._closed:  # meanwhile
            process.close()
            raise OpenFailed("The simulator was closed.")
        return open_transport(process.address, self._line)

    def _start(self) -> SimulatorProcess:
        from device.simulator.process import SimulatorProcess

        try:
            process = SimulatorProcess(self._model, pty=os.name == "posix", baud=self._line.baud, port2="127.0.0.1:0")
        except OSError as reason:
            raise OpenFailed(f"The simulator did not start ({reason}).") from reason
        try:
            process.state()  # told once it serves: on a busy computer the line is there long before somebody answers
        except OSError as reason:
            process.close()
            raise OpenFailed(f"The simulator did not start ({reason}).") from reason
        return process

    def stimulus(self, signal: str, value: float | str) -> None:
        """Something outside the simulated controller changes; ValueError while it is still starting."""
        if self._process is None:
            raise ValueError("it is still starting")
        self._process.stimulus(signal, value)

    def state(self) -> dict[str, Any]:
        """Everything the simulated controller knows, as `run --json` has it; ValueError while it is still starting."""
        if self._process is None:
            raise ValueError("it is still starting")
        state: dict[str, Any] = self._process.state()
        return state

    def second(self) -> Transport:
        """The line to its port 2; a socket, because what nobody reads must not hold up the controller."""
        if self._process is None:
            raise OpenFailed("The simulator is still starting; try again.")
        return open_transport(self._process.address2)

    def close(self) -> None:
        """Ends the process."""
        self._closed = True
        if self._process is not None:
            self._process.close()


def connector(
    programs: Path,
    idle_s: Callable[[], float],
    known: Callable[[], dict[int, str]] = dict,
    recorder: Recorder | None = None,
) -> Connector:
    """Opens real lines and starts simulators; programs found in a controller are kept in `programs`."""

    def connect(address: str, line: LineSettings) -> Opened:
        if not address.startswith(SIMULATOR):
            opener, number = recorded(recorder, partial(open_transport, address, line))
            more = {"program_folder": programs, "idle_limit_s": idle_s(), "known_models": known()}
            return Opened(Controller(opener, kind=Kind.MACHINE, line=line, **more), channel=number)
        name = address.removeprefix(SIMULATOR)
        world = Simulated(name, line)
        opener, number = recorded(recorder, world.open)
        controller = Controller(
            opener, kind=Kind.SIMULATOR, line=line, model=MODELS.get(name), program_folder=programs, own=world
        )
        return Opened(controller, world, number)

    return connect


def recorded(recorder: Recorder | None, opener: Callable[[], Transport]) -> tuple[Callable[[], Transport], int]:
    """The same line with all its bytes recorded, and the number of its channel."""
    if recorder is None:
        return opener, 0
    channel = recorder.channel()
    return channel.tap(opener), channel.number


class Probed:
    """Opens a line for the search: the first time it listens and asks who is there before anything else is sent."""

    def __init__(self, address: str, line: LineSettings) -> None:
        self._address, self._line = address, line
        self._known = False

    def open(self) -> Transport:
        """OpenFailed with a sentence when nobody answers; runs on the link's thread."""
        from device.find import probe

        if not self._known:
            found = probe(self._address, self._line, used_before=True, ask=lambda _: True)  # the person has allowed it
            if isinstance(found, str):
                raise OpenFailed(found)
            self._known = True
        return open_transport(self._address, self._line)


def seeker(
    programs: Path,
    idle_s: Callable[[], float],
    known: Callable[[], dict[int, str]] = dict,
    recorder: Recorder | None = None,
) -> Connector:
    """As `connector`, for ports that may have something else behind them."""

    def connect(address: str, line: LineSettings) -> Opened:
        opener, number = recorded(recorder, Probed(address, line).open)
        return Opened(
            Controller(
                opener,
                kind=Kind.MACHINE,
                line=line,
                program_folder=programs,
                idle_limit_s=idle_s(),
                known_models=known(),
            ),
            channel=number,
        )

    return connect
