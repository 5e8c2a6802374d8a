"""A daisy chain: up to eight simulated controllers, port 2 of each on port 1 of the next (dmc-1412-1414.txt l.1300)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

from codegen.models import Model
from codegen.twoletter.fixed import ONE
from device.simulator.eeprom import Eeprom
from device.simulator.motion import Motion
from device.simulator.plant import Plant
from device.simulator.server import MOST_IN_CHAIN
from device.simulator.simulation import Simulation
from device.simulator.times import TICKS_PER_MS
from device.simulator.twoletter import burned
from device.simulator.twoletter.profile import Profile
from device.simulator.uart import Uart

PORT_TWO_BAUD: Final = 9600
GRID: Final = TICKS_PER_MS  # a character needs so many ticks from one controller to the next


class Chain:
    """The host's line ends at the first one; what is served looks like one controller with `%n` and `!`."""

    def __init__(self, units: Sequence[Simulation]) -> None:
        if not 1 <= len(units) <= MOST_IN_CHAIN:
            raise ValueError(f"a daisy chain of {len(units)}: 1 to {MOST_IN_CHAIN} controllers")
        self.units = tuple(units)
        for place, simulation in enumerate(self.units):
            _set_up(simulation, place, last=place == len(self.units) - 1)

    # -------------------------------------------------------------------- time

    @property
    def ticks(self) -> int:
        """Virtual time, the same on all."""
        return self.units[0].ticks

    def advance(self, ticks: int) -> None:
        """Carries out everything up to and including `ticks` from now; the same at any slicing."""
        end = self.ticks + ticks
        while self.ticks < end:
            step = min(end, (self.ticks // GRID + 1) * GRID) - self.ticks
            for simulation in self.units:
                simulation.advance(step)
            if self.ticks % GRID == 0:
                self._carry()
                self._share_clock()

    def _share_clock(self) -> None:
        """Those with a negative TM sample with the one that has a clock of its own (SSC manual l.1231)."""
        units = [simulation.unit for simulation in self.units]
        takers = [unit for unit in units if unit.state.settings["TM"] < 0]
        sources = [unit for unit in units if unit.state.settings["TM"] > 0]
        for unit in takers if sources else ():
            unit.take_clock(sources[0].clock)

    def _carry(self) -> None:
        """What is on the wires between the controllers reaches their other ends."""
        for near, far in zip(self.units, self.units[1:], strict=False):
            passes = _passes_on(near)
            there = near.port.take_passed() + near.transmit(2)
            back = far.transmit(1)
            if there:
                far.receive(1, there)
            if back and passes:
                near.port.send(back, near.ticks)
            elif back:
                near.receive(2, back)
            near.port.passing = passes

    def rest(self, records: int) -> None:
        """Between two slices of real time."""
        for simulation in self.units:
            simulation.rest(records)

    # ------------------------------------------------------------------- bytes

    @property
    def port(self) -> Uart:
        """Port 1 of the first one: the host's line."""
        return self.units[0].port

    @property
    def motions(self) -> tuple[Motion, ...]:
        """The motion of all."""
        return tuple(simulation.motion for simulation in self.units)

    def line(self, port: int) -> Uart:
        """Port 1 of the first one or port 2 of the last one: the ends of the chain."""
        return self._end(port).line(port)

    def receive(self, port: int, data: bytes) -> None:
        """Characters handed to an end of the chain."""
        self._end(port).receive(port, data)

    def transmit(self, port: int) -> bytes:
        """Characters that have left an end of the chain."""
        return self._end(port).transmit(port)

    def _end(self, port: int) -> Simulation:
        return self.units[0 if port == 1 else -1]

    # ----------------------------------------------------------- outside world

    def stimulus(self, signal: str, value: float | str) -> None:
        """`in1` on the first one, `1:in1` on the second, and so on by place."""
        place, colon, name = signal.rpartition(":")
        if not colon:
            self.units[0].stimulus(signal, value)
        elif place.isdecimal() and int(place) < len(self.units):
            self.units[int(place)].stimulus(name, value)
        else:
            raise KeyError(f"no controller {place} in the chain; there are 0 to {len(self.units) - 1}")

    def state(self) -> dict[str, Any]:
        """The state of the first one, and of all under `chain`."""
        states = [simulation.state() for simulation in self.units]
        return {**states[0], "chain": states}


def _passes_on(simulation: Simulation) -> bool:
    """CC with r = 1: port 2 carries the chain."""
    return simulation.unit.state.port_two[2] == 1


def _set_up(simulation: Simulation, place: int, *, last: bool) -> None:
    """As installed: addresses in order and CC on all but the last, both burned (l.1303, l.1310)."""
    unit = simulation.unit
    unit.chained, unit.jumper_address = True, place
    if unit.eeprom.part("parameters") is None:
        unit.state.settings["SA"] = place * ONE
        unit.state.port_two = [PORT_TWO_BAUD, 0, int(not last), 0]
        unit.open_port_two()
        try:
            unit.eeprom.burn(parameters=burned.parameters(unit))
        except OSError as reason:
            unit.notice(f"the EEPROM file cannot be written: {reason.strerror or reason}")
    unit.choose_at_start()
    simulation.port.passing = _passes_on(simulation)


def make_chain(
    model: Model,
    plants: Mapping[str, Plant] | None,
    eeproms: Sequence[Eeprom],
    *,
    baud: int | None = None,
    seed: int = 0,
    compiled: bool | None = None,
    handshake: bool = True,
    profile: Profile | None = None,
) -> Chain:
    """A chain of the same controllers with the same machines."""
    return Chain(
        [
            Simulation(model, plants, eeprom, baud, seed + place, compiled, handshake, profile)
            for place, eeprom in enumerate(eeproms)
        ]
    )
