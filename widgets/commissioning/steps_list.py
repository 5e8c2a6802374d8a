"""The list of steps: a number in a circle, a tick, a cross or a dash, and beside it what came of the step."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QPainter, QPen
from PySide6.QtWidgets import QListWidget, QListWidgetItem, QStyle, QStyledItemDelegate, QStyleOptionViewItem, QWidget

from widgets.commissioning.page import MARK_WORDS, Entry
from widgets.parts.look import look

ENTRY = Qt.ItemDataRole.UserRole
HEIGHT, CIRCLE = 48, 24
TOKENS = {"passed": "ok", "failed": "fault", "skipped": "quiet", "open": "border"}


class StepsList(QListWidget):
    """Shows entries; the current row is the step that is worked on."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName("Steps")
        self.setItemDelegate(StepDelegate(self))
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setUniformItemSizes(True)
        self.setFixedWidth(288)

    def show_entries(self, entries: Sequence[Entry], current: int) -> None:
        """Keeps the items where they are the same."""
        self.blockSignals(True)
        while self.count() > len(entries):
            self.takeItem(self.count() - 1)
        for row, entry in enumerate(entries):
            item = self.item(row) if row < self.count() else QListWidgetItem(self)
            if item.data(ENTRY) != entry:
                item.setData(ENTRY, entry)
                item.setSizeHint(QSize(0, HEIGHT))
                said = f"{row + 1}. {entry.title}, {MARK_WORDS[entry.mark]}"
                item.setData(Qt.ItemDataRole.AccessibleTextRole, said)
                item.setToolTip(entry.words)
        if self.currentRow() != current:
            self.setCurrentRow(current)
        self.blockSignals(False)


class StepDelegate(QStyledItemDelegate):
    """Paints one entry."""

    def sizeHint(self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex) -> QSize:
        return QSize(0, HEIGHT)

    def paint(
        self, painter: QPainter, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        entry = index.data(ENTRY)
        if not isinstance(entry, Entry):
            return
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        rect = QRectF(option.rect)
        state = option.state
        chosen = bool(state & QStyle.StateFlag.State_Selected)
        if chosen:
            painter.fillRect(rect, look().colour("selection"))
        circle = QRectF(rect.left() + 12, rect.center().y() - CIRCLE / 2, CIRCLE, CIRCLE)
        paint_mark(painter, circle, entry.mark, index.row() + 1)
        ink = look().colour("selection_text" if chosen else "text")
        words = rect.adjusted(12 + CIRCLE + 12, 0, -8, 0)
        font = look().body_font()
        font.setBold(chosen)
        painter.setFont(font)
        painter.setPen(ink)
        top = words.adjusted(0, 6, 0, -words.height() / 2 + 4)
        painter.drawText(top, Qt.AlignmentFlag.AlignVCenter, entry.title)
        painter.setFont(look().small_font())
        painter.setPen(ink if chosen else look().colour("quiet"))
        below = words.adjusted(0, words.height() / 2, 0, -6)
        painter.drawText(below, Qt.AlignmentFlag.AlignVCenter, MARK_WORDS[entry.mark])
        painter.restore()


def paint_mark(painter: QPainter, circle: QRectF, mark: str, number: int) -> None:
    """A shape for each verdict, so that colour is not needed to tell them apart."""
    colour = look().colour(TOKENS[mark])
    ground = look().colour("surface")
    painter.setPen(QPen(colour, 1.6))
    painter.setBrush(colour if mark in ("passed", "failed") else Qt.BrushStyle.NoBrush)
    painter.drawEllipse(circle)
    centre, arm = circle.center(), circle.width() / 4.4
    painter.setPen(QPen(ground, 2.2, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap, Qt.PenJoinStyle.RoundJoin))
    if mark == "passed":
        points = [(-arm, 0.1 * arm), (-0.25 * arm, 0.8 * arm), (arm, -0.75 * arm)]
        painter.drawPolyline([centre + QPointF(x, y) for x, y in points])
    elif mark == "failed":
        for sign in (1, -1):
            painter.drawLine(
                centre + QPointF(-0.75 * arm, -0.75 * arm * sign), centre + QPointF(0.75 * arm, 0.75 * arm * sign)
            )
    elif mark == "skipped":
        painter.setPen(QPen(colour, 2.2))
        painter.drawLine(centre + QPointF(-arm, 0), centre + QPointF(arm, 0))
    else:
        painter.setPen(look().colour("quiet"))
        painter.setFont(look().small_font())
        painter.drawText(circle, Qt.AlignmentFlag.AlignCenter, str(number or "…"))  # not at its end
