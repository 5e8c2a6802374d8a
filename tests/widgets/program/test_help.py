"""Help: the page of what is in focus, links, search and the way back."""

from __future__ import annotations

from PySide6.QtCore import Qt, QUrl
from PySide6.QtWidgets import QLineEdit, QWidget
from pytestqt.qtbot import QtBot

from codegen.docs import pages
from codegen.instructions import ALL, Wait
from tests.widgets.program.conftest import Window
from widgets.form.form import InstructionForm
from widgets.help.panel import HelpPanel
from widgets.help.topic import topic_of


def test_every_instruction_has_a_page(qtbot: QtBot) -> None:
    panel = HelpPanel(pages())
    qtbot.addWidget(panel)
    for kind in ALL:
        assert panel.open(kind.title)
        assert kind.title in panel.browser.toPlainText()


def test_links_lead_to_pages_and_back(qtbot: QtBot) -> None:
    panel = HelpPanel({"One": "See [two](page:Two).", "Two": "Here."})
    qtbot.addWidget(panel)
    panel.open("One")
    panel.browser.anchorClicked.emit(QUrl("page:Two"))
    assert panel.page == "Two"
    qtbot.mouseClick(panel.back, Qt.MouseButton.LeftButton)
    assert panel.page == "One"
    assert not panel.back.isEnabled()
    assert not panel.open("Three")


def test_the_search_looks_into_the_pages(qtbot: QtBot) -> None:
    panel = HelpPanel({"One": "accelerate", "Two": "wait"})
    qtbot.addWidget(panel)
    qtbot.keyClicks(panel.search, "accel")
    assert [panel.list.item(row).text() for row in range(panel.list.count())] == ["One"]
    qtbot.keyClicks(panel.search, "zzz")
    assert panel.list.count() == 0 and not panel.none.isHidden()


def test_the_page_is_that_of_the_widget_in_focus_or_of_what_holds_it(qtbot: QtBot) -> None:
    outer = QWidget()
    qtbot.addWidget(outer)
    line = QLineEdit(outer)
    assert topic_of(line) is None
    outer.setProperty("helpPage", "Wait")
    assert topic_of(line) == "Wait"
    assert topic_of(None) is None


def test_a_selected_step_and_its_form_know_their_page(window: Window) -> None:
    (step_id,) = window.session.insert([Wait(time="1")])
    window.view.tree.choose([step_id])
    assert topic_of(window.view.tree) == "Wait"
    dialog = window.view.dialogs.modify(step_id)
    assert isinstance(dialog.form, InstructionForm)
    assert topic_of(dialog.form.fields.cells["time", ""].editor) == "Wait#Time"  # the field on the page
