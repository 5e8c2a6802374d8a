"""What a controller is doing: the threads that run and the axes that move, in words."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Future
from dataclasses import dataclass

from device.api import Controller
from widgets.display.threads import thread_words

SEQUENCE = "S"  # a coordinated motion, as BG and ST name it


@dataclass(frozen=True)
class Work:
    """Threads by number, with the line each is on, and letters of what moves."""

    threads: tuple[tuple[int, int], ...] = ()
    moving: str = ""

    @property
    def words(self) -> str:
        """As a sentence; nothing when it rests."""
        axes = self.moving.replace(SEQUENCE, "")
        found = ["a program runs"] if self.threads else []
        path = " on a common path" if SEQUENCE in self.moving else ""
        found += [f"{' '.join(axes)} {'moves' if len(axes) == 1 else 'move'}{path}"] if axes else []
        found += ["a coordinated motion goes on"] if path and not axes else []
        words = ", ".join(found)
        return f"{words[0].upper()}{words[1:]}." if words else ""

    def told(self, source: Sequence[str]) -> str:
        """The same with every thread and the line it is on, a line each; `source`: the program's lines, if known."""
        threads = [thread_words(number, line, source) for number, line in self.threads]
        return "\n".join([*threads, *([f"▲  {Work(moving=self.moving).words}"] if self.moving else [])])


@dataclass(frozen=True)
class Inquiry:
    """What a controller is asked; its type may become known before it answers, so this stays as it was asked."""

    threads: int
    motions: str
    answer: Future[tuple[float, ...]]

    def work(self) -> Work:
        """What the answer means; it has come."""
        values = self.answer.result()
        threads = tuple((number, int(line)) for number, line in enumerate(values[: self.threads]) if line >= 0)
        moving = [each for each, value in zip(self.motions, values[self.threads :], strict=True) if value]
        return Work(threads, "".join(moving))


def inquire(controller: Controller) -> Inquiry:
    """Asks which threads run and what moves."""
    model = controller.model
    threads = model.threads if model is not None else 1
    motions = controller.axes + (SEQUENCE if model is not None and model.coordinated else "")
    asked = [*(f"_XQ{number}" for number in range(threads)), *(f"_BG{each}" for each in motions)]
    return Inquiry(threads, motions, controller.read(*asked))
