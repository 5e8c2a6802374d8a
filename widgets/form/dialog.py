"""The dialog of an instruction: add a new one or change one; never modal, so STOP and all windows stay alive."""

from __future__ import annotations

from collections.abc import Iterator

from PySide6.QtCore import QEvent, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QKeyEvent, QPainter, QPaintEvent, QShowEvent
from PySide6.QtWidgets import (
    QDialog,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from codegen.instructions import Group, Instruction
from widgets.form.buttons import Buttons
from widgets.form.form import InstructionForm
from widgets.form.offers import Offers
from widgets.form.room import keep_on_screen, room, settle
from widgets.parts.foot import foot
from widgets.parts.look import look
from widgets.parts.pieces import Pieces, dressed, in_breaths

LEAST_WIDTH = 560  # px
BAR = 14  # width of a scroll bar, px (theme.toml)
SECTION_WORDS = {"configuration": "Configuration", "main": "Main"}


class SectionButtons(Buttons):
    """Where an instruction goes that may stand in both sections."""

    def __init__(self) -> None:
        super().__init__(list(SECTION_WORDS.items()), several=False)

    def _say(self) -> None:
        self.changed.emit(self.chosen()[0])


class GroupBar(QWidget):
    """The colour of a group of instructions, in the theme that is on now."""

    def __init__(self, group: str) -> None:
        super().__init__()
        self.group = group
        self.setFixedWidth(4)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Fills itself."""
        QPainter(self).fillRect(self.rect(), look().group(self.group))


class InstructionDialog(QDialog):
    """Add / Add and next / Cancel / Help for a new step; Change / Cancel / Help for one that is there."""

    added = Signal(object, str, bool)  # instruction, section ("" = its own), whether the dialog stays open
    changed = Signal(object)
    help_requested = Signal(str)
    mirror_wanted = Signal(str)  # as the form says

    def __init__(
        self,
        instruction: Instruction,
        offers: Offers,
        *,
        new: bool,
        where: str = "",
        section: str = "",
        note: str = "",
        parent: QWidget | None = None,
        at_once: bool = True,
    ) -> None:
        super().__init__(parent)
        self.new = new
        self._fitting = False
        self.setModal(False)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(instruction.title if new else f"Change: {instruction.title}")
        self.setProperty("helpPage", instruction.title)
        self._form = InstructionForm(offers, parent=self)
        self.section = SectionButtons()
        self.section.choose([section or usual_section(instruction)])
        self.note = note_line(note)
        self.buttons = self._buttons()
        self._lay_out(instruction, where)
        self._form.refreshed.connect(self._refresh)
        self._form.mirror_wanted.connect(self.mirror_wanted)
        self._making = Pieces(in_breaths(self._fill(instruction)))
        self._turns = QTimer(self)  # between what else the window has to do
        self._turns.timeout.connect(self.grow)
        self.finished.connect(self._turns.stop)
        if at_once:
            self._making.finish()

    @property
    def form(self) -> InstructionForm:
        """With all its fields: whoever asks for it cannot wait for them."""
        while self._turns.isActive():
            self.grow()
        return self._form

    # ---- making it

    def _fill(self, instruction: Instruction) -> Iterator[None]:
        """In pieces, as a form of many fields takes as long as many turns of the window."""
        yield from self._form.showing(instruction)
        yield from dressed(self)
        self._form.fields.focus_first()

    def show_when_made(self) -> None:
        """In front once all of it is there; until then nothing of it can be seen."""
        self._turns.start(0)

    def grow(self) -> None:
        """The next piece; the last one shows it."""
        if self._making.step():
            self._turns.stop()
            self.show()
            self.raise_()
            self.activateWindow()
            self._form.fields.focus_first()

    # ---- looks

    def _lay_out(self, instruction: Instruction, where: str) -> None:
        title = QLabel(instruction.title)
        title.setProperty("role", "title")
        self.place = QLabel(where)
        self.place.setProperty("role", "quiet")
        about = QLabel(_first_sentence(instruction.help))
        about.setProperty("role", "quiet")
        about.setWordWrap(True)
        words = QVBoxLayout()
        words.setSpacing(2)
        top = QHBoxLayout()
        top.addWidget(title)
        top.addStretch(1)
        top.addWidget(self.place)
        words.addLayout(top)
        words.addWidget(about)
        heading = QHBoxLayout()
        heading.setSpacing(12)
        heading.addWidget(GroupBar(str(instruction.group)))
        heading.addLayout(words, 1)
        self.column = column = QVBoxLayout(self)
        column.setContentsMargins(16, 12, 16, 12)
        column.setSpacing(8)
        column.addLayout(heading)
        if self.new and instruction.section == "C/M":
            column.addLayout(self._section_row())
        column.addWidget(self._form, 1)
        column.addWidget(self.note)
        *adds, away, explains = self.buttons.values()
        column.addWidget(foot(*adds, away=away, explains=explains))
        self._form.area.content_changed.connect(self.fit)

    def _section_row(self) -> QHBoxLayout:
        row = QHBoxLayout()
        label = QLabel("Goes to")
        row.addWidget(label)
        row.addWidget(self.section)
        row.addStretch(1)
        for button in self.section.buttons.values():
            button.setAccessibleName(f"Goes to: {button.text()}")
        return row

    def _buttons(self) -> dict[str, QPushButton]:
        names = ("Add", "Add and next", "Cancel", "Help") if self.new else ("Change", "Cancel", "Help")
        buttons = {name: QPushButton(name) for name in names}
        for button in buttons.values():
            button.setMinimumHeight(look().control)
            button.setAutoDefault(False)
        main = buttons[names[0]]
        main.setProperty("role", "primary")
        main.setDefault(True)
        main.clicked.connect(self._accept)
        if self.new:
            buttons["Add and next"].clicked.connect(lambda: self._add(True))
        buttons["Cancel"].clicked.connect(self.reject)
        buttons["Help"].clicked.connect(lambda: self.help_requested.emit(self.form.instruction.title))
        return buttons

    # ---- size

    def showEvent(self, event: QShowEvent) -> None:
        """Only once it is styled is it known how large it is."""
        self._fit(QSize(LEAST_WIDTH, 0))
        super().showEvent(event)

    def event(self, event: QEvent) -> bool:
        """What stands around the fields may grow too; Ctrl+Enter is the dialog's own, not the program's behind it."""
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent) and _adds(event):
            event.accept()
            return True
        done = super().event(event)
        if event.type() == QEvent.Type.LayoutRequest and self.isVisible():
            self.fit()
        return done

    def fit(self) -> None:
        """Large enough to show everything, as far as the screen allows; never smaller than it is."""
        if self.isVisible() and not self._fitting:
            self._fit(self.size())
            keep_on_screen(self)

    def _fit(self, present: QSize) -> None:
        self._fitting = True
        settle(self)
        limit, sides, area = room(self), self.column.contentsMargins(), self._form.area
        around = sides.left() + sides.right()
        least = max(self.column.minimumSize().width(), area.least_width() + around)
        width = min(max(present.width(), least), limit.width())
        fields = area.height_for(width - around)
        high = self._ask_for_height(fields, width)
        if high > limit.height():
            width = min(max(width, least + BAR), limit.width())
            high = self._ask_for_height(fields - (high - limit.height()), width)
        self.resize(width, max(present.height(), min(high, limit.height())))
        self._fitting = False

    def _ask_for_height(self, height: int, width: int) -> int:
        """Gives the fields a height; the height the whole dialog then has."""
        self._form.ask_for_height(height)
        settle(self)
        return self.column.totalHeightForWidth(width)

    # ---- what happens

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Ctrl+Enter adds from anywhere, also out of a text of several lines."""
        if _adds(event):
            self._accept()
            return
        super().keyPressEvent(event)

    def show_offers(self, offers: Offers) -> None:
        """Follows the document: other units, other names."""
        self.form.show_offers(offers)

    def _refresh(self) -> None:
        problem = self._form.problem()
        for name in ("Add", "Add and next", "Change"):
            if name in self.buttons:
                self.buttons[name].setEnabled(not problem)
                self.buttons[name].setToolTip(problem or "Ctrl+Enter")
                self.buttons[name].setAccessibleDescription(problem)

    def _accept(self) -> None:
        if self.form.problem():
            self.form.fields.focus_first()
        elif self.new:
            self._add(False)
        else:
            self.changed.emit(self.form.instruction)
            self.accept()

    def _add(self, stay: bool) -> None:
        section = self.section.chosen()[0] if self.form.instruction.section == "C/M" else ""
        self.added.emit(self.form.instruction, section, stay)
        if stay:
            self.note.clear()
            self.form.fields.focus_first()
        else:
            self.accept()


def note_line(text: str = "") -> QLineEdit:
    """The person's own comment on a step."""
    line = QLineEdit(text)
    line.setPlaceholderText("Note: why this step is here")
    line.setAccessibleName("Note")
    line.setMinimumHeight(look().control)
    return line


def usual_section(instruction: Instruction) -> str:
    """Where an instruction for either section mostly stands: gains and limits are set before anything moves."""
    return "configuration" if instruction.group in (Group.SERVO, Group.LIMITS) else "main"


def _first_sentence(text: str) -> str:
    line = " ".join(text.split("\n\n")[0].split())
    end = line.find(". ")
    return line if end < 0 else line[: end + 1]


def _adds(event: QKeyEvent) -> bool:
    enter = event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter)
    return enter and bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
