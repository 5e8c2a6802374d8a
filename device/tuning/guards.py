"""What stands around every excitation of an axis (safety.md 4): limits only ever narrowed, former values on disk first.

`guarded` runs steps inside: nothing else runs or moves, OE 1, ER, TL, FL and BL lie around the travel that a person
stated, and everything is put back on finish, cancel, fault and STOP (`device/former.py`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE, scaled
from device.backing_up import LINE_S, REFUSAL_S, exact
from device.bits import FORWARD, REVERSE
from device.former import GAINS, HELD, LIMITS, PROFILE, Former, assign, kept, present, taken
from device.jog import FURTHEST
from device.lease import LOOK_S
from device.proof import proved
from device.quiet import ready, recording, rest, still
from device.tasks import LinkError, NotAllowed, Steps, Stopped, Wait
from device.tuning.excite import carried, sag
from device.tuning.registers import gains_of
from device.wire import Kind

if TYPE_CHECKING:
    from codegen.models import Model
    from device.api import Controller
    from device.backup import Value

T = TypeVar("T")
SIDES = {"forward": FORWARD, "reverse": REVERSE}  # of _TS: whatever CN
LIMITED = (2, 3)  # stop codes: FL or the forward switch, BL or the reverse one
ERROR_SHARE = 1.5  # of a step: more than that and the loop is not following any more
SPARE = 2.0  # times what an axis hangs below its place already: it may hang so far with the gains that are tried
BEARS = 0.9  # of the torque limit: more must not be needed to hold the axis


class Fault(LinkError):
    """The axis did something that ends the excitation; the text says what, and what to do."""


class Cancelled(LinkError):
    """The person ended it."""


@dataclass(frozen=True, slots=True)
class Guard:
    """What a person stated and confirmed: how far the axis may go from where it stands (counts), how hard it may push.

    `error` is the largest following error in counts, `torque` the largest motor command in volts.
    """

    axis: str
    forward: int
    reverse: int
    error: int
    torque: float
    sure: int = 0  # counts: so large an error there will be for a moment, by the step itself

    @staticmethod
    def around(axis: str, step: int, margin: int, torque: float) -> Guard:
        """For steps to and fro between here and `step` counts away, with a margin for overshoot on either side."""
        largest = int(COMMANDS["ER"].high or 0)
        error = min(largest, math.ceil(abs(step) * ERROR_SHARE) + 10)
        return Guard(axis, max(step, 0) + margin, max(-step, 0) + margin, error, torque, abs(step))

    def bearing(self, counts: float) -> Guard:
        """For an axis that hangs so far below its place, or would without its integrator."""
        largest = int(COMMANDS["ER"].high or 0)
        return replace(self, error=min(largest, self.error + math.ceil(SPARE * counts)), sure=self.sure + round(counts))

    @property
    def problem(self) -> str:
        """What is wrong with the numbers, or nothing."""
        if self.forward < 0 or self.reverse < 0 or self.forward + self.reverse == 0:
            return "the travel is 0; state how far the axis may go."
        if self.error < 1 or not 0 < self.torque <= 9.9982:
            return "the error limit must be at least 1 count, and the torque limit between 0 and 9.9982 V."
        return ""


def guarded(c: Controller, guard: Guard, folder: Path, body: Callable[[Former], Steps[T]], now: datetime) -> Steps[T]:
    """Narrows, runs `body`, puts back; what cannot be put back now stays on disk."""
    words = f"axis {guard.axis} is being tuned. Wait for its end, or cancel it."
    with recording(c, words), taken(c, guard.axis, words):
        former, around = yield from _begin(c, guard, folder, now)
        began = c.clock()

        def inside() -> Steps[T]:
            yield from _narrow(c, around, former)
            result = yield from body(former)
            not_stopped(c, began)
            return result

        def clear(reason: LinkError | None) -> Steps[None]:
            yield from rest(c, former.axis)
            yield from assign(c, former.axis, {name: former.values[name] for name in GAINS})
            if not isinstance(reason, (Fault, Stopped)):
                yield from _go_back(c, former)

        return (yield from kept(c, former, inside, clear, last=(*PROFILE, *LIMITS)))


def _begin(c: Controller, guard: Guard, folder: Path, now: datetime) -> Steps[tuple[Former, Guard]]:
    """Looks whether it may begin, and reads what the axis is set to and what hangs on it."""
    model = ready(c, guard.axis)
    if guard.problem:
        raise NotAllowed(f"Not started: {guard.problem}")
    yield from _free(c, model, guard.axis)
    former = yield from present(c, guard.axis, HELD, folder, now)
    told = yield from exact(c.nonces, [f"_TE{guard.axis}", f"_TT{guard.axis}"], model.columns)
    error, volts = ((value or 0) / ONE for value in told)
    gains = gains_of(former.values)
    bears = carried(gains, error, volts)
    most = min(guard.torque, former.values["TL"] / ONE)
    if bears > BEARS * most:
        raise NotAllowed(
            f"Not started: axis {guard.axis} needs {bears:.2f} V to stay where it is; a torque limit of {most:.2f} V "
            "would not hold it. Allow more torque."
        )
    around = guard.bearing(max(abs(error), sag(gains, bears)))
    _inside(around, former)
    return former, around


def _free(c: Controller, model: Model, axis: str) -> Steps[None]:
    """Nothing runs, moves or follows; it is a servo with its motor on."""
    yield from still(c, model, "Not started")
    told = yield from exact(c.nonces, [f"_MO{axis}", f"_MT{axis}", f"_TS{axis}"], model.columns)
    off, motor = (0 if value is None else value for value in told[:2])
    if abs(motor) != ONE:
        raise NotAllowed(f"Not started: axis {axis} drives a stepper (MT); there is no loop to tune.")
    if off:
        raise NotAllowed(f"Not started: the motor of axis {axis} is off. Switch it on (SH) first.")
    if side := _tripped(told[2]):
        raise NotAllowed(f"Not started: axis {axis} stands in its {side} limit switch. Move it away first.")


def _tripped(switches: Value | None) -> str:
    """Which limit switch is active, from _TS: unlike _LF and _LR it knows the polarity (CN). Or nothing."""
    if switches is None:
        return ""
    return next((side for side, bit in SIDES.items() if bit.on(switches // ONE)), "")


def _inside(guard: Guard, former: Former) -> None:
    """The stated travel must lie between the limits there are: guards never open one."""
    place, forward, reverse = former.place, former.values["FL"] // ONE, former.values["BL"] // ONE
    if guard.sure >= former.values["ER"] // ONE:
        raise NotAllowed(
            f"Not started: the error at the step, {guard.sure} counts, is not smaller than the error limit ER of "
            f"{former.values['ER'] // ONE} counts; the motor would go off. Take a smaller step, or set a larger ER."
        )
    if place + guard.forward > min(forward, FURTHEST) or place - guard.reverse < max(reverse, -FURTHEST):
        raise NotAllowed(
            f"Not started: from {place} counts the axis would go to between {place - guard.reverse} and "
            f"{place + guard.forward}, beyond its software limits ({reverse} to {forward}). Move it, or state less."
        )


def _narrow(c: Controller, guard: Guard, former: Former) -> Steps[None]:
    """The guards themselves, each proved and read back; a limit that is narrower already stays."""
    values = {
        "OE": ONE,
        "ER": min(scaled(guard.error), former.values["ER"]),
        "TL": min(COMMANDS["TL"].stored(scaled(Fraction(str(guard.torque)))), former.values["TL"]),
        "FL": min(scaled(former.place + guard.forward), former.values["FL"]),
        "BL": max(scaled(former.place - guard.reverse), former.values["BL"]),
    }
    yield from assign(c, former.axis, values)


def watch(c: Controller, axis: str, *, switches: bool = True) -> Steps[bool]:
    """Whether the axis is still commanded to move; Fault where the motor went off or a limit ended the move."""
    assert c.model is not None  # `ready` has looked
    told = yield from exact(c.nonces, [f"_MO{axis}", f"_BG{axis}", f"_SC{axis}", f"_TS{axis}"], c.model.columns)
    off, moving, code = (0 if value is None else value for value in told[:3])
    if off:
        raise Fault(
            f"The motor of axis {axis} went off: its following error passed the limit of this test. The former gains "
            "are put back. Look at the axis, switch it on (SH) when it is safe, and try smaller gains or a smaller "
            "step."
        )
    if not moving and code // ONE in LIMITED:
        raise Fault(f"Axis {axis} met a limit and stopped. Move it away from there, or state less travel.")
    if switches and (side := _tripped(told[3])):
        raise Fault(f"Axis {axis} met its {side} limit switch. Move it away from there, or state less travel.")
    return bool(moving)


def not_stopped(c: Controller, since: float) -> None:
    """Stopped where STOP was pressed since then: reading a record outlives a STOP, moving on does not."""
    if c.stop_pressed_at >= since:
        raise Stopped("STOP was pressed.")


def _go_back(c: Controller, former: Former) -> Steps[None]:
    """To where it began, with the former gains and at the former pace, still between the guards."""
    assert c.model is not None  # `ready` has looked
    axis = former.axis
    told = yield from exact(c.nonces, [f"_MO{axis}", f"_RP{axis}"], c.model.columns)
    off, here = (0 if value is None else value for value in told)
    way = former.place - here // ONE
    if off or not way:
        return
    yield from assign(c, axis, {name: former.values[name] for name in PROFILE})
    for line in (f"PR{axis}={way}", f"BG {axis}"):
        answer = yield from proved(c.nonces, line, LINE_S, REFUSAL_S)
        if answer.kind is not Kind.ACCEPTED:
            return  # it stays where it is; that harms nothing
    while (yield from watch(c, axis, switches=False)):  # this way leads off a switch
        yield Wait(LOOK_S)
