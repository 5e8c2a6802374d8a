"""An instruction as a form: its fields, a live picture where there is one, the sentence and the code it will add."""

from __future__ import annotations

from collections.abc import Iterator

from PySide6.QtCore import QEvent, QObject, QSize, Qt, Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QScrollArea, QVBoxLayout, QWidget

from codegen import read
from codegen.generate import code, compiled
from codegen.instructions import Instruction
from widgets.form.cell import focus_in
from widgets.form.command_list import CommandList
from widgets.form.curve_picture import CurvePicture
from widgets.form.fields_form import FieldsForm
from widgets.form.grid_editor import GridEditor
from widgets.form.offers import Offers
from widgets.form.path_picture import PathPicture
from widgets.form.pictures import PICTURES
from widgets.form.preview import Preview
from widgets.form.rows import RowsEditor

LEAST = 48  # height below which fields are not pressed together, px


class FieldsArea(QScrollArea):
    """Room for the fields; says when they need another size."""

    content_changed = Signal()

    def __init__(self, inside: QWidget) -> None:
        super().__init__()
        self.inside = inside
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAsNeeded)
        self.setWidget(inside)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Fields came, went, or say more than before."""
        done = super().eventFilter(watched, event)
        if event.type() == QEvent.Type.LayoutRequest:
            self.content_changed.emit()
        return done

    def sizeHint(self) -> QSize:
        """Not more than was asked for."""
        return self.minimumSize() if self.minimumHeight() else super().sizeHint()

    def minimumSizeHint(self) -> QSize:
        """As little."""
        return self.minimumSize() if self.minimumHeight() else super().minimumSizeHint()

    def least_width(self) -> int:
        """Narrower, something would be cut."""
        return self.inside.minimumSizeHint().width()

    def scrolls(self) -> bool:
        """Whether a part of the fields is out of sight."""
        return self.inside.height() > self.viewport().height() or self.inside.width() > self.viewport().width()

    def height_for(self, width: int) -> int:
        """How high all fields are at a width."""
        layout = self.inside.layout()
        wrapped = layout.totalHeightForWidth(width) if layout is not None and layout.hasHeightForWidth() else 0
        return max(wrapped, self.inside.minimumSizeHint().height())

    def ask_for(self, size: QSize) -> None:
        """Nothing scrolls from this size on."""
        if size != self.minimumSize():
            self.setMinimumSize(size)


class InstructionForm(QWidget):
    """Emits the edited instruction; `problem` says why it is not right yet."""

    edited = Signal(object)
    refreshed = Signal()  # whatever is shown now, problems and all
    mirror_wanted = Signal(str)  # the axis that pictures of paths are to show the other way round

    def __init__(self, offers: Offers, *, grows: bool = True, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.offers = offers
        self.grows = grows  # whether the window is to make room for all fields
        self.fields = FieldsForm(offers, narrow=not grows)
        self.fields.edited.connect(self._edited)
        self.preview = Preview()
        self.nothing = QLabel("This instruction has nothing to set.")
        self.nothing.setProperty("role", "quiet")
        self.picture: QWidget | None = None
        self._beside = QHBoxLayout()
        self._beside.setSpacing(16)
        self._beside.addWidget(self.fields, 1)
        inside = QWidget()
        column = QVBoxLayout(inside)
        column.setContentsMargins(2, 0, 2, 0)
        column.addWidget(self.nothing)
        column.addLayout(self._beside)
        column.addStretch(1)
        self.area = FieldsArea(inside)
        whole = QVBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.setSpacing(8)
        whole.addWidget(self.area, 1)
        whole.addWidget(self.preview)

    @property
    def instruction(self) -> Instruction:
        """The instruction as it stands on the form."""
        return self.fields.item  # type: ignore[no-any-return]

    def problem(self) -> str:
        """The first reason why the instruction is not right; empty when it is."""
        table = self.fields.cells.get(("table", ""))
        if table is not None and isinstance(table.editor, GridEditor) and table.editor.refusal:
            return table.editor.refusal
        errors = compiled(self.instruction, self.offers.setup).errors
        if not errors:
            return ""
        cell = self.fields.cells.get((errors[0].field, ""))
        empty = cell is not None and isinstance(cell.editor, RowsEditor) and not cell.editor.rows
        return cell.editor.invitation if cell is not None and empty else errors[0].message

    def _advice(self) -> list[str]:
        """Warnings that no field says already."""
        item, setup = self.instruction, self.offers.setup
        made = compiled(item, setup)
        own = [each for each in made.warnings if read.warning_of(item, each.field, setup, each.axis) != each.message]
        return [each.message for each in own if not made.errors]

    def show_instruction(self, instruction: Instruction) -> None:
        """Shows `instruction`; typing places stay where they are if it is of the same kind."""
        for _ in self.showing(instruction):
            pass

    def showing(self, instruction: Instruction) -> Iterator[None]:
        """The same in pieces."""
        other = type(instruction) is not type(self.fields.item)
        yield from self.fields.showing(instruction)
        if other:
            self._show_picture(instruction)
            yield
            self.nothing.setVisible(not self.fields.cells)
            self.setProperty("helpPage", instruction.title)
        self._refresh()

    def show_offers(self, offers: Offers) -> None:
        """Follows the document: other units, other names."""
        before, self.offers = self.offers, offers
        if offers == before:
            return
        self.fields.show_offers(offers)
        if self.fields.item is None:
            return
        if offers.setup != before.setup:  # the form was built anew
            self._show_picture(self.instruction)
        elif isinstance(self.picture, PathPicture):
            self.picture.show_offers(offers)
        self._refresh()

    def _edited(self, instruction: Instruction) -> None:
        self._refresh()
        self.edited.emit(instruction)

    def _refresh(self) -> None:
        setup = self.offers.setup
        words, lines = read.sentence(self.instruction, setup), code(self.instruction, setup)
        self.preview.show_words(words, lines, self.problem(), self._advice())
        if self.picture is not None:
            self.picture.show_instruction(self.instruction)  # type: ignore[attr-defined]
        self.refreshed.emit()

    def _show_picture(self, instruction: Instruction) -> None:
        if self.picture is not None:
            self.picture.deleteLater()
            self.picture = None
        filled_in = self.fields.cells.get(("table", ""))
        if filled_in is not None and isinstance(filled_in.editor, GridEditor):
            filled_in.editor.refused.connect(self._refresh)
        make = PICTURES.get(type(instruction).__name__)
        if make is not None and self.grows:
            self.picture = make(self.offers)
            if isinstance(self.picture, CommandList):
                self.picture.picked.connect(self._put_in)
            table, rows = (self.fields.cells.get((name, "")) for name in ("table", "segments"))
            if isinstance(self.picture, PathPicture) and rows is not None:
                self.picture.mirror_wanted.connect(self.mirror_wanted)
                rows.editor.opened.connect(self.picture.mark_row)
                self.picture.mark_row(rows.editor.list.currentRow())
            if isinstance(self.picture, CurvePicture) and table is not None:
                self.picture.point_moved.connect(table.editor.move_point)
                self.picture.row_wanted.connect(lambda row: table.editor.view.go_to(row, 0))
                table.editor.row_changed.connect(self.picture.mark_row)
                self._beside.addWidget(self.picture, 1)
            elif rows is not None and self.fields.put_below("segments", self.picture):
                pass
            elif self.fields.tight:  # there is room below the shorter column
                self.fields.last_column.addWidget(self.picture, 1)
            else:
                self._beside.addWidget(self.picture, 1)

    def _put_in(self, text: str) -> None:
        """A picked command becomes the next line of the code."""
        editor = self.fields.cells["text", ""].editor
        before = editor.value()
        editor.setValue(f"{before}\n{text}" if before.strip() else text)
        editor.changed.emit(editor.value())
        focus_in(editor)

    def ask_for_height(self, height: int) -> None:
        """The fields get this height; a narrow form takes what there is."""
        self.area.ask_for(QSize(0, max(LEAST if self.fields.cells else 0, height)))
