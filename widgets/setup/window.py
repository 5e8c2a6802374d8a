"""The setup of a machine in one window: pages on the left, files above, the controller below."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeVar

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import (
    QDialog,
    QFrame,
    QHBoxLayout,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from codegen.rescale import AXIS_VALUES
from codegen.setup import Setup, setup_problems
from codegen.setup_differences import Key, Readings
from codegen.setup_plate import plate_problem
from device.api import Kind, StopState
from widgets.parts.foot import foot
from widgets.parts.look import look
from widgets.parts.pieces import Pieces, dressed, in_breaths
from widgets.parts.stop_button import StopButton
from widgets.setup.comparing import Comparing
from widgets.setup.pages.axes import AxesPage
from widgets.setup.pages.compare import Choice, ComparePage
from widgets.setup.pages.controller import ControllerPage, serial_problem
from widgets.setup.pages.limits import LimitsPage
from widgets.setup.pages.motors import ServoPage, StepperPage
from widgets.setup.pages.names import NamesPage, NotesPage
from widgets.setup.pages.page import Page, Shown, quiet, say


@dataclass(frozen=True)
class Online:
    """What can be done with a controller now: the reason why not, or nothing."""

    read: str = "Connect a controller or start the simulator first."
    burn: str = "Connect a controller or start the simulator first."
    serial: int | None = None


P = TypeVar("P", bound=Page)
KINDS: tuple[type[Page], ...] = (
    ControllerPage, AxesPage, ServoPage, StepperPage, LimitsPage, NamesPage, NotesPage, ComparePage,
)  # fmt: skip


class SetupWindow(QDialog):
    """Not modal. `finished_setup(setup, keep, keys)`: the person is done; `keys` are the registers to be sent."""

    finished_setup = Signal(object, str, object)
    changed = Signal()
    new_wanted = Signal()
    open_wanted = Signal()
    save_wanted = Signal()
    save_as_wanted = Signal()
    read_wanted = Signal()
    burn_wanted = Signal()

    def __init__(self, setup: Setup, has_content: bool, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setModal(False)
        self.setProperty("helpPage", "Setup")
        self.setup, self._before, self._has_content = setup, setup, has_content
        self.comparing, self._who, self._online = Comparing(), "", Online()
        self._made: dict[type[Page], Page] = {}
        self._growing = Pieces(in_breaths(self._grow()))
        self.list, self.stack = QListWidget(), QStackedWidget()
        self.file, self.problem, self.stop = QLabel(), quiet("warning"), StopButton()
        self.stop.hide()  # until something is connected: what is sent may move it
        self.file_buttons = {
            "New": (QPushButton("New"), self.new_wanted),
            "Open": (QPushButton("Open…"), self.open_wanted),
            "Save": (QPushButton("Save"), self.save_wanted),
            "Save as": (QPushButton("Save as…"), self.save_as_wanted),
        }
        self.read, self.burn = QPushButton("Setup from controller"), QPushButton("Write to EEPROM…")
        self.done_button, self.cancel = QPushButton("Done"), QPushButton("Cancel")
        self.question = self._make_question()
        self._lay_out()
        self._join()
        self.show_file("not saved in a file", False)
        self.show_online(self._online)
        self._show()

    # ---- its pages

    def page(self, kind: type[P]) -> P:
        """A page; made when it is first wanted."""
        found = self._made.get(kind)
        if found is None:
            found = self._made[kind] = kind(self.stack)
            self._place(found, KINDS.index(kind))
            found.edited.connect(self._edited)
            if isinstance(found, ComparePage):
                found.chosen.connect(self._choose)
                found.all_chosen.connect(self._choose_all)
            found.show_setup(self._shown, False)
        assert isinstance(found, kind)
        return found

    def grow(self) -> None:
        """With each tick some of the pages: made all at once the window would stand still, made later a click would."""
        self._growing.step()

    def _grow(self) -> Iterator[None]:
        for kind in KINDS:
            page = self.page(kind)
            yield
            yield from page.filling(self._shown)
            yield from dressed(page)

    @property
    def pages(self) -> tuple[Page, ...]:
        """All of them, in the order of the list."""
        return tuple(self.page(kind) for kind in KINDS)

    @property
    def controller(self) -> ControllerPage:
        return self.page(ControllerPage)

    @property
    def axes(self) -> AxesPage:
        return self.page(AxesPage)

    @property
    def servo(self) -> ServoPage:
        return self.page(ServoPage)

    @property
    def stepper(self) -> StepperPage:
        return self.page(StepperPage)

    @property
    def limits(self) -> LimitsPage:
        return self.page(LimitsPage)

    @property
    def names(self) -> NamesPage:
        return self.page(NamesPage)

    @property
    def notes(self) -> NotesPage:
        return self.page(NotesPage)

    @property
    def compare(self) -> ComparePage:
        return self.page(ComparePage)

    def _place(self, page: Page, row: int) -> None:
        """Instead of what kept its place; the Tab key goes from the list into it."""
        kept, before = self.stack.widget(row), self.list
        self.stack.insertWidget(row, page)
        self.stack.removeWidget(kept)
        kept.deleteLater()
        self.stack.setCurrentIndex(self.list.currentRow())
        for widget in page.findChildren(QWidget):
            if widget.window() is page.window() and widget.focusPolicy() & Qt.FocusPolicy.TabFocus:  # no lists of boxes
                QWidget.setTabOrder(before, widget)
                before = widget

    # ---- what is shown

    def show_file(self, name: str, unsaved: bool) -> None:
        """The file of this setup."""
        title = f"Setup – {name}{'*' if unsaved else ''}"
        if title != self.windowTitle():
            self.setWindowTitle(title)
            self.file.setText(f"{name}{' (changed)' if unsaved else ''}")

    def show_online(self, online: Online) -> None:
        """What a connected controller allows."""
        if online == self._online and self.read.toolTip():
            return
        self._online = online
        for button, reason, words in (
            (self.read, online.read, "Reads what the controller holds and marks what differs; changes nothing there"),
            (self.burn, online.burn, "Keeps in the EEPROM what the controller holds; you are asked before"),
        ):
            button.setEnabled(not reason)
            button.setToolTip(reason or words)
        self._show()

    def show_stop(self, kind: Kind, state: StopState) -> None:
        """What is connected, and what has become of the last stop."""
        self.stop.show_state(kind, state)
        self.stop.setVisible(kind is not Kind.OFFLINE)

    def show_setup(self, setup: Setup) -> None:
        """Another setup, from a file or a new one."""
        self.comparing = self.comparing.edited(self.setup, setup) if self.comparing.readings else self.comparing
        self.setup = setup
        self._show()
        self.changed.emit()

    def show_readings(self, readings: Readings, who: str, turn: bool = True) -> None:
        """What the controller holds was read just now; `turn` to the page that lists what differs."""
        self.comparing, self._who = Comparing.of(self.setup, readings), who
        self._show()
        if turn:
            self.open_page(self.compare)

    def forget_readings(self) -> None:
        """Another controller is connected, or none: what was read says nothing any more."""
        if self.comparing.readings:
            self.comparing, self._who = Comparing(), ""
            self._show()

    def open_page(self, page: Page) -> None:
        """One of the pages in front."""
        self.list.setCurrentRow(KINDS.index(type(page)))

    def problems(self) -> list[str]:
        """What has to be put right before it can be taken over, one sentence each."""
        serial, plate = serial_problem(self.setup.serial_number), plate_problem(self.setup.plate)
        found = [each.message for each in setup_problems(self.setup) if each.severity == "error"]
        return [*(words for words in (serial, plate) if words), *found]

    def rescaled(self) -> str:
        """Letters of the axes whose scale differs from before."""
        return "".join(
            letter for letter in self.setup.letters if self.setup.axis(letter).scale != self._before.axis(letter).scale
        )

    def _limited(self) -> bool:
        """Whether an axis whose scale changed has limits in its unit."""
        axes = [self._before.axis(letter) for letter in self.rescaled()]
        return any(getattr(axis, name).strip() for axis in axes for name in AXIS_VALUES)

    # ---- what a person does

    def _edited(self, setup: Setup) -> None:
        self.show_setup(setup)

    def _turn(self, row: int) -> None:
        """Another page comes to the front."""
        self.page(KINDS[row])
        self._show()
        self.stack.setCurrentIndex(row)

    def _choose(self, key: Key, choice: Choice) -> None:
        self.comparing, self.setup = self.comparing.choose(self.setup, key, choice)
        self._show()
        self.changed.emit()

    def _choose_all(self, choice: Choice) -> None:
        self.comparing, self.setup = self.comparing.choose_all(self.setup, choice)
        self._show()
        self.changed.emit()

    def _finish(self) -> None:
        if self.rescaled() and (self._has_content or self._limited()):
            self._word_question()
            self.question.show()
            self.keep_units.setFocus()
        else:
            self._keep("units")

    def _keep(self, what: str) -> None:
        self.finished_setup.emit(self.setup, what, self.comparing.to_send(self.setup))

    # ---- inside

    @property
    def _shown(self) -> Shown:
        return Shown(self.setup, self.comparing.readings, self._online.serial)

    def _show(self) -> None:
        front = KINDS[self.list.currentRow()]
        for kind, page in self._made.items():
            page.show_setup(self._shown, kind is front)
        if self.comparing.readings and front is ComparePage:
            self.compare.show_rows(self.comparing.rows(self.setup), self.comparing.choices, self._who)
        self._mark_pages()
        found = self.problems()
        more = f" ({len(found) - 1} more)" if len(found) > 1 else ""
        say(self.problem, f"{found[0]}{more}" if found else "")
        self.done_button.setEnabled(not found)
        sends = len(self.comparing.to_send(self.setup))
        tip = f"Takes the setup over and sends {sends} value{'s' * (sends != 1)}" if sends else "Takes the setup over"
        self.done_button.setToolTip(found[0] if found else f"{tip} (one step back with Undo)")
        self.question.hide()

    def _mark_pages(self) -> None:
        """Behind the page of the controller's values: how many differ."""
        count = len(self.comparing.rows(self.setup)) if self.comparing.readings else 0
        item = self.list.item(KINDS.index(ComparePage))
        item.setText(f"{ComparePage.title} ({count})" if count else ComparePage.title)

    def _join(self) -> None:
        self.list.currentRowChanged.connect(self._turn)
        for button, signal in self.file_buttons.values():
            button.clicked.connect(signal)
        self.read.clicked.connect(self.read_wanted)
        self.burn.clicked.connect(self.burn_wanted)
        self.cancel.clicked.connect(self.reject)
        self.done_button.clicked.connect(self._finish)

    def _make_question(self) -> QFrame:
        frame = QFrame()
        frame.setProperty("role", "card")
        self.asks = quiet("")
        self.keep_units, self.keep_counts = QPushButton("Keep the numbers in units"), QPushButton("Keep the counts")
        self.keep_units.clicked.connect(lambda: self._keep("units"))
        self.keep_counts.clicked.connect(lambda: self._keep("counts"))
        buttons = QHBoxLayout()
        buttons.addStretch(1)
        buttons.addWidget(self.keep_counts)
        buttons.addWidget(self.keep_units)
        column = QVBoxLayout(frame)
        column.addWidget(self.asks)
        column.addLayout(buttons)
        frame.hide()
        return frame

    def _word_question(self) -> None:
        """With the units of the first axis whose scale changed."""
        letter = self.rescaled()[0]
        old, new = self._before.axis(letter).symbol, self.setup.axis(letter).symbol
        stays = f"10 {old} stays 10 {new}" if old == new else f"10 {old} becomes 10 {new}"
        what = "the program" if self._has_content else "the limits"
        held = "holds" if self._has_content else "hold"
        self.asks.setText(
            f"The scale has changed and {what} already {held} positions. What should stay the same?\n"
            f"In units: {stays}, other counts are sent. In counts: the machine moves as before, the numbers change."
        )

    def _lay_out(self) -> None:
        self.file.setProperty("role", "quiet")
        self.file.setAccessibleName("Setup file")
        self.done_button.setProperty("role", "primary")
        self.done_button.setDefault(True)
        self.list.setAccessibleName("Pages of the setup")
        self.list.setFixedWidth(176)
        self.list.setStyleSheet("QListWidget::item { padding-left: 8px; }")
        for kind in KINDS:
            item = QListWidgetItem(kind.title)
            item.setSizeHint(QSize(0, look().control + 4))
            self.list.addItem(item)
            self.stack.addWidget(QWidget())  # keeps the place of a page
        self.list.setCurrentRow(0)
        head = QHBoxLayout()
        for button, _ in self.file_buttons.values():
            button.setAutoDefault(False)
            head.addWidget(button)
        head.addSpacing(8)
        head.addWidget(self.file, 1)
        head.addWidget(self.stop)
        middle = QHBoxLayout()
        middle.setSpacing(24)
        middle.addWidget(self.list)
        middle.addWidget(self.stack, 1)
        for button in (self.read, self.burn):
            button.setAutoDefault(False)
        column = QVBoxLayout(self)
        column.setContentsMargins(24, 16, 24, 16)
        column.setSpacing(16)
        column.addLayout(head)
        column.addLayout(middle, 1)
        column.addWidget(self.problem)
        column.addWidget(self.question)
        column.addWidget(foot(self.done_button, away=self.cancel, left=(self.read, self.burn)))
        self.page(KINDS[0])
        self.resize(1080, 740)
