"""A whole studio on simulated controllers in virtual time, for tests of the application and for pictures."""

from __future__ import annotations

import shutil
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import shiboken6
from PySide6.QtCore import QObject
from PySide6.QtWidgets import QApplication

import resources
from app.compose import Studio
from app.connection import Opened
from app.help_pages import Pages
from app.search import Candidate
from app.settings import Settings
from app.which_model import known_models
from device.api import Badge, Controller, Kind, LineSettings, State
from device.recorder import Recorder
from device.transport import Transport
from device.transport.loopback import Loopback
from tests.rig import Rig
from widgets.parts.pieces import Pieces

TICK_S = 0.033
PATIENCE_S = 60.0  # true ones, for threads
SHORT_LIVED = ("background", "code check", "file on disk", "ports", "port 2", "loading", "leaving")  # threads
ASKS = 12  # the line of the question
LENGTH = "\n".join(["#A", *(f"N={number}" for number in range(1, ASKS)), 'IN "Length?",LEN', "JP #A,LEN<0", "EN"])


class SimulatedWorld:
    """The outside of a simulated machine in this process, its port 2 too."""

    def __init__(self, rig: Rig) -> None:
        self._simulation = rig.simulation
        self.stimulus, self.state = rig.simulation.stimulus, rig.simulation.state

    def second(self) -> Transport:
        """Port 2; time passes by the stage's clock, not by reading."""
        return PortTwo(self._simulation)


class PortTwo(Loopback):
    """Bytes of port 2, without waiting."""

    def read(self, timeout_s: float) -> bytes:
        return self.simulation.transmit(2)

    def write(self, data: bytes) -> int:
        self.simulation.receive(2, data)
        return len(data)


class WhenWanted(Pieces):
    """Panels at the machine as nobody has wanted them yet: no tick makes them, whoever asks for one does."""

    def __init__(self, pieces: Pieces) -> None:
        self._pieces = pieces
        self.done = pieces.done

    def step(self) -> bool:
        return self.done

    def wanted(self) -> bool:
        self.finish()
        return True

    def finish(self) -> None:
        if not self.done:
            self._pieces.finish()
            self.done = True


class Clock:
    """The time of the stage; controllers run along."""

    def __init__(self) -> None:
        self.now = 0.0
        self.rigs: list[Rig] = []

    def __call__(self) -> float:
        return self.now

    def add(self, rig: Rig) -> Rig:
        self.rigs.append(rig)
        return rig

    def pass_by(self, seconds: float) -> None:
        end = self.now + seconds
        for rig in self.rigs:
            rig.run_to(end)
        self.now = max([end, *(rig.clock() for rig in self.rigs if not rig.closed)])


@dataclass
class Stage:
    """The studio, what it is connected to, and the hands of its clock."""

    studio: Studio
    clock: Clock
    ports: list[Candidate]
    silent: set[str] = field(default_factory=set)  # ports at which nobody answers

    @property
    def controller(self) -> Controller:
        """What is connected."""
        return self.studio.connection.controller

    @property
    def rigs(self) -> list[Rig]:
        """Every simulated machine that was ever opened."""
        return self.clock.rigs

    @property
    def rig(self) -> Rig:
        """The simulated machine behind what is connected."""
        return next(rig for rig in self.rigs if rig.controller is self.controller)

    @property
    def controllers(self) -> list[Controller]:
        return [rig.controller for rig in self.rigs]

    def connect(self, kind: str = "simulator", model: str = "ssc2", answers: bool = True, **more: Any) -> Rig:
        """Another machine, in the situation that is asked for; waits until it has answered."""
        rig = self.machine(kind, model, **more)()
        if answers:
            self.until(lambda: rig.controller.state is State.READY)
        return rig

    def machine(self, kind: str, model: str, **more: Any) -> Callable[[], Rig]:
        """A simulated machine, ready made; what comes back connects the studio to it, and that is the studio's work."""
        channel = self.studio.recorder.channel()
        rig = self.clock.add(Rig(kind, model, began=self.clock.now, tap=channel.wrap, **more))
        world = SimulatedWorld(rig) if kind == "simulator" else None

        def plug() -> Rig:
            self.studio.connection.adopt(Opened(rig.controller, world, channel.number), kind)
            return rig

        return plug

    def go(self, ticks: int = 3) -> None:
        """Some ticks, and what Qt has to do between them."""
        for _ in range(ticks):
            self.clock.pass_by(TICK_S)
            self.studio.tick.once()
            if not isinstance(self.studio.late.making, WhenWanted):
                self.studio.late.making.finish()  # as after the first half second
            for panel in self.studio.panels:
                if panel.in_sight:
                    panel.making.finish()
            QApplication.processEvents()

    def until(self, true: Callable[[], object], seconds: float = 20.0) -> None:
        """Ticks until it is true; a failure when that takes too long, besides what threads of their own take."""
        end, patience = self.clock.now + seconds, time.monotonic() + PATIENCE_S
        while not true():
            if self.beside and time.monotonic() < patience:
                time.sleep(0.001)
                end += TICK_S
            assert self.clock.now < end, f"not within {seconds:g} s"
            self.go(1)

    @property
    def beside(self) -> bool:
        """Whether something works in a thread of its own, which has no part in the time of the stage."""
        return self.studio.tick.writing or any(each.name.startswith(SHORT_LIVED) for each in threading.enumerate())

    def later(self, seconds: float) -> None:
        """Much time passes between two ticks."""
        self.clock.pass_by(seconds)

    def download(self) -> Rig:
        """Control is taken, and the open program is in the controller, verified."""
        self.controller.take_control()
        self.studio.run.download()
        self.until(lambda: self.controller.program_badge is Badge.SAME and not self.studio.run.doing)
        return self.rig

    def question(self, kind: str = "machine", model: str = "ssc2") -> Rig:
        """A machine whose program was started from here and asks for a length."""
        rig = self.connect(kind, model, program=LENGTH)
        rig.controller.take_control()
        rig.controller.execute(anyway=True)
        self.until(lambda: rig.controller.pending_prompt is not None)
        return rig

    def clear_away(self) -> None:
        """The end: nothing of the studio stays in memory, though slots are referred to where Python cannot see it."""
        self.studio.close()
        self.studio.window.hide()
        for each in parts_of(self.studio):
            if shiboken6.isValid(each) and each.parent() in (None, QApplication.instance()):
                shiboken6.delete(each)

    def type(self, *commands: str) -> None:
        """Commands typed into the terminal, and what came of them."""
        terminal = self.studio.terminal
        self.studio.desk.bring("Terminal")
        self.go()
        for command in commands:
            count = terminal.log.blockCount()
            terminal.line.setText(command)
            terminal.send.click()
            self.until(lambda count=count: terminal.log.blockCount() >= count + 2)


def parts_of(studio: Studio) -> list[QObject]:
    """Every Qt object that the studio or one of its parts has as an attribute, or in one."""
    found: dict[int, Any] = {}
    waiting: list[Any] = [studio]
    while waiting:
        part = waiting.pop()
        if id(part) in found:
            continue
        found[id(part)] = part
        for value in list(getattr(part, "__dict__", {}).values()):
            several = value.values() if isinstance(value, dict) else value
            for each in list(several) if isinstance(value, dict | list | tuple | set) else [value]:
                if isinstance(each, QObject) or type(each).__module__.startswith(("app.", "widgets.")):
                    waiting.append(each)
    return [part for part in found.values() if isinstance(part, QObject) and part is not QApplication.instance()]


def make_studio(folder: Path, theme: str = "light", example: str = "wire-cutter.tlp") -> Stage:
    """A studio that is offline, with an example program open, its ports invented and its time in our hands."""
    application = QApplication.instance()
    assert isinstance(application, QApplication)
    settings = Settings(folder / "settings.json")
    settings.set("theme", theme)
    clock, silent = Clock(), set[str]()
    ports = [Candidate("/dev/ttyUSB0", "USB serial adapter", False)]

    recorder = Recorder(folder / "recordings", clock=clock, threaded=False)

    def connect(address: str, line: LineSettings) -> Opened:
        simulated = address.startswith("simulator:")
        channel = recorder.channel()
        rig = Rig(
            Kind.SIMULATOR if simulated else Kind.MACHINE,
            address.partition(":")[2] if simulated else "ssc2",
            line=line,
            began=clock.now,
            silent=address in silent,
            known_models=known_models(settings),
            tap=channel.wrap,
        )
        clock.add(rig)
        return Opened(rig.controller, SimulatedWorld(rig) if simulated else None, channel.number)

    studio = Studio(
        application, settings, folder, connect, lambda: list(ports), Pages(), clock=clock, recorder=recorder
    )
    if example:  # a copy: whatever is clicked, the one that is shipped stays as it is
        studio.session.open(Path(shutil.copy(resources.path(f"examples/{example}"), folder)))
    return Stage(studio, clock, ports, silent)
