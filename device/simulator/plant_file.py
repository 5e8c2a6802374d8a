"""Reads plant files: what is bolted to each axis, in TOML (`spec/cli.md`)."""

from __future__ import annotations

import math
import tomllib
from dataclasses import fields
from pathlib import Path
from typing import Any

from device.simulator.kernel.layout import MAXIMUM_DELAY
from device.simulator.plant import Drive, Enable, Place, Plant

AXES = "XYZW"
POSITIVE = {
    "amplifier_gain",
    "torque_constant",
    "inertia",
    "encoder_lines",
    "magnetic_cycle",
    "peak_current",
    "resistance",
}
NOT_NEGATIVE = {
    "inductance",
    "tachometer_gain",
    "load_inertia",
    "coupling_stiffness",
    "coupling_damping",
    "torque_ripple",
    "encoder_noise",
    "viscous_friction",
    "coulomb_friction",
    "backlash",
}
SIGNED = {"gravity", "auxiliary_ratio", "forward_limit", "reverse_limit", "index_at", "hall_offset"}
SWITCHES = {"phases_swapped", "motor_reversed", "limits_swapped", "home_stuck"}
CHOICES: dict[str, tuple[str, ...]] = {
    "drive": tuple(Drive),
    "main": (Place.MOTOR, Place.LOAD),
    "auxiliary": tuple(Place),
    "amplifier_enable": tuple(Enable),
    "dead_channel": ("a", "b"),
    "hall_order": ("123", "132", "213", "231", "312", "321"),
}


class PlantUnreadable(Exception):
    """A plant file that cannot be used; the text is one sentence."""


def number(key: str, value: Any) -> float:
    """A finite number, or the sentence that says what is wrong with it."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise PlantUnreadable(f"{key} must be a number, not {value!r}")
    if key in POSITIVE and value <= 0:
        raise PlantUnreadable(f"{key} must be above 0, not {value:g}")
    if key in NOT_NEGATIVE and value < 0:
        raise PlantUnreadable(f"{key} must not be negative, but is {value:g}")
    return float(value)


def whole(key: str, value: Any, low: int, high: int) -> int:
    """A whole number in a range."""
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise PlantUnreadable(f"{key} must be a whole number from {low} to {high}, not {value!r}")
    return value


def switch_range(key: str, value: Any) -> tuple[float, float]:
    """The two ends of a switch."""
    if not isinstance(value, list) or len(value) != 2:
        raise PlantUnreadable(f"{key} must be two positions in brackets, such as [900, 1000], not {value!r}")
    low, high = (number(key, item) for item in value)
    if low > high:
        raise PlantUnreadable(f"{key} must begin with its lower end, but is [{low:g}, {high:g}]")
    return low, high


def read_value(key: str, value: Any) -> Any:
    """One entry as the Plant holds it."""
    if key in CHOICES:
        if value not in CHOICES[key]:
            allowed = ", ".join(f'"{choice}"' for choice in CHOICES[key])
            raise PlantUnreadable(f"{key} must be one of {allowed}, not {value!r}")
        return {"drive": Drive, "main": Place, "auxiliary": Place, "amplifier_enable": Enable}.get(key, str)(value)
    if key == "home_switch":
        return switch_range(key, value)
    if key == "delay_samples":
        return whole(key, value, 0, MAXIMUM_DELAY)
    if key == "hall_inputs":
        return whole(key, value, 1, 6)
    if key in SWITCHES:
        if not isinstance(value, bool):
            raise PlantUnreadable(f"{key} must be true or false, not {value!r}")
        return value
    return number(key, value)


def read_axis(table: dict[str, Any]) -> Plant:
    """One `[axis.x]` table."""
    known = {field.name for field in fields(Plant)}
    values = {}
    for key, value in table.items():
        if key not in known:
            raise PlantUnreadable(f"{key} is not something a plant file can say")
        values[key] = read_value(key, value)
    return Plant(**values)


def read_plants(text: str) -> dict[str, Plant]:
    """The axes of a plant file by upper-case letter; axes it does not name are left out."""
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as wrong:
        raise PlantUnreadable(f"not a plant file: {wrong}") from wrong
    unknown = [key for key in content if key != "axis"]
    axes = content.get("axis", {})
    if unknown or not isinstance(axes, dict):
        raise PlantUnreadable(f"a plant file holds tables such as [axis.x], not {unknown[0] if unknown else 'axis'}")
    plants = {}
    for name, table in axes.items():
        if len(name) != 1 or name.upper() not in AXES or not isinstance(table, dict):
            raise PlantUnreadable(f"axis.{name}: the axes are x, y, z and w")
        try:
            plants[name.upper()] = read_axis(table)
        except PlantUnreadable as wrong:
            raise PlantUnreadable(f"axis.{name}: {wrong}") from wrong
    return plants


def load_plants(path: Path | str) -> dict[str, Plant]:
    """Reads a plant file; raises PlantUnreadable with one sentence that names the file."""
    try:
        text = Path(path).read_text(encoding="utf-8")
    except OSError as wrong:
        raise PlantUnreadable(f"{path}: {wrong.strerror or wrong}") from wrong
    except UnicodeDecodeError as wrong:
        raise PlantUnreadable(f"{path}: not a text file") from wrong
    try:
        return read_plants(text)
    except PlantUnreadable as wrong:
        raise PlantUnreadable(f"{path}: {wrong}") from wrong
