"""Everything that is remembered between two starts, one row each."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import platformdirs

from widgets.connect.rates import RATES

APPLICATION = "Twoletter Studio"


@dataclass(frozen=True)
class Row:
    """One setting: its key in the file, its type, what it is at first, how it is called and what it does."""

    key: str
    type: type
    default: Any
    label: str
    help: str
    choices: tuple[Any, ...] = ()
    low: float | None = None
    high: float | None = None
    was: tuple[str, ...] = ()  # earlier keys

    def problem(self, value: Any) -> str | None:
        """Why a value does not fit, in one sentence."""
        right = isinstance(value, self.type) and not (self.type is not bool and isinstance(value, bool))
        if not right:
            return f"{self.label} must be {WORDS[self.type]}."
        if self.choices and value not in self.choices:
            return f"{self.label} must be one of {', '.join(str(each) for each in self.choices)}."
        if (self.low is not None and value < self.low) or (self.high is not None and value > self.high):
            return f"{self.label} must lie between {self.low:g} and {self.high:g}."
        return None


WORDS = {str: "text", int: "a whole number", float: "a number", bool: "yes or no", list: "a list", dict: "a table"}

ROWS = (
    Row("theme", str, "system", "Colours", "Light, dark, or as the system has it.", ("system", "light", "dark")),
    Row("port", str, "", "Port", "The serial port used last."),
    Row("baud", int, 9600, "Baud rate", "Speed of the serial line; must equal the switches on the controller.",
        tuple(RATES), was=("baud_rate",)),
    Row("bits", int, 8, "Data bits", "Bits of a character.", (7, 8)),
    Row("stop_bits", int, 1, "Stop bits", "Stop bits after a character.", (1, 2)),
    Row("parity", str, "none", "Parity", "Check bit of a character.", ("none", "even", "odd")),
    Row("echo", bool, False, "Controller echo", "The controller sends back what it receives."),
    Row("simulator_baud", int, 19200, "Baud rate of the simulator",
        "Speed of the serial line to the bundled simulator: as slow as a real one.",
        tuple(RATES)),
    Row("handshake", str, "both", "Flow control", "How the controller holds the computer back.", ("none", "rts",
        "xon", "both")),
    Row("ports_used", list, [], "Known ports",
        "Ports that were connected before; only these are written to without asking."),
    Row("idle_minutes", float, 10.0, "Back to Watch after",
        "Minutes without an action after which Control falls back to Watch.",
        low=0.5, high=480.0),
    Row("known_models", dict, {}, "Known controllers",
        "Types of controllers that do not name themselves, by serial number."),
    Row("recent_files", list, [], "Recent programs", "Programs opened last, newest first."),
    Row("folded", dict, {}, "Folded", "What is folded in the programs opened last, by file."),
    Row("variable_names", dict, {}, "Names of variables",
        "Variables and arrays whose names were typed, by type and serial number of the controller."),
    Row("jog_speeds", dict, {}, "Jog speeds", "Slow, medium and fast of every axis, by its unit, for moving by hand."),
    Row("tuner", dict, {}, "Tuner", "Axis, page, view, record, steps and targets of the tuner; no gains."),
    Row("scope", dict, {}, "Scope", "Channels, colours, interval, start and view that were chosen last in the scope."),
    Row("teach", dict, {}, "Teach", "What was chosen last for teaching, speeds by the units of the axes."),
    Row("layout", str, "Program", "Layout", "Arrangement of the panels.", ("Program", "Run", "Tune", "Own")),
    Row("window", dict, {}, "Window", "Place, size and arrangement of the panels."),
    Row("look_at_start", bool, True, "Look for a controller at start",
        "Tries the ports known from before when the studio starts."),
)  # fmt: skip


class Settings:
    """The values of all rows; what the file holds that does not fit stays at its default and is a complaint."""

    def __init__(self, path: Path, rows: tuple[Row, ...] = ROWS) -> None:
        self.path = path
        self.rows: Mapping[str, Row] = {row.key: row for row in rows}
        self.complaints: list[str] = []
        self._values: dict[str, Any] = {}
        self._unknown: dict[str, Any] = {}
        self._listeners: list[Callable[[str, Any], None]] = []
        self._load()

    def get(self, key: str) -> Any:
        """The value of a row; KeyError when there is no such row."""
        value = self._values.get(key, self.rows[key].default)
        return value.copy() if isinstance(value, list | dict) else value

    def set(self, key: str, value: Any) -> None:
        """Takes a value over and writes the file; ValueError with a sentence when it does not fit."""
        problem = self.rows[key].problem(value)
        if problem is not None:
            raise ValueError(problem)
        if self.get(key) == value:
            return
        self._values[key] = value
        self.save()
        for listener in self._listeners:
            listener(key, value)

    def on_change(self, listener: Callable[[str, Any], None]) -> None:
        """Calls `listener(key, value)` after every change."""
        self._listeners.append(listener)

    def save(self) -> None:
        """Writes the whole file or nothing of it; a folder that cannot be written to is a complaint, not a stop."""
        text = json.dumps({**self._unknown, **self._values}, indent=2, sort_keys=True)
        half = self.path.with_suffix(".new")
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            half.write_text(text + "\n", encoding="utf-8")
            os.replace(half, self.path)
        except OSError as error:
            self.complaints.append(f"The settings could not be saved: {error}")

    def _load(self) -> None:
        try:
            found = json.loads(self.path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            return
        except (OSError, ValueError) as error:
            self.complaints.append(f"The settings could not be read ({error}); all are at their defaults.")
            return
        if not isinstance(found, dict):
            self.complaints.append("The settings file holds no settings; all are at their defaults.")
            return
        for row in self.rows.values():
            for key in (row.key, *row.was):
                if key in found:
                    self._take(row, found.pop(key))
        self._unknown = found

    def _take(self, row: Row, value: Any) -> None:
        if row.type is float and isinstance(value, int) and not isinstance(value, bool):
            value = float(value)
        problem = row.problem(value)
        if problem is None:
            self._values.setdefault(row.key, value)
        else:
            self.complaints.append(f"{problem} It is back at {row.default!r}.")


def settings_path() -> Path:
    """Where the settings file lies on this system."""
    return Path(platformdirs.user_config_dir(APPLICATION, appauthor=False)) / "settings.json"


def data_folder() -> Path:
    """Where crash reports, recovered programs and kept uploads go on this system."""
    return Path(platformdirs.user_data_dir(APPLICATION, appauthor=False))
