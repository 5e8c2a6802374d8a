"""A controller on a simulated machine in this process: every byte is real, time is virtual, nothing is waited for."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future
from typing import Any, TypeVar

from codegen.models import model as model_named
from device.api import Controller, Kind, LineSettings, State
from device.door import LEAVE
from device.simulator.plant import Plant
from device.simulator.scenes import set_up
from device.simulator.simulation import Simulation
from device.transport import OpenFailed, Transport
from device.transport.loopback import Loopback

T = TypeVar("T")
LINE = LineSettings(baud=int(os.environ.get("TEST_BAUD", "19200")))  # tests/app/test_other_speeds.py asks for others
# the compiled loop once it is worth its loading, or never: loading it would be seen where time is measured
COMPILED = None if os.environ.get("TEST_COMPILED") else False
ROUND_TICKS = 1_024_000 // 20  # time that passes in a round without a line


class Recorded(Loopback):
    """A loopback that keeps what was written."""

    def __init__(self, simulation: Simulation) -> None:
        super().__init__(simulation)
        self.written = bytearray()

    def write(self, data: bytes) -> int:
        self.written += data
        return super().write(data)


class Rig:
    """Simulation, line and controller facade; `run` lets time pass on all of them."""

    def __init__(
        self,
        kind: Kind | str = Kind.SIMULATOR,
        model: str = "ssc2",
        *,
        scene: str = "",
        program: str = "",
        revision: str = "",
        silent: bool = False,
        openable: bool = True,
        plants: Mapping[str, Plant] | None = None,
        line: LineSettings = LINE,
        began: float = 0.0,
        tap: Callable[[Transport], Transport] = lambda line: line,
        there: Simulation | None = None,  # the machine has been on for a while, with somebody else at its port
        **more: Any,
    ) -> None:
        self.simulation = there or Simulation(model_named(model), plants, baud=line.baud, compiled=COMPILED)
        self.began, self.openable, self._tap = began - self.simulation.ticks / 1_024_000, openable, tap
        if revision:
            self.simulation.unit.revision = lambda: revision  # type: ignore[method-assign]
        if program:
            self.simulation.load_program(program)
        if scene:
            set_up(self.simulation, scene)
            self.simulation.transmit(1)  # said before anybody listened
        self.loopback = Recorded(self.simulation)
        self.loopback.unplugged = silent
        more.setdefault("known_models", {})
        self.controller = Controller(self._open, kind=Kind(kind), line=line, clock=self.clock, threaded=False, **more)

    def clock(self) -> float:
        """Seconds, from the moment of the stage in which it was switched on."""
        return self.began + self.simulation.ticks / 1_024_000

    @property
    def closed(self) -> bool:
        return self.controller.state is State.OFFLINE

    def run_to(self, moment: float) -> None:
        """Lets the link work until the clock shows this moment."""
        while self.clock() < moment and not self.closed:
            self._step()

    def run(self, seconds: float) -> None:
        self.run_to(self.clock() + seconds)

    def until(self, true: Callable[[], object], seconds: float = 20.0) -> None:
        """Lets time pass until it is true; a failure when that takes too long."""
        end = self.clock() + seconds
        while not true():
            assert self.clock() < end, f"not within {seconds:g} s"
            self._step()

    def ready(self) -> Rig:
        self.until(lambda: self.controller.state is State.READY, 5.0)
        return self

    def result(self, future: Future[T]) -> T:
        self.until(future.done)
        return future.result()

    def type(self, *commands: str) -> None:
        """Commands a person types; each must be accepted."""
        for command in commands:
            reply = self.result(self.controller.ask(command))
            assert reply.accepted, reply

    def start(self, program: str, target: str | int = 0) -> None:
        """A program that is in the machine already begins to run, as if started at power-up."""
        self.simulation.load_program(program)
        self.simulation.execute(target)

    def values(self, keys: Iterable[str]) -> Rig:
        """Waits until all of these have been read afresh."""
        wanted, now = tuple(keys), self.clock()
        self.controller.watch("test", wanted)
        self.until(lambda: all(self.controller.last().time(key) > now for key in wanted))
        return self

    def cut(self) -> None:
        """The cable is out."""
        self.loopback.unplugged = True

    def wear_out(self, text: str, becomes: str) -> None:
        """The program memory keeps something else than what was sent."""
        unit = self.simulation.unit
        store = unit.set_program
        unit.set_program = lambda lines: store(  # type: ignore[method-assign]
            tuple(line.replace(text, becomes) for line in lines)
        )

    @property
    def lines(self) -> list[str]:
        """Every line that left for the controller."""
        return bytes(self.loopback.written).decode("ascii").split("\r")

    @property
    def stops(self) -> list[str]:
        """The stops that left, ST or AB, in their order; the two words of a line that may be half typed are one."""
        told = [each.text for each in self.controller.traffic() if each.source == "stop" and each.direction == ">"]
        told = [text for text in told if ";HX;" not in text]  # the proof, which says it once more
        words = [re.findall(r"\b(ST|AB)\b", text.replace(LEAVE.decode("ascii"), " ")) for text in told]
        return [each[0] for each in words if each]

    def sent(self, pattern: str) -> list[str]:
        """What a person or a button sent, as far as it matches."""
        told = [each.text for each in self.controller.traffic() if each.source == "user" and each.direction == ">"]
        return [text for text in told if re.match(pattern, text)]

    @property
    def program(self) -> list[str]:
        """The lines in the program memory."""
        return list(self.simulation.unit.state.program)

    @property
    def running(self) -> list[int]:
        """Lines of the running threads, told by the simulation itself."""
        return [thread["line"] for thread in self.simulation.state()["threads"] if thread["running"]]

    @property
    def moving(self) -> list[str]:
        """Axes that are commanded to move, told by the simulation itself."""
        return [letter for letter, axis in self.simulation.state()["axes"].items() if axis["moving"]]

    def _open(self) -> Transport:
        if not self.openable:
            raise OpenFailed("There is no such port.")
        return self._tap(self.loopback)

    def _step(self) -> None:
        if self.controller.link.transport is None:
            self.simulation.advance(ROUND_TICKS)
        self.controller.link.step()
