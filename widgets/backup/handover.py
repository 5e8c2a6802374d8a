"""Author, revision and change notes of the open program, and the line that goes into the controller with it."""

from __future__ import annotations

import dataclasses as dc

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QDialog,
    QFormLayout,
    QLabel,
    QLineEdit,
    QPlainTextEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from codegen.document import Document
from codegen.handover import Handover, first_line
from codegen.models import MODELS
from widgets.panel import set_text
from widgets.parts.foot import foot
from widgets.parts.look import look

WITHOUT = "Without a revision the code carries no comment: nobody can tell from the controller which program it runs."
NO_DATE = "Write the date as 2026-11-22; otherwise it is left out."


class HandoverPage(QDialog):
    """Not modal; every change is one of the document and can be undone."""

    edited = Signal(object)  # Handover
    pack_wanted = Signal()

    def __init__(self, today: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Handover")
        self.setProperty("helpPage", "Handover")
        self.setModal(False)
        self._today, self._handover = today, Handover()
        self.author, self.revision, self.date = (
            _line("Author", "Who is responsible for it"),
            _line("Revision", "For example C, or 1.2"),
            _line("Date of the revision", "2026-11-22"),
        )
        self.changes = QPlainTextEdit()
        self.changes.setAccessibleName("Change notes")
        self.changes.setPlaceholderText("One line for each revision: what was changed and why")
        self.changes.setTabChangesFocus(True)
        self.line = QLabel()
        self.line.setFont(look().code_font())
        self.line.setProperty("role", "code")
        self.words = QLabel()
        self.words.setWordWrap(True)
        self.words.setProperty("role", "quiet")
        self.pack, self.shut = QPushButton("Handover pack…"), QPushButton("Close")
        self.pack.setToolTip("Program, code, setup, names, limits, gains and a checklist: preview and PDF")
        for button, call in ((self.pack, self.pack_wanted.emit), (self.shut, self.accept)):
            button.setAutoDefault(False)
            button.setMinimumHeight(look().control)
            button.clicked.connect(lambda _=False, call=call: call())
        for edit in (self.author, self.revision, self.date):
            edit.textEdited.connect(lambda _: self._edited())
        self.changes.textChanged.connect(self._edited)
        self._lay_out()
        self.resize(560, 440)

    def show_document(self, document: Document) -> None:
        """What the document says; what is being typed stays."""
        handover, model = document.handover, MODELS.get(document.setup.model)
        self._handover = handover
        for edit, text in (
            (self.author, handover.author),
            (self.revision, handover.revision),
            (self.date, handover.date),
        ):
            if edit.text() != text:
                edit.setText(text)
        if self.changes.toPlainText() != handover.changes:
            self.changes.blockSignals(True)
            self.changes.setPlainText(handover.changes)
            self.changes.blockSignals(False)
        line = first_line(handover, document.program.name, model) if model is not None and model.columns else ""
        set_text(self.line, line)
        set_text(self.words, self._about(handover, line))

    def _about(self, handover: Handover, line: str) -> str:
        if not line:
            return WITHOUT
        if handover.date and handover.date not in line:
            return f"{NO_DATE} It may also be that the line is full: this controller takes no more."
        if handover.author and ", by " not in line:
            return "The author does not fit into a line of this controller and is left out there."
        return "The first line of the code; it is downloaded, burned, and read back when somebody connects."

    def _edited(self) -> None:
        revision, date = self.revision.text(), self.date.text()
        if revision != self._handover.revision and date == self._handover.date:
            date = self._today
        new = Handover(self.author.text(), revision, date, self.changes.toPlainText())
        if new != self._handover:
            self._handover = dc.replace(new)
            self.edited.emit(new)

    def _lay_out(self) -> None:
        form = QFormLayout()
        form.setHorizontalSpacing(16)
        form.setVerticalSpacing(8)
        for name, widget in (
            ("Author", self.author),
            ("Revision", self.revision),
            ("Date", self.date),
            ("Changes", self.changes),
            ("In the code", self.line),
        ):
            form.addRow(name, widget)
        column = QVBoxLayout(self)
        column.setContentsMargins(24, 16, 24, 16)
        column.setSpacing(12)
        column.addLayout(form)
        column.addWidget(self.words)
        column.addWidget(foot(away=self.shut, left=(self.pack,)))


def _line(name: str, hint: str) -> QLineEdit:
    line = QLineEdit()
    line.setAccessibleName(name)
    line.setPlaceholderText(hint)
    line.setMinimumHeight(look().control)
    return line
