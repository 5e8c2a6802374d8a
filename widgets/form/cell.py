"""One field on the form: its editor, its unit, what will be sent, and what is wrong with it."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QApplication, QComboBox, QHBoxLayout, QLabel, QSizePolicy, QVBoxLayout, QWidget

SPACE = 8  # between a field that says nothing and the next one, px
LITTLE = 4  # the same in a long form


class Cell(QWidget):
    """An editor with its unit, its counts in a quiet tone and its problem; `wide` puts unit and counts in one line.

    A cell that `speaks` keeps a line free for its message, so that nothing moves while it is typed into.
    """

    changed = Signal(object)

    def __init__(
        self,
        editor: QWidget,
        name: str,
        help_text: str,
        *,
        wide: bool,
        speaks: bool = True,
        tight: bool = False,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.editor: Any = editor
        self.unit, self.counts, self.problem = QLabel(self), QLabel(self), QLabel(self)
        self.counts.setProperty("role", "quiet")
        self.problem.setProperty("role", "warning")
        for label in (self.counts, self.problem):
            label.setWordWrap(True)
            label.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
            label.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)  # never widens the field
            label.hide()
        name_focusable(editor, name, help_text)
        self._lay_out(editor, wide=wide, foot=LITTLE if tight else self.fontMetrics().height() + 2 if speaks else SPACE)
        self.editor.changed.connect(self.changed)
        self._name = name

    def _lay_out(self, editor: QWidget, *, wide: bool, foot: int) -> None:
        whole = QVBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.setSpacing(0)
        top, below = QHBoxLayout(), QWidget(self)
        whole.addLayout(top)
        whole.addWidget(below)
        top.setContentsMargins(0, 0, 0, 0)
        top.setSpacing(8)
        policy = editor.sizePolicy().horizontalPolicy()
        stretches = policy == QSizePolicy.Policy.Expanding and editor.maximumWidth() > editor.minimumWidth()
        top.addWidget(editor, 1 if stretches else 0)
        top.addWidget(self.unit)
        if wide and not stretches:
            self.counts.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
            top.addWidget(self.counts, 1)
        if not stretches:
            top.addStretch(0 if wide else 1)
        below.setMinimumHeight(foot)
        lines = QVBoxLayout(below)
        lines.setContentsMargins(0, 0, 0, 4 if foot > SPACE else 0)
        lines.setSpacing(0)
        if not wide or stretches:
            lines.addWidget(self.counts)
        lines.addWidget(self.problem)
        lines.addStretch(1)

    def show_facts(self, unit: str, counts: str, warning: str | None, problem: str | None) -> None:
        """Shows unit and counts, and the problem sentence instead of the counts while there is one."""
        _say(self.unit, unit)
        _say(self.counts, "" if problem else counts)
        _say(self.problem, f"! {problem}" if problem else f"△ {warning}" if warning else "")
        spoken = ". ".join(part for part in (unit, counts, warning or "", problem or "") if part)
        target = focus_target(self.editor)
        if target.accessibleDescription() != spoken:
            target.setAccessibleDescription(spoken)


def _say(label: QLabel, text: str) -> None:
    text = unbroken(text)
    if label.text() != text:
        label.setText(text)
        label.setMinimumWidth(label.minimumSizeHint().width())  # the longest word
    label.setVisible(bool(text))


def unbroken(text: str) -> str:
    """A unit such as in/s is not broken behind its slash."""
    return text.replace("/s", "/\N{WORD JOINER}s")


def name_focusable(editor: QWidget, name: str, help_text: str) -> None:
    """Gives every part of an editor that takes the focus a name, and the field's help as tool tip."""
    parts = [editor, *editor.findChildren(QWidget)]
    for part in parts:
        if part.focusPolicy() == Qt.FocusPolicy.NoFocus and part is not editor:
            continue
        text = getattr(part, "text", None)
        own = text() if callable(text) and part.property("role") == "segment" else ""
        if not part.accessibleName():
            part.setAccessibleName(f"{name}: {own}" if own else name)
        if help_text and not part.toolTip():
            part.setToolTip(help_text)


def focus_target(editor: QWidget) -> QWidget:
    """The part of an editor that takes the cursor."""
    inner = getattr(editor, "focus_target", None)
    return inner() if inner is not None else editor


def focus_in(widget: QWidget) -> None:
    """Puts the cursor into an editor and selects what stands there."""
    target = focus_target(widget)
    target.setFocus(Qt.FocusReason.TabFocusReason)
    line = target.lineEdit() if isinstance(target, QComboBox) else target
    if line is not None and hasattr(line, "selectAll"):
        line.selectAll()


def focused_inside(widget: QWidget) -> bool:
    """Whether the focus is somewhere in `widget`."""
    focus = QApplication.focusWidget()
    return focus is not None and (focus is widget or widget.isAncestorOf(focus))
