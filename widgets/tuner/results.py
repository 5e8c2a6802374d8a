"""What came of a run: the diagrams, the numbers below them, and what can be done with them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QCheckBox, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from widgets.panel import set_text
from widgets.parts.turns import Turns

if TYPE_CHECKING:
    from device.tuning.metrics import Metrics
    from widgets.tuner.bode import BodePlot
    from widgets.tuner.plots import Curve, StepPlot


class Results(QWidget):
    """The Bode plot over the step; made without its plots, which take longest to load."""

    error_chosen = Signal(bool)
    zero_wanted = Signal()
    save_wanted = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._turns = Turns(self)
        self.error, self.metrics = QCheckBox("Position error"), QLabel()
        self.save, self.zero = QPushButton("Save data…"), QPushButton("Zero position")
        self.step_plot: StepPlot | None = None
        self.bode_plot: BodePlot | None = None

    def pieces(self) -> Iterator[None]:
        """The diagrams, in their places from the start."""
        from widgets.tuner.bode import BodePlot
        from widgets.tuner.plots import StepPlot

        step_plot, bode_plot = StepPlot(self._turns, self), BodePlot(self)
        bode_plot.hide()
        self._lay_out(step_plot, bode_plot)
        yield
        for plot in (step_plot, bode_plot):
            yield from plot.making.each()
            yield
        self.step_plot, self.bode_plot = step_plot, bode_plot
        self.error.toggled.connect(step_plot.show_error)
        self.error.toggled.connect(self.error_chosen)
        self.zero.clicked.connect(self.zero_wanted)
        self.save.clicked.connect(self.save_wanted)

    def appear(self) -> None:
        """All is in its place."""
        self._bring()
        self.setUpdatesEnabled(True)

    def show_bode(self, on: bool) -> None:
        """The Bode plot over the step, or the step alone."""
        if self.bode_plot is not None and self.bode_plot.isHidden() == on:
            self._bring()
            self.bode_plot.setVisible(on)

    def _bring(self) -> None:
        assert self.bode_plot is not None and self.step_plot is not None
        step, bode = self.step_plot, self.bode_plot
        self._turns.bring((bode.gain, bode.phase, step.position, step.torque))

    def show_curves(self, curves: Sequence[Curve], metrics: Metrics | None, torque_limit: float) -> None:
        """Responses over each other, the last one in front with its numbers."""
        if self.step_plot is not None:
            self.step_plot.show_curves(curves, torque_limit)
        set_text(self.metrics, metrics_words(metrics))
        self.save.setEnabled(bool(curves))

    def _lay_out(self, step_plot: StepPlot, bode_plot: BodePlot) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(4)
        column.addWidget(bode_plot, 4)
        row = QHBoxLayout()
        self.metrics.setWordWrap(True)
        self.metrics.setAccessibleName("Measured")
        self.metrics.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        row.addWidget(self.error)
        row.addStretch(1)
        self.zero.setToolTip("Clears the graph: the next step is drawn from 0 and alone. The axis keeps its position.")
        self.save.setToolTip("The last response as a table (CSV) or for NumPy (npz)")
        self.save.setEnabled(False)
        row.addWidget(self.zero)
        row.addWidget(self.save)
        column.addLayout(row)
        column.addWidget(step_plot, 3)
        column.addWidget(self.metrics)


def metrics_words(metrics: Metrics | None) -> str:
    """The numbers of a response in one line."""
    if metrics is None:
        return ""
    from device.tuning.metrics import percent

    settled = "did not settle" if metrics.settling_time is None else f"settled in {metrics.settling_time * 1000:.0f} ms"
    part = percent(metrics.saturated) if metrics.saturated >= 0.005 else "less than 1 %"
    torque = f", ▲ torque at its limit {part} of the time" if metrics.saturated > 0 else ""
    return (
        f"Rise {_rise(metrics)}, overshoot {percent(metrics.overshoot)}, {settled}, "
        f"steady error {metrics.steady_error:.1f} counts, largest {metrics.peak_error:.0f}{torque}"
    )


def _rise(metrics: Metrics) -> str:
    """Between two recorded values nothing is known: there it says how far they are apart."""
    if metrics.rise_time is None:
        return "–"
    if metrics.coarse:
        apart = f"a value each {metrics.every * 1000:.1f} ms: record for a shorter time"
        return f"about {metrics.rise_time * 1000:.0f} ms ({apart})"
    return f"{metrics.rise_time * 1000:.1f} ms"
