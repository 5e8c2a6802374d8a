"""The way into work: looking for a controller, and everything that can be done without one."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QWidget

from app.connection import Connection, Opened
from app.echo_wish import EchoWish
from app.leaving import Leaving
from app.search import Candidate, Search
from app.settings import Settings
from device.api import Kind, State
from device.transport import LineSettings

if TYPE_CHECKING:
    from widgets.connect.serial_setup import PortShown, SerialChoice, SerialSetup
    from widgets.connect.welcome import Welcome

Ports = Callable[[], list[Candidate]]


class Start(QObject):
    """Owns the welcome window and the serial set-up."""

    setup_wanted = Signal()
    exit_wanted = Signal()
    doctor_wanted = Signal()
    said = Signal(str)

    def __init__(
        self,
        connection: Connection,
        search: Search,
        settings: Settings,
        ports: Ports,
        model: Callable[[], str],
        leaving: Leaving,
        parent: QWidget,
    ) -> None:
        super().__init__(parent)
        self._connection, self._search, self._settings = connection, search, settings
        self._ports, self._model, self._leaving, self._window = ports, model, leaving, parent
        self.echo = EchoWish(connection, self.said.emit)
        self.welcome: Welcome | None = None
        self.serial: SerialSetup | None = None
        search.looking.connect(self._looking)
        search.question.connect(self._question)
        search.found.connect(self._found)
        search.nothing.connect(self._nothing)

    def look(self) -> None:
        """Shows the welcome window and looks for a controller, after asking when the one that is connected works."""
        self._leaving.careful("Look for another controller?", self._look)

    def _look(self) -> None:
        if self._here() is None:  # the port of one that does not answer is tried like any other
            self._connection.go_offline()
        others = [each for each in self._known() if each.device != self._here()]
        if self._here() and not others:
            self._nothing("There is no other serial port on this computer.")
            return
        self.welcome_window().show_looking("Listing the ports of this computer…")
        self._search.start(others, self.line())

    def _here(self) -> str | None:
        """The port of the machine that is connected; None while it does not answer, "" where there is no machine."""
        controller = self._connection.controller
        if controller.kind is not Kind.MACHINE:
            return ""
        return self._connection.address if controller.state is State.READY else None

    def begin(self) -> None:
        """Looks on the ports known from before; where none was ever used, the simulator is there at once."""
        known = [each for each in self._known() if each.used_before]
        if known and self._settings.get("look_at_start"):
            self.welcome_window().show_looking("Listing the ports of this computer…")
            self._search.start(known, self.line())
            return
        self.use_simulator()
        self.said.emit("This is the simulator. Controller > Connect looks for a real controller.")

    def show_serial(self) -> None:
        """Serial communication setup."""
        from widgets.connect.serial_setup import SerialSetup

        if self.serial is not None:
            self.serial.close()
        self.serial = SerialSetup(self.choice(), self._shown(), self._window)
        self.serial.chosen.connect(self._chosen)
        self.serial.search_again.connect(lambda: self.serial is not None and self.serial.show_ports(self._shown()))
        self.serial.show()

    def use_simulator(self, model: str = "") -> None:
        """A simulated controller: of the model that the program is for, where none is named."""
        self._leaving.careful("Use the simulator?", partial(self._simulate, model or self._model()))

    def _simulate(self, model: str) -> None:
        self._search.cancel()
        self._connection.open_simulator(model, LineSettings(baud=self._settings.get("simulator_baud")))
        self._done()

    def disconnect_now(self) -> None:
        """Closes the connection, after asking when the machine works."""
        self._leaving.careful("Disconnect?", self._connection.go_offline)

    def open_port(self, device: str) -> None:
        """A port that was named on the command line, with the settings used last."""
        self._connection.open(device, self.line())
        self._remember(device)

    def connect_at(self, device: str, baud: int) -> None:
        """Where the doctor found a controller: the port and its speed are remembered."""
        self._leaving.careful("Connect to another port?", partial(self._connect_at, device, baud))

    def _connect_at(self, device: str, baud: int) -> None:
        self._settings.set("port", device)
        self._settings.set("baud", baud)
        self._search.cancel()
        self.open_port(device)
        self._done()

    def line(self) -> LineSettings:
        """The serial line as it was set up last."""
        choice = self.choice()
        return LineSettings(
            baud=choice.baud,
            bits=choice.bits,
            parity=choice.parity,
            stop_bits=choice.stop_bits,
            handshake=choice.handshake,
        )

    def choice(self) -> SerialChoice:
        """The same as the serial set-up shows it; the first port where none was ever used."""
        from widgets.connect.serial_setup import SerialChoice

        get = self._settings.get
        ports = self._ports()
        port = get("port") or (ports[0].device if ports else "")
        return SerialChoice(
            port, get("baud"), get("bits"), get("stop_bits"), get("parity"), get("echo"), get("handshake")
        )

    def _chosen(self, choice: SerialChoice) -> None:
        self._leaving.careful("Connect to another port?", partial(self._connect_to, choice))

    def _connect_to(self, choice: SerialChoice) -> None:
        values = {"port": choice.port, "baud": choice.baud, "bits": choice.bits, "stop_bits": choice.stop_bits}
        for key, value in {
            **values,
            "parity": choice.parity,
            "echo": choice.echo,
            "handshake": choice.handshake,
        }.items():
            self._settings.set(key, value)
        self._search.cancel()
        self.echo.choose(choice.port, choice.echo)
        self.open_port(choice.port)
        self._done()

    def _way(self, name: str) -> None:
        ways: dict[str, Callable[[], None]] = {
            "simulator": self.use_simulator,
            "serial": self.show_serial,
            "setup": self._offline_setup,
            "offline": self._offline,
            "again": self.look,
            "doctor": self.doctor_wanted.emit,
            "exit": self.exit_wanted.emit,
            "allow": self._search.allow,
            "skip": self._search.skip,
        }
        ways[name]()

    def _offline(self) -> None:
        self._leaving.careful("Work without a controller?", self._go_offline)

    def _go_offline(self) -> None:
        self._search.cancel()
        self._connection.go_offline()
        self._done()

    def _offline_setup(self) -> None:
        self._leaving.careful("Work without a controller?", self._set_up_offline)

    def _set_up_offline(self) -> None:
        self._go_offline()
        self.setup_wanted.emit()

    def _found(self, candidate: Candidate, opened: Opened) -> None:
        self._remember(candidate.device)
        if self._leaving.left is self._connection.controller:
            self._take(candidate, opened, "")
        else:  # it may have begun to work while the search went on
            self._leaving.check(partial(self._take, candidate, opened))

    def _take(self, candidate: Candidate, opened: Opened, working: str | None) -> None:
        if working == "":
            self._connection.adopt(opened, candidate.device)
            self._done()
            return
        opened.controller.close()
        if working:
            self._nothing(f"A controller answers at {candidate.device}, but the other one works. {working}")

    def _looking(self, sentence: str) -> None:
        if self.welcome is not None:
            self.welcome.show_looking(sentence)

    def _question(self, candidate: Candidate) -> None:
        self.welcome_window().show_question(candidate.device, candidate.words)

    def _nothing(self, sentence: str) -> None:
        here = self._here()
        welcome = self.welcome_window()
        if here:
            welcome.show_nothing(f"{here} stays connected. {sentence}", "No other controller")
        else:
            welcome.show_nothing(sentence)

    @property
    def looking(self) -> bool:
        """Whether the welcome window is open."""
        return self.welcome is not None and self.welcome.isVisible()

    def welcome_window(self) -> Welcome:
        """The welcome window, made when it is first needed."""
        from widgets.connect.welcome import Welcome

        if self.welcome is None:
            self.welcome = Welcome(self._window)
            self.welcome.way.connect(self._way)
            self.welcome.rejected.connect(self._search.cancel)
        self.welcome.show()
        return self.welcome

    def _done(self) -> None:
        if self.welcome is not None:
            self.welcome.hide()

    def _remember(self, device: str) -> None:
        used = self._settings.get("ports_used")
        if device not in used:
            self._settings.set("ports_used", [*used, device])

    def _known(self) -> list[Candidate]:
        used = self._settings.get("ports_used")
        return [Candidate(each.device, each.words, each.device in used) for each in self._ports()]

    def _shown(self) -> list[PortShown]:
        from widgets.connect.serial_setup import PortShown

        return [
            PortShown(each.device, f"{each.device} – {each.words}" if each.words else each.device)
            for each in self._ports()
        ]
