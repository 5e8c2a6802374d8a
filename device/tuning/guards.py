"""What stands around every excitation of an axis (safety.md 4): limits only ever narrowed, former values on disk first.

`guarded` runs steps inside: nothing else runs or moves, OE 1, ER, TL, FL and BL lie around the travel that a person
stated, and everything is put back on finish, cancel, fault and STOP. Where that is not possible (a cut cable, a
computer that died) the file stays, and `left_behind` finds it: `put_back` is what is then offered first.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from codegen.files import save_text
from codegen.numbers import is_short_decimal, plain
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE, scaled
from codegen.twoletter.problems import ERROR_TEXTS
from device.backing_up import LINE_S, REFUSAL_S, exact
from device.backup import Value, hexadecimal
from device.download import proved
from device.identify import fence
from device.jog import FURTHEST
from device.lease import LOOK_S
from device.stop import StopState
from device.tasks import LinkError, LinkLost, NotAllowed, Priority, Steps, Stopped, Wait
from device.wire import FRAME_COLUMNS, Kind

if TYPE_CHECKING:
    from concurrent.futures import Future

    from codegen.models import Model
    from device.api import Controller

T = TypeVar("T")
FILTER = ("KD", "KP", "KI", "FV", "FA")  # as they are put back: damping first
GAINS = (*FILTER, "IL", "OF")
LIMITS = ("TL", "ER", "FL", "BL", "OE")
PROFILE = ("SP", "AC", "DC", "IT")
HELD = GAINS + LIMITS + PROFILE
SUFFIX = ".before-tuning"
LIMITED = (2, 3)  # stop codes: FL or the forward switch, BL or the reverse one
STILL_S = 3.0  # for an axis that was told to stop
STOPPED_S = 6.0  # for STOP to be proved before anything is put back
ERROR_SHARE = 1.5  # of a step: more than that and the loop is not following any more


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

    @staticmethod
    def around(axis: str, step: int, margin: int, torque: float) -> Guard:
        """For steps to and fro between here and `step` counts away, with a margin for overshoot on either side."""
        largest = int(COMMANDS["ER"].high or 0)
        error = min(largest, math.ceil(abs(step) * ERROR_SHARE) + 10)
        return Guard(axis, max(step, 0) + margin, max(-step, 0) + margin, error, torque)

    @property
    def problem(self) -> str:
        """What is wrong with the numbers, or nothing."""
        if self.forward < 0 or self.reverse < 0 or self.forward + self.reverse == 0:
            return "the travel is 0; state how far the axis may go."
        if self.error < 1 or not 0 < self.torque <= 9.9982:
            return "the error limit must be at least 1 count, and the torque limit between 0 and 9.9982 V."
        return ""


@dataclass(frozen=True, slots=True)
class Former:
    """What an axis was set to before its tuning began; `file` is where it is kept."""

    axis: str
    model: str
    serial: int
    kind: str
    who: str
    when: str
    place: int  # counts
    values: Mapping[str, Value] = field(default_factory=dict)
    file: Path = field(default=Path(), compare=False)

    def gains(self) -> str:
        """As words: `KP 6, KI 0, KD 64`."""
        return ", ".join(f"{name} {number(self.values[name])}" for name in ("KP", "KI", "KD") if name in self.values)


def number(value: Value) -> str:
    """A value of a register as a short decimal."""
    return f"{value / ONE:.4f}".rstrip("0").rstrip(".")


# ----------------------------------------------------------------------- on disk


def keep(former: Former) -> None:
    """On disk, complete and surely, before anything is changed; NotAllowed where that is not possible."""
    told = {name: getattr(former, name) for name in ("axis", "model", "serial", "kind", "who", "when", "place")}
    try:
        former.file.parent.mkdir(parents=True, exist_ok=True)
        save_text(former.file, json.dumps({**told, "values": dict(former.values)}, indent=1) + "\n")
    except OSError as failure:
        raise NotAllowed(
            f"Not started: the present values can not be kept in {former.file.parent} "
            f"({failure.strerror or failure}), so they could not be put back."
        ) from failure


def forget(former: Former) -> None:
    """They are back in the controller, or no longer wanted."""
    former.file.unlink(missing_ok=True)


def left_behind(folder: Path) -> tuple[Former, ...]:
    """What interrupted runs left, oldest first: the oldest holds the values from before all of them."""
    found = [former for file in folder.glob(f"*{SUFFIX}") if (former := _read(file)) is not None]
    return tuple(sorted(found, key=lambda each: each.when))


def _read(file: Path) -> Former | None:
    try:
        told = json.loads(file.read_text(encoding="utf-8"))
        values = {str(name): int(value) for name, value in told["values"].items() if name in HELD}
        texts = (str(told[name]) for name in ("kind", "who", "when"))
        kind, who, when = texts
        axis, model = str(told["axis"]), str(told["model"])
        return Former(axis, model, int(told["serial"]), kind, who, when, int(told["place"]), values, file)
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None  # written by another version, or damaged: nothing in it can be trusted


def meant(former: Former, c: Controller) -> bool:
    """Whether the connected controller may be the one it was read from: never another serial number or type."""
    serial = (c.identity.serial or 0) if c.identity is not None else 0
    return c.model is not None and c.model.name == former.model and serial == former.serial and c.kind == former.kind


# ------------------------------------------------------------------------- steps


def guarded(c: Controller, guard: Guard, folder: Path, body: Callable[[Former], Steps[T]], now: datetime) -> Steps[T]:
    """Narrows, runs `body`, puts back; what can not be put back now stays on disk."""
    if c.motion.busy:
        raise NotAllowed(f"Not started: {c.motion.busy} is moved by hand. Let go first.")
    c.motion.taken = f"axis {guard.axis} is being tuned. Wait for its end, or cancel it."
    try:
        return (yield from _inside_guards(c, guard, folder, body, now))
    finally:
        c.motion.taken = ""


def _inside_guards(
    c: Controller, guard: Guard, folder: Path, body: Callable[[Former], Steps[T]], now: datetime
) -> Steps[T]:
    former = yield from begin(c, guard, folder, now)
    began = c.clock()
    try:
        try:
            yield from _narrow(c, guard, former)
            result = yield from body(former)
            not_stopped(c, began)
        except (Stopped, LinkLost):
            raise
        except LinkError as reason:
            yield from _finish(c, former, str(reason), back=not isinstance(reason, Fault))
            raise
        yield from _finish(c, former, "The run is complete.", back=True)
    except Stopped as stop:
        yield from _until_stopped(c)
        yield from _finish(c, former, str(stop), back=False)
        raise Stopped(f"STOP ended the run. The former values of axis {former.axis} are back.") from stop
    return result  # a lost link: the controller keeps OE, ER and limits, the file is offered when it answers again


def begin(c: Controller, guard: Guard, folder: Path, now: datetime) -> Steps[Former]:
    """Looks whether it may begin, reads what the axis is set to, and keeps it on disk."""
    model = ready(c, guard.axis)
    if guard.problem:
        raise NotAllowed(f"Not started: {guard.problem}")
    place = yield from _free(c, model, guard.axis)
    found = yield from exact(c.nonces, [f"_{name}{guard.axis}" for name in HELD], model.columns)
    values = {name: value for name, value in zip(HELD, found, strict=True) if value is not None}
    missing = [name for name in HELD if name not in values]
    if missing:
        raise NotAllowed(f"Not started: the controller does not tell {', '.join(missing)} of axis {guard.axis}.")
    _inside(guard, place, values)
    serial = (c.identity.serial or 0) if c.identity is not None else 0
    file = folder / f"{model.name}-{serial}-{guard.axis}-{now:%Y%m%d-%H%M%S-%f}{SUFFIX}"
    former = Former(guard.axis, model.name, serial, str(c.kind), c.who, now.isoformat(), place, values, file)
    keep(former)
    return former


def ready(c: Controller, axis: str, what: str = "Not started") -> Model:
    """The controller's model where an axis of it may be tuned at all; NotAllowed with the reason otherwise."""
    if not c.control:
        raise NotAllowed(f"{what}: this is Watch. Take Control first.")
    if c.model is None:
        raise NotAllowed(f"{what}: the controller's type is not known.")
    if c.resting():
        raise NotAllowed(f"{what}: {c.resting()}")
    if axis not in c.model.axes:
        raise NotAllowed(f"{what}: this controller has no axis {axis}.")
    return c.model


def _free(c: Controller, model: Model, axis: str) -> Steps[int]:
    """Where the axis is commanded to stand; nothing runs, moves or follows, it is a servo with its motor on."""
    yield from still(c, model, "Not started")
    told = yield from exact(c.nonces, [f"_MO{axis}", f"_MT{axis}", f"_RP{axis}"], model.columns)
    off, motor, place = (0 if value is None else value for value in told)
    if abs(motor) != ONE:
        raise NotAllowed(f"Not started: axis {axis} drives a stepper (MT); there is no loop to tune.")
    if off:
        raise NotAllowed(f"Not started: the motor of axis {axis} is off. Switch it on (SH) first.")
    return place // ONE


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


def _inside(guard: Guard, place: int, values: Mapping[str, Value]) -> None:
    """The stated travel must lie between the limits there are: guards never open one."""
    forward, reverse = values["FL"] // ONE, values["BL"] // ONE
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


def assign(c: Controller, axis: str, values: Mapping[str, Value]) -> Steps[None]:
    """Sets registers of an axis and reads them back; LinkError where the controller holds another value."""
    assert c.model is not None  # `ready` has looked
    columns = c.model.columns
    for line in _packed([f"{name}{axis}={_text(name, value)}" for name, value in values.items()], columns):
        answer = yield from proved(c.nonces, line, LINE_S, REFUSAL_S)
        if answer.kind is Kind.SILENT:
            raise LinkLost(f"The controller stopped answering at “{line}”.")
        if answer.kind is not Kind.ACCEPTED:
            fenced = yield from fence(c.nonces)
            code = int(fenced.values[0]) if fenced.kind is Kind.VALUES else 0
            raise LinkError(f"“{line}” was refused: error {code}, {ERROR_TEXTS.get(code, 'unknown error')}.")
    found = yield from exact(c.nonces, [f"_{name}{axis}" for name in values], columns)
    wrong = [name for (name, value), there in zip(values.items(), found, strict=True) if not _same(name, value, there)]
    if wrong:
        raise LinkError(f"The controller did not take {', '.join(wrong)} of axis {axis}.")


def _packed(commands: list[str], columns: int) -> list[str]:
    lines: list[str] = []
    for command in commands:
        if lines and len(lines[-1]) + 2 + len(command) + FRAME_COLUMNS <= columns:
            lines[-1] += f";{command}"
        else:
            lines.append(command)
    return lines


def _same(name: str, wanted: Value, there: Value | None) -> bool:
    """To the resolution of the register."""
    grain = max(int(Fraction(COMMANDS[name].step or 0) * ONE), 1)
    return there is not None and abs(wanted - there) < grain


def _text(name: str, value: Value) -> str:
    """Short where a decimal of few places is exact, else to the last bit; what the register makes the same of it."""
    stored = COMMANDS[name].stored
    value = next((each for each in (value, value + 1, value - 1) if stored(each) == value), value)
    exactly = Fraction(value, ONE)
    text = plain(exactly) if is_short_decimal(exactly) else ""
    return text if text and len(text) <= 11 else hexadecimal(value)


def watch(c: Controller, axis: str) -> Steps[bool]:
    """Whether the axis is still commanded to move; Fault where the motor went off or a limit ended the move."""
    assert c.model is not None  # `ready` has looked
    told = yield from exact(c.nonces, [f"_MO{axis}", f"_BG{axis}", f"_SC{axis}"], c.model.columns)
    off, moving, code = (0 if value is None else value for value in told)
    if off:
        raise Fault(
            f"The motor of axis {axis} went off: its following error passed the limit of this test. The former gains "
            "are put back. Look at the axis, switch it on (SH) when it is safe, and try smaller gains or a smaller "
            "step."
        )
    if not moving and code // ONE in LIMITED:
        raise Fault(f"Axis {axis} met a limit and stopped. Move it away from there, or state less travel.")
    return bool(moving)


def not_stopped(c: Controller, since: float) -> None:
    """Stopped where STOP was pressed since then: reading a record outlives a STOP, moving on does not."""
    if c.stop_pressed_at >= since:
        raise Stopped("STOP was pressed.")


def _until_stopped(c: Controller) -> Steps[None]:
    """After STOP nothing is sent before its proof; without it the file stays for later."""
    end = c.clock() + STOPPED_S
    while c.stop_state in (StopState.STOPPING, StopState.NOT_CONFIRMED):
        if c.clock() > end:
            raise LinkLost("STOP was not confirmed; the former values are kept, and offered when the axis is at rest.")
        yield Wait(0.05)


def _finish(c: Controller, former: Former, why: str, *, back: bool) -> Steps[None]:
    """Still, former gains, back to where it began, former limits and speeds; then the file is no longer needed."""
    try:
        yield from _rest(c, former.axis)
        yield from assign(c, former.axis, {name: former.values[name] for name in GAINS})
        if back:
            yield from _go_back(c, former)
        yield from assign(c, former.axis, {name: former.values[name] for name in (*PROFILE, *LIMITS)})
    except LinkError as failure:
        raise type(failure)(
            f"{why} The former values of axis {former.axis} are not all back: {failure} They are kept on this computer "
            "and offered again."
        ) from failure
    forget(former)


def _rest(c: Controller, axis: str) -> Steps[None]:
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
    while (yield from watch(c, axis)):
        yield Wait(LOOK_S)


# ------------------------------------------------------------------ after a crash


def now_there(c: Controller, former: Former) -> Future[dict[str, Value]]:
    """What the controller holds of it at present."""
    return c.run(_there(c, former), Priority.USER, "user")


def _there(c: Controller, former: Former) -> Steps[dict[str, Value]]:
    assert c.model is not None  # `meant` has looked
    found = yield from exact(c.nonces, [f"_{name}{former.axis}" for name in former.values], c.model.columns)
    return {name: value for name, value in zip(former.values, found, strict=True) if value is not None}


def put_back(c: Controller, former: Former) -> Future[str]:
    """The former values into the controller; the sentence says which gains hold again."""
    return c.run(putting_back(c, former), Priority.USER, "user")


def putting_back(c: Controller, former: Former) -> Steps[str]:
    """Only while nothing moves; the file goes when everything is read back."""
    model = ready(c, former.axis, "Not put back")
    yield from _rest(c, former.axis)  # it may still jog at speed 0
    yield from still(c, model, "Not put back")
    ordered = {name: former.values[name] for name in (*GAINS, *PROFILE, *LIMITS) if name in former.values}
    yield from assign(c, former.axis, ordered)
    forget(former)
    return f"Axis {former.axis} is set as it was before its tuning: {former.gains()}. Nothing was burned."
