"""What a form can offer while it is filled in: the machine, and the names the program already has."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from codegen.document import Document
from codegen.ingredients import arrays_of
from codegen.program import Place, labels, variables
from codegen.setup import Setup
from codegen.standing import Standing, standing_at


class LiveValues(Protocol):
    """Reads what expressions are made of from the controller, again and again while somebody watches."""

    def watch(self, owner: object, texts: Sequence[str], call: Callable[[Mapping[str, float | str]], None]) -> None:
        """Calls back with the value of each text, or with why it has none; with nothing while offline."""

    def forget(self, owner: object) -> None:
        """Nobody watches any more."""


@dataclass(frozen=True)
class Offers:
    """Setup, labels and names of one document, and the values they have on the controller."""

    setup: Setup
    labels: tuple[str, ...] = ()
    variables: tuple[str, ...] = ()
    arrays: tuple[str, ...] = ()
    live: LiveValues | None = field(default=None, compare=False)
    standing: Standing = field(default_factory=Standing)  # before the step


def offers_of(document: Document, live: LiveValues | None = None, place: Place | None = None) -> Offers:
    """What a document offers to its forms, at a place of its program."""
    program, setup = document.program, document.working_setup
    standing = standing_at(program, place, setup) if place is not None else Standing()
    return Offers(setup, labels(program), variables(program), arrays_of(program), live, standing)
