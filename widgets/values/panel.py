"""Variables and arrays: names, values, one array as a picture; edited in Control, kept as recipes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QAction, QKeySequence, QShowEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QLineEdit,
    QPushButton,
    QSizePolicy,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from device.api import Kind, State
from widgets.panel import Panel, set_text, show_role
from widgets.parts.look import look
from widgets.parts.wrapping import WrappingRow

if TYPE_CHECKING:
    from device.api import Row
    from widgets.parts.plot import Plot

OFFLINE = "Nothing is connected. Connect a controller or start the simulator to see its variables and arrays."
WATCHED = "This is Watch: switch to Control to change a value."
NONE_THERE = "The controller knows no variable and no array yet: execute a program that uses some, or add a name."
COLUMNS = ("Name", "Value", "As text", "In the recipe")
ARRAY_COLUMNS = ("Element", "Value", "In the recipe")
NAME, VALUE, LETTERS, RECIPE = range(4)
PICTURE, ROWS = 72, 46  # px: an array and its elements in a low dock
LEAST = 186  # px of both tables: the buttons above take a second line of it where the dock is narrow
NAME_WIDTH = 136  # px
REPEAT_TICKS = 30  # about a second


class ValuesPanel(Panel):
    """Shows what it is handed; asks by signals."""

    title = "Variables"
    moves = True
    names_wanted = Signal()
    values_wanted = Signal(object)  # names
    array_wanted = Signal(str)
    set_wanted = Signal(str, str)  # variable or element, typed text
    name_added = Signal(str)
    name_forgotten = Signal(str)
    recipe_load_wanted = Signal()
    recipe_save_wanted = Signal()
    recipe_send_wanted = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.names: tuple[str, ...] = ()
        self.arrays: tuple[str, ...] = ()
        self.recipe: Mapping[str, str] = {}
        self.plot: Plot | None = None
        self._shown: dict[str, str] = {}
        self._array, self._numbers = "", list[str]()  # the array that is shown, as far as it was read
        self._ticks = 0
        self._filling = False
        self.read, self.keep = QPushButton("Read"), QCheckBox("Keep reading")
        self.load, self.save, self.send = (
            QPushButton("Open recipe…"),
            QPushButton("Save recipe…"),
            QPushButton("Send recipe"),
        )
        self.new, self.add, self.forget = QLineEdit(), QPushButton("Add name"), QAction("Forget this name", self)
        self.table, self.elements = QTableWidget(0, len(COLUMNS)), QTableWidget(0, len(ARRAY_COLUMNS))
        self.chosen, self.words_, self.empty = QLabel(), QLabel(), QLabel(OFFLINE)
        self._lay_out()
        self.read.clicked.connect(self.names_wanted)
        self.load.clicked.connect(self.recipe_load_wanted)
        self.save.clicked.connect(self.recipe_save_wanted)
        self.send.clicked.connect(self.recipe_send_wanted)
        self.new.returnPressed.connect(self.add.click)
        self.add.clicked.connect(lambda: self.name_added.emit(self.new.text()))
        self.forget.triggered.connect(
            lambda: self.name_forgotten.emit(self._name(self.table.currentRow()).replace(" ", ""))
        )
        self.table.cellChanged.connect(self._edited)
        self.table.currentCellChanged.connect(self._chosen)
        self.elements.cellChanged.connect(self._element_edited)

    # ---- what it shows

    def show_controller(self) -> None:
        self.show_names((), ())
        self._show_usable()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        if not self.names and not self.arrays and self._linked:
            self.names_wanted.emit()

    def refresh(self, row: Row) -> None:
        self._show_usable()
        self._ticks += 1
        if self.keep.isChecked() and self.names and self._ticks % REPEAT_TICKS == 0:
            self.values_wanted.emit(self.names)

    def show_names(self, names: Sequence[str], arrays: Sequence[str]) -> None:
        """Which variables and arrays there are; values come after."""
        self.names, self.arrays = tuple(names), tuple(arrays)
        self._shown = {}
        self._filling = True
        self.table.setRowCount(0)
        for name in (*sorted(self.names), *(f"{name}[ ]" for name in sorted(self.arrays))):
            self._add(name)
        self._filling = False
        self._show_recipe()
        self.show_elements("", ())
        self.say(NONE_THERE if self._linked and not (names or arrays) else "")

    def show_values(self, values: Mapping[str, tuple[str, str]]) -> None:
        """Number and letters of variables; what has changed since last time is bold."""
        self._filling = True
        for row in range(self.table.rowCount()):
            name = self._name(row)
            if name not in values:
                continue
            number, letters = values[name]
            item = self.table.item(row, VALUE)
            assert item is not None
            font = item.font()
            font.setBold(name in self._shown and self._shown[name] != number)
            item.setFont(font)
            item.setText(number)
            self._put(row, LETTERS, f'"{letters}"' if letters else "")
            self._shown[name] = number
        self._filling = False
        self._show_recipe()

    def show_elements(self, name: str, values: Sequence[str], first: int = 0, total: int = 0) -> None:
        """Elements of one array from `first` on, as a list and as a picture; `total`: so many it has."""
        self._filling = True
        if not first:
            self._numbers = []
        self._numbers += values
        self.elements.setRowCount(len(self._numbers))
        for place, text in enumerate(values, start=first):
            number = QTableWidgetItem(f"{name}[{place}]")
            number.setFlags(number.flags() & ~Qt.ItemFlag.ItemIsEditable)
            self.elements.setItem(place, 0, number)
            self.elements.setItem(place, 1, QTableWidgetItem(text))
        self._filling = False
        self._array = name
        set_text(self.chosen, f"{name}, {total or len(values)} elements" if name else "")
        self._right.setVisible(bool(name))
        self._show_recipe(first)
        if name:
            self._draw(name, self._numbers)

    def show_element(self, name: str, text: str) -> None:
        """One element as it was read again."""
        array, bracket, place = name.partition("[")
        row = int(place.rstrip("]")) if bracket and place.rstrip("]").isdecimal() else -1
        if array == self._array and 0 <= row < len(self._numbers):
            self._numbers[row] = text
            self._filling = True
            item = self.elements.item(row, 1)
            if item is not None:
                item.setText(text)
            self._filling = False
            self._show_recipe(row)
            self._draw(array, self._numbers)

    def show_recipe(self, recipe: Mapping[str, str]) -> None:
        """What a recipe holds, beside what the controller holds."""
        self.recipe = dict(recipe)
        self._filling = True
        there = {self._name(row) for row in range(self.table.rowCount())}
        for name in recipe:
            shown = f"{name.partition('[')[0]}[ ]" if "[" in name else name
            if shown not in there:
                there.add(shown)
                self._add(shown)
        self._filling = False
        self._show_recipe()
        self._show_usable()

    def say(self, sentence: str, good: bool = True) -> None:
        """One sentence below the tables."""
        set_text(self.words_, sentence)
        show_role(self.words_, "quiet" if good else "problem")

    def words(self) -> str:
        """What it says and shows, as text."""
        if self.empty.isVisibleTo(self):
            return self.empty.text()
        rows = [
            " ".join(filter(None, (self._text(row, column) for column in range(len(COLUMNS)))))
            for row in range(self.table.rowCount())
        ]
        return "\n".join([*rows, self.words_.text()])

    # ---- inside

    @property
    def _linked(self) -> bool:
        return self.controller is not None and self.controller.kind is not Kind.OFFLINE

    def _name(self, row: int) -> str:
        return self._text(row, NAME)

    def _text(self, row: int, column: int) -> str:
        item = self.table.item(row, column)
        return item.text() if item is not None else ""

    def _put(self, row: int, column: int, text: str) -> None:
        item = self.table.item(row, column)
        if item is not None and item.text() != text:
            item.setText(text)

    def _add(self, name: str) -> None:
        row = self.table.rowCount()
        self.table.insertRow(row)
        for column in range(len(COLUMNS)):
            item = QTableWidgetItem(name if column == NAME else "")
            if column != VALUE or name.endswith("]"):
                item.setFlags(item.flags() & ~Qt.ItemFlag.ItemIsEditable)
            self.table.setItem(row, column, item)

    def _show_recipe(self, first: int = 0) -> None:
        """What the recipe has for each name, and for the elements from `first` on; ≠ where it differs."""
        self._filling = True
        self.table.setColumnHidden(RECIPE, not self.recipe)
        sizes = Counter(name.partition("[")[0] for name in self.recipe if "[" in name)
        for row in range(self.table.rowCount()):
            name = self._name(row)
            wanted = self.recipe.get(name, "")
            words = f"≠ {wanted}" if wanted and wanted != self._text(row, VALUE) else wanted
            array = name.removesuffix("[ ]")
            self._put(row, RECIPE, self._array_words(array, sizes[array]) if array != name and sizes[array] else words)
        self.elements.setColumnHidden(2, not sizes[self._array])
        for row in range(first, self.elements.rowCount() if sizes[self._array] else 0):
            wanted = self.recipe.get(f"{self._array}[{row}]", "")
            item = QTableWidgetItem(f"≠ {wanted}" if wanted and wanted != self._numbers[row] else wanted)
            item.setFlags(item.flags() & ~Qt.ItemFlag.ItemIsEditable)
            self.elements.setItem(row, 2, item)
        self._filling = False

    def _array_words(self, name: str, count: int) -> str:
        """How many elements, and how many differ where they are known."""
        if name != self._array:
            return f"{count} elements"
        wanted = [self.recipe.get(f"{name}[{row}]", "") for row in range(len(self._numbers))]
        wrong = sum(bool(text) and text != there for text, there in zip(wanted, self._numbers, strict=True))
        return f"≠ {wrong} of {count} elements" if wrong else f"{count} elements"

    def _edited(self, row: int, column: int) -> None:
        if self._filling or column != VALUE:
            return
        name, text = self._name(row), self._text(row, VALUE)
        self._filling = True
        self._put(row, VALUE, self._shown.get(name, ""))  # the value comes back from the controller
        self._filling = False
        self.set_wanted.emit(name, text)

    def _element_edited(self, row: int, column: int) -> None:
        item, name = self.elements.item(row, column), self.elements.item(row, 0)
        if not self._filling and column == 1 and item is not None and name is not None:
            self.set_wanted.emit(name.text(), item.text())

    def _chosen(self, row: int, *_: int) -> None:
        name = self._name(row)
        if name.endswith("[ ]"):
            self.array_wanted.emit(name[:-3])

    def _show_usable(self) -> None:
        linked = self._linked
        if self.empty.isVisibleTo(self) == linked:
            self.empty.setVisible(not linked)
            self._inside.setVisible(linked)
        controller = self.controller
        ready = linked and controller is not None and controller.state is State.READY
        control = ready and controller is not None and controller.control
        for button in (self.read, self.keep, self.save, self.new, self.add):
            button.setEnabled(ready)
        self.send.setEnabled(bool(control and self.recipe))
        self.send.setToolTip("" if control else WATCHED)
        triggers = (
            QAbstractItemView.EditTrigger.DoubleClicked
            | QAbstractItemView.EditTrigger.EditKeyPressed
            | QAbstractItemView.EditTrigger.AnyKeyPressed
        )
        for table in (self.table, self.elements):
            wanted = triggers if control else QAbstractItemView.EditTrigger.NoEditTriggers
            if table.editTriggers() != wanted:
                table.setEditTriggers(wanted)
                table.setToolTip("" if control else WATCHED)

    def _draw(self, name: str, values: Sequence[str]) -> None:
        if self.plot is None:
            from widgets.parts.plot import Plot

            self.plot = Plot("Array", parent=self)
            self.plot.setMinimumHeight(PICTURE)
            self._curve = self.plot.plot()
            self._right_column.insertWidget(1, self.plot, 1)
        self.plot.name_sides("element", name)
        self._curve.setData([float(text) for text in values], pen={"color": look().colour("accent"), "width": 2})
        self.plot.fit()

    def _lay_out(self) -> None:
        outer = QVBoxLayout(self)
        outer.setContentsMargins(8, 4, 8, 4)
        self.empty.setWordWrap(True)
        self.empty.setProperty("role", "quiet")
        outer.addWidget(self.empty)
        self._inside = QWidget()
        outer.addWidget(self._inside, 1)
        outer.addStretch(0)
        column = QVBoxLayout(self._inside)
        column.setContentsMargins(0, 0, 0, 0)
        self.new.setAccessibleName("Name of a variable or array")
        self.new.setPlaceholderText("Name")
        self.new.setFixedWidth(NAME_WIDTH)
        self.new.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self.new.setToolTip("A variable, or an array as NAME[], that neither the controller nor its program names")
        self.forget.setShortcut(QKeySequence.StandardKey.Delete)
        self.forget.setShortcutContext(Qt.ShortcutContext.WidgetShortcut)
        self.table.addAction(self.forget)
        self.table.setContextMenuPolicy(Qt.ContextMenuPolicy.ActionsContextMenu)
        column.addLayout(WrappingRow(self.read, self.keep, self.load, self.save, self.send, self.new, self.add))
        both = QHBoxLayout()
        both.addStrut(LEAST)
        self._right = QWidget()
        self._right_column = QVBoxLayout(self._right)
        self._right_column.setContentsMargins(0, 0, 0, 0)
        self._right_column.addWidget(self.chosen)
        self._right_column.addWidget(self.elements, 1)
        self.elements.setMinimumHeight(ROWS)
        for table, names, accessible in (
            (self.table, COLUMNS, "Variables and arrays"), (self.elements, ARRAY_COLUMNS, "Elements of the array"),
        ):  # fmt: skip
            table.setHorizontalHeaderLabels(list(names))
            table.setAccessibleName(accessible)
            table.verticalHeader().hide()
            table.setShowGrid(False)
            table.setTabKeyNavigation(False)
            table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
            table.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
            table.horizontalHeader().setStretchLastSection(True)
            table.horizontalHeader().setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self.table.setColumnHidden(RECIPE, True)
        both.addWidget(self.table, 3)
        both.addWidget(self._right, 2)
        self._right.hide()
        column.addLayout(both, 1)
        self.words_.setWordWrap(True)
        column.addWidget(self.words_)
