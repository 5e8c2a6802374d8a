"""Inputs and outputs as lamps with their names, which are edited in place."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QGridLayout, QLineEdit, QWidget

from widgets.display.readings import bit
from widgets.parts.lamp import Lamp

COLUMNS = 2
LONGEST = 40  # characters of a name


class Levels(QWidget):
    """A byte of inputs or outputs (`kind`: one of them), one lamp a bit."""

    wanted = Signal(int, bool)  # number, level the person asks for
    renamed = Signal(int, str)  # number, the name the person typed

    def __init__(self, kind: str, height: int | None = None, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._kind, self._height = kind, height
        self.lamps: list[Lamp] = []
        self.names: list[str] = []  # of the lamps there are
        self.editor: NameEditor | None = None  # while a name is edited
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.setHorizontalSpacing(8)
        self._grid.setVerticalSpacing(0)

    def show_names(self, names: Sequence[str]) -> None:
        """One lamp for each name (empty names included)."""
        if list(names) == self.names:
            return
        self._close_editor()
        self.names = list(names)
        while len(self.lamps) > len(names):
            lamp = self.lamps.pop()
            self._grid.removeWidget(lamp)
            lamp.hide()
            lamp.deleteLater()
        while len(self.lamps) < len(names):
            self._add(len(self.lamps) + 1)
        for row, lamp in enumerate(self.lamps):
            rows = (len(names) + COLUMNS - 1) // COLUMNS
            self._grid.addWidget(lamp, row % rows, row // rows)
        for lamp, name in zip(self.lamps, names, strict=True):
            lamp.show_name(name)

    def show_byte(self, value: float, stale: bool) -> None:
        """The byte as TI or OP have it."""
        for lamp in self.lamps:
            lamp.show_level(bit(value, lamp.number), stale)

    def show_switchable(self, switchable: bool, why_not: str = "") -> None:
        """Whether clicks switch."""
        for lamp in self.lamps:
            lamp.show_switchable(switchable, why_not)

    def edit(self, number: int) -> None:
        """An editor over the name of a lamp: Enter or leaving it takes the name, Esc does not."""
        self._close_editor()
        lamp = self.lamps[number - 1]
        self.editor = NameEditor(lamp)
        self.editor.setAccessibleName(f"Name of {self._kind.lower()} {number}")
        self.editor.ended.connect(partial(self._edited, lamp))

    def _edited(self, lamp: Lamp, name: str) -> None:
        self._close_editor()
        if name != lamp.name:
            self.renamed.emit(lamp.number, name)

    def _close_editor(self) -> None:
        editor, self.editor = self.editor, None
        if editor is not None:
            editor.leave()

    def _add(self, number: int) -> None:
        lamp = Lamp(number, height=self._height)
        lamp.show_renamable()
        lamp.wanted.connect(lambda on: self.wanted.emit(number, on))
        lamp.rename_wanted.connect(partial(self.edit, number))
        self.lamps.append(lamp)


class NameEditor(QLineEdit):
    """Over the name of a lamp."""

    ended = Signal(str)  # the name, or the former one after Esc

    def __init__(self, lamp: Lamp) -> None:
        super().__init__(lamp.name, lamp)
        self._lamp, self._open = lamp, True
        self.setPlaceholderText("Name")
        self.setMaxLength(LONGEST)
        self.setStyleSheet("min-height: 0; padding: 0 2px;")
        self.setGeometry(lamp.name_place())
        self.selectAll()
        self.show()
        self.setFocus(Qt.FocusReason.OtherFocusReason)
        self.editingFinished.connect(self._take)

    def leave(self) -> None:
        """Goes; the lamp has the keys again where the editor had them."""
        self._open = False
        if self.hasFocus():
            self._lamp.setFocus(Qt.FocusReason.OtherFocusReason)
        self.hide()
        self.deleteLater()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape:
            self._end(self._lamp.name)
        else:
            super().keyPressEvent(event)
        event.accept()  # the lamp below is a button

    def _take(self) -> None:
        self._end(" ".join(self.text().split()))

    def _end(self, name: str) -> None:
        if self._open:
            self._open = False
            self.ended.emit(name)
