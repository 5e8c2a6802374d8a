"""The text of the editor: colours, line numbers, problems at their lines, completion while typing."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QEvent, Qt, QTimer, Signal
from PySide6.QtGui import QFocusEvent, QHideEvent, QKeyEvent, QTextCursor
from PySide6.QtWidgets import QWidget

from codegen.models import MODELS, Model
from codegen.twoletter.complete import Candidate, Names, complete, parameter_help
from codegen.twoletter.problems import Problem
from widgets.parts.offer import Offer, begun
from widgets.source.view import CodeView
from widgets.terminal.command_line import words_of

PAUSE_MS = 200  # after the last key, before it is checked


class EditorText(CodeView):
    """Asks for a check a moment after each change; lines count from 0 as the controller does."""

    check_wanted = Signal(str, object)  # the text, the Model
    help_changed = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setReadOnly(False)
        self.setTextInteractionFlags(Qt.TextInteractionFlag.TextEditorInteraction)
        self.setUndoRedoEnabled(True)
        self.setAccessibleName("Two-letter code to edit")
        self.setPlaceholderText("Write two-letter code here, open a file, or read the controller's program.")
        self.setProperty("helpPage", "Code editor")
        self.setTabChangesFocus(True)
        self.model: Model = MODELS["ssc4"]
        self.problems: Sequence[Problem] = ()
        self.names = Names()
        self.offer = Offer(self)
        self.offer.taken.connect(self._take)
        self._pause = QTimer(self, singleShot=True, interval=PAUSE_MS)
        self._pause.timeout.connect(self.check_now)
        self.textChanged.connect(self._changed)
        self.cursorPositionChanged.connect(self._tell)

    def show_model(self, model: Model) -> None:
        """The controller the code is for."""
        if model.name != self.model.name:
            self.model = model
            self.check_now()

    def labels(self) -> list[tuple[str, int]]:
        """Labels with their lines."""
        return [(text.split(";")[0].strip(), line) for line, text in enumerate(self.lines) if text.startswith("#")]

    def go_to(self, line: int) -> None:
        """The cursor at the beginning of a line, the line in sight."""
        block = self.document().findBlockByNumber(line)
        if block.isValid():
            self.setTextCursor(QTextCursor(block))
            self.centerCursor()
            self.setFocus(Qt.FocusReason.OtherFocusReason)

    def check_now(self) -> None:
        """Asks for the check without waiting for a pause."""
        self._pause.stop()
        text = self.toPlainText()
        self.lines = text.split("\n")
        self.check_wanted.emit(text, self.model)

    def show_checked(self, names: Names, problems: Sequence[Problem]) -> None:
        """What was found in the text as it is."""
        self.names, self.problems = names, problems
        self.problem_lines = {problem.line: problem.message for problem in reversed(problems)}
        self.margin.update()

    # ---- typing

    def event(self, event: QEvent) -> bool:
        """Tab would leave the text before `keyPressEvent` sees it."""
        tab = isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress and event.key() == Qt.Key.Key_Tab
        if tab and self.offer.isVisible() and self.offer.chosen is not None:
            self._take(self.offer.chosen)
            return True
        return bool(super().event(event))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """The list of what fits takes Tab, Escape and the arrows while it is there."""
        key, listed = Qt.Key(event.key()), self.offer.isVisible()
        if listed and key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            self.offer.walk(-1 if key == Qt.Key.Key_Up else 1)
        elif listed and key == Qt.Key.Key_Escape:
            self.offer.hide()
        elif key == Qt.Key.Key_Space and event.modifiers() == Qt.KeyboardModifier.ControlModifier:
            self._look(always=True)
        else:
            super().keyPressEvent(event)
            if (event.text().isprintable() and event.text()) or key == Qt.Key.Key_Backspace:
                self._look()
            else:
                self.offer.hide()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        self.offer.hide()
        super().focusOutEvent(event)

    def hideEvent(self, event: QHideEvent) -> None:
        self.offer.hide()
        super().hideEvent(event)

    def _look(self, always: bool = False) -> None:
        cursor = self.textCursor()
        text, column = cursor.block().text(), cursor.positionInBlock()
        wanted = always or begun(text, column)
        found = complete(text, column, self.model, self.names) if wanted else []
        place = self.cursorRect()
        top, bottom = (self.viewport().mapToGlobal(each) for each in (place.topLeft(), place.bottomLeft()))
        self.offer.show_at(found, top, bottom)

    def _take(self, each: Candidate) -> None:
        cursor = self.textCursor()
        start = cursor.block().position()
        cursor.setPosition(start + each.start)
        cursor.setPosition(start + each.end, QTextCursor.MoveMode.KeepAnchor)
        cursor.insertText(each.text)
        self.setTextCursor(cursor)
        self.offer.hide()

    def _changed(self) -> None:
        self.lines = self.toPlainText().split("\n")
        self.margin.update()
        self._pause.start()

    def _tell(self) -> None:
        cursor = self.textCursor()
        found = parameter_help(cursor.block().text(), cursor.positionInBlock(), self.model)
        self.help_changed.emit(words_of(found) if found is not None else "")
