"""The pages of the jog panel; loaded when it is first shown."""

from __future__ import annotations

from codegen.by_hand import Arc, Line
from codegen.setup import Setup
from widgets.jog import plans
from widgets.jog.drive import DrivePage
from widgets.jog.one_axis import OneAxisPage
from widgets.jog.saved import SavedPage
from widgets.jog.together import TogetherPage

Pages = tuple[OneAxisPage, TogetherPage, TogetherPage, DrivePage, SavedPage]


def make_pages(setup: Setup) -> Pages:
    """One axis, line, arc, stick, points."""
    return (
        OneAxisPage(setup),
        TogetherPage(Line(), plans.line, setup),
        TogetherPage(Arc(), plans.arc, setup),
        DrivePage(setup),
        SavedPage(setup),
    )
