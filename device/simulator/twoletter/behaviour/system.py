"""Burning and reset."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from device.simulator.twoletter import burned
from device.simulator.twoletter.state import CommandError, Port, Strand, Wait

if TYPE_CHECKING:
    from device.simulator.twoletter.calls import Call
    from device.simulator.twoletter.unit import Unit

PROGRAM_RUNS: Final = 17
WRITE_ERROR: Final = 15


def burn_parameters(unit: Unit, strand: Strand, call: Call) -> None:
    """BN: the parameters, about 250 ms (SSC manual l.1941)."""
    _not_while_running(unit, strand)
    _burn(unit, parameters=burned.parameters(unit))
    _busy(unit, strand, unit.profile.burn_parameters_ms)


def burn_program(unit: Unit, strand: Strand, call: Call) -> None:
    """BP: the program, for power-up (dmc-1412-1414.txt l.2969)."""
    _not_while_running(unit, strand)
    _burn(unit, program=list(unit.state.program))
    _busy(unit, strand, unit.profile.burn_program_ms)


def burn_variables(unit: Unit, strand: Strand, call: Call) -> None:
    """BV: variables and arrays (dmc-1412-1414.txt l.3213)."""
    state = unit.state
    _burn(unit, variables={"values": dict(state.variables), "strings": sorted(state.strings)}, arrays=state.arrays)
    _busy(unit, strand, unit.profile.burn_variables_ms)


def _burn(unit: Unit, **parts: Any) -> None:
    """Error 15 when the EEPROM's file cannot be written."""
    try:
        unit.eeprom.burn(**parts)
    except OSError as reason:
        unit.notice(f"the EEPROM file cannot be written: {reason.strerror or reason}")
        raise CommandError(WRITE_ERROR) from reason


def _not_while_running(unit: Unit, strand: Strand) -> None:
    if isinstance(strand, Port) and unit.running():
        raise CommandError(PROGRAM_RUNS)


def _busy(unit: Unit, strand: Strand, milliseconds: int) -> None:
    """The prompt comes when the EEPROM is written; the interpreter does nothing else meanwhile."""
    unit.state.busy_until = unit.after_ms(milliseconds)
    strand.wait = Wait("burn", wake=unit.state.busy_until)
    unit.changed = True


def reset(unit: Unit, strand: Strand, call: Call) -> None:
    """RS: as at power-up; the prompt comes after about a second (recall)."""
    unit.begin_reset()


DOES: Final = {"BN": burn_parameters, "BP": burn_program, "BV": burn_variables, "RS": reset}
