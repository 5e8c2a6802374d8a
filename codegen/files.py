"""Program files (`.tlp`) and setup files (`.tls`): versioned JSON that people can read and compare.

Every released version opens for ever: names that changed are listed as `was` and `renamed` in the classes.
Nothing in a file is ever executed.
"""

from __future__ import annotations

import dataclasses as dc
import json
from collections.abc import Callable, Mapping, Sequence
from enum import StrEnum
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from codegen.disk import FileUnreadable, save_text
from codegen.document import Document
from codegen.fields import AXES, NONE, Choice, Flag, ListOf, PerAxis, fields_of, is_shown
from codegen.handover import Handover
from codegen.instructions import ALL, Instruction
from codegen.models import MODELS
from codegen.program import Program, Section, Step, Steps
from codegen.setup import Axis, Setup

VERSION = 1
PROGRAM = "twoletter program"
SETUP = "twoletter setup"
STEPS = "twoletter steps"
_WIDEST = 160  # characters of a value that stays on one line
_DEEPEST = 40  # containers inside each other
Read = TypeVar("Read")


# ----------------------------------------------------------------------- writing


def dumps(document: Document) -> str:
    """A document as the text of a `.tlp` file."""
    program = document.program
    return readable(
        {
            "format": PROGRAM,
            "version": VERSION,
            "name": program.name,
            "description": program.description,
            **({"compact": True} if document.compact else {}),
            **{section.value: [_step_data(step) for step in program.section(section)] for section in Section},
            "setup": _setup_data(document.setup),
            "stimulus": document.stimulus.split("\n") if document.stimulus else [],
            "notes": document.notes.split("\n") if document.notes else [],
            **({"handover": dc.asdict(document.handover)} if document.handover != Handover() else {}),
        }
    )


def setup_dumps(setup: Setup) -> str:
    """A setup as the text of a `.tls` file."""
    return readable({"format": SETUP, "version": VERSION, **_setup_data(setup)})


def steps_to_text(steps: Sequence[Step]) -> str:
    """Steps for the clipboard."""
    return readable({"format": STEPS, "version": VERSION, "steps": [_step_data(step) for step in steps]})


def _step_data(step: Step) -> dict[str, Any]:
    data: dict[str, Any] = {"id": step.id, "do": type(step.instruction).__name__, **_values(step.instruction)}
    if step.note:
        data["note"] = step.note
    if not step.enabled:
        data["enabled"] = False
    if step.body:
        data["body"] = [_step_data(inner) for inner in step.body]
    return data


def _values(item: Any) -> dict[str, Any]:
    """The values of an instruction, a row or an axis: all that are shown, and hidden ones that were changed.

    What is left out is empty or that of a new one; defaults therefore never change (a test compares them).
    """
    found: dict[str, Any] = {}
    for field in dc.fields(item):
        value = getattr(item, field.name)
        if value != field.default or (value not in ("", (), NONE) and is_shown(item, field.name)):
            found[field.name] = _value_data(value)
    return found


def _value_data(value: Any) -> Any:
    if isinstance(value, StrEnum):
        return value.value
    if isinstance(value, tuple) and value and dc.is_dataclass(value[0]):
        return [_values(row) for row in value]
    if isinstance(value, tuple) and len(value) == len(AXES) and all(isinstance(text, str) for text in value):
        return {letter: text for letter, text in zip(AXES, value, strict=True) if text}
    return list(value) if isinstance(value, tuple) else value


def _setup_data(setup: Setup) -> dict[str, Any]:
    data: dict[str, Any] = {name: value for name, value in _plain_values(setup).items() if value != ""}
    data["axes"] = {letter: _values(setup.axis(letter)) for letter in AXES if setup.axis(letter) != Axis()}
    for name in ("input_names", "output_names"):
        names = getattr(setup, name)
        data[name] = {str(place + 1): text for place, text in enumerate(names) if text}
    return data


def _plain_values(setup: Setup) -> dict[str, str]:
    return {field.name: getattr(setup, field.name) for field in dc.fields(setup) if isinstance(field.default, str)}


def readable(data: Mapping[str, Any]) -> str:
    """JSON as people read and compare it: a line for each step, axis or short value."""
    return _pretty(data, "") + "\n"


def _pretty(value: Any, indent: str, open_lists: bool = True) -> str:
    """JSON with each step, axis or short value on a line of its own, so that files compare line by line."""
    flat = json.dumps(value, ensure_ascii=False)
    inside = indent + "  "
    if isinstance(value, dict) and value and (indent == "" or len(flat) > _WIDEST or "body" in value):
        rows = [f"{inside}{json.dumps(key)}: {_pretty(inner, inside)}" for key, inner in value.items()]
        return "{\n" + ",\n".join(rows) + "\n" + indent + "}"
    if isinstance(value, list) and value and (isinstance(value[0], dict) or len(flat) > _WIDEST):
        return "[\n" + ",\n".join(inside + _pretty(inner, inside) for inner in value) + "\n" + indent + "]"
    return flat


def save(path: str | Path, document: Document) -> None:
    """Writes a `.tlp` file; a crash leaves the old one whole."""
    save_text(path, dumps(document))


def save_setup(path: str | Path, setup: Setup) -> None:
    """Writes a `.tls` file; a crash leaves the old one whole."""
    save_text(path, setup_dumps(setup))


# ----------------------------------------------------------------------- reading


class _Wrong(Exception):
    """What is wrong with the contents, with a text to look for when its line is wanted."""

    def __init__(self, message: str, near: str = "") -> None:
        super().__init__(message)
        self.near = near


def load(path: str | Path) -> Document:
    """Opens a `.tlp` file."""
    return loads(_text_of(path))


def load_setup(path: str | Path) -> Setup:
    """Opens a `.tls` file."""
    return setup_loads(_text_of(path))


def _text_of(path: str | Path) -> str:
    try:
        return Path(path).read_bytes().decode("utf-8-sig")
    except UnicodeDecodeError:
        raise FileUnreadable(f"{Path(path).name} is not a program file (it is not text)") from None
    except OSError as error:
        raise FileUnreadable(f"{Path(path).name} cannot be read: {error.strerror or error}") from None


def loads(text: str) -> Document:
    """A document from the text of a `.tlp` file."""
    return _read(text, PROGRAM, "program", _document)


def setup_loads(text: str) -> Setup:
    """A setup from the text of a `.tls` file."""
    return _read(text, SETUP, "setup", _setup)


def steps_from_text(text: str) -> Steps:
    """Steps from the clipboard; nothing when it holds none."""
    try:
        return _read(text, STEPS, "steps", lambda data: _steps(data.get("steps", []), set(), 0))
    except FileUnreadable:
        return ()


def _read(text: str, format: str, kind: str, build: Callable[[Mapping[str, Any]], Read]) -> Read:
    try:
        data = json.loads(text, object_pairs_hook=_unique, parse_constant=_constant)
        if not isinstance(data, dict) or data.get("format") != format:
            raise _Wrong(f'it has no "format": "{format}"')
        version = data.get("version")
        if not isinstance(version, int) or isinstance(version, bool) or version < 1:
            raise _Wrong("its version is missing", '"version"')
        if version > VERSION:
            raise FileUnreadable(
                f"this {kind} file was written by a newer Twoletter Studio (version {version} of the format)"
            )
        return build(data)
    except json.JSONDecodeError as error:
        raise FileUnreadable(f"not a {kind} file (line {error.lineno}: {error.msg})") from None
    except RecursionError:
        raise FileUnreadable(f"not a {kind} file (it is nested too deeply)") from None
    except _Wrong as error:
        place = text.find(error.near) if error.near else -1
        where = f"line {text.count(chr(10), 0, place) + 1}: " if place >= 0 else ""
        raise FileUnreadable(f"not a {kind} file ({where}{error})") from None


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    data = dict(pairs)
    if len(data) < len(pairs):
        name = next(key for place, (key, _) in enumerate(pairs) if key in dict(pairs[:place]))
        raise _Wrong(f"'{name}' is there twice")
    return data


def _constant(name: str) -> NoReturn:
    raise _Wrong(f"{name} is no value", name)


def _document(data: Mapping[str, Any]) -> Document:
    ids: set[str] = set()
    sections = {section.value: _steps(data.get(section.value, []), ids, 0) for section in Section}
    program = Program(name=_text(data, "name"), description=_text(data, "description"), **sections)
    setup = data.get("setup", {})
    if not isinstance(setup, dict):
        raise _Wrong("its setup is not a list of values", '"setup"')
    return Document(
        program=program,
        setup=_setup(setup),
        stimulus=_lines(data, "stimulus"),
        notes=_lines(data, "notes"),
        handover=_handover(data.get("handover", {})),
        compact=data.get("compact") is True,
    )


def _handover(data: Any) -> Handover:
    names = [field.name for field in dc.fields(Handover)]
    if not isinstance(data, dict) or not data.keys() <= set(names):
        raise _Wrong(f"its handover has more than {', '.join(names)}", '"handover"')
    return Handover(**{name: _text(data, name) for name in names})


def _text(data: Mapping[str, Any], name: str) -> str:
    value = data.get(name, "")
    if not isinstance(value, str):
        raise _Wrong(f"{name} is not text", f'"{name}"')
    return value


def _lines(data: Mapping[str, Any], name: str) -> str:
    value = data.get(name, [])
    if not isinstance(value, list) or not all(isinstance(line, str) for line in value):
        raise _Wrong(f"{name} is not a list of lines", f'"{name}"')
    return "\n".join(value)


CLASSES: dict[str, type[Instruction]] = {name: kind for kind in ALL for name in (kind.__name__, *kind.was)}


def _steps(data: Any, ids: set[str], depth: int) -> Steps:
    if not isinstance(data, list):
        raise _Wrong("the steps are not a list")
    if depth > _DEEPEST:
        raise _Wrong("the steps are nested too deeply")
    return tuple(_step(each, ids, depth) for each in data)


def _step(data: Any, ids: set[str], depth: int) -> Step:
    if not isinstance(data, dict):
        raise _Wrong("a step is not a list of values")
    id = data.get("id")
    if not isinstance(id, str) or not id or id in tuple(Section):
        raise _Wrong("a step has no id")
    near = f'"id": {json.dumps(id, ensure_ascii=False)}'
    if id in ids:
        raise _Wrong(f"two steps have the id {id}", near)
    ids.add(id)
    kind = CLASSES.get(data["do"]) if isinstance(data.get("do"), str) else None
    if kind is None:
        raise _Wrong(f"step {id} has the unknown instruction '{data.get('do')}'", near)
    rest = {name: value for name, value in data.items() if name not in ("id", "do", "note", "enabled", "body")}
    enabled = data.get("enabled", True)
    if not isinstance(enabled, bool):
        raise _Wrong(f"step {id}: enabled is neither true nor false", near)
    body = _steps(data.get("body", []), ids, depth + 1)
    if body and not kind.container:
        raise _Wrong(f"step {id} cannot hold other steps", near)
    return Step(id, _item(kind, rest, f"step {id}", near), _text(data, "note"), enabled, body)


def _item(kind: type[Any], data: Mapping[str, Any], who: str, near: str) -> Any:
    """An instruction, a row or an axis from its values."""
    fields = fields_of(kind)
    renamed = getattr(kind, "renamed", {})
    values: dict[str, Any] = {}
    for name, value in data.items():
        present = renamed.get(name, name)
        if present not in fields:
            raise _Wrong(f"{who} has the unknown value '{name}'", near)
        values[present] = _value(fields[present], value, f"{who}: {name}", near)
    return kind(**values)


def _value(field: Any, value: Any, who: str, near: str) -> Any:
    match field:
        case PerAxis():
            return _per_axis(value, who, near)
        case ListOf(row=row):
            if not isinstance(value, list) or not all(isinstance(each, dict) for each in value):
                raise _Wrong(f"{who} is not a list of rows", near)
            return tuple(_item(row, each, who, near) for each in value)
        case Choice(kind=kind):
            if value not in tuple(kind):
                raise _Wrong(f"{who} is none of {', '.join(kind)}", near)
            return kind(value)
        case Flag():
            if not isinstance(value, bool):
                raise _Wrong(f"{who} is neither true nor false", near)
            return value
        case _:
            if not isinstance(value, str):
                raise _Wrong(f"{who} is not text", near)
            return value


def _per_axis(value: Any, who: str, near: str) -> tuple[str, ...]:
    if not isinstance(value, dict) or not all(
        key in tuple(AXES) and isinstance(text, str) for key, text in value.items()
    ):
        raise _Wrong(f"{who} is not a list of axes", near)
    return tuple(value.get(letter, "") for letter in AXES)


def _setup(data: Mapping[str, Any]) -> Setup:
    values: dict[str, Any] = {}
    plain = _plain_values(Setup())
    for name, value in data.items():
        if name in ("format", "version"):
            continue
        if name in plain:
            values[name] = _text(data, name)
        elif name == "axes":
            values[name] = _axes(value)
        elif name in ("input_names", "output_names"):
            values[name] = _names(value, name)
        else:
            raise _Wrong(f"the setup has the unknown value '{name}'", f'"{name}"')
    if values.get("model", "ssc4") not in MODELS:
        raise _Wrong(f"there is no controller model '{values['model']}'", '"model"')
    return Setup(**values)


def _axes(value: Any) -> tuple[Axis, ...]:
    if not isinstance(value, dict) or not all(
        key in tuple(AXES) and isinstance(each, dict) for key, each in value.items()
    ):
        raise _Wrong("the axes of the setup are no list of axes", '"axes"')
    return tuple(_item(Axis, value.get(letter, {}), f"axis {letter}", f'"{letter}"') for letter in AXES)


def _names(value: Any, name: str) -> tuple[str, ...]:
    if not isinstance(value, dict) or not all(
        key in tuple("12345678") and isinstance(text, str) for key, text in value.items()
    ):
        raise _Wrong(f"{name} is not a list of names for 1 to 8", f'"{name}"')
    return tuple(value.get(str(place + 1), "") for place in range(8))
