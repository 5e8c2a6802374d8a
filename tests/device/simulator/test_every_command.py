"""Every row of the command table is simulated in exactly one way."""

from __future__ import annotations

import pytest

from codegen.twoletter.commands import COMMANDS, KEYWORDS
from device.simulator.twoletter import behaviour
from device.simulator.twoletter.behaviour import registers
from tests.device.simulator.bench import Bench

# Rows that are no commands: read only in expressions, or bytes that the wire takes.
BY_THE_WIRE = {"^R^V", "^R^S"}
BY_THE_COMPILER = {"NO"}
BY_THE_NAMES = {"TIME", "F1", "F2", "F3", "F4", "F5"}


def ways(name: str) -> list[str]:
    """How a command is simulated."""
    row = COMMANDS[name]
    found = []
    if name in behaviour.COMPILES:
        found.append("compiled")
    if name in behaviour.WAITS:
        found.append("waits")
    if name in behaviour.DOES:
        found.append("does")
    elif name in registers.STORES:  # PF and VF are checked by a behaviour before they are stored
        found.append("stored")
    if name in BY_THE_WIRE or name in BY_THE_COMPILER or name in BY_THE_NAMES:
        found.append("elsewhere")
    if not found and name in behaviour.READS and (row.reply is not None or row.operand is not None):
        found.append("told")
    return found


@pytest.mark.parametrize("name", list(COMMANDS))
def test_every_command_is_simulated_in_exactly_one_way(name: str) -> None:
    assert len(ways(name)) == 1, (name, ways(name))


@pytest.mark.parametrize("name", [name for name, row in COMMANDS.items() if row.operand])
def test_every_operand_can_be_read(name: str) -> None:
    operand = name.removeprefix("_")
    assert operand in behaviour.READS or operand in registers.STORES, name


@pytest.mark.parametrize("name", list(KEYWORDS))
def test_every_keyword_can_be_read(name: str) -> None:
    assert name in BY_THE_NAMES or name in behaviour.KEYWORDS, name


@pytest.mark.parametrize(
    "name", [name for name, row in COMMANDS.items() if row.reply == "PF" and row.takes.name == "AXIS_NUMBERS"]
)
def test_position_registers_answer_a_question(name: str) -> None:
    assert Bench().ask(f"{name} ?").lstrip(" -").isdigit()
