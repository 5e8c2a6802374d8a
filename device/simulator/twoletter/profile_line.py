"""Settings of the line: prompts, echo, ends of uploads, buffers; and of refusals."""

from __future__ import annotations

from dataclasses import dataclass

from device.simulator.twoletter.setting import FLOOD, PROGRAM, fact


@dataclass(frozen=True, slots=True)
class LineSettings:
    """The line and its refusals."""

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
    array_format: str = fact("VF", "format of the elements that QU sends", "inferred", choices=("VF", "10.4"))
    typed_message_marked: bool = fact(
        False, "CW1 sets bit 7 also where MG was typed at the port", "inferred (asked for with --cw only)", rows=("CW",)
    )
    revision: str = fact("Rev 2.0h", "second half of the answer to ^R^V", "inferred (form known)", rows=("^R^V",))
    copyright: str = fact("TWOLETTER STUDIO SIMULATED CONTROLLER", "what CW alone tells", "inferred (form known)")
    serial_number: int = fact(1, "what _BN tells", "recall", high=2**31 - 1)
    data_mode_alone: bool = fact(
        True,
        "the data mode of port 1 (CI ,,1) also holds while no program runs",
        "inferred; dmc-1412-1414.txt l.3524: may only be used when executing a program",
    )
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
