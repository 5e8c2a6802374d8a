"""Settings of the language: numbers, expressions, programs and their threads."""

from __future__ import annotations

from dataclasses import dataclass

from device.simulator.twoletter.profile_line import LineSettings
from device.simulator.twoletter.setting import PROGRAM, fact


@dataclass(frozen=True, slots=True)
class LanguageSettings(LineSettings):
    """Numbers and programs."""

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
        unseen="how many are in use cannot be asked",
    )

    # ---------------------------------------------------------- expressions
    bracket_levels: int = fact(
        4,
        "brackets within brackets, of both kinds; deeper: error 59",
        "SSC manual l.2635",
        unit="levels",
        low=1,
        high=20,
    )
    division_by_zero: str = fact(
        "error 6", "a division by zero", "inferred", choices=("error 6", "error 9", "largest number")
    )
    cut: str = fact(
        "towards zero", "how * and / lose what is below 1/65536", "inferred", choices=("towards zero", "down")
    )
    axis_assignment: str = fact(
        "variable",
        "PRA=5 sets a variable of that name, or PR of X",
        "inferred (later families have the command)",
        choices=("variable", "command"),
    )
    stack_operand: bool = fact(True, "_ZSn tells how many returns wait", "recall", rows=("ZS",))

    # ------------------------------------------------------------- programs
    unknown_label_code: int = fact(
        10, "error of a jump to a label that is not there", "inferred", choices=(10, 11), unseen=PROGRAM
    )
    waiting_operand: bool = fact(
        True, "_HXn is 2 while the thread waits at a trippoint, else 1", "recall", rows=("HX",), unseen=PROGRAM
    )
    waiting_line: str = fact(
        "the trippoint's",
        "_XQn of a thread that waits",
        "recall",
        choices=("the trippoint's", "the next command's"),
        rows=("XQ",),
        unseen=PROGRAM,
    )
    trace_labels: bool = fact(True, "TR1 sends lines that hold only a label, too", "inferred", unseen=PROGRAM)
    listed_line: str = fact(
        "000 text", "form of a line of LS and TR", "inferred", choices=("000 text", "000text"), unseen=PROGRAM
    )
    prompt_ends_line: bool = fact(False, "IN sends CR LF behind its text", "inferred", unseen=PROGRAM)
    command_error_return: str = fact(
        "next command",
        "where EN at the end of #CMDERR goes on",
        "recall",
        choices=("next command", "same command"),
        unseen=PROGRAM,
    )
    software_limit_routine: bool = fact(True, "FL and BL call #LIMSWI, too", "recall", unseen=PROGRAM)
