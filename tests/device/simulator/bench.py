"""A simulated controller on a bench: what tests of the simulator type into it and read from it."""

from __future__ import annotations

from codegen.models import model as model_named
from device.simulator.eeprom import Eeprom
from device.simulator.plant import Plant
from device.simulator.simulation import Simulation

MS = 1024  # ticks in a true millisecond
SAMPLE = 1000  # ticks in a sample at TM 1000


class Bench:
    """Port 1 typed by hand, unpaced unless a baud rate is given; interpreted kernel source is not needed here."""

    def __init__(
        self,
        model: str = "ssc4",
        plants: dict[str, Plant] | None = None,
        eeprom: Eeprom | None = None,
        baud: int | None = None,
        handshake: bool = True,
        compiled: bool | None = None,
    ) -> None:
        self.simulation = Simulation(
            model_named(model), plants, eeprom, baud=baud, handshake=handshake, compiled=compiled
        )

    def type(self, text: str, ms: float = 20) -> str:
        """Sends characters, lets time pass, answers what came back."""
        self.simulation.receive(1, text.encode("latin-1"))
        return self.wait(ms)

    def ask(self, command: str) -> str:
        """One command line; its answer without the last prompt and line end."""
        answer = self.type(command + "\r")
        assert answer.endswith(":"), (command, answer)
        return answer[:-1].removesuffix("\r\n")

    def refused(self, command: str) -> int:
        """The error code of a line that must be refused."""
        answer = self.type(command + "\r")
        assert answer.endswith("?"), (command, answer)
        return int(self.ask("TC"))

    def wait(self, ms: float) -> str:
        """Lets true milliseconds pass; answers what port 1 sent."""
        self.simulation.advance(round(ms * MS))
        return self.simulation.transmit(1).decode("latin-1")

    def samples(self, count: int) -> str:
        """Lets samples pass (TM 1000)."""
        self.simulation.advance(count * SAMPLE)
        return self.simulation.transmit(1).decode("latin-1")

    def load(self, program: str) -> None:
        """Puts a program into the memory, one line a line of text."""
        self.simulation.load_program(program.strip("\n"))

    def run(self, program: str, entry: str | int = 0, seconds: float = 60) -> str:
        """Loads and runs a program to its end; answers why it ended."""
        self.load(program)
        self.simulation.execute(entry)
        return self.simulation.run_until_idle(round(seconds * 1000 * MS))

    def texts(self, port: int = 1) -> list[str]:
        """Everything sent unasked so far."""
        return [text for _, number, text in self.simulation.messages if number == port]

    def position(self, axis: int = 0) -> int:
        """Commanded position."""
        return self.simulation.unit.motion.reference(axis)
