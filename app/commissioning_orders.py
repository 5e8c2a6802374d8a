"""What each button of the steps does: orders for the link, and the verdict on what came of them."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Any

from codegen.fields import Dimension
from codegen.numbers import number_problem, parse_number, plain, shown
from codegen.rescale import with_setup
from codegen.setup_registers import BY_COMMAND
from codegen.twoletter.fixed import ONE, scaled
from device.commissioning import judge, moves, settings, sine
from device.commissioning.moves import Trial
from device.commissioning.record import Finding, Verdict
from device.commissioning.seen import NOT_FITTED, NOTHING, Switches, Turned
from device.download import Job

if TYPE_CHECKING:
    from app.commissioning import Commissioning
    from device.commands import Reply
    from device.commissioning.judge import Moved

WENT = "Did it go the way that you call forward?"
UNITS = {"ER": "counts", "TL": "V", "FL": "counts", "BL": "counts", "OE": ""}


class NotTyped(Exception):
    """A field that has to be put right first; the text is the sentence."""


class Orders:
    """`carry_out` is told the name of a button."""

    def __init__(self, desk: Commissioning) -> None:
        self._d = desk
        self._does: Mapping[str, Callable[[], None]] = {
            "off": self._off, "safety": self._safety, "begin_encoder": self._begin_encoder, "encoder": self._encoder,
            "take_scale": self._take_scale, "begin_switches": self._begin_switches,
            "nothing": partial(self._answer, NOTHING), "not_fitted": partial(self._answer, NOT_FITTED),
            "guards": self._guards, "phases": self._ask_phases, "zero": self._ask_zero, "polarity": self._polarity,
            "forward": partial(self._direction, True), "backward": partial(self._direction, False),
            "scale": self._scale, "measured": self._measured, "limits": self._limits,
            "halls": self._halls, "take_limits": self._take_limits, "burn": self._ask_burn,
        }  # fmt: skip

    def carry_out(self, name: str) -> None:
        """A button was pressed; a field that is wrong is said, and nothing is sent."""
        self._d.note = ""
        self._d.controller.used()
        try:
            self._does[name]()
        except NotTyped as wrong:
            self._d.note = str(wrong)

    def _number(self, name: str, label: str, usual: str = "") -> Fraction:
        text = self._d.text(name, usual)
        number = parse_number(text)
        if number is None:
            raise NotTyped(f"{label}: {number_problem(text)}.")
        return number

    def _whole(self, name: str, label: str, usual: str = "") -> int:
        number = self._number(name, label, usual)
        if number.denominator != 1:
            raise NotTyped(f"{label}: write a whole number.")
        return int(number)

    # ---- by hand

    def _off(self) -> None:
        d = self._d
        d.run("Switching the motor off", settings.motor_off(d.controller, d.record.axis), lambda _: None)

    def _safety(self) -> None:
        d = self._d
        off = d.controller.last().value(f"motor_off.{d.record.axis.lower()}") == 1
        d.found(judge.judge_safety(d.text("estop") == "yes", d.text("disabled") == "yes", off))

    def _begin_encoder(self) -> None:
        self._d.turned, self._d.measured = Turned(), None
        self._d.begin()

    def _encoder(self) -> None:
        d = self._d
        seen, typed = d.turned or Turned(), d.text("distance")
        d.found(judge.judge_encoder(seen, typed, d.axis))
        distance = parse_number(typed)
        scale = Fraction(seen.moved) / distance if distance and seen.range > judge.FEW else None
        d.measured = scale if scale is not None and scale > 0 else None

    def _take_scale(self) -> None:
        """One step of the program's history, as Setup does it; what was judged by the old scale is judged again."""
        d = self._d
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
        d = self._d
        limit, home = int(d.text("limit", "-1")), int(d.text("home", "-1"))

        def done(_: object) -> None:
            d.switches = Switches()
            d.begin()

        d.run("Setting CN", settings.set_switches(d.controller, d.record.axis, limit, home), done)

    def _answer(self, outcome: str) -> None:
        d = self._d
        if d.switches is not None:
            d.switches = d.switches.answered(outcome)
            self.judge_switches()

    def judge_switches(self) -> None:
        """Once all were tripped or answered."""
        d = self._d
        if d.switches is None or d.switches.asked:
            return
        low = int(d.text("limit", "-1") == "1")
        d.found(judge.judge_switches(d.switches, {"forward": low, "reverse": low, "home": 0}))
        d.switches = None

    # ---- limits

    def _guards(self) -> None:
        error = self._whole("error", "Error limit", "2000")
        torque = self._number("torque", "Torque limit", "1")
        if not 1 <= error <= 32767:
            raise NotTyped("Error limit: write 1 to 32767 counts.")
        if not 0 < torque < 10:
            raise NotTyped("Torque limit: write more than 0, and less than 10 V.")
        self._set({"OE": ONE, "ER": error * ONE, "TL": scaled(torque)})

    def _limits(self) -> None:
        d = self._d
        letter, setup = d.record.axis, d.session.document.working_setup
        low, high = (
            self._number("reverse", "Reverse limit", d.axis.reverse_limit),
            self._number("forward", "Forward limit", d.axis.forward_limit),
        )
        torque = self._number("torque", "Torque limit", d.axis.torque_limit or "9.99")
        if low >= high:
            raise NotTyped(f"The reverse limit {plain(low)} must lie below the forward limit {plain(high)}.")
        if not 0 < torque < 10:
            raise NotTyped("Torque limit: write more than 0, and less than 10 V.")
        counts = d.controller.last().value(f"position.{letter.lower()}")
        here = setup.from_counts(Dimension.POSITION, letter, int(counts)) if counts == counts else None
        if here is None or not low <= here <= high:
            place = "not known" if here is None else f"{shown(here)} {d.axis.symbol}"
            raise NotTyped(f"The axis is at {place}, which must lie between the limits.")
        trial = setup.with_axis(letter, dc.replace(d.axis, forward_limit=plain(high), reverse_limit=plain(low)))
        wanted = {name: BY_COMMAND[name].wanted(trial, letter) or 0 for name in ("FL", "BL")}
        self._set({**wanted, "TL": scaled(torque)})

    def _set(self, wanted: dict[str, int]) -> None:
        d = self._d

        def done(result: tuple[Mapping[str, int], Mapping[str, int]]) -> None:
            former, there = result
            finding = judge.judge_set(*({name: _told(name, each[name]) for name in each} for each in (wanted, there)))
            was = tuple((f"{name} before", _told(name, former[name])) for name in wanted)
            d.found(dc.replace(finding, facts=(*finding.facts, *was)))

        steps = settings.set_values(d.controller, d.record.axis, wanted, d.folder, d.now())
        d.run("Setting and reading back", steps, done)

    def _take_limits(self) -> None:
        d = self._d
        document, letter = d.session.document, d.record.axis
        old = document.setup.axis(letter)
        error = parse_number(d.record.text("guards", "error", "2000"))
        axis = dc.replace(
            old,
            forward_limit=d.text("forward", old.forward_limit),
            reverse_limit=d.text("reverse", old.reverse_limit),
            torque_limit=d.text("torque", old.torque_limit or "9.99"),
            error_limit=old.error_limit if error is None or old.is_stepper else plain(error / old.scale),
            off_on_error=True,
        )
        d.session.set_document(with_setup(document, document.setup.with_axis(letter, axis)), "Change limits")
        d.said.emit(f"The limits of axis {letter} are in the setup now (Undo takes it back).")

    # ---- moves

    def _move(self, trial: Trial, done: Callable[[Moved], None]) -> None:
        d = self._d
        if trial.problem:
            raise NotTyped(f"Not moved: {trial.problem}")
        d.moved = d.measured = None
        job: Job[Moved] = Job()
        steps = moves.move(d.controller, trial, d.folder, d.now(), job)
        d.run(f"Axis {trial.axis} moves", steps, done, job)

    def _polarity(self) -> None:
        d = self._d
        counts = self._whole("counts", "Way of the test move", str(moves.TRIAL_COUNTS))
        error = self._whole("error", "Error limit meanwhile", str(moves.TRIAL_ERROR))
        if not error < abs(counts) <= moves.LARGEST_TRIAL:
            raise NotTyped(
                f"The way of the test move must be longer than the error limit, which guards it, and at most "
                f"{moves.LARGEST_TRIAL} counts."
            )

        def done(moved: Moved) -> None:
            d.moved = moved
            finding = judge.judge_polarity(moved, d.record.sine)
            if finding.verdict is Verdict.PASSED:
                finding = dc.replace(finding, verdict=Verdict.OPEN, sentence=f"{finding.sentence} {WENT}")
            d.found(finding)

        self._move(Trial(d.record.axis, counts, error, self._torque()), done)

    def _torque(self) -> Fraction:
        return parse_number(self._d.record.text("guards", "torque", "1")) or Fraction(1)

    def _direction(self, forward: bool) -> None:
        d = self._d
        if d.moved is not None:
            went = forward == (d.moved.asked > 0)
            d.found(judge.judge_direction(judge.judge_polarity(d.moved, d.record.sine), went))

    def _scale(self) -> None:
        d = self._d
        distance = self._number("distance", "Move by")
        counts = d.session.document.working_setup.counts(Dimension.DISTANCE, d.record.axis, distance)
        error = int(parse_number(d.record.text("polarity", "error", "")) or moves.TRIAL_ERROR)

        def done(moved: Moved) -> None:
            d.moved = moved
            finding = judge.judge_scale(moved, d.text("distance"), "", d.axis)
            if finding.verdict is Verdict.OPEN:
                finding = dc.replace(finding, sentence="It has moved. Type what you measured and press “Judge”.")
            d.found(finding)

        self._move(Trial(d.record.axis, counts, error, self._torque(), d.axis.is_stepper), done)

    def _measured(self) -> None:
        d = self._d
        if d.moved is None:
            return
        typed = d.text("measured")
        d.found(judge.judge_scale(d.moved, d.text("distance"), typed, d.axis))
        measured = parse_number(typed)
        found = Fraction(d.moved.end - d.moved.start) / measured if measured else Fraction(0)
        d.measured = found if found > 0 else None

    # ---- sine commutation

    def _ask_phases(self) -> None:
        d = self._d
        phases = sine.Phases(
            d.record.axis, self._number("cycle", "Magnetic cycle"), int(d.text("halls", "0")),
            self._number("volts", "Voltage", "2"), self._whole("time", "Time for each phase", "200"),
        )  # fmt: skip
        if phases.problem:
            raise NotTyped(f"Not tested: {phases.problem}")
        words = (
            f"The motor turns {shown(phases.cycle)} counts there and back, driven with {shown(phases.volts)} V, for "
            f"about {phases.seconds:.1f} s. {DEAF}"
        )
        d.ask("Turn the motor by one magnetic cycle?", words, [("Turn it", partial(self._phases, phases))], "warning")

    def _phases(self, phases: sine.Phases) -> None:
        d = self._d

        def done(answer: str) -> None:
            d.found(judge.judge_phases(answer, plain(phases.cycle)))

        d.run("The motor turns", sine.try_phases(d.controller, phases), done)

    def _ask_zero(self) -> None:
        d = self._d
        volts, offset = self._number("volts", "Voltage", "2"), self._whole("offset", "Offset", "0")
        if not 0 <= offset <= 360:
            raise NotTyped("Offset of the hall sensors: write 0 to 360 degrees.")
        words = f"The motor jerks to the next zero of its phase, with {shown(volts)} V, for about 2 s. {DEAF}"
        d.ask("Drive to commutation zero?", words, [("Drive it", partial(self._zero, volts, offset))], "warning")

    def _zero(self, volts: Fraction, offset: int) -> None:
        d = self._d

        def done(result: tuple[Reply, int | None]) -> None:
            reply, counts = result
            d.found(judge.judge_zero(reply.accepted, reply.code, counts))

        d.run("The motor goes to zero", sine.drive_to_zero(d.controller, d.record.axis, volts, offset), done)

    def _halls(self) -> None:
        d = self._d
        cycle = parse_number(d.record.text("phases", "cycle"))
        if cycle is None:
            raise NotTyped("Type the magnetic cycle under “Phases and halls” first.")

        def done(result: tuple[Moved, int, int]) -> None:
            d.found(judge.judge_halls(*result))

        job: Job[Moved] = Job()
        steps = sine.by_halls(d.controller, d.record.axis, cycle, self._torque(), d.folder, d.now(), job)
        d.run(f"Axis {d.record.axis} moves", steps, done, job)

    # ---- burn

    def _ask_burn(self) -> None:
        words = settings.BURN_WORDS.format(axis=self._d.record.axis)
        self._d.ask("Write to EEPROM?", words, [("Write to EEPROM", self._burn)], "warning")

    def _burn(self) -> None:
        d = self._d

        def done(reply: Any) -> None:
            words = "Burned: the controller starts with these values from the next power-up on, the motor off."
            good = reply.accepted
            d.found(Finding(Verdict.PASSED if good else Verdict.FAILED, words if good else reply.reason))

        d.run("Writing to EEPROM", settings.burn(d.controller, d.record.axis), done)


DEAF = (
    "While it does, the controller hears nothing, STOP included: keep a hand at the machine's emergency stop. The "
    "motor goes off at the end."
)


def _told(name: str, value: int) -> str:
    """A register in words: `1 V`, `2000 counts`, `off` for a limit that is none."""
    if name in ("FL", "BL") and abs(value // ONE) >= 2**31 - 1:
        return "off"
    number = f"{value / ONE:.3f}".rstrip("0").rstrip(".")
    return f"{number} {UNITS[name]}".strip()
