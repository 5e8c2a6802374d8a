"""Orders of a stepper: its kind and smoothing, and a test move that only the person can judge."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING

from app.commissioning_typed import NotTyped, Typed
from codegen.numbers import plain
from codegen.rescale import with_setup
from codegen.setup_axis import MotorType
from codegen.setup_registers import BY_COMMAND
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import scaled
from device.commissioning import judge_stepper, moves
from device.commissioning.moves import Trial
from device.commissioning.record import Verdict

if TYPE_CHECKING:
    from device.commissioning.judge import Moved

WENT = "Which way did the motor turn?"


class StepperOrders(Typed):
    """Motor type and smoothing, direction."""

    @property
    def does(self) -> Mapping[str, Callable[[], None]]:
        return {
            "stepper": self._stepper, "take_stepper": self._take, "pulses": self._pulses,
            "turned_forward": partial(self._turned, True), "turned_backward": partial(self._turned, False),
            "turned_not": partial(self._turned, None),
        }  # fmt: skip

    def _stepper(self) -> None:
        smoothing, row = self.number("smoothing", "Smoothing", self.desk.axis.smoothing or "2"), COMMANDS["KS"]
        low, high = row.low or 0, row.high or 0
        if not low <= smoothing <= high:
            raise NotTyped(f"Smoothing: write {low:g} to {high:g}.")
        setup, letter = self.desk.session.document.working_setup, self.desk.record.axis
        kind = MotorType(self.desk.text("kind", self.desk.axis.motor))
        trial = setup.with_axis(letter, dc.replace(self.desk.axis, motor=kind))
        self.assign({"MT": BY_COMMAND["MT"].wanted(trial, letter) or 0, "KS": row.stored(scaled(smoothing))})

    def _take(self) -> None:
        d, letter = self.desk, self.desk.record.axis
        setup = d.session.document.setup
        smoothing = plain(self.number("smoothing", "Smoothing", d.axis.smoothing or "2"))
        axis = dc.replace(setup.axis(letter), motor=MotorType(d.text("kind", d.axis.motor)), smoothing=smoothing)
        d.session.set_document(with_setup(d.session.document, setup.with_axis(letter, axis)), "Change motor type")
        d.said.emit(f"Motor type and smoothing of axis {letter} are in the setup now (Undo takes it back).")

    def _pulses(self) -> None:
        d = self.desk
        counts = self.whole("counts", "Way of the test move", str(moves.TRIAL_COUNTS))

        def done(moved: Moved) -> None:
            d.moved = moved
            finding = judge_stepper.judge_pulses(moved)
            if finding.verdict is Verdict.OPEN:
                finding = dc.replace(finding, sentence=f"{finding.sentence} {WENT}")
            d.found(finding)

        self.move(Trial(d.record.axis, counts, stepper=True), done)

    def _turned(self, forward: bool | None) -> None:
        if self.desk.moved is not None:
            self.desk.found(judge_stepper.judge_turned(self.desk.moved, forward))
