"""One step: what to do, live readings, fields, buttons, and what came of it in words."""

from __future__ import annotations

from html import escape

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from widgets.commissioning.page import MARK_ROLES, MARK_WORDS, Act, Entered, Page
from widgets.commissioning.steps_list import paint_mark
from widgets.panel import set_text, show_role
from widgets.parts.icons import icon
from widgets.parts.look import look

FIELD = 168  # px


class Mark(QWidget):
    """The circle of a verdict."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.mark = "open"
        self.setFixedSize(28, 28)

    def show_mark(self, mark: str) -> None:
        if mark != self.mark:
            self.mark = mark
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        paint_mark(painter, QRectF(2, 2, 24, 24), self.mark, 0)


class PageView(QWidget):
    """Shows a page; tells what was typed, ticked and pressed."""

    typed = Signal(str, str)  # name, text
    ticked = Signal(str, bool)
    pressed = Signal(str)
    help_wanted = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._shape: tuple[object, ...] = ()
        self.readings: dict[str, QLabel] = {}
        self.fields: dict[str, QLineEdit | QComboBox] = {}
        self.ticks: dict[str, QCheckBox] = {}
        self.acts: dict[str, QPushButton] = {}
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(24, 8, 24, 16)
        self._column.setSpacing(16)
        self._body: QWidget | None = None
        self.blocked, self.result = _words("note"), Result()
        self.result.help_wanted.connect(self.help_wanted)

    def show_page(self, page: Page) -> None:
        """What is the same stays as it is, the cursor in a field too."""
        if page.shape != self._shape:
            self._shape = page.shape
            self._build(page)
        for reading in page.readings:
            label = self.readings[reading.label]
            set_text(label, reading.text)
            show_role(label, reading.role)
        for field in page.fields:
            _show_field(self.fields[field.name], field)
        for tick in page.ticks:
            box = self.ticks[tick.name]
            if box.isChecked() != tick.on:
                box.blockSignals(True)
                box.setChecked(tick.on)
                box.blockSignals(False)
            box.setEnabled(not page.blocked)
        for act in page.acts:
            _show_act(self.acts[act.name], act)
        set_text(self.blocked, page.blocked)
        self.blocked.setVisible(bool(page.blocked))
        self.result.show_result(page)

    # ---- made anew for each step

    def _build(self, page: Page) -> None:
        for kept in (self.blocked, self.result):
            kept.setParent(None)
        if self._body is not None:
            self._column.removeWidget(self._body)
            self._body.hide()
            self._body.deleteLater()
        self.readings, self.fields, self.ticks, self.acts = {}, {}, {}, {}
        self._body = body = QWidget()
        column = QVBoxLayout(body)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(16)
        column.addLayout(_heading(page))
        column.addWidget(_todo(page))
        column.addWidget(self.blocked)
        if page.readings:
            column.addWidget(self._make_readings(page))
        if page.ticks:
            ticks = QVBoxLayout()
            ticks.setSpacing(0)
            for tick in page.ticks:
                ticks.addWidget(self._make_tick(tick.name, tick.label))
            column.addLayout(ticks)
        if page.fields:
            column.addLayout(self._make_fields(page))
        column.addLayout(self._make_acts(page))
        column.addWidget(self.result)
        self._column.insertWidget(0, body)
        if self._column.count() == 1:
            self._column.addStretch(1)

    def _make_readings(self, page: Page) -> QFrame:
        card = QFrame()
        card.setProperty("role", "card")
        grid = QGridLayout(card)
        grid.setContentsMargins(16, 12, 16, 12)
        grid.setHorizontalSpacing(32)
        grid.setVerticalSpacing(2)
        for place, reading in enumerate(page.readings):
            name, text = _words("quiet", wrap=False), QLabel("–")
            name.setText(reading.label)
            text.setFont(look().digits_font(16))
            text.setAccessibleName(reading.label)
            row, side = divmod(place, 4)
            grid.addWidget(name, 2 * row, side)
            grid.addWidget(text, 2 * row + 1, side)
            self.readings[reading.label] = text
        grid.setColumnStretch(4, 1)
        return card

    def _make_tick(self, name: str, label: str) -> QCheckBox:
        box = QCheckBox(label)
        box.toggled.connect(lambda on: self.ticked.emit(name, on))
        self.ticks[name] = box
        return box

    def _make_fields(self, page: Page) -> QGridLayout:
        grid = QGridLayout()
        grid.setHorizontalSpacing(12)
        grid.setVerticalSpacing(8)
        for row, field in enumerate(page.fields):
            label = QLabel(field.label)
            editor = self._make_field(field)
            editor.setAccessibleName(field.label)
            label.setBuddy(editor)
            unit = _words("quiet", wrap=False)
            unit.setText(field.unit)
            beside = QHBoxLayout()
            beside.setSpacing(12)
            beside.addWidget(editor)
            beside.addWidget(unit)
            beside.addStretch(1)
            grid.addWidget(label, row, 0)
            grid.addLayout(beside, row, 1)
            self.fields[field.name] = editor
        grid.setColumnStretch(1, 1)
        return grid

    def _make_field(self, field: Entered) -> QLineEdit | QComboBox:
        name = field.name
        if field.choices:
            box = QComboBox()
            for value, words in field.choices:
                box.addItem(words, value)
            box.currentIndexChanged.connect(lambda at: self.typed.emit(name, str(box.itemData(at))))
            return box
        line = QLineEdit()
        line.setFixedWidth(FIELD)
        line.textEdited.connect(lambda text: self.typed.emit(name, text))
        return line

    def _make_acts(self, page: Page) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(8)
        for act in page.acts:
            button = QPushButton(f" {act.label}" if act.moves else act.label)
            button.setAutoDefault(False)
            if act.moves:  # for gloves
                button.setStyleSheet(f"QPushButton {{ min-height: {look().space['touch'] - 4}px; }}")
            if act.moves:
                button.setIconSize(QSize(18, 18))
            button.clicked.connect(lambda _=False, name=act.name: self.pressed.emit(name))
            row.addWidget(button)
            self.acts[act.name] = button
        row.addStretch(1)
        return row


class Result(QFrame):
    """What came of the step: a shape and a word, a sentence, what to do, the figures, and where to read on."""

    help_wanted = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setProperty("role", "card")
        self.mark, self.word, self.sentence = Mark(), _words("", wrap=False), _words("")
        self.advice, self.facts, self.links = _words(""), _words("quiet"), _words("quiet")
        self.word.setAccessibleName("Result")
        bold = look().body_font()
        bold.setBold(True)
        self.word.setFont(bold)
        self.facts.setTextFormat(Qt.TextFormat.RichText)
        self.advice.setTextFormat(Qt.TextFormat.RichText)
        self.links.linkActivated.connect(self.help_wanted)
        self.links.setTextInteractionFlags(
            Qt.TextInteractionFlag.LinksAccessibleByMouse | Qt.TextInteractionFlag.LinksAccessibleByKeyboard
        )
        head = QHBoxLayout()
        head.setSpacing(12)
        head.addWidget(self.mark)
        head.addWidget(self.word)
        head.addStretch(1)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 12, 16, 12)
        column.setSpacing(8)
        column.addLayout(head)
        for label in (self.sentence, self.advice, self.facts, self.links):
            column.addWidget(label)

    def show_result(self, page: Page) -> None:
        """Nothing is shown before something is known."""
        self.setVisible(bool(page.sentence or page.busy))
        self.mark.show_mark(page.mark)
        set_text(self.word, page.busy or MARK_WORDS[page.mark].capitalize())
        show_role(self.word, "heading" if page.busy or page.mark == "open" else MARK_ROLES[page.mark])
        set_text(self.sentence, page.sentence)
        self.sentence.setVisible(bool(page.sentence))
        bullets = "".join(f"<li style='margin-bottom: 4px'>{escape(each)}</li>" for each in page.advice)
        set_text(
            self.advice,
            f"<ul style='margin-left: -20px; margin-top: 0; margin-bottom: 0'>{bullets}</ul>" if bullets else "",
        )
        self.advice.setVisible(bool(bullets))
        set_text(self.facts, "   ·   ".join(f"{escape(name)} {escape(text)}" for name, text in page.facts))
        self.facts.setVisible(bool(page.facts))
        link = look().colour("accent").name()
        set_text(self.links, _link("Troubleshooting", "What else it can be: Troubleshooting", link))
        self.links.setVisible(page.mark == "failed")


def _link(page: str, words: str, colour: str) -> str:
    return f"<a href='{page}' style='color: {colour}'>{words}</a>"


def _heading(page: Page) -> QVBoxLayout:
    title, source = QLabel(page.heading), _words("quiet")
    title.setProperty("role", "title")
    source.setText(f"Judged: {page.judged}.\nSee: {page.source}.")
    source.setFont(look().small_font())
    source.setVisible(bool(page.source))
    column = QVBoxLayout()
    column.setSpacing(2)
    column.addWidget(title)
    column.addWidget(source)
    return column


def _todo(page: Page) -> QLabel:
    words = _words("")
    words.setTextFormat(Qt.TextFormat.RichText)
    items = "".join(f"<li style='margin-bottom: 6px'>{escape(each)}</li>" for each in page.todo)
    words.setText(f"<ol style='margin-left: -20px; margin-top: 0; margin-bottom: 0'>{items}</ol>")
    return words


def _words(role: str, wrap: bool = True) -> QLabel:
    label = QLabel()
    label.setWordWrap(wrap)
    if role:
        label.setProperty("role", role)
    if wrap:
        label.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Minimum)
        label.setMinimumHeight(
            1
        )  # else its height at the narrowest width counts, and there is a scroll bar for nothing
        label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    return label


def _show_field(editor: QLineEdit | QComboBox, field: Entered) -> None:
    editor.blockSignals(True)
    if isinstance(editor, QComboBox):
        editor.setCurrentIndex(max(editor.findData(field.text), 0))
    elif editor.text() != field.text:
        editor.setText(field.text)
    editor.blockSignals(False)


def _show_act(button: QPushButton, act: Act) -> None:
    role = "primary" if act.primary else ""
    if act.moves and (button.icon().isNull() or button.property("role") != role):
        button.setIcon(icon("warning", "accent_text" if act.primary else "warning"))
    show_role(button, role)
    if button.isEnabled() == bool(act.reason):
        button.setEnabled(not act.reason)
    if button.toolTip() != act.reason:
        button.setToolTip(act.reason)
