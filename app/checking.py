"""Checks code beside the window: one text at a time, and of those that came meanwhile only the newest."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

from codegen.models import Model
from codegen.twoletter.check import check
from codegen.twoletter.complete import Names, names_of
from codegen.twoletter.parse import parse
from codegen.twoletter.problems import Problem

if TYPE_CHECKING:
    from collections.abc import Iterator

SHORT_TURN = 0.0005  # s; the window waits so long for Python while a check runs


@dataclass(frozen=True)
class Checked:
    """What was found in a text for a controller."""

    text: str
    model: Model
    names: Names
    problems: tuple[Problem, ...]

    @property
    def error(self) -> Problem | None:
        """The first that is no mere advice."""
        return next((each for each in self.problems if each.severity == "error"), None)


def checked(text: str, model: Model) -> Checked:
    """All of it, at once."""
    found = check(text, model) if text.strip() else []
    return Checked(text, model, names_of(parse(text).lines, model), tuple(found))


class Checking:
    """`look` belongs to every tick: it hands over what is finished and begins what waits."""

    def __init__(self, done: Callable[[Checked], None]) -> None:
        self._done = done
        self._wanted: tuple[str, Model] | None = None
        self._thread: threading.Thread | None = None
        self._found: Checked | None = None  # written by the thread, last thing
        self.last: Checked | None = None

    def ask(self, text: str, model: Model) -> None:
        """The newest text; what waited before it is forgotten."""
        self._wanted = (text, model)
        self.look()

    def knows(self, text: str, model: Model) -> Checked | None:
        """What was found in exactly this text; None while that is not known."""
        last = self.last
        return last if last is not None and (last.text, last.model.name) == (text, model.name) else None

    def look(self) -> None:
        """Never waits."""
        if self._thread is not None:
            if self._thread.is_alive():
                return
            self._thread = None
            if self._found is not None:
                self.last = self._found
                if self._wanted is None:
                    self._done(self.last)
        if self._wanted is not None and self._thread is None:
            (text, model), self._wanted, self._found = self._wanted, None, None
            self._thread = threading.Thread(target=self._work, args=(text, model), name="code check", daemon=True)
            self._thread.start()

    def _work(self, text: str, model: Model) -> None:
        with _short_turns():
            self._found = checked(text, model)


@contextmanager
def _short_turns() -> Iterator[None]:
    """Whoever paints calls Python for each line, and would wait for the other thread's whole turn each time."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(min(before, SHORT_TURN))
    try:
        yield
    finally:
        sys.setswitchinterval(before)
