"""A simulated controller of our own, in its own process."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from device.simulator.process import SimulatorProcess
from device.transport import LineSettings, OpenFailed, Transport, open_transport


class OwnSimulator:
    """A simulated controller in a process of its own, started by the link's thread when it is first needed."""

    def __init__(
        self, model: str, plant: Path | None = None, eeprom: Path | None = None, profile: Path | None = None
    ) -> None:
        self._model, self._plant, self._eeprom, self._profile = model, plant, eeprom, profile
        self._process: SimulatorProcess | None = None
        self._closed = False

    def open(self, line: LineSettings) -> Transport:
        """The line to it; starts it, also again when it has ended."""
        if self._closed:
            raise OpenFailed("The simulator was closed.")
        if self._process is not None:
            try:
                return open_transport(self._process.address, line)
            except OpenFailed:
                self._process.close()
        try:
            self._process = SimulatorProcess(
                self._model, plant=self._plant, eeprom=self._eeprom, profile=self._profile, baud=line.baud
            )
        except OSError as reason:
            raise OpenFailed(f"The simulator did not start ({reason}).") from reason
        return open_transport(self._process.address, line)

    def stimulus(self, signal: str, value: float | str) -> None:
        """Something happens to the simulated machine (an input, a limit switch, a push)."""
        if self._process is not None:
            self._process.stimulus(signal, value)

    def state(self) -> dict[str, Any]:
        """What the simulation knows of itself; empty before it runs."""
        return self._process.state() if self._process is not None else {}

    def close(self) -> None:
        self._closed = True
        if self._process is not None:
            self._process.close()
