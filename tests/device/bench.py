"""A controller facade over a simulated controller in virtual time, stepped by hand: nothing sleeps."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from typing import Any, TypeVar

from codegen.models import model
from device.api import Controller, Kind, State
from device.simulator.plant import Plant
from device.simulator.simulation import Simulation
from device.transport import LineSettings, Transport
from device.transport.loopback import Loopback

T = TypeVar("T")


class Bench:
    """`Bench("ssc4").ready()`: simulation, loopback and controller, with `run_until`."""

    def __init__(
        self,
        name: str = "ssc4",
        baud: int | None = 19200,
        kind: Kind = Kind.SIMULATOR,
        plants: Mapping[str, Plant] | None = None,
        simulation: Any = None,
        address: int | None = None,
        **more: object,
    ) -> None:
        self.simulation = simulation or Simulation(model(name), plants, baud=baud, compiled=True)
        self.loopback = Loopback(self.simulation)
        self.refuse_to_open = False
        self.sent = bytearray()
        self.controller = Controller(
            self._open,
            kind=kind,
            line=LineSettings(baud=baud, address=address),
            clock=self.loopback.clock,
            threaded=False,
            **more,
        )

    def _open(self) -> Transport:
        write = self.loopback.write

        def recorded(data: bytes) -> int:
            self.sent += data
            return write(data)

        self.loopback.write = recorded  # type: ignore[method-assign]
        return self.loopback

    def ready(self) -> Bench:
        self.run_until(lambda: self.controller.state is State.READY, 5.0)
        return self

    def run(self, seconds: float) -> None:
        end = self.loopback.clock() + seconds
        while self.loopback.clock() < end:
            self.step()

    def step(self) -> None:
        """One round of the link; without a line only the controller's time passes."""
        if self.controller.link.transport is None:
            self.simulation.advance(1_024_000 // 20)
        self.controller.link.step()

    def run_until(self, true: Callable[[], bool], seconds: float = 20.0) -> None:
        end = self.loopback.clock() + seconds
        while not true():
            assert self.loopback.clock() < end, f"not within {seconds} s"
            self.step()

    def result(self, future: Future[T], seconds: float = 30.0) -> T:
        self.run_until(future.done, seconds)
        return future.result()

    def ask(self, command: str) -> str:
        reply = self.result(self.controller.ask(command))
        assert reply.accepted, reply
        return reply.text

    def raw(self, data: bytes, seconds: float = 0.1) -> None:
        """Bytes past the link, as if they had been sent before; lets them arrive."""
        self.simulation.receive(1, data)
        self.run(seconds)

    def still(self) -> bool:
        """Whether no axis is commanded and no thread runs, told by the simulation itself."""
        state = self.simulation.state()
        return not any(axis["moving"] for axis in state["axes"].values()) and not any(
            thread["running"] for thread in state["threads"]
        )
