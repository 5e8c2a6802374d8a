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

if TYPE_CHECKING:
    from device.wire import Manners

Value: TypeAlias = bool | int | float | str
Change: TypeAlias = Mapping[str, Value]

FACTORY = "needs a master reset, which erases the EEPROM"
BURNING = "needs burning"
PROGRAM = "needs a program of its own in the memory"
MOTION = "needs motion"
FLOOD = "needs more characters than the port takes"
OUTPUT = "needs an output or a motor that is switched"
CHANGED: Final = ("reply", "default", "low", "high", "step", "moving")  # what `commands` may correct of a row


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


@dataclass(frozen=True, slots=True)
class Profile:
    """Every recalled or inferred choice of the simulator in one place."""

    # ------------------------------------------------------------- the line
    line_characters: int = fact(
        80, "longest command line of a port; longer: error 5", "recall", unit="characters", low=10, high=512
    )
    prompt_per_command: bool = fact(True, "each command of a line with ; has its own prompt", "recall")
    prompt_on_empty_line: bool = fact(True, "a return alone is answered by a prompt", "recall")
    error_ends_line: bool = fact(True, "after a refused command the rest of its line is dropped", "inferred")
    echo_return: str = fact("CR LF", "how EO1 echoes a return", "inferred", choices=("CR LF", "CR"))
    program_end: str = fact(
        "^Z", "sent by UL after the last line", "recall", choices=("^Z", "^Z CR LF", "CR LF", "nothing"), rows=("UL",)
    )
    array_end: str = fact(
        "^Z", "sent by QU after the last element", "recall", choices=("^Z", "^Z CR LF", "CR LF", "nothing")
    )
    typed_message_marked: bool = fact(
        False, "CW1 sets bit 7 also where MG was typed at the port", "inferred (asked for with --cw only)", rows=("CW",)
    )
    revision: str = fact("Rev 2.0h", "second half of the answer to ^R^V", "inferred (form known)", rows=("^R^V",))
    serial_number: int = fact(1, "what _BN tells", "recall", high=2**31 - 1)
    output_fifo: int = fact(
        128,
        "characters that wait for the line before the program does",
        "dmc-1412-1414.txt l.1333; l.2672 says 512",
        unit="characters",
        choices=(128, 512),
        unseen=PROGRAM,
    )
    receive_buffer: int = fact(
        256, "received characters not yet looked at", "inferred", unit="characters", low=32, high=4096, unseen=FLOOD
    )
    sends_xoff: bool = fact(False, "the controller holds the host by XOFF, too", "inferred", unseen=FLOOD)

    # --------------------------------------------------------------- errors
    error_code_cleared_by_reading: bool = fact(True, "TC sets the error code to 0", "recall", rows=("TC",))
    error_code_cleared_by_operand: bool = fact(False, "so does _TC in an expression", "inferred")
    error_code_cleared_by_good_command: bool = fact(False, "so does every accepted command", "inferred")
    error_text: str = fact(
        "1 text",
        "form of the answer to TC1",
        "dmc-1412-1414.txt l.1403; the SSC's windows show 022 - text",
        choices=("1 text", "001 text", "001 - text"),
    )
    undefined_variable_code: int = fact(57, "error of a name never assigned", "inferred", choices=(57, 9))
    dimension_again_code: int = fact(57, "error of DM for an array that is there", "inferred", choices=(57, 67, 6))
    deallocate_missing_code: int = fact(
        0, "error of DA for an array that is not there; 0: accepted", "inferred", choices=(0, 57, 82)
    )
    off_the_end_code: int = fact(10, "error of a thread that runs past the last line", "inferred", unseen=PROGRAM)
    bad_input_code: int = fact(83, "error of an answer to IN that is no number", "inferred", unseen=PROGRAM)

    # -------------------------------------------------------------- numbers
    status_sign: bool = fact(False, "TB TI TS TC SC answer with a sign column", "inferred", rows=("TI",))
    int_of_negative: str = fact(
        "towards zero", "@INT and @FRAC of a negative number", "inferred", choices=("towards zero", "down")
    )
    round_half: str = fact("up", "@RND of a negative number that ends in .5", "inferred", choices=("up", "away from 0"))
    root_of_negative: str = fact(
        "of the magnitude", "@SQR of a negative number", "recall", choices=("of the magnitude", "error 6")
    )
    overflow: str = fact(
        "wraps", "a result beyond 2 147 483 647.9999", "inferred", choices=("wraps", "stops at the limit")
    )
    samples_per_second: int = fact(
        1024, "samples, so TIME, in a true second at TM 1000", "dmc-1412-1414.txt l.3284", choices=(1024, 1000)
    )
    labels: int = fact(254, "labels that an SSC holds", "recall", unit="labels", low=1, high=1000, rows=("DL",))
    variables: int = fact(
        254,
        "variables that an SSC holds",
        "recall",
        unit="variables",
        low=1,
        high=1000,
        unseen="how many are in use can not be asked",
    )

    # ----------------------------------------------------- power-up, burning
    leading_zeros_removed: int = fact(
        0, "LZ after a master reset", "inferred", choices=(0, 1), rows=("LZ",), unseen=FACTORY
    )
    echo: int = fact(0, "EO after a master reset", "recall", choices=(0, 1), rows=("EO",), unseen=FACTORY)
    mark: int = fact(2, "first field of CW after a master reset", "recall", choices=(1, 2), unseen=FACTORY)
    port_two_baud: int = fact(
        9600,
        "speed of port 2 after a master reset",
        "recall",
        unit="baud",
        choices=(300, 1200, 4800, 9600, 19200, 38400),
        rows=("CC",),
        unseen=FACTORY,
    )
    burn_parameters_ms: int = fact(250, "BN", "SSC manual l.1941", unit="ms", rows=("BN",), unseen=BURNING)
    burn_program_ms: int = fact(2000, "BP, up to 10 s", "recall", unit="ms", rows=("BP",), unseen=BURNING)
    burn_variables_ms: int = fact(1000, "BV, up to 2 s", "recall", unit="ms", rows=("BV",), unseen=BURNING)
    burns_outputs: bool = fact(True, "BN keeps the outputs", "recall", unseen=BURNING)
    reset_ms: int = fact(
        1000,
        "from RS to the prompt",
        "recall",
        unit="ms",
        rows=("RS", "^R^S"),
        unseen="needs a reset, which stops programs and switches outputs",
    )

    # ------------------------------------------------------- programs, motion
    interrupt_once: bool = fact(
        True, "II: after #ININT was called once, RI enables it again", "recall", rows=("II", "RI"), unseen=PROGRAM
    )
    end_fields: str = fact(
        "trippoint,interrupt",
        "EN m,n at the end of #COMINT",
        "recall",
        choices=("trippoint,interrupt", "interrupt,trippoint"),
        rows=("EN", "RE"),
        unseen=PROGRAM,
    )
    abort_keeps_programs: int = fact(
        1, "argument of AB that leaves the programs", "recall", choices=(0, 1), rows=("AB",), unseen=MOTION
    )
    limits_follow_level: bool = fact(
        False, "with CN 1, TS shows limit levels instead of 'not active'", "inferred", unseen="needs CN 1", rows=("CN",)
    )
    edge_direction: str = fact(
        "table",
        "FE: forward where _HM is 0, or the other way round",
        "dmc-1412-1414.txt l.2341-2346; the sentence at l.1145 contradicts",
        choices=("table", "sentence"),
        unseen=MOTION,
    )
    velocity_feed_v: float = fact(
        1.22e-6, "FV: volts for 1 count/s at FV 1", "recall", unit="V", rows=("FV",), unseen=MOTION
    )
    acceleration_feed_v: float = fact(
        1.5e-7, "FA: volts for 1 count/s² at FA 1", "recall", unit="V", rows=("FA",), unseen=MOTION
    )

    # --------------------------------------------------------------- tables
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
    """A setting that is not known or a value that it can not have; the text is one sentence."""


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
            raise ProfileWrong(f"{key} of {name} can not be corrected")
        if key == "reply":
            whole, _, decimals = str(value).partition(".")
            fits = isinstance(value, str) and whole.isdecimal() and decimals in "01234" and 0 < int(whole) <= 10
            if not fits or not decimals:
                raise ProfileWrong(f'reply of {name} is a format such as "8.0", not {shown(value)}')
        elif key == "moving" and not isinstance(value, bool):
            raise ProfileWrong(f"moving of {name} is true or false, not {shown(value)}")
        elif key != "moving" and (isinstance(value, bool) or not isinstance(value, Number)):
            raise ProfileWrong(f"{key} of {name} is a number, not {shown(value)}")
