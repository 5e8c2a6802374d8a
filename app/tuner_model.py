"""Model-based tuning: the axis is excited and identified, gains follow a target, the step is predicted and then run.

The mathematics runs in a thread of its own and is imported there, so that neither the window nor the line waits.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject

from app.background import in_background
from app.tick import Tick, failure_of
from app.tuner_memory import Memory
from widgets.tuner.asked import Asked
from widgets.tuner.panel import TunerPanel

if TYPE_CHECKING:
    from app.tuner_maths import Proposal
    from device.tuning.bench import Excited
    from device.tuning.excite import NotIdentified
    from device.tuning.feed import Feeds
    from device.tuning.identify import Estimate
    from widgets.tuner.plots import Curve

LONGEST_S = 1.0  # of a predicted step
UNREACHED = "There are no gains for this target; ask for one that can be reached."


class Modelling(QObject):
    """What is known of the axis; `excite` makes it jump and hands over the record, `ended` closes a run."""

    def __init__(
        self,
        tick: Tick,
        panel: TunerPanel,
        excite: Callable[[Asked, Callable[[Excited], None]], None],
        running: Callable[[str], None],
        ended: Callable[[], None],
        memory: Memory,
        parent: QObject,
    ) -> None:
        super().__init__(parent)
        self._tick, self._panel = tick, panel
        self._excite, self._running, self._ended, self._memory = excite, running, ended, memory
        self.estimate: Estimate | None = None
        self.proposal: Proposal | None = None
        self._excited: Excited | None = None
        self._to_draw = 0
        self.designing = False
        self._next: tuple[float, float] | None = None  # asked for while one was being worked out; the last counts
        panel.target_wanted.connect(self._design)

    def forget(self) -> None:
        """Another axis, another controller."""
        self.estimate = self.proposal = self._excited = self._next = None
        self._to_draw = 0
        if self._panel.bode_plot is not None:
            self._panel.model.clear()
            self._panel.bode_plot.show_bode(None)

    def look(self) -> None:
        """With each tick: two pictures at once would be felt."""
        if self._to_draw:
            self._to_draw -= 1
            if not self._to_draw:
                self._draw_predicted()

    def data(self) -> dict[str, float | str]:
        """The estimate as the logbook keeps it."""
        if self.estimate is None:
            return {}
        from app.tuner_maths import estimate_data
        from widgets.tuner.pages import margin_words

        margins = self.proposal.margins if self.proposal is not None else None
        return {**estimate_data(self.estimate), "loop": "" if margins is None else margin_words(margins)}

    # ---- what the axis is

    def identify(self, asked: Asked) -> None:
        """A small excitation, what it tells, and gains for a sound target."""
        self._excite(asked, partial(self._work_out, asked))

    def recognise(self, asked: Asked, then: Callable[[bool | None], None]) -> None:
        """Whether the drive is in velocity mode; None where that could not be told."""

        def excited(record: Excited) -> None:
            self._estimate(record, "Working out the drive's mode…", told)

        def told(found: Estimate | NotIdentified | None, words: str) -> None:
            then(None if self.estimate is None or found is not self.estimate else self.estimate.plant.velocity_mode)

        self._excite(asked, excited)

    def _work_out(self, asked: Asked, excited: Excited) -> None:
        def told(found: Estimate | NotIdentified | None, words: str) -> None:
            self._panel.model.show_estimate(words, good=self.estimate is not None)
            if self.estimate is None:
                self._panel.show_result("The axis was not identified.", good=False)
                return
            self._panel.show_result("")
            self._propose(None, asked)

        self._estimate(excited, "Working out what the axis is…", told)

    def _estimate(
        self, excited: Excited, words: str, told: Callable[[Estimate | NotIdentified | None, str], None]
    ) -> None:
        def work() -> tuple[Estimate | NotIdentified, str, bool]:
            from app.tuner_maths import estimate_words, estimated
            from device.tuning.identify import Estimate

            found = estimated(excited)
            good = isinstance(found, Estimate)
            return found, estimate_words(found) if isinstance(found, Estimate) else found.reason, good

        def done(future: Future[Any]) -> None:
            self._ended()
            if excited is not self._excited:
                return  # another axis was chosen meanwhile
            if failure := failure_of(future):
                told(None, failure)
                return
            found, sentence, good = future.result()
            self.estimate = found if good else None
            told(found, sentence)

        self._excited, self.estimate = excited, None
        self._running(words)
        self._tick.when_done(in_background(work), done)

    # ---- gains for a target

    def _design(self, crossover: float, phase: float) -> None:
        self._memory.keep_target(crossover, phase)
        if self.designing:
            self._next = (crossover, phase)
        elif self.estimate is not None:
            self._propose((crossover, phase), self._panel.asked)

    def _propose(self, wanted: tuple[float, float] | None, asked: Asked) -> None:
        estimate, excited = self.estimate, self._excited
        assert estimate is not None and excited is not None
        seconds, before = min(asked.seconds, LONGEST_S), self._memory.target

        def work() -> Proposal:
            from app.tuner_maths import first_proposed, proposed
            from device.tuning.design import Target

            then = (excited.period, excited.gains, asked.step, seconds)
            if wanted is not None:
                return proposed(estimate, Target(*wanted), *then)
            return first_proposed(estimate, None if before is None else Target(*before), *then)

        def done(future: Future[Any]) -> None:
            self.designing = False
            if estimate is not self.estimate:
                return
            wanted, self._next = self._next, None
            if wanted is not None:
                self._design(*wanted)
            else:
                self._proposed(future)

        self.designing = True
        self._tick.when_done(in_background(work), done)

    def _proposed(self, future: Future[Any]) -> None:
        failure, model, bode_plot = failure_of(future), self._panel.model, self._panel.bode_plot
        if failure:
            model.show_design(None, None, failure)
            return
        proposal: Proposal = future.result()
        self.proposal = proposal
        assert bode_plot is not None  # the panel was shown, else nobody could have asked
        if proposal.target is not None:
            model.show_target(proposal.target.crossover, proposal.target.phase)
            bode_plot.show_target(proposal.target.crossover, proposal.target.phase)
        bode_plot.show_bode(proposal.bode)
        model.show_usable(True, "" if proposal.gains is not None else UNREACHED)
        model.show_design(proposal.gains, proposal.margins, proposal.words)
        model.show_feeds(self.feeds.words if self.feeds is not None else "")
        if proposal.gains is not None:
            self._panel.manual.gains.show_filter(proposal.gains)
            self._to_draw = 2  # looks: the first one is in this very tick
        else:
            self._panel.show_curves((), None, 10.0)  # what was predicted belongs to another target

    def foresee(self, asked: Asked, then: Callable[[], None]) -> None:
        """Goes on once the predicted step is this one, of this size and with this torque at most."""
        proposal, estimate, excited = self.proposal, self.estimate, self._excited
        if proposal is None or proposal.predicted is None or estimate is None or excited is None:
            return
        if proposal.foresees(asked.step, asked.torque):
            then()
            return

        def work() -> Proposal:
            from app.tuner_maths import again

            return again(estimate, proposal, excited.period, asked.step, asked.torque, min(asked.seconds, LONGEST_S))

        def done(future: Future[Any]) -> None:
            self._ended()
            if proposal is not self.proposal:
                return
            if failure := failure_of(future):
                self._panel.show_result(failure, good=False)
                return
            self.proposal = future.result()
            self._draw_predicted()
            then()

        self._running("Predicting this step…")
        self._tick.when_done(in_background(work), done)

    @property
    def period(self) -> float:
        """Of a sample, in s, as the axis was excited with."""
        return self._excited.period if self._excited is not None else 0.0

    @property
    def feeds(self) -> Feeds | None:
        """FV and FA for the axis that was identified."""
        if self.estimate is None or not self.period:
            return None
        from device.tuning.feed import feeds

        return feeds(self.estimate.plant, self.period)

    @property
    def predicted(self) -> tuple[Curve, ...]:
        """The predicted step, or nothing."""
        from widgets.tuner.plots import Curve

        proposal = self.proposal
        if proposal is None or proposal.predicted is None:
            return ()
        return (Curve(proposal.predicted, "Predicted", predicted=True, quiet=True),)

    def _draw_predicted(self) -> None:
        from device.tuning.metrics import measure

        proposal = self.proposal
        if proposal is None or proposal.predicted is None or proposal.gains is None:
            return
        found = measure(proposal.predicted, proposal.gains.torque_limit)
        metrics = None if isinstance(found, str) else found
        self._panel.show_curves(self.predicted, metrics, proposal.gains.torque_limit)
