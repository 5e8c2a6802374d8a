"""What every kind of value has, and how instructions declare and show their values."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping
from functools import lru_cache
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    from codegen.setup import Setup

AXES = "XYZW"
PerAxisText = tuple[str, str, str, str]
NONE: PerAxisText = ("", "", "", "")


@dc.dataclass(frozen=True, slots=True)
class Context:
    """What a value needs to know beside itself: the machine, and the axis it belongs to ("" = none).

    A value along a path belongs to all the axes of the path: `XY`.
    """

    setup: Setup
    axis: str = ""


@dc.dataclass(frozen=True, slots=True)
class Counts:
    """What is really sent for a quantity, and a warning when rounding changes it by more than 0.1 %."""

    text: str
    warning: str | None = None


@dc.dataclass(frozen=True, kw_only=True)
class Field:
    """One value of an instruction: its name in the dialog, its help, and when it is shown."""

    label: str
    help: str = ""
    when: Mapping[str, Any] = dc.field(
        default_factory=dict
    )  # {"mode": Mode.BY} or {"mode": (Mode.BY, Mode.TO)}: names of siblings
    required: bool = True
    warns: ClassVar[bool] = False  # whether rounding may change the value

    def empty(self, value: Any) -> bool:
        """Whether nothing has been entered."""
        return value in ("", (), NONE)

    def problem(self, value: Any, context: Context) -> str | None:
        """What is wrong with `value`, in one sentence that starts with the label."""
        if self.empty(value):
            return f"{self.label} is missing" if self.required else None
        return self.wrong(value, context)

    def wrong(self, value: Any, context: Context) -> str | None:
        """As `problem`, for a value that is not empty."""
        return None

    def text(self, value: Any, context: Context) -> str:
        """The value as the sentence says it."""
        return str(value)

    def counts(self, value: Any, context: Context) -> Counts | None:
        """What is sent to the controller where that differs from what is shown."""
        return None

    def unit(self, context: Context) -> str:
        """The unit shown behind the field."""
        return ""


@dc.dataclass(frozen=True, kw_only=True)
class ListOf(Field):
    """Rows of a small dataclass with fields of its own."""

    row: type[Any]
    most: int = 0
    joint: str = "; "  # what stands between the rows in the sentence
    axes: str = ""  # the sibling that names the axes the rows move, for their values along a path


def value(field: Field, default: Any = "") -> Any:
    """Declares one value of an instruction: its field, and what a new instruction holds."""
    return dc.field(default=default, metadata={"field": field})


@lru_cache(maxsize=512)
def _fields_of(kind: type[Any]) -> Mapping[str, Field]:
    return MappingProxyType({each.name: each.metadata["field"] for each in dc.fields(kind) if "field" in each.metadata})


def fields_of(item: Any) -> Mapping[str, Field]:
    """The fields of an instruction, a row, an axis or a setup (class or instance), in dialog order."""
    return _fields_of(item if isinstance(item, type) else type(item))


def is_shown(item: Any, name: str) -> bool:
    """Whether the field is to be shown, by the values of its siblings."""
    when = fields_of(item)[name].when
    if not when:
        return True
    for sibling, wanted in when.items():
        present = getattr(item, sibling)
        if present not in wanted if isinstance(wanted, tuple) else present != wanted:
            return False
        if not is_shown(item, sibling):
            return False
    return True
