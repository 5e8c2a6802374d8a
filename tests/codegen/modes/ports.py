"""Modes of Communication."""

from __future__ import annotations

from codegen.instructions import (
    Communication,
)
from codegen.instructions.flow import EndOf, Routine
from codegen.instructions.records import Baud, Interrupting, Link, PortMode
from tests.codegen.modes.bench import SAMPLES, Mode, Seen, code
from tests.codegen.modes.flow import routine
from tests.codegen.modes.oracles import close, sees

LONG_TEXT = "ABCDEFGHIJKLMNOPQRSTUVWXYZABCDEFGHIJKLMNOPQRSTUVWXYZ"


def sent_at(baud: int) -> object:
    """Characters come out of port 2 ten bits each, as fast as the line allows."""

    def holds(before: Seen, after: Seen, setup: object) -> bool:
        times = [number for number, count in enumerate(after.second_port) if count]
        spent = (times[-1] - times[0] + 1) * after.mode.every / SAMPLES
        return close(spent, sum(after.second_port) * 10 / baud, 0.2 * spent + 0.02)

    return holds


def talks(expected: dict[int, int]) -> object:
    """How many times the routine has been called after what was typed."""
    return sees(lambda b, a: a["N"] == expected[0])


PORTS = (
    *(
        Mode(
            Communication(baud=baud),
            f"Port 2 at {baud.value} baud, for messages and data",
            sent_at(int(baud.value)),  # type: ignore[arg-type]
            then=(code(f'MG {{P2}}"{LONG_TEXT}"\n' * 3),),
            seconds=8 if baud is Baud.B300 else 2,
            every=20,
        )
        for baud in Baud
    ),
    Mode(
        Communication(handshake=True, echo=True),
        "Port 2 at 9600 baud, with handshake, for messages and data, with echo",
        sees(lambda b, a: "Q" in a.sent[2] and "Q" not in b.sent[2] and a.simulation.uarts[1].handshake),
        world=((0.3, "type2", "Q"),),
    ),
    Mode(
        Communication(mode=PortMode.CHAIN, baud=Baud.B19200),
        "Port 2 at 19200 baud, as a daisy chain",
        sees(lambda b, a: passed_on(a) and not passed_on(b)),
    ),
    Mode(
        Communication(what=Link.INTERRUPT, second=Interrupting.CHARACTER),
        "Interrupt by characters: port 1 no interrupt, port 2 on every character",
        sees(lambda b, a: a["N"] == 1),
        first=(code("N=0"),),
        routines=routine(Routine.COMINT, EndOf.COMMUNICATION),  # type: ignore[arg-type]
        world=((0.3, "type2", "A"),),
    ),
    Mode(
        Communication(what=Link.INTERRUPT, second=Interrupting.LINE),
        "Interrupt by characters: port 1 no interrupt, port 2 on Enter",
        sees(lambda b, a: a["N"] == 1 and a["M"] > 500),
        first=(code("N=0\nM=0"),),
        routines=routine(Routine.COMINT, EndOf.COMMUNICATION, "M=TIME-T0"),  # type: ignore[arg-type]
        world=((0.3, "type2", "A"), (0.6, "type2", "B\\r")),
    ),
    *(
        Mode(
            Communication(what=Link.INTERRUPT, first=first, second=Interrupting.NONE, live=True),
            f"Interrupt by characters: port 1 {words}, port 2 no interrupt, live data on port 1",
            sees(lambda b, a, wanted=wanted: abs(a.simulation.state()["variables"]["M"] - wanted) < 60),  # type: ignore[misc]
            first=(code("N=0\nM=0"),),
            then=(code("T0=TIME"),),
            routines=routine(Routine.COMINT, EndOf.COMMUNICATION, "M=TIME"),
            world=((0.3, "type", "A"), (0.6, "type", "B\\r")),
        )
        for first, words, wanted in (
            (Interrupting.CHARACTER, "on every character", 307),  # samples: the first character is enough
            (Interrupting.LINE, "on Enter", 614),
        )
    ),
    Mode(
        Communication(what=Link.INTERRUPT, first=Interrupting.CLEAR, second=Interrupting.CLEAR),
        "Interrupt by characters: port 1 forget what came in, port 2 forget what came in",
        sees(lambda b, a: a["P2CD"] == 0 and a["N"] == 0),
        first=(code("N=0"),),
    ),
    Mode(
        Communication(what=Link.INTERRUPT, second=Interrupting.NONE, live=True),
        "Interrupt by characters: port 1 no interrupt, port 2 no interrupt, live data on port 1",
        sees(lambda b, a: not answers(a) and answers(b)),
    ),
)


def passed_on(seen: Seen) -> bool:
    """Whether port 2 belongs to the chain: what a chain of controllers asks before it passes anything on."""
    return seen.simulation.unit.state.port_two[2] == 1


def answers(seen: Seen) -> bool:
    """Whether a command at port 1 is obeyed; `\\` leaves the mode of live data."""
    simulation = seen.simulation
    simulation.transmit(1)
    simulation.receive(1, b"MG 5\r")
    simulation.advance(300_000)
    return b"5" in simulation.transmit(1)


MODES = (*PORTS,)
