"""A machine's setup over the link: read, sent, burned. Nothing is sent while anything moves."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from codegen.fields import joined
from codegen.models import Model
from codegen.setup import Setup
from codegen.setup_differences import Difference, Key, Line, Readings, differences, expressions
from codegen.twoletter.problems import ERROR_TEXTS
from device import commands
from device.backing_up import LINE_S, exact
from device.commands import Reply
from device.download import Job
from device.identify import fence
from device.proof import proved
from device.tasks import LinkLost, NotAllowed, Priority, Steps
from device.wire import Kind

if TYPE_CHECKING:
    from device.api import Controller

BURN_S = 3.0


@dataclass(frozen=True, slots=True)
class Reading:
    """What a controller held: its registers, and which of its motors were on."""

    model: str
    values: Readings = field(default_factory=dict)
    motors_on: str = ""
    not_told: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Sent:
    """What came of sending: refused lines, and values that are still others; both empty is success."""

    reading: Reading
    refused: tuple[str, ...]
    left: tuple[Difference, ...]
    sentence: str

    @property
    def complete(self) -> bool:
        return not self.refused and not self.left


# ----------------------------------------------------------------------- asked


def read_setup(c: Controller) -> Future[Reading]:
    """Reads what a setup holds; changes nothing, also in Watch and while a program runs."""
    return c.run(reading_steps(c), Priority.USER, "user")


def read_registers(c: Controller, keys: Collection[Key]) -> Future[Readings]:
    """As `read_setup`, of these registers only."""
    return c.run(_registers(c, keys), Priority.USER, "user")


def send_setup(c: Controller, setup: Setup, lines: Collection[Line]) -> Job[Sent]:
    """Sends these lines, each proved, and reads everything again."""
    job: Job[Sent] = Job()
    job.future = c.run(sending_steps(c, setup, lines, job), Priority.USER, "user")
    return job


def burn_setup(c: Controller) -> Future[Reply]:
    """Keeps in the EEPROM what the controller holds."""
    return c.run(burning_steps(c), Priority.USER, "user")


# ----------------------------------------------------------------------- steps


def reading_steps(c: Controller) -> Steps[Reading]:
    model = _known(c, "Not read")
    wanted = expressions(model)
    values = yield from exact(c.nonces, list(wanted.values()), model.columns)
    motors = yield from exact(c.nonces, [f"_MO{axis}" for axis in model.axes], model.columns)
    found: Mapping[Key, int] = {key: value for key, value in zip(wanted, values, strict=True) if value is not None}
    return Reading(
        model.name,
        found,
        "".join(axis for axis, off in zip(model.axes, motors, strict=True) if off == 0),
        tuple(text for key, text in wanted.items() if key not in found),
    )


def _registers(c: Controller, keys: Collection[Key]) -> Steps[Readings]:
    model = _known(c, "Not read")
    wanted = {key: text for key, text in expressions(model).items() if key in keys}
    values = yield from exact(c.nonces, list(wanted.values()), model.columns)
    return {key: value for key, value in zip(wanted, values, strict=True) if value is not None}


def sending_steps(c: Controller, setup: Setup, lines: Collection[Line], job: Job[Sent]) -> Steps[Sent]:
    if not c.control:
        raise NotAllowed("Not sent: this is Watch. Switch to Control first.")
    c.motion.unclaimed("Not sent")
    model = _known(c, "Not sent")
    if model.name != setup.model:
        raise NotAllowed(f"Not sent: the setup is for {setup.limits.title}, connected is {model.title}.")
    off = yield from _switch_off(c, model, "".join(dict.fromkeys(line.axis for line in lines if line.motor_off)))
    refused: list[str] = []
    for number, line in enumerate(lines):
        if job.cancelled:
            raise NotAllowed(
                f"Cancelled after {number} of {len(lines)} values; read the controller to see what it holds."
            )
        job.show("sending", number, len(lines))
        yield from _still(c, model, number)
        refused += yield from _put(c, line)
    reading = yield from reading_steps(c)
    sent = {line.key for line in lines}
    left = tuple(each for each in differences(setup, reading.values) if each.key in sent)
    return Sent(reading, tuple(refused), left, _sentence(lines, refused, left, off))


def burning_steps(c: Controller) -> Steps[Reply]:
    """The link itself changes no setting of a controller, so nothing of its own could be burned."""
    if not c.control:
        raise NotAllowed("Not burned: this is Watch. Switch to Control first.")
    c.motion.unclaimed("Not burned")
    yield from _still(c, _known(c, "Not burned"), 0, "Not burned")
    return (yield from commands.by_hand(c, "BN", BURN_S))


def _known(c: Controller, what: str) -> Model:
    if c.model is None:
        raise NotAllowed(f"{what}: the controller's type is not known.")
    if c.resting():
        raise NotAllowed(f"{what}: {c.resting()}")
    return c.model


def _still(c: Controller, model: Model, done: int, what: str = "Not sent") -> Steps[None]:
    """Nothing runs, moves or follows a master; else one sentence, and how far it came."""
    threads = [f"_XQ{number}" for number in range(model.threads)]
    moving = [f"_BG{axis}" for axis in (f"{model.axes}S" if model.coordinated else model.axes)]
    following = [f"_GR{axis}" for axis in model.axes]
    found = yield from exact(c.nonces, [*threads, *moving, *following], model.columns)
    so_far = f" {done} of the values were sent before." if done else ""
    if any(line is not None and line >= 0 for line in found[: len(threads)]):
        raise NotAllowed(f"{what}: a program is running. Halt it first.{so_far}")
    if any(found[len(threads) : -len(following)]):
        raise NotAllowed(f"{what}: an axis is moving. Stop it first.{so_far}")
    if any(found[-len(following) :]):
        raise NotAllowed(f"{what}: an axis follows a master (gearing). Disable it first.{so_far}")


def _switch_off(c: Controller, model: Model, letters: str) -> Steps[str]:
    """The motors of these axes are off from now on; answers which were on."""
    if not letters:
        return ""
    yield from _still(c, model, 0)
    states = yield from exact(c.nonces, [f"_MO{axis}" for axis in letters], model.columns)
    on = "".join(axis for axis, off in zip(letters, states, strict=True) if off == 0)
    if on:
        answer = yield from proved(c.nonces, f"MO {on}", LINE_S)
        if answer.kind is not Kind.ACCEPTED:
            raise LinkLost(f"Not sent: it is not certain that the motors of {joined(tuple(on))} went off.")
    return on


def _put(c: Controller, line: Line) -> Steps[list[str]]:
    """Sends one line; what the controller says against it, in words."""
    answer = yield from proved(c.nonces, line.text, LINE_S)
    if answer.kind is Kind.ACCEPTED:
        return []
    if answer.kind is Kind.SILENT:
        raise LinkLost(f"The controller stopped answering at “{line.text}”; read it to see what it holds.")
    fenced = yield from fence(c.nonces)
    code = int(fenced.values[0]) if fenced.kind is Kind.VALUES else 0
    return [f"{line.words}: {line.text} was refused, error {code}, {ERROR_TEXTS.get(code, 'unknown error')}"]


def _sentence(lines: Collection[Line], refused: Collection[str], left: Collection[Difference], off: str) -> str:
    motors = (
        f" The {_motors(off)} off now: switch {'it' if len(off) == 1 else 'them'} on when it is safe." if off else ""
    )
    if refused:
        return f"{len(refused)} of {len(lines)} values were refused: {'; '.join(refused)}.{motors}"
    if left:
        names = ", ".join(f"{each.title} of {each.axis}" for each in left)
        return f"Sent, but the controller holds other values of {names}: read it again.{motors}"
    number = len(lines)
    return f"{number} value{'s' * (number != 1)} sent and read back; nothing is burned.{motors}"


# ----------------------------------------------------------------------- words


def _motors(letters: str) -> str:
    if len(letters) == 1:
        return f"motor of {letters} is"
    return f"motors of {joined(tuple(letters))} are"


def burn_words(reading: Reading, model: Model, unsent: int) -> str:
    """What is burned, and what the next power-up does with it (commands.md, BN contents: motors on or off too)."""
    on, off = reading.motors_on, "".join(axis for axis in model.axes if axis not in reading.motors_on)
    starts = [f"the {_motors(on)} switched on by {'itself' if len(on) == 1 else 'themselves'}, as now"] if on else []
    starts += [f"the {_motors(off).replace(' is', ' stays').replace(' are', ' stay')} off"] if off else []
    differ = (
        f" {unsent} value{'s' * (unsent != 1)} of this setup {'is' if unsent == 1 else 'are'} not in the controller: "
        "what is burned is what the controller holds."
        if unsent
        else ""
    )
    return (
        "Everything the controller holds now (motor and encoder types, gains, limits, speeds, outputs) is written into "
        f"its EEPROM over what was there.{differ} From the next power-up on it starts with these values: "
        f"{' and '.join(starts)}. The program is not burned with them. It takes about 250 ms: leave the power on."
    )
