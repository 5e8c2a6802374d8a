"""What this studio burned into a controller, remembered by the controller's serial number."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from codegen.difference import Line
from codegen.difference_report import Burned
from codegen.difference_values import Values, number_text
from codegen.disk import save_text
from codegen.files import readable
from codegen.twoletter.commands import COMMANDS
from device.backup import number_of, per_axis

FORMAT = "twoletter burned"
FILE = "burned.json"


def save_burned(folder: Path, burned: Burned) -> None:
    """Beside the back-ups of that controller; OSError where it cannot be written."""
    folder.mkdir(parents=True, exist_ok=True)
    save_text(folder / FILE, dumps(burned))


def load_burned(folder: Path) -> Burned:
    """What is remembered; nothing where there is no file or it is spoilt: then the EEPROM is not known."""
    try:
        data = json.loads((folder / FILE).read_text(encoding="utf-8"))
        return _read(data) if isinstance(data, dict) and data.get("format") == FORMAT else Burned()
    except (OSError, ValueError, TypeError, KeyError, AttributeError):
        return Burned()


def dumps(burned: Burned) -> str:
    """As the text of the file."""
    return readable(
        {
            "format": FORMAT,
            "version": 1,
            "name": burned.name,
            "program_when": burned.program_when,
            "program": None
            if burned.program is None
            else [[each.text, each.words, each.step] for each in burned.program],
            "parameters_when": burned.parameters_when,
            "parameters": _numbers({f"{name}{axis}": value for (name, axis), value in burned.parameters.items()})
            if burned.parameters is not None
            else None,
            "variables_when": burned.variables_when,
            "variables": _numbers(burned.variables) if burned.variables is not None else None,
        }
    )


def _numbers(values: Any) -> dict[str, str]:
    return {name: number_text(value) for name, value in values.items()}


def _read(data: dict[str, Any]) -> Burned:
    program, parameters, variables = data["program"], data["parameters"], data["variables"]
    return Burned(
        None if program is None else tuple(Line(str(text), str(words), str(step)) for text, words, step in program),
        str(data["name"]),
        str(data["program_when"]),
        None if parameters is None else {_key(name): number_of(text) for name, text in parameters.items()},
        str(data["parameters_when"]),
        None if variables is None else {name: number_of(text) for name, text in variables.items()},
        str(data["variables_when"]),
    )


def _key(name: str) -> tuple[str, str]:
    if name[:2] not in COMMANDS:
        raise ValueError(name)
    return name[:2], name[2:]


def keyed(parameters: Any, axes: str) -> Values:
    """The parameters of a back-up by register and axis."""
    return {
        (name, axis): value
        for name, values in parameters.items()
        for axis, value in zip(axes if per_axis(name) else ("",), values, strict=False)
    }
