"""Orders of sine commutation: the field turns, jerks to zero, or is set by the hall sensors."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING

from app.commissioning_typed import NotTyped, Typed
from codegen.numbers import parse_number, plain, shown
from device.commissioning import judge_sine, sine
from device.commissioning.moves import SILENT
from device.download import Job

if TYPE_CHECKING:
    from device.commands import Reply
    from device.commissioning.judge import Moved

DEAF = (
    "While it does, the controller hears nothing, STOP included: keep a hand at the machine's emergency stop. The "
    "motor goes off at the end."
)


class SineOrders(Typed):
    """Phases, zero, halls."""

    @property
    def does(self) -> Mapping[str, Callable[[], None]]:
        return {"phases": self._ask_phases, "zero": self._ask_zero, "halls": self._halls}

    def _ask_phases(self) -> None:
        d = self.desk
        phases = sine.Phases(
            d.record.axis, self.number("cycle", "Magnetic cycle"), int(d.text("halls", "0")),
            self.number("volts", "Voltage", "2"), self.whole("time", "Time for each phase", "200"),
        )  # fmt: skip
        if phases.problem:
            raise NotTyped(f"Not tested: {phases.problem}")
        words = (
            f"The motor turns {shown(phases.cycle)} counts there and back, driven with {shown(phases.volts)} V, for "
            f"about {phases.seconds:.1f} s. {DEAF}"
        )
        d.ask("Turn the motor by one magnetic cycle?", words, [("Turn it", partial(self._phases, phases))], "warning")

    def _phases(self, phases: sine.Phases) -> None:
        d = self.desk

        def done(answer: str) -> None:
            d.found(judge_sine.judge_phases(answer, plain(phases.cycle)))

        d.run("The motor turns", sine.try_phases(d.controller, phases), done)

    def _ask_zero(self) -> None:
        d = self.desk
        volts, offset = self.number("volts", "Voltage", "2"), self.whole("offset", "Offset", "0")
        if not 0 <= offset <= 360:
            raise NotTyped("Offset of the hall sensors: write 0 to 360 degrees.")
        words = f"The motor jerks to the next zero of its phase, with {shown(volts)} V, for about 2 s. {DEAF}"
        d.ask("Drive to commutation zero?", words, [("Drive it", partial(self._zero, volts, offset))], "warning")

    def _zero(self, volts: Fraction, offset: int) -> None:
        d = self.desk

        def done(result: tuple[Reply, int | None]) -> None:
            reply, counts = result
            d.found(judge_sine.judge_zero(reply.accepted, reply.code, counts))

        d.run("The motor goes to zero", sine.drive_to_zero(d.controller, d.record.axis, volts, offset), done)

    def _halls(self) -> None:
        d = self.desk
        cycle = parse_number(d.record.text("phases", "cycle"))
        if cycle is None:
            raise NotTyped("Type the magnetic cycle under “Phases and halls” first.")

        def done(result: tuple[Moved, int, int]) -> None:
            d.found(judge_sine.judge_halls(*result))

        job: Job[Moved] = Job()
        silent = max(SILENT, d.record.error)
        steps = sine.by_halls(d.controller, d.record.axis, cycle, self.torque(), d.folder, d.now(), job, silent)
        d.run(f"Axis {d.record.axis} moves", steps, done, job)
