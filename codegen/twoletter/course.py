"""What two-letter code written by hand does to the places of the axes, as far as it is clear."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

from codegen.fields import AXES, Dimension
from codegen.laps import FINEST, Course, Item, Mark
from codegen.setup import Setup
from codegen.twoletter.fixed import ONE
from codegen.twoletter.nodes import Command, Label, Negative, Number, Statement, Target
from codegen.twoletter.parse import parse

RELATIVE = frozenset({"PR", "IP"})
ENDS = frozenset({"EN", "RI", "RE", "HX", "AB", "RS"})  # the way does not go on behind them
PLACES = frozenset(  # what may leave an axis somewhere that the steps before do not tell
    {"PA", "DP", "HM", "FI", "FE", "JG", "LM", "LI", "VM", "VP", "CR", "CM", "CD", "DT", "EA", "EG", "GA", "GR", "EM"}
    | {"TM", "MT", "MO", "OF", "DE", "JS", "ST"}
)


@lru_cache(maxsize=1024)
def raw_items(text: str, setup: Setup, step: str, at: int) -> tuple[Item, ...]:
    """Labels, jumps without condition, and relative moves by numbers; axes it may put elsewhere are not judged."""
    return tuple(item for _, statement in parse(text).statements() for item in _items(statement, setup, step, at))


def _items(statement: Statement, setup: Setup, step: str, at: int) -> Iterator[Item]:
    match statement:
        case Label(name=name):
            yield Mark("label", name)
        case Command(name="JP", arguments=(Target(label=str(name)),)):
            yield Mark("jump", name, step, at)
        case Command(name="JP", arguments=(Target(label=None), *_)):
            yield Mark("end", "")  # to a line that is worked out
        case Command(name=name) if name in ENDS:
            yield Mark("end", "")
        case Command(name=name) if name in PLACES:
            yield Course(known=frozenset(setup.letters))
        case Command(name=name) if name in RELATIVE:
            yield _relative(statement, setup)


def _relative(move: Command, setup: Setup) -> Course:
    """The controller takes whole counts: a fraction is cut down in each turn. Of expressions nothing is known."""
    letters = (move.axis,) if move.axis else tuple(AXES)
    offs = []
    for letter, argument in zip(letters, move.arguments, strict=False):
        scaled = _scaled(argument)
        if scaled is None or scaled % ONE == 0 or letter not in setup.letters:
            continue
        counts = setup.from_counts(Dimension.DISTANCE, letter, 1)
        offs.append((letter, -round(counts * FINEST * (scaled % ONE) / ONE)))
    return Course(tuple(offs))


def _scaled(argument: object) -> int | None:
    """The number as the controller holds it; None for anything else."""
    match argument:
        case Number(scaled=scaled):
            return scaled
        case Negative(operand=Number(scaled=scaled)):
            return -scaled
    return None
