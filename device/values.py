"""Variables and arrays of a controller by name: which there are, and what they hold to the last bit."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Future
from typing import TYPE_CHECKING

from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE, string_text, string_value
from device.backing_up import exact
from device.backup import Value, names_in
from device.download import proved, upload_steps
from device.identify import fence
from device.tasks import LinkError, NotAllowed, Priority, Steps
from device.wire import Kind

if TYPE_CHECKING:
    from device.api import Controller

LIST_S, REFUSAL_S = 10.0, 0.05


def number_text(value: Value) -> str:
    """As a decimal number, exact: 16 bits behind the point are 16 decimals at the most."""
    sign, (whole, rest) = "-" if value < 0 else "", divmod(abs(value), ONE)
    digits = f"{rest * 10**16 // ONE:016d}".rstrip("0")
    return f"{sign}{whole}.{digits}" if digits else f"{sign}{whole}"


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

    def elements(self, name: str) -> Future[tuple[Value, ...]]:
        """All elements of one array."""
        return self._c.run(self._elements(name), Priority.POLL, "user")

    def _allowed(self) -> int:
        """Columns of a line, when something may be read now."""
        if self._c.resting():
            raise NotAllowed(f"Not read: {self._c.resting()}")
        return self._c.model.columns if self._c.model is not None else 40

    def _names(self) -> Steps[tuple[list[str], list[str]]]:
        self._allowed()
        listing = self._c.listing
        if listing is None:
            listing = yield from upload_steps(self._c.nonces, None)
            self._c.set_listing(listing)
        variables, arrays = names_in(listing)
        for command, found in (("LV", variables), ("LA", arrays)):
            if self._c.model is None or command not in COMMANDS or not COMMANDS[command].known_to(self._c.model):
                continue
            answer = yield from proved(self._c.nonces, command, LIST_S, REFUSAL_S)
            if answer.kind is not Kind.ACCEPTED:
                yield from fence(self._c.nonces)
                continue
            listed = [line.split("=")[0].split("[")[0].strip() for line in answer.text.splitlines()]
            found += [name for name in listed if name.isalnum() and name not in found]
        return variables, arrays

    def _read(self, names: tuple[str, ...]) -> Steps[dict[str, Value]]:
        values = yield from exact(self._c.nonces, names, self._allowed())
        return {name: value for name, value in zip(names, values, strict=True) if value is not None}

    def _elements(self, name: str) -> Steps[tuple[Value, ...]]:
        columns = self._allowed()
        count = yield from self._count(name, columns)
        if not count:
            raise LinkError(f"The controller has no array {name}.")
        values = yield from exact(self._c.nonces, [f"{name}[{place}]" for place in range(count)], columns)
        return tuple(value for value in values if value is not None)

    def _count(self, name: str, columns: int) -> Steps[int]:
        """How many elements there are: an element that does not exist is refused; halving finds the first of those."""
        low, high = 0, self._c.model.elements if self._c.model is not None else 1000
        while low < high:
            middle = (low + high) // 2
            found = yield from exact(self._c.nonces, [f"{name}[{middle}]"], columns)
            low, high = (middle + 1, high) if found[0] is not None else (low, middle)
        return low
