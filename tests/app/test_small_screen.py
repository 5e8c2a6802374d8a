"""On a small panel (1024 x 700) nothing makes the window larger than the screen, and no text of a button is cut."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QRect, Qt
from PySide6.QtWidgets import QLineEdit, QPushButton, QToolButton, QWidget
from pytestqt.qtbot import QtBot

from tests.stage import Stage
from widgets.parts.short_label import ShortLabel
from widgets.parts.wrapping import WrappingRow

WIDE, HIGH = 1024, 700

WHOLE = True  # the panels at the machine are there from the beginning
ALONE = Qt.ToolButtonStyle.ToolButtonIconOnly


@pytest.fixture
def small(stage: Stage) -> Stage:
    """A download under way, because then the status bar is full of words."""
    window = stage.studio.window
    window.resize(WIDE, HIGH)
    window.show()
    stage.connect("simulator", stage.studio.model())
    assert stage.studio.at_machine  # all of its panels are made
    stage.studio.run.download()
    stage.until(lambda: bool(stage.studio.window.status.progress.words.text()))
    return stage


def test_neither_words_nor_a_panel_make_the_window_wider(small: Stage) -> None:
    window = small.studio.window
    for title in ("Display", "Terminal", "Jog", "X-Y view", "Variables", "Events", "Recorder"):
        small.studio.desk.bring(title)
        small.go(2)
        assert (window.width(), window.height()) == (WIDE, HIGH), title


def test_another_layout_does_not_make_the_window_wider(stage: Stage) -> None:
    window = stage.studio.window
    window.resize(1280, 800)
    window.show()
    stage.connect("simulator", stage.studio.model())
    stage.studio.actions["layout_tune"].trigger()
    stage.go(5)
    for layout in ("program", "tune", "run"):
        stage.studio.actions[f"layout_{layout}"].trigger()
        stage.go(3)
        assert window.width() == 1280, layout


def test_buttons_of_the_toolbars_show_all_of_their_words_or_none(small: Stage) -> None:
    window = small.studio.window
    for width in (WIDE, 1280, 1600):
        window.resize(width, HIGH)
        small.go(2)
        for bar in (window.header.toolbar, window.run_bar.toolbar):
            for action in bar.actions():
                button = bar.widgetForAction(action)
                if not isinstance(button, QToolButton) or not action.text():
                    continue
                assert button.isVisible(), (width, action.text())  # not behind the arrow of what had no room
                words = button.fontMetrics().horizontalAdvance(action.iconText())
                assert bar.toolButtonStyle() is ALONE or button.width() >= words, (width, action.text())
        if width >= 1280:  # the least screen of most
            assert window.header.toolbar.toolButtonStyle() is Qt.ToolButtonStyle.ToolButtonTextUnderIcon
            assert window.run_bar.badge.text()[2:] or not window.run_bar.badge.isVisible()  # more than a sign


def test_a_short_label_keeps_all_of_its_text(qtbot: QtBot) -> None:
    label = ShortLabel("Thread 0: line 8, waiting: after move (AM X)")
    qtbot.addWidget(label)
    label.resize(60, 20)
    assert label.cut and label.text().endswith("(AM X)") and label.minimumSizeHint().width() <= 60
    label.grab()  # it paints
    label.resize(label.sizeHint())
    assert not label.cut


def test_a_row_goes_on_below_and_what_may_grow_takes_the_rest(qtbot: QtBot) -> None:
    whole, line, buttons = QWidget(), QLineEdit(), [QPushButton(text) for text in ("Read", "Open recipe…", "Send")]
    qtbot.addWidget(whole)
    line.setMinimumWidth(100)
    row = WrappingRow(line, *buttons)
    whole.setLayout(row)
    widths = [each.sizeHint().width() for each in buttons]
    in_one = 100 + sum(widths) + 3 * row.spacing()
    for width, lines in ((in_one + 200, 1), (in_one, 1), (in_one - 1, 2), (max(widths), 4)):
        row.setGeometry(QRect(0, 0, width, row.heightForWidth(width)))
        assert len({each.y() for each in (line, *buttons)}) == lines, width
        assert all(each.geometry().right() < width for each in (line, *buttons)), width
    row.setGeometry(QRect(0, 0, in_one + 200, 60))
    assert line.width() == 300
    buttons[0].hide()
    row.setGeometry(QRect(0, 0, in_one + 200, 60))
    assert buttons[1].x() == line.width() + row.spacing()
