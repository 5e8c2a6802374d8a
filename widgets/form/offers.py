"""What a form can offer while it is filled in: the machine, and the names the program already has."""

from __future__ import annotations

from dataclasses import dataclass

from codegen.document import Document
from codegen.program import labels, variables
from codegen.setup import Setup


@dataclass(frozen=True)
class Offers:
    """Setup, labels and variables of one document."""

    setup: Setup
    labels: tuple[str, ...] = ()
    variables: tuple[str, ...] = ()


def offers_of(document: Document) -> Offers:
    """What a document offers to its forms."""
    return Offers(document.working_setup, labels(document.program), variables(document.program))
