"""The status bar: kind and connection, what the program does, where the first axis is, progress with Cancel."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QSize, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QProgressBar, QPushButton, QStatusBar, QWidget

from device.api import Job, Kind
from widgets.panel import set_text
from widgets.parts.kind import KindBadge
from widgets.parts.short_label import ShortLabel

STEP = 24  # px
ASIDE = 16  # px: margins of the status bar


class Progress(QWidget):
    """Phase, share done, and Cancel; hidden while nothing is under way."""

    cancelled = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.words, self.bar, self.cancel = ShortLabel(), QProgressBar(), QPushButton("Cancel")
        self.bar.setRange(0, 1000)
        self.bar.setFixedWidth(200)
        self.bar.setAccessibleName("Progress")
        self.cancel.clicked.connect(self.cancelled)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        for widget in (self.words, self.bar, self.cancel):
            row.addWidget(widget)
        self.hide()

    def show_job(self, doing: str, job: Job[object] | None) -> None:
        """What is under way; nothing when `doing` is empty."""
        self.setVisible(bool(doing))
        self.bar.setVisible(job is not None)
        self.cancel.setVisible(job is not None)
        if job is None:
            set_text(self.words, doing)
            return
        set_text(self.words, f"{doing}: {job.phase}" if job.phase else doing)
        value = round(job.fraction * 1000)
        if value != self.bar.value():
            self.bar.setValue(value)


class Parts(QWidget):
    """A row whose width changes in steps: each change lays out the whole window, with all docks and diagrams."""

    def __init__(self, *parts: QWidget) -> None:
        super().__init__()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addStretch(1)
        for part in parts:
            row.addWidget(part)

    def event(self, event: QEvent) -> bool:
        done = super().event(event)
        if event.type() is QEvent.Type.LayoutRequest:
            self.fit()
        return done

    def fit(self) -> None:
        """As wide as it likes, or as there is room; a size that is fixed is what makes Qt ask nobody else."""
        hint, width = self.sizeHint(), self.maximumWidth()
        if not hint.width() <= width <= hint.width() + 2 * STEP:
            width = -(-hint.width() // STEP) * STEP
        room = self.parentWidget().width() - ASIDE if self.parentWidget() is not None else width
        self.setFixedSize(min(width, max(room, self.minimumSizeHint().width())), hint.height())


class Status(QStatusBar):
    """Permanent parts right, sentences of the moment left."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setSizeGripEnabled(False)
        self.badge, self.position = KindBadge(), QLabel()
        self.link, self.program = ShortLabel(), ShortLabel()
        self.progress = Progress()
        self._parts = Parts(self.progress, self.position, self.program, self.link, self.badge)
        self.addPermanentWidget(self._parts)

    def minimumSizeHint(self) -> QSize:
        return QSize(self._parts.minimumSizeHint().width() + ASIDE, super().minimumSizeHint().height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._parts.fit()

    def show_link(self, kind: Kind, words: str) -> None:
        """What is connected and how fast it is read."""
        self.badge.show_kind(kind)
        set_text(self.link, words)

    def show_program(self, words: str) -> None:
        """What thread 0 does."""
        set_text(self.program, words)
        self.program.setVisible(bool(words))

    def show_position(self, words: str) -> None:
        """Where the first axis is."""
        set_text(self.position, words)
        self.position.setVisible(bool(words))

    def say(self, words: str) -> None:
        """A sentence that goes away by itself."""
        self.showMessage(words, 10_000)
