"""The tuner: gains by hand, automatic, model-based; the response beside them; every run in a logbook."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QComboBox,
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from device.api import Kind, State
from widgets.display.readings import unit_of
from widgets.panel import Panel, set_text, show_role
from widgets.parts.pieces import Pieces
from widgets.parts.units import scale_of
from widgets.tuner.asked import Asked, Judged
from widgets.tuner.results import Results

if TYPE_CHECKING:
    from codegen.document import Document
    from codegen.setup import Setup
    from device.api import Row
    from device.tuning.loop import Gains
    from device.tuning.metrics import Metrics
    from widgets.tuner.bode import BodePlot
    from widgets.tuner.pages import AutomaticPage, LogbookPage, ManualPage, ModelPage
    from widgets.tuner.plots import Curve, StepPlot
    from widgets.tuner.step_box import StepBox

OFFLINE = "Nothing is connected. Connect a controller or start the simulator to tune an axis."
WATCHED = "This is Watch: switch to Control to tune."
PAGES = ("Manual", "Automatic", "Model", "Logbook")
MANUAL, AUTOMATIC, MODEL, LOGBOOK = range(4)
STARTS = ("Start step", "Start automatic tuning", "Identify the axis", "")
WIDE = 760  # px; narrower and the diagrams go below
LEFT = 450  # px of the controls where there is room
LOWEST = 300  # px of the diagrams below the controls; the Bode plot needs as much again


class TunerPanel(Panel):
    """Asks by signals; whoever joins it to the controller shows what came of it."""

    title = "Tuner"
    moves = True
    axis_chosen = Signal(str)
    start_wanted = Signal(int, object)  # page, Asked
    cancel_wanted = Signal()
    use_wanted = Signal(str, object)  # axis, gains
    burn_wanted = Signal(str, object)
    save_wanted = Signal()
    zero_wanted = Signal()
    target_wanted = Signal(float, float)  # rad/s, degrees
    predicted_wanted = Signal(object)  # Asked: the step with the proposed gains
    moves_wanted = Signal(object)  # Asked: moves without and with the feed-forwards
    page_opened = Signal(int)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._setup: Setup | None = None
        self._fitted: tuple[object, str] | None = None
        self._begun = self._made = False
        self.judge: Callable[[Asked], Judged] = lambda asked: Judged("")
        self.running = ""  # what is under way, in words
        self.empty, self.result, self.results = QLabel(OFFLINE), QLabel(), Results()
        self.axes, self.pages, self.page = QComboBox(), QWidget(), MANUAL
        self.buttons = [QPushButton(name) for name in PAGES]
        self.use, self.burn = QPushButton("Use these gains"), QPushButton("Save PID gains…")
        for each in (self.use, self.burn):
            each.setEnabled(False)  # until it is known whether they may
        self.manual: ManualPage
        self.automatic: AutomaticPage
        self.model: ModelPage
        self.logbook: LogbookPage
        self.box: StepBox
        self._lay_out()

    # ---- what it shows

    def show_controller(self) -> None:
        self._fit()

    def show_document(self, old: Document | None, new: Document) -> None:
        if old is None or old.setup is not new.setup:
            self._setup = new.working_setup
            self._fit()

    def watches(self) -> tuple[str, ...]:
        return (f"commanded.{self.axis.lower()}",) if self._made else ()

    @property
    def axis(self) -> str:
        """The axis that is tuned."""
        return self.axes.currentText() or "X"

    @property
    def step_plot(self) -> StepPlot | None:
        return self.results.step_plot

    @property
    def bode_plot(self) -> BodePlot | None:
        return self.results.bode_plot

    @property
    def reason(self) -> str:
        """Why nothing may be tuned now, or nothing."""
        return self.no_control(OFFLINE, WATCHED)

    @property
    def asked(self) -> Asked:
        """What would be started now."""
        box = self.box
        return Asked(self.axis, box.counts, self.manual.gains.gains, box.torque, box.record_s, box.drive.currentData())

    @property
    def problem(self) -> str:
        """What is wrong with the fields, or nothing."""
        return self.box.problem or (self.manual.gains.problem if self.page == MANUAL else "")

    def refresh(self, row: Row) -> None:
        self._fit()
        if self._made:
            self._show_usable()
            if not self._side.updatesEnabled():
                self._side.setUpdatesEnabled(True)
                self.results.appear()

    def show_present(self, gains: Gains | None, dual: bool = False) -> None:
        """What the controller holds of the axis."""
        self.manual.gains.show_there(gains)
        self.automatic.show_loop(dual)

    def show_result(self, sentence: str, good: bool = True) -> None:
        """How the last run ended, or what is under way."""
        set_text(self.result, sentence)
        show_role(self.result, "quiet" if good else "problem")

    def show_running(self, words: str) -> None:
        """A run is under way (nothing: it has ended)."""
        self.running = words
        self._show_usable()

    def show_curves(self, curves: Sequence[Curve], metrics: Metrics | None, torque_limit: float) -> None:
        """Responses over each other, the last one in front with its numbers."""
        self.results.show_curves(curves, metrics, torque_limit)

    # ---- inside

    def _show_usable(self) -> None:
        problem = self.problem
        judged = Judged("", problem) if problem else self.judge(self.asked)
        running = bool(self.running)
        self.box.show_judged(judged, self.reason, running, STARTS[self.page])
        why = self.reason or self.running or self.manual.gains.problem
        for button, tip in ((self.use, "Sets KP KI KD FV FA in the controller; nothing is burned"),
                            (self.burn, "Sets the gains and writes them into the EEPROM, after asking")):  # fmt: skip
            button.setEnabled(not why)
            button.setToolTip(why or tip)
        self.axes.setEnabled(not running)
        step_problem = self.reason or self.running or judged.problem
        free = "" if self.box.free.isChecked() else "Look whether the way is free first."
        self.model.show_runnable(step_problem or free)

    def _fit(self) -> None:
        """Axes and units of the machine that is connected; made when first shown."""
        controller, setup = self.controller, self._setup
        linked = controller is not None and controller.kind is not Kind.OFFLINE and setup is not None
        if self.empty.isVisibleTo(self) == linked:
            self.empty.setVisible(not linked)
            self._area.setVisible(linked)
        if not linked or not self.isVisible() or setup is None or controller is None:
            return
        if not self._begun:
            self._begun, self.making = True, Pieces(self._make())
        if not self._made:
            return
        letters = controller.axes or (setup.letters if controller.state is State.READY else "")
        if letters and (setup, letters) != self._fitted:
            self._fitted = (setup, letters)
            self.axes.blockSignals(True)
            before = self.axis
            self.axes.clear()
            self.axes.addItems(list(letters))
            self.axes.setCurrentText(before if before in letters else letters[0])
            self.axes.blockSignals(False)
            self._axis_chosen()

    def _axis_chosen(self) -> None:
        assert self._setup is not None
        self.box.show_axis(self._setup, self.axis)
        axis = self._setup.axis(self.axis)
        if self.step_plot is not None:
            self.step_plot.show_scale(scale_of(axis), unit_of(axis), self.axis)
        self.axis_chosen.emit(self.axis)

    def open_page(self, index: int) -> None:
        """One of the four."""
        self.page = index
        for number, page in enumerate((self.manual, self.automatic, self.model, self.logbook)):
            page.setVisible(number == index)
        for number, button in enumerate(self.buttons):
            button.setChecked(number == index)
        for part in (self.box, self.box.fields):
            part.setVisible(index != LOGBOOK)
        for part in (self.box.drive, self.box.drive_label):
            part.setVisible(index == AUTOMATIC)
        self.results.show_bode(index == MODEL)
        self._turn()
        self._show_usable()
        self.page_opened.emit(index)

    def _start(self) -> None:
        if not self.problem and not self.reason and not self.running:
            self.start_wanted.emit(self.page, self.asked)

    def _lay_out(self) -> None:
        outer = QVBoxLayout(self)
        outer.setContentsMargins(8, 4, 8, 4)
        self.empty.setWordWrap(True)
        self.empty.setProperty("role", "quiet")
        outer.addWidget(self.empty)
        self._area = QWidget()
        self._area.hide()
        outer.addWidget(self._area, 1)
        outer.addStretch(0)

    def _make(self) -> Iterator[None]:
        """Everything that needs pyqtgraph, with the first look at it: a piece with each tick, so that nothing waits.

        From the outside inwards: what gets another parent is dressed anew with all that is in it.
        """
        from widgets.tuner.pages import AutomaticPage, LogbookPage, ManualPage, ModelPage
        from widgets.tuner.step_box import StepBox

        self._frame()
        yield
        self.box = StepBox(self._side, self._column.parentWidget())
        self._side_column.insertWidget(1, self.box)
        self._column.insertWidget(0, self.box.fields)
        yield
        self._fill_column()
        yield
        self.manual = ManualPage(self.pages)
        self._pages.addWidget(self.manual)
        yield
        self.automatic, self.model = AutomaticPage(self.pages), ModelPage(self.pages)
        yield
        self.logbook = LogbookPage(self.pages)
        for page in (self.automatic, self.model, self.logbook):
            page.hide()
            self._pages.addWidget(page)
        self._turn()
        yield
        yield from self.results.pieces()
        self._connect()
        yield
        self._made = True
        self.open_page(MANUAL)

    def _connect(self) -> None:
        from device.tuning.loop import FACTORY

        assert self.bode_plot is not None
        box, manual, model = self.box, self.manual, self.model
        self.axes.currentTextChanged.connect(lambda _text: self._axis_chosen())
        for edited in (box.edited, manual.gains.edited):
            edited.connect(self._show_usable)
        box.start.connect(self._start)
        box.cancel.connect(self.cancel_wanted)
        manual.defaults.clicked.connect(lambda: manual.gains.show_gains(FACTORY))
        self.use.clicked.connect(lambda: self.use_wanted.emit(self.axis, manual.gains.gains))
        self.burn.clicked.connect(lambda: self.burn_wanted.emit(self.axis, manual.gains.gains))
        self.results.save_wanted.connect(self.save_wanted)
        self.results.zero_wanted.connect(self.zero_wanted)
        model.target_wanted.connect(self.target_wanted)
        self.bode_plot.target_wanted.connect(self.target_wanted)
        model.run_wanted.connect(lambda: self.predicted_wanted.emit(self.asked))
        model.moves_wanted.connect(lambda: self.moves_wanted.emit(self.asked))

    def _frame(self) -> None:
        """All may scroll but what starts and ends a run, and how it ended."""
        self._sides = QHBoxLayout(self._area)
        self._sides.setContentsMargins(0, 0, 0, 0)
        self._side = QWidget(self._area)
        self._sides.addWidget(self._side)
        column = self._side_column = QVBoxLayout(self._side)
        column.setContentsMargins(0, 0, 8, 0)
        column.setSpacing(6)
        self._scroll = QScrollArea(self._side)
        self._scroll.setWidgetResizable(True)
        self._scroll.setFrameShape(QFrame.Shape.NoFrame)
        self._scroll.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        left = QWidget(self._scroll.viewport())
        self._column = QVBoxLayout(left)
        self._column.setContentsMargins(0, 0, 8, 0)
        self._column.setSpacing(8)
        self._column.addStretch(1)
        self._scroll.setWidget(left)
        column.addWidget(self._scroll, 1)
        self.result.setWordWrap(True)
        self.result.setProperty("role", "quiet")
        self.result.setAccessibleName("Result")
        column.addWidget(self.result)
        for part in (self._side, self.results):  # shown when it is whole
            part.setUpdatesEnabled(False)

    def _fill_column(self) -> None:
        """Axis and pages above, what is done with the gains below them."""
        self._column.insertLayout(0, self._top())
        gains = QVBoxLayout()
        gains.setSpacing(8)
        self._pages = QVBoxLayout(self.pages)
        self._pages.setContentsMargins(0, 0, 0, 0)
        gains.addWidget(self.pages)
        row = QHBoxLayout()
        row.addWidget(self.use)
        row.addWidget(self.burn)
        row.addStretch(1)
        gains.addLayout(row)
        self._column.insertLayout(1, gains)
        self._turn()

    def _top(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(4)
        self.axes.setAccessibleName("Axis to tune")
        self.axes.setToolTip("Axis to tune")
        self.axes.setMaximumWidth(64)
        self._axis_label = QLabel("Axis", self._side)
        row.addWidget(self._axis_label)
        row.addWidget(self.axes)
        row.addSpacing(4)
        for index, button in enumerate(self.buttons):
            button.setCheckable(True)
            button.setProperty("role", "segment")
            button.clicked.connect(lambda _=False, index=index: self.open_page(index))
            row.addWidget(button)
        row.addStretch(1)
        return row

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if self._made:
            self._turn()

    def _turn(self) -> None:
        """Diagrams beside the controls where there is room, else below them and scrolled with them."""
        wide = self.width() >= WIDE
        if wide and self._sides.count() == 1:
            self._column.removeWidget(self.results)
            self._sides.addWidget(self.results, 1)
        elif not wide and self._column.indexOf(self.results) < 0:
            self._sides.removeWidget(self.results)
            self._column.insertWidget(self._column.count() - 1, self.results)
        self._axis_label.setVisible(wide)
        policy = Qt.ScrollBarPolicy
        self._scroll.setHorizontalScrollBarPolicy(policy.ScrollBarAlwaysOff if wide else policy.ScrollBarAsNeeded)
        self.results.setMinimumHeight(0 if wide else LOWEST * (2 if self.page == MODEL else 1))
        needed = self._scroll.widget().minimumSizeHint().width() + self._scroll.verticalScrollBar().width()
        left = max(LEFT, needed + 12)
        self._side.setMaximumWidth(left + 24 if wide else 16_777_215)
        self._side.setMinimumWidth(left + 24 if wide else 0)
