"""Facts of the controllers that no manual states: named settings, so that a real unit's answers can replace them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Profile:
    """Every recalled or inferred choice of the simulator in one place."""

    line_characters: int = 80  # longest command line of a port; longer: error 5
    leading_zeros_removed: int = 0  # LZ after a master reset
    echo: int = 0  # EO after a master reset
    burn_parameters_ms: int = 250  # BN
    burn_program_ms: int = 2000  # BP (up to 10 s)
    burn_variables_ms: int = 1000  # BV (up to 2 s)
    reset_ms: int = 1000  # from RS to the prompt
    off_the_end_code: int = 10  # error of a thread that runs past the last line
    bad_input_code: int = 83  # error of an answer to IN that is no number
    upload_end: bytes = b"\x1a"  # what UL and QU send after the last line
    revision: str = "Rev 2.0h"  # second half of the answer to ^R^V
    serial_number: int = 1  # _BN
