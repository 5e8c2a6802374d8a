"""What is drawn of a capture and of the live roll, over time, over each other, and as spectra; and what is read off."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QColor

from codegen.setup import Setup
from device.bits import Signal, signals, worth
from device.capture import Capture, Channel
from device.curves import Curve, Window, curves, evenly, scaled, spectrum, straight
from device.roll import Line as Rolled
from device.roll import Roll
from device.waves import Wave, drawn, levels
from widgets.parts.look import look
from widgets.scope.chart import Line
from widgets.scope.choices import Choices
from widgets.scope.readings import Column
from widgets.scope.timings import Level

Values = NDArray[np.float64]
MOST_OF_A_SPECTRUM = 1 << 15  # live values, the newest of them; more would hold the window up
MOST_OF_A_PLANE = 4000  # points of a live picture of one curve over another
NOT_LIVE = 0.02  # s, about what a cursor moves by in live values


@dataclass(frozen=True, eq=False)
class Picture:
    """Lines with the axis below them; `columns` are the readings of a stretch of that axis."""

    lines: Sequence[Line]
    bottom: str
    columns: Callable[[float, float], list[Column]]
    levels: Callable[[float, float], Sequence[Level]] = lambda low, high: ()  # what tracks say, likewise
    step: float = 0.001
    mark: tuple[float, float] | None = None
    equal: bool = False


class Views:
    """Makes pictures in the colours of the choices."""

    def __init__(self, choices: Choices) -> None:
        self._choices = choices

    # ------------------------------------------------------------------ captures

    def over_time(self, capture: Capture, overlaid: Sequence[Capture]) -> Picture:
        """The capture, those laid over it faded."""
        own, tracks = self._over_time(capture)
        lines = [*own, *(self._track(each) for each in tracks)]
        for other in overlaid:
            curves_below, tracks_below = self._over_time(other, faded=True)
            lines += [*curves_below, *(self._track(each, faded=True) for each in tracks_below)]
        lines = _by_unit(lines)
        triggered = capture.moments is None and capture.trigger_text != "at once"
        bottom = "Time from the trigger, s" if triggered else "Time, s"
        if capture.moments is not None:
            bottom = SINCE
        mark = (0.0, capture.early_s) if triggered else None
        return Picture(lines, bottom, _read_off(own), lambda low, high: tracks, capture.interval_s, mark)

    def _over_time(self, capture: Capture, faded: bool = False) -> tuple[list[Line], list[Level]]:
        """Curves, and the levels of what is drawn bit by bit."""
        lines, tracks = [], []
        for each in curves(capture, self._choices.shown):
            bits = self._bits(capture, each)
            tracks += [Level(signal, self._colour(each.channel), wave) for signal, wave in bits]
            if not bits:
                lines.append(self._line(each, capture.times, each.values, capture.channels, faded))
        return lines, tracks

    def _bits(self, capture: Capture, curve: Curve) -> tuple[tuple[Signal, Wave], ...]:
        """Those of a curve that are drawn by themselves."""
        return () if curve.derived is not None else drawn(capture, curve.channel, self._choices.bits_of(curve.channel))

    def names(self, capture: Capture) -> list[str]:
        """What can be drawn over each other."""
        return [each.label for each in self._curves(capture)]

    def over_each_other(self, capture: Capture, overlaid: Sequence[Capture], sides: tuple[str, str]) -> Picture:
        """One curve over another; overlaid captures too where they hold both."""
        across, upward, x, y = self._pair(capture, sides)
        own = [self._line(each, capture.times, each.values, capture.channels) for each in (across, upward)]
        lines = [self._over(across, upward, x, y)]
        for other in overlaid:
            if set(sides) <= set(self.names(other)):
                pair = self._pair(other, sides)
                if (pair[0].unit, pair[1].unit) == (across.unit, upward.unit):
                    lines.append(self._over(*pair, faded=True))
        return Picture(lines, f"{across.label}, {across.unit}", _read_off(own), equal=_comparable(across, upward))

    def spectra(self, capture: Capture, stretch: tuple[float, float] | None, window: Window) -> Picture:
        """Of the stretch between the cursors, or of everything."""
        low, high = sorted(stretch) if stretch is not None else (-math.inf, math.inf)
        inside = (capture.times >= low) & (capture.times <= high)
        times = capture.times[inside]
        found = [(each, times, each.values[inside]) for each in self._curves(capture)]
        return self._spectra(found, None if capture.moments is not None else capture.interval_s, window)

    # ---------------------------------------------------------------------- live

    def rolled(self, roll: Roll, channels: Sequence[Channel], setup: Setup | None) -> tuple[Rolled, ...]:
        """The curves of the live roll, with what is derived; what is drawn bit by bit as one of each."""
        found: list[Rolled] = []
        for each in roll.lines(channels, self._choices.shown, setup):
            known = signals(each.channel, setup, self._choices.model, live=True) if each.derived is None else ()
            wanted = self._choices.bits_of(each.channel)
            if not known or wanted == ():
                found.append(each)
                continue
            changes = roll.changes(each.channel)
            changed = [signal.bit.number for signal in known if changes.changed >> signal.bit.number & 1]
            found += [
                dc.replace(each, label=signal.label, group=LEVELS, signal=signal, changes=changes)
                for signal in worth(known, wanted, changed, live=True)
            ]
        return tuple(found)

    def live(self, rolled: Sequence[Rolled], low: float, high: float) -> Picture:
        """A stretch of time."""
        kinds, lines = [each.channel for each in rolled if each.derived is None], []
        bits, rolled = [each for each in rolled if each.signal], [each for each in rolled if not each.signal]
        for each in rolled:
            x, y = each.track.seen(low, high)
            curve = each.curve(y)
            lines.append(self._line(curve, x, curve.values, kinds))
        lines = _by_unit(lines)

        def columns(start: float, end: float) -> list[Column]:
            found = []
            for each, line in zip(rolled, lines, strict=True):
                whole = None
                if each.track.many(start, end):
                    whole, x, y = each.track.measured(start, end)
                    whole = scaled(whole, each.scale)
                else:
                    x, y = each.track.between(start, end)
                found.append(Column(line.label, line.unit, line.colour, x, y / each.scale, measured=whole))
            return found

        def levels(start: float, end: float) -> list[Level]:
            return [
                Level(each.signal, self._colour(each.channel), each.changes.wave(each.signal, start, end))
                for each in bits
                if each.signal is not None and each.changes is not None
            ]

        tracks = [self._track(each) for each in levels(low, high)]
        return Picture([*lines, *tracks], SINCE, columns, levels, NOT_LIVE)

    def live_over_each_other(
        self, rolled: Sequence[Rolled], low: float, high: float, sides: tuple[str, str]
    ) -> Picture:
        """One live curve over another, at the moments of the one upward."""
        by_name = {each.label: each for each in rolled}
        across, upward = (by_name[name] for name in sides)
        times, y = upward.track.between(low, high)
        thin = slice(None, None, -(-len(times) // MOST_OF_A_PLANE) or 1)
        times, y = times[thin], y[thin]
        near = across.track.between(low, high)
        x = straight(times, *near) if len(near[0]) else np.full(len(times), np.nan)
        first, second = across.curve(x), upward.curve(y)
        own = [self._line(each, times, each.values, ()) for each in (first, second)]
        line = self._over(first, second, first.values, second.values)
        bottom = f"{first.label}, {first.unit}"
        return Picture([line], bottom, _read_off(own), equal=_comparable(first, second))

    def live_spectra(self, rolled: Sequence[Rolled], low: float, high: float, window: Window) -> Picture:
        """Of a stretch of time, as even values between those that were read."""
        found = []
        for each in rolled:
            times, values = each.track.between(low, high)
            times, values = times[-MOST_OF_A_SPECTRUM:], values[-MOST_OF_A_SPECTRUM:]
            curve = each.curve(values)
            found.append((curve, times, curve.values))
        return self._spectra(found, None, window)

    # ------------------------------------------------------------------- details

    def _curves(self, capture: Capture) -> list[Curve]:
        """Those that can be drawn over each other, and as spectra: what is drawn bit by bit is 0 and 1."""
        found: list[Curve] = []
        for each in curves(capture, self._choices.shown):
            found += [
                dc.replace(each, label=signal.label, group=LEVELS, values=levels(each.values, signal.bit))
                for signal, _ in self._bits(capture, each)
            ] or [each]
        return found

    def _track(self, level: Level, faded: bool = False) -> Line:
        x, y = level.wave.corners()
        return Line(level.signal.label, "", LEVELS, level.colour, x, y, faded=faded, track=True)

    def _colour(self, channel: Channel) -> QColor:
        return look().colour(self._choices.colour_of(channel))

    def _line(
        self, curve: Curve, x: Values, y: Values, channels: Sequence[Channel], faded: bool = False
    ) -> Line:  # fmt: skip
        known = np.isfinite(y)
        if not known.all():
            x, y = x[known], y[known]
        doubled = curve.derived is not None and Channel("error", curve.axis) in channels  # a second kind in the strip
        dashed = curve.dashed or (doubled and curve.group == "Position error")
        return Line(curve.label, curve.unit, curve.group, self._colour(curve.channel), x, y, dashed, faded)

    def _pair(self, capture: Capture, sides: tuple[str, str]) -> tuple[Curve, Curve, Values, Values]:
        found = {each.label: each for each in self._curves(capture)}
        across, upward = (found[name] for name in sides)
        x, y = across.values, upward.values
        if capture.moments is not None:  # both are known at few moments only
            x = straight(capture.times, capture.times, x)
        return across, upward, x, y

    def _over(self, across: Curve, upward: Curve, x: Values, y: Values, faded: bool = False) -> Line:
        known = np.isfinite(x) & np.isfinite(y)
        name = f"{upward.label} over {across.label}"
        return Line(name, upward.unit, upward.label, self._colour(upward.channel), x[known], y[known], faded=faded)

    def _spectra(
        self, found: Sequence[tuple[Curve, Values, Values]], interval_s: float | None, window: Window
    ) -> Picture:
        """Without an interval the values are made even first."""
        lines, columns, count, step = [], [], 0, 1.0
        for curve, times, values in found:
            even, apart = (values, interval_s) if interval_s is not None else evenly(times, values)
            hertz, heights = spectrum(even, apart, window)
            line = self._line(curve, hertz, heights, ())
            count = max(count, int(np.isfinite(even).sum()))
            step = 1 / (len(even) * apart) if len(even) else step
            peak = None
            if len(heights) > 1:
                top = 1 + int(np.argmax(heights[1:]))
                peak = (float(hertz[top]), float(heights[top]))
            lines.append(line)
            columns.append(Column(curve.label, curve.unit, line.colour, line.x, line.y, peak))
        how = "" if interval_s is not None else ", made even"
        words = f"Frequency, Hz · window: {window} · {count} values{how}"
        return Picture(_by_unit(lines), words, lambda low, high: columns, step=step)


SINCE = "Time since Live began, s"
LEVELS = "On and off"  # the strip of all tracks


def _read_off(lines: Sequence[Line]) -> Callable[[float, float], list[Column]]:
    columns = [Column(line.label, line.unit, line.colour, line.x, line.y) for line in lines]
    return lambda low, high: columns


def _by_unit(lines: list[Line]) -> list[Line]:
    """What shares a scale has one unit: millimetres and degrees, or a capture of another machine, get their own."""
    first: dict[str, str] = {}
    for line in lines:
        first.setdefault(line.group, line.unit)
    return [
        line if line.unit == first[line.group] else dc.replace(line, group=f"{line.group}, {line.unit}")
        for line in lines
    ]


def _comparable(across: Curve, upward: Curve) -> bool:
    """Whether both directions have the same scale."""
    return across.unit == upward.unit and across.group == upward.group and across.axis != upward.axis
