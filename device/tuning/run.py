"""What a person can ask of the tuner: present gains, a step, automatic trials, an excitation, gains used or burned."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Callable
from concurrent.futures import Future
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from codegen.twoletter.fixed import ONE
from device import commands
from device.backing_up import exact
from device.download import Job
from device.former import Former, assign
from device.quiet import ready, still
from device.setup_transfer import BURN_S
from device.tasks import NotAllowed, Priority, Steps
from device.tuning.automatic import VELOCITY
from device.tuning.bench import Excited, Found, Measured, Told, Wish, bench
from device.tuning.entry import gains_words
from device.tuning.excite import carried, sag
from device.tuning.feed import Sweep
from device.tuning.guards import guarded
from device.tuning.loop import Gains, period
from device.tuning.registers import ALL, gains_of, registers

if TYPE_CHECKING:
    from device.api import Controller
    from device.commands import Reply

T = TypeVar("T")
LIMITED_BY = ("RP", "FL", "BL", "ER")
STEP_VALUES = 200  # of a channel: what a person looks at


@dc.dataclass(frozen=True)
class Present:
    """What the controller holds of an axis: gains, place, limits (counts, V), whether motor on and dual loop."""

    gains: Gains
    place: int
    forward: int
    reverse: int
    error: int
    motor_on: bool
    dual: bool
    period: float
    hangs: float = 0.0  # counts below its place, or without its integrator


# ------------------------------------------------------------------------ asked


def read_present(c: Controller, axis: str) -> Future[Present]:
    """Reads only; also in Watch."""
    return c.run(present_steps(c, axis), Priority.USER, "user")


def run_step(c: Controller, wish: Wish, folder: Path, now: datetime) -> Job[Measured]:
    """One step to and back, recorded and measured."""
    job: Job[Measured] = Job()

    def body(former: Former) -> Steps[Measured]:
        rig = yield from bench(c, former, wish, job)
        return (yield from rig.step(wish.step, wish.gains, wish.seconds, STEP_VALUES))

    job.future = _begin(c, wish, folder, now, body)
    return job


def run_automatic(c: Controller, wish: Wish, folder: Path, now: datetime, tell: Told, *, velocity: bool) -> Job[Found]:
    """Gains by trial; `velocity`: what is known of the drive's mode."""
    job: Job[Found] = Job()
    if velocity:
        job.future.set_exception(NotAllowed(VELOCITY))
        return job

    def body(former: Former) -> Steps[Found]:
        rig = yield from bench(c, former, wish, job)
        return (yield from rig.automatic(wish, tell))

    job.future = _begin(c, wish, folder, now, body)
    return job


def run_excitation(c: Controller, wish: Wish, folder: Path, now: datetime) -> Job[Excited]:
    """A small excitation with the gains of the wish, recorded."""
    job: Job[Excited] = Job()

    def body(former: Former) -> Steps[Excited]:
        rig = yield from bench(c, former, wish, job)
        return (yield from rig.excite(wish.gains))

    job.future = _begin(c, wish, folder, now, body)
    return job


def run_moves(
    c: Controller, wish: Wish, sweep: Sweep, other: Gains, folder: Path, now: datetime
) -> Job[tuple[Measured, Measured]]:
    """A profiled move forth with the gains of the wish and back with other ones, to be compared."""
    job: Job[tuple[Measured, Measured]] = Job()

    def body(former: Former) -> Steps[tuple[Measured, Measured]]:
        rig = yield from bench(c, former, wish, job)
        first = yield from rig.move(sweep, wish.gains)
        return first, (yield from rig.move(dc.replace(sweep, counts=-sweep.counts), other))

    job.future = _begin(c, wish, folder, now, body)
    return job


def use_gains(c: Controller, axis: str, gains: Gains) -> Future[str]:
    """These gains into the controller's memory, not into its EEPROM."""
    return c.run(using(c, axis, gains), Priority.USER, "user")


def burn(c: Controller, axis: str, gains: Gains) -> Future[Reply]:
    """These gains, and with them everything that BN keeps, into the EEPROM."""
    return c.run(_burning(c, axis, gains), Priority.USER, "user")


def _begin(c: Controller, wish: Wish, folder: Path, now: datetime, body: Callable[[Former], Steps[T]]) -> Future[T]:
    if wish.problem:
        future: Future[T] = Future()
        future.set_exception(NotAllowed(f"Not started: {wish.problem}"))
        return future
    return c.run(guarded(c, wish.guard, folder, body, now), Priority.USER, "user")


# ------------------------------------------------------------------------- steps


def present_steps(c: Controller, axis: str) -> Steps[Present]:
    model = c.model
    if model is None or axis not in model.axes or c.resting():
        raise NotAllowed(c.resting() or f"The gains cannot be read: this controller has no axis {axis}.")
    names = [*ALL, *LIMITED_BY, "MO", "DV", "TE", "TT"]
    found = yield from exact(c.nonces, [*(f"_{name}{axis}" for name in names), "_TM"], model.columns)
    values = {name: value or 0 for name, value in zip([*names, "TM"], found, strict=True)}
    gains, error = gains_of(values), values["TE"] / ONE
    hangs = 0.0 if values["MO"] else max(abs(error), sag(gains, carried(gains, error, values["TT"] / ONE)))
    return Present(
        gains, values["RP"] // ONE, values["FL"] // ONE, values["BL"] // ONE, values["ER"] // ONE,
        values["MO"] == 0, values["DV"] != 0, period(abs(values["TM"]) / ONE), hangs,
    )  # fmt: skip


def using(c: Controller, axis: str, gains: Gains) -> Steps[str]:
    model = ready(c, axis, "Not set")
    yield from still(c, model, "Not set")
    yield from assign(c, axis, registers(gains))
    return f"Axis {axis} works with {gains_words(gains)} until the power goes off; nothing was burned."


def _burning(c: Controller, axis: str, gains: Gains) -> Steps[Reply]:
    yield from using(c, axis, gains)
    return (yield from commands.by_hand(c, "BN", BURN_S))
