"""The line two-letter commands are typed into: earlier lines, what fits here, and what the command takes."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape

from PySide6.QtCore import QPoint, Qt, Signal
from PySide6.QtGui import QFocusEvent, QHideEvent, QKeyEvent
from PySide6.QtWidgets import QLineEdit, QListWidget, QListWidgetItem, QWidget

from codegen.docs import command_page
from codegen.models import MODELS, Model
from codegen.twoletter.complete import Candidate, Names, ParameterHelp, complete, parameter_help
from widgets.parts.look import look

MOST_EARLIER = 500  # lines
ROWS, WIDTH = 8, 420  # of the list of what fits; px


class CommandLine(QLineEdit):
    """Enter sends `typed`, Tab takes what is marked in the list; arrows walk in it, or else through earlier lines."""

    typed = Signal(str)
    help_changed = Signal(str)  # rich text about the command at the cursor, or nothing

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.model: Model = MODELS["ssc4"]
        self.names = Names()
        self._earlier: list[str] = []
        self._at = 0
        self._found: list[Candidate] = []
        self.offer = QListWidget(self)
        self.offer.setWindowFlags(Qt.WindowType.ToolTip | Qt.WindowType.FramelessWindowHint)
        self.offer.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.offer.setAttribute(Qt.WidgetAttribute.WA_ShowWithoutActivating)
        self.offer.setAccessibleName("What fits here")
        self.offer.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.offer.itemClicked.connect(lambda item: self._take(self.offer.row(item)))
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
        return [each.text for each in self._found] if self.offer.isVisible() else []

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
        elif key == Qt.Key.Key_Tab and listed and not event.modifiers():
            self._take(max(self.offer.currentRow(), 0))
        elif key == Qt.Key.Key_Escape and listed:
            self.offer.hide()
        elif key == Qt.Key.Key_Space and event.modifiers() == Qt.KeyboardModifier.ControlModifier:
            self._look(always=True)
        elif key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            step = -1 if key == Qt.Key.Key_Up else 1
            self._walk(step) if listed else self._recall(step)
        else:
            return False
        return True

    def _walk(self, step: int) -> None:
        self.offer.setCurrentRow((self.offer.currentRow() + step) % len(self._found))

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
        column = self.cursorPosition()
        begun = column > 0 and (self.text()[column - 1].isalnum() or self.text()[column - 1] in "_@#")
        self._found = complete(self.text(), column, self.model, self.names) if begun or always else []
        if not self._found:
            self.offer.hide()
            return
        self.offer.clear()
        for each in self._found:
            item = QListWidgetItem(f"{each.text}    {each.title}")
            item.setToolTip(each.help)
            self.offer.addItem(item)
        self.offer.setFont(look().code_font())
        height = self.offer.sizeHintForRow(0) * min(len(self._found), ROWS) + 2 * self.offer.frameWidth()
        self.offer.resize(WIDTH, height)
        corner = self.mapToGlobal(QPoint(0, 0))
        below = corner.y() + self.height()
        room = self.screen().availableGeometry().bottom() - below
        self.offer.move(corner.x(), below if room > height else corner.y() - height)
        self.offer.setCurrentRow(0)
        self.offer.show()

    def _take(self, row: int) -> None:
        each = self._found[row]
        text = self.text()
        self.setText(text[: each.start] + each.text + text[each.end :])
        self.setCursorPosition(each.start + len(each.text))
        self.offer.hide()

    def _tell(self) -> None:
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
    parts = []
    for place, each in enumerate(found.parameters):
        words = escape(" ".join(filter(None, (each.name, each.range))))
        parts.append(f"<b>{words}</b>" if place == found.current else words)
    takes = "; ".join(parts)
    return f"<b>{escape(found.command)}</b> {escape(found.title)}. {takes or escape(found.help)}"
