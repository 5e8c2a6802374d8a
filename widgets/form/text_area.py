"""Several lines: texts, and two-letter code."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QPlainTextEdit, QWidget

from codegen import fields
from codegen.docs import command_page
from widgets.form.offers import Offers
from widgets.parts.look import look


class TextArea(QPlainTextEdit):
    """Several lines of text or code."""

    changed = Signal(object)

    def __init__(self, field: fields.Field, offers: Offers, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTabChangesFocus(True)
        self.setMinimumHeight(look().control * 3)
        self.setMaximumHeight(look().control * 5)
        self.setMinimumWidth(240)
        if isinstance(field, fields.Code):
            self.setFont(look().code_font())
            self.setFixedHeight(look().control * 7)
        self.textChanged.connect(lambda: self.changed.emit(self.toPlainText()))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Ctrl+Enter belongs to the dialog."""
        if (
            event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter)
            and event.modifiers() & Qt.KeyboardModifier.ControlModifier
        ):
            event.ignore()
            return
        super().keyPressEvent(event)

    def value(self) -> str:
        return self.toPlainText()

    def setValue(self, value: Any) -> None:
        if value != self.toPlainText():
            self.blockSignals(True)
            self.setPlainText(value)
            self.blockSignals(False)


class CodeArea(TextArea):
    """Two-letter code; help is that of the command at the cursor."""

    def help_page(self) -> str:
        """Empty where no command is: then it is the field's."""
        cursor = self.textCursor()
        return command_page(cursor.block().text(), cursor.positionInBlock())
