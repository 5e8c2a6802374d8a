"""The X-Y view: where two axes are, where they were commanded, and the way they came."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from codegen.numbers import parse_number
from device.api import Kind
from widgets.display.readings import age_of, unit_of
from widgets.panel import Panel, set_text
from widgets.parts.look import look
from widgets.parts.units import scale_of, shown
from widgets.plane.trail import Trail

if TYPE_CHECKING:
    from codegen.document import Document
    from codegen.setup import Setup
    from device.api import Row
    from widgets.parts.plot import Plot

EMPTY = "Nothing is connected. Connect a controller or start the simulator to see where its axes go."
TOGETHER_S = 0.0005  # read in one line
Path = Sequence[tuple[float, float]]
PATH = "path "  # before the name of one, among what is drawn
ONE_AXIS = "This controller has one axis; a view from above needs two."


class PlanePanel(Panel):
    """Reads only. The trail is kept while the panel is visible; the axes have the same scale unless units differ."""

    title = "X-Y view"

    def __init__(self, parent: QWidget | None = None, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__(parent)
        self._clock = clock
        self._setup: Setup | None = None
        self._letters = ""
        self.actual, self.commanded = Trail(), Trail()
        self.plot: Plot | None = None
        self._drawn: dict[str, Any] = {}
        self._paths: dict[str, Path] = {}
        self._ghost: dict[str, int] = {}
        self.across, self.upward = QComboBox(), QComboBox()
        self.clear, self.fit = QPushButton("Clear trail"), QPushButton("Fit")
        self.place, self.empty = QLabel(), QLabel(EMPTY)
        self._lay_out()

    # ---- what it shows

    def show_controller(self) -> None:
        self.forget()
        self._fit_axes()

    def show_document(self, old: Document | None, new: Document) -> None:
        if old is None or old.setup is not new.setup:
            self._setup = new.setup
            self.forget()  # the trail is in the units of before
            self._fit_axes()
            self._draw_limits()

    def watches(self) -> tuple[str, ...]:
        return tuple(f"{name}.{letter.lower()}" for name in ("position", "commanded") for letter in self.shown)

    def draws(self) -> tuple[str, ...]:
        """Both places of a moment belong together: read apart the cross would seem to lag behind."""
        return self.watches()

    @property
    def shown(self) -> str:
        """The letters of the axes that are drawn: across, upward."""
        first, second = self.across.currentText(), self.upward.currentText()
        return first + second if first and second and first != second else ""

    def refresh(self, row: Row) -> None:
        self._fit_axes()
        if not self.shown or self._setup is None or self.plot is None:
            return
        now = self._clock()
        stale = any(row.stale(f"position.{letter.lower()}", now) for letter in self.shown)
        if not stale:
            changed = [trail.add(*self._place(row, name)) for name, trail in self._trails if self._together(row, name)]
            if any(changed):
                self._draw()
        set_text(self.place, self._words(row, now))

    def show_path(self, name: str, points: Path) -> None:
        """A path to be driven, thin and under the trail, in user units of X and Y; without points it is gone."""
        self._paths = {**self._paths, name: tuple(points)}
        if not points:
            del self._paths[name]
        self._draw_paths()

    def show_ghost(self, ghost: Mapping[str, int]) -> None:
        """Where the two axes will stop, counts: a ring; an axis that does not move keeps its place."""
        if ghost != self._ghost:
            self._ghost = dict(ghost)
            self._draw_ghost()

    def forget(self) -> None:
        """An empty trail."""
        self.actual.clear()
        self.commanded.clear()
        if self.plot is not None:
            self._draw()

    def words(self) -> str:
        """What is shown, as text."""
        return self.empty.text() if self.empty.isVisibleTo(self) else self.place.text()

    @property
    def _trails(self) -> tuple[tuple[str, Trail], tuple[str, Trail]]:
        return ("position", self.actual), ("commanded", self.commanded)

    def _together(self, row: Row, name: str) -> bool:
        """Whether both places are of one moment; places of two moments make a point where nothing ever was."""
        first, second = (row.time(f"{name}.{letter.lower()}") for letter in self.shown)
        return abs(first - second) < TOGETHER_S

    def _place(self, row: Row, name: str) -> tuple[float, float]:
        assert self._setup is not None
        x, y = (row.value(f"{name}.{letter.lower()}") / scale_of(self._setup.axis(letter)) for letter in self.shown)
        return x, y

    def _words(self, row: Row, now: float) -> str:
        assert self._setup is not None
        parts = []
        for letter in self.shown:
            axis = self._setup.axis(letter)
            parts.append(f"{letter} {shown(row.value(f'position.{letter.lower()}'), axis)} {unit_of(axis)}")
        old = age_of(row, f"position.{self.shown[0].lower()}", now)
        return "   ".join(parts) + (f"   ({old})" if old else "")

    # ---- the picture

    def pieces(self) -> Iterator[None]:
        """The picture, as what draws it takes a while to load and to make."""
        from widgets.parts.plot import Plot

        yield
        plot = Plot("Path of two axes from above", equal=True, parent=self)
        yield
        self._drawn = {
            "limits": plot.plot(), "commanded": plot.plot(), "actual": plot.plot(),
            "ghost": plot.plot(symbol="o", symbolSize=20),
            "target": plot.plot(symbol="+", symbolSize=14), "head": plot.plot(symbol="o", symbolSize=11),
        }  # fmt: skip
        yield
        self.plot = plot
        self.layout().insertWidget(1, plot, 1)  # type: ignore[union-attr]
        plot.setVisible(bool(self.shown))
        self._name_sides()
        self._draw_limits()
        self._draw_paths()
        self._draw()

    def _draw(self) -> None:
        if self.plot is None:
            return
        pens = {"actual": (look().colour("accent"), 2.5), "commanded": (look().colour("quiet"), 1)}
        for name, trail in (("commanded", self.commanded), ("actual", self.actual)):
            colour, width = pens[name]
            self._drawn[name].setData(trail.points, pen={"color": colour, "width": width})
        for name, trail, colour in (("target", self.commanded, "quiet"), ("head", self.actual, "accent")):
            self._drawn[name].setData(trail.points[-1:], symbolBrush=look().colour(colour), symbolPen=None, pen=None)
        if self._ghost:
            self._draw_ghost()

    def _draw_ghost(self) -> None:
        if self.plot is None or self._setup is None:
            return
        points = []
        if self.shown and any(letter in self._ghost for letter in self.shown) and self.commanded.count:
            here = self.commanded.points[-1]
            ends = [
                self._ghost[letter] / scale_of(self._setup.axis(letter)) if letter in self._ghost else place
                for letter, place in zip(self.shown, here, strict=True)
            ]
            points = [(float(ends[0]), float(ends[1]))]
        ring = {"color": look().colour("accent"), "width": 2}
        self._drawn["ghost"].setData([x for x, _ in points], [y for _, y in points], symbolPen=ring,
            symbolBrush=None, pen=None)  # fmt: skip

    def _draw_paths(self) -> None:
        """Named ones, each in a line of its own; turned where Y is drawn across."""
        if self.plot is None:
            return
        for name in [key for key in self._drawn if key.startswith(PATH) and key[len(PATH) :] not in self._paths]:
            self.plot.removeItem(self._drawn.pop(name))
        for name, points in self._paths.items():
            line = self._drawn.get(PATH + name) or self.plot.plot()
            self._drawn[PATH + name] = line
            line.setZValue(-1)
            drawn = {"XY": points, "YX": [(y, x) for x, y in points]}.get(self.shown, ())
            pen = {"color": look().colour("axis_w"), "width": 1.5}
            line.setData([x for x, _ in drawn], [y for _, y in drawn], pen=pen)

    def _draw_limits(self) -> None:
        """The rectangle of the soft limits, when all four are set up."""
        if self.plot is None or self._setup is None or not self.shown:
            return
        ends = []
        for letter in self.shown:
            axis = self._setup.axis(letter)
            low, high = parse_number(axis.reverse_limit), parse_number(axis.forward_limit)
            if low is None or high is None or not low < high:
                self._drawn["limits"].setData([], [])
                return
            ends.append((float(low), float(high)))
        (left, right), (bottom, top) = ends
        pen = {"color": look().colour("warning"), "width": 1.5, "style": Qt.PenStyle.DashLine}
        self._drawn["limits"].setData([left, right, right, left, left], [bottom, bottom, top, top, bottom], pen=pen)

    def _name_sides(self) -> None:
        if self.plot is None or self._setup is None or not self.shown:
            return
        across, upward = (self._setup.axis(letter) for letter in self.shown)
        self.plot.name_sides(f"{self.shown[0]}, {unit_of(across)}", f"{self.shown[1]}, {unit_of(upward)}")
        self.plot.setAspectLocked(unit_of(across) == unit_of(upward))
        box = self.plot.getPlotItem().getViewBox()
        box.invertX(across.mirrored)
        box.invertY(upward.mirrored)

    # ---- which axes

    def _fit_axes(self) -> None:
        """The axes of what is connected, as choices."""
        controller = self.controller
        linked = controller is not None and controller.kind is not Kind.OFFLINE and self._setup is not None
        letters = ""
        if linked and controller is not None and self._setup is not None:
            letters = controller.axes or self._setup.letters
        if letters != self._letters:
            self._letters = letters
            for box, place in ((self.across, 0), (self.upward, 1)):
                box.blockSignals(True)
                box.clear()
                box.addItems(list(letters))
                box.setCurrentIndex(min(place, len(letters) - 1))
                box.blockSignals(False)
        set_text(self.empty, ONE_AXIS if linked and len(letters) == 1 else EMPTY)
        self._show_usable(len(letters) > 1)

    def _show_usable(self, usable: bool) -> None:
        if self.empty.isVisibleTo(self) == (not usable):
            return
        self.empty.setVisible(not usable)
        self._tools.setVisible(usable)
        if self.plot is not None:
            self.plot.setVisible(usable)
        self._axes_chosen()

    def _axes_chosen(self) -> None:
        """Other axes: another trail. The same one twice makes the other one give way."""
        if self.across.currentText() == self.upward.currentText() and self._letters[1:]:
            other = self.upward if self.sender() is self.across else self.across
            place = (other.currentIndex() + 1) % len(self._letters)
            other.blockSignals(True)
            other.setCurrentIndex(place)
            other.blockSignals(False)
        self.forget()
        self._name_sides()
        self._draw_limits()
        self._draw_paths()

    def _fit(self) -> None:
        if self.plot is not None:
            self.plot.fit()

    def _lay_out(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 4, 8, 4)
        self._tools = QWidget()
        tools = QHBoxLayout(self._tools)
        tools.setContentsMargins(0, 0, 0, 0)
        for box, words in ((self.across, "Across"), (self.upward, "Upward")):
            label = QLabel(words)
            label.setBuddy(box)
            box.setAccessibleName(f"Axis drawn {words.lower()}")
            box.currentIndexChanged.connect(self._axes_chosen)
            tools.addWidget(label)
            tools.addWidget(box)
        tools.addStretch(1)
        self.clear.clicked.connect(self.forget)
        self.fit.clicked.connect(self._fit)
        self.fit.setToolTip("Shows all of it and follows again (double click on the picture).")
        tools.addWidget(self.clear)
        tools.addWidget(self.fit)
        column.addWidget(self._tools)
        self.place.setProperty("role", "quiet")
        column.addWidget(self.place)
        self.empty.setWordWrap(True)
        self.empty.setProperty("role", "quiet")
        column.addWidget(self.empty)
        column.addStretch(0)
        self._tools.hide()
