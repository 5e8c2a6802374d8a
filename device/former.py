"""What an axis was set to before a step that changes something: on disk before the first change, put back at its end.

`kept` runs such a step and puts everything back on finish, cancel, fault and STOP. Where that is not possible (a cut
cable, a computer that died) the file stays, and `left_behind` finds it: putting it back is what is then offered first.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import datetime
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from codegen.disk import save_text
from codegen.numbers import is_short_decimal, plain
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE
from device.backing_up import exact
from device.backup import Value, hexadecimal
from device.quiet import ready, rest, said, still, until_stopped
from device.tasks import LinkError, LinkLost, NotAllowed, Priority, Steps, Stopped
from device.wire import FRAME_COLUMNS

if TYPE_CHECKING:
    from concurrent.futures import Future

    from device.api import Controller

T = TypeVar("T")
FILTER = ("KD", "KP", "KI", "FV", "FA")  # as they are put back: damping first
GAINS = (*FILTER, "IL", "OF")
LIMITS = ("TL", "ER", "FL", "BL", "OE")
PROFILE = ("SP", "AC", "DC", "IT")
HELD = GAINS + LIMITS + PROFILE
ORDER = ("MT", "KS", *GAINS, *PROFILE, *LIMITS)  # in which they are put back: what guards the axis goes last
SUFFIX = ".before-tuning"


@dataclass(frozen=True, slots=True)
class Former:
    """What an axis was set to before; `file` is where it is kept."""

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
        """As words: `KP 6, KI 0, KD 64`; nothing where they were not changed."""
        if "KP" not in self.values:
            return ""
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
            f"Not started: the present values cannot be kept in {former.file.parent} "
            f"({failure.strerror or failure}), so they could not be put back."
        ) from failure


def forget(former: Former) -> None:
    """They are back in the controller, or no longer wanted."""
    former.file.unlink(missing_ok=True)


def left_behind(folder: Path) -> tuple[Former, ...]:
    """What interrupted steps left, oldest first: the oldest holds the values from before all of them."""
    found = [former for file in folder.glob(f"*{SUFFIX}") if (former := _read(file)) is not None]
    return tuple(sorted(found, key=lambda each: each.when))


def _read(file: Path) -> Former | None:
    try:
        told = json.loads(file.read_text(encoding="utf-8"))
        values = {str(name): int(value) for name, value in told["values"].items() if name in ORDER}
        kind, who, when = (str(told[name]) for name in ("kind", "who", "when"))
        axis, model = str(told["axis"]), str(told["model"])
        return Former(axis, model, int(told["serial"]), kind, who, when, int(told["place"]), values, file)
    except (OSError, ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError):
        return None  # written by another version, or damaged: nothing in it can be trusted


def meant(former: Former, c: Controller) -> bool:
    """Whether the connected controller may be the one it was read from: never another serial number or type."""
    serial = (c.identity.serial or 0) if c.identity is not None else 0
    return c.model is not None and c.model.name == former.model and serial == former.serial and c.kind == former.kind


# ------------------------------------------------------------------------- steps


@contextmanager
def taken(c: Controller, axis: str, words: str) -> Iterator[None]:
    """Nobody moves anything by hand meanwhile; `words` say why. A line that is closed stops this axis."""
    if c.motion.busy:
        raise NotAllowed(f"Not started: {c.motion.busy} is moved by hand. Let go first.")
    c.motion.taken, c.motion.taken_axis = words, axis
    try:
        yield
    finally:
        c.motion.taken = c.motion.taken_axis = ""


def present(
    c: Controller, axis: str, names: Sequence[str], folder: Path, now: datetime, *, place: str = "RP"
) -> Steps[Former]:
    """What the controller holds of an axis; `place` is RP, or TP for an axis whose motor is off. Not kept yet."""
    model = c.model
    assert model is not None  # `ready` has looked
    found = yield from exact(c.nonces, [f"_{name}{axis}" for name in (*names, place)], model.columns)
    values = {name: value for name, value in zip((*names, place), found, strict=True) if value is not None}
    if missing := [name for name in (*names, place) if name not in values]:
        raise NotAllowed(f"Not started: the controller does not tell {', '.join(missing)} of axis {axis}.")
    counts = values.pop(place) // ONE
    serial = (c.identity.serial or 0) if c.identity is not None else 0
    file = folder / f"{model.name}-{serial}-{axis}-{now:%Y%m%d-%H%M%S-%f}{SUFFIX}"
    return Former(axis, model.name, serial, str(c.kind), c.who, now.isoformat(), counts, values, file)


def kept(
    c: Controller,
    former: Former,
    body: Callable[[], Steps[T]],
    clear: Callable[[LinkError | None], Steps[None]],
    *,
    last: Sequence[str] = ORDER,
    lasting: bool = False,
) -> Steps[T]:
    """Keeps on disk, runs `body`, and whatever ends it, `clear` and everything back; a lost link leaves the file.

    `clear` brings the axis to rest and is told what ended the body, None where it came to its end; `last` is what it
    leaves to be put back. `lasting`: what the body has set is meant to stay, and only put back where it failed.
    """
    keep(former)
    try:
        try:
            result = yield from body()
        except (Stopped, LinkLost):
            raise  # a lost link: the controller keeps OE, ER and limits, the file is offered when it answers again
        except LinkError as reason:
            yield from _finish(c, former, f"{reason} ", clear(reason), last)
            raise
        if lasting:
            forget(former)
        else:
            yield from _finish(c, former, "", clear(None), last)
        return result
    except Stopped as stop:
        yield from until_stopped(c)
        yield from _finish(c, former, f"{stop} ", clear(stop), last)
        raise Stopped(f"STOP ended it. The former values of axis {former.axis} are back.") from stop


def _finish(c: Controller, former: Former, why: str, clear: Steps[None], last: Sequence[str]) -> Steps[None]:
    """The axis at rest, former values; then the file is no longer needed."""
    try:
        yield from clear
        yield from _back(c, former, last)
    except LinkError as failure:
        raise type(failure)(
            f"{why}The former values of axis {former.axis} are not all back: {failure} They are kept on this computer "
            "and offered again."
        ) from failure


def _back(c: Controller, former: Former, names: Sequence[str] = ORDER) -> Steps[None]:
    yield from assign(c, former.axis, {name: former.values[name] for name in names if name in former.values})
    forget(former)


# -------------------------------------------------------------------- registers


def assign(c: Controller, axis: str, values: Mapping[str, Value]) -> Steps[None]:
    """Sets registers of an axis and reads them back; LinkError where the controller holds another value."""
    assert c.model is not None  # `ready` has looked
    columns = c.model.columns
    for line in _packed([f"{name}{axis}={_text(name, value)}" for name, value in values.items()], columns):
        yield from said(c, line)
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


# ------------------------------------------------------------------ after a crash


def named(c: Controller) -> Future[None]:
    """The serial number of a controller that was met without one, as a disturbed line leaves it."""
    return c.run(_named(c), Priority.USER, "user")


def _named(c: Controller) -> Steps[None]:
    assert c.model is not None  # it is ready
    told = yield from exact(c.nonces, ["_BN"], c.model.columns)
    if c.identity is not None and told[0] is not None:
        c.identity = dataclasses.replace(c.identity, serial=told[0] // ONE)


def now_there(c: Controller, former: Former) -> Future[dict[str, Value]]:
    """What the controller holds of it at present."""
    return c.run(_there(c, former), Priority.USER, "user")


def _there(c: Controller, former: Former) -> Steps[dict[str, Value]]:
    assert c.model is not None  # `meant` has looked
    found = yield from exact(c.nonces, [f"_{name}{former.axis}" for name in former.values], c.model.columns)
    return {name: value for name, value in zip(former.values, found, strict=True) if value is not None}


def put_back(c: Controller, former: Former, *, motor_off: bool = False) -> Future[str]:
    """The former values into the controller; the sentence says what holds again."""
    return c.run(putting_back(c, former, motor_off=motor_off), Priority.USER, "user")


def putting_back(c: Controller, former: Former, *, motor_off: bool = False) -> Steps[str]:
    """Only while nothing moves; the file goes when everything is read back. `motor_off`: MO before it."""
    model, axis = ready(c, former.axis, "Not put back"), former.axis
    yield from rest(c, axis)  # it may still jog at speed 0
    yield from still(c, model, "Not put back")
    if motor_off:
        yield from said(c, f"MO {axis}")
    yield from _back(c, former)
    gains = f"the gains from before: {former.gains()}"
    what = "the settings from before" if motor_off else gains
    return f"Axis {axis} has {what}.{' Its motor is off.' if motor_off else ''} Nothing was burned."
