"""Commands that restart the controller."""

from __future__ import annotations

from codegen.twoletter.rows import Row, Takes

SYSTEM: tuple[Row, ...] = (
    Row(
        name="RS",
        title="Reset",
        group="System",
        takes=Takes.NONE,
        help="Restart as at power-up.",
        example="RS",
        program=False,
        confidence="medium",
        profile="recall",
    ),
    Row(
        name="^R^S",
        title="Master reset",
        group="System",
        takes=Takes.BYTES,
        help="Erase the EEPROM: factory parameters, no program, no variables.",
        example="^R^S",
        program=False,
        confidence="medium",
        profile="recall",
    ),
)
