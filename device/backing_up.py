"""Backing up and restoring over the link: in the right order, motors off, read back and compared item by item."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING

from codegen.models import Model
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.problems import ERROR_TEXTS
from device.backup import (
    Backup,
    Value,
    differences,
    from_hexadecimal,
    hexadecimal,
    misfits,
    names_in,
    parameter_names,
    per_axis,
    untold,
)
from device.backup_words import names
from device.download import Download, Downloaded, Job, held_program
from device.identify import fence
from device.proof import proved
from device.tasks import LinkError, LinkLost, NotAllowed, Send, Steps, data_line
from device.wire import FRAME_COLUMNS, Kind, Upload

if TYPE_CHECKING:
    from device.api import Controller

LINE_S = 1.5
REFUSAL_S = 0.05  # silence behind a `?` that makes it a refusal
WIDTH = len("$00000000.0000")
EXACT = r"\s*\$[0-9A-F]{8}\.[0-9A-F]{4}"


@dataclass(frozen=True, slots=True)
class Restored:
    """What came of it: `refused` lines in words, `left` what still differs from the backup; both empty is success."""

    refused: tuple[str, ...]
    left: tuple[str, ...]
    sentence: str

    @property
    def complete(self) -> bool:
        return not self.refused and not self.left


def quiet(c: Controller, what: str) -> Steps[Model]:
    """The controller's model, when nothing moves and no program runs there; else one sentence why not."""
    model = c.model
    if model is None:
        raise NotAllowed(f"{what}: the controller's model is not known.")
    if c.resting():
        raise NotAllowed(f"{what}: {c.resting()}")
    threads = [f"_XQ{number}" for number in range(model.threads)]
    lines = yield from exact(c.nonces, threads, model.columns)
    moving = yield from exact(c.nonces, [f"_BG{axis}" for axis in model.axes], model.columns)
    if any(line is not None and line >= 0 for line in lines):
        raise NotAllowed(f"{what}: a program is running. Halt it first.")
    if any(moving):
        raise NotAllowed(f"{what}: an axis is moving. Stop it first.")
    return model


def exact(
    nonces: Iterator[str], expressions: Sequence[str], columns: int, enough: Callable[[], bool] = lambda: False
) -> Steps[list[Value | None]]:
    """Reads expressions to the last bit, as many a line as fit; None where the controller knows none of that name.

    The list ends early once it is `enough`.
    """
    found: list[Value | None] = []
    for group in _lines([f"{each}{{$8.4}}" for each in expressions], columns - FRAME_COLUMNS - 4, ","):
        if enough():
            break
        answer = yield from proved(nonces, f"MG {','.join(group)}", LINE_S, REFUSAL_S, EXACT * len(group))
        if answer.kind is Kind.SILENT:
            raise LinkLost("The controller stopped answering.")
        if answer.kind is not Kind.ACCEPTED:
            yield from fence(nonces)
            single = len(group) == 1
            found += [None] if single else (yield from exact(nonces, [each[:-6] for each in group], 0, enough))
            continue
        texts = answer.text.split("$")[1:]
        if len(texts) != len(group) or not answer.certain:
            raise LinkLost(f"Reading {', '.join(each[:-6] for each in group)} was disturbed; try again.")
        found += [from_hexadecimal(f"${text}") for text in texts]
    return found


def _lines(parts: Sequence[str], room: int, joint: str) -> Iterator[list[str]]:
    """Parts grouped so that each group, joined, fits into `room` characters (one part at least)."""
    group: list[str] = []
    size = 0
    for part in parts:
        if group and size + len(joint) + len(part) > room:
            yield group
            group, size = [], 0
        group.append(part)
        size += len(joint) + len(part)
    if group:
        yield group


def backup_steps(
    c: Controller,
    job: Job[Backup],
    note: str = "",
    port: str = "",
    *,
    setup: str = "",
    reason: str = "",
    budget_s: float = math.inf,
    running: bool = False,
    taken: datetime | None = None,
) -> Steps[Backup]:
    """Reads everything; changes nothing. With a budget what does not fit into it is left out, and named.

    `running`: also while a program runs, to compare; its variables are then of different moments.
    """
    model = (yield from quiet(c, "Not backed up")) if not running else _readable(c, "Not compared")
    quick = math.isfinite(budget_s)
    _ongoing(job, "program", 0, 3)
    program = yield from held_program(c.waiting, c.nonces)
    c.set_listing(program)
    end = c.clock() + budget_s  # the download would have read the program anyway
    names, array_names = yield from listed(c, model, program)
    _ongoing(job, "variables", 1, 3)
    values = yield from exact(c.nonces, names, model.columns, lambda: c.clock() >= end)
    _ongoing(job, "parameters", 2, 3)
    motors = yield from exact(c.nonces, [f"_MO{axis}" for axis in model.axes], model.columns)
    registers, asked = yield from _registers(c, model, lambda: c.clock() >= end)
    arrays = {} if quick else (yield from _arrays(c, model, array_names, job))
    identity = c.identity
    return Backup(
        model=model.name,
        revision=identity.text if identity is not None else "",
        serial=identity.serial if identity is not None else None,
        port=port,
        taken=(taken or datetime.now()).isoformat(sep=" ", timespec="seconds"),
        note=note,
        reason=reason,
        setup=setup,
        parameters=registers,
        motors_on="".join(axis for axis, off in zip(model.axes, motors, strict=True) if off == 0),
        program=program.rstrip("\n"),
        variables={name: value for name, value in zip(names, values, strict=False) if value is not None},
        arrays=arrays,
        not_read=(*untold(model), *(name for name in asked if name not in registers)),
        left_out=(*names[len(values) :], *(name for name in parameter_names(model) if name not in asked),
                  *(f"{name}[]" for name in array_names if quick)),
    )  # fmt: skip


def _readable(c: Controller, what: str) -> Model:
    """The controller's model, when it can be read at all now; else one sentence why not."""
    if c.model is None:
        raise NotAllowed(f"{what}: the controller's model is not known.")
    if c.resting():
        raise NotAllowed(f"{what}: {c.resting()}")
    return c.model


def _registers(
    c: Controller, model: Model, enough: Callable[[], bool]
) -> Steps[tuple[dict[str, tuple[Value, ...]], list[str]]]:
    """The parameters that the controller tells, as many values a line as fit, and which were asked."""
    wanted = {
        name: [f"_{name}{axis}" for axis in model.axes] if per_axis(name) else [f"_{name}"]
        for name in parameter_names(model)
    }
    told = yield from exact(c.nonces, [each for group in wanted.values() for each in group], model.columns, enough)
    found: dict[str, tuple[Value, ...]] = {}
    asked: list[str] = []
    at = 0
    for name, group in wanted.items():
        values = told[at : at + len(group)]
        at += len(group)
        if len(values) == len(group):
            asked.append(name)
            if None not in values:
                found[name] = tuple(value for value in values if value is not None)
    return found, asked


def _ongoing(job: Job[Backup], phase: str, done: int, total: int) -> None:
    if job.cancelled:
        raise LinkError(f"Back-up cancelled at the {phase}; nothing was changed in the controller.")
    job.show(phase, done, total)


def _arrays(c: Controller, model: Model, names: Sequence[str], job: Job[Backup]) -> Steps[dict[str, tuple[Value, ...]]]:
    arrays: dict[str, tuple[Value, ...]] = {}
    for place, name in enumerate(names):
        _ongoing(job, f"array {name}", place, len(names))
        size = yield from _size(c, name)
        elements = yield from exact(c.nonces, [f"{name}[{each}]" for each in range(size)], model.columns)
        arrays[name] = tuple(value for value in elements if value is not None)
    return {name: values for name, values in arrays.items() if values}


def listed(c: Controller, model: Model, program: str) -> Steps[tuple[list[str], list[str]]]:
    """Variables and arrays: those the controller lists where it can, and those its program names."""
    variables, arrays = names_in(program)
    for command, found, reply in (("LV", variables, r"\w+=.*"), ("LA", arrays, r"\w+\[\d+\]")):
        if command not in COMMANDS or not COMMANDS[command].known_to(model):
            continue
        answer = yield from proved(c.nonces, command, 10.0, REFUSAL_S, reply)
        if answer.kind is not Kind.ACCEPTED:
            yield from fence(c.nonces)
            continue
        listed = [line.split("=")[0].split("[")[0].strip() for line in answer.text.splitlines()]
        found += [name for name in listed if name.isalnum() and name not in found]
    return variables, arrays


def _size(c: Controller, name: str) -> Steps[int]:
    """How many elements an array has; none when there is no such array."""
    answer = yield Send(data_line(f"QU {name}[]"), Upload(), timeout_s=LINE_S, extends=True)
    if answer.kind is not Kind.ACCEPTED:
        yield from fence(c.nonces)
        return 0
    return len(answer.text.split())


# ---------------------------------------------------------------------- restoring


def restore_steps(c: Controller, backup: Backup, job: Job[Restored]) -> Steps[Restored]:
    """Puts a backup back: motors off first and at the end, program last, everything read back and compared."""
    if not c.control:
        raise NotAllowed("Not restored: this is Watch. Switch to Control first.")
    c.motion.unclaimed("Not restored")
    model = yield from quiet(c, "Not restored")
    reasons = misfits(backup, model)
    if reasons:
        raise NotAllowed(f"Not restored, the back-up does not fit: {'; '.join(reasons)}.")
    refused: list[str] = []
    for number, line in enumerate(lines := list(lines_of(backup, model))):
        if job.cancelled and not number:
            raise LinkError("Restore cancelled; nothing was changed in the controller.")
        if job.cancelled:
            raise LinkError(
                f"Restore cancelled after {number} of {len(lines)} lines: the motors are off and parts of the back-up "
                "are in the controller; restore once more."
            )
        job.show("values", number, len(lines))
        refused += yield from _put(c, line)
    job.show("program", 0, 1)
    inner: Job[Downloaded] = Job(lambda each: job.show("program", each.done, each.total))
    yield from c.memory.downloading(
        Download(
            backup.program, inner, model=model, line=c.line, nonces=c.nonces, clock=c.clock, folder=c.program_folder
        )
    )
    job.show("comparing", 0, 1)
    there = yield from backup_steps(c, Job())
    left = tuple(differences(backup, there))
    return Restored(tuple(refused), left, _sentence(backup, model, refused, left))


def lines_of(backup: Backup, model: Model) -> Iterator[str]:
    """The lines that put parameters, variables and arrays back, each proved when it is sent."""
    room = model.columns - FRAME_COLUMNS - 2
    yield "MO"
    for name in parameter_names(model):
        values = backup.parameters.get(name, ())
        for place, value in enumerate(values):
            yield (
                f"{name}{model.axes[place]}={hexadecimal(value)}" if per_axis(name) else f"{name} {hexadecimal(value)}"
            )
    assignments = [f"{name}={hexadecimal(value)}" for name, value in backup.variables.items()]
    for name, elements in backup.arrays.items():
        yield f"DA {name}[]"
        yield f"DM {name}[{len(elements)}]"
        assignments += [f"{name}[{place}]={hexadecimal(value)}" for place, value in enumerate(elements)]
    for group in _lines(assignments, room, ";"):
        yield ";".join(group)


def _put(c: Controller, line: str) -> Steps[list[str]]:
    """Sends one line; what the controller says against it, in words."""
    answer = yield from proved(c.nonces, line, LINE_S, REFUSAL_S)
    if answer.kind is Kind.ACCEPTED:
        return []
    if answer.kind is Kind.SILENT:
        raise LinkLost(f"The controller stopped answering at “{line}”; what is restored so far is incomplete.")
    fenced = yield from fence(c.nonces)
    code = int(fenced.values[0]) if fenced.kind is Kind.VALUES else 0
    return [f"{line} was refused: error {code}, {ERROR_TEXTS.get(code, 'unknown error')}"]


def _sentence(backup: Backup, model: Model, refused: Sequence[str], left: Sequence[str]) -> str:
    unknown = f" Not in the back-up, because the controller does not tell it: {names(untold(model))}."
    if refused or left:
        return f"Restored with {len(refused) + len(left)} exceptions; the motors are off, nothing is burned.{unknown}"
    on = f" In the back-up the motors of {', '.join(backup.motors_on)} were on." if backup.motors_on else ""
    return (
        f"Restored and compared: {len(backup.parameters)} parameters, {len(backup.variables)} variables, "
        f"{len(backup.arrays)} arrays and the program are as in the back-up. The motors are off, nothing is burned."
        f"{on}{unknown}"
    )
