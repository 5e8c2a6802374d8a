"""The small list of what fits where somebody types; it never takes the focus."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, Qt, Signal
from PySide6.QtWidgets import QListWidget, QListWidgetItem, QWidget

from widgets.parts.look import look

if TYPE_CHECKING:
    from codegen.twoletter.complete import Candidate

ROWS, WIDTH = 8, 420  # px


class Offer(QListWidget):
    """Shown below (or above) the cursor of its owner; `taken` when a row is clicked."""

    taken = Signal(object)  # Candidate

    def __init__(self, owner: QWidget) -> None:
        super().__init__(owner)
        self.found: list[Candidate] = []
        self.setWindowFlags(Qt.WindowType.ToolTip | Qt.WindowType.FramelessWindowHint)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_ShowWithoutActivating)
        self.setAccessibleName("What fits here")
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.itemClicked.connect(lambda item: self.taken.emit(self.found[self.row(item)]))

    @property
    def texts(self) -> list[str]:
        """What it shows; empty when it is not there."""
        return [each.text for each in self.found] if self.isVisible() else []

    @property
    def chosen(self) -> Candidate | None:
        """The marked one."""
        row = self.currentRow()
        return self.found[row] if 0 <= row < len(self.found) else None

    def show_at(self, found: Sequence[Candidate], top: QPoint, bottom: QPoint) -> None:
        """Below `bottom`, or above `top` where there is no room; global places. Nothing found: it goes."""
        self.found = list(found)
        if not self.found:
            self.hide()
            return
        self.clear()
        for each in self.found:
            item = QListWidgetItem(f"{each.text}    {each.title}")
            item.setToolTip(each.help)
            self.addItem(item)
        self.setFont(look().code_font())
        height = self.sizeHintForRow(0) * min(len(self.found), ROWS) + 2 * self.frameWidth()
        self.resize(WIDTH, height)
        room = self.screen().availableGeometry().bottom() - bottom.y()
        self.move(bottom if room > height else QPoint(top.x(), top.y() - height))
        self.setCurrentRow(0)
        self.show()

    def walk(self, step: int) -> None:
        """The next one, around."""
        self.setCurrentRow((self.currentRow() + step) % len(self.found))


def begun(text: str, column: int) -> bool:
    """Whether a word has begun at the column, so that it is time to offer."""
    return column > 0 and (text[column - 1].isalnum() or text[column - 1] in "_@#")
