"""What stands around every step that changes something: former values on disk, the motor off at the end."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from codegen.twoletter.fixed import ONE
from codegen.twoletter.problems import ERROR_TEXTS
from device.backing_up import LINE_S, REFUSAL_S, exact
from device.download import proved
from device.identify import fence
from device.lease import Exchange
from device.stop import StopState
from device.tasks import LinkError, LinkLost, NotAllowed, Steps, Stopped, Wait
from device.tuning.guards import LIMITS, PROFILE, SUFFIX, Former, assign, forget, keep, putting_back, ready
from device.wire import Kind

if TYPE_CHECKING:
    from device.api import Controller

T = TypeVar("T")
KEPT = (*LIMITS, *PROFILE)
STOPPED_S, OFF_S = 6.0, 3.0


def switch_off(c: Controller, axis: str, what: str = "Not done") -> Steps[bool]:
    """MO, and whether the controller then says so."""
    ready(c, axis, what)
    yield from said(c, f"MO {axis}")
    told = yield from exact(c.nonces, [f"_MO{axis}"], columns_of(c))
    return bool(told[0])


def putting_back_of(c: Controller, former: Former) -> Steps[str]:
    """Motor off, then everything as it was before a step that was interrupted."""
    yield from switch_off(c, former.axis, "Not put back")
    yield from putting_back(c, former)
    return f"Axis {former.axis} has the limits and speeds from before; its motor is off. Nothing was burned."


def keep_former(c: Controller, axis: str, folder: Path, now: datetime) -> Steps[Former]:
    """What the axis is set to, on disk before anything is changed."""
    found = yield from exact(c.nonces, [f"_{name}{axis}" for name in (*KEPT, "TP")], columns_of(c))
    values = {name: value for name, value in zip((*KEPT, "TP"), found, strict=True) if value is not None}
    missing = [name for name in (*KEPT, "TP") if name not in values]
    if missing or c.model is None:
        raise NotAllowed(f"Not started: the controller does not tell {', '.join(missing)} of axis {axis}.")
    place = values.pop("TP") // ONE
    serial = (c.identity.serial or 0) if c.identity is not None else 0
    file = folder / f"{c.model.name}-{serial}-{axis}-{now:%Y%m%d-%H%M%S-%f}{SUFFIX}"
    former = Former(axis, c.model.name, serial, str(c.kind), c.who, now.isoformat(), place, values, file)
    keep(former)
    return former


def guarded(c: Controller, former: Former, body: Callable[[], Steps[T]]) -> Steps[T]:
    try:
        result = yield from body()
    except Stopped as stop:
        yield from until_stopped(c)
        yield from finish(c, former, str(stop))
        raise
    except LinkLost:
        raise  # the controller keeps its guards; the file is offered when it answers again
    except LinkError as reason:
        yield from finish(c, former, str(reason))
        raise
    yield from finish(c, former, "The move is complete.")
    return result


def finish(c: Controller, former: Former, why: str) -> Steps[None]:
    """Motor off, former values; then the file is no longer needed."""
    try:
        yield from power_off(c, former.axis)
        yield from assign(c, former.axis, {name: former.values[name] for name in (*PROFILE, *LIMITS)})
    except LinkError as failure:
        raise type(failure)(
            f"{why} The former limits of axis {former.axis} are not all back: {failure} They are kept on this computer "
            "and offered again."
        ) from failure
    forget(former)


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


def until_stopped(c: Controller) -> Steps[None]:
    """After STOP nothing is sent before its proof; without it the file stays for later."""
    end = c.clock() + STOPPED_S
    while c.stop_state is not StopState.STOPPED:
        if c.clock() > end:
            raise LinkLost("STOP was not confirmed; the former values are kept, and offered when the axis is at rest.")
        yield Wait(0.05)


def said(c: Controller, line: str) -> Steps[None]:
    """One line, proved; LinkError with the reason where it is refused."""
    answer = yield from proved(c.nonces, line, LINE_S, REFUSAL_S)
    if answer.kind is Kind.ACCEPTED:
        return
    if answer.kind is Kind.SILENT:
        raise LinkLost(f"The controller stopped answering at “{line}”.")
    fenced = yield from fence(c.nonces)
    code = int(fenced.values[0]) if fenced.kind is Kind.VALUES else 0
    raise LinkError(f"“{line}” was refused: error {code}, {ERROR_TEXTS.get(code, 'unknown error')}.")


def columns_of(c: Controller) -> int:
    return c.model.columns if c.model is not None else 40


def exchange_of(c: Controller) -> Exchange:
    return Exchange(c.clock, c.nonces, columns_of(c), c.line.byte_s)
