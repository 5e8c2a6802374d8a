"""What the commands do, one group of commands a module: DOES, READS, WAITS, COMPILES."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Final, TypeAlias

from codegen.twoletter.nodes import Command
from device.simulator.twoletter.behaviour import (
    commutation,
    configuration,
    flow,
    following,
    io,
    messages,
    motion,
    operator,
    programs,
    recording,
    sequences,
    status,
    system,
    trippoints,
)
from device.simulator.twoletter.state import Strand, Wait

if TYPE_CHECKING:
    from device.simulator.twoletter.calls import Call
    from device.simulator.twoletter.compile import Code
    from device.simulator.twoletter.unit import Unit

Op: TypeAlias = Callable[[Strand], int]

DOES: Final[dict[str, Callable[[Unit, Strand, Call], None]]] = {
    **motion.DOES,
    **flow.DOES,
    **io.DOES,
    **status.DOES,
    **configuration.DOES,
    **system.DOES,
    **programs.DOES,
    **operator.DOES,
    **following.DOES,
    **sequences.DOES,
    **recording.DOES,
    **commutation.DOES,
}
READS: Final[dict[str, Callable[[Unit, int], int]]] = {
    **motion.READS,
    **flow.READS,
    **io.READS,
    **status.READS,
    **configuration.READS,
    **following.READS,
    **sequences.READS,
    **recording.READS,
    **commutation.READS,
}
ASKED: Final[dict[str, Callable[[Unit, int], int]]] = {}
WAITS: Final = {**trippoints.WAITS, **following.WAITS, **sequences.WAITS}
ENDS: Final[dict[str, Callable[[Unit, Strand, Wait], None]]] = {**commutation.ENDS}
"""What goes on when a wait of this kind is over; it may wait again or refuse."""
COMPILES: Final[dict[str, Callable[[Command, int, Unit, Code | None], Op]]] = {
    **flow.COMPILES,
    **configuration.COMPILES,
    **messages.COMPILES,
    **programs.COMPILES,
}
KEYWORDS = operator.KEYWORDS
