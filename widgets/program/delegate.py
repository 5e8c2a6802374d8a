"""Paints a row of the program: group bar, sentence, problem, marks of running threads, place of the next step."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QRect, QSize, Qt
from PySide6.QtGui import QColor, QFont, QFontMetrics, QPainter, QPalette, QPen
from PySide6.QtWidgets import QStyle, QStyledItemDelegate, QStyleOptionViewItem

from widgets.parts.look import look
from widgets.program.model import ENGLISH, NodeRole
from widgets.program.node import HINTS, TITLES, Node
from widgets.program.words import Words

Index = QModelIndex | QPersistentModelIndex
BAR = 4
GAP = 8
WARNING = "△"


class ProgramDelegate(QStyledItemDelegate):
    """One row, painted from its node; knows which steps run, which failed and where the next one goes."""

    def __init__(self, words: Words) -> None:
        super().__init__()
        self.words = words
        self.executing: Mapping[str, tuple[int, ...]] = {}
        self.error: tuple[str, str] | None = None
        self.next_place: tuple[str, str] = ("", "")  # ("after" | "before" | "inside", id or section)

    def sizeHint(self, option: QStyleOptionViewItem, index: Index) -> QSize:
        """All rows are equally high, and high enough for a finger."""
        return QSize(120, look().control)

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        """Paints one cell."""
        node: Node = index.data(NodeRole)
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._background(painter, option, node)
        if node.step is None:
            self._section(painter, option, node, index.column())
        elif index.column() == ENGLISH:
            self._sentence(painter, option, node)
        else:
            self._code(painter, option, node)
        self._next_place(painter, option, node)
        if option.state & QStyle.StateFlag.State_HasFocus:
            painter.setPen(QPen(look().colour("focus"), 2))
            painter.drawRect(option.rect.adjusted(1, 1, -1, -1))
        painter.restore()

    # ---- parts of a row

    def _background(self, painter: QPainter, option: QStyleOptionViewItem, node: Node) -> None:
        chosen = bool(option.state & QStyle.StateFlag.State_Selected)
        if self.error is not None and node.id == self.error[0]:
            fault = QColor(look().colour("fault"))
            fault.setAlpha(50)
            painter.fillRect(option.rect, look().colour("surface"))
            painter.fillRect(option.rect, fault)
        elif node.id in self.executing:
            painter.fillRect(option.rect, look().colour("executing"))
        elif chosen:
            painter.fillRect(option.rect, look().colour("selection"))
            return
        if chosen:
            painter.fillRect(option.rect.adjusted(0, option.rect.height() - 2, 0, 0), look().colour("accent"))

    def _section(self, painter: QPainter, option: QStyleOptionViewItem, node: Node, column: int) -> None:
        painter.setPen(QPen(look().colour("line"), 1))
        painter.drawLine(option.rect.bottomLeft(), option.rect.bottomRight())
        if column != ENGLISH:
            return
        font = QFont(option.font)
        font.setBold(True)
        box = option.rect.adjusted(BAR, 0, -GAP, 0)
        title = TITLES[node.section]
        self._text(painter, box, title, font, self._colour(option, "text"))
        if not node.children:
            used = QFontMetrics(font).horizontalAdvance(title) + 2 * GAP
            self._text(
                painter, box.adjusted(used, 0, 0, 0), HINTS[node.section], option.font, self._colour(option, "quiet")
            )

    def _sentence(self, painter: QPainter, option: QStyleOptionViewItem, node: Node) -> None:
        step = node.step
        if step is None:
            return
        box = QRect(option.rect)
        bar = QRect(box.left(), box.top() + 3, BAR, box.height() - 6)
        painter.fillRect(bar, look().group(str(step.instruction.group)))
        box.adjust(BAR + GAP, 0, -GAP, 0)
        threads = self.executing.get(step.id)
        if threads:
            mark = "► " + ",".join(map(str, threads))
            box.setLeft(
                box.left() + self._text(painter, box, mark, _bold(option.font), self._colour(option, "text")) + GAP
            )
        font = QFont(option.font)
        font.setItalic(not step.enabled)
        colour = self._colour(option, "text" if step.enabled else "quiet")
        problem, token = self._problem(step.id, step.enabled)
        sentence = self.words.english(step)
        if problem:
            self._with_problem(painter, box, option, (sentence, font, colour), (problem, self._colour(option, token)))
            return
        used = self._text(painter, box, sentence, font, colour) + 2 * GAP
        if step.note:
            quiet = QFont(option.font)
            quiet.setItalic(True)
            self._text(painter, box.adjusted(used, 0, 0, 0), step.note, quiet, self._colour(option, "quiet"))

    def _with_problem(
        self,
        painter: QPainter,
        box: QRect,
        option: QStyleOptionViewItem,
        sentence: tuple[str, QFont, QColor],
        problem: tuple[str, QColor],
    ) -> None:
        """A mere warning gives way to a long sentence, down to its sign; the tool tip says it whole."""
        words, colour = problem
        room = box.width() // 3
        if words.startswith(WARNING):
            whole = QFontMetrics(sentence[1]).horizontalAdvance(sentence[0])
            if whole + 2 * GAP + QFontMetrics(option.font).horizontalAdvance(words) > box.width():
                words, room = WARNING, 3 * GAP
        used = self._text(painter, box.adjusted(0, 0, -room, 0), *sentence) + 2 * GAP - (GAP if words == WARNING else 0)
        self._text(painter, box.adjusted(used, 0, 0, 0), words, option.font, colour)

    def _problem(self, step_id: str, enabled: bool) -> tuple[str, str]:
        if self.error is not None and self.error[0] == step_id:
            return f"! {self.error[1]}", "fault"
        message = self.words.problems.get(step_id)
        if not message or not enabled:
            return "", ""
        return ("! " if step_id in self.words.errors else f"{WARNING} ") + message[0], "warning"

    def _code(self, painter: QPainter, option: QStyleOptionViewItem, node: Node) -> None:
        if node.step is None:
            return
        font = look().code_font()
        self._text(
            painter,
            option.rect.adjusted(GAP, 0, -GAP, 0),
            self.words.code(node.step),
            font,
            self._colour(option, "quiet"),
        )

    def _next_place(self, painter: QPainter, option: QStyleOptionViewItem, node: Node) -> None:
        where, name = self.next_place
        if name != node.id:
            return
        y = option.rect.top() + 1 if where == "before" else option.rect.bottom()
        painter.setPen(QPen(look().colour("accent"), 2))
        painter.drawLine(option.rect.left(), y, option.rect.right(), y)

    # ---- words

    def _colour(self, option: QStyleOptionViewItem, token: str) -> QColor:
        if option.state & QStyle.StateFlag.State_Selected and token == "text":
            return option.palette.color(QPalette.ColorRole.HighlightedText)
        return look().colour(token)

    def _text(self, painter: QPainter, box: QRect, text: str, font: QFont, colour: QColor) -> int:
        """Paints one elided line and says how wide it came out."""
        if box.width() <= 0:
            return 0
        metrics = QFontMetrics(font)
        shown = metrics.elidedText(text.replace("\n", "  "), Qt.TextElideMode.ElideRight, box.width())
        painter.setFont(font)
        painter.setPen(colour)
        painter.drawText(box, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, shown)
        return metrics.horizontalAdvance(shown)


def _bold(font: QFont) -> QFont:
    bold = QFont(font)
    bold.setBold(True)
    return bold
