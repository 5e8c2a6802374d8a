"""The line two-letter commands are typed into: earlier lines, what fits here, and what the command takes."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, Qt, Signal
from PySide6.QtGui import QFocusEvent, QHideEvent, QKeyEvent
from PySide6.QtWidgets import QLineEdit, QWidget

from codegen.docs import command_page
from codegen.models import MODELS, Model
from widgets.parts.offer import Offer, begun

if TYPE_CHECKING:  # what fits is looked up when something is typed
    from codegen.twoletter.complete import Candidate, Names, ParameterHelp

MOST_EARLIER = 500  # lines


class CommandLine(QLineEdit):
    """Enter sends `typed`, Tab takes what is marked in the list; arrows walk in it, or else through earlier lines."""

    typed = Signal(str)
    help_changed = Signal(str)  # rich text about the command at the cursor, or nothing

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.model: Model = MODELS["ssc4"]
        self.names: Names | None = None
        self._earlier: list[str] = []
        self._at = 0
        self.offer = Offer(self)
        self.offer.taken.connect(self._take)
        self.textEdited.connect(lambda _: self._look())
        self.cursorPositionChanged.connect(lambda *_: self._tell())

    def show_names(self, model: Model | None, names: Names) -> None:
        """The controller's model, and the names its program uses."""
        self.model, self.names = model or self.model, names

    def help_page(self) -> str:
        """Of the command at the cursor."""
        return command_page(self.text(), self.cursorPosition())

    @property
    def offered(self) -> list[str]:
        """What the list shows; empty when there is none."""
        return self.offer.texts

    def remember(self, texts: Iterable[str]) -> None:
        """Lines of earlier sessions."""
        self._earlier = list(texts)[-MOST_EARLIER:]
        self._at = len(self._earlier)

    @property
    def earlier(self) -> list[str]:
        """All lines that were sent, oldest first."""
        return list(self._earlier)

    # ---- keys

    def event(self, event: object) -> bool:
        """Tab would leave the line before `keyPressEvent` sees it."""
        if isinstance(event, QKeyEvent) and event.type() == QKeyEvent.Type.KeyPress and self._key(event):
            return True
        return bool(super().event(event))  # type: ignore[arg-type]

    def _key(self, event: QKeyEvent) -> bool:
        key, listed = Qt.Key(event.key()), self.offer.isVisible()
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.send()
        elif key == Qt.Key.Key_Tab and listed and not event.modifiers() and self.offer.chosen is not None:
            self._take(self.offer.chosen)
        elif key == Qt.Key.Key_Escape and listed:
            self.offer.hide()
        elif key == Qt.Key.Key_Space and event.modifiers() == Qt.KeyboardModifier.ControlModifier:
            self._look(always=True)
        elif key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            step = -1 if key == Qt.Key.Key_Up else 1
            self.offer.walk(step) if listed else self._recall(step)
        else:
            return False
        return True

    def _recall(self, step: int) -> None:
        if self._earlier:
            self._at = min(max(0, self._at + step), len(self._earlier))
            self.setText(self._earlier[self._at] if self._at < len(self._earlier) else "")

    def send(self) -> None:
        """What stands in the line goes out."""
        text = self.text().strip()
        self.offer.hide()
        if text:
            if self._earlier[-1:] != [text]:
                self._earlier = [*self._earlier, text][-MOST_EARLIER:]
            self._at = len(self._earlier)
            self.clear()
            self.typed.emit(text)

    # ---- what fits

    def _look(self, always: bool = False) -> None:
        """While a word is typed; on Ctrl+Space also where none has begun."""
        from codegen.twoletter.complete import complete

        column = self.cursorPosition()
        wanted = always or begun(self.text(), column)
        found = complete(self.text(), column, self.model, self.names) if wanted else []
        corner = self.mapToGlobal(QPoint(0, 0))
        self.offer.show_at(found, corner, corner + QPoint(0, self.height()))

    def _take(self, each: Candidate) -> None:
        text = self.text()
        self.setText(text[: each.start] + each.text + text[each.end :])
        self.setCursorPosition(each.start + len(each.text))
        self.offer.hide()

    def _tell(self) -> None:
        if not self.text():
            self.help_changed.emit("")
            return
        from codegen.twoletter.complete import parameter_help

        found = parameter_help(self.text(), self.cursorPosition(), self.model)
        self.help_changed.emit(words_of(found) if found is not None else "")

    def focusOutEvent(self, event: QFocusEvent) -> None:
        self.offer.hide()
        super().focusOutEvent(event)

    def hideEvent(self, event: QHideEvent) -> None:
        self.offer.hide()
        super().hideEvent(event)


def words_of(found: ParameterHelp) -> str:
    """The command in one line of rich text, the parameter at the cursor in bold."""
    from html import escape

    parts = []
    for place, each in enumerate(found.parameters):
        words = escape(" ".join(filter(None, (each.name, each.range))))
        parts.append(f"<b>{words}</b>" if place == found.current else words)
    takes = "; ".join(parts)
    return f"<b>{escape(found.command)}</b> {escape(found.title)}. {takes or escape(found.help)}"
