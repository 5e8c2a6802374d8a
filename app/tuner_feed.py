"""Feed-forwards of the model page: FV and FA from the estimate, and a profiled move without and with them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject

from widgets.tuner.asked import Asked
from widgets.tuner.panel import TunerPanel

if TYPE_CHECKING:
    from app.tuner_model import Modelling
    from device.download import Job
    from device.tuning.bench import Measured
    from device.tuning.feed import Feeds, Sweep
    from device.tuning.loop import Gains

Begin = Callable[["Job[Any]", str, Callable[[Any], None]], None]
Moves = Callable[[Asked, "Sweep", "Gains"], "Job[Any]"]


class Feeding(QObject):
    """`moves` starts the two moves between guards, `begin` follows the run, `keep` writes it into the logbook.

    `tops` tells the highest SP and AC of an axis.
    """

    def __init__(
        self,
        panel: TunerPanel,
        model: Modelling,
        careful: Callable[[str, Callable[[], object]], None],
        moves: Moves,
        begin: Begin,
        keep: Callable[[Measured, str, str], None],
        tops: Callable[[str], tuple[int, int]],
        parent: QObject,
    ) -> None:
        super().__init__(parent)
        self._tops = tops
        self._panel, self._model, self._careful = panel, model, careful
        self._moves, self._begin, self._keep = moves, begin, keep
        panel.moves_wanted.connect(lambda asked: careful("Tune", lambda: self._compare(asked)))

    def _compare(self, asked: Asked) -> None:
        found, proposal = self._model.feeds, self._model.proposal
        if found is None or proposal is None or proposal.gains is None or self._model.estimate is None:
            return
        from device.tuning.feed import sweep

        tops = self._tops(asked.axis)
        way = sweep(self._model.estimate.plant, asked.step, self._model.period, asked.torque, tops)
        without = replace(asked, gains=replace(proposal.gains, fv=0.0, fa=0.0))
        job = self._moves(without, way, replace(proposal.gains, fv=found.fv, fa=found.fa))
        self._begin(job, f"Move of {asked.axis}", lambda measured: self._compared(measured, found))

    def _compared(self, measured: tuple[Measured, Measured], found: Feeds) -> None:
        import numpy as np

        self._panel.results.error.setChecked(True)  # that is what the moves are for
        first, second = (float(np.abs(m.response.commanded - m.response.actual).max()) for m in measured)
        words = (
            f"Largest following error of the move in counts: {first:.3g} without, {second:.3g} with "
            f"FV {found.fv:g} and FA {found.fa:g}."
        )
        for each in measured:
            self._keep(each, "move", words)
        if second < first:
            self._panel.manual.gains.show_gains(measured[1].gains)
            words += " They are in the fields; “Use these gains” sets them."
        self._panel.show_result(words, good=second < first)
