"""The program as rows: three sections, their steps and the bodies of repeats; updated by what changed, never reset.

The rows are flat, as they stand on the screen, so that an edit touches what it changes only: a tree view asks for
every row of the program after each inserted one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import groupby
from typing import Any
from uuid import uuid4

from PySide6.QtCore import QAbstractTableModel, QMimeData, QModelIndex, QObject, QPersistentModelIndex, Qt, Signal

from codegen.changes import Change, Changed, Inserted, Moved, Removed
from codegen.document import Document
from codegen.program import Program, Section, Step
from widgets.program.difference import edits
from widgets.program.node import HINTS, TITLES, Node, empty_tree
from widgets.program.words import Words

Index = QModelIndex | QPersistentModelIndex

STEPS_MIME = "application/x-twoletter-steps"
NEW_MIME = "application/x-twoletter-instruction"
FROM_MIME = "application/x-twoletter-window"  # whose steps they are: other windows number theirs alike
NodeRole = Qt.ItemDataRole.UserRole + 1
ENGLISH, CODE = 0, 1
HEADINGS = ("Program", "Code")
NOTHING = Qt.ItemFlag.NoItemFlags
TOP = QModelIndex()
SECTION_FLAGS = Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable | Qt.ItemFlag.ItemIsDropEnabled
STEP_FLAGS = SECTION_FLAGS | Qt.ItemFlag.ItemIsDragEnabled
FLAGS = (SECTION_FLAGS, STEP_FLAGS, STEP_FLAGS)


class ProgramModel(QAbstractTableModel):
    """Rows of one document; `show` walks from the old document to the new one with few row operations."""

    folded = Signal()  # something was folded or unfolded

    def __init__(self, words: Words, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.words = words
        self.root, self.nodes = empty_tree()
        self.rows: list[Node] = list(self.root.children)  # as they stand on the screen
        self._count(0)
        self.shown = Document(Program())  # what the rows show now
        self._mark = uuid4().hex.encode()
        self.copy_text: Callable[[Sequence[str]], str] = lambda ids: ""

    # ---- what Qt asks

    def index(self, row: int, column: int, parent: Index = TOP) -> QModelIndex:
        """The index of a row; rows have none below them."""
        there = 0 <= row < len(self.rows) and 0 <= column <= CODE and not parent.isValid()
        return self.createIndex(row, column) if there else QModelIndex()

    def rowCount(self, parent: Index = TOP) -> int:
        """How many rows are on the screen."""
        return 0 if parent.isValid() else len(self.rows)

    def columnCount(self, parent: Index = TOP) -> int:
        """English and code."""
        return 0 if parent.isValid() else 2

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
            return self._spoken(node) if index.column() == ENGLISH else self.words.code(node.step)
        return None

    def flags(self, index: Index) -> Qt.ItemFlag:
        """Steps can be chosen and dragged; what may be dropped where is told when it is let go."""
        return FLAGS[self.rows[index.row()].kind] if index.isValid() else NOTHING

    # ---- look-up

    def node(self, index: Index) -> Node:
        """The row behind an index; the root for an invalid one."""
        return self.rows[index.row()] if index.isValid() else self.root

    def index_of(self, name: str, column: int = 0) -> QModelIndex:
        """The index of a step by id, or of a section by name; invalid when it is not on the screen."""
        node = self.nodes.get(name)
        return QModelIndex() if node is None or node.line < 0 else self.createIndex(node.line, column)

    def order(self, ids: Sequence[str]) -> list[str]:
        """The given steps in the order of the program, without those whose holder is given too."""
        nodes = [self.nodes[name] for name in ids if name in self.nodes and self.nodes[name].step is not None]
        wanted = {node.id for node in nodes}
        tops = [node for node in nodes if not any(above.id in wanted for above in node.above())]
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
        data.setData(FROM_MIME, self._mark)
        return data

    def owns(self, data: QMimeData) -> bool:
        """Whether these are steps of this window."""
        return bytes(data.data(FROM_MIME).data()) == self._mark

    def dropMimeData(self, data: QMimeData, action: Qt.DropAction, row: int, column: int, parent: Index) -> bool:
        """Nothing: the view says what was dropped and where, and the document decides."""
        return False

    # ---- folding

    def fold(self, name: str, folded: bool = True) -> None:
        """Hides what a section or a step holds, or shows it again."""
        node = self.nodes[name]
        if node.folded == folded:
            return
        if node.line < 0:
            node.folded = folded  # it is out of sight itself
        elif folded:
            hidden = sum(1 for _ in node.unfolded()) - 1
            self._take(node.line + 1, hidden, lambda: setattr(node, "folded", True))
        else:
            node.folded = False
            seen = list(node.unfolded())[1:]
            node.folded = True
            self._put(node.line + 1, seen, lambda: setattr(node, "folded", False))
        if node.line >= 0:
            self._say_changed(node)
        self.folded.emit()

    def uncover(self, name: str) -> None:
        """Unfolds everything a step stands in."""
        node = self.nodes.get(name)
        if node is not None:
            for above in reversed([each for each in node.above() if each.folded]):
                self.fold(above.id, False)

    def visible_of(self, name: str) -> str:
        """The step itself, or the folded one it is hidden in; nothing when there is no such step."""
        node = self.nodes.get(name)
        if node is None:
            return ""
        return node.id if node.line >= 0 else next(above.id for above in node.above() if above.line >= 0)

    # ---- following the document

    def show(self, new: Document) -> None:
        """Goes from what the rows show to `new`; rows of steps that stay keep selection and scrolling."""
        old, self.shown = self.shown, new
        found = edits(old.program, new.program)
        for run in _runs(found):
            self._apply(run)
        for section in self.root.children:
            _adopt(section, new.program.section(Section(section.section)))
        if old.working_setup != new.working_setup:
            self.refresh()
        for edit in found:
            if isinstance(edit, Changed):
                self._say_changed(self.nodes[edit.step.id])

    def refresh(self) -> None:
        """Every row's words may have changed."""
        self.dataChanged.emit(self.createIndex(0, 0), self.createIndex(len(self.rows) - 1, CODE))

    def _apply(self, run: Sequence[Change]) -> None:
        match run[0]:
            case Inserted(_, place):
                steps = [edit.step for edit in run if isinstance(edit, Inserted)]
                self._insert(self.nodes[place.parent], place.index, steps)
            case Removed(name, place):
                last = self.nodes[name]  # steps go from the last to the first
                self._remove(self.nodes[place.parent], last.row - len(run) + 1, len(run))
            case Moved(name, _, place):
                self._move(self.nodes[name], self.nodes[place.parent], place.index)

    def _say_changed(self, node: Node) -> None:
        """The words of one row are new."""
        if node.line >= 0:
            self.dataChanged.emit(self.createIndex(node.line, 0), self.createIndex(node.line, CODE))

    def _insert(self, parent: Node, row: int, steps: Sequence[Step]) -> None:
        grown = [self._grown(parent, step) for step in steps]

        def enter() -> None:
            parent.children[row:row] = grown
            parent.number(row)

        if parent.is_open_to_view():
            self._put(_line_at(parent, row), [node for each in grown for node in each.walk()], enter)
        else:
            enter()

    def _grown(self, parent: Node, step: Step) -> Node:
        node = Node(parent, step)
        self.nodes[step.id] = node
        if step.body:
            node.children = [self._grown(node, child) for child in step.body]
            node.number()
        return node

    def _remove(self, parent: Node, row: int, count: int) -> None:
        gone = parent.children[row : row + count]

        def leave() -> None:
            del parent.children[row : row + count]
            parent.number(row)
            for each in gone:
                for node in each.walk():
                    if self.nodes.get(node.id) is node:
                        del self.nodes[node.id]

        if parent.is_open_to_view():
            self._take(gone[0].line, sum(1 for each in gone for _ in each.unfolded()), leave)
        else:
            leave()

    def _move(self, node: Node, parent: Node, row: int) -> None:
        source, start = _parent(node), node.row
        if source is parent and start == row:
            return

        def change() -> None:
            del source.children[start]
            parent.children.insert(row, node)
            node.parent = parent
            source.number(min(start, row) if source is parent else start)
            parent.number(min(start, row) if source is parent else row)

        seen = list(node.unfolded())
        if node.line < 0 and not parent.is_open_to_view():
            change()
        elif node.line < 0:
            self._put(_line_at(parent, row), seen, change)
        elif not parent.is_open_to_view():
            self._take(node.line, len(seen), change)
        else:
            ahead = source is parent and row > start  # the line is counted before the rows are taken out
            self._carry(node.line, seen, _line_at(parent, row + ahead), change)

    # ---- rows on the screen

    def _put(self, line: int, nodes: Sequence[Node], change: Callable[[], object]) -> None:
        """New rows from `line` on."""
        if not nodes:
            change()
            return
        self.beginInsertRows(TOP, line, line + len(nodes) - 1)
        change()
        self.rows[line:line] = nodes
        self._count(line)
        self.endInsertRows()

    def _take(self, line: int, count: int, change: Callable[[], object]) -> None:
        """Rows from `line` on go."""
        if not count:
            change()
            return
        self.beginRemoveRows(TOP, line, line + count - 1)
        change()
        for node in self.rows[line : line + count]:
            node.line = -1
        del self.rows[line : line + count]
        self._count(line)
        self.endRemoveRows()

    def _carry(self, line: int, nodes: Sequence[Node], to: int, change: Callable[[], object]) -> None:
        """Rows go elsewhere; `to` counts before they are taken out."""
        count = len(nodes)
        if line <= to <= line + count:  # only further in or out: the same lines
            change()
            self.dataChanged.emit(self.createIndex(line, 0), self.createIndex(line + count - 1, CODE))
            return
        self.beginMoveRows(TOP, line, line + count - 1, TOP, to)
        change()
        del self.rows[line : line + count]
        start = to - count if to > line else to
        self.rows[start:start] = nodes
        self._count(min(line, start))
        self.endMoveRows()

    def _count(self, start: int) -> None:
        rows = self.rows
        for line in range(start, len(rows)):
            rows[line].line = line

    def _spoken(self, node: Node) -> str:
        """The words of a step, and what a screen reader cannot see: that it is folded, and what it stands in."""
        if node.step is None:
            return ""
        words = self.words.spoken(node.step)
        holder = node.parent
        inside = f", inside {holder.step.instruction.title}" if holder is not None and holder.step is not None else ""
        hidden = f", folded, {len(node.children)} inside" if node.folded and node.children else ""
        return f"{words}{inside}{hidden}"


def _runs(found: Sequence[Change]) -> Iterator[list[Change]]:
    """Edits that can be made at once: steps beside each other that come, or that go from the last to the first."""

    def key(item: tuple[int, Change]) -> object:
        number, edit = item
        match edit:
            case Inserted(_, place):
                return "in", place.parent, place.index - number
            case Removed(_, place):
                return "out", place.parent, place.index + number
            case _:
                return number

    for _, run in groupby(enumerate(found), key):
        yield [edit for _, edit in run]


def _line_at(parent: Node, row: int) -> int:
    """The line a child would come to stand on at `row`."""
    if row == 0:
        return parent.line + 1
    before = parent.children[row - 1]
    return before.line + sum(1 for _ in before.unfolded())


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


def _path(node: Node) -> tuple[int, ...]:
    return (*reversed([above.row for above in node.above()]), node.row)
