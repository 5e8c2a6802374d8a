"""The program window: name and description, the program in English beside its code, and everything done to it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from PySide6.QtCore import QDate, QPoint, Qt, Signal
from PySide6.QtWidgets import QApplication, QMenu, QSplitter, QVBoxLayout, QWidget

from codegen.document import Document
from codegen.generate import Listing
from codegen.instructions import Comment
from codegen.program import Section, Step, find
from widgets.form.inspector import Inspector
from widgets.form.offers import LiveValues, offers_of
from widgets.program.arranging import Arranging
from widgets.program.code_popup import CodePopup
from widgets.program.commands import COMMANDS, make_actions
from widgets.program.delegate import ProgramDelegate
from widgets.program.dialogs import Dialogs
from widgets.program.find_bar import FindBar
from widgets.program.finding import Finding
from widgets.program.header import Header
from widgets.program.insertion_bar import InsertionBar, next_place
from widgets.program.model import ProgramModel
from widgets.program.node import TITLES
from widgets.program.palette import Palette
from widgets.program.possible import reason_of, show_possible
from widgets.program.problems import ProblemsPanel
from widgets.program.running import Running
from widgets.program.tree import ProgramTree
from widgets.program.words import Words
from widgets.source.view import CodeView

if TYPE_CHECKING:
    from widgets.program.editing import Editing

MODES = ("program", "both", "code")


class ProgramView(QWidget):
    """Centre of the main window. Owns palette, problems and inspector too; whoever shows the window docks them."""

    said = Signal(str)
    help_requested = Signal(str)
    selection_changed = Signal()
    mode_changed = Signal(str)

    def __init__(self, session: Editing, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.session = session
        self.setAccessibleName("Program window")
        self.setProperty("helpPage", "Program window")
        self.words = Words()
        self.model = ProgramModel(self.words, self)
        self.delegate = ProgramDelegate(self.model)
        self.tree = ProgramTree(self.model, self.delegate)
        self.code = CodeView()
        self.header = Header()
        self.bar = InsertionBar()
        self.instructions = Palette()
        self.problems = ProblemsPanel()
        self.inspector = Inspector(offers_of(session.document))
        self.dialogs = Dialogs(self, session)
        self.live: LiveValues | None = None  # reads values for expressions
        self.run = Running(session, self.words, self.tree, self.delegate, self.code)
        self.find_bar = FindBar()
        self.finding = Finding(session, self.words, self.tree, self.delegate, self.find_bar)
        self.arranging = Arranging(session, self.model, self.tree, self.words)
        self.mode = "program"
        self._stepping = self._showing = False
        self.commands = make_actions(self)
        self._lay_out()
        self._connect()
        self.set_view("program")
        self.show_document(None, session.document)
        self.tree.choose(["main"])

    # ---- showing

    def show_document(self, old: Document | None, new: Document) -> None:
        """Brings everything from `old` to `new`; what did not change is not touched."""
        listing = self.session.listing
        with self.tree.changing():
            self.words.show(new, listing)
            self._showing = True  # rows come and go: the selection is told once, at the end
            self.model.show(new)
            self._showing = False
            self.delegate.show_marks()
            self.finding.follow()
            self._show_insertion()
        self._show_code()
        self.header.show_program(new.program, _label(listing))
        self.problems.show_problems(new, listing)
        if self.dialogs.open:
            self.dialogs.show_offers(offers_of(new, self.live))
        if old is None or old.setup != new.setup:
            self.instructions.show_setup(new.working_setup)
        self._show_selection(scroll=False)

    def _show_code(self) -> None:
        """While the listing is out of sight it follows nothing."""
        if self.mode != "program":
            listing = self.session.listing
            self.code.show_lines([line.text for line in listing.lines], self.words.problem_lines())

    @property
    def running(self) -> Listing | None:
        """What was downloaded and runs; None while that is not known."""
        return self.run.listing

    @running.setter
    def running(self, listing: Listing | None) -> None:
        self.run.listing = listing

    def show_executing(self, threads: Mapping[int, int | None]) -> None:
        """Marks the line each thread stands on (line of what was downloaded; None: the thread does not run)."""
        self.run.show_executing(threads)

    def show_error(self, line: int, text: str) -> None:
        """Opens the program on the instruction the controller stopped at."""
        listing = self.run.present()
        step = listing.step_of(line) if 0 <= line < len(listing.lines) else ""
        self.delegate.error = (step, text)
        self.code.show_error(line)
        self.reveal_step(step)
        self.tree.viewport().update()
        self.said.emit(f"Line {line}: {text}")

    def clear_error(self) -> None:
        """The error has been seen."""
        self.delegate.error = None
        self.code.show_error(None)
        self.tree.viewport().update()

    def reveal_step(self, step_id: str) -> None:
        """Selects a step and brings it into view."""
        if self.mode == "code":
            self.set_view("both")
        self.tree.choose([step_id])

    def reveal_line(self, line: int) -> None:
        """Selects the step a line of code belongs to."""
        self.reveal_step(self.session.listing.step_of(line))

    def current_step(self) -> str | None:
        """Id of the step with the focus frame."""
        return self.tree.current()

    def set_view(self, mode: str) -> None:
        """`program`: English beside its code; `both`: English and the listing; `code`: the listing."""
        if mode == "both" and self.mode != "both":
            self.splitter.setSizes([3 * self.width() // 5, 2 * self.width() // 5])
        self.mode = mode
        self.tree.setVisible(mode != "code")
        self.bar.setVisible(mode != "code" and bool(self.bar.text.text()))
        self.code.setVisible(mode != "program")
        self._show_code()
        self.tree.show_code_column(mode == "program")
        self.header.show_mode(mode)
        (self.code if mode == "code" else self.tree).setFocus()
        self.mode_changed.emit(mode)

    # ---- what can be done now

    def can(self, name: str) -> str | None:
        """None when the command is possible now, else the reason in words."""
        return reason_of(name, self.session, self.tree, self.tree.chosen())

    def refresh_commands(self) -> None:
        """Greys what is not possible now and says why."""
        show_possible(self.commands, self.session, self.tree)

    def step(self, step_id: str) -> Step:
        """A step of the document."""
        return find(self.session.document.program, step_id)

    # ---- commands

    def undo(self) -> None:
        label = self.session.undo_text
        self.session.undo()
        self.said.emit(f"Undone: {label}")

    def redo(self) -> None:
        label = self.session.redo_text
        self.session.redo()
        self.said.emit(f"Done again: {label}")

    def modify(self) -> None:
        step_id = self.tree.current() or next(iter(self.tree.chosen()), None)
        if step_id is not None:
            self.dialogs.modify(step_id)

    def insert(self) -> None:
        self.session.insert_before(self.tree.current())
        self.find()

    insert_before = insert

    def comment(self) -> None:
        self.dialogs.add(Comment, before=self.tree.current())

    insert_comment = comment

    def comment_out(self) -> None:
        self.session.comment_out(self.tree.chosen())

    def view_code(self) -> None:
        for step_id in self.tree.chosen()[:1]:
            CodePopup(self.words, self.step(step_id), self).show()

    def cut(self) -> None:
        self.copy()
        self.delete()

    def copy(self) -> None:
        self.arranging.copy()
        self.refresh_commands()

    def paste(self) -> None:
        self.arranging.paste_clipboard()

    def duplicate(self) -> None:
        self.arranging.duplicate()

    def delete(self) -> None:
        self.arranging.delete()

    def move_up(self) -> None:
        self.arranging.shift(-1)

    def move_down(self) -> None:
        self.arranging.shift(1)

    def fold_all(self) -> None:
        self.tree.fold_all(True)

    def unfold_all(self) -> None:
        self.tree.fold_all(False)

    def end_of_repeat(self) -> None:
        if self.session.before is not None:
            self.session.insert_before(None)
        else:
            self.session.leave_body()

    def find_text(self) -> None:
        self.finding.open(replacing=False)

    def replace_text(self) -> None:
        self.finding.open(replacing=True)

    def find_next(self) -> None:
        self.finding.go(1)

    def find_previous(self) -> None:
        self.finding.go(-1)

    def find(self) -> None:
        self.instructions.focus_search()

    def trace(self) -> None:
        self.run.trace()

    def program_status(self) -> None:
        self.run.show_status()

    def print_program(self) -> None:
        self._print("Print program")

    def print_code(self) -> None:
        self._print("Print code")

    def _print(self, title: str) -> None:
        from widgets.program.printing import PrintPreview, code_pages, program_pages  # late: few print, all start

        document, date = self.session.document, QDate.currentDate().toString(Qt.DateFormat.ISODate)
        code = title == "Print code"
        pages = code_pages(document, self.words, date) if code else program_pages(document, self.words, date)
        self.preview = PrintPreview(title, pages, document.program.name, self.window())
        self.preview.said.connect(self.said)
        self.preview.show()

    def mode_program(self) -> None:
        self.set_view("program")

    def mode_both(self) -> None:
        self.set_view("both")

    def mode_code(self) -> None:
        self.set_view("code")

    # ---- inside

    def _show_selection(self, *, scroll: bool = True) -> None:
        chosen = self.tree.chosen()
        self.code.show_chosen([line for step_id in chosen for line in self.words.lines_of(step_id)], scroll=scroll)
        one = self.step(chosen[0]) if len(chosen) == 1 else None
        if one is None or not self.inspector.isVisible():
            self.inspector.show_nothing()
        else:
            self.inspector.show_step(one, offers_of(self.session.document, self.live))

    def _selection_changed(self) -> None:
        if self._showing:
            return
        self._show_selection(scroll=not self._stepping)
        current = self.tree.current()
        self.tree.setProperty("helpPage", self.step(current).instruction.title if current else "Program window")
        self.refresh_commands()
        self.selection_changed.emit()

    def _code_line(self, line: int) -> None:
        self._stepping = True
        step = self.session.listing.step_of(line)
        if step:
            self.tree.choose([step])
        self._stepping = False

    def _folded(self) -> None:
        self.delegate.show_marks()
        self.tree.viewport().update()

    def _show_insertion(self) -> None:
        words, place = next_place(self.session, self.model, self.words)
        self.bar.show_text(words)
        self.bar.setVisible(self.mode != "code" and bool(words))
        if place != self.delegate.next_place:
            self.delegate.next_place = place
            self.tree.viewport().update()
        self.refresh_commands()

    def _menu(self, point: QPoint) -> None:
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for row in COMMANDS:
            if row.in_menu:
                menu.addAction(self.commands[row.name])
            if row.name in ("view_code", "delete"):
                menu.addSeparator()
        menu.popup(self.tree.viewport().mapToGlobal(point))

    def _connect(self) -> None:
        session, tree = self.session, self.tree
        session.document_changed.connect(self.show_document)
        session.history_changed.connect(self.refresh_commands)
        self.inspector.became_visible.connect(lambda: self._show_selection(scroll=False))
        session.insertion_changed.connect(self._show_insertion)
        self.model.copy_text = session.copy
        self.model.folded.connect(self._folded)
        self.arranging.said.connect(self.said)
        self.finding.said.connect(self.said)
        self.run.step_wanted.connect(self.reveal_step)
        self.arranging.new_wanted.connect(lambda kind, place: self.dialogs.add(kind, place=place))
        tree.modify_wanted.connect(self.dialogs.modify)
        tree.chosen_changed.connect(self._selection_changed)
        tree.customContextMenuRequested.connect(self._menu)
        self.code.line_chosen.connect(self._code_line)
        self.header.named.connect(lambda name: session.set_program(name=name))
        self.header.described.connect(lambda text: session.set_program(description=text))
        self.header.mode_chosen.connect(self.set_view)
        self.bar.left.connect(self.end_of_repeat)
        self.instructions.chosen.connect(self.dialogs.add_possible)
        self.problems.chosen.connect(self.reveal_step)
        self.inspector.edited.connect(session.replace)
        self.inspector.noted.connect(session.set_note)
        self.dialogs.said.connect(self.said)
        self.dialogs.help_requested.connect(self.help_requested)
        QApplication.clipboard().dataChanged.connect(self.refresh_commands)

    def _lay_out(self) -> None:
        self.tree.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        context = Qt.ShortcutContext
        for row in COMMANDS:
            action = self.commands[row.name]
            action.setShortcutContext(context.WidgetShortcut if row.in_menu else context.WindowShortcut)
            (self.tree if row.in_menu else self).addAction(action)
        self.splitter = QSplitter()
        self.splitter.setChildrenCollapsible(False)
        self.splitter.addWidget(self.tree)
        self.splitter.addWidget(self.code)
        self.splitter.setStretchFactor(0, 3)
        self.splitter.setStretchFactor(1, 2)
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 8, 8, 8)
        column.setSpacing(8)
        for widget in (self.header, self.find_bar, self.run.bar, self.bar, self.splitter):
            column.addWidget(widget)
        column.setStretchFactor(self.splitter, 1)
        self.setAccessibleDescription(f"Sections {', '.join(TITLES[section.value] for section in Section)}")


def _label(listing: Listing) -> str:
    """The label the program has in its code: the first of its frame that is not #AUTO."""
    texts = (text for line in listing.lines[:2] for text in line.text.split(";"))
    return next((text for text in texts if text.startswith("#") and text != "#AUTO"), "")
