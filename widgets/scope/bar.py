"""The row above the curves: begin, end and follow a capture; choose what is seen."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from enum import StrEnum
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QComboBox,
    QHBoxLayout,
    QLabel,
    QMenu,
    QProgressBar,
    QPushButton,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from device.curves import WINDOW_WORDS, Window
from widgets.panel import set_text, show_role
from widgets.parts.icons import icon
from widgets.parts.look import look
from widgets.parts.pieces import Pieces
from widgets.parts.wrapping import WrappingRow

SPANS = {"10 s": 10.0, "30 s": 30.0, "2 min": 120.0, "10 min": 600.0, "1 h": 3600.0}


class View(StrEnum):
    """What is drawn over what."""

    TIME = "Over time"
    PLANE = "X-Y"
    SPECTRUM = "Spectrum"


class Bar(QWidget):
    """Buttons and lists; the body listens to them."""

    view_chosen = Signal()
    drawn_otherwise = Signal()

    def __init__(self, parent: QWidget | None = None, at_once: bool = True) -> None:
        super().__init__(parent)
        self.stretch: tuple[float, float] | None = None  # of which the spectrum is calculated
        self._busy = False
        self._sides = ("", "")  # of the last start
        self._shown: list[bool] = []
        self._fitting = False
        self.making = Pieces(self._pieces())
        if at_once:
            self.making.finish()

    def _pieces(self) -> Iterator[None]:
        self.capture, self.finish, self.cancel, self.live, self.cursors, self.sides_left, self.sides_right = (
            QPushButton(text, self)
            for text in ("Capture", "Stop, read", "Cancel", "Live", "Cursors", "Channels", "Readings")
        )
        self.span, self.views, self.windows, self.across, self.upward = (QComboBox(self) for _ in range(5))
        self.over, self.words, self.progress = QLabel("over", self), QLabel(self), QProgressBar(self)
        self.fit, self.save, self.open, self.picture, self.more = (QToolButton(self) for _ in range(5))
        self.tools = (self.fit, self.save, self.open, self.picture)
        for each in (self.capture, self.live):
            each.setEnabled(False)  # until it is known what is connected
        self._name_all()
        yield
        self._lay_out()
        self._connect()
        self.show_result("")
        self.show_live(False)
        self.show_view(self.view, False)

    # ------------------------------------------------------------------- chosen

    @property
    def view(self) -> View:
        return View(self.views.currentText())

    @property
    def window_kind(self) -> Window:
        return Window(self.windows.currentText())

    @property
    def span_s(self) -> float:
        """How much of the live roll is shown."""
        return SPANS[self.span.currentText()]

    @property
    def sides(self) -> tuple[str, str]:
        """The names of the curves across and upward."""
        return self.across.currentText(), self.upward.currentText()

    def offer_sides(self, names: Sequence[str]) -> None:
        """The curves that can be drawn over each other."""
        if [self.across.itemText(place) for place in range(self.across.count())] == list(names):
            return
        for box, usual in ((self.across, 0), (self.upward, min(1, len(names) - 1))):
            before = box.currentText() or self._sides[box is self.upward]
            box.blockSignals(True)
            box.clear()
            box.addItems(list(names))
            box.setCurrentIndex(names.index(before) if before in names else usual)
            box.blockSignals(False)

    # --------------------------------------------------------------- remembered

    def state(self) -> dict[str, Any]:
        """What was chosen, for the next start."""
        boxes = {"view": self.views, "window": self.windows, "span": self.span}
        across, upward = (now or before for now, before in zip(self.sides, self._sides, strict=True))
        return {**{name: box.currentText() for name, box in boxes.items()}, "across": across, "upward": upward}

    def restore(self, found: Mapping[str, Any]) -> None:
        """As far as it is something that can be chosen."""
        for name, box in (("view", self.views), ("window", self.windows), ("span", self.span)):
            place = box.findText(str(found.get(name, "")))
            if place >= 0:
                box.setCurrentIndex(place)
        self._sides = str(found.get("across", "")), str(found.get("upward", ""))

    # -------------------------------------------------------------------- shown

    def allow(self, reason: str, online: bool) -> None:
        """Whether a capture can begin; the reason why not is its tip."""
        self.capture.setEnabled(not reason and not self._busy and not self.live.isChecked())
        told = reason or ("Switch Live off first." if self.live.isChecked() else "The controller records by itself.")
        if self.capture.toolTip() != told:
            self.capture.setToolTip(told)
            self.capture.setStatusTip(told)
        self.live.setEnabled(online and not self._busy)

    def show_progress(self, phase: str, fraction: float, remaining_s: float) -> None:
        """A capture is under way."""
        self._busy = True
        with self._at_once():
            for widget in (self.finish, self.cancel, self.progress, self.words):
                widget.show()
            self._fit_anew()
        self.progress.setRange(0, 0 if math.isnan(remaining_s) and phase != "preparing" else 1000)
        self.progress.setValue(round(1000 * fraction))
        left = "" if math.isnan(remaining_s) or phase == "preparing" else f", {_left(remaining_s)} left"
        self.words.setWordWrap(False)
        set_text(self.words, f"{phase[:1].upper()}{phase[1:]}{left}")
        show_role(self.words, "quiet")

    def show_result(self, words: str, good: bool = True) -> None:
        """Nothing is under way any more."""
        self._busy = False
        with self._at_once():
            for widget in (self.finish, self.cancel, self.progress):
                widget.hide()
            self._fit_anew()
        set_text(self.words, words)
        self.words.setToolTip(words)
        self.words.setVisible(bool(words))
        self.words.setWordWrap(True)
        show_role(self.words, "quiet" if good else "problem")

    def show_live(self, on: bool) -> None:
        self.live.setChecked(on)
        with self._at_once():
            self.span.setVisible(on)
            self._fit_anew()

    def show_view(self, view: View, live: bool) -> None:
        """Only what belongs to the view is offered."""
        with self._at_once():
            self.windows.setVisible(view is View.SPECTRUM)
            for widget in (self.across, self.over, self.upward):
                widget.setVisible(view is View.PLANE)
            self._fit_anew()
        self.cursors.setEnabled(view is not View.PLANE)
        words = "Save live values" if live else "Save capture"
        if self.save.accessibleName() != words:
            self.save.setAccessibleName(words)
            self.save.setToolTip(f"{words}: CSV or NumPy")

    def can_save(self, there: bool) -> None:
        self.save.setEnabled(there)

    # ------------------------------------------------------------------ details

    def _name_all(self) -> None:
        for button, name, tip in (
            (self.capture, "record", "The controller records by itself."),
            (self.finish, "download", "Ends the recording now and reads what was recorded"),
            (self.cancel, "close", "Ends it and keeps what has been read"),
            (self.live, "play", "Shows the chosen channels continuously, as fast as the line carries"),
            (self.cursors, "measure", "Two cursors: drag them, or choose one with A or B and move it with Ctrl+arrows"),
            (self.sides_left, "settings", "What is captured, beside the curves"),
            (self.sides_right, "program", "Readings and earlier captures, beside the curves"),
        ):
            button.setIcon(icon(name))
            button.setToolTip(tip)
            button.setAccessibleName(button.text())
        for small, name, words, tip in (
            (self.fit, "zoom_fit", "Fit", "Shows everything (double click)"),
            (self.save, "save", "Save capture", "CSV or NumPy"),
            (self.open, "open", "Open capture", "Opens earlier captures"),
            (self.picture, "export", "Save picture", "Saves the picture as it is on the screen"),
        ):
            small.setIcon(icon(name))
            small.setAccessibleName(words)
            small.setToolTip(f"{words}: {tip[:1].lower()}{tip[1:]}")
            small.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
            small.setProperty("role", "control")
            small.setFixedWidth(look().space["control"] + 8)
            small.setStyleSheet("padding: 0;")  # as narrow as that, the usual padding would leave the icon no room
        self.more.setIcon(icon("down"))
        self.more.setAccessibleName("More")
        self.more.setToolTip("Fit, save, open, picture")
        self.more.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.more.setProperty("role", "control")
        self.more.setFixedWidth(look().space["control"] + 8)
        self.more.setStyleSheet("padding: 0;")
        for switch in (self.live, self.cursors, self.sides_left, self.sides_right):
            switch.setCheckable(True)
        self.capture.setProperty("role", "primary")
        self.capture.setIcon(icon("record", "accent_text"))
        for box, name in (
            (self.views, "View"), (self.windows, "Window of the spectrum"), (self.across, "Across"),
            (self.upward, "Upward"), (self.span, "Time shown live"),
        ):  # fmt: skip
            box.setAccessibleName(name)
        self.views.addItems([str(view) for view in View])
        self.span.addItems(list(SPANS))
        for window in Window:
            self.windows.addItem(str(window))
            self.windows.setItemData(self.windows.count() - 1, WINDOW_WORDS[window], Qt.ItemDataRole.ToolTipRole)
        self.progress.setAccessibleName("Progress of the capture")
        self.progress.setTextVisible(False)
        self.progress.setMaximumHeight(6)
        for box in (self.across, self.upward):
            box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
            box.setMinimumContentsLength(12)

    def _lay_out(self) -> None:
        apart = QWidget(self)
        apart.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        row = WrappingRow(
            self.capture, self.finish, self.cancel, self.live, self.span, apart,
            self.views, self.windows, self.upward, self.over, self.across, self.cursors,
            self.sides_left, self.sides_right, *self.tools, self.more,
        )  # fmt: skip
        row.setSpacing(6)
        self._row = row
        state = QHBoxLayout()
        state.addWidget(self.words, 1)
        state.addWidget(self.progress, 2, Qt.AlignmentFlag.AlignVCenter)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(4)
        column.addLayout(row)
        column.addLayout(state)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if event.size().width() != event.oldSize().width():
            self._fit()

    @contextmanager
    def _at_once(self) -> Iterator[None]:
        """What is shown or hidden inside is laid out and painted once, afterwards; Qt would do it after each."""
        layout = self.layout()
        assert layout is not None
        layout.setEnabled(False)
        self.setUpdatesEnabled(False)
        try:
            yield
        finally:
            layout.setEnabled(True)
            self.setUpdatesEnabled(True)
            layout.invalidate()

    def _fit_anew(self) -> None:
        """Where other controls are shown than before."""
        shown = [box.isHidden() for box in (self.finish, self.span, self.windows, self.across)]
        if shown != self._shown:
            self._shown = shown
            self._fit()

    def _fit(self) -> None:
        """Where there is little room some buttons show their icons only, then tools become a menu, then it wraps."""
        if self._fitting:  # what is shown or hidden here may change the height at once
            return
        self._fitting = True
        for words, tools in ((True, True), (False, True), (False, False)):
            for button in (self.cursors, self.sides_left, self.sides_right):
                button.setText(button.accessibleName() if words else "")
            for tool in self.tools:
                tool.setVisible(tools)
            self.more.setVisible(not tools)
            if self._row.sizeHint().width() <= self.width():
                break
        self._fitting = False

    def _show_more(self) -> None:
        """The tools that have no room, as a menu."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for tool in self.tools:
            entry = menu.addAction(tool.icon(), tool.accessibleName())
            entry.setEnabled(tool.isEnabled())
            entry.triggered.connect(tool.click)
        menu.popup(self.more.mapToGlobal(self.more.rect().bottomLeft()))

    def _connect(self) -> None:
        self.views.currentIndexChanged.connect(self.view_chosen)
        for box in (self.windows, self.across, self.upward, self.span):
            box.currentIndexChanged.connect(self.drawn_otherwise)
        self.more.clicked.connect(self._show_more)


def _left(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.1f} min"
