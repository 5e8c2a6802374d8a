"""The program on the screen: keys, mouse, folding, drag and drop; emits what the user wants done."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from PySide6.QtCore import QItemSelection, QItemSelectionModel, QMimeData, QModelIndex, QPoint, QRect, QSize, Qt, Signal
from PySide6.QtGui import (
    QDragLeaveEvent,
    QDragMoveEvent,
    QDropEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QResizeEvent,
)
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableView, QWidget

from codegen.program import Place
from widgets.parts.look import look
from widgets.parts.still import still
from widgets.program.delegate import INDENT, ProgramDelegate
from widgets.program.model import CODE, ENGLISH, NEW_MIME, STEPS_MIME, ProgramModel
from widgets.program.node import Node
from widgets.program.places import Target, target_at, within

FOLDING = {Qt.Key.Key_Left: True, Qt.Key.Key_Minus: True, Qt.Key.Key_Right: False, Qt.Key.Key_Plus: False}


class ProgramTree(QTableView):
    """Rows of the program; several can be chosen. A table, because a tree of Qt looks at every row after each edit."""

    modify_wanted = Signal(str)
    chosen_changed = Signal()
    moved = Signal(object, object)  # ids of steps, Place
    pasted = Signal(str, object)  # steps from outside as text, Place
    taken = Signal(str, object)  # title of an instruction dragged out of the palette, Place or None

    def __init__(self, model: ProgramModel, delegate: ProgramDelegate, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._model = model
        self._target: Target | None = None
        self.refusal: Callable[[QMimeData, Place], str] = lambda data, place: ""
        self.setModel(model)
        self._delegate = delegate
        self.setItemDelegate(delegate)
        self._set_up_selection()
        self._set_up_headers()
        self.setAccessibleName("Program")
        self.setAccessibleDescription("Enter changes a step, Delete removes it, Ctrl+I inserts before it")
        self.setProperty("helpPage", "Program window")
        self.doubleClicked.connect(self._activated)
        self.selectionModel().selectionChanged.connect(lambda *_: self.chosen_changed.emit())

    def _set_up_selection(self) -> None:
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setDragDropMode(QAbstractItemView.DragDropMode.DragDrop)
        self.setDragDropOverwriteMode(False)
        self.setDefaultDropAction(Qt.DropAction.MoveAction)
        self.setDropIndicatorShown(False)  # painted here: it shows how far in the steps go
        self.setAutoScroll(True)
        self.setTabKeyNavigation(False)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)

    def _set_up_headers(self) -> None:
        self.setShowGrid(False)
        self.setWordWrap(False)
        self.setCornerButtonEnabled(False)
        rows, columns = self.verticalHeader(), self.horizontalHeader()
        rows.hide()
        rows.setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        rows.setMinimumSectionSize(16)
        rows.setDefaultSectionSize(look().control)
        columns.hide()
        columns.setMinimumSectionSize(80)
        columns.setSectionResizeMode(ENGLISH, QHeaderView.ResizeMode.Stretch)
        columns.setSectionResizeMode(CODE, QHeaderView.ResizeMode.Interactive)
        columns.resizeSection(CODE, 240)

    # ---- which steps

    def chosen(self) -> list[str]:
        """Ids of the selected steps, in the order of the program."""
        nodes = [self._model.node(index) for index in self.selectionModel().selectedRows()]
        return self._model.order([node.id for node in nodes if node.step is not None])

    def current(self) -> str | None:
        """Id of the step the focus frame stands on."""
        node = self._model.node(self.currentIndex())
        return None if node.step is None else node.id

    def current_section(self) -> str:
        """The section the focus frame stands in."""
        return self._model.node(self.currentIndex()).section_name() if self.currentIndex().isValid() else ""

    def choose(self, names: Sequence[str]) -> None:
        """Selects steps (or a section) and brings the last into view; what they stand in is unfolded."""
        for name in names:
            self._model.uncover(name)
        rows = [index for index in map(self._model.index_of, names) if index.isValid()]
        if not rows:
            return
        selection = QItemSelection()
        for index in rows:
            selection.select(index, index.siblingAtColumn(CODE))
        flags = QItemSelectionModel.SelectionFlag
        self.selectionModel().setCurrentIndex(rows[-1], flags.NoUpdate)
        self.selectionModel().select(selection, flags.ClearAndSelect)
        self.scrollTo(rows[-1])

    def bring(self, name: str) -> None:
        """Brings a row into view, unfolding what hides it; the selection stays."""
        self._model.uncover(name)
        index = self._model.index_of(name)
        if index.isValid():
            self.scrollTo(index)

    # ---- folding

    def fold(self, name: str, folded: bool) -> None:
        """Folds or unfolds; a selection that would go out of sight goes to the row that hides it."""
        current = self._model.node(self.currentIndex())
        self._model.fold(name, folded)
        if folded and current.line < 0:
            self.choose([name])

    def fold_all(self, folded: bool) -> None:
        """Every subroutine and repeat at once; the sections stay open."""
        for node in list(self._model.root.walk()):
            if node.kind == 1:
                self._model.fold(node.id, folded)

    def folded_names(self) -> list[str]:
        """What is folded, also out of sight."""
        return [node.id for node in self._model.root.walk() if node.folded and node.children]

    def fold_only(self, names: Sequence[str]) -> None:
        """Folds these and unfolds everything else; names of nothing that folds are left aside."""
        wanted = frozenset(names)
        for node in list(self._model.root.walk()):
            if node.parent is not None and node.children:
                self.fold(node.id, node.id in wanted)

    def arrow_of(self, node: Node) -> QRect:
        """Where the arrow stands that folds a row."""
        row = self.visualRect(self._model.index(node.line, ENGLISH))
        return QRect(row.left() + node.depth * INDENT, row.top(), INDENT, row.height())

    # ---- keys and mouse

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter changes the step, on a section it folds; Left and Right fold, Home and End go to the ends."""
        plain = event.modifiers() in (Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.KeypadModifier)
        key = Qt.Key(event.key())
        if plain and key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._activated(self.currentIndex())
        elif plain and key in FOLDING and self.currentIndex().isValid():
            self._fold_by_key(key)
        else:
            super().keyPressEvent(event)
            return
        event.accept()

    def _fold_by_key(self, key: Qt.Key) -> None:
        node, folded = self._model.node(self.currentIndex()), FOLDING[key]
        steps_on = key in (Qt.Key.Key_Left, Qt.Key.Key_Right)
        if node.children and node.folded != folded:
            self.fold(node.id, folded)
        elif steps_on and folded and node.parent is not None and node.parent is not self._model.root:
            self.choose([node.parent.id])
        elif steps_on and not folded and node.children:
            self.choose([node.children[0].id])

    def moveCursor(self, action: QAbstractItemView.CursorAction, modifiers: Qt.KeyboardModifier) -> QModelIndex:
        """Home and End go to the first and last row."""
        cursor = QAbstractItemView.CursorAction
        if action in (cursor.MoveHome, cursor.MoveEnd):
            return self._model.index(0 if action is cursor.MoveHome else len(self._model.rows) - 1, ENGLISH)
        if action in (cursor.MoveLeft, cursor.MoveRight):
            return self.currentIndex()
        return super().moveCursor(action, modifiers)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """A click on the arrow folds."""
        node = self._arrow_under(event)
        if node is None:
            super().mousePressEvent(event)
        else:
            self.fold(node.id, not node.folded)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Two quick clicks on the arrow are two clicks."""
        if self._arrow_under(event) is None:
            super().mouseDoubleClickEvent(event)
        else:
            self.mousePressEvent(event)

    def _arrow_under(self, event: QMouseEvent) -> Node | None:
        at = event.position().toPoint()
        node = self._model.node(self.indexAt(at))
        left = event.button() == Qt.MouseButton.LeftButton
        return node if left and node.children and node.line >= 0 and self.arrow_of(node).contains(at) else None

    def _activated(self, index: QModelIndex) -> None:
        node = self._model.node(index)
        if node.step is not None:
            self.modify_wanted.emit(node.id)
        elif index.isValid():
            self.fold(node.id, not node.folded)

    # ---- dropping

    def dragMoveEvent(self, event: QDragMoveEvent) -> None:
        """Shows where the steps would go."""
        super().dragMoveEvent(event)  # scrolls at the edges
        self._show_target(self._target_of(event))
        event.setAccepted(event.mimeData().hasFormat(STEPS_MIME) or event.mimeData().hasFormat(NEW_MIME))

    def dragLeaveEvent(self, event: QDragLeaveEvent) -> None:
        """Nothing will be dropped here for now."""
        super().dragLeaveEvent(event)
        self._show_target(None)

    def dropEvent(self, event: QDropEvent) -> None:
        """Says what was dropped and where; the document decides."""
        target, data, copies = self._target_of(event), event.mimeData(), event.dropAction() == Qt.DropAction.CopyAction
        super().dropEvent(event)  # ends the dragging; the model takes nothing
        self._show_target(None)
        event.setAccepted(True)
        place = None if target is None else target.place
        if data.hasFormat(NEW_MIME):
            self.taken.emit(bytes(data.data(NEW_MIME).data()).decode(), place)
        elif data.hasFormat(STEPS_MIME):
            names, _, text = bytes(data.data(STEPS_MIME).data()).decode().partition("\f")
            if copies or not self._model.owns(data):
                self.pasted.emit(text, place)
            else:
                self.moved.emit(tuple(names.split("\n")), place)

    def _target_of(self, event: QDropEvent) -> Target | None:
        """The place under the mouse; None below the last row."""
        at: QPoint = event.position().toPoint()
        line = self.rowAt(at.y())
        if line < 0:
            return None
        data, nodes = event.mimeData(), self._model.nodes
        copies = event.dropAction() == Qt.DropAction.CopyAction or not self._model.owns(data)
        moving = () if copies else _ids(data)
        top = self.rowViewportPosition(line)
        height = (at.y() - top) / max(1, self.rowHeight(line))
        depth = (at.x() - self.columnViewportPosition(ENGLISH)) // INDENT - 1
        found = target_at(
            self._model.rows, line, height, depth, lambda place: self.refusal(data, within(nodes, place, moving))
        )
        return Target(within(nodes, found.place, moving), found.line, found.shown, found.depth)

    def _show_target(self, target: Target | None) -> None:
        if target != self._target:
            self._target = target
            self.viewport().update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """The rows, and while something is dragged the place it would go to."""
        super().paintEvent(event)
        if self._target is None:
            return
        painter = QPainter(self.viewport())
        painter.setPen(QPen(look().colour("accent"), 2))
        top, height = self.rowViewportPosition(self._target.line), self.rowHeight(self._target.line)
        left, right = (self._target.depth + 1) * INDENT, self.viewport().width() - 2
        if self._target.shown == "on":
            painter.drawRect(QRect(left - INDENT // 2, top + 1, right - left, height - 3))
        else:
            y = top + (height - 1 if self._target.shown == "below" else 1)
            painter.drawLine(left, y, right, y)
            painter.drawEllipse(QPoint(left, y), 3, 3)

    # ---- what is painted anew

    @contextmanager
    def changing(self) -> Iterator[None]:
        """The program changes; afterwards only the rows are painted that do not look as before."""
        before = self._looks()
        with still(self):
            yield
            self.executeDelayedItemsLayout()
        after = self._looks()
        width = self.viewport().width()
        for place in range(max(len(before), len(after))):
            if before[place : place + 1] != after[place : place + 1]:
                line = self.rowAt(0) + place
                end = place < len(after)
                top = self.rowViewportPosition(line) if end else self._end()
                height = self.rowHeight(line) if end else self.viewport().height()
                self.viewport().update(0, top, width, height)

    def _looks(self) -> list[object]:
        """What each row in sight shows now."""
        first, last = self.rowAt(0), self.rowAt(self.viewport().height() - 1)
        if first < 0:
            return []
        chosen = {line for each in self.selectionModel().selection() for line in range(each.top(), each.bottom() + 1)}
        current, rows, with_code = self.currentIndex().row(), self._model.rows, not self.isColumnHidden(CODE)
        return [
            (self._delegate.looks(rows[line], with_code), line in chosen, line == current)
            for line in range(first, len(rows) if last < 0 else last + 1)
        ]

    def _end(self) -> int:
        """Where the last row ends, in the viewport."""
        last = len(self._model.rows) - 1
        return self.rowViewportPosition(last) + self.rowHeight(last)

    # ---- size

    def show_code_column(self, shown: bool) -> None:
        """English beside its code, or English alone."""
        self.setColumnHidden(CODE, not shown)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """A third of the width is for the code, within reason."""
        super().resizeEvent(event)
        self.horizontalHeader().resizeSection(CODE, max(96, min(320, self.viewport().width() * 32 // 100)))

    def sizeHint(self) -> QSize:
        """A comfortable width to start with."""
        return QSize(560, look().control * 14)


def _ids(data: QMimeData) -> tuple[str, ...]:
    if not data.hasFormat(STEPS_MIME):
        return ()
    return tuple(bytes(data.data(STEPS_MIME).data()).decode().partition("\f")[0].split("\n"))
