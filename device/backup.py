"""Everything a controller holds, as one readable file: what it is, its parameters, program, variables and arrays.

Values are kept to the last bit, as the controller's own numbers (32 bits and 16 behind the point).
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from codegen.difference_values import number_text, resolution
from codegen.disk import FileUnreadable, save_text
from codegen.files import readable
from codegen.models import MODELS, Model
from codegen.twoletter import nodes
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE
from codegen.twoletter.parse import parse
from codegen.twoletter.rows import Takes

FORMAT = "twoletter backup"
VERSION = 1
UNNAMED = "variables and arrays that its program does not name"
SUFFIX = ".tlb"
Value = int  # in 1/65536


@dataclass(frozen=True, slots=True)
class Backup:
    """What a controller held at one time; values count 1/65536."""

    model: str
    revision: str = ""
    serial: int | None = None
    port: str = ""
    taken: str = ""
    note: str = ""
    reason: str = ""  # why it was made: "before a download"
    parameters: Mapping[str, tuple[Value, ...]] = field(default_factory=dict)
    motors_on: str = ""
    program: str = ""
    variables: Mapping[str, Value] = field(default_factory=dict)
    arrays: Mapping[str, tuple[Value, ...]] = field(default_factory=dict)
    not_read: tuple[str, ...] = ()  # what the controller does not tell
    left_out: tuple[str, ...] = ()  # what was not read to keep a download quick
    setup: str = ""  # the text of a `.tls`, where the person keeps one with it


def parameter_names(model: Model) -> list[str]:
    """The burned parameters this controller has and tells, in the order of putting them back.

    The table's order will do: what the motor is (MT) comes before how fast it may go. The outputs (OP) are not among
    them: putting them back could move something.
    """
    return [row.name for row in COMMANDS.values() if row.burned and row.operand and row.known_to(model)]


def untold(model: Model) -> tuple[str, ...]:
    """Burned settings that this controller has but does not tell, and values that it cannot list."""
    settings = tuple(row.name for row in COMMANDS.values() if row.burned and not row.operand and row.known_to(model))
    return settings if COMMANDS["LV"].known_to(model) else (*settings, UNNAMED)


def per_axis(name: str) -> bool:
    """Whether the parameter has a value for each axis."""
    return COMMANDS[name].takes is Takes.AXIS_NUMBERS


def names_in(program: str) -> tuple[list[str], list[str]]:
    """Variables and arrays a program names, for controllers that cannot list theirs (the SSC has no LV, no LA)."""
    variables: dict[str, None] = {}
    arrays: dict[str, None] = {}
    for line in parse(program).lines:
        for statement in line.statements:
            if isinstance(statement, nodes.Assign) and isinstance(statement.target, nodes.Variable):
                variables[statement.target.name] = None
            if isinstance(statement, nodes.Command) and statement.name in ("DM", "IN"):
                for item in statement.arguments:
                    if isinstance(item, nodes.Dimension):
                        arrays[item.name] = None
                    elif isinstance(item, nodes.Variable):
                        variables[item.name] = None
    return list(variables), list(arrays)


# ---------------------------------------------------------------------- numbers


def number_of(text: str) -> Value:
    """The number a file holds; ValueError when it is none of the controller's."""
    found = re.fullmatch(r"(-?)([0-9]{1,10})(?:\.([0-9]{1,16}))?", text)
    if found is None:
        raise ValueError(f"{text!r} is not a number of a controller")
    scaled, rest = divmod(int((found[3] or "").ljust(16, "0")) * ONE, 10**16)
    if rest:
        raise ValueError(f"{text!r} has more places than a controller keeps (steps of 1/65536)")
    value = int(found[2]) * ONE + scaled
    return -value if found[1] else value


def hexadecimal(value: Value) -> str:
    """As the controller takes it, exact to the last bit: `$FFFFFFFE.8000`."""
    bits = value & (1 << 48) - 1
    return f"${bits >> 16:08X}.{bits & 0xFFFF:04X}"


def from_hexadecimal(text: str) -> Value:
    """What `{$8.4}` printed; ValueError when it is something else."""
    found = re.fullmatch(r"\$([0-9A-F]{8})\.([0-9A-F]{4})", text.strip())
    if found is None:
        raise ValueError(f"{text!r} is not what was asked for")
    bits = int(found[1] + found[2], 16)
    return bits - (1 << 48) if bits >> 47 else bits


# ------------------------------------------------------------------------- files


def dumps(backup: Backup) -> str:
    """The backup as the text of its file: one parameter, variable and program line a line, so that files compare."""
    axes = MODELS[backup.model].axes
    data: dict[str, Any] = {
        "format": FORMAT, "version": VERSION, "model": backup.model, "revision": backup.revision,
        "serial": backup.serial, "port": backup.port, "taken": backup.taken, "note": backup.note,
        "reason": backup.reason, "motors_on": backup.motors_on, "not_read": list(backup.not_read),
        **({"left_out": list(backup.left_out)} if backup.left_out else {}),
        "parameters": {
            name: dict(zip(axes, map(number_text, values), strict=True)) if per_axis(name) else number_text(values[0])
            for name, values in backup.parameters.items()
        },
        "program": backup.program.split("\n") if backup.program else [],
        "variables": {name: number_text(value) for name, value in backup.variables.items()},
        "arrays": {name: [number_text(value) for value in values] for name, values in backup.arrays.items()},
        "setup": json.loads(backup.setup) if backup.setup else None,
    }  # fmt: skip
    return readable(data)


def save(path: str | Path, backup: Backup) -> None:
    """Writes the file; a crash leaves an old one whole."""
    save_text(path, dumps(backup))


def load(path: str | Path) -> Backup:
    """Opens the file; FileUnreadable says in one sentence what is wrong with it."""
    path = Path(path)
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError:
        raise FileUnreadable(f"{path.name} is not a back-up (it is not text)") from None
    except OSError as reason:
        raise FileUnreadable(f"{path.name} cannot be opened: {(reason.strerror or str(reason)).lower()}") from None
    try:
        return loads(text)
    except FileUnreadable as reason:
        raise FileUnreadable(f"{path.name} is not a back-up of a controller: {reason}") from None


def loads(text: str) -> Backup:
    """A backup from the text of its file; FileUnreadable says what is wrong in it."""
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as reason:
        raise FileUnreadable(str(reason)) from None
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise FileUnreadable("it does not say that it is one")
    version = data.get("version")
    if not isinstance(version, int) or version > VERSION:
        raise FileUnreadable(f"it was written by a newer program (version {version}, this one knows {VERSION})")
    model = MODELS.get(_text(data, "model"))
    if model is None:
        raise FileUnreadable(f"there is no controller model {data.get('model')!r}")
    serial = data.get("serial")
    setup = data.get("setup")
    return Backup(
        model=model.name,
        revision=_text(data, "revision"),
        serial=serial if isinstance(serial, int) else None,
        port=_text(data, "port"),
        taken=_text(data, "taken"),
        note=_text(data, "note"),
        reason=_text(data, "reason"),
        parameters=_parameters(data, model),
        motors_on=_text(data, "motors_on"),
        program="\n".join(_texts(data.get("program", []), "program")),
        variables={name: _number(value, name) for name, value in _table(data, "variables").items()},
        arrays={name: _numbers(values, name) for name, values in _table(data, "arrays").items()},
        not_read=tuple(_texts(data.get("not_read", []), "not_read")),
        left_out=tuple(_texts(data.get("left_out", []), "left_out")),
        setup=json.dumps(setup) if isinstance(setup, dict) else "",
    )


def _parameters(data: Mapping[str, Any], model: Model) -> dict[str, tuple[Value, ...]]:
    found: dict[str, tuple[Value, ...]] = {}
    known = parameter_names(model)
    for name, value in _table(data, "parameters").items():
        if name not in known:
            raise FileUnreadable(f"parameters: {name} is none of a {model.name}")
        if not per_axis(name):
            found[name] = (_number(value, name),)
            continue
        if not isinstance(value, dict) or list(value) != list(model.axes):
            raise FileUnreadable(f"parameters: {name} needs one value for each of {' '.join(model.axes)}")
        found[name] = tuple(_number(each, f"{name}{axis}") for axis, each in value.items())
    return found


def _table(data: Mapping[str, Any], name: str) -> dict[str, Any]:
    value = data.get(name, {})
    if not isinstance(value, dict):
        raise FileUnreadable(f"{name} is not a table")
    return value


def _text(data: Mapping[str, Any], name: str) -> str:
    value = data.get(name, "")
    if not isinstance(value, str):
        raise FileUnreadable(f"{name} is not text")
    return value


def _texts(value: object, name: str) -> Sequence[str]:
    if not isinstance(value, list) or not all(isinstance(line, str) for line in value):
        raise FileUnreadable(f"{name} is not a list of lines")
    return value


def _number(value: object, name: str) -> Value:
    if not isinstance(value, str):
        raise FileUnreadable(f"{name} is not a number in quotes")
    try:
        return number_of(value)
    except ValueError as reason:
        raise FileUnreadable(f"{name}: {reason}") from None


def _numbers(values: object, name: str) -> tuple[Value, ...]:
    if not isinstance(values, list):
        raise FileUnreadable(f"{name} is not a list")
    return tuple(_number(value, f"{name}[{place}]") for place, value in enumerate(values))


# ---------------------------------------------------------------------- comparing


def misfits(backup: Backup, model: Model) -> list[str]:
    """Why this backup cannot go into such a controller, one sentence each; nothing when it can."""
    theirs = MODELS[backup.model]
    if theirs.name == model.name:
        return []
    found = [f"it is of a {theirs.name}, this is a {model.name}"]
    if theirs.axes != model.axes:
        found.append(f"it has the axes {' '.join(theirs.axes)}, this has {' '.join(model.axes)}")
    lines = backup.program.split("\n") if backup.program else []
    if len(lines) > model.lines:
        found.append(f"its program has {len(lines)} lines, this takes {model.lines}")
    longest = max(map(len, lines), default=0)
    if longest > model.columns:
        found.append(f"its program has a line of {longest} characters, this takes {model.columns}")
    missing = [name for name in backup.parameters if not COMMANDS[name].known_to(model)]
    if missing:
        found.append(f"this has no {', '.join(missing)}")
    elements = sum(map(len, backup.arrays.values()))
    if elements > model.elements:
        found.append(f"its arrays have {elements} elements, this holds {model.elements}")
    return found


def differences(wanted: Backup, found: Backup) -> list[str]:
    """What `found` has otherwise than `wanted`, in words, item by item."""
    axes = MODELS[wanted.model].axes
    return [
        *_parameter_differences(wanted, found, axes),
        *_program_difference(wanted.program, found.program),
        *_value_differences("variable", wanted.variables, found.variables),
        *_array_differences(wanted.arrays, found.arrays),
    ]


def _parameter_differences(wanted: Backup, found: Backup, axes: str) -> Iterable[str]:
    for name, values in wanted.parameters.items():
        there = found.parameters.get(name, ())
        for place, value in enumerate(values):
            axis = f" of {axes[place]}" if per_axis(name) else ""
            if place >= len(there):
                yield f"{COMMANDS[name].title}{axis} ({name}) cannot be read, the back-up has {number_text(value)}"
            elif abs(there[place] - value) >= resolution(name):
                other = number_text(there[place])
                yield f"{COMMANDS[name].title}{axis} ({name}) is {other}, the back-up has {number_text(value)}"


def _program_difference(wanted: str, found: str) -> Iterable[str]:
    ours, theirs = ([line.rstrip() for line in text.rstrip("\n").split("\n")] for text in (wanted, found))
    if ours != theirs:
        place = next((n for n, (a, b) in enumerate(zip(ours, theirs, strict=False)) if a != b), None)
        where = f"differs first at line {place}" if place is not None else f"has {len(theirs)} lines, not {len(ours)}"
        yield f"the program {where}"


def _value_differences(kind: str, wanted: Mapping[str, Value], found: Mapping[str, Value]) -> Iterable[str]:
    for name, value in wanted.items():
        if name not in found:
            yield f"{kind} {name} is missing"
        elif found[name] != value:
            yield f"{kind} {name} is {number_text(found[name])}, the back-up has {number_text(value)}"


def _array_differences(wanted: Mapping[str, Sequence[Value]], found: Mapping[str, Sequence[Value]]) -> Iterable[str]:
    for name, values in wanted.items():
        there = found.get(name)
        if there is None:
            yield f"array {name} is missing"
        elif len(there) != len(values):
            yield f"array {name} has {len(there)} elements, the back-up has {len(values)}"
        else:
            pairs = ({f"{name}[{n}]": value for n, value in enumerate(each)} for each in (values, there))
            yield from _value_differences("element", *pairs)
