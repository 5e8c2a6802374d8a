"""Variables and arrays of a controller by name: which there are, and what they hold to the last bit."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from codegen.models import Model
from codegen.twoletter.fixed import string_text, string_value
from device.backing_up import exact, listed
from device.backup import Value
from device.download import held_program
from device.tasks import LinkError, NotAllowed, Priority, Steps

if TYPE_CHECKING:
    from device.api import Controller


AT_ONCE = 32  # elements of an array between two looks whether they are still wanted


@dataclass
class Elements:
    """An array while it is read: what has come so far, of how many; `wanted` is set to False to end it."""

    name: str
    values: list[Value] = field(default_factory=list)
    total: int = 0
    wanted: bool = True


def letters_of(value: Value) -> str:
    """The string a value may be (up to six characters), or nothing when it is none."""
    text = string_text(value)
    return text if text and value == string_value(text) and all(" " <= each <= "~" for each in text) else ""


class Values:
    """Reads through the link like every panel: never while a question of a program waits."""

    def __init__(self, controller: Controller) -> None:
        self._c = controller

    def names(self) -> Future[tuple[list[str], list[str]]]:
        """Names of variables and arrays: those the controller lists, and those that its program names."""
        return self._c.run(self._names(), Priority.POLL, "user")

    def read(self, names: Sequence[str]) -> Future[dict[str, Value]]:
        """The values of these variables or elements (`V1`, `A[3]`); what the controller does not know is left out."""
        return self._c.run(self._read(tuple(names)), Priority.POLL, "user")

    def elements(self, elements: Elements) -> Future[Elements]:
        """All elements of one array; they can be looked at while they come."""
        return self._c.run(self._elements(elements), Priority.POLL, "user")

    def _allowed(self) -> Model:
        """The controller's model, when something may be read now."""
        if self._c.resting():
            raise NotAllowed(f"Not read: {self._c.resting()}")
        if self._c.model is None:
            raise NotAllowed("Not read: the controller's model is not known.")
        return self._c.model

    def _names(self) -> Steps[tuple[list[str], list[str]]]:
        model = self._allowed()
        listing = self._c.listing
        if listing is None:
            listing = yield from held_program(self._c.waiting, self._c.nonces)
            self._c.set_listing(listing)
        return (yield from listed(self._c, model, listing))

    def _read(self, names: tuple[str, ...]) -> Steps[dict[str, Value]]:
        values = yield from exact(self._c.nonces, names, self._allowed().columns)
        return {name: value for name, value in zip(names, values, strict=True) if value is not None}

    def _elements(self, elements: Elements) -> Steps[Elements]:
        model = self._allowed()
        total = yield from self._count(elements.name, model)
        if not total:
            raise LinkError(f"The controller has no array {elements.name}.")
        elements.total = total
        for first in range(0, total, AT_ONCE):
            if not elements.wanted:
                raise NotAllowed(f"{elements.name} was not read to its end.")
            self._allowed()
            names = [f"{elements.name}[{place}]" for place in range(first, min(first + AT_ONCE, total))]
            values = yield from exact(self._c.nonces, names, model.columns)
            elements.values += [value for value in values if value is not None]
        return elements

    def _count(self, name: str, model: Model) -> Steps[int]:
        """How many elements there are: an element that does not exist is refused; halving finds the first of those."""
        low, high = 0, model.elements
        while low < high:
            middle = (low + high) // 2
            found = yield from exact(self._c.nonces, [f"{name}[{middle}]"], model.columns)
            low, high = (middle + 1, high) if found[0] is not None else (low, middle)
        return low
