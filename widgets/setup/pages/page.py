"""What every page of the setup has: it shows a setup and what the controller holds, and emits the setup anew."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Iterator, Mapping

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QFrame, QLabel, QScrollArea, QVBoxLayout, QWidget

from codegen.setup import Setup
from codegen.setup_differences import Key
from widgets.form.room import settle


@dc.dataclass(frozen=True)
class Shown:
    """What a page shows: the setup as it stands, and the controller's registers as far as they were read."""

    setup: Setup
    readings: Mapping[Key, int] = dc.field(default_factory=dict)
    serial: int | None = None  # of what is connected


class Page(QWidget):
    """One page; `edited` carries the new setup."""

    edited = Signal(object)
    title = ""
    help_page = ""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setProperty("helpPage", self.help_page)
        self.shown: Shown | None = None
        self.inside = QWidget()
        self.column = QVBoxLayout(self.inside)
        self.column.setContentsMargins(0, 0, 16, 8)
        self.column.setSpacing(8)
        scroll = QScrollArea()
        scroll.setWidgetResizable(True)
        scroll.setFrameShape(QFrame.Shape.NoFrame)
        scroll.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        scroll.setWidget(self.inside)
        whole = QVBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.addWidget(scroll)

    def show_setup(self, shown: Shown, in_front: bool) -> None:
        """A setup to show; a page behind the others is only told, and refreshed when it comes to the front."""
        self.shown = shown
        if in_front:
            self.refresh(shown)
            if self.isVisible():
                settle(self.inside)

    def showEvent(self, event: QShowEvent) -> None:
        """Words that take several lines know their height only once the page has its width."""
        super().showEvent(event)
        settle(self.inside)

    def filling(self, shown: Shown) -> Iterator[None]:
        """What takes long to make of it, before somebody turns to it."""
        return iter(())

    def refresh(self, shown: Shown) -> None:
        """Brings every editor and word up to date."""
        raise NotImplementedError

    def change(self, setup: Setup) -> None:
        """A person changed something."""
        if self.shown is not None and setup != self.shown.setup:
            self.edited.emit(setup)

    def heading(self, words: str) -> QLabel:
        """Words above a group."""
        label = QLabel(words)
        label.setProperty("role", "heading")
        self.column.addWidget(label)
        return label

    def words(self, role: str = "quiet") -> QLabel:
        """Words that may take several lines."""
        label = quiet(role)
        self.column.addWidget(label)
        return label


def quiet(role: str = "quiet") -> QLabel:
    """A label of several lines that does not widen its page."""
    label = QLabel()
    label.setProperty("role", role)
    label.setWordWrap(True)
    label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    return label


def say(label: QLabel, words: str) -> None:
    """New words; an empty label takes no room."""
    if label.text() != words:
        label.setText(words)
    label.setVisible(bool(words))
