"""Named starting situations of the simulator, set up in a moment: for tests, panels and demonstrations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from device.simulator.times import TICKS_PER_MS

if TYPE_CHECKING:
    from device.simulator.simulation import Simulation


@dataclass(frozen=True, slots=True)
class Scene:
    """A situation: what it is called, what one sees, and how it comes about."""

    name: str
    title: str
    commands: str = ""  # typed at port 1
    stimuli: tuple[tuple[str, float], ...] = ()  # after the commands
    program: str = ""  # loaded before
    ms: int = 20  # true milliseconds that pass afterwards


SCENES: Final[tuple[Scene, ...]] = (
    Scene("rest", "Switched on, nothing has happened"),
    Scene("forward_limit", "X stands in its forward limit switch", stimuli=(("fls_x", 0),)),
    Scene("reverse_limit", "X stands in its reverse limit switch", stimuli=(("rls_x", 0),)),
    Scene("motor_off", "The motor of X is off", "MOX"),
    Scene("following_error", "X was pushed beyond ER and is off", "ER 100;OE 1", (("position_x", 500),)),
    Scene("half_way", "X is half-way through a move of 20 000 counts", "DP 0;SP 20000;PR 20000;BGX", ms=540),
    Scene("jogging", "X jogs at 5000 counts/s", "JG 5000;BGX", ms=200),
    Scene("abort", "The abort input is active", stimuli=(("abort", 0),)),
    Scene("refused", "The last command was refused", "bg"),
    Scene("running", "A program runs in thread 0", "XQ#A", program="#A\nN=0\n#L\nN=N+1\nWT 10\nJP#L"),
    Scene("prompt", "A program waits for an answer", "XQ#A", program='#A\nIN "LENGTH",LEN\nEN'),
    Scene("program_error", "A program has stopped at an error", "XQ#A", program="#A\nPR 1000;BGX\nPR 5000\nEN"),
    Scene("input_wait", "A program waits for input 1 to go low", "XQ#A", program="#A\nAI-1\nSB1\nEN"),
)


def scene(name: str) -> Scene:
    """A scene by name; KeyError says which there are."""
    for known in SCENES:
        if known.name == name:
            return known
    raise KeyError(f"no scene {name!r}; there are {' '.join(known.name for known in SCENES)}")


def set_up(simulation: Simulation, name: str, wait: Callable[[int], None] | None = None) -> None:
    """Brings a freshly made simulation into the situation; `wait` lets ticks pass (default: virtual time)."""
    wanted = scene(name)
    passing = wait or simulation.advance
    if wanted.program:
        simulation.load_program(wanted.program)
    if wanted.commands:
        simulation.receive(1, wanted.commands.encode("ascii") + b"\r")
        passing(20 * TICKS_PER_MS)
    for signal, value in wanted.stimuli:
        simulation.stimulus(signal, value)
    passing(wanted.ms * TICKS_PER_MS)
