"""Arrays for a capture: names nobody has, room nobody needs, RA and RD, and giving everything back."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from codegen.models import Model
from codegen.twoletter import nodes
from codegen.twoletter.parse import parse
from device.backup import names_in
from device.capture import Plan, most, too_short
from device.capture_talk import NOT, Talk
from device.download import held_program
from device.tasks import LinkError, NotAllowed, Steps
from device.wire import Shape

if TYPE_CHECKING:
    from device.api import Controller

NAMES = ("ZCA", "ZKA", "ZXA")  # first of four arrays each; no command begins like these


class Room:
    """The arrays of one capture."""

    def __init__(self, c: Controller, plan: Plan, talk: Talk) -> None:
        self._c, self._plan, self._talk = c, plan, talk
        self.names: list[str] = []
        self.began = False
        self.tm = 1000.0

    def prepare(self, model: Model) -> Steps[None]:
        """Room, names, RA and RD; raises one sentence where something stands against it."""
        records, tm = yield from self._talk.numbers(("_RC", Shape(1, 0)), ("_TM", Shape(5, 0)))
        if records and not (yield from self._left_recording(model)):
            raise NotAllowed(f"{NOT}: the controller is recording already (_RC is 1). Wait for its end, or send RC 0.")
        self.tm = tm
        plan = self._plan
        if problem := too_short(plan, tm):
            raise NotAllowed(f"{NOT}: {problem}")
        reserved = yield from self._reserved(model)
        yield from self._room(model, reserved)
        yield from self._dimension()
        yield from self._talk.must("RA " + ",".join(f"{name}[]" for name in self.names))
        yield from self._talk.must("RD " + ",".join(channel.code for channel in plan.channels))

    def _left_recording(self, model: Model) -> Steps[bool]:
        """Round and round into arrays of ours, since the line was lost: ended, and the arrays given back."""
        if (yield from self._running(model)):
            return False
        listing = yield from self._listing()
        for first in NAMES:
            name = _names(first, 1)[0]
            if not re.search(rf"\b{name}\b", listing) and (yield from self._talk.known(f"{name}[0]")):
                yield from self._talk.must("RC 0")
                yield from self._free_left()
                return True
        return False

    def _running(self, model: Model) -> Steps[frozenset[int]]:
        """Lines of the program that run now."""
        lines = yield from self._talk.numbers(*((f"_XQ{n}", Shape(4, 0)) for n in range(min(model.threads, 2))))
        if model.threads > 2:
            lines += yield from self._talk.numbers(*((f"_XQ{n}", Shape(4, 0)) for n in range(2, model.threads)))
        running = frozenset(int(line) for line in lines if line >= 0)
        self._c.waiting.threads(running)
        return running

    def _reserved(self, model: Model) -> Steps[int]:
        """Elements that a running program may still want; raises where it records by itself."""
        if not (yield from self._running(model)):
            return 0
        listing = yield from self._listing()
        place = next((n for n, text in enumerate(listing.split("\n")) if re.search(r"(?:^|[;\s])R[ACD]\b", text)), None)
        if place is not None:
            raise NotAllowed(f"{NOT}: the running program records by itself (line {place}). Halt it first.")
        for line, item in _made(listing):
            known = isinstance(item.size, nodes.Number) or (yield from self._talk.known(f"{item.name}[0]"))
            if not known:
                raise NotAllowed(
                    f"{NOT}: the running program will make {item.name}[] in line {line}, of a size that is not known "
                    "here; the capture could take its room. Capture when it has, or halt it first."
                )
        return _wanted(listing)

    def _room(self, model: Model, reserved: int) -> Steps[None]:
        """Enough elements and arrays must be free; what a capture that broke off has left is given back."""
        plan = self._plan
        need, several = plan.count * len(plan.channels), len(plan.channels)
        for again in (False, True):
            free, arrays = yield from self._talk.numbers(("_DM", Shape(5, 0)), ("_DA", Shape(2, 0)))
            kept = max(0, reserved - (model.elements - int(free)))
            if need <= free - kept and several <= arrays:
                return
            if not again:
                yield from self._free_left()
        there = names_in((yield from self._listing()))[1]
        used = f" Its program uses {', '.join(f'{name}[]' for name in there)}." if there else ""
        fits = most(model, several, int(free) - kept)
        raise NotAllowed(
            f"{NOT}: {need} array elements are needed, {int(free) - kept} of {model.elements} are free "
            f"({int(arrays)} arrays).{used} Take {fits} values a channel at most, or free an array (DA)."
            if fits and several <= arrays
            else f"{NOT}: the controller has {int(free) - kept} array elements and {int(arrays)} arrays free, "
            f"{need} and {several} are needed.{used} Free arrays first (DA)."
        )

    def _free_left(self) -> Steps[None]:
        """Arrays of ours that a capture has left which could not end; never one its program knows."""
        listing = yield from self._listing()
        for first in NAMES:
            for name in _names(first, 4):
                if not re.search(rf"\b{name}\b", listing):
                    yield from self._talk.accepted(f"DA {name}[]")

    def _dimension(self) -> Steps[None]:
        """Arrays under names that nobody has: DM refuses one that is there already."""
        plan = self._plan
        listing = self._c.listing or ""
        for first in NAMES:
            names = _names(first, len(plan.channels))
            if any(re.search(rf"\b{name}\b", listing) for name in names):
                continue
            for name in names:
                if (yield from self._talk.accepted(f"DM {name}[{plan.count}]")):
                    self.names.append(name)
                    continue
                yield from self.clean()
                self.names = []
                break
            else:
                return
        raise NotAllowed(f"{NOT}: the controller refused the arrays {', '.join(NAMES)} (their names are taken).")

    def _listing(self) -> Steps[str]:
        """The program in the controller; read where it is not known."""
        if self._c.listing is None:
            self._c.set_listing((yield from held_program(self._c.waiting, self._c.nonces)))
        return self._c.listing or ""

    def clean(self) -> Steps[None]:
        """Ends the recording and gives the arrays back, whatever came in between."""
        lines = ["RC 0"] if self.began else []
        if self.names:
            lines.append("DA " + ",".join(f"{name}[]" for name in self.names))
        for line in lines:
            try:
                yield from self._talk.exchange(*self._talk.line_and_proof(line), keep=True)
            except LinkError:
                return  # Control is gone, or the line: the next capture frees them


def _names(first: str, count: int) -> list[str]:
    return [first[:-1] + letter for letter in "ABCD"[:count]]


def _made(listing: str) -> Iterator[tuple[int, nodes.Dimension]]:
    """Every array that a program makes, and the line in which it does."""
    for number, line in enumerate(parse(listing).lines):
        for statement in line.statements:
            if isinstance(statement, nodes.Command) and statement.name == "DM":
                yield from ((number, item) for item in statement.arguments if isinstance(item, nodes.Dimension))


def _wanted(listing: str) -> int:
    """Elements the DM of a program ask for, as far as they are plain numbers."""
    sizes = [item.size for _, item in _made(listing)]
    return sum(size.scaled // nodes.ONE for size in sizes if isinstance(size, nodes.Number))
