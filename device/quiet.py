"""Whether an axis may be worked with: Control, a known model, nothing running, nothing moving; and lines proved."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from codegen.twoletter.problems import ERROR_TEXTS
from device.backing_up import LINE_S, REFUSAL_S, exact
from device.identify import fence
from device.lease import LOOK_S
from device.proof import proved
from device.stop import StopState
from device.tasks import LinkError, LinkLost, NotAllowed, Steps, Wait
from device.wire import Kind

if TYPE_CHECKING:
    from codegen.models import Model
    from device.api import Controller

STILL_S = 3.0  # for an axis that was told to stop
STOPPED_S = 6.0  # for STOP to be proved before anything is put back


def allowed(c: Controller, what: str) -> Model:
    """The controller's model where it may be worked with at all; NotAllowed with the reason otherwise."""
    if not c.control:
        raise NotAllowed(f"{what}: this is Watch. Switch to Control first.")
    if c.model is None:
        raise NotAllowed(f"{what}: the controller's type is not known.")
    if c.resting():
        raise NotAllowed(f"{what}: {c.resting()}")
    return c.model


def ready(c: Controller, axis: str, what: str = "Not started") -> Model:
    """The same for one of its axes."""
    model = allowed(c, what)
    if axis not in model.axes:
        raise NotAllowed(f"{what}: this controller has no axis {axis}.")
    return model


@contextmanager
def recording(c: Controller, words: str, what: str = "Not started") -> Iterator[None]:
    """A controller records one thing at a time, and what is under way keeps its arrays; `words` say what it is."""
    if c.recording:
        raise NotAllowed(f"{what}: {c.recording}")
    c.recording = words
    try:
        yield
    finally:
        c.recording = ""


def still(c: Controller, model: Model, what: str) -> Steps[None]:
    """No program runs, no axis moves or follows a master."""
    threads = [f"_XQ{number}" for number in range(model.threads)]
    moving = [f"_BG{axis}" for axis in (f"{model.axes}S" if model.coordinated else model.axes)]
    following = [f"_GR{axis}" for axis in model.axes]
    found = yield from exact(c.nonces, [*threads, *moving, *following], model.columns)
    if any(line is not None and line >= 0 for line in found[: len(threads)]):
        raise NotAllowed(f"{what}: a program is running. Halt it first.")
    if any(found[len(threads) : -len(following)]):
        raise NotAllowed(f"{what}: an axis is moving. Stop it first.")
    if any(found[-len(following) :]):
        raise NotAllowed(f"{what}: an axis follows a master (gearing). Disable it first.")


def rest(c: Controller, axis: str) -> Steps[None]:
    """The axis is not commanded to move."""
    assert c.model is not None  # `ready` has looked
    end = c.clock() + STILL_S
    told = yield from exact(c.nonces, [f"_BG{axis}"], c.model.columns)
    if told[0]:
        yield from proved(c.nonces, f"ST {axis}", LINE_S, REFUSAL_S)
    while told[0]:
        if c.clock() > end:
            raise LinkError(f"axis {axis} was told to stop and still moves. Press STOP.")
        yield Wait(LOOK_S)
        told = yield from exact(c.nonces, [f"_BG{axis}"], c.model.columns)


def until_stopped(c: Controller, deaf_s: float = 0.0) -> Steps[None]:
    """After STOP nothing is sent before its proof, which a controller that hears nothing gives `deaf_s` later."""
    end = c.clock() + STOPPED_S + deaf_s
    while c.stop_state in (StopState.STOPPING, StopState.NOT_CONFIRMED):
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
