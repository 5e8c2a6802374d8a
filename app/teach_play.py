"""Play-back of the teach table: what it will do is said and asked first, then it runs row by row from here."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future
from functools import partial
from typing import Any

from PySide6.QtCore import QObject

from app.asked import AskedOfMachine
from app.connection import Connection
from app.run import Ask
from app.tick import Tick, failure_of
from codegen.setup import Setup
from codegen.teach import BYTE, Row, Table, counts_of
from codegen.teach_drive import slow
from device.api import Places
from device.jog import told
from device.teach import Action, PlayBack, approach, passes
from device.teach_actions import actions_of, ends_of
from widgets.teach.panel import TeachPanel

OWNER = "teach"


class TeachPlay(QObject):
    """Asks, undertakes, shows what it does and how it ended."""

    def __init__(
        self,
        connection: Connection,
        tick: Tick,
        panel: TeachPanel,
        ask: Ask,
        homed: Callable[[], Iterable[str]],
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._connection, self._tick, self._panel, self._homed = connection, tick, panel, homed
        self._ask = AskedOfMachine(connection, ask, lambda why: panel.show_result(why, good=False))
        self.playing: PlayBack | None = None
        panel.play_wanted.connect(self.play)
        panel.next_wanted.connect(self._next)
        panel.halt_wanted.connect(self.halt)
        tick.each(self.look)

    def play(self, step: bool) -> None:
        """Looks where the axes are and which limits there are, then asks."""
        panel, setup = self._panel, self._panel.setup
        if panel.reason or panel.wrong or setup is None or self.playing is not None:
            return
        panel.ended("")
        if any(row.output for row in panel.table.rows) and not self._connection.controller.io_control:
            panel.show_result("Not played back: rows switch outputs. Switch I/O control on first.", good=False)
            return
        motion = self._connection.controller.motion
        motion.setup = setup
        self._tick.when_done(motion.look("XY"), partial(self._looked, panel.table, setup, step))

    def _looked(self, table: Table, setup: Setup, step: bool, future: Future[Any]) -> None:
        if failure := failure_of(future):
            self._panel.show_result(failure, good=False)
            return
        places: Places = future.result()
        if beyond := passes(ends_of(table, setup), places, setup):
            self._panel.show_result(f"Not played back. {beyond}", good=False)
            return
        words = self._words(table, setup, places, step)
        self._ask("Play back?", words, [("Play back", partial(self._begin, table, setup, step))], "warning")

    def _words(self, table: Table, setup: Setup, places: Places, step: bool) -> str:
        number, first = _first(table)
        speed, _ = slow(self._panel.driving, first, setup)
        end = counts_of(first, setup)
        ways = [
            f"{letter} from {told(places.commanded[letter], letter, setup)} to {told(counts, letter, setup)}"
            for letter, counts in zip("XY", end, strict=True)
        ]
        text = f"First slowly, at {speed} {table.units[0]}/s, to the place of row {number + 1}: {', '.join(ways)}. "
        text += "Each row then waits for you." if step else f"Then {len(table)} rows without waiting for you."
        text += _switched({row.output for row in table.rows if row.output})
        unknown = [letter for letter in "XY" if letter not in set(self._homed())]
        if unknown:
            text += f" {' and '.join(unknown)} not seen homed: places may be anywhere."
        return f"{text} Keep your hand at STOP."

    def _begin(self, table: Table, setup: Setup, step: bool) -> None:
        if table is not self._panel.table or setup is not self._panel.setup:
            self._panel.show_result("Not played back: the table was changed meanwhile.", good=False)
            return
        _, first = _first(table)
        _, speeds = slow(self._panel.driving, first, setup)
        ramps = {letter: max(speeds[letter] * 4 // 1024 * 1024, 1024) for letter in "XY"}
        actions: tuple[Action, ...] = actions_of(table, setup, approach(counts_of(first, setup), speeds, ramps))
        controller = self._connection.controller
        make = partial(PlayBack.of, actions, OWNER, step, switches=lambda: controller.io_control)
        self.playing, future = controller.motion.undertake(make)
        self._panel.show_result("Play-back begins.")
        self._tick.when_done(future, self._played)

    def _played(self, future: Future[Any]) -> None:
        self.playing = None
        self._panel.show_play(False, -1, "", False)
        failure = failure_of(future)
        done = None if failure else future.result()
        self._panel.show_result(failure or done.sentence, good=not failure)

    def ghost(self) -> Mapping[str, int]:
        """Where the move on its way ends, for the marks of other panels."""
        return self.playing.end if self.playing is not None else {}

    def _next(self) -> None:
        if self.playing is not None:
            self.playing.go_on()

    def halt(self) -> None:
        """Stops it with the row in hand."""
        if self.playing is not None:
            self._connection.controller.motion.release(OWNER)

    def look(self) -> None:
        """With every tick: what it does now."""
        if self.playing is not None:
            self._panel.show_play(True, self.playing.row, self.playing.doing, self.playing.holds)


def _first(table: Table) -> tuple[int, Row]:
    """The first row with a place."""
    return next((number, row) for number, row in enumerate(table.rows) if row.moves)


def _switched(outputs: Iterable[str]) -> str:
    """Which outputs are switched, as a sentence, or nothing."""
    every = sorted(outputs)
    alone = sorted({text.lstrip("-") for text in every if not BYTE.match(text)}, key=int)
    parts = [f"output{'s' if len(alone) > 1 else ''} {', '.join(alone)}"] if alone else []
    whole = [text for text in every if BYTE.match(text)]
    parts += [f"all outputs as {' and '.join(whole)}"] if whole else []
    return f" It switches {' and '.join(parts)}." if parts else ""
