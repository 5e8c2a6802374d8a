"""A machine to bring to life over its byte stream, and how far it really moved, told by the simulation itself."""

from __future__ import annotations

import math
from concurrent.futures import Future
from datetime import datetime
from pathlib import Path
from typing import Any, TypeVar

from device.api import Job
from device.commissioning.judge import Moved
from device.commissioning.moves import Trial, move
from device.simulator.kernel import inputs, layout
from device.simulator.plant import Plant
from device.tasks import Priority, Steps
from tests.device.bench import Bench

T = TypeVar("T")
NOW = datetime(2026, 11, 22, 12, 0)


def bearing(**faults: Any) -> Plant:
    """The motor of chapter 10 with the friction of resources/plants/bench.toml, and what is wrong with it."""
    return Plant(**{"viscous_friction": 2.0e-3, "coulomb_friction": 0.002, **faults})


class Machine(Bench):
    """A bench that remembers how far its load was from where it was."""

    def __init__(self, name: str = "ssc2", plant: Plant | None = None, **more: Any) -> None:
        super().__init__(name, plants={"X": plant or bearing()}, **more)
        self._rest = 0.0
        self.furthest = 0.0  # counts since `rest`
        self._dies: tuple[str, float] | None = None
        self.ready()

    @property
    def place(self) -> float:
        """Where the motor really is, counts, whatever its encoder says."""
        return float(self.simulation.motion._parts[0][layout.MOTOR_X])

    def rest(self) -> None:
        """From here on it is measured."""
        self._rest, self.furthest = self.place, 0.0

    def step(self) -> None:
        super().step()
        self.furthest = max(self.furthest, abs(self.place - self._rest))
        if self._dies is not None and self.furthest >= self._dies[1]:
            self.kill_channel(self._dies[0])

    def dies(self, channel: str, at: float) -> None:
        """A channel of the encoder, "a" or "b", fails once the motor has come so far from `rest`."""
        self._dies = channel, at

    def kill_encoder(self) -> None:
        """Nothing comes from it any more: its plug is out."""
        self.simulation.motion._parts[0][layout.ENCODER_SIGN] = 0.0

    def kill_channel(self, channel: str) -> None:
        """From now on the channel stays low; the counter goes on from where it is."""
        part, number = self.simulation.motion._parts[0], float(" ab".index(channel))
        raw = float(math.floor(part[layout.MOTOR_X] + 0.5))
        part[layout.DEAD_CHANNEL] = number
        part[layout.COUNTS_SHIFT] += (raw - inputs.toggled(raw, number)) * part[layout.ENCODER_SIGN]
        self._dies = None

    def carry_out(self, steps: Steps[T]) -> T:
        future: Future[T] = self.controller.run(steps, Priority.USER, "user")
        return self.result(future)

    def try_move(self, folder: Path, trial: Trial | None = None, job: Job[Moved] | None = None) -> Moved:
        """The polarity move; afterwards the motor coasts until it stands."""
        self.rest()
        moved = self.carry_out(move(self.controller, trial or Trial("X", 300), folder, NOW, job or Job()))
        self.run(3.0)
        return moved

    def registers(self) -> tuple[float, ...]:
        """What a step may change for a while."""
        names = ("OE", "ER", "TL", "FL", "BL", "SP", "AC", "DC", "IT")
        return self.result(self.controller.read(*(f"_{name}X" for name in names)))
