"""Which bit of a recorded or watched number is what, and how it is called (pure): the one list of the bits of TS."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from codegen.models import Model
    from codegen.setup import Setup
    from device.capture import Channel

USUAL = 8  # inputs and outputs of a controller that is not known


@dataclass(frozen=True, slots=True)
class Bit:
    """One bit: `number` 0 is the lowest; `inverted`: 1 says that it is not so; `words`: its levels as they are read."""

    number: int
    label: str
    inverted: bool = False
    recorded: bool = True  # RD's copy has it too
    words: tuple[str, str] = ("off", "on")

    def on(self, words: Any) -> Any:
        """Of whole numbers, one or an array of them."""
        return ((words >> self.number & 1) == 1) != self.inverted


# TS of an axis (commands.md 4; recorded ones have bits 0 to 4 only, dmc-1412-1414.txt l.3433)
MOVING = Bit(7, "Moving", recorded=False)
ERROR = Bit(6, "Error above ER", recorded=False)
MOTOR = Bit(5, "Motor", inverted=True, recorded=False)
FORWARD = Bit(3, "Forward limit", inverted=True, words=("free", "at limit"))
REVERSE = Bit(2, "Reverse limit", inverted=True, words=("free", "at limit"))
HOME = Bit(1, "Home", words=("0", "1"))
LATCH = Bit(0, "Latch", inverted=True, words=("not armed", "armed"))
SWITCHES = (FORWARD, REVERSE, HOME, LATCH, MOTOR, ERROR, MOVING)
# The status word that RD records of an axis (commands.md 4: inferred from a later family)
STATUS_MOVING = Bit(15, "Moving")
STATUS = (
    STATUS_MOVING, Bit(14, "Mode PA or PR"), Bit(13, "Mode PA"), Bit(12, "Find edge"), Bit(11, "Homing"),
    Bit(10, "First phase of HM done"), Bit(9, "Second phase of HM, or FI"), Bit(8, "Coordinated"),
    Bit(7, "Negative direction"), Bit(6, "Contour mode"), Bit(5, "At speed"), Bit(4, "Stopping by ST or limit"),
    Bit(3, "Final deceleration"), Bit(2, "Latch armed"), Bit(1, "OE armed"), Bit(0, "Motor", inverted=True),
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Signal:
    """A bit of a channel as the person calls it; `named`: by the setup."""

    label: str
    bit: Bit
    named: bool = False


def signals(channel: Channel, setup: Setup | None, model: Model | None, live: bool = False) -> tuple[Signal, ...]:
    """Every bit of a channel that says something; none where it is no number of bits. `live`: as TS tells it."""
    axis = f" {channel.axis}" if channel.axis else ""
    if channel.what == "switches":
        return tuple(Signal(bit.label + axis, bit) for bit in SWITCHES if live or bit.recorded)
    if channel.what == "axis_status":
        return tuple(Signal(bit.label + axis, bit) for bit in STATUS)
    if channel.what == "inputs":  # bit 0 is input 1 (commands.md, TI)
        return _numbered("Input", model.inputs if model else USUAL, setup.input_names if setup else ())
    if channel.what == "outputs":  # OP 6 sets outputs 2 and 3 (dmc-1412-1414.txt l.3928)
        return _numbered("Output", model.outputs if model else USUAL, setup.output_names if setup else ())
    return ()


def _numbered(word: str, count: int, names: Sequence[str]) -> tuple[Signal, ...]:
    found = []
    for place in range(count):
        name = names[place] if place < len(names) else ""
        label = f"{word} {place + 1}"
        found.append(Signal(f"{label} {name}".rstrip(), Bit(place, label), bool(name)))
    return tuple(found)


def worth(
    known: Sequence[Signal], wanted: Collection[int] | None, changed: Collection[int], live: bool = False
) -> tuple[Signal, ...]:
    """Those that are drawn: the wanted bits; None: those that changed or have a name, all where there is neither.

    Live, where nothing is known of the future, those without names are all drawn until one of them has a name.
    """
    if wanted is not None:
        return tuple(each for each in known if each.bit.number in wanted)
    named = any(each.named for each in known)
    if live and not named:
        return tuple(known)
    return tuple(each for each in known if each.named or each.bit.number in changed) or tuple(known)
