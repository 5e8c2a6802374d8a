"""Targets behind a software limit (target_beyond_limit): "will not accept position commands beyond" it (l.4135)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from codegen.twoletter.fixed import ONE
from device.simulator.motion import Register
from device.simulator.twoletter.state import CommandError

if TYPE_CHECKING:
    from device.simulator.twoletter.unit import Unit

RANGE, BEGIN = 6, 22
ACCEPTED: Final = "not refused"


def beyond(unit: Unit, axis: int, target: int) -> bool:
    """Whether the way to a target ends behind FL or BL; the way back from behind a limit does not."""
    motion = unit.motion
    here = motion.reference(axis)
    forward, reverse = (motion.get(axis, limit) for limit in (Register.FORWARD_LIMIT, Register.REVERSE_LIMIT))
    return (target > forward and target >= here) or (target < reverse and target <= here)


def refuse(unit: Unit, axis: int, target: int) -> None:
    """PA, PR and IP to a place behind a limit."""
    rule = unit.profile.target_beyond_limit
    if rule != ACCEPTED and beyond(unit, axis, target):
        raise CommandError(BEGIN if rule.endswith("22") else RANGE)


def check_target(unit: Unit, name: str, axis: int, value: int) -> None:
    """The argument of PA or PR, where these are what is refused."""
    if unit.profile.target_beyond_limit.startswith("PA"):
        here = 0 if name == "PA" else unit.motion.reference(axis)
        refuse(unit, axis, here + value // ONE)


def check_begin(unit: Unit, axis: int, target: int) -> None:
    """BG of a position move, where that is what is refused."""
    if unit.profile.target_beyond_limit.startswith("BG"):
        refuse(unit, axis, target)
