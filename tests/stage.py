"""A whole studio with a fake controller, for tests of the application and for pictures."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from PySide6.QtWidgets import QApplication

import resources
from app.compose import Studio
from app.connection import Opened
from app.search import Candidate
from app.settings import Settings
from app.studio import help_pages
from device.api import Kind, LineSettings, NoticeKind
from tests.fakes import FakeController, FakeWorld, live_row


@dataclass
class Stage:
    """The studio, what it is connected to, and the hands of its clock."""

    studio: Studio
    controllers: list[FakeController]
    world: FakeWorld
    ports: list[Candidate]
    now: list[float] = field(default_factory=lambda: [0.0])

    @property
    def controller(self) -> FakeController:
        """What is connected."""
        controller = self.studio.connection.controller
        assert isinstance(controller, FakeController)
        return controller

    def connect(self, kind: str = "simulator", model: str = "ssc2") -> FakeController:
        """Another fake controller, with live values and the program of the document in it."""
        fake = FakeController(Kind(kind), model)
        fake.row = live_row()
        fake.listing = self.studio.session.listing.text
        self.studio.connection.adopt(Opened(fake, self.world if kind == "simulator" else None), kind)
        return fake

    def go(self, ticks: int = 3) -> None:
        """Some ticks, and what Qt has to do between them."""
        for _ in range(ticks):
            self.studio.tick.once()
            QApplication.processEvents()

    def later(self, now: float) -> None:
        """Sets the clock."""
        self.now[0] = now

    def chatter(self) -> None:
        """A conversation for the terminal and the messages."""
        fake, terminal = self.controller, self.studio.terminal
        for style, text in (
            ("typed", "MG _TPX"),
            ("reply", "6370.0000"),
            ("typed", "PR ,5000,,9"),
            ("said", "LENGTH 10.00"),
        ):
            terminal.write(style, text)
        terminal.write("refused", "PR ,5000,,9: refused, error 4, Operand error.")
        fake.say(NoticeKind.IDENTIFIED, "Connected to SSC2.")
        fake.say(NoticeKind.DOWNLOAD, "Downloaded and verified: 14 lines in 0.4 s.")
        fake.say(NoticeKind.MESSAGE, "LENGTH 10.00")


def make_studio(folder: Path, theme: str = "light", example: str = "wire-cutter.tlp") -> Stage:
    """A studio that is offline, with an example program open, its ports invented and its clock standing still."""
    application = QApplication.instance()
    assert isinstance(application, QApplication)
    settings = Settings(folder / "settings.json")
    settings.set("theme", theme)
    world, controllers, now = FakeWorld(), [], [0.0]
    ports = [Candidate("/dev/ttyUSB0", "USB serial adapter", False)]

    def connect(address: str, line: LineSettings) -> Opened:
        fake = FakeController(Kind.SIMULATOR if address.startswith("simulator") else Kind.MACHINE)
        controllers.append(fake)
        return Opened(fake, world)

    studio = Studio(application, settings, folder, connect, lambda: list(ports), help_pages(), clock=lambda: now[0])
    if example:
        studio.session.open(resources.path(f"examples/{example}"))
    return Stage(studio, controllers, world, ports, now)
