"""Measures what a dialog cuts: `python -m tests.widgets.form.clipping THEME` prints it for every instruction."""

from __future__ import annotations

import sys
from collections.abc import Iterator

import pytest
from PySide6.QtCore import QPoint, QRect
from PySide6.QtWidgets import (
    QAbstractButton,
    QApplication,
    QComboBox,
    QLabel,
    QLineEdit,
    QListWidget,
    QPlainTextEdit,
    QToolButton,
    QWidget,
)

from codegen.document import Document
from codegen.instructions import ALL, Instruction
from tests.long import is_long
from tests.widgets.form.samples import program
from widgets.form import room
from widgets.form.dialog import InstructionDialog
from widgets.form.offers import Offers, offers_of

MODELS = ("ssc1", "ssc4")
FILLINGS = ("empty", "example")
EVERY = [(model, filling) for model in MODELS for filling in FILLINGS]
FORMS = EVERY if is_long() else [EVERY[0], EVERY[-1]]
PANEL = QRect(0, 0, 1280, 800)  # the least screen of look.md
SIDES = 18  # of a line: border and padding left and right, px
SHOWN = (QLabel, QAbstractButton, QLineEdit, QComboBox, QListWidget, QPlainTextEdit)


def open_dialog(kind: type[Instruction], model: str, filling: str) -> InstructionDialog:
    """The dialog of an instruction on a machine whose axes all have a scale."""
    offers = machine_offers(model)
    instruction = kind.example() if filling == "example" else kind()
    dialog = InstructionDialog(instruction, offers, new=True, where="to Configuration" if kind.section == "C" else "")
    dialog.show()
    settle()
    return dialog


def machine_offers(model: str) -> Offers:
    """What a small program offers on a machine of that model; 637 counts an inch on X, 1000 elsewhere."""
    return offers_of(Document(*program(model)))


def settle() -> None:
    """Lets layouts happen."""
    for _ in range(4):
        QApplication.processEvents()


def cut(dialog: InstructionDialog) -> Iterator[str]:
    """Everything that does not stand whole inside the dialog, in words."""
    for widget in dialog.findChildren(QWidget):
        if isinstance(widget, SHOWN) and widget.isVisible() and widget.window() is dialog:
            for what in (*_outside(widget, dialog), *_pressed(widget)):
                yield f"{type(widget).__name__} “{_words(widget)}” {what}"
    if dialog.form.area.scrolls():
        yield "the fields scroll"
    if not PANEL.adjusted(0, 0, -PANEL.width() * 15 // 100, -PANEL.height() * 15 // 100).contains(
        QRect(QPoint(), dialog.size())
    ):
        yield f"{dialog.width()} x {dialog.height()} is too large for the screen"


def _outside(widget: QWidget, dialog: QWidget) -> Iterator[str]:
    above = widget.parentWidget()
    while above is not None:
        place = QRect(widget.mapTo(above, QPoint()), widget.size())
        if not above.rect().contains(place):
            yield f"at {place.getRect()} leaves {type(above).__name__} {above.size().toTuple()}"
            return
        above = None if above is dialog else above.parentWidget()


def _pressed(widget: QWidget) -> Iterator[str]:
    if isinstance(widget, QToolButton) and isinstance(widget.parentWidget(), QLineEdit):
        return  # a picture inside a line: Qt makes it as large as the line has room
    size, hint = widget.size(), widget.sizeHint()
    if isinstance(widget, QLabel) and widget.wordWrap():
        hint.setWidth(widget.minimumSizeHint().width())  # the longest word
        hint.setHeight(widget.heightForWidth(size.width()))
    elif isinstance(widget, QLineEdit):
        inside = sum(button.width() for button in widget.findChildren(QToolButton))
        words = widget.text() or widget.placeholderText()
        hint.setWidth(widget.fontMetrics().horizontalAdvance(words) + SIDES + inside)
        if isinstance(widget.parentWidget(), QComboBox):
            hint.setHeight(0)  # the list has the frame
    elif isinstance(widget, QListWidget):
        hint.setWidth(widget.sizeHintForColumn(0))
        hint.setHeight(0)  # it scrolls
        size.setWidth(widget.viewport().width())
    elif isinstance(widget, QPlainTextEdit):
        return
    if size.width() < hint.width() or size.height() < hint.height():
        yield f"has {size.toTuple()}, needs {hint.toTuple()}"


def _words(widget: QWidget) -> str:
    text = getattr(widget, "text", None)
    return (text() if callable(text) else "") or widget.accessibleName()


def main(theme: str) -> int:
    """Every dialog in one theme, at the scale this process was started with."""
    from app.theme import Choice, Theme

    application = QApplication([])
    worn = Theme(application, Choice(theme))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(room, "screen_of", lambda widget: PANEL)
        for kind in ALL:
            for model, filling in EVERY if is_long() else EVERY[-1:]:
                dialog = open_dialog(kind, model, filling)
                for what in cut(dialog):
                    print(f"{kind.title}, {model}, {filling}: {what}")
                dialog.reject()
    worn.release()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
