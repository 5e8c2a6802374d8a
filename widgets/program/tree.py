"""The tree of the program: keys, mouse, drag and drop; emits what the user wants done."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QItemSelection, QItemSelectionModel, QModelIndex, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTreeView, QWidget

from widgets.parts.look import look
from widgets.program.delegate import ProgramDelegate
from widgets.program.model import CODE, ENGLISH, ProgramModel


class ProgramTree(QTreeView):
    """Rows of the program; several can be chosen."""

    modify_wanted = Signal(str)
    chosen_changed = Signal()

    def __init__(self, model: ProgramModel, delegate: ProgramDelegate, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._model = model
        self.setModel(model)
        self._delegate = delegate
        self.setItemDelegate(delegate)
        self.setUniformRowHeights(True)
        self.setExpandsOnDoubleClick(False)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setDragDropMode(QAbstractItemView.DragDropMode.DragDrop)
        self.setDefaultDropAction(Qt.DropAction.MoveAction)
        self.setDropIndicatorShown(True)
        self.setAutoScroll(True)
        self.setIndentation(20)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setAccessibleName("Program")
        self.setAccessibleDescription("Enter changes a step, Delete removes it, Ctrl+I inserts before it")
        self.setProperty("helpPage", "Program window")
        self.setIconSize(QSize(16, 16))
        header = self.header()
        header.setStretchLastSection(False)
        header.setSectionResizeMode(ENGLISH, QHeaderView.ResizeMode.Stretch)
        header.setSectionResizeMode(CODE, QHeaderView.ResizeMode.Interactive)
        header.setMinimumSectionSize(80)
        header.resizeSection(CODE, 240)
        self.setHeaderHidden(True)
        self.doubleClicked.connect(self._activated)
        model.rowsInserted.connect(self._open_new)
        self.selectionModel().selectionChanged.connect(lambda *_: self.chosen_changed.emit())
        for row in range(model.rowCount()):
            self.setFirstColumnSpanned(row, QModelIndex(), True)
        self.expandAll()

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
        """Selects steps (or a section) and brings the last into view."""
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

    # ---- keys and mouse

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter changes the step; on a section it folds."""
        plain = event.modifiers() in (Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.KeypadModifier)
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and plain:
            self._activated(self.currentIndex())
            event.accept()
            return
        super().keyPressEvent(event)

    def _activated(self, index: QModelIndex) -> None:
        node = self._model.node(index)
        if node.step is not None:
            self.modify_wanted.emit(node.id)
        elif index.isValid():
            self.setExpanded(index, not self.isExpanded(index))

    def _open_new(self, parent: QModelIndex, first: int, last: int) -> None:
        """New rows come unfolded."""
        self.expand(parent)
        for row in range(first, last + 1):
            index = self._model.index(row, 0, parent)
            if self._model.rowCount(index):
                self.expandRecursively(index)

    def show_code_column(self, shown: bool) -> None:
        """English beside its code, or English alone."""
        self.setColumnHidden(CODE, not shown)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """A third of the width is for the code, within reason."""
        super().resizeEvent(event)
        self.header().resizeSection(CODE, max(96, min(320, self.viewport().width() * 32 // 100)))

    def sizeHint(self) -> QSize:
        """A comfortable width to start with."""
        return QSize(560, look().control * 14)
