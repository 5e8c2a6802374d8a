"""The program as rows: three sections, their steps and the bodies of repeats; updated by what changed, never reset."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from PySide6.QtCore import QAbstractItemModel, QMimeData, QModelIndex, QObject, QPersistentModelIndex, Qt, Signal

from codegen.changes import Change, Changed, Inserted, Moved, Removed
from codegen.document import Document
from codegen.program import Program, Section, Step
from widgets.program.difference import edits
from widgets.program.node import HINTS, TITLES, Node, empty_tree
from widgets.program.words import Words

Index = QModelIndex | QPersistentModelIndex

STEPS_MIME = "application/x-twoletter-steps"
NEW_MIME = "application/x-twoletter-instruction"
NodeRole = Qt.ItemDataRole.UserRole + 1
ENGLISH, CODE = 0, 1
HEADINGS = ("Program", "Code")
NOTHING = Qt.ItemFlag.NoItemFlags
SECTION_FLAGS = Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable | Qt.ItemFlag.ItemIsDropEnabled
HOLDER_FLAGS = SECTION_FLAGS | Qt.ItemFlag.ItemIsDragEnabled
STEP_FLAGS = HOLDER_FLAGS & ~Qt.ItemFlag.ItemIsDropEnabled | Qt.ItemFlag.ItemNeverHasChildren
FLAGS = (SECTION_FLAGS, HOLDER_FLAGS, STEP_FLAGS)


class ProgramModel(QAbstractItemModel):
    """Rows of one document; `show` walks from the old document to the new one with few row operations."""

    moved = Signal(object, object)  # ids of steps, (parent id or section, index)
    pasted = Signal(str, object)  # steps from outside as text, where
    chosen = Signal(str, object)  # title of an instruction dragged out of the palette, where

    def __init__(self, words: Words, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.words = words
        self.root, self.nodes = empty_tree()
        self.shown = Document(Program())  # what the rows show now
        self.copy_text: Callable[[Sequence[str]], str] = lambda ids: ""

    # ---- what Qt asks

    def index(self, row: int, column: int, parent: Index = QModelIndex()) -> QModelIndex:  # noqa: B008
        """The index of a row below `parent`."""
        children = (parent.internalPointer() or self.root).children
        return self.createIndex(row, column, children[row]) if 0 <= row < len(children) else QModelIndex()

    def parent(self, index: Index) -> QModelIndex:  # type: ignore[override]
        """The row above in the tree."""
        above = self.node(index).parent
        return QModelIndex() if above is None or above is self.root else self.createIndex(above.row, 0, above)

    def rowCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008
        """How many rows stand below `parent`."""
        return 0 if parent.isValid() and parent.column() > 0 else len(self.node(parent).children)

    def columnCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008
        """English and code."""
        return 2

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = 0) -> Any:
        """The headings of the two columns."""
        wanted = role == Qt.ItemDataRole.DisplayRole and orientation == Qt.Orientation.Horizontal
        return HEADINGS[section] if wanted else None

    def data(self, index: Index, role: int = 0) -> Any:
        """What a row says: English, code, tool tip, and the same for a screen reader."""
        node = self.node(index)
        if role == NodeRole:
            return node
        if node.step is None:
            return _section_data(node, index.column(), role)
        if role == Qt.ItemDataRole.DisplayRole:
            return self.words.english(node.step) if index.column() == ENGLISH else self.words.code(node.step)
        if role == Qt.ItemDataRole.ToolTipRole:
            return self.words.tip(node.step)
        if role == Qt.ItemDataRole.AccessibleTextRole:
            return self.words.spoken(node.step) if index.column() == ENGLISH else self.words.code(node.step)
        return None

    def flags(self, index: Index) -> Qt.ItemFlag:
        """Steps can be chosen and dragged; sections and everything that holds steps take them."""
        node = index.internalPointer()  # None for an invalid index; asked for every row at each change
        return FLAGS[node.kind] if node is not None else NOTHING

    # ---- look-up

    def node(self, index: Index) -> Node:
        """The row behind an index; the root for an invalid one."""
        return index.internalPointer() if index.isValid() else self.root  # type: ignore[no-any-return]

    def index_of(self, name: str, column: int = 0) -> QModelIndex:
        """The index of a step by id, or of a section by name; invalid when it is not there."""
        node = self.nodes.get(name)
        return QModelIndex() if node is None else self.createIndex(node.row, column, node)

    def order(self, ids: Sequence[str]) -> list[str]:
        """The given steps in the order of the program, without those whose holder is given too."""
        nodes = [self.nodes[name] for name in ids if name in self.nodes and self.nodes[name].step is not None]
        wanted = {node.id for node in nodes}
        tops = [node for node in nodes if not _has_ancestor(node, wanted)]
        return [node.id for node in sorted(tops, key=_path)]

    # ---- drag and drop

    def supportedDropActions(self) -> Qt.DropAction:
        """Dragging moves; with Ctrl it copies."""
        return Qt.DropAction.MoveAction | Qt.DropAction.CopyAction

    def mimeTypes(self) -> list[str]:
        """What may be dropped here."""
        return [STEPS_MIME, NEW_MIME]

    def mimeData(self, indexes: Sequence[QModelIndex]) -> QMimeData:
        """The dragged steps, by id and as text."""
        ids = self.order([self.node(index).id for index in indexes if index.column() == 0])
        data = QMimeData()
        data.setData(STEPS_MIME, ("\n".join(ids) + "\f" + self.copy_text(ids)).encode())
        return data

    def dropMimeData(self, data: QMimeData, action: Qt.DropAction, row: int, column: int, parent: Index) -> bool:
        """Says what was dropped and where; the owner changes the document."""
        node = self.node(parent)
        if node is self.root:
            return False
        if node.step is not None and not self.words.holds_steps(node.step) and node.parent is not None:
            row, node = node.row + 1, node.parent
        where = (node.id, len(node.children) if row < 0 else row)
        if data.hasFormat(NEW_MIME):
            self.chosen.emit(bytes(data.data(NEW_MIME).data()).decode(), where)
        elif data.hasFormat(STEPS_MIME):
            names, _, text = bytes(data.data(STEPS_MIME).data()).decode().partition("\f")
            if action == Qt.DropAction.MoveAction:
                self.moved.emit(tuple(names.split("\n")), where)
            else:
                self.pasted.emit(text, where)
        return False  # never let the view remove rows: the document decides

    # ---- following the document

    def show(self, new: Document) -> None:
        """Goes from what the rows show to `new`; rows of steps that stay keep selection and scrolling."""
        old, self.shown = self.shown, new
        found = edits(old.program, new.program)
        for edit in found:
            self._apply(edit)
        for section in self.root.children:
            _adopt(section, new.program.section(Section(section.section)))
        if old.working_setup != new.working_setup:
            self.refresh()
        for edit in found:
            if isinstance(edit, Changed):
                self._say_changed(self.nodes[edit.step.id])

    def refresh(self) -> None:
        """Every row's words may have changed."""
        for node in self.root.walk():
            if node.children:
                first, last = node.children[0], node.children[-1]
                self.dataChanged.emit(self.createIndex(first.row, 0, first), self.createIndex(last.row, 1, last))

    def _apply(self, change: Change) -> None:
        match change:
            case Inserted(step, place):
                self._insert(self.nodes[place.parent], place.index, step)
            case Removed(name, _):
                self._remove(self.nodes[name])
            case Moved(name, _, place):
                self._move(self.nodes[name], self.nodes[place.parent], place.index)

    def _say_changed(self, node: Node) -> None:
        """The words of one row are new."""
        self.dataChanged.emit(self.createIndex(node.row, 0, node), self.createIndex(node.row, 1, node))

    def _insert(self, parent: Node, row: int, step: Step) -> None:
        self.beginInsertRows(self._of(parent), row, row)
        parent.children.insert(row, self._grown(parent, step))
        parent.number(row)
        self.endInsertRows()

    def _grown(self, parent: Node, step: Step) -> Node:
        node = Node(parent, step)
        self.nodes[step.id] = node
        node.children = [self._grown(node, child) for child in step.body]
        node.number()
        return node

    def _remove(self, node: Node) -> None:
        parent = _parent(node)
        self.beginRemoveRows(self._of(parent), node.row, node.row)
        del parent.children[node.row]
        parent.number(node.row)
        for gone in node.walk():
            self.nodes.pop(gone.id, None)
        self.endRemoveRows()

    def _move(self, node: Node, parent: Node, row: int) -> None:
        source, start = _parent(node), node.row
        if source is parent and start == row:
            return
        ahead = source is parent and row > start  # Qt counts before the row is taken out
        self.beginMoveRows(self._of(source), start, start, self._of(parent), row + ahead)
        del source.children[start]
        parent.children.insert(row, node)
        node.parent = parent
        source.number(min(start, row) if source is parent else start)
        parent.number(min(start, row) if source is parent else row)
        self.endMoveRows()

    def _of(self, node: Node) -> QModelIndex:
        return QModelIndex() if node is self.root else self.createIndex(node.row, 0, node)


def _adopt(node: Node, steps: Sequence[Step]) -> None:
    """Hands the new frozen steps to the rows; only where something below is new."""
    for child, step in zip(node.children, steps, strict=True):
        if child.step is not step:
            child.adopt(step)
            _adopt(child, step.body)


def _parent(node: Node) -> Node:
    if node.parent is None:
        raise LookupError("the root of the tree neither moves nor goes")
    return node.parent


def _section_data(node: Node, column: int, role: int) -> Any:
    if column != ENGLISH:
        return None
    if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.AccessibleTextRole):
        return TITLES[node.section]
    return HINTS[node.section] if role == Qt.ItemDataRole.ToolTipRole else None


def _has_ancestor(node: Node, names: set[str]) -> bool:
    above = node.parent
    while above is not None:
        if above.id in names:
            return True
        above = above.parent
    return False


def _path(node: Node) -> tuple[int, ...]:
    rows: list[int] = []
    above: Node | None = node
    while above is not None:
        rows.append(above.row)
        above = above.parent
    return tuple(reversed(rows))
