"""What every instruction has, and the groups of the palette."""

from __future__ import annotations

import dataclasses as dc
from enum import StrEnum
from typing import TYPE_CHECKING, Any, ClassVar

if TYPE_CHECKING:
    from codegen.setup import Setup


class Group(StrEnum):
    """The groups of the palette, in its order."""

    TWO_LETTER = "2-Letter Code"
    CONFIGURATION = "Configuration"
    IO = "I/O"
    MOTION = "Motion"
    FLOW = "Program Flow"
    SERVO = "Servo Settings"
    LIMITS = "System Limits"
    MATH = "Mathematical Equation"


@dc.dataclass(frozen=True, kw_only=True)
class Instruction:
    """The values of one instruction; what the class says holds for all of its kind.

    In `sentence`, `{name}` is a field, `[…|…]` is the first alternative whose fields all have a value and are
    shown (nothing when there is none), and `<…>` is repeated for the axes that have values.
    """

    title: ClassVar[str]
    group: ClassVar[Group]
    section: ClassVar[str] = "M"  # "C" configuration, "M" main or a subroutine, "C/M" either, "S" opens a subroutine
    sentence: ClassVar[str]
    help: ClassVar[str]
    container: ClassVar[bool] = False
    needs: ClassVar[str] = ""  # why no controller of ours can do it ("" = they can)
    uses_setup: ClassVar[bool] = False  # reads the axes of the setup beyond what its fields name
    was: ClassVar[tuple[str, ...]] = ()  # former class names in files
    renamed: ClassVar[dict[str, str]] = {}  # former field name -> present one

    def recall(self, what: str, setup: Setup) -> Any:
        """What was worked out for this very instance on that setup; None when nothing was."""
        kept = self.__dict__.get(what)
        return kept[1] if kept is not None and kept[0] is setup else None

    def remember(self, what: str, setup: Setup, result: Any) -> None:
        """Keeps a result with the instance, the quickest memo there is (it is no part of the value)."""
        self.__dict__[what] = (setup, result)

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in dc.fields(self)}

    @classmethod
    def example(cls) -> Instruction:
        """One that is filled in, for the help page."""
        raise NotImplementedError

    def own_problem(self) -> tuple[str, str] | None:
        """A contradiction between the fields: (field, sentence)."""
        return None

    def setup_problem(self, setup: Setup) -> tuple[str, str] | None:
        """What this machine cannot do of it: (field, sentence); the fields are right in themselves."""
        return None

    def own_warning(self, setup: Setup) -> tuple[str, str] | None:
        """Advice about the values: (field, sentence)."""
        return None
