"""A back-up in words: what it is, what it holds, what is not in it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from codegen.models import MODELS
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE
from device.backup import Backup, per_axis
from device.backup_kept import Kept

MOST_ELEMENTS = 12  # of an array, in words


@dataclass(frozen=True, slots=True)
class Part:
    """A heading and what stands below it; `code` lines stand as they are."""

    title: str
    lines: tuple[str, ...]
    code: bool = False


def described(backup: Backup) -> list[Part]:
    """Everything in it, part by part."""
    return [part for part in _parts(backup) if part.lines]


def _parts(backup: Backup) -> Iterator[Part]:
    yield Part("Controller", tuple(_identity(backup)))
    axes = MODELS[backup.model].axes
    yield Part("Parameters", tuple(_parameter(backup, name, axes) for name in backup.parameters))
    lines = backup.program.split("\n") if backup.program else []
    yield Part("Program", tuple(f"{number:4}  {line}" for number, line in enumerate(lines)), code=True)
    yield Part("Variables", tuple(f"{name} = {_short(value)}" for name, value in backup.variables.items()))
    yield Part("Arrays", tuple(_array(name, values) for name, values in backup.arrays.items()))
    yield Part("Not in it", tuple(missing(backup)))


def _identity(backup: Backup) -> Iterator[str]:
    model = MODELS[backup.model]
    yield f"{model.title}; {serial_words(backup.serial)}"
    if backup.revision:
        yield f"calls itself {backup.revision}"
    yield f"taken {backup.taken}{f' {backup.reason}' if backup.reason else ''}"
    if backup.note:
        yield f"note: {backup.note}"
    if backup.port:
        yield f"at {backup.port}"
    yield f"motors on: {' '.join(backup.motors_on) or 'none'}"
    if backup.setup:
        yield "with the setup of the machine"


def serial_words(serial: int | None) -> str:
    """ "serial number 4711", or that there is none."""
    return f"serial number {serial}" if serial else "no serial number"


def _parameter(backup: Backup, name: str, axes: str) -> str:
    row, values = COMMANDS[name], backup.parameters[name]
    if not per_axis(name):
        return f"{row.title} ({name}): {_short(values[0])}"
    each = ", ".join(f"{axis} {_short(value)}" for axis, value in zip(axes, values, strict=False))
    return f"{row.title} ({name}): {each}"


def _short(value: int) -> str:
    """With at most four places, as the controller prints; the file keeps every bit."""
    return f"{value / ONE:.4f}".rstrip("0").rstrip(".")


def _array(name: str, values: Sequence[int]) -> str:
    first = ", ".join(_short(value) for value in values[:MOST_ELEMENTS])
    return f"{name}[{len(values)}]: {first}{' …' if len(values) > MOST_ELEMENTS else ''}"


def missing(backup: Backup) -> Iterator[str]:
    """What is not in it, and why."""
    if backup.not_read:
        yield f"The controller does not tell it: {names(backup.not_read)}."
    if backup.left_out:
        yield (
            f"Left out to keep the download quick, which leaves it as it is in the controller: "
            f"{names(backup.left_out)}."
        )


def names(items: Sequence[str]) -> str:
    """Settings by their titles, arrays and variables as such."""
    return ", ".join(map(_name, items))


def _name(item: str) -> str:
    if item in COMMANDS:
        return f"{COMMANDS[item].title} ({item})"
    return f"array {item.removesuffix('[]')}" if item.endswith("[]") else item


def summary(backup: Backup) -> str:
    """ "32 parameters, a program of 46 lines, 3 variables, 1 array"."""
    lines = len(backup.program.split("\n")) if backup.program else 0
    counted = [
        _count(len(backup.parameters), "parameter"),
        f"a program of {_count(lines, 'line')}" if lines else "no program",
        _count(len(backup.variables), "variable"),
        _count(len(backup.arrays), "array"),
    ]
    return ", ".join(counted)


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'s' * (number != 1)}"


def row_of(kept: Kept) -> tuple[str, str, str]:
    """A kept one in a list: when, why, note."""
    if kept.broken:
        return kept.path.stem, "", f"{kept.path.name} {kept.broken}"
    return kept.taken, kept.reason or "by hand", kept.note
