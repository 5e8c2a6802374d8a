"""The picture of the scope: strips one above the other, one for each scale, with one time and two cursors for all."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any

import pyqtgraph
from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QColor, QFontMetrics, QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget

from widgets.parts.look import look
from widgets.parts.turns import Turns
from widgets.scope.lanes import NO_LIMIT
from widgets.scope.strip import Line, Strip

FEW_TOGETHER = 5000  # of all curves
NAMES = ("A", "B")
SIDE = 0.35  # of the width, for names of tracks at the most
NO_BREAK = "\N{NO-BREAK SPACE}"
SPARE = 3  # strips that are made before they are needed


class Chart(QWidget):
    """Shows lines; cursors are at places of the time axis, None while they are hidden."""

    cursors_moved = Signal()
    panned = Signal()
    fitted = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName("Curves")
        self.strips: dict[str, Strip] = {}
        self._spare: list[Strip] = []  # as new
        self._turns = Turns(self)
        self.cursors: list[float] | None = None
        self._chosen = 0
        self._step = 0.001
        self._lines: dict[str, list[Any]] = {}
        self._marks: dict[str, list[Any]] = {}
        self._mark: tuple[float, float] | None = None
        self._shape: tuple[object, ...] = ()
        self._empty = False  # nothing is drawn into the strips of this shape yet
        self._named: dict[str, tuple[object, ...]] = {}
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(2)

    def prepare(self) -> None:
        """A strip for the next picture with each tick: made when they are needed the window would stand still."""
        if len(self._spare) < SPARE:
            self._spare.append(self._made())

    def _made(self) -> Strip:
        strip = Strip(self)
        strip.hide()
        strip.panned.connect(self.panned)
        strip.getViewBox().setMouseEnabled(x=True, y=True)
        return strip

    # ------------------------------------------------------------------ drawing

    def show_lines(
        self, lines: Sequence[Line], bottom: str, *, equal: bool = False, mark: tuple[float, float] | None = None,
        step: float = 0.001,
    ) -> bool:  # fmt: skip
        """`bottom` names the common axis; `mark` is the trigger and how much earlier it may have been.

        Whether there are other strips now: then everything is shown.
        """
        self._step = step
        fresh = self.begin(lines, bottom, equal)
        self._empty = False
        (self._turns.bring if fresh else self._turns.change)(self.strips.values())
        few = sum(len(line.y) for line in lines) <= FEW_TOGETHER
        for group, strip in self.strips.items():
            mine = [line for line in lines if line.group == group]
            strip.show_lines(mine, few)
            self._name(group, mine, bottom)
        self._share_room()
        if fresh or mark != self._mark:
            self._mark = mark
            self._draw_mark()
        if fresh:
            self._draw_cursors()
            for strip in self.strips.values():
                strip.fit_own()
        return fresh

    def begin(self, lines: Sequence[Line], bottom: str, equal: bool) -> bool:
        """The strips that lines will have, without them; whether there are none in them yet."""
        groups = list(dict.fromkeys(line.group for line in lines)) or [""]
        shape = (bottom, equal, tuple(groups))
        if shape != self._shape:
            self._shape, self._empty = shape, True
            self._build(groups, equal)
        return self._empty

    def _build(self, groups: list[str], equal: bool) -> None:
        """Strips that are there go on; all are laid out once, because each size they have takes time."""
        strips = list(self.strips.values())
        self._column.setEnabled(False)
        for strip in strips[len(groups) :]:
            self._column.removeWidget(strip)
            strip.hide()
            strip.deleteLater()
        self._wipe(self._lines)
        self._wipe(self._marks)
        while len(strips) < len(groups):
            strips.append(self._spare.pop() if self._spare else self._made())
            self._column.addWidget(strips[-1], 1)
        self.strips, self._named = dict(zip(groups, strips, strict=False)), {}
        high = (self.height() - (len(groups) - 1) * self._column.spacing()) // len(groups)
        for number, (group, strip) in enumerate(self.strips.items()):
            strip.setAccessibleName(f"Curves of {group.lower()}" if group else "Curves")
            strip.setAspectLocked(equal)
            if strip.isHidden():
                strip.setGeometry(0, number * (high + self._column.spacing()), self.width(), high)
                strip.show()
            strip.setXLink(strips[0] if number else None)
            last = number == len(groups) - 1
            strip.getAxis("bottom").setStyle(showValues=last)
            strip.getAxis("bottom").setHeight(None if last else 6)
        self._turns.bring(self.strips.values())
        self._column.setEnabled(True)

    def _wipe(self, drawn: dict[str, list[Any]]) -> None:
        """These are no longer in their strips."""
        for group, items in drawn.items():
            for item in items:
                self.strips[group].removeItem(item)
        drawn.clear()

    def _name(self, group: str, lines: Sequence[Line], bottom: str) -> None:
        """Left: what is shown, with its unit; above the curves their names in their colours."""
        strip = self.strips[group]
        key = (bottom, *((line.label, line.unit, line.colour.name(), line.dashed, line.faded) for line in lines))
        if key == self._named.get(group):
            return
        self._named[group] = key
        units = list(dict.fromkeys(line.unit for line in lines if line.unit))
        last = strip is list(self.strips.values())[-1]
        words = f"{group}, {units[0]}" if units and group and ", " not in group else group or ", ".join(units)
        words = "" if strip.lanes.labels else words
        below = bottom if last else ""
        if (strip.getAxis("left").labelText, strip.getAxis("bottom").labelText) != (words, below):
            strip.name_sides(below, words)
            strip.show_titles()
        dash = {True: "┅", False: "━"}
        names = dict.fromkeys(
            (line.label, line.colour.name(), line.dashed) for line in lines if not line.faded and not line.track
        )
        strip.show_legend(f"{3 * NO_BREAK} ".join(
            f'<span style="color:{colour}">{dash[dashed]}{NO_BREAK}{escape(label).replace(" ", NO_BREAK)}</span>'
            for label, colour, dashed in names
        ))  # fmt: skip

    def _share_room(self) -> None:
        """Sides of the same width, so that times stand under each other; tracks have no more height than they need."""
        strips = list(self.strips.values())
        usual = QFontMetrics(look().small_font()).horizontalAdvance("-000 000") + 34
        names = min(max((strip.lanes.widest for strip in strips), default=0), round(SIDE * self.width()))
        alone = all(strip.lanes.labels for strip in strips)
        for strip in strips:
            strip.show_left(max(usual, names))
            most = NO_LIMIT if alone else strip.lanes.most
            if strip.maximumHeight() != most:
                strip.setMaximumHeight(most)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._share_room()

    def fit(self) -> None:
        """Everything is shown."""
        for strip in self.strips.values():
            strip.fit_own()
        self.fitted.emit()

    @property
    def range(self) -> tuple[float, float]:
        """From where to where the common axis is shown."""
        strip = next(iter(self.strips.values()), None)
        if strip is None:
            return 0.0, 1.0
        low, high = strip.getViewBox().viewRange()[0]
        return float(low), float(high)

    def show_range(self, low: float, high: float) -> None:
        """The common axis from here to there; the other one follows its values."""
        for strip in self.strips.values():
            strip.getViewBox().enableAutoRange(axis="y")
        next(iter(self.strips.values())).getViewBox().setXRange(low, high, padding=0.0)

    # ------------------------------------------------------------------ cursors

    def show_cursors(self, places: Sequence[float] | None) -> None:
        """Both cursors at these places of the common axis; None hides them."""
        self.cursors = None if places is None else list(places)
        self._draw_cursors()
        self.cursors_moved.emit()

    def _draw_cursors(self) -> None:
        for group, strip in self.strips.items():
            for line in self._lines.pop(group, []):
                strip.removeItem(line)
            if self.cursors is not None:
                self._lines[group] = [self._cursor(strip, number) for number in range(2)]

    def _cursor(self, strip: Strip, number: int) -> Any:
        assert self.cursors is not None
        colour = look().colour("text")
        dash = Qt.PenStyle.SolidLine if number == 0 else Qt.PenStyle.DashLine
        line = pyqtgraph.InfiniteLine(
            self.cursors[number], angle=90, movable=True, pen=pyqtgraph.mkPen(colour, width=1, style=dash),
            hoverPen=pyqtgraph.mkPen(look().colour("accent"), width=3),
            label=NAMES[number],
            labelOpts={"position": 0.85, "color": look().colour("surface"), "fill": colour, "movable": False},
        )  # fmt: skip
        line.sigPositionChanged.connect(lambda moved, number=number: self._moved(number, float(moved.value())))
        strip.addItem(line, ignoreBounds=True)
        return line

    def _moved(self, number: int, place: float) -> None:
        if self.cursors is None or self.cursors[number] == place:
            return
        self.cursors[number] = place
        self._chosen = number
        for lines in self._lines.values():
            if lines[number].value() != place:
                lines[number].setValue(place)
        self.cursors_moved.emit()

    def key(self, event: QKeyEvent) -> bool:
        """A and B choose a cursor, Ctrl with arrows moves it by one value, with Shift by ten."""
        if self.cursors is None:
            return False
        if event.key() in (Qt.Key.Key_A, Qt.Key.Key_B):
            self._chosen = int(event.key() == Qt.Key.Key_B)
            return True
        held = event.modifiers()
        side = {Qt.Key.Key_Left: -1, Qt.Key.Key_Right: 1}.get(Qt.Key(event.key()), 0)
        if not side or not held & Qt.KeyboardModifier.ControlModifier:
            return False
        far = 10 if held & Qt.KeyboardModifier.ShiftModifier else 1
        self._moved(self._chosen, self.cursors[self._chosen] + side * far * self._step)
        return True

    # ------------------------------------------------------------------- details

    def _draw_mark(self) -> None:
        """A dotted line at the trigger, and a shade over the time in which it may have been."""
        for group, strip in self.strips.items():
            for item in self._marks.pop(group, []):
                strip.removeItem(item)
            if self._mark is None:
                continue
            at, early = self._mark
            pen = pyqtgraph.mkPen(look().colour("quiet"), width=1, style=Qt.PenStyle.DotLine)
            items: list[Any] = [pyqtgraph.InfiniteLine(at, angle=90, pen=pen)]
            if early > 0:
                shade = QColor(look().colour("quiet"))
                shade.setAlpha(40)
                items.append(pyqtgraph.LinearRegionItem((at - early, at), movable=False, brush=shade, pen=None))
            for item in items:
                strip.addItem(item, ignoreBounds=True)
            self._marks[group] = items

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.StyleChange, QEvent.Type.PaletteChange) and hasattr(self, "_column"):
            self._draw_cursors()
            self._draw_mark()
