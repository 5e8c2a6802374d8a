"""A simulated controller in a process of its own, for the studio and for tests."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any, Final

import device

ENDING_S: Final = 2.0


class SimulatorFailed(OSError):
    """The simulator process did not come up, or has ended."""


class SimulatorProcess:
    """`python -m device.simulator` and its control lines; `close` ends it."""

    def __init__(
        self,
        model: str = "ssc4",
        *,
        pty: bool = False,
        baud: int | None = None,
        plant: Path | None = None,
        eeprom: Path | None = None,
        tcp: str = "127.0.0.1:0",
        handshake: bool = True,
        chain: int | None = None,
        port2: str | None = None,
        profile: Path | None = None,
    ) -> None:
        command = [sys.executable, "-m", "device.simulator", "--control", "--controller", model]
        command += ["--pty"] if pty else ["--tcp", tcp]
        command += ["--baud", str(baud)] if baud else []
        command += ["--plant", str(plant)] if plant else []
        command += ["--eeprom", str(eeprom)] if eeprom else []
        command += ["--chain", str(chain)] if chain else []
        command += [] if handshake else ["--no-handshake"]
        command += ["--port2", port2] if port2 else []
        command += ["--profile", str(profile)] if profile else []
        self._process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=_environment(),
            **_own_group(),
        )
        self.address = self._address("listening on ")
        self.address2 = self._address("port 2 on ") if port2 else ""

    @property
    def pid(self) -> int:
        return self._process.pid

    def stimulus(self, signal: str, value: float | str) -> None:
        """Something happens to the machine within a slice (5 ms); does not wait for it."""
        self._ask(f"{signal},{value}", answer=False)

    def state(self) -> dict[str, Any]:
        """The state, as `run --json` prints it."""
        found: dict[str, Any] = json.loads(self._ask("state", answer=True))
        return found

    def close(self) -> None:
        """Ends the process: asked first, then forced."""
        if self._process.stdin is not None and not self._process.stdin.closed:
            self._quietly(self._process.stdin.close)
        try:
            self._process.wait(ENDING_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        if self._process.stdout is not None:
            self._process.stdout.close()

    def __enter__(self) -> SimulatorProcess:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _address(self, announced: str) -> str:
        assert self._process.stdout is not None
        first = self._process.stdout.readline().strip()
        place = first.removeprefix(announced)
        if not first or place == first:
            self.close()
            raise SimulatorFailed("the simulator did not start")
        return place if place.startswith("/") else f"socket://{place}"

    def _ask(self, line: str, *, answer: bool) -> str:
        assert self._process.stdin is not None and self._process.stdout is not None
        try:
            self._process.stdin.write(line.replace("\r", "\\r").replace("\n", "\\n") + "\n")
            self._process.stdin.flush()
        except (OSError, ValueError) as reason:
            raise SimulatorFailed("the simulator has ended") from reason
        text = self._process.stdout.readline() if answer else ""
        if answer and not text:
            raise SimulatorFailed("the simulator has ended")
        return text

    @staticmethod
    def _quietly(action: Callable[[], None]) -> None:
        try:
            action()
        except OSError:  # the pipe's other end has gone, which is what was wanted
            return


def _environment() -> dict[str, str]:
    root = str(Path(device.__file__).resolve().parents[1])
    path = os.environ.get("PYTHONPATH", "")
    return {**os.environ, "PYTHONPATH": os.pathsep.join([root, path] if path else [root])}


def _own_group() -> dict[str, Any]:
    """Ctrl-C in the studio's terminal is not the simulator's."""
    if sys.platform == "win32":
        return {"creationflags": getattr(subprocess, "CREATE_NO_WINDOW", 0)}
    return {"start_new_session": True}
