"""The running program in the program window: marks of the threads, the one that is followed, the error."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from codegen.generate import Listing
from widgets.program.delegate import ProgramDelegate
from widgets.program.tracing import ALL, StatusWindow, Threads, TraceBar, doing
from widgets.program.tree import ProgramTree
from widgets.program.words import Words
from widgets.source.view import CodeView

if TYPE_CHECKING:
    from widgets.program.editing import Editing


class Running(QObject):
    """Lines are those of the listing that was downloaded; without one, of the program that is open."""

    step_wanted = Signal(str)

    def __init__(
        self, session: Editing, words: Words, tree: ProgramTree, delegate: ProgramDelegate, code: CodeView
    ) -> None:
        super().__init__(tree)
        self.session, self.words = session, words
        self.tree, self.delegate, self.code = tree, delegate, code
        self.listing: Listing | None = None  # that was downloaded
        self.bar = TraceBar()
        self.window: StatusWindow | None = None
        self._threads: Threads = {}
        self.bar.followed.connect(lambda _: self._show())
        self.bar.closed.connect(self.close)
        self.bar.status_wanted.connect(self.show_status)

    def present(self) -> Listing:
        """The listing that lines are counted in."""
        return self.listing or self.session.listing

    def show_executing(self, threads: Threads) -> None:
        """The line each thread stands on (None: the thread does not run)."""
        self._threads = dict(threads)
        self._show()

    def trace(self) -> None:
        """Opens the bar, or closes it and marks all threads again."""
        if self.bar.isHidden():
            self.bar.show()
            self._show()
        else:
            self.close()

    def close(self) -> None:
        """All threads are marked, none is followed."""
        self.bar.chooser.setCurrentIndex(0)
        self.bar.hide()
        self._show()

    def show_status(self) -> None:
        """The table of all threads."""
        if self.window is None:
            self.window = StatusWindow(self.tree.window())
            self.window.step_wanted.connect(self.step_wanted)
        self.window.show()
        self.window.raise_()
        self._show()

    def _show(self) -> None:
        followed = self.bar.thread
        marked = {thread: line for thread, line in self._threads.items() if followed in (ALL, thread)}
        listing = self.present()
        steps: dict[str, tuple[int, ...]] = {}
        for thread, line in marked.items():
            if line is not None and 0 <= line < len(listing.lines):
                step = listing.step_of(line)
                steps[step] = (*steps.get(step, ()), thread)
        if steps != self.delegate.executing:
            self.delegate.executing = steps
            self.delegate.show_marks()
            self.tree.viewport().update()
            if followed != ALL:
                self._go_along(steps)
        self.code.show_executing(marked, follow=followed != ALL)
        if self.bar.isVisible() or (self.window is not None and self.window.isVisible()):
            found = doing(self._threads, listing, self.words)
            self.bar.show_doing(found)
            if self.window is not None:
                self.window.show_doing(found)

    def _go_along(self, steps: dict[str, tuple[int, ...]]) -> None:
        """The row of the followed thread stays in sight; the selection stays the person's own."""
        for step in steps:
            self.tree.bring(step)
