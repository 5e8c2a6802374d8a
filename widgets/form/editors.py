"""One editor for each kind of field; every editor has three names: `changed`, `value`, `setValue`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol

from PySide6.QtCore import Qt, Signal, SignalInstance
from PySide6.QtGui import QKeyEvent, QValidator
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QLineEdit,
    QPushButton,
    QSizePolicy,
    QWidget,
)

from codegen import fields
from widgets.form.builder import ExpressionBuilder
from widgets.form.buttons import Buttons, row_of
from widgets.form.grid_editor import GridEditor
from widgets.form.judge import Judge
from widgets.form.offers import Offers
from widgets.form.text_area import CodeArea, TextArea
from widgets.parts.icons import icon
from widgets.parts.look import look

LEAVE = "leave as it is"
NUMBER_WIDTH = 144
BUILD = "Build an expression: functions, variables, live values (Ctrl+Space)"
FREE = 16_777_215  # no limit, as Qt writes it


class Editor(Protocol):
    """What the form knows of an editor (it is a QWidget too)."""

    changed: SignalInstance

    def value(self) -> Any: ...
    def setValue(self, value: Any) -> None: ...


class LineEditor(QLineEdit):
    """One line of text: numbers, expressions, names. Ctrl+Space or the button inside opens the expression builder."""

    changed = Signal(object)

    def __init__(self, field: fields.Field, offers: Offers, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.field = field
        self.offers = offers
        self.setMinimumHeight(look().control)
        if isinstance(field, fields.Text):
            self.setMinimumWidth(NUMBER_WIDTH)
        else:
            self.setFixedWidth(NUMBER_WIDTH)
        self.textEdited.connect(lambda text: self.changed.emit(text))
        self.judge: Callable[[], Judge] | None = None  # what the form says of a text; without it nothing is built
        self.builder: ExpressionBuilder | None = None
        self.builds = not getattr(field, "literal", False) and not isinstance(field, fields.Text | fields.LabelName)
        if self.builds and not isinstance(field, fields.ExpressionField):  # that has a button of its own
            action = self.addAction(icon("function", "quiet"), QLineEdit.ActionPosition.TrailingPosition)
            action.setToolTip(BUILD)
            action.triggered.connect(self.build)

    def value(self) -> str:
        return self.text()

    def setValue(self, value: Any) -> None:
        if value != self.text():
            self.setText(value)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Ctrl+Space opens the expression builder."""
        if event.key() == Qt.Key.Key_Space and event.modifiers() == Qt.KeyboardModifier.ControlModifier and self.builds:
            self.build()
            return
        super().keyPressEvent(event)

    def show_offers(self, offers: Offers) -> None:
        """Other names for the expression builder."""
        self.offers = offers

    def build(self) -> None:
        """Opens the builder; what it brings takes the place of the text."""
        if self.judge is None:
            return
        self.builder = ExpressionBuilder(self.offers, self.judge(), self.text(), self.window())
        self.builder.accepted_text.connect(self._take)
        self.destroyed.connect(self.builder.close)
        self.builder.show()

    def _take(self, text: str) -> None:
        self.setText(text)
        self.setFocus()
        self.changed.emit(text)


class ExpressionEditor(QWidget):
    """A line with a button beside it that opens the expression builder."""

    changed = Signal(object)

    def __init__(self, field: fields.Field, offers: Offers, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.line = LineEditor(field, offers)
        self.line.setMinimumWidth(160)
        self.line.setMaximumWidth(FREE)
        self.line.setFont(look().code_font())
        button = QPushButton("ƒ(x)")
        button.setAutoDefault(False)
        button.setMinimumHeight(look().control)
        button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        button.setToolTip(BUILD)
        button.setAccessibleName("Build an expression")
        button.clicked.connect(self.line.build)
        row_of(self, self.line, button)
        self.line.changed.connect(self.changed)

    def show_offers(self, offers: Offers) -> None:
        """Other names for the expression builder."""
        self.line.show_offers(offers)

    def focus_target(self) -> LineEditor:
        """The line takes the cursor."""
        return self.line

    def value(self) -> str:
        return self.line.value()

    def setValue(self, value: Any) -> None:
        self.line.setValue(value)


class ChoiceButtons(Buttons):
    """One of up to three short choices."""

    def __init__(self, field: fields.Choice, offers: Offers, parent: QWidget | None = None) -> None:
        super().__init__([(key, words_of(field, key)) for key in field.kind], several=False, parent=parent)

    def value(self) -> Any:
        return next(iter(self.chosen()), None)

    def setValue(self, value: Any) -> None:
        self.choose([value])

    def _say(self) -> None:
        self.changed.emit(self.value())


class AxisNameEditor(Buttons):
    """One axis letter."""

    def __init__(self, field: fields.Field, offers: Offers, parent: QWidget | None = None) -> None:
        super().__init__([(letter, letter) for letter in offers.setup.letters], several=False, parent=parent)

    def value(self) -> str:
        return "".join(self.chosen())

    def setValue(self, value: Any) -> None:
        self.choose(list(value))

    def _say(self) -> None:
        self.changed.emit(self.value())


class AxisSetEditor(Buttons):
    """Any axes of the controller."""

    def __init__(self, field: fields.Field, offers: Offers, parent: QWidget | None = None) -> None:
        super().__init__([(letter, letter) for letter in offers.setup.letters], several=True, parent=parent)

    def value(self) -> str:
        return "".join(self.chosen())

    def setValue(self, value: Any) -> None:
        self.choose(list(value))

    def _say(self) -> None:
        self.changed.emit(self.value())


class ComboEditor(QComboBox):
    """One of many choices, or of none: `leave as it is` where a value may be empty."""

    changed = Signal(object)

    def __init__(self, choices: Sequence[tuple[Any, str]], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setMinimumHeight(look().control)
        self.setMinimumContentsLength(10)
        self.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)
        self.setSizePolicy(QSizePolicy.Policy.Minimum, QSizePolicy.Policy.Fixed)  # never narrower than its words
        self.keys = [key for key, _ in choices]
        self.addItems([words for _, words in choices])
        self.activated.connect(lambda _: self.changed.emit(self.value()))
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)

    def value(self) -> Any:
        return self.keys[max(0, self.currentIndex())]

    def setValue(self, value: Any) -> None:
        self.setCurrentIndex(self.keys.index(value) if value in self.keys else -1)


class NameEditor(QComboBox):
    """A name to type, or to pick from those there are already."""

    changed = Signal(object)

    def __init__(
        self, names_of: Callable[[Offers], Sequence[str]], offers: Offers, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.names_of = names_of
        self.setEditable(True)
        self.setInsertPolicy(QComboBox.InsertPolicy.NoInsert)
        self.setMinimumHeight(look().control)
        self.setMinimumWidth(160)
        self.addItems(list(names_of(offers)))
        self.setCurrentIndex(-1)
        self.completer().setCaseSensitivity(Qt.CaseSensitivity.CaseInsensitive)
        self.editTextChanged.connect(lambda text: self.changed.emit(text))

    def show_offers(self, offers: Offers) -> None:
        """The names there are now; what was typed stays."""
        names, text = list(self.names_of(offers)), self.currentText()
        if names != [self.itemText(index) for index in range(self.count())]:
            self.blockSignals(True)
            self.clear()
            self.addItems(names)
            self.setCurrentIndex(-1)
            self.setEditText(text)
            self.blockSignals(False)

    def value(self) -> str:
        return self.currentText()

    def setValue(self, value: Any) -> None:
        if value != self.currentText():
            self.blockSignals(True)
            self.setEditText(value)
            self.blockSignals(False)


class FlagEditor(QCheckBox):
    """Yes or no; carries its own words."""

    changed = Signal(object)

    def __init__(self, field: fields.Field, offers: Offers, parent: QWidget | None = None) -> None:
        super().__init__(field.label, parent)
        self.setProperty("role", "field")  # in line with the fields above and below
        self.setMinimumHeight(look().control)
        self.toggled.connect(lambda on: self.changed.emit(on))

    def value(self) -> bool:
        return self.isChecked()

    def setValue(self, value: Any) -> None:
        self.blockSignals(True)
        self.setChecked(bool(value))
        self.blockSignals(False)


def words_of(field: fields.Choice, key: Any) -> str:
    """How a choice reads on a button."""
    words = field.words.get(key, str(key))
    return words[:1].upper() + words[1:]


def choice(field: fields.Choice, offers: Offers) -> QWidget:
    """Buttons for a few short choices, else a list."""
    words = [words_of(field, key) for key in field.kind]
    if len(words) <= 4 and sum(map(len, words)) <= 40:
        return ChoiceButtons(field, offers)
    return choice_list(field)


def choice_list(field: fields.Choice) -> ComboEditor:
    """A choice as a list."""
    return ComboEditor([(key, words_of(field, key)) for key in field.kind])


def in_little_room(editor: QWidget) -> QWidget:
    """A list there may be narrower than its longest entry; the tool tip of the list says it whole."""
    for box in (editor, *editor.findChildren(QComboBox)):
        if isinstance(box, QComboBox):
            box.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
    return editor


def optional_choice(field: fields.Choice, offers: Offers) -> QWidget:
    """A choice for one axis of several: it may be left as it is."""
    return ComboEditor([("", LEAVE), *((str(key), words_of(field, key)) for key in field.kind)])


def optional_flag(field: fields.Field, offers: Offers) -> QWidget:
    """On, off, or left as it is, for one axis of several."""
    return ComboEditor([("", LEAVE), ("on", "On"), ("off", "Off")])


def channels(names: Sequence[str], count: int) -> list[str]:
    """What an input or output is called: its name where it has one, else its number."""
    return [names[number] if number < len(names) and names[number] else str(number + 1) for number in range(count)]


def _inputs(offers: Offers) -> list[str]:
    return channels(offers.setup.input_names, offers.setup.inputs)


def _outputs(offers: Offers) -> list[str]:
    return channels(offers.setup.output_names, offers.setup.outputs)


class Capitals(QValidator):
    """Turns what is typed into capitals."""

    def validate(self, text: str, position: int) -> tuple[QValidator.State, str, int]:
        return QValidator.State.Acceptable, text.upper(), position


def label_name(field: fields.LabelName, offers: Offers) -> QWidget:
    """A new label is typed; one to go to is picked from those of the program; both in capitals."""
    editor = LineEditor(field, offers) if field.defines else NameEditor(lambda now: now.labels, offers)
    editor.setValidator(Capitals(editor))
    return editor


EDITORS: dict[type[fields.Field], Any] = {
    fields.Field: LineEditor,
    fields.Quantity: LineEditor,
    fields.Number: LineEditor,
    fields.Choice: choice,
    fields.AxisName: AxisNameEditor,
    fields.AxisSet: AxisSetEditor,
    fields.Flag: FlagEditor,
    fields.ExpressionField: ExpressionEditor,
    fields.Condition: ExpressionEditor,
    fields.Text: lambda field, offers: (TextArea if field.lines else LineEditor)(field, offers),
    fields.MessageText: LineEditor,
    fields.Code: CodeArea,
    fields.Table: GridEditor,
    fields.LabelName: label_name,
    fields.VariableName: lambda field, offers: NameEditor(lambda now: now.variables, offers),
    fields.InputNumber: lambda field, offers: NameEditor(_inputs, offers),
    fields.OutputNumber: lambda field, offers: NameEditor(_outputs, offers),
}

AXIS_EDITORS: dict[type[fields.Field], Any] = {fields.Flag: optional_flag, fields.Choice: optional_choice}


def maker_for(field: fields.Field, makers: dict[type[fields.Field], Any]) -> Any:
    """What builds the editor for a field: its own kind's, or that of the nearest kind it is a sort of; else None."""
    return next((makers[kind] for kind in type(field).__mro__ if kind in makers), None)
