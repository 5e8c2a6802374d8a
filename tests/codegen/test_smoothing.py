"""Smoothing 0 … 255 reaches the controller as exactly (256 − s)/256, which it rounds down to 1/256."""

from __future__ import annotations

import pytest

from codegen.generate import code
from codegen.instructions import SingleAxisMove
from codegen.setup import Axis, Setup
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE, scaled


@pytest.mark.parametrize("smoothing", range(256))
def test_every_smoothing_is_stored_as_it_was_meant(smoothing: int) -> None:
    setup = Setup().with_axis("X", Axis(counts_per_unit="4000"))
    lines = code(SingleAxisMove(distance="1", smoothing=str(smoothing)), setup)
    (sent,) = (line.removeprefix("IT ") for line in lines if line.startswith("IT "))
    assert COMMANDS["IT"].stored(scaled(sent)) == max(256 - smoothing, 1) * ONE // 256
