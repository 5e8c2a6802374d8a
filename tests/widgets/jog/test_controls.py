"""Every control of the pages: a name for screen readers, reached by Tab, a help page; nothing is cut off."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtWidgets import QAbstractButton, QApplication

from app.help_pages import Pages
from tests.app.test_controls import controls, describe, name_of, reachable
from tests.stage import Stage
from tests.widgets.jog.test_jog import make_table, ready
from widgets.form.buttons import Segment
from widgets.help.topic import topic_of
from widgets.parts.stick import Stick


@pytest.fixture
def stage(qapp: QApplication, tmp_path: Path) -> Iterator[Stage]:
    made = make_table(tmp_path)
    yield made
    made.clear_away()


def test_every_page_is_named_reached_and_explained(stage: Stage) -> None:
    ready(stage)
    panel = stage.studio.at_machine.jog
    for button in panel.buttons:
        button.click()
        stage.go(2)
        found = controls(panel) + panel.pages.currentWidget().findChildren(Stick)
        assert len(found) > 8
        assert [describe(each) for each in found if not name_of(each)] == []
        lost = [each for each in found if each.isEnabled() and not reachable(each) and not isinstance(each, Segment)]
        assert [describe(each) for each in lost] == []  # arrows walk along segments; one of them is reached
        assert {topic_of(each) for each in found} <= {"Jog"}
        cut = [
            each
            for each in found
            if isinstance(each, QAbstractButton) and each.width() < each.minimumSizeHint().width()
        ]
        assert [describe(each) for each in cut] == []
    assert "Jog" in Pages()
