"""The document: what is saved, undone and compared as one."""

# ruff: noqa: RUF009  (Program and Setup are frozen)

from __future__ import annotations

import dataclasses as dc
from functools import lru_cache

from codegen.handover import Handover
from codegen.instructions import LoopRate
from codegen.numbers import parse_number
from codegen.program import Program
from codegen.setup import Setup


@dc.dataclass(frozen=True)
class Document:
    """A program with the machine it is for, the stimulus of its dry run, and notes."""

    program: Program = Program()
    setup: Setup = Setup()
    stimulus: str = ""
    notes: str = ""
    handover: Handover = Handover()
    compact: bool = False  # several statements a line from the start

    @property
    def working_setup(self) -> Setup:
        """The setup while the program runs: with the loop rate the configuration sets."""
        period = self.setup.sample_us
        for step in self.program.configuration:
            if step.enabled and isinstance(step.instruction, LoopRate) and parse_number(step.instruction.period):
                period = step.instruction.period
        return self.setup if period == self.setup.sample_us else _at(self.setup, period)


@lru_cache(maxsize=16)
def _at(setup: Setup, period: str) -> Setup:
    return dc.replace(setup, sample_us=period)
