"""What a setup leaves unprotected, in the amber words of an axis."""

from __future__ import annotations

from codegen.fields import OFF, Dimension
from codegen.numbers import shown
from codegen.setup import Axis, Setup
from codegen.setup_registers import BY_COMMAND, factory
from codegen.twoletter.fixed import ONE


def unprotected(setup: Setup, letter: str) -> tuple[str, ...]:
    """Amber words of one axis, shortest first: OE 0, no travel limits, following error at its default."""
    axis = setup.axis(letter)
    found = [] if _limited(axis) else [_travel_words(axis)]
    if not axis.is_stepper:
        if not axis.off_on_error:
            found.insert(0, "OE 0: the motor stays on however large its following error")
        error = BY_COMMAND["ER"]
        counts = factory(error.command)
        wanted = error.wanted(setup, letter)
        if wanted is None or error.same(wanted, counts):
            units = setup.from_counts(Dimension.ERROR, letter, counts // ONE)
            found.append(f"following error at its default: {counts // ONE} counts = {shown(units)} {axis.symbol}")
    return tuple(found)


def _limited(axis: Axis) -> bool:
    return all(text.strip() and text.strip().lower() != OFF for text in (axis.forward_limit, axis.reverse_limit))


def _travel_words(axis: Axis) -> str:
    forward, reverse = (
        not text.strip() or text.strip().lower() == OFF for text in (axis.forward_limit, axis.reverse_limit)
    )
    if forward and reverse:
        return "no travel limits (FL, BL)"
    return "no forward travel limit (FL)" if forward else "no reverse travel limit (BL)"
