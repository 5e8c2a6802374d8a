"""What a controller records by itself: channels, the plan of a capture, and the captured values (pure, no link)."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from codegen.instructions.records import Source
from device import live

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from codegen.models import Model
    from codegen.setup import Setup

TICKS_S = 1_024_000  # a sample is TM of these
SLOWEST = 8  # RC's exponent: 1 to 8 (dmc-1412-1414.txt l.3420)
FEWEST = 2  # elements of a channel
STARTS_S = 0.5  # a ring must last this long, or its turns could not be counted from outside
TORQUE_FULL, TORQUE_V = 32767, 10.0  # how RD records the motor command (recollection; no manual states it)
ANALOG_CODE = "AF"  # "analog input values" can be recorded (ssc-tol-o-motion.txt l.1923; the letters are recollection)


@dataclass(frozen=True, slots=True)
class What:
    """A kind of value a controller records: how RD calls it, and what one recorded unit means."""

    name: str
    code: str
    label: str
    dimension: str
    per_axis: bool = True
    scale: float = 1.0


def _what(name: str, source: Source, scale: float = 1.0) -> What:
    row = live.LIVE[name]
    return What(name, source.value, row.label, row.dimension, row.per_axis, scale)


# Names and dimensions are those of the live values, so that a channel can be watched and captured (l.3425-3436).
WHATS: tuple[What, ...] = (
    _what("position", Source.POSITION),
    _what("commanded", Source.COMMANDED),
    _what("error", Source.ERROR),
    _what("auxiliary", Source.AUXILIARY),
    _what("torque", Source.TORQUE, TORQUE_V / TORQUE_FULL),
    _what("latch", Source.LATCH),
    _what("stop_code", Source.STOP),
    _what("switches", Source.SWITCHES),
    What("axis_status", Source.STATUS.value, "Status bits", "bits"),
    _what("inputs", Source.INPUTS),
    _what("outputs", Source.OUTPUTS),
    What("analog", ANALOG_CODE, "Analog input", "voltage"),
)
BY_NAME = {row.name: row for row in WHATS}


@dataclass(frozen=True, slots=True)
class Channel:
    """One recorded value; analog inputs 1 to 4 go by the axis letters X to W, inputs and outputs by none."""

    what: str
    axis: str = ""

    @property
    def row(self) -> What:
        return BY_NAME[self.what]

    @property
    def code(self) -> str:
        """As RD takes it: `_TPX`."""
        return f"_{self.row.code}{self.axis}"

    @property
    def label(self) -> str:
        if self.what == "analog":
            return f"Analog input {self.number}"
        return f"{self.row.label} {self.axis}".strip()

    @property
    def number(self) -> int:
        """Of an analog input."""
        return "XYZW".index(self.axis) + 1

    @property
    def live_key(self) -> str:
        """The live value that shows the same, or nothing."""
        if self.what == "analog":
            return f"analog{self.number}"
        return live.key(self.what, self.axis) if self.what in live.LIVE else ""


def channels(model: Model) -> tuple[Channel, ...]:
    """Everything a controller of this type can record; analog inputs only on the SSC (the 141x lists none, l.3425)."""
    found: list[Channel] = []
    for row in WHATS:
        if row.name == "analog":
            inputs = model.analog_inputs if model.family == "ssc" else 0
            found += [Channel("analog", axis) for axis in model.axes[:inputs]]
        else:
            found += [Channel(row.name, axis) for axis in (model.axes if row.per_axis else ("",))]
    return tuple(found)


# ------------------------------------------------------------------------ the plan


class When(StrEnum):
    """What a capture begins with."""

    NOW = "now"
    MOTION = "motion begins"
    INPUT = "input edge"
    LEVEL = "level"


@dataclass(frozen=True, slots=True)
class Trigger:
    """When recording begins; `pre` is the share kept from before it, 0 to 0.9.

    MOTION: the commanded position of `axis` begins to change. INPUT: `number` goes on (`rising`) or off.
    LEVEL: the `channel`, which must be one of the recorded, passes `level` (its own units: counts, V) upwards or down.
    """

    when: When = When.NOW
    axis: str = ""
    number: int = 0
    channel: Channel | None = None
    level: float = 0.0
    rising: bool = True
    pre: float = 0.0

    @property
    def text(self) -> str:
        match self.when:
            case When.NOW:
                return "at once"
            case When.MOTION:
                return f"when {self.axis} begins to move"
            case When.INPUT:
                return f"when input {self.number} goes {'on' if self.rising else 'off'}"
            case When.LEVEL:
                name = self.channel.label if self.channel is not None else ""
                return f"when {name} {'rises above' if self.rising else 'falls below'} {self.level:g}"


@dataclass(frozen=True, slots=True)
class Plan:
    """What to capture: a value of every channel each 2^`exponent` samples, `count` times.

    `go` is sent on the line that starts the recording, right behind it (`BG X`); only with a start at once.
    """

    channels: tuple[Channel, ...]
    exponent: int = 1
    count: int = 500
    trigger: Trigger = field(default_factory=Trigger)
    go: str = ""

    def interval_s(self, tm: float) -> float:
        """Seconds from one recorded value to the next; TM is what the controller says."""
        return (1 << self.exponent) * abs(tm) / TICKS_S


def most(model: Model, channel_count: int, free: int | None = None) -> int:
    """The most values a channel can have; `free`: of the elements the controller says are free."""
    elements = model.elements if free is None else min(free, model.elements)
    return elements // max(1, channel_count)


def objection(plan: Plan, model: Model) -> str:
    """Why a controller of this type cannot carry that out, as one sentence, or nothing."""
    known = channels(model)
    missing = [channel.label for channel in plan.channels if channel not in known]
    trigger = plan.trigger
    if not plan.channels:
        return "Choose at least one channel."
    if missing:
        return f"This controller does not record {missing[0]}."
    if len(set(plan.channels)) < len(plan.channels):
        return "A channel is chosen twice."
    if len(plan.channels) > model.recorded_channels:
        return f"This controller records {model.recorded_channels} channels at once; {len(plan.channels)} are chosen."
    if not 1 <= plan.exponent <= SLOWEST:
        return f"The interval is one value each 2 to {1 << SLOWEST} samples."
    if not FEWEST <= plan.count <= most(model, len(plan.channels)):
        return f"{plan.count} values a channel do not fit: {FEWEST} to {most(model, len(plan.channels))} do."
    if plan.go and trigger.when is not When.NOW:
        return "A command can be sent along only with a start at once."
    return _trigger_objection(plan, model)


def too_short(plan: Plan, tm: float) -> str:
    """Why a trigger cannot be waited for with so few values at this sample time, as one sentence, or nothing."""
    lasts = plan.count * plan.interval_s(tm)
    if plan.trigger.when is When.NOW or lasts >= STARTS_S:
        return ""
    return (
        f"To wait for a trigger the recording must last {STARTS_S:g} s at least; this one lasts {lasts * 1000:.0f} ms. "
        "Take more values or a longer interval."
    )


def _trigger_objection(plan: Plan, model: Model) -> str:
    trigger = plan.trigger
    if not 0.0 <= trigger.pre <= 0.9:
        return "The share before the trigger lies between 0 and 90 %."
    if trigger.when is When.MOTION and trigger.axis not in tuple(model.axes):
        return f"There is no axis {trigger.axis or '(none)'} whose motion could be waited for."
    if trigger.when is When.INPUT and not 1 <= trigger.number <= model.inputs:
        return f"There is no input {trigger.number}: this controller has 1 to {model.inputs}."
    if trigger.when is When.LEVEL and trigger.channel not in plan.channels:
        return "The level belongs to one of the recorded channels; choose which."
    if trigger.when is When.LEVEL and trigger.channel is not None and not trigger.channel.live_key:
        return f"{trigger.channel.label} cannot be waited for: the controller tells it only in recordings."
    return ""


def shown_by(trigger: Trigger, recorded: Collection[Channel]) -> Channel | None:
    """The recorded channel that shows the trigger to the very value; None: it is only known from polling."""
    wanted: tuple[Channel, ...]
    match trigger.when:
        case When.MOTION:
            wanted = (Channel("commanded", trigger.axis), Channel("axis_status", trigger.axis))
        case When.INPUT:
            wanted = (Channel("inputs"),)
        case _:
            wanted = (trigger.channel,) if trigger.channel is not None else ()
    return next((channel for channel in wanted if channel in recorded), None)


# ------------------------------------------------------------------- what was captured


@dataclass(frozen=True, eq=False)
class Capture:
    """Recorded values, `values[channel, n]` in counts, V, or bits; NaN where not (yet) read.

    Element `trigger` is the first one at or after the trigger (outside, where only a part was kept), `early` how many
    elements earlier it may have been (0: exact to one interval). `model`, `controller`, `when`, `setup`, `note` say
    where it comes from. `moments` are the times of values that were watched live: they come as the line carries them.
    """

    channels: tuple[Channel, ...]
    values: NDArray[np.float64]
    exponent: int
    tm: float
    trigger: int = 0
    early: int = 0
    trigger_text: str = "at once"
    model: str = ""
    controller: str = ""
    when: str = ""
    setup: Setup | None = None
    complete: bool = True
    note: str = ""
    moments: NDArray[np.float64] | None = None

    @property
    def count(self) -> int:
        return int(self.values.shape[1])

    @property
    def interval_samples(self) -> int:
        return 1 << self.exponent

    @cached_property
    def interval_s(self) -> float:
        """From one value to the next; of watched ones that is usual."""
        if self.moments is not None and self.count > 1:
            return float(np.median(np.diff(self.moments)))
        return self.interval_samples * abs(self.tm) / TICKS_S

    @cached_property
    def times(self) -> NDArray[np.float64]:
        """Seconds from the trigger."""
        if self.moments is not None:
            return self.moments
        return (np.arange(self.count, dtype=np.float64) - self.trigger) * np.float64(self.interval_s)

    @property
    def early_s(self) -> float:
        """How much before time 0 the trigger may have been, in seconds."""
        return self.early * self.interval_s

    def of(self, channel: Channel) -> NDArray[np.float64]:
        """The values of one channel; KeyError when it was not recorded."""
        if channel not in self.channels:
            raise KeyError(channel.label)
        row: NDArray[np.float64] = self.values[self.channels.index(channel)]
        return row

    def scale(self, channel: Channel) -> tuple[float, str]:
        """What one user unit counts, and its name: lengths by the setup's axis, other values as they are."""
        return scale_of(channel, self.setup)


def cut(capture: Capture, low_s: float, high_s: float) -> Capture:
    """Only the values between two times; the trigger stays where it was, perhaps outside."""
    inside = np.flatnonzero((capture.times >= low_s) & (capture.times <= high_s))
    first, last = (int(inside[0]), int(inside[-1]) + 1) if len(inside) else (0, 0)
    part = capture.complete and last - first == capture.count
    values = capture.values[:, first:last].copy()
    if capture.moments is not None:
        return replace(capture, values=values, moments=capture.moments[first:last].copy(), complete=part)
    return replace(capture, values=values, trigger=capture.trigger - first, complete=part)


def scale_of(channel: Channel, setup: Setup | None) -> tuple[float, str]:
    """Counts (or V, or bits) to one shown unit, and the unit's name."""
    dimension = channel.row.dimension
    if dimension == "voltage":
        return 1.0, "V"
    if dimension != "position":
        return 1.0, ""
    if setup is None or channel.axis not in tuple(setup.letters):
        return 1.0, "counts"
    axis = setup.axis(channel.axis)
    return float(axis.scale), axis.symbol


def facts(capture: Capture) -> Mapping[str, str]:
    """What a person wants to know of a capture beside its curves."""
    span = float(np.ptp(capture.times)) if capture.count else 0.0
    every = f"every {capture.interval_samples} samples = {capture.interval_s * 1000:.4g} ms"
    if capture.moments is not None:
        every = f"read live, about every {capture.interval_s * 1000:.3g} ms"
    return {
        "Captured": capture.when,
        "Controller": capture.controller,
        "Values": f"{capture.count} a channel, {every}, {span:.4g} s",
        "Trigger": capture.trigger_text + (f", up to {capture.early_s * 1000:.3g} ms earlier" if capture.early else ""),
        "Note": capture.note,
    }
