"""A profile as a readable TOML file: what differs from the defaults, each with what it means."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from device.simulator.twoletter.profile import DEFAULTS, SETTINGS, Profile, ProfileWrong, allowed, check, shown
from device.simulator.twoletter.setting import Value

TABLES = ("codes", "commands")


class ProfileUnreadable(Exception):
    """The file is no profile; the text is one sentence with the file's name in front."""


def load_profile(path: Path) -> Profile:
    """Reads a profile; raises ProfileUnreadable."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as reason:
        words = reason.strerror if isinstance(reason, OSError) and reason.strerror else "not a text file"
        raise ProfileUnreadable(f"{path.name}: {words.lower()}") from reason
    return read_profile(text, path.name)


def read_profile(text: str, name: str = "profile") -> Profile:
    """A profile from its text; unknown settings and values they cannot have are refused."""
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as reason:
        raise ProfileUnreadable(f"{name}: not a profile ({reason})") from reason
    try:
        found: dict[str, Any] = {key: check(key, value) for key, value in content.items() if key not in TABLES}
        found["codes"] = _codes(_table(content, "codes"))
        found["commands"] = {key: _change(key, value) for key, value in _table(content, "commands").items()}
        return Profile(**found)
    except ProfileWrong as reason:
        raise ProfileUnreadable(f"{name}: {reason}") from reason


def _table(content: dict[str, Any], name: str) -> dict[str, Any]:
    table = content.get(name, {})
    if not isinstance(table, dict):
        raise ProfileWrong(f"{name} is a table [{name}]")
    return table


def _codes(table: dict[str, Any]) -> dict[int, int]:
    found: dict[int, int] = {}
    for key, value in table.items():
        if not key.isascii() or not key.isdecimal() or type(value) is not int:
            raise ProfileWrong(f"{key} = {shown(value)} under [codes] is no pair of error codes")
        found[int(key)] = value
    return found


def _change(name: str, value: object) -> Mapping[str, Value]:
    if not isinstance(value, dict):
        raise ProfileWrong(f"commands.{name} is a table [commands.{name}]")
    return value


def profile_text(profile: Profile, about: str = "") -> str:
    """The file of a profile: only what differs from the defaults, with the meaning above each setting."""
    lines = [f"# {line}" for line in about.splitlines()]
    lines += [] if not lines else [""]
    for name, setting in SETTINGS.items():
        value = getattr(profile, name)
        if value != DEFAULTS[name]:
            unit = f", {setting.unit}" if setting.unit else ""
            lines.append(f"# {setting.doc}{unit}; {allowed(name)}; without this line {shown(DEFAULTS[name])}")
            lines.append(f"{name} = {_toml(value)}")
    if profile.codes:
        lines += ["", "# error code of the manuals = code of this controller", "[codes]"]
        lines += [f"{mine} = {theirs}" for mine, theirs in sorted(profile.codes.items())]
    for name, change in sorted(profile.commands.items()):
        lines += ["", f"[commands.{name}]", *(f"{key} = {_toml(value)}" for key, value in change.items())]
    return "\n".join(lines) + "\n"


def _toml(value: Value) -> str:
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    return shown(value)
