"""Finds words in the English and the code of the program, goes from one to the next, replaces them."""

from __future__ import annotations

import dataclasses as dc
import re
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from codegen.program import Step
from codegen.replacing import pattern_of, replaced
from widgets.program.delegate import ProgramDelegate
from widgets.program.find_bar import FindBar
from widgets.program.tree import ProgramTree
from widgets.program.words import Words

if TYPE_CHECKING:
    from widgets.program.editing import Editing


class Finding(QObject):
    """Marks all steps that hold what is searched; the selected one is where it goes on from."""

    said = Signal(str)

    def __init__(
        self, session: Editing, words: Words, tree: ProgramTree, delegate: ProgramDelegate, bar: FindBar
    ) -> None:
        super().__init__(bar)
        self.session, self.words, self.tree, self.delegate, self.bar = session, words, tree, delegate, bar
        self.found: list[str] = []
        bar.changed.connect(self.search)
        bar.step.connect(self.go)
        bar.replace_wanted.connect(self.replace)
        bar.closed.connect(self.close)

    def open(self, *, replacing: bool) -> None:
        """Opens the bar and shows what its words find now."""
        self.bar.open(replacing=replacing)
        self.search()

    def close(self) -> None:
        """No marks any more; back to the program."""
        self.bar.hide()
        self._show([])
        self.tree.setFocus()

    def follow(self) -> None:
        """The program has changed under an open bar."""
        if self.bar.isVisible():
            self.search()

    def search(self) -> None:
        """Finds all steps anew."""
        pattern = self._pattern()
        steps = self.session.document.program.steps() if pattern is not None else ()
        self._show([step.id for step in steps if pattern is not None and self._holds(step, pattern)])

    def go(self, by: int) -> None:
        """To the next step found (1) or the one before (-1), round the ends."""
        if not self.bar.isVisible() or not self.found:
            self.said.emit("Nothing was found" if self.bar.text.text() else "Type what to find (Ctrl+F)")
            return
        order = [step.id for step in self.session.document.program.steps()]
        here = order.index(self.tree.current()) if self.tree.current() in order else (-1 if by > 0 else len(order))
        places = [order.index(name) for name in self.found]
        ahead = [place for place in places if (place > here if by > 0 else place < here)]
        at = (min(ahead) if by > 0 else max(ahead)) if ahead else places[0 if by > 0 else -1]
        self.tree.choose([order[at]])
        self._count(self.found.index(order[at]))

    def replace(self, everywhere: bool) -> None:
        """In the selected step, then on to the next; or in all of them as one edit."""
        pattern, document = self._pattern(), self.session.document
        if pattern is None:
            return
        if not everywhere and self.tree.current() not in self.found:
            self.go(1)
            return
        ids = self.found if everywhere else [self.tree.current() or ""]
        by = self.bar.by.text()
        done = replaced(document.program, document.working_setup, pattern, by, frozenset(ids))
        if done.changed:
            label = f"Replace {self.bar.text.text()} by {by}"
            self.session.set_document(dc.replace(document, program=done.program), label)
        if not everywhere and done.changed:
            self.go(1)
        self._report(len(done.changed), len(done.refused))

    # ---- inside

    def _pattern(self) -> re.Pattern[str] | None:
        text = self.bar.text.text()
        exact = not self.bar.replacing.isHidden()  # for the controller LEN and len are two variables
        return pattern_of(text, words=self.bar.words.isChecked(), case=exact) if text.strip() else None

    def _holds(self, step: Step, pattern: re.Pattern[str]) -> bool:
        place = self.bar.place.currentData()
        english = place != "code" and pattern.search(f"{self.words.english(step)}\n{step.note}")
        return bool(english or (place != "english" and pattern.search(self.words.code(step))))

    def _show(self, found: list[str]) -> None:
        self.found = found
        if self.delegate.found != frozenset(found):
            self.delegate.found = frozenset(found)
            self.tree.viewport().update()
        self._count(None)

    def _count(self, at: int | None) -> None:
        count = len(self.found)
        if not self.bar.text.text().strip():
            text = ""
        elif at is not None:
            text = f"{at + 1} of {count}"
        else:
            text = "Nothing found" if not count else "1 step" if count == 1 else f"{count} steps"
        self.bar.show_found(text, can_replace=bool(count))

    def _report(self, changed: int, refused: int) -> None:
        """In words, also what was not done."""
        words = self.bar.text.text()
        steps = "1 step" if changed == 1 else f"{changed} steps"
        if not changed and not refused:
            text = f"“{words}” is wording here, not something typed: change the step itself"
        else:
            text = f"Replaced in {steps}" if changed else "Nothing replaced"
        if refused:
            left = "1 step was left" if refused == 1 else f"{refused} steps were left"
            text += f"; {left}, because it would be wrong there"
        self.bar.show_found(text, can_replace=bool(self.found))
        self.said.emit(text)
