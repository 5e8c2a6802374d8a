"""What opens from an instruction dialog: every control has a name, is reached by keys, and F1 has a page for it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QAbstractButton, QComboBox, QLineEdit, QToolButton, QTreeWidget, QWidget
from pytestqt.qtbot import QtBot

from app.help_pages import Pages
from app.theme import Choice, Theme
from codegen.instructions import ElectronicCam, SingleAxisMove
from tests.widgets.form.clipping import open_dialog, settle
from widgets.help.topic import topic_of

KINDS = (QAbstractButton, QComboBox, QLineEdit, QTreeWidget)


@pytest.fixture(params=["Expressions", "Tables"])
def opened(request: pytest.FixtureRequest, qtbot: QtBot, qapp: object) -> Iterator[tuple[str, QWidget]]:
    """The expression builder of a move, and the dialog that fills a column of a cam."""
    worn = Theme(qapp, Choice.LIGHT)  # type: ignore[arg-type]
    kind = SingleAxisMove if request.param == "Expressions" else ElectronicCam
    dialog = open_dialog(kind, "ssc4", "example")
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
    qtbot.addWidget(dialog)
    if request.param == "Expressions":
        editor = dialog.form.fields.cells["distance", ""].editor
        editor.build()
        found = editor.builder
    else:
        grid = dialog.form.fields.cells["table", ""].editor
        grid.fill()
        found = grid.fill_dialog
    settle()
    yield request.param, found
    worn.release()


def test_every_control_is_named_reached_and_explained(opened: tuple[str, QWidget]) -> None:
    page, window = opened
    assert page in Pages()
    seen = 0
    for control in window.findChildren(QWidget):
        inside = isinstance(control, QToolButton) and isinstance(control.parentWidget(), QLineEdit)
        if not isinstance(control, KINDS) or not control.isVisible() or inside:
            continue
        if isinstance(control, QLineEdit) and isinstance(control.parentWidget(), QComboBox):
            continue
        seen += 1
        name = control.accessibleName() or (control.text() if isinstance(control, QAbstractButton) else "")
        assert name, control
        assert control.focusPolicy() & Qt.FocusPolicy.TabFocus, name
        assert topic_of(control) == page
    assert seen >= 5
