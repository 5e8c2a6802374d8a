"""The pages of the jog panel, each made and joined when it is first opened."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, cast

from PySide6.QtWidgets import QHBoxLayout, QPushButton, QWidget

from codegen.setup import Setup
from widgets.parts.pieces import dressed

if TYPE_CHECKING:
    from widgets.jog.drive import DrivePage
    from widgets.jog.one_axis import OneAxisPage
    from widgets.jog.panel import JogPanel
    from widgets.jog.saved import SavedPage
    from widgets.jog.together import TogetherPage

NAMES = ("One axis", "Line", "Arc", "Stick", "Points")
ONE, LINE, ARC, STICK, POINTS = range(len(NAMES))
ON_SCREEN = "stick"


class Pages:
    """What has been opened so far; what a person does there becomes a signal of the panel."""

    def __init__(self, panel: JogPanel) -> None:
        self._panel = panel
        self._made: dict[int, QWidget] = {}  # opened
        self._ready: dict[int, QWidget] = {}  # made beforehand
        self._coming: dict[int, Iterator[None]] = {}

    def page(self, index: int, setup: Setup) -> QWidget:
        """This page; made and joined when it is opened for the first time, as far as it is not there yet."""
        if index not in self._made:
            making = self._coming.pop(index, None) or self._begin(index, setup)
            for _ in making:
                pass
            self._made[index] = self._ready.pop(index)
        return self._made[index]

    def making(self, index: int, setup: Setup) -> Iterator[None]:
        """The same page in pieces, ready to be opened."""
        if index not in self._made and index not in self._ready:
            self._coming[index] = self._begin(index, setup)
        while making := self._coming.get(index):
            if next(making, self) is self:
                self._coming.pop(index, None)
            yield

    def others(self, setup: Callable[[], Setup | None]) -> Iterator[None]:
        """All pages, before somebody clicks at them."""
        for index in range(len(NAMES)):
            if (now := setup()) is not None:
                yield from self.making(index, now)

    def _begin(self, index: int, setup: Setup) -> Iterator[None]:
        if index not in self._ready:
            make = {ONE: self._one_axis, STICK: self._drive, POINTS: self._saved}.get(index)
            page = make(setup) if make is not None else self._together(index, setup)
            page.hide()  # whatever becomes of what it stands in
            yield
            making = getattr(page, "making", None)
            while making is not None and not making.step():
                yield
            yield from dressed(page)
            self._ready[index] = page

    @property
    def one(self) -> OneAxisPage | None:
        return cast("OneAxisPage | None", self._made.get(ONE))

    @property
    def line(self) -> TogetherPage | None:
        return cast("TogetherPage | None", self._made.get(LINE))

    @property
    def arc(self) -> TogetherPage | None:
        return cast("TogetherPage | None", self._made.get(ARC))

    @property
    def drive(self) -> DrivePage | None:
        return cast("DrivePage | None", self._made.get(STICK))

    @property
    def saved(self) -> SavedPage | None:
        return cast("SavedPage | None", self._made.get(POINTS))

    def _one_axis(self, setup: Setup) -> OneAxisPage:
        from widgets.jog.one_axis import OneAxisPage

        panel = self._panel
        page = OneAxisPage(setup, panel.pages, at_once=False)
        page.hold_wanted.connect(panel.hold)
        page.let_go.connect(panel.holder.let_go)
        page.run_wanted.connect(panel.run)
        page.latch_wanted.connect(panel.latch_wanted)
        page.latch_wanted.connect(lambda _: panel.holder.let_go())
        page.zero_wanted.connect(panel.zero_wanted)
        page.axis_changed.connect(panel.another_axis)
        page.speed_kept.connect(panel.keep_speed)
        page.plan_wanted.connect(panel.plan_wanted)
        return page

    def _together(self, index: int, setup: Setup) -> TogetherPage:
        from codegen.by_hand import Arc, Line
        from widgets.jog import plans
        from widgets.jog.together import TogetherPage

        panel = self._panel
        item, make = (Line(), plans.line) if index == LINE else (Arc(), plans.arc)
        page = TogetherPage(item, make, setup, panel.pages, at_once=False)
        page.plan_wanted.connect(panel.plan_wanted)
        page.stop_wanted.connect(lambda: panel.released.emit(""))
        return page

    def _drive(self, setup: Setup) -> DrivePage:
        from widgets.jog.drive import DrivePage

        panel = self._panel
        page = DrivePage(setup, panel.pages)
        page.leaned.connect(lambda across, upward: panel.lean(ON_SCREEN, across, upward))
        page.let_go.connect(panel.holder.let_go)
        return page

    def _saved(self, setup: Setup) -> SavedPage:
        from widgets.jog.saved import SavedPage

        panel = self._panel
        page = SavedPage(setup, panel.pages)
        page.save_wanted.connect(panel.point_saved)
        page.go_wanted.connect(panel.point_wanted)
        page.rename_wanted.connect(panel.point_renamed)
        page.delete_wanted.connect(panel.point_deleted)
        return page


def row_of(buttons: Sequence[QPushButton], opened: Callable[[int], None]) -> QHBoxLayout:
    """The buttons that open the pages; the first one is open."""
    row = QHBoxLayout()
    for index, button in enumerate(buttons):
        button.setCheckable(True)
        button.setChecked(index == ONE)
        button.setProperty("role", "segment")
        button.clicked.connect(lambda _=False, index=index: opened(index))
        row.addWidget(button)
    row.addStretch(1)
    return row
