"""The window: steps on the left, the present one on the right, STOP above, all that moves inside the border."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from device.api import Kind, StopState
from widgets.commissioning.page import Entry, Page
from widgets.commissioning.page_view import PageView
from widgets.commissioning.steps_list import StepsList
from widgets.panel import set_text
from widgets.parts.foot import foot
from widgets.parts.kind import KindFrame
from widgets.parts.stop_button import StopButton

TITLE = "Bring an axis to life"
ROOM = 720  # px: four readings beside each other


class CommissioningWindow(QDialog):
    """Never modal; it is told what to show, and decides nothing."""

    axis_chosen = Signal(str)
    sine_chosen = Signal(bool)
    step_chosen = Signal(int)
    typed = Signal(str, str)
    ticked = Signal(str, bool)
    pressed = Signal(str)  # the name of a button of the page
    skip_wanted = Signal()
    again_wanted = Signal()
    report_wanted = Signal()
    help_wanted = Signal(str)
    left = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(TITLE)
        self.setProperty("helpPage", TITLE)
        self.setModal(False)
        self.axis, self.sine = QComboBox(), QCheckBox("The controller commutates this motor (sine)")
        self.who, self.stop = QLabel(), StopButton()
        self.steps, self.page, self.frame = StepsList(), PageView(), KindFrame()
        self.back, self.next = QPushButton("Back"), QPushButton("Next")
        self.skip, self.again = QPushButton("Skip this step"), QPushButton("Start again…")
        self.report, self.close_ = QPushButton("Report…"), QPushButton("Close")
        self._area, self._key, self._said = QScrollArea(), "", ""
        self._lay_out()
        self._join()

    def show_machine(self, axes: str, axis: str, who: str, sine: bool | None) -> None:
        """Which axes there are; `sine` None where the controller cannot commutate."""
        if [self.axis.itemText(row) for row in range(self.axis.count())] != list(axes):
            self.axis.blockSignals(True)
            self.axis.clear()
            self.axis.addItems(list(axes))
            self.axis.blockSignals(False)
        if axis != self.axis.currentText():
            self.axis.blockSignals(True)
            self.axis.setCurrentText(axis)
            self.axis.blockSignals(False)
        set_text(self.who, who)
        self.sine.setVisible(sine is not None)
        if sine is not None and sine != self.sine.isChecked():
            self.sine.blockSignals(True)
            self.sine.setChecked(sine)
            self.sine.blockSignals(False)

    def show_steps(self, entries: Sequence[Entry], current: int, optional: bool, any_found: bool) -> None:
        """The list, and which of the buttons below are possible."""
        self.steps.show_entries(entries, current)
        for button, possible in (
            (self.back, current > 0),
            (self.next, current < len(entries) - 1),
            (self.skip, optional),
            (self.again, any_found),
            (self.report, any_found),
        ):
            if button.isEnabled() != possible:
                button.setEnabled(possible)

    def show_page(self, page: Page) -> None:
        """The present step; a new one is shown from its beginning."""
        another, said = page.key != self._key, page.sentence != self._said
        self._key, self._said = page.key, page.sentence
        self.page.show_page(page)
        if another:
            self._area.verticalScrollBar().setValue(0)
        elif said and page.sentence:
            QTimer.singleShot(0, self, lambda: self._area.ensureWidgetVisible(self.page.result))  # once laid out

    def show_stop(self, kind: Kind, state: StopState) -> None:
        """What is connected, and what has become of the last stop."""
        self.stop.show_state(kind, state)
        self.frame.show_kind(kind)

    def words(self) -> str:
        """The result that is shown, as text."""
        result = self.page.result
        return f"{result.word.text()}: {result.sentence.text()}" if result.isVisibleTo(self) else ""

    # ---- inside

    def _join(self) -> None:
        self.axis.currentTextChanged.connect(self.axis_chosen)
        self.sine.toggled.connect(self.sine_chosen)
        self.steps.currentRowChanged.connect(self.step_chosen)
        self.page.typed.connect(self.typed)
        self.page.ticked.connect(self.ticked)
        self.page.pressed.connect(self.pressed)
        self.page.help_wanted.connect(self.help_wanted)
        self.back.clicked.connect(lambda: self.step_chosen.emit(self.steps.currentRow() - 1))
        self.next.clicked.connect(lambda: self.step_chosen.emit(self.steps.currentRow() + 1))
        self.skip.clicked.connect(self.skip_wanted)
        self.again.clicked.connect(self.again_wanted)
        self.report.clicked.connect(self.report_wanted)
        self.close_.clicked.connect(self.reject)
        self.finished.connect(lambda _: self.left.emit())

    def _lay_out(self) -> None:
        self.axis.setAccessibleName("Axis")
        self.axis.setFixedWidth(72)
        self.who.setProperty("role", "quiet")
        label = QLabel("Axis")
        label.setBuddy(self.axis)
        choice = QHBoxLayout()
        choice.setSpacing(8)
        for widget in (label, self.axis, self.sine):
            choice.addWidget(widget)
        choice.addStretch(1)
        names = QVBoxLayout()
        names.addLayout(choice)
        names.addWidget(self.who)
        head = QHBoxLayout()
        head.addLayout(names, 1)
        head.addWidget(self.stop)
        self._area.setWidgetResizable(True)
        self._area.setMinimumWidth(ROOM)
        self._area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._area.setFrameShape(QFrame.Shape.NoFrame)
        self._area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._area.setWidget(self.page)
        inside = QHBoxLayout(self.frame)
        inside.setContentsMargins(8, 8, 8, 8)
        inside.setSpacing(0)
        inside.addWidget(self.steps)
        inside.addWidget(self._area, 1)
        for button in (self.again, self.report, self.skip, self.back, self.next, self.close_):
            button.setAutoDefault(False)
        column = QVBoxLayout(self)
        column.setContentsMargins(24, 16, 24, 16)
        column.setSpacing(12)
        column.addLayout(head)
        column.addWidget(self.frame, 1)
        column.addWidget(foot(None, self.skip, self.back, self.next, away=self.close_, left=(self.again, self.report)))
        self.resize(1120, min(870, self.screen().availableSize().height()))
