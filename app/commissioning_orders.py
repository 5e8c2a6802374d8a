"""What each button of the steps does: orders for the link, and the verdict on what came of them."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Any

from app.commissioning_sine import SineOrders
from app.commissioning_stepper import StepperOrders
from app.commissioning_typed import NotTyped, Typed
from codegen.fields import Dimension
from codegen.numbers import parse_number, plain, shown
from codegen.rescale import with_setup
from codegen.setup_registers import BY_COMMAND
from codegen.twoletter.fixed import ONE, scaled
from device.commissioning import judge, moves, settings
from device.commissioning.moves import Trial
from device.commissioning.record import Finding, Verdict
from device.commissioning.seen import NOT_FITTED, NOTHING, Switches, Turned

if TYPE_CHECKING:
    from app.commissioning import Commissioning
    from device.commissioning.judge import Moved

WENT = "Did it go the way that you call forward?"


class Orders(Typed):
    """`carry_out` is told the name of a button."""

    def __init__(self, desk: Commissioning) -> None:
        super().__init__(desk)
        self._does: Mapping[str, Callable[[], None]] = {
            "off": self._off, "safety": self._safety, "begin_encoder": self._begin_encoder, "encoder": self._encoder,
            "take_scale": self._take_scale, "begin_switches": self._begin_switches,
            "nothing": partial(self._answer, NOTHING), "not_fitted": partial(self._answer, NOT_FITTED),
            "guards": self._guards, "polarity": self._polarity,
            "forward": partial(self._direction, True), "backward": partial(self._direction, False),
            "scale": self._scale, "measured": self._measured, "limits": self._limits,
            "take_limits": self._take_limits, "burn": self._ask_burn,
            **SineOrders(desk).does, **StepperOrders(desk).does,
        }  # fmt: skip

    def carry_out(self, name: str) -> None:
        """A button was pressed; a field that is wrong is said, and nothing is sent."""
        self.desk.note = ""
        self.desk.controller.used()
        try:
            self._does[name]()
        except NotTyped as wrong:
            self.desk.note = str(wrong)

    # ---- by hand

    def _off(self) -> None:
        d = self.desk
        d.run("Switching the motor off", settings.motor_off(d.controller, d.record.axis), lambda _: None)

    def _safety(self) -> None:
        d = self.desk
        off = d.controller.last().value(f"motor_off.{d.record.axis.lower()}") == 1
        d.found(judge.judge_safety(d.text("estop") == "yes", d.text("disabled") == "yes", off))

    def _begin_encoder(self) -> None:
        self.desk.turned, self.desk.measured = Turned(), None
        self.desk.begin()

    def _encoder(self) -> None:
        d = self.desk
        seen, typed = d.turned or Turned(), d.text("distance")
        d.found(judge.judge_encoder(seen, typed, d.axis))
        distance = parse_number(typed)
        scale = Fraction(seen.moved) / distance if distance and seen.range > judge.FEW else None
        d.measured = scale if scale is not None and scale > 0 else None

    def _take_scale(self) -> None:
        """One step of the program's history, as Setup does it; what was judged by the old scale is judged again."""
        d = self.desk
        if d.measured is None:
            return
        text = shown(d.measured)
        document, letter = d.session.document, d.record.axis
        setup = document.setup.with_axis(letter, dc.replace(document.setup.axis(letter), counts_per_unit=text))
        d.session.set_document(with_setup(document, setup), "Change scale")
        d.said.emit(f"Axis {letter} has {text} counts in 1 {d.axis.symbol} in the setup now (Undo takes it back).")
        d.measured = parse_number(text)
        (self._encoder if d.step.key == "encoder" else self._measured)()

    def _begin_switches(self) -> None:
        d = self.desk
        limit, home = int(d.text("limit", "-1")), int(d.text("home", "-1"))

        def done(_: object) -> None:
            d.switches = Switches()
            d.begin()

        d.run("Setting CN", settings.set_switches(d.controller, d.record.axis, limit, home), done)

    def _answer(self, outcome: str) -> None:
        d = self.desk
        if d.switches is not None:
            d.switches = d.switches.answered(outcome)
            self.judge_switches()

    def judge_switches(self) -> None:
        """Once all were tripped or answered."""
        d = self.desk
        if d.switches is None or d.switches.asked:
            return
        low = int(d.text("limit", "-1") == "1")
        d.found(judge.judge_switches(d.switches, {"forward": low, "reverse": low, "home": 0}))
        d.switches = None

    # ---- limits

    def _guards(self) -> None:
        error = self.whole("error", "Error limit", "2000")
        torque = self.number("torque", "Torque limit", "1")
        if not 1 <= error <= 32767:
            raise NotTyped("Error limit: write 1 to 32767 counts.")
        if not 0 < torque < 10:
            raise NotTyped("Torque limit: write more than 0, and less than 10 V.")
        self.assign({"OE": ONE, "ER": error * ONE, "TL": scaled(torque)})

    def _limits(self) -> None:
        d = self.desk
        letter, setup = d.record.axis, d.session.document.working_setup
        low, high = (
            self.number("reverse", "Reverse limit", d.axis.reverse_limit),
            self.number("forward", "Forward limit", d.axis.forward_limit),
        )
        torque = None if d.axis.is_stepper else self.number("torque", "Torque limit", d.axis.torque_limit or "9.99")
        if low >= high:
            raise NotTyped(f"The reverse limit {plain(low)} must lie below the forward limit {plain(high)}.")
        if torque is not None and not 0 < torque < 10:
            raise NotTyped("Torque limit: write more than 0, and less than 10 V.")
        counts = d.controller.last().value(f"{d.place}.{letter.lower()}")
        here = setup.from_counts(Dimension.POSITION, letter, int(counts)) if counts == counts else None
        if here is None or not low <= here <= high:
            place = "not known" if here is None else f"{shown(here)} {d.axis.symbol}"
            raise NotTyped(f"The axis is at {place}, which must lie between the limits.")
        trial = setup.with_axis(letter, dc.replace(d.axis, forward_limit=plain(high), reverse_limit=plain(low)))
        wanted = {name: BY_COMMAND[name].wanted(trial, letter) or 0 for name in ("FL", "BL")}
        self.assign({**wanted, **({} if torque is None else {"TL": scaled(torque)})})

    def _take_limits(self) -> None:
        d = self.desk
        document, letter = d.session.document, d.record.axis
        old = document.setup.axis(letter)
        error = parse_number(d.record.text("guards", "error", "2000"))
        axis = dc.replace(
            old,
            forward_limit=d.text("forward", old.forward_limit),
            reverse_limit=d.text("reverse", old.reverse_limit),
        )
        if not old.is_stepper:
            torque = d.text("torque", old.torque_limit or "9.99")
            limit = old.error_limit if error is None else plain(error / old.scale)
            axis = dc.replace(axis, torque_limit=torque, error_limit=limit, off_on_error=True)
        d.session.set_document(with_setup(document, document.setup.with_axis(letter, axis)), "Change limits")
        d.said.emit(f"The limits of axis {letter} are in the setup now (Undo takes it back).")

    # ---- moves

    def _polarity(self) -> None:
        d = self.desk
        counts = self.whole("counts", "Way of the test move", str(moves.TRIAL_COUNTS))
        error = self.whole("error", "Largest error limit", str(moves.TRIAL_ERROR))
        if not error < abs(counts) <= moves.LARGEST_TRIAL:
            raise NotTyped(
                f"The way of the test move must be longer than the error limit, which guards it, and at most "
                f"{moves.LARGEST_TRIAL} counts."
            )

        def done(moved: Moved) -> None:
            d.moved = moved
            finding = judge.judge_polarity(moved, d.record.sine)
            d.still = moved.error if moved.furthest <= 1 else 0
            d.record = dc.replace(d.record, error=moved.error if finding.verdict is Verdict.PASSED else 0)
            if finding.verdict is Verdict.PASSED:
                finding = dc.replace(finding, verdict=Verdict.OPEN, sentence=f"{finding.sentence} {WENT}")
            d.found(finding)

        silent = max(moves.SILENT, 2 * d.still)  # the person has seen that it stood still
        self.move(Trial(d.record.axis, counts, error, self.torque(), silent=silent), done)

    def _direction(self, forward: bool) -> None:
        d = self.desk
        if d.moved is not None:
            went = forward == (d.moved.asked > 0)
            d.found(judge.judge_direction(judge.judge_polarity(d.moved, d.record.sine), went))

    def _scale(self) -> None:
        d = self.desk
        distance = self.number("distance", "Move by")
        counts = d.session.document.working_setup.counts(Dimension.DISTANCE, d.record.axis, distance)
        error = int(parse_number(d.record.text("polarity", "error", "")) or moves.TRIAL_ERROR)

        def done(moved: Moved) -> None:
            d.moved = moved
            finding = judge.judge_scale(moved, d.text("distance"), "", d.axis)
            if finding.verdict is Verdict.OPEN:
                finding = dc.replace(finding, sentence="It has moved. Type what you measured and press “Judge”.")
            d.found(finding)

        known = max(moves.SILENT, d.record.error)
        self.move(Trial(d.record.axis, counts, error, self.torque(), d.axis.is_stepper, silent=known), done)

    def _measured(self) -> None:
        d = self.desk
        if d.moved is None:
            return
        typed = d.text("measured")
        d.found(judge.judge_scale(d.moved, d.text("distance"), typed, d.axis))
        measured = parse_number(typed)
        found = Fraction(d.moved.end - d.moved.start) / measured if measured else Fraction(0)
        d.measured = found if found > 0 else None

    # ---- burn

    def _ask_burn(self) -> None:
        words = settings.BURN_WORDS.format(axis=self.desk.record.axis)
        self.desk.ask("Write to EEPROM?", words, [("Write to EEPROM", self._burn)], "warning")

    def _burn(self) -> None:
        d = self.desk

        def done(reply: Any) -> None:
            words = "Burned: the controller starts with these values from the next power-up on, the motor off."
            good = reply.accepted
            d.found(Finding(Verdict.PASSED if good else Verdict.FAILED, words if good else reply.reason))

        d.run("Writing to EEPROM", settings.burn(d.controller, d.record.axis), done)
