"""The scope: what is captured on the left, the curves in the middle, readings and earlier captures on the right."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QLabel, QMenu, QScrollArea, QSplitter, QTabWidget, QVBoxLayout, QWidget

from codegen.models import Model
from codegen.setup import Setup
from device.api import Kind, State
from device.capture import Capture, Channel, cut
from widgets.panel import set_text
from widgets.parts.pieces import Pieces
from widgets.scope.bar import Bar, View
from widgets.scope.chart import Chart
from widgets.scope.choices import Choices
from widgets.scope.kept import Kept
from widgets.scope.readings import Column, Readings, apart_words
from widgets.scope.timings import Level, Timings
from widgets.scope.views import Picture, Views

if TYPE_CHECKING:
    from device.api import Controller
    from device.roll import Line as Rolled
    from device.roll import Roll

EMPTY = "Nothing is captured yet. Choose channels and press Capture, or switch Live on."
LEAST_LEFT, LEAST_RIGHT = 560, 860  # px of the whole from which on there is room beside the curves
MEASURED_S = 0.25  # between two readings of a live roll, or two of its spectra
HELD = "The picture is held; Fit or a double click follows again."


class Body(QWidget):
    """Emits what the person wants; is told of captures, progress and the live roll."""

    capture_wanted = Signal(object)  # a Plan
    finish_wanted = Signal()
    cancel_wanted = Signal()
    live_wanted = Signal(bool)
    save_wanted = Signal(object)  # a Capture
    open_wanted = Signal()
    chosen = Signal()  # something that is remembered

    def __init__(self, parent: QWidget | None = None, at_once: bool = True) -> None:
        super().__init__(parent)
        self._model: Model | None = None
        self._setup: Setup | None = None
        self._partial: Capture | None = None
        self._due = self._to_measure = False  # a part that has come is not drawn yet; is drawn, but not measured yet
        self._roll: Roll | None = None
        self._reason = ""
        self.picture: Picture | None = None
        self._following = True
        self._window = (0.0, 1.0)  # the stretch of time of the live picture
        self._measured_at = -math.inf
        self._room = (True, True)
        self.making = Pieces(self._pieces())
        if at_once:
            self.making.finish()

    def _pieces(self) -> Iterator[None]:
        """From the outside inwards: what gets another parent is dressed anew with all that is in it."""
        self._lay_out()
        yield
        self.bar = Bar(self, at_once=False)
        yield from self.bar.making.each()
        self.start = self.bar.capture
        self._whole.insertWidget(0, self.bar)
        yield
        self.choices = Choices(self.choices_side.viewport(), at_once=False)
        self.choices.setUpdatesEnabled(False)  # until all of it is there
        self.choices_side.setWidget(self.choices)
        yield from self.choices.making.each()
        yield
        if self._model is not None:
            self.choices.show_machine(self._model, self._setup)
        self.choices.setUpdatesEnabled(True)
        yield
        self.room = QScrollArea(self)  # strips keep a height in which they can be read, also in a low dock
        self.room.setWidgetResizable(True)
        self.room.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.room.setFrameShape(QScrollArea.Shape.NoFrame)
        self.room.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.room.hide()
        self.chart = Chart(self.room.viewport())
        self.room.setWidget(self.chart)
        self._middle.insertWidget(0, self.room, 1)
        self.readings, self.timings = Readings(self), Timings(self)
        self.readings.show_columns([], None, (0.0, 1.0))
        self._beside.addWidget(self.readings, 1)
        self._beside.addWidget(self.timings, 1)
        yield
        self.kept = Kept(self.side)
        self.side.addTab(self.kept, "Captures")
        self._views = Views(self.choices)
        yield
        self._connect()
        self._fit_room(self.width())
        yield
        self.redraw()
        yield

    # -------------------------------------------------------------------- told

    def show_machine(self, model: Model, setup: Setup) -> None:
        self._model, self._setup = model, setup
        if self.making.done:
            self.choices.show_machine(model, setup)

    def refresh(self, controller: Controller) -> None:
        """Whether a capture can begin now, and why not."""
        reason = self.choices.problem
        if controller.kind is Kind.OFFLINE or controller.state is not State.READY:
            reason = "Nothing is connected that could capture."
        elif controller.kind is Kind.REPLAY:
            reason = "A recording is played: nothing can be captured from it."
        elif not controller.control:
            reason = "This is Watch: switch to Control first; a capture writes arrays in the controller."
        self.bar.allow(reason, controller.kind is not Kind.OFFLINE)
        if self._to_measure:
            self._measure()
        elif self._due:
            self.redraw(measured=False)
            self._to_measure = True
        else:
            self.chart.prepare()

    def show_progress(self, phase: str, fraction: float, remaining_s: float) -> None:
        self.bar.show_progress(phase, fraction, remaining_s)

    def show_partial(self, capture: Capture) -> None:
        """What there is of a capture under way: its strips with this tick, curves and readings with the next two."""
        first, self._partial, self._due = self._partial is None, capture, True
        if first:
            picture = self._picture(capture)
            if self.chart.begin(picture.lines, picture.bottom, picture.equal):
                self.empty.hide()
                self.room.show()

    def show_result(self, words: str, good: bool = True) -> None:
        """The capture has ended."""
        self.bar.show_result(words, good)
        if self._partial is not None:
            self._partial = None
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
        if roll is not None:
            self.bar.show_result("")
        self.redraw(fit=True)

    def roll_on(self, now: float) -> None:
        """New live values came: they are drawn, or measured, which for an hour of them takes as long."""
        if self._roll is None:
            return
        spectral = self.bar.view is View.SPECTRUM
        if now - self._measured_at >= MEASURED_S:
            self._measured_at = now
            if spectral:
                self.redraw(measured=False)
            self._measure()
        elif not spectral:
            self.redraw(measured=False)

    @property
    def live_channels(self) -> tuple[Channel, ...]:
        """What can be watched of what is chosen."""
        return tuple(channel for channel in self.choices.channels if channel.live_key)

    @property
    def shown(self) -> Capture | None:
        """The capture in front."""
        return self._partial or self.kept.current

    # --------------------------------------------------------------- remembered

    def state(self) -> dict[str, Any]:
        """What was chosen, for the next start."""
        return {**self.choices.state(), **self.bar.state()}

    def restore(self, found: Mapping[str, Any]) -> None:
        """What was chosen at the last start, as far as it is that."""
        self.choices.restore(found)
        self.bar.restore(found)

    # ------------------------------------------------------------------ drawing

    def redraw(self, fit: bool = False, measured: bool = True) -> None:
        """Everything anew, as the choices say."""
        self._due = self._to_measure = False
        live, capture = self._roll is not None, self.shown
        self.bar.show_view(self.bar.view, live)
        nothing = capture is None and not live
        self.empty.setVisible(nothing)
        self.room.setVisible(not nothing)
        self.bar.can_save(capture is not None or live)
        if nothing:
            self.picture = None
            self._show_readings([], [], None, (0.0, 1.0))
            return
        picture = self.picture = self._live_picture() if live else self._picture(capture)
        fresh = self.chart.show_lines(
            picture.lines, picture.bottom, equal=picture.equal, mark=picture.mark, step=picture.step
        )
        if live and self.bar.view is View.TIME and (self._following or fresh):
            self.chart.show_range(*self._window)
        elif fit:
            self.chart.fit()
        if measured:
            self._measure()

    def _picture(self, capture: Capture | None) -> Picture:
        assert capture is not None
        others = [each for each in self.kept.overlaid if each is not capture]
        if self.bar.view is View.PLANE:
            self.bar.offer_sides(self._views.names(capture))
            return self._views.over_each_other(capture, others, self.bar.sides)
        if self.bar.view is View.SPECTRUM:
            return self._views.spectra(capture, self.bar.stretch, self.bar.window_kind)
        return self._views.over_time(capture, others)

    def _live_picture(self) -> Picture:
        roll, view = self._roll, self.bar.view
        assert roll is not None
        if self._following:
            low = max(0.0, roll.end - self.bar.span_s)
            self._window = low, low + self.bar.span_s
        elif view is View.TIME:
            self._window = self.chart.range
        rolled = self._rolled()
        if view is View.PLANE and rolled:
            self.bar.offer_sides([each.label for each in rolled])
            return self._views.live_over_each_other(rolled, *self._window, self.bar.sides)
        if view is View.SPECTRUM:
            low, high = sorted(self.bar.stretch) if self.bar.stretch is not None else self._window
            return self._views.live_spectra(rolled, low, high, self.bar.window_kind)
        return self._views.live(rolled, *self._window)

    def _rolled(self) -> tuple[Rolled, ...]:
        assert self._roll is not None
        return self._views.rolled(self._roll, self.live_channels, self._setup)

    # ----------------------------------------------------------------- measuring

    def _measure(self) -> None:
        self._to_measure = False
        if self.picture is None:
            return
        cursors, view = self.chart.cursors, self.bar.view
        low, high = sorted(cursors) if cursors is not None else self.chart.range
        if view is View.PLANE:
            low, high = -math.inf, math.inf
        self._show_readings(self.picture.columns(low, high), self.picture.levels(low, high), cursors, (low, high))
        held = HELD if self._roll is not None and not self._following and view is View.TIME else ""
        set_text(self.between, "\n".join(filter(None, (apart_words(cursors, view is View.SPECTRUM), held))))

    def _show_readings(
        self, columns: Sequence[Column], levels: Sequence[Level], cursors: Sequence[float] | None,
        shown: tuple[float, float],
    ) -> None:  # fmt: skip
        """Those of curves, and below them those of tracks."""
        self.readings.setVisible(bool(columns) or not levels)
        self.readings.show_columns(columns, cursors, shown)
        self.timings.show_levels(levels, cursors, shown)

    def _toggle_cursors(self, on: bool) -> None:
        """Cursors stand at moments: a live picture is held for them."""
        low, high = self.chart.range
        if on and self._roll is not None and self.bar.view is View.TIME:
            self._following, high = False, max(min(high, self._roll.end), low)
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
        self._following = self._following or self.bar.stretch is None
        self.redraw(fit=True)
        self.chosen.emit()

    def _save_picture(self) -> None:
        strip = next(iter(self.chart.strips.values()), None)
        if strip is None:
            set_text(self.bar.words, "There is no curve yet: capture something, or look at live values.")
        else:
            strip.save()

    def _ask_what_to_save(self) -> None:
        """All of the capture or of the live values, or the stretch that is on the screen."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        whole = "Save all live values…" if self._roll is not None else "Save the whole capture…"
        menu.addAction(whole).triggered.connect(lambda: self._save(-math.inf, math.inf))
        part = menu.addAction("Save only what is on the screen…")
        part.triggered.connect(lambda: self._save(*self.chart.range))
        part.setEnabled(self.bar.view is View.TIME)
        menu.popup(self.bar.save.mapToGlobal(self.bar.save.rect().bottomLeft()))

    def _save(self, low: float, high: float) -> None:
        if self._roll is not None:
            self.save_wanted.emit(self._roll.capture(self.live_channels, low, high))
        elif self.shown is not None:
            self.save_wanted.emit(self.shown if low == -math.inf else cut(self.shown, low, high))

    def _live(self) -> None:
        self._following = True
        self.live_wanted.emit(self.bar.live.isChecked())

    def _panned(self) -> None:
        self._following = self._following and self.bar.view is not View.TIME
        self._measure()

    def _fitted(self) -> None:
        self._following = True
        self._measure()

    # -------------------------------------------------------------------- joining

    def _lay_out(self) -> None:
        self._whole = QVBoxLayout(self)
        self._whole.setContentsMargins(0, 0, 0, 0)
        self._whole.setSpacing(6)
        parts = QSplitter(self)
        self._whole.addWidget(parts, 1)
        scroll = self.choices_side = QScrollArea(parts)
        scroll.setWidgetResizable(True)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        scroll.setFrameShape(QScrollArea.Shape.NoFrame)
        scroll.setAccessibleName("What is captured")
        scroll.setMinimumWidth(250)
        middle, self.empty = QWidget(parts), QLabel(EMPTY)
        self._middle = QVBoxLayout(middle)
        self._middle.setContentsMargins(0, 0, 0, 0)
        self._middle.addWidget(self.empty, 1)
        self.empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.empty.setWordWrap(True)
        self.empty.setProperty("role", "quiet")
        self.side, readings, self.between = QTabWidget(parts), QWidget(), QLabel()
        self.side.addTab(readings, "Readings")
        self.side.setAccessibleName("Readings and captures")
        self._beside = QVBoxLayout(readings)
        self._beside.setContentsMargins(0, 4, 0, 0)
        self._beside.addWidget(self.between)
        self.between.setWordWrap(True)
        parts.setStretchFactor(1, 1)
        parts.setSizes([300, 680, 330])
        parts.setCollapsible(1, False)

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
        bar.drawn_otherwise.connect(self.chosen)
        chart.cursors_moved.connect(lambda: self._measure())
        chart.panned.connect(self._panned)
        chart.fitted.connect(self._fitted)
        self.choices.changed.connect(self._chosen)
        self.kept.changed.connect(lambda: self.redraw(fit=True))

    def resizeEvent(self, event: QResizeEvent) -> None:
        """What stands beside the curves gives way where there is little room, until the person says otherwise."""
        super().resizeEvent(event)
        if self.making.done:
            self._fit_room(event.size().width())

    def _fit_room(self, width: int) -> None:
        room = (width >= LEAST_LEFT, width >= LEAST_RIGHT)
        if room != self._room:
            self._room = room
            self.bar.sides_left.setChecked(room[0])
            self.bar.sides_right.setChecked(room[1])

    def _chosen(self) -> None:
        """Other channels, colours or derived curves."""
        if self._roll is not None and set(self._roll.tracks) != {each.live_key for each in self.live_channels}:
            self.live_wanted.emit(True)  # with these channels; what is there of them stays
        self.redraw()
        self.chosen.emit()
