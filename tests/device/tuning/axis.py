"""A simulated axis that is excited and stepped through the commands a technician's studio sends, in virtual time."""

from __future__ import annotations

import numpy
from numpy.typing import NDArray

from device.simulator.motion import Register
from device.simulator.plant import Plant
from device.tuning.excite import Excitation, NotIdentified, excitation
from device.tuning.loop import Gains
from device.tuning.metrics import Response
from device.tuning.recording import TORQUE_STEP, Recording
from tests.device.simulator.bench import Bench

PERIOD = 1 / 1024  # s at TM 1000 (commands.md 7)
ERROR_LIMIT = 16384  # counts, the factory's ER
FAST = 67_107_840  # counts/s², the largest AC


class Axis:
    """X of a controller with this machine; off-on-error is on."""

    def __init__(self, plant: Plant, model: str = "ssc1", late: bool = False, tm: int = 1000) -> None:
        self.bench = Bench(model, {"X": plant})
        if late:  # TP and TE as they are at the end of a sample
            self.bench.simulation.motion.set(0, Register.READ_LATE, 1.0)
        self.channels = self.bench.simulation.model.recorded_channels
        self.gains = Gains()
        self.rows: NDArray[numpy.float64] = numpy.zeros((0, 7))
        self.period = tm / 1_024_000  # s (commands.md 7)
        for line in (f"TM{tm}", "OE1", f"ER{ERROR_LIMIT}", "SH"):
            self.bench.ask(line)
        self.bench.wait(1500)

    def set(self, gains: Gains) -> None:
        """New gains, and time to come to rest."""
        self.bench.ask(f"KP{gains.kp:g};KD{gains.kd:g};KI{gains.ki:g}")
        self.gains = gains
        self.bench.wait(1000)

    def on(self) -> bool:
        """The error limit has not switched it off."""
        return self.bench.ask("MG_MOX{F1.0}").strip() == "0"

    def capture(self, elements: int, channels: tuple[str, ...]) -> None:
        """Chooses arrays and begins to record."""
        names = ["CA", "CB", "CC", "CD"][: len(channels)]
        self.bench.ask("DA*[]")
        self.bench.ask("DM" + ",".join(f"{name}[{elements}]" for name in names))
        self.bench.ask("RA" + ",".join(f"{name}[]" for name in names))
        self.bench.ask("RD" + ",".join(f"_{channel}X" for channel in channels))
        self.bench.simulation.receive(1, f"RC1,{elements}\r".encode())

    def captured(self, elements: int, channels: tuple[str, ...]) -> dict[str, NDArray[numpy.float64]]:
        """Waits for the end of the recording and reads the arrays."""
        while self.bench.ask("MG_RC{F1.0}").strip() != "0":
            self.bench.wait(20)
        found = {}
        for name, channel in zip(("CA", "CB", "CC", "CD"), channels, strict=False):
            values = self.bench.simulation.unit.state.arrays[name]
            found[channel] = numpy.array([value / 65536 for value in values[:elements]])
        return found

    def excited(self, plan: Excitation) -> Recording:
        """Carries out an excitation."""
        self.bench.ask("JG0")
        self.bench.ask("BGX")
        self.capture(plan.elements, plan.channels)
        past = 0.0
        for step in plan.steps:
            self.bench.wait((step.at - past) * 1000)
            past = step.at
            self.bench.simulation.receive(1, f"IP{step.counts}\r".encode())
        self.bench.wait((plan.seconds - past) * 1000)
        found = self.captured(plan.elements, plan.channels)
        self.bench.ask("STX")
        self.bench.wait(500)
        return Recording(
            self.period,
            2**plan.exponent,
            self.gains,
            found["TE"],
            found["TT"] * TORQUE_STEP,
            found.get("TP"),
            tuple(step.counts for step in plan.steps),
        )

    def excite(self, travel: int, elements: int = 1000, seed: int = 0) -> Recording:
        """An excitation with the gains in effect."""
        plan = excitation(self.gains, travel, elements, min(3, self.channels), self.period, seed)
        assert not isinstance(plan, NotIdentified), plan.reason
        return self.excited(plan)

    def step(self, counts: int, elements: int = 500) -> Response:
        """A step of the commanded position: a move with the largest acceleration there is."""
        self.bench.ask(f"SP8000000;AC{FAST};DC{FAST};PR{counts}")
        channels = ("SH", "TP", "TT")[: self.channels]
        begin = int(self.bench.ask("MG_RPX{F10.0}"))
        self.capture(elements, channels)
        self.bench.wait(10)
        self.bench.simulation.motion.trace(2 * elements)
        self.bench.ask("BGX")
        self.bench.wait(elements * 2)
        self.rows = self.bench.simulation.motion.trace_rows().copy()  # every sample, as the simulator knows it
        found = self.captured(elements, channels)
        volts = found.get("TT", numpy.zeros(elements)) * TORQUE_STEP
        return Response(2 * self.period, found["SH"] - begin, found["TP"] - begin, volts)
