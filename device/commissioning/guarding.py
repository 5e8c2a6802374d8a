"""What stands around every step that changes something: former values on disk, the motor off at the end."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from device.backing_up import exact
from device.former import LIMITS, PROFILE, Former, kept, present, taken
from device.lease import Exchange
from device.quiet import ready, said
from device.tasks import LinkLost, Steps, Wait
from device.wire import Kind

if TYPE_CHECKING:
    from device.api import Controller

T = TypeVar("T")
KEPT = (*LIMITS, *PROFILE, "KI")
OFF_S = 3.0


def guarded(
    c: Controller,
    axis: str,
    folder: Path,
    now: datetime,
    body: Callable[[Former], Steps[T]],
    *,
    also: tuple[str, ...] = (),
    place: str = "TP",
    lasting: bool = False,
) -> Steps[T]:
    """Runs `body` with the former values, `also` of these, on disk; then motor off and, if not `lasting`, all back."""
    with taken(c, axis, f"axis {axis} is being brought to life. Wait for the end of the step, or press STOP."):
        names = tuple(dict.fromkeys((*KEPT, *also)))
        former = yield from present(c, axis, names, folder, now, place=place)
        return (yield from kept(c, former, lambda: body(former), lambda _: power_off(c, axis), lasting=lasting))


def switch_off(c: Controller, axis: str, what: str = "Not done") -> Steps[bool]:
    """MO, and whether the controller then says so."""
    ready(c, axis, what)
    yield from said(c, f"MO {axis}")
    told = yield from exact(c.nonces, [f"_MO{axis}"], columns_of(c))
    return bool(told[0])


def power_off(c: Controller, axis: str) -> Steps[None]:
    """The motor goes off (not while it moves: so it is stopped before), in Watch as well: what began here ends here."""
    exchange, end = exchange_of(c), c.clock() + OFF_S
    while c.clock() < end:
        for word in ("MO", "ST"):
            answer = yield from exchange.prove(f"{word} {axis}", stops=True)
            if word == "MO" and answer.kind is Kind.ACCEPTED:
                return
            if answer.kind is Kind.SILENT:
                raise LinkLost("The controller stopped answering.")
        yield Wait(0.02)
    raise LinkLost(f"it is not certain that the motor of {axis} is off. Press STOP.")


def columns_of(c: Controller) -> int:
    return c.model.columns if c.model is not None else 40


def exchange_of(c: Controller) -> Exchange:
    return Exchange(c.clock, c.nonces, columns_of(c), c.line.byte_s)
