"""The scope: what is captured on the left, the curves in the middle, readings and earlier captures on the right."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor, QResizeEvent
from PySide6.QtWidgets import QLabel, QMenu, QScrollArea, QSplitter, QTabWidget, QVBoxLayout, QWidget

from codegen.models import Model
from codegen.setup import Setup
from device.api import Kind, State
from device.capture import Capture, Channel, cut, scale_of
from device.curves import Curve, curves, group_of, spectrum
from widgets.panel import set_text
from widgets.parts.look import look
from widgets.parts.pieces import Pieces
from widgets.scope.bar import Bar, View
from widgets.scope.chart import Chart, Line
from widgets.scope.choices import Choices
from widgets.scope.kept import Kept
from widgets.scope.readings import Column, Readings, seconds

if TYPE_CHECKING:
    from device.api import Controller
    from device.roll import Roll

EMPTY = "Nothing is captured yet. Choose channels and press Capture, or switch Live on."
LEAST_LEFT, LEAST_RIGHT = 560, 860  # px of the whole from which on there is room beside the curves
MEASURED_S = 0.25  # between two readings of a live roll


class Parts:
    """What the scope is made of."""

    bar: Bar
    choices: Choices
    chart: Chart
    readings: Readings
    kept: Kept

    def pieces(self) -> Iterator[None]:
        """One after the other: all at once the window would stand still."""
        self.bar = Bar()
        yield
        self.choices = Choices()
        yield
        self.chart = Chart()
        self.readings, self.kept = Readings(), Kept()
        yield


class Body(QWidget):
    """Emits what the person wants; is told of captures, progress and the live roll."""

    capture_wanted = Signal(object)  # a Plan
    finish_wanted = Signal()
    cancel_wanted = Signal()
    live_wanted = Signal(bool)
    save_wanted = Signal(object)  # a Capture
    open_wanted = Signal()

    def __init__(self, parts: Parts | None = None, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        if parts is None:
            parts = Parts()
            Pieces(parts.pieces()).finish()
        self.bar, self.choices, self.chart = parts.bar, parts.choices, parts.chart
        self.readings, self.kept = parts.readings, parts.kept
        self.between, self.empty = QLabel(), QLabel(EMPTY)
        self.start = self.bar.capture
        self._setup: Setup | None = None
        self._partial: Capture | None = None
        self._roll: Roll | None = None
        self._reason = ""
        self._drawn: list[tuple[Curve, Line]] = []
        self._following = True
        self._measured_at = -math.inf
        self._room = (True, True)
        self._lay_out()
        self._connect()
        self.redraw()

    # -------------------------------------------------------------------- told

    def show_machine(self, model: Model, setup: Setup) -> None:
        self._setup = setup
        self.choices.show_machine(model, setup)

    def refresh(self, controller: Controller) -> None:
        """Whether a capture can begin now, and why not."""
        reason = self.choices.problem
        if controller.kind is Kind.OFFLINE or controller.state is not State.READY:
            reason = "Nothing is connected that could capture."
        elif controller.kind is Kind.REPLAY:
            reason = "A recording is played: nothing can be captured from it."
        elif not controller.control:
            reason = "This is Watch. Take Control first: a capture writes arrays in the controller."
        self.bar.allow(reason, controller.kind is not Kind.OFFLINE)

    def show_progress(self, phase: str, fraction: float, remaining_s: float) -> None:
        self.bar.show_progress(phase, fraction, remaining_s)

    def show_partial(self, capture: Capture) -> None:
        """What there is of a capture under way."""
        self._partial = capture
        self.redraw()

    def show_result(self, words: str, good: bool = True) -> None:
        """The capture has ended."""
        self._partial = None
        self.bar.show_result(words, good)
        self.redraw()

    def add(self, capture: Capture, name: str = "", show: bool = True) -> None:
        """A capture that is done, or was opened; it is shown."""
        self._partial = None
        self.kept.add(capture, name, show)
        self.redraw(fit=True)

    def show_roll(self, roll: Roll | None) -> None:
        """The live values, or None when they are off."""
        self._roll = roll
        self._following = True
        self.bar.show_live(roll is not None)
        self.redraw(fit=True)

    def roll_on(self, now: float) -> None:
        """New live values came."""
        if self._roll is None:
            return
        measured = now - self._measured_at >= MEASURED_S
        self.redraw(measured=measured)
        if measured:
            self._measured_at = now

    @property
    def live_channels(self) -> tuple[Channel, ...]:
        """What can be watched of what is chosen."""
        return tuple(channel for channel in self.choices.channels if channel.live_key)

    @property
    def shown(self) -> Capture | None:
        """The capture in front."""
        return self._partial or self.kept.current

    # ------------------------------------------------------------------ drawing

    def redraw(self, fit: bool = False, measured: bool = True) -> None:
        """Everything anew, as the choices say."""
        live = self._roll is not None
        view = View.TIME if live else self.bar.view
        self.bar.show_view(view, live)
        capture = self.shown
        nothing = capture is None and not live
        self.empty.setVisible(nothing)
        self.chart.setVisible(not nothing)
        self.bar.can_save(capture is not None and not live)
        if nothing:
            self.readings.show_columns([], None, (0.0, 1.0))
            return
        draw = self._draw_live if live else {
            View.TIME: self._draw_time, View.PLANE: self._draw_plane, View.SPECTRUM: self._draw_spectrum,
        }[view]  # fmt: skip
        draw()
        if fit and not live:
            self.chart.fit()
        if measured:
            self._measure()

    def _colour(self, channel: Channel) -> QColor:
        return look().colour(self.choices.colour_of(channel))

    def _line(self, curve: Curve, x: np.ndarray, y: np.ndarray, faded: bool = False) -> Line:
        known = np.isfinite(y)
        if not known.all():
            x, y = x[known], y[known]
        dashed = curve.dashed or self._doubled(curve)
        return Line(curve.label, curve.unit, curve.group, self._colour(curve.channel), x, y, dashed, faded)

    def _doubled(self, curve: Curve) -> bool:
        """A second kind of curve of the same axis in the same strip."""
        return curve.derived is not None and curve.group == "Position error" and Channel("error", curve.axis) in (
            self.shown.channels if self.shown is not None else ()
        )  # fmt: skip

    def _draw_time(self) -> None:
        capture = self.shown
        assert capture is not None
        self._drawn = [
            (each, self._line(each, capture.times, each.values)) for each in curves(capture, self.choices.shown)
        ]
        lines = [line for _, line in self._drawn]
        for other in self.kept.overlaid:
            if other is not capture:
                lines += [
                    self._line(each, other.times, each.values, True) for each in curves(other, self.choices.shown)
                ]
        triggered = capture.trigger_text != "at once"
        mark = (0.0, capture.early_s) if triggered else None
        self.chart.show_lines(lines, "Time from the trigger (s)" if triggered else "Time (s)", mark=mark,
            step=capture.interval_s)  # fmt: skip

    def _draw_plane(self) -> None:
        """One curve over another; overlaid captures too where they hold both."""
        capture = self.shown
        assert capture is not None
        all_curves = {each.label: each for each in curves(capture, self.choices.shown)}
        self.bar.offer_sides(list(all_curves))
        across, upward = (all_curves[name] for name in self.bar.sides)
        name = f"{upward.label} over {across.label}"
        self._drawn = [(each, self._line(each, capture.times, each.values)) for each in (across, upward)]
        lines = [Line(name, upward.unit, upward.label, self._colour(upward.channel), across.values, upward.values)]
        for other in self.kept.overlaid:
            there = {each.label: each for each in curves(other, self.choices.shown)}
            if other is not capture and {across.label, upward.label} <= set(there):
                x, y = there[across.label].values, there[upward.label].values
                lines.append(Line(name, upward.unit, upward.label, self._colour(upward.channel), x, y, faded=True))
        equal = across.unit == upward.unit and across.group == upward.group and across.axis != upward.axis
        self.chart.show_lines(lines, f"{across.label} ({across.unit})", equal=equal)

    def _draw_spectrum(self) -> None:
        """Of the stretch between the cursors, or of everything."""
        capture = self.shown
        assert capture is not None
        places = self.bar.stretch if self.bar.stretch is not None else (-math.inf, math.inf)
        inside = (capture.times >= min(places)) & (capture.times <= max(places))
        self._drawn = []
        for curve in curves(capture, self.choices.shown):
            hertz, heights = spectrum(curve.values[inside], capture.interval_s, self.bar.window_kind)
            self._drawn.append((curve, self._line(curve, hertz, heights)))
        count = int(inside.sum())
        words = f"Frequency (Hz) · window: {self.bar.window_kind} · {count} values"
        step = 1 / (count * capture.interval_s) if count else 1.0
        self.chart.show_lines([line for _, line in self._drawn], words, step=step)

    def _draw_live(self) -> None:
        roll = self._roll
        assert roll is not None
        end = roll.end
        low, high = self.chart.range
        if self._following or not self._drawn:
            low = max(0.0, end - self.bar.span_s)
            high = low + self.bar.span_s
        self._drawn = []
        for channel in self.live_channels:
            track = roll.tracks.get(channel.live_key)
            if track is None:
                continue
            scale, unit = scale_of(channel, self._setup)
            x, y = track.seen(low, high)
            curve = Curve(channel.label, unit, group_of(channel), channel.axis, y / scale, channel)
            self._drawn.append((curve, self._line(curve, x, curve.values)))
        self.chart.show_lines([line for _, line in self._drawn], "Time since Live began (s)", step=0.02)
        if self._following:
            self.chart.show_range(low, high)

    # ----------------------------------------------------------------- measuring

    def _measure(self) -> None:
        cursors = self.chart.cursors
        spectral = self._roll is None and self.bar.view is View.SPECTRUM
        columns = []
        for curve, line in self._drawn:
            peak = None
            if spectral and len(line.y) > 1:
                top = 1 + int(np.argmax(line.y[1:]))
                peak = (float(line.x[top]), float(line.y[top]))
            columns.append(Column(curve.label, curve.unit, line.colour, line.x, line.y, peak))
        plane = self._roll is None and self.bar.view is View.PLANE
        self.readings.show_columns(columns, cursors, (-math.inf, math.inf) if plane else self.chart.range)
        set_text(self.between, self._words(cursors, spectral))

    @staticmethod
    def _words(cursors: Sequence[float] | None, spectral: bool) -> str:
        if cursors is None:
            return ""
        first, second = cursors
        if spectral:
            return f"A {first:.5g} Hz   B {second:.5g} Hz   B − A {second - first:.5g} Hz"
        apart = second - first
        turns = f"   1/(B − A) {1 / abs(apart):.5g} Hz" if apart else ""
        return f"A {seconds(first)}   B {seconds(second)}   B − A {seconds(apart)}{turns}"

    def _toggle_cursors(self, on: bool) -> None:
        low, high = self.chart.range
        third = (high - low) / 3
        self.chart.show_cursors((low + third, high - third) if on else None)

    def _view_chosen(self) -> None:
        """Cursors stand at places of one axis and go with it; a spectrum is of the stretch they chose."""
        cursors = self.chart.cursors
        if self.bar.view is View.SPECTRUM:
            self.bar.stretch = (cursors[0], cursors[1]) if cursors is not None else None
        else:
            self.bar.stretch = None
        self.bar.cursors.setChecked(False)
        self.redraw(fit=True)

    def _save_picture(self) -> None:
        strip = next(iter(self.chart.strips.values()), None)
        if strip is None:
            set_text(self.bar.words, "There is no curve yet: capture something, or look at live values.")
        else:
            strip.save()

    def _ask_what_to_save(self) -> None:
        """All of the capture, or the stretch that is on the screen."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.addAction("Save the whole capture…").triggered.connect(lambda: self.save_wanted.emit(self.shown))
        part = menu.addAction("Save only what is on the screen…")
        part.triggered.connect(self._save_part)
        part.setEnabled(self.bar.view is View.TIME)
        menu.popup(self.bar.save.mapToGlobal(self.bar.save.rect().bottomLeft()))

    def _save_part(self) -> None:
        if self.shown is not None:
            self.save_wanted.emit(cut(self.shown, *self.chart.range))

    def _live(self) -> None:
        self._following = True
        self.live_wanted.emit(self.bar.live.isChecked())

    def _panned(self) -> None:
        self._following = False
        self._measure()

    def _fitted(self) -> None:
        self._following = True
        if self._drawn:
            self._measure()

    # -------------------------------------------------------------------- joining

    def _lay_out(self) -> None:
        scroll = QScrollArea()
        scroll.setWidget(self.choices)
        scroll.setWidgetResizable(True)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        scroll.setFrameShape(QScrollArea.Shape.NoFrame)
        scroll.setAccessibleName("What is captured")
        scroll.setMinimumWidth(230)
        middle = QWidget()
        column = QVBoxLayout(middle)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.chart, 1)
        column.addWidget(self.empty, 1)
        self.empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.empty.setWordWrap(True)
        self.empty.setProperty("role", "quiet")
        right, readings = QTabWidget(), QWidget()
        inner = QVBoxLayout(readings)
        inner.setContentsMargins(0, 4, 0, 0)
        inner.addWidget(self.between)
        inner.addWidget(self.readings, 1)
        self.between.setWordWrap(True)
        right.addTab(readings, "Readings")
        right.addTab(self.kept, "Captures")
        right.setAccessibleName("Readings and captures")
        self.side = right
        parts = QSplitter()
        for part in (scroll, middle, right):
            parts.addWidget(part)
        self.choices_side = scroll
        parts.setStretchFactor(1, 1)
        parts.setSizes([270, 700, 330])
        parts.setCollapsible(1, False)
        whole = QVBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.setSpacing(6)
        whole.addWidget(self.bar)
        whole.addWidget(parts, 1)

    def _connect(self) -> None:
        bar, chart = self.bar, self.chart
        bar.capture.clicked.connect(lambda: self.capture_wanted.emit(self.choices.plan))
        bar.finish.clicked.connect(self.finish_wanted)
        bar.cancel.clicked.connect(self.cancel_wanted)
        bar.live.clicked.connect(self._live)
        bar.save.clicked.connect(self._ask_what_to_save)
        bar.open.clicked.connect(self.open_wanted)
        bar.cursors.toggled.connect(self._toggle_cursors)
        bar.sides_left.toggled.connect(self.choices_side.setVisible)
        bar.sides_right.toggled.connect(self.side.setVisible)
        bar.sides_left.setChecked(True)
        bar.sides_right.setChecked(True)
        bar.fit.clicked.connect(lambda: self.redraw(fit=True))
        bar.picture.clicked.connect(self._save_picture)
        bar.view_chosen.connect(self._view_chosen)
        bar.drawn_otherwise.connect(lambda: self.redraw(fit=True))
        chart.cursors_moved.connect(lambda: self._measure())
        chart.panned.connect(self._panned)
        chart.fitted.connect(self._fitted)
        self.choices.changed.connect(self._chosen)
        self.kept.changed.connect(lambda: self.redraw(fit=True))

    def resizeEvent(self, event: QResizeEvent) -> None:
        """What stands beside the curves gives way where there is little room, until the person says otherwise."""
        super().resizeEvent(event)
        room = (event.size().width() >= LEAST_LEFT, event.size().width() >= LEAST_RIGHT)
        if room != self._room:
            self._room = room
            self.bar.sides_left.setChecked(room[0])
            self.bar.sides_right.setChecked(room[1])

    def _chosen(self) -> None:
        """Other channels, colours or derived curves."""
        if self._roll is not None and set(self._roll.tracks) != {each.live_key for each in self.live_channels}:
            self.live_wanted.emit(True)  # the roll starts afresh with them
        self.redraw()
