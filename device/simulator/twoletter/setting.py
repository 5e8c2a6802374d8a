"""What a setting of the profile is: its default, what it may be, and whether a question shows it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Final, TypeAlias

Value: TypeAlias = bool | int | float | str

FACTORY: Final = "needs a master reset, which erases the EEPROM"
BURNING: Final = "needs burning"
PROGRAM: Final = "needs a program of its own in the memory"
MOTION: Final = "needs motion"
FLOOD: Final = "needs more characters than the port takes"
OUTPUT: Final = "needs an output or a motor that is switched"
SEQUENCE: Final = "needs a sequence or a table of its own in place of the one that is prepared"
LIMITS: Final = "needs limits of its own, which protect the machine"


@dataclass(frozen=True, slots=True)
class Setting:
    """What is known about one setting; `rows` are the commands whose mark in the table it answers."""

    doc: str
    source: str
    unit: str = ""
    choices: tuple[Value, ...] = ()
    low: int = 0
    high: int = 1_000_000
    rows: tuple[str, ...] = ()
    unseen: str = ""  # why no motionless question shows it; empty: one does


def fact(default: Value, doc: str, source: str, **more: Any) -> Any:
    """A field of the profile with what is known about it."""
    return field(default=default, metadata={"setting": Setting(doc, source, **more)})
