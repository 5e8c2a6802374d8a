"""The page of each step as the window shows it: pure functions of what is known at this moment."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from codegen.setup import MOTOR_WORDS, Axis
from device.commissioning.judge import Moved
from device.commissioning.moves import TRIAL_COUNTS, TRIAL_ERROR
from device.commissioning.record import Record, Verdict
from device.commissioning.seen import SWITCHES, Switches, Turned
from device.commissioning.steps import Step
from widgets.commissioning.page import Act, Entered, Page, Reading, Tick
from widgets.parts.units import shown

SWITCH_KINDS = (("-1", "closes to zero volts when tripped (CN -1)"), ("1", "opens when tripped (CN 1)"))
HALLS = (("0", "none"), *((str(first), f"inputs {first} to {first + 2}") for first in range(1, 6)))
STEPPERS = tuple((kind.value, words) for kind, words in MOTOR_WORDS.items() if "stepper" in kind.value)
WAIT = "Something is under way; wait for its end or press STOP."


@dataclass(frozen=True)
class Now:
    """What is known: the record, live values (NaN: not read), and what was seen since “Begin”."""

    record: Record
    axis: Axis
    live: Mapping[str, float] = field(default_factory=dict)
    reason: str = ""  # why nothing may be sent now
    busy: str = ""
    turned: Turned | None = None
    switches: Switches | None = None
    moved: Moved | None = None
    measured: bool = False  # a scale was measured that the setup does not have

    def text(self, step: str, name: str, usual: str = "") -> str:
        return self.record.text(step, name, usual)

    def counts(self, name: str) -> str:
        """A live value in counts."""
        value = self.live.get(name, math.nan)
        return f"{value:.0f}" if math.isfinite(value) else "–"

    @property
    def send(self) -> str:
        """Why no button that sends something can be pressed."""
        return WAIT if self.busy else self.reason

    @property
    def motor(self) -> str:
        off = self.live.get("motor_off", math.nan)
        return "–" if not math.isfinite(off) else "off" if off else "on"


Parts = tuple[tuple[Reading, ...], tuple[Entered, ...], tuple[Tick, ...], tuple[Act, ...]]


def page_of(step: Step, steps: tuple[Step, ...], now: Now) -> Page:
    """The page of a step; where others come first its buttons are grey and say so."""
    finding, blocked = now.record.of(step.key), now.record.missing(step, steps)
    readings, fields, ticks, acts = PARTS[step.key](now)
    if blocked:
        acts = tuple(Act(act.name, act.label, blocked, act.primary, act.moves) for act in acts)
    return Page(
        step.key, step.title, step.todo, step.manual, step.judged, readings, fields, ticks, acts,
        finding.verdict.value, finding.sentence, finding.advice, finding.facts, blocked, now.busy,
    )  # fmt: skip


def _safety(now: Now) -> Parts:
    role = "ok" if now.motor == "off" else "warning" if now.motor == "on" else "quiet"
    ticks = (
        Tick("estop", "The emergency stop takes the power from the drive, and is within my reach",
             now.text("safety", "estop") == "yes"),
        Tick("disabled", "With the motor off, the drive shows that it is disabled and the shaft turns freely",
             now.text("safety", "disabled") == "yes"),
    )  # fmt: skip
    acts = (Act("off", "Motor off", now.send, primary=now.motor != "off"), Act("safety", "Judge", _motor_on(now)))
    return (Reading("Motor", now.motor, role),), (), ticks, acts


def _motor_on(now: Now) -> str:
    return "" if now.motor == "off" else "Switch the motor off first: it would hold the axis."


def _encoder(now: Now) -> Parts:
    seen = now.turned or Turned()
    told = now.turned is not None and seen.first is not None
    in_units = f"{shown(seen.moved, now.axis)} {now.axis.symbol}" if now.axis.is_set_up else "–"
    readings = (
        Reading("Position, counts", now.counts("position")),
        Reading("Moved, counts", str(seen.moved) if told else "–"),
        Reading("By the setup", in_units if told else "–"),
        Reading("Lowest, highest", f"{seen.low}, {seen.high}" if told else "–"),
    )
    distance = now.text("encoder", "distance")
    fields = (Entered("distance", "Distance moved", distance, f"{now.axis.symbol}, forward above 0"),)
    acts = (
        Act("begin_encoder", "Begin" if not told else "Begin again", _motor_on(now), primary=not told),
        Act("encoder", "Judge", "" if told else "Press “Begin” first.", primary=told),
        *_take_scale(now),
    )
    return readings, fields, (), acts


def _take_scale(now: Now) -> tuple[Act, ...]:
    return (Act("take_scale", "Take the measured scale into the setup"),) if now.measured else ()


def _switches(now: Now) -> Parts:
    seen = now.switches
    names = {"forward": "forward_limit", "reverse": "reverse_limit", "home": "home"}
    changed = {name for name in SWITCHES if seen is not None and seen.levels.get(name) != seen.rest.get(name)}
    readings = [
        Reading(
            SWITCHES[name].capitalize(),
            str(seen.levels[name]) if seen is not None and seen.levels else now.counts(key),
            "warning" if name in changed else "",
        )
        for name, key in names.items()
    ]
    asked = seen.asked if seen is not None else ""
    told = f"{SWITCHES[asked]} switch" if asked else "–" if seen is None else "all seen"
    readings.append(Reading("Trip now", told, "ok" if asked else "quiet"))
    fields = (
        Entered("limit", "Limit switch", now.text("switches", "limit", "-1"), "", SWITCH_KINDS),
        Entered("home", "Home switch", now.text("switches", "home", "-1"), "", SWITCH_KINDS),
    )
    waiting = "" if asked else "Press “Begin” first."
    acts = (
        Act("begin_switches", "Begin" if seen is None else "Begin again", now.send, primary=not asked),
        Act("nothing", "Nothing changed", waiting),
        Act("not_fitted", "Not fitted", waiting),
    )
    return tuple(readings), fields, (), acts


def _guards(now: Now) -> Parts:
    fields = (
        Entered("error", "Error limit (ER)", now.text("guards", "error", "2000"), "counts"),
        Entered("torque", "Torque limit (TL)", now.text("guards", "torque", "1"), "V"),
    )
    return (Reading("Motor", now.motor),), fields, (), (Act("guards", "Set", now.send, primary=True),)


def _phases(now: Now) -> Parts:
    fields = (
        Entered("cycle", "Magnetic cycle (BM)", now.text("phases", "cycle"), "counts: a turn ÷ pole pairs"),
        Entered("halls", "Hall sensors (BI)", now.text("phases", "halls", "0"), "", HALLS),
        Entered("volts", "Voltage (BS)", now.text("phases", "volts", "2"), "V"),
        Entered("time", "Time for each phase (BS)", now.text("phases", "time", "200"), "ms"),
    )
    return _going(now), fields, (), (Act("phases", "Test phases…", now.send, primary=True, moves=True),)


def _zero(now: Now) -> Parts:
    fields = (
        Entered("offset", "Offset of the hall sensors (BB)", now.text("zero", "offset", "0"), "degrees"),
        Entered("volts", "Voltage (BZ)", now.text("zero", "volts", "2"), "V"),
    )
    return _going(now), fields, (), (Act("zero", "Drive to zero…", now.send, primary=True, moves=True),)


def _going(now: Now) -> tuple[Reading, ...]:
    return (
        Reading("Motor", now.motor, "warning" if now.motor == "on" else ""),
        Reading("Position, counts", now.counts("position")),
        Reading("Error, counts", "–" if now.motor == "off" else now.counts("error")),
        Reading("Motor command, V", _volts(now)),
    )


def _volts(now: Now) -> str:
    value = now.live.get("torque", math.nan)
    return f"{value:.2f}" if math.isfinite(value) else "–"


def _stepping(now: Now) -> tuple[Reading, ...]:
    """A stepper: what was commanded, what went out, and an encoder where there is one."""
    return (
        Reading("Motor", now.motor, "warning" if now.motor == "on" else ""),
        Reading("Commanded, pulses", now.counts("commanded")),
        Reading("Sent, pulses", now.counts("auxiliary")),
        Reading("Encoder, counts", now.counts("position")),
    )


def _stepper(now: Now) -> Parts:
    fields = (
        Entered("kind", "Motor type (MT)", now.text("stepper", "kind", now.axis.motor.value), "", STEPPERS),
        Entered("smoothing", "Smoothing (KS)", now.text("stepper", "smoothing", now.axis.smoothing or "2"),
                "0.5 to 8, 8 is smoothest"),
    )  # fmt: skip
    done = "" if now.record.of("stepper").verdict is Verdict.PASSED else "Set them first."
    same = now.text("stepper", "kind", now.axis.motor.value) == now.axis.motor.value
    same = same and now.text("stepper", "smoothing", now.axis.smoothing) == now.axis.smoothing
    take = () if same else (Act("take_stepper", "Take them into the setup", done, primary=not done),)
    acts = (Act("stepper", "Set", now.send, primary=bool(done)), *take)
    return (Reading("Motor", now.motor),), fields, (), acts


def _direction(now: Now) -> Parts:
    fields = (Entered("counts", "Way of the test move", now.text("direction", "counts", str(TRIAL_COUNTS)), "pulses"),)
    came = now.moved is not None and now.record.of("direction").verdict is not Verdict.FAILED
    waiting = "" if came and not now.busy else "After a test move."
    acts = (
        Act("pulses", "Test move", now.send, primary=not came, moves=True),
        Act("turned_forward", "It went forward", waiting, primary=came),
        Act("turned_backward", "It went the other way", waiting),
        Act("turned_not", "It did not turn", waiting),
    )
    return _stepping(now), fields, (), acts


def _polarity(now: Now) -> Parts:
    fields = (
        Entered("counts", "Way of the test move", now.text("polarity", "counts", str(TRIAL_COUNTS)), "counts"),
        Entered("error", "Largest error limit", now.text("polarity", "error", str(TRIAL_ERROR)), "counts"),
    )
    came = now.moved is not None and now.record.of("polarity").verdict is not Verdict.FAILED
    waiting = "" if came and not now.busy else "After a test move that came to its target."
    acts = (
        Act("polarity", "Test move", now.send, primary=not came, moves=True),
        Act("forward", "It went forward", waiting, primary=came),
        Act("backward", "It went the other way", waiting),
    )
    return _going(now), fields, (), acts


def _halls(now: Now) -> Parts:
    without = "" if now.text("phases", "halls", "0") != "0" else "No hall sensors were chosen under “Phases and halls”."
    return _going(now), (), (), (Act("halls", "Move", now.send or without, primary=True, moves=True),)


def _scale(now: Now) -> Parts:
    fields = (
        Entered("distance", "Move by", now.text("scale", "distance"), now.axis.symbol),
        Entered("measured", "Measured", now.text("scale", "measured"), now.axis.symbol),
    )
    came = now.moved is not None
    acts = (
        Act("scale", "Move", now.send, primary=not came, moves=True),
        Act("measured", "Judge", "" if came else "Move first.", primary=came),
        *_take_scale(now),
    )
    return (_stepping if now.axis.is_stepper else _going)(now), fields, (), acts


def _limits(now: Now) -> Parts:
    stepper, symbol = now.axis.is_stepper, now.axis.symbol
    position = now.live.get("commanded" if stepper else "position", math.nan)
    fields: tuple[Entered, ...] = (
        Entered("forward", "Forward limit (FL)", now.text("limits", "forward", now.axis.forward_limit), symbol),
        Entered("reverse", "Reverse limit (BL)", now.text("limits", "reverse", now.axis.reverse_limit), symbol),
    )
    if not stepper:
        torque = now.text("limits", "torque", now.axis.torque_limit or "9.99")
        fields = (*fields, Entered("torque", "Torque limit from now on (TL)", torque, "V"))
    readings = (Reading("Motor", now.motor), Reading("Position", f"{shown(position, now.axis)} {symbol}"))
    done = "" if now.record.of("limits").verdict is Verdict.PASSED else "Set them first."
    acts = (
        Act("limits", "Set", now.send, primary=bool(done)),
        Act("take_limits", "Take them into the setup", done, primary=not done),
    )
    return readings, fields, (), acts


def _burn(now: Now) -> Parts:
    return (Reading("Motor", now.motor),), (), (), (Act("burn", "Burn…", now.send, primary=True),)


PARTS: Mapping[str, Callable[[Now], Parts]] = {
    "safety": _safety,
    "encoder": _encoder,
    "switches": _switches,
    "guards": _guards,
    "stepper": _stepper,
    "direction": _direction,
    "phases": _phases,
    "zero": _zero,
    "polarity": _polarity,
    "halls": _halls,
    "scale": _scale,
    "limits": _limits,
    "burn": _burn,
}
