"""Facts that no manual states: named settings, so that a real controller's answers can replace them.

`recall` is knowledge without a document, `inferred` a decision of this simulator. Every setting has its default, what
else is imaginable, and either a motionless question that shows it (see `device/conform`) or the reason why none can.
Beside the settings, `commands` corrects rows of the command table and `codes` renames error codes.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from codegen.models import Model
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.problems import ERROR_TEXTS
from codegen.twoletter.rows import Number, Row
from device.simulator.twoletter.profile_motion import MotionSettings
from device.simulator.twoletter.setting import Setting, Value

if TYPE_CHECKING:
    from device.wire import Manners

Change: TypeAlias = Mapping[str, Value]

CHANGED: Final = ("reply", "default", "low", "high", "step", "moving", "burned")
"""What `commands` may correct of a row."""
FLAGS: Final = ("moving", "burned")


@dataclass(frozen=True, slots=True)
class Profile(MotionSettings):
    """Every recalled or inferred choice of the simulator in one place."""

    codes: Mapping[int, int] = field(default_factory=dict)  # error code here → the controller's
    commands: Mapping[str, Change] = field(default_factory=dict)  # command → corrections of its row

    def __post_init__(self) -> None:
        for name in SETTINGS:
            check(name, getattr(self, name))
        for mine, theirs in self.codes.items():
            check_code(mine)
            check_code(theirs)
        for name, change in self.commands.items():
            check_change(name, change)

    @property
    def upload_end(self) -> bytes:
        """Sent by UL after the last line."""
        return ENDS[self.program_end]

    @property
    def array_upload_end(self) -> bytes:
        """Sent by QU after the last element."""
        return ENDS[self.array_end]

    def manners(self) -> Manners:
        """What the link has to know of it."""
        from device.wire import Manners

        marked = self.program_end.startswith("^Z")
        return Manners(self.prompt_per_command, self.error_ends_line, marked, self.typed_message_marked)

    def code(self, code: int) -> int:
        """The controller's code of a refusal."""
        return self.codes.get(code, code) if self.codes else code

    def rows(self) -> Mapping[str, Row]:
        """The command table as this controller has it."""
        if not self.commands:
            return COMMANDS
        changed = {name: dataclasses.replace(COMMANDS[name], **change) for name, change in self.commands.items()}  # type: ignore[arg-type]
        return {**COMMANDS, **changed}

    def model(self, model: Model) -> Model:
        """The controller's type with the places that an SSC really has."""
        if model.family != "ssc" or (self.labels, self.variables) == (model.labels, model.variables):
            return model
        return dataclasses.replace(model, labels=self.labels, variables=self.variables)

    def feed(self, name: str) -> float:
        """What FV and FA count in the servo loop against the volts of the defaults."""
        if name == "FV":
            return self.velocity_feed_v / float(DEFAULTS["velocity_feed_v"])
        return self.acceleration_feed_v / float(DEFAULTS["acceleration_feed_v"]) if name == "FA" else 1.0

    def period(self, sample_us: int) -> int:
        """Ticks of a sample at a TM."""
        return sample_us * 1024 // self.samples_per_second


class ProfileWrong(ValueError):
    """A setting that is not known or a value that it cannot have; the text is one sentence."""


SETTINGS: Final[dict[str, Setting]] = {
    each.name: each.metadata["setting"] for each in dataclasses.fields(Profile) if "setting" in each.metadata
}
DEFAULTS: Final[dict[str, Any]] = {
    each.name: each.default for each in dataclasses.fields(Profile) if "setting" in each.metadata
}
ENDS: Final[dict[str, bytes]] = {"^Z": b"\x1a", "^Z CR LF": b"\x1a\r\n", "CR LF": b"\r\n", "nothing": b""}
"""What program_end and array_end stand for."""


def check(name: str, value: object) -> Value:
    """The value, when the setting can have it; raises ProfileWrong."""
    setting = SETTINGS.get(name)
    if setting is None:
        raise ProfileWrong(f"there is no setting {name}")
    default = DEFAULTS[name]
    if isinstance(default, float) and isinstance(value, int) and not isinstance(value, bool):
        value = float(value)
    if type(value) is not type(default) or (isinstance(value, float) and not 0 <= value <= 1):
        raise ProfileWrong(f"{name} is {allowed(name)}, not {shown(value)}")
    if setting.choices and value not in setting.choices:
        raise ProfileWrong(f"{name} is {allowed(name)}, not {shown(value)}")
    if type(value) is int and not setting.choices and not setting.low <= value <= setting.high:
        raise ProfileWrong(f"{name} is {allowed(name)}, not {shown(value)}")
    if isinstance(value, str) and not (value.isascii() and value.isprintable()):
        raise ProfileWrong(f"{name} is printable text, not {shown(value)}")
    assert isinstance(value, bool | int | float | str)
    return value


def allowed(name: str) -> str:
    """What a setting can be, in words."""
    setting, default = SETTINGS[name], DEFAULTS[name]
    if setting.choices:
        return " or ".join(shown(choice) for choice in setting.choices)
    if isinstance(default, bool):
        return "true or false"
    if isinstance(default, int):
        return f"a whole number from {setting.low} to {setting.high}"
    return "text" if isinstance(default, str) else "a number from 0 to 1"


def shown(value: object) -> str:
    """A value as the file has it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return f'"{value}"' if isinstance(value, str) else f"{value}"


def check_code(code: object) -> None:
    """An error code the controllers have; raises ProfileWrong."""
    if type(code) is not int or code not in ERROR_TEXTS:
        raise ProfileWrong(f"{shown(code)} is no error code")


def check_change(name: str, change: Change) -> None:
    """Corrections of a row that exist and fit; raises ProfileWrong."""
    row = COMMANDS.get(name)
    if row is None:
        raise ProfileWrong(f"there is no command {name}")
    for key, value in change.items():
        if key not in CHANGED or (key == "reply" and row.reply in (None, "PF")) or getattr(row, key) is None:
            raise ProfileWrong(f"{key} of {name} cannot be corrected")
        if key == "reply":
            whole, _, decimals = str(value).partition(".")
            fits = isinstance(value, str) and whole.isdecimal() and decimals in "01234" and 0 < int(whole) <= 10
            if not fits or not decimals:
                raise ProfileWrong(f'reply of {name} is a format such as "8.0", not {shown(value)}')
        elif key in FLAGS and not isinstance(value, bool):
            raise ProfileWrong(f"{key} of {name} is true or false, not {shown(value)}")
        elif key not in FLAGS and (isinstance(value, bool) or not isinstance(value, Number)):
            raise ProfileWrong(f"{key} of {name} is a number, not {shown(value)}")
