"""Paints a row of the program: group bar, sentence, problem, marks of running threads, place of the next step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QPointF, QRect, QSize, Qt
from PySide6.QtGui import QColor, QFont, QFontMetrics, QPainter, QPalette, QPen, QPolygonF
from PySide6.QtWidgets import QStyle, QStyledItemDelegate, QStyleOptionViewItem

from widgets.parts.look import Look, look
from widgets.program.model import ENGLISH, ProgramModel
from widgets.program.node import HINTS, TITLES, Node

Index = QModelIndex | QPersistentModelIndex
BAR = 4
GAP = 8
INDENT = 20  # pixels for each step inwards
WARNING = "△"
PLAIN, BOLD, ITALIC, MONO = range(4)
CACHED = 4096  # texts kept as they were cut to their width
MIDDLE = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft | Qt.TextFlag.TextSingleLine


class Pens:
    """Fonts, colours and cut texts of one theme and font, made once: painting asks for them for every cell."""

    def __init__(self, now: Look, font: QFont) -> None:
        self.look, self.font = now, font
        self.fonts = (QFont(font), QFont(font), QFont(font), now.code_font())
        self.fonts[BOLD].setBold(True)
        self.fonts[ITALIC].setItalic(True)
        self.metrics = tuple(QFontMetrics(each) for each in self.fonts)
        self._colours: dict[str, QColor] = {}
        self._cut: dict[tuple[str, int, int], tuple[str, int]] = {}

    def colour(self, token: str) -> QColor:
        """A colour of the theme."""
        if token not in self._colours:
            self._colours[token] = self.look.colour(token)
        return self._colours[token]

    def group(self, group: str) -> QColor:
        """The colour of a group of instructions."""
        if group not in self._colours:
            self._colours[group] = self.look.group(group)
        return self._colours[group]

    def cut(self, text: str, font: int, width: int) -> tuple[str, int]:
        """The text as far as it fits, and how wide it is then."""
        key = (text, font, width)
        found = self._cut.get(key)
        if found is None:
            if len(self._cut) >= CACHED:
                self._cut.clear()
            metrics = self.metrics[font]
            shown = metrics.elidedText(text.replace("\n", "  "), Qt.TextElideMode.ElideRight, width)
            found = self._cut[key] = (shown, metrics.horizontalAdvance(shown))
        return found


class Cell:
    """What is being painted: the row, the box that is left, and whether it is chosen."""

    __slots__ = ("box", "chosen", "focused", "node", "palette", "pens", "right", "scrolled", "whole")

    def __init__(self, option: QStyleOptionViewItem, node: Node, pens: Pens) -> None:
        state = option.state.value
        self.node, self.pens = node, pens
        self.whole = QRect(option.rect)
        self.box = QRect(option.rect)
        self.palette = option.palette
        view: Any = option.widget
        self.right, self.scrolled = view.viewport().width(), view.horizontalScrollBar().value()
        self.chosen = bool(state & QStyle.StateFlag.State_Selected.value)
        self.focused = bool(state & QStyle.StateFlag.State_HasFocus.value)

    def colour(self, token: str) -> QColor:
        """A colour of the theme; text on a chosen row has the one that can be read there."""
        if self.chosen and token == "text":
            return self.palette.color(QPalette.ColorRole.HighlightedText)
        return self.pens.colour(token)

    def text(self, painter: QPainter, text: str, font: int, token: str, room: int = 0) -> None:
        """Paints one line, cut to the box (less `room`), and takes its width off the box."""
        width = self.box.width() - room
        if width <= 0:
            return
        shown, used = self.pens.cut(text, font, width)
        painter.setFont(self.pens.fonts[font])
        painter.setPen(self.colour(token))
        painter.drawText(self.box, MIDDLE.value, shown)
        self.box.setLeft(self.box.left() + used)


class ProgramDelegate(QStyledItemDelegate):
    """One row, painted from its node; knows which steps run, which failed and where the next one goes."""

    def __init__(self, model: ProgramModel) -> None:
        super().__init__()
        self.model, self.words = model, model.words
        self.executing: Mapping[str, tuple[int, ...]] = {}
        self.error: tuple[str, str] | None = None
        self.next_place: tuple[str, str] = ("", "")  # ("after" | "before" | "inside", id or section)
        self.found: frozenset[str] = frozenset()  # steps that hold what is searched
        self.marks: dict[str, tuple[int, ...]] = {}
        self._pens: Pens | None = None

    def show_marks(self) -> None:
        """Threads stand on the row that is to be seen; call it when they moved or something was folded."""
        marks: dict[str, tuple[int, ...]] = {}
        for name, threads in self.executing.items():
            seen = self.model.visible_of(name)
            marks[seen] = tuple(sorted({*marks.get(seen, ()), *threads}))
        self.marks = marks

    def looks(self, node: Node, with_code: bool) -> object:
        """What a row shows now, to be compared: equal looks are painted alike."""
        step, name = node.step, node.id
        marks = (self.marks.get(name), name in self.found, self.next_place if self.next_place[1] == name else None)
        if step is None:
            return name, bool(node.children), node.folded and _hidden(node), marks
        error = self.error if self.error is not None and self.error[0] == name else None
        said = (
            self.words.english(step),
            self.words.code(step) if with_code else "",
            self._problem(name, step.enabled),
            error,
        )
        hidden = node.folded and node.children and _hidden(node)
        return step.note, step.instruction.group, node.depth, bool(node.children), hidden, said, marks

    def sizeHint(self, option: QStyleOptionViewItem, index: Index) -> QSize:
        """All rows are equally high, and high enough for a finger."""
        return QSize(120, look().control)

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        """Paints one cell."""
        node, column = self.model.rows[index.row()], index.column()
        cell = Cell(option, node, self._pens_for(option.font))
        self._background(painter, cell)
        if node.step is None:
            self._section(painter, cell, column)
        elif column == ENGLISH:
            self._sentence(painter, cell)
        else:
            cell.box.adjust(GAP, 0, -GAP, 0)
            cell.text(painter, self.words.code(node.step), MONO, "quiet")
        self._next_place(painter, cell)
        if cell.focused:
            painter.setPen(QPen(cell.pens.colour("focus"), 2))
            painter.drawRect(cell.whole.adjusted(1, 1, -1, -1))

    def _pens_for(self, font: QFont) -> Pens:
        now = look()
        if self._pens is None or self._pens.look is not now or self._pens.font != font:
            self._pens = Pens(now, QFont(font))
        return self._pens

    # ---- parts of a row

    def _background(self, painter: QPainter, cell: Cell) -> None:
        rect, name, pens = cell.whole, cell.node.id, cell.pens
        if self.error is not None and name == self.error[0]:
            fault = QColor(pens.colour("fault"))
            fault.setAlpha(50)
            painter.fillRect(rect, pens.colour("surface"))
            painter.fillRect(rect, fault)
        elif name in self.marks:
            painter.fillRect(rect, pens.colour("executing"))
        elif cell.chosen:
            painter.fillRect(rect, pens.colour("selection"))
            return
        if cell.chosen:
            painter.fillRect(rect.adjusted(0, rect.height() - 2, 0, 0), pens.colour("accent"))

    def _section(self, painter: QPainter, cell: Cell, column: int) -> None:
        """The title; it goes on into the column of the code."""
        node, whole, box = cell.node, cell.whole, cell.box
        painter.setPen(cell.pens.colour("line"))
        painter.drawLine(whole.bottomLeft(), whole.bottomRight())
        if column == ENGLISH:
            self._arrow(painter, cell)
        painter.save()
        painter.setClipRect(whole)
        box.setLeft(INDENT + BAR - cell.scrolled)
        box.setRight(max(box.right(), cell.right) - GAP)
        cell.text(painter, TITLES[node.section], BOLD, "text")
        box.setLeft(box.left() + 2 * GAP)
        if not node.children:
            cell.text(painter, HINTS[node.section], PLAIN, "quiet")
        elif node.folded:
            cell.text(painter, _hidden(node), PLAIN, "quiet")
        painter.restore()

    def _arrow(self, painter: QPainter, cell: Cell) -> None:
        """Points down where a row is open, to the right where it is folded."""
        node = cell.node
        if not node.children:
            return
        x = cell.whole.left() + node.depth * INDENT + INDENT / 2 + 1
        y = cell.whole.center().y() + 0.5
        points = ((-2, -4), (2.5, 0), (-2, 4)) if node.folded else ((-4, -2), (0, 2.5), (4, -2))
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(cell.colour("text"), 1.6))
        painter.drawPolyline(QPolygonF([QPointF(x + right, y + down) for right, down in points]))
        painter.restore()

    def _sentence(self, painter: QPainter, cell: Cell) -> None:
        node, box = cell.node, cell.box
        step = node.step
        if step is None:
            return
        self._arrow(painter, cell)
        box.setLeft(box.left() + (node.depth + 1) * INDENT)
        painter.fillRect(
            QRect(box.left(), box.top() + 3, BAR, box.height() - 6), cell.pens.group(step.instruction.group.value)
        )
        box.adjust(BAR + GAP, 0, -GAP, 0)
        threads = self.marks.get(step.id)
        if threads:
            cell.text(painter, "► " + ",".join(map(str, threads)), BOLD, "text")
            box.setLeft(box.left() + GAP)
        font, token = (PLAIN, "text") if step.enabled else (ITALIC, "quiet")
        if step.id in self.found:
            self._mark_found(painter, cell, font)
        problem, alarm = self._problem(step.id, step.enabled)
        if problem:
            self._with_problem(painter, cell, self.words.english(step), font, token, problem, alarm)
            return
        cell.text(painter, self.words.english(step), font, token)
        box.setLeft(box.left() + 2 * GAP)
        if node.folded and node.children:
            cell.text(painter, _hidden(node), PLAIN, "quiet")
            box.setLeft(box.left() + 2 * GAP)
        if step.note:
            cell.text(painter, step.note, ITALIC, "quiet")

    def _mark_found(self, painter: QPainter, cell: Cell, font: int) -> None:
        """A line under a step that holds what is searched."""
        step, box = cell.node.step, cell.box
        if step is not None:
            _, used = cell.pens.cut(self.words.english(step), font, max(1, box.width()))
            painter.fillRect(QRect(box.left(), box.bottom() - 4, used, 3), cell.pens.colour("warning"))

    def _with_problem(
        self, painter: QPainter, cell: Cell, sentence: str, font: int, token: str, problem: str, alarm: str
    ) -> None:
        """A mere warning gives way to a long sentence, down to its sign; the tool tip says it whole."""
        metrics, box = cell.pens.metrics, cell.box
        room = box.width() // 3
        if problem.startswith(WARNING):
            whole = metrics[font].horizontalAdvance(sentence)
            if whole + 2 * GAP + metrics[PLAIN].horizontalAdvance(problem) > box.width():
                problem, room = WARNING, 3 * GAP
        cell.text(painter, sentence, font, token, room)
        box.setLeft(box.left() + 2 * GAP - (GAP if problem == WARNING else 0))
        cell.text(painter, problem, PLAIN, alarm)

    def _problem(self, step_id: str, enabled: bool) -> tuple[str, str]:
        if self.error is not None and self.error[0] == step_id:
            return f"! {self.error[1]}", "fault"
        message = self.words.problems.get(step_id)
        if not message or not enabled:
            return "", ""
        return ("! " if step_id in self.words.errors else f"{WARNING} ") + message[0], "warning"

    def _next_place(self, painter: QPainter, cell: Cell) -> None:
        where, name = self.next_place
        if name != cell.node.id:
            return
        y = cell.whole.top() + 1 if where == "before" else cell.whole.bottom()
        painter.setPen(QPen(cell.pens.colour("accent"), 2))
        painter.drawLine(cell.whole.left(), y, cell.whole.right(), y)


def _hidden(node: Node) -> str:
    """How much is folded away."""
    count = sum(1 for _ in node.walk()) - 1
    return "1 step inside" if count == 1 else f"{count} steps inside"
