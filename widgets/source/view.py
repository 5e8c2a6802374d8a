"""The generated two-letter code, read only, in step with the program."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from PySide6.QtCore import QEvent, QRect, Qt, Signal
from PySide6.QtGui import QColor, QPaintEvent, QResizeEvent, QTextCursor, QTextFormat
from PySide6.QtWidgets import QPlainTextEdit, QTextEdit, QWidget

from codegen.docs import command_page
from widgets.parts.look import look
from widgets.parts.still import is_still, still
from widgets.source.highlight import Highlighter
from widgets.source.hunks import Hunk, hunks
from widgets.source.margin import Margin


class CodeView(QPlainTextEdit):
    """Lines of code; the user's cursor and the chosen steps light up on both sides."""

    line_chosen = Signal(int)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setReadOnly(True)
        self.setTextInteractionFlags(
            Qt.TextInteractionFlag.TextSelectableByMouse | Qt.TextInteractionFlag.TextSelectableByKeyboard
        )
        self.setUndoRedoEnabled(False)
        self.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.setAccessibleName("Two-letter code")
        self.setPlaceholderText("The two-letter code of your program appears here.")
        self.setProperty("role", "code")
        self.setProperty("helpPage", "Program window")
        self.setMinimumWidth(176)
        self.setFont(look().code_font())
        self.lines: list[str] = []
        self.problem_lines: dict[int, str] = {}
        self.executing: dict[int, int] = {}
        self.chosen: tuple[int, ...] = ()
        self.error_line: int | None = None
        self.highlighter = Highlighter(self.document(), self._sight)
        self.margin = Margin(self)
        self._following = False
        self._held: range | None = None  # the lines in sight, while they change
        self.blockCountChanged.connect(lambda _: self._place_margin())
        self.updateRequest.connect(self._scroll_margin)
        self.verticalScrollBar().valueChanged.connect(self._scrolled)
        self.cursorPositionChanged.connect(self._cursor_moved)
        self._place_margin()

    # ---- what is shown

    def show_lines(self, lines: Sequence[str], problems: Mapping[int, str]) -> None:
        """Shows `lines`; only the lines that differ are replaced, so scrolling and colours stay."""
        new, sight = list(lines), self._sight()
        found = hunks(self.lines, new)
        self._following, self._held = True, sight
        with still(self):
            for hunk in found:
                self._replace(hunk.start, hunk.end, hunk.lines)
                self.lines[hunk.start : hunk.end] = hunk.lines
        self._following, self._held = False, None
        self.lines = new
        for hunk in found:
            self._update(hunk, sight)
        marks = dict(problems)
        if marks != self.problem_lines:
            self.problem_lines = marks
            self.margin.update()
        if found:
            self._paint_extras()

    def show_chosen(self, numbers: Sequence[int], *, scroll: bool = True) -> None:
        """Lights up the lines of the chosen steps and brings the first into view."""
        self.chosen = tuple(numbers)
        self._paint_extras()
        if scroll and self.chosen:
            self._reveal(self.chosen[0])

    def show_executing(self, executing: Mapping[int, int | None], *, follow: bool = False) -> None:
        """Marks the line each thread stands on; `follow` keeps the first of them in sight."""
        now = {thread: line for thread, line in executing.items() if line is not None}
        if now != self.executing:
            self.executing = now
            self._paint_extras()
            if follow and now:
                self._reveal(next(iter(now.values())))

    def show_error(self, line: int | None) -> None:
        """Marks the line the controller stopped on; None clears it."""
        self.error_line = line
        self._paint_extras()
        if line is not None:
            self._reveal(line)

    def threads_at(self, line: int) -> tuple[int, ...]:
        """The threads that stand on a line."""
        return tuple(thread for thread, at in self.executing.items() if at == line)

    # ---- margin

    def margin_width(self) -> int:
        """Room for the line number and one mark."""
        return self.fontMetrics().horizontalAdvance("0000") + 28

    def visible_lines(self) -> Iterator[tuple[int, float, float]]:
        """Number, top and height of each line on the screen."""
        block = self.firstVisibleBlock()
        top = self.blockBoundingGeometry(block).translated(self.contentOffset()).top()
        number, bottom, count = block.blockNumber(), self.viewport().height(), len(self.lines)
        while block.isValid() and top <= bottom:
            height = self.blockBoundingRect(block).height()
            if number < count:
                yield number, top, height
            top += height
            number += 1
            block = block.next()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keeps the margin beside the text."""
        super().resizeEvent(event)
        self._place_margin()

    def paintEvent(self, event: QPaintEvent) -> None:
        """What comes into sight gets its colours now."""
        self._scrolled()
        super().paintEvent(event)

    def _scrolled(self) -> None:
        self.highlighter.colour(self.firstVisibleBlock(), self._sight().stop)

    def _sight(self) -> range:
        """The lines on the screen, and one that is cut off; they are all equally high."""
        if self._held is not None:
            return self._held
        first = self.firstVisibleBlock().blockNumber()
        return range(first, first + self.viewport().height() // max(1, self.fontMetrics().lineSpacing()) + 2)

    def changeEvent(self, event: QEvent) -> None:
        """Takes the colours of a changed theme."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and hasattr(self, "margin"):
            self.highlighter.recolour()
            self._paint_extras()

    # ---- inside

    def _update(self, hunk: Hunk, sight: range) -> None:
        """Paints what a change touched: those lines, or all from there on where others moved up or down."""
        if hunk.start >= sight.stop:
            return
        moved = hunk.end - hunk.start != len(hunk.lines)
        if hunk.end < sight.start and not moved:
            return
        shown = list(self.visible_lines())
        top = next((top for number, top, _ in shown if number >= hunk.start), 0.0)
        end = self.viewport().height() if moved else next((top for number, top, _ in shown if number >= hunk.end), 1e6)
        self.viewport().update(0, int(top), self.viewport().width(), int(min(end, self.viewport().height()) - top) + 1)
        if moved:
            self.margin.update()

    def _replace(self, first: int, end: int, lines: Sequence[str]) -> None:
        """Replaces the shown lines `first` … `end` (exclusive)."""
        cursor = QTextCursor(self.document())
        cursor.beginEditBlock()
        if first == 0 and end >= len(self.lines):
            cursor.select(QTextCursor.SelectionType.Document)
            cursor.insertText("\n".join(lines))
        elif end >= len(self.lines):
            cursor.setPosition(self.document().findBlockByNumber(first - 1).position())
            cursor.movePosition(QTextCursor.MoveOperation.EndOfBlock)
            cursor.movePosition(QTextCursor.MoveOperation.End, QTextCursor.MoveMode.KeepAnchor)
            cursor.insertText("".join("\n" + line for line in lines))
        else:
            cursor.setPosition(self.document().findBlockByNumber(first).position())
            after = self.document().findBlockByNumber(end).position()
            cursor.setPosition(after, QTextCursor.MoveMode.KeepAnchor)
            cursor.insertText("".join(line + "\n" for line in lines))
        cursor.endEditBlock()

    def help_page(self) -> str:
        """Of the command at the cursor."""
        cursor = self.textCursor()
        return command_page(cursor.block().text(), cursor.positionInBlock())

    def _cursor_moved(self) -> None:
        if not self._following:
            self.line_chosen.emit(self.textCursor().blockNumber())

    def _reveal(self, number: int) -> None:
        block = self.document().findBlockByNumber(number)
        if not block.isValid() or block.blockNumber() == self.textCursor().blockNumber():
            return
        self._following = True
        cursor = QTextCursor(block)
        self.setTextCursor(cursor)
        self.ensureCursorVisible()
        self._following = False

    def _paint_extras(self) -> None:
        tints = [(number, "selection", 255) for number in self.chosen]
        tints += [(number, "executing", 255) for number in self.executing.values()]
        if self.error_line is not None:
            tints.append((self.error_line, "fault", 60))
        tints = [tint for tint in tints if tint[0] < len(self.lines)]
        if tints or self.extraSelections():
            self.setExtraSelections([self._tint(*tint) for tint in tints])
            self.margin.update()

    def _tint(self, number: int, token: str, strength: int) -> QTextEdit.ExtraSelection:
        selection = QTextEdit.ExtraSelection()
        colour = QColor(look().colour(token))
        colour.setAlpha(strength)
        selection.format.setBackground(colour)
        selection.format.setProperty(QTextFormat.Property.FullWidthSelection, True)
        selection.cursor = QTextCursor(self.document().findBlockByNumber(number))
        return selection

    def _place_margin(self) -> None:
        width = self.margin_width()
        if self.viewportMargins().left() != width:
            self.setViewportMargins(width, 0, 0, 0)
        inside = self.contentsRect()
        self.margin.setGeometry(QRect(inside.left(), inside.top(), width, inside.height()))

    def _scroll_margin(self, rect: QRect, dy: int) -> None:
        if dy:
            self.margin.scroll(0, dy)
        elif not is_still(self):
            self.margin.update(0, rect.y(), self.margin.width(), rect.height())
