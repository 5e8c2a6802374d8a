"""The search of the help: words of people at machines lead to the page that helps them."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from app.help_pages import Pages, search_words
from tests.stage import Stage
from widgets.help.panel import HelpPanel
from widgets.help.search import pages_with, words_of
from widgets.help.topic import topic_of

# what somebody types, and the page that has to stand among the first five
TYPED = {
    "wiring": "Connectors: SSC",
    "pinout": "Connectors: SSC",
    "limit": "Setup: Limits",
    "end stop": "Bring an axis to life",
    "following error": "Following Error",
    "runaway": "Bring an axis to life",
    "run away": "Troubleshooting",
    "oscillation": "Troubleshooting",
    "vibration": "Tuner",
    "hum": "Troubleshooting",
    "noise": "Troubleshooting",
    "homing": "Home",
    "e-stop": "STOP",
    "backup": "Back up, restore, replace",
    "excel": "Tables",
    "usb": "Connecting",
    "shortcut": "Keys",
    "gearbox": "Setup: Axes",
    "encoder resolution": "Setup: Axes",
    "jerk": "Programming",
    "burn": "Write to EEPROM",
    "baud": "Serial communication setup",
    "gamepad": "Teach",
    "motor does not move": "Troubleshooting",
    "dark": "Colours and layouts",
    "AM": "Commands: Program flow",
    "autotune": "Tuner",
    "settling time": "Tuner",
    "fft": "Scope",
    "pre-trigger": "Scope",
    "chart": "Scope",
    "black box": "Recorder",
    "logging": "Recorder",
    "lead through": "Teach",
    "deadband": "Teach",
    "sample rate": "Scope",
}


@pytest.mark.parametrize("typed", TYPED)
def test_what_is_typed_leads_to_the_page(typed: str) -> None:
    found = pages_with(words_of(typed, search_words()), Pages())
    assert TYPED[typed] in found[:5], found[:8]


def test_every_other_word_has_pages_and_says_more_than_the_word_alone() -> None:
    pages = Pages()
    for typed, said in search_words().items():
        assert typed == typed.lower() and said
        for each in said:
            assert pages_with(words_of(each, {}), pages), (typed, each)


def test_the_best_page_comes_first_and_beginnings_of_words_count_less() -> None:
    pages = {"Tables": "limited", "Motion": "text\n## Limit\nmore", "Limits": "of a limit", "Other": "a limit"}
    assert pages_with(words_of("limit", {}), pages) == ["Limits", "Motion", "Other", "Tables"]
    assert pages_with(words_of("mit", {}), pages) == []
    assert pages_with(words_of("limit more", {}), pages) == ["Motion"]


def test_a_found_page_opens_where_the_words_stand(stage: Stage, qtbot: QtBot) -> None:
    stage.studio.desk.show_help("Jog")
    assert stage.studio.desk.help is not None
    panel = stage.studio.desk.help.findChild(HelpPanel)
    assert panel is not None and not panel.browser.extraSelections()
    everything = panel.list.count()
    qtbot.keyClicks(panel.search, "runaway")
    assert 0 < panel.list.count() < everything
    qtbot.keyClick(panel.search, Qt.Key.Key_Return)
    assert panel.page == panel.list.item(0).text()
    marked = {mark.cursor.selectedText().lower() for mark in panel.browser.extraSelections()}
    assert marked & {"runs away", "run away", "runaway"}
    assert panel.browser.textCursor().block().text().lower().find("away") >= 0
    stage.studio.desk.show_help("Keys")  # has nothing of that: the list shows all pages again
    assert panel.search.text() == "" and panel.list.count() == everything
    assert not panel.browser.extraSelections()


def test_a_question_has_the_page_of_where_it_was_asked(stage: Stage) -> None:
    studio = stage.studio
    studio.window.show()
    studio.desk.bring("Terminal")
    studio.window.activateWindow()
    studio.terminal.log.setFocus()
    studio.desk.ask("Sure?", "It is a question.", [("Yes", lambda: None)])
    assert studio.desk.question is not None
    assert topic_of(studio.desk.question.buttons["Yes"]) == "Terminal"
