"""What the steps set without moving anything: motor off, CN, error, torque and travel limits, and burning them."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from device import commands
from device.backing_up import exact
from device.backup import Value
from device.commissioning.guarding import exchange_of, guarded, switch_off
from device.former import Former, assign
from device.lease import FLAG
from device.quiet import ready, said, still
from device.tasks import Steps

if TYPE_CHECKING:
    from device.api import Controller

INPUTS = {"forward": "LF", "reverse": "LR", "home": "HM"}
BURN_WORDS = (
    "Everything the controller holds now (motor and encoder types, CN, limits, gains) is written into its EEPROM over "
    "what was there. The motor of {axis} goes off first, so that the next power-up leaves it off; other motors start "
    "as they are now. The program is not burned with it. It takes about 250 ms: leave the power on."
)


def motor_off(c: Controller, axis: str) -> Steps[bool]:
    """As a step of its own: not under a running program."""
    model = ready(c, axis, "Not switched off")
    yield from still(c, model, "Not switched off")
    return (yield from switch_off(c, axis))


def set_switches(c: Controller, axis: str, limit: int, home: int) -> Steps[bool]:
    """CN: which level of limit and home inputs counts; the motor is off meanwhile."""
    model = ready(c, axis, "Not set")
    yield from still(c, model, "Not set")
    yield from switch_off(c, axis)
    yield from said(c, f"CN {limit},{home}")
    return True


def look_at_switches(c: Controller, axis: str) -> Steps[Mapping[str, int] | None]:
    """Levels of the three inputs, at once: the usual reading comes round too seldom for a switch tripped by hand."""
    told = yield from exchange_of(c).read(*((f"_{name}{axis}", FLAG) for name in INPUTS.values()))
    return None if told is None else dict(zip(INPUTS, map(int, told), strict=True))


def set_values(
    c: Controller, axis: str, values: Mapping[str, Value], folder: Path, now: datetime
) -> Steps[tuple[Mapping[str, Value], Mapping[str, Value]]]:
    """Sets registers with the motor off; what was there and what is there now. Put back where one is refused."""
    model = ready(c, axis, "Not set")
    yield from still(c, model, "Not set")
    yield from switch_off(c, axis)

    def body(former: Former) -> Steps[tuple[Mapping[str, Value], Mapping[str, Value]]]:
        yield from assign(c, axis, values)
        found = yield from exact(c.nonces, [f"_{name}{axis}" for name in values], model.columns)
        there = {name: value for name, value in zip(values, found, strict=True) if value is not None}
        return former.values, there

    return (yield from guarded(c, axis, folder, now, body, also=tuple(values), lasting=True))


def burn(c: Controller, axis: str) -> Steps[commands.Reply]:
    """BN with the motor off, so that the next power-up leaves it off."""
    model = ready(c, axis, "Not burned")
    yield from still(c, model, "Not burned")
    yield from switch_off(c, axis, "Not burned")
    return (yield from commands.typed(c, "BN", 3.0))
