"""Names of variables and arrays that a person has typed, by controller: one without LV does not tell them."""

from __future__ import annotations

from app.connection import Connection
from app.settings import Settings
from device.backup import names_in

KEY = "variable_names"  # the setting
MOST = 200  # names of a controller
ARRAY = "[]"


class TypedNames:
    """They come from lines that the controller has taken, or are added by name."""

    def __init__(self, connection: Connection, settings: Settings) -> None:
        self._connection, self._settings = connection, settings

    @property
    def names(self) -> tuple[list[str], list[str]]:
        """Variables and arrays of the controller that is connected."""
        kept = self._kept
        return [each for each in kept if not each.endswith(ARRAY)], [
            each.removesuffix(ARRAY) for each in kept if each.endswith(ARRAY)
        ]

    def hear(self, line: str) -> bool:
        """A line that was taken; whether it names something new."""
        variables, arrays = names_in(line)
        return self._add([*variables, *(f"{each}{ARRAY}" for each in arrays)])

    def add(self, name: str) -> str:
        """Adds a name; why that is not possible, or nothing."""
        name = name.strip()
        array = name.removesuffix(ARRAY) if name.endswith(ARRAY) else ""
        read = names_in(f"DM {array}[1]") if array else names_in(f"{name}=0")
        if read != (([], [array]) if array else ([name], [])):
            return f"“{name}” is no name: up to 8 letters and digits, a letter first, and no command. Arrays: NAME[]."
        self._add([name])
        return ""

    def forget(self, name: str) -> bool:
        """Whether it was a typed one."""
        kept = self._kept
        if name not in kept:
            return False
        self._keep([each for each in kept if each != name])
        return True

    def _add(self, names: list[str]) -> bool:
        kept = self._kept
        new = [each for each in names if each not in kept]
        if new:
            self._keep([*kept, *new][-MOST:])
        return bool(new)

    @property
    def _whose(self) -> str:
        controller = self._connection.controller
        serial = (controller.identity.serial or 0) if controller.identity is not None else 0
        return f"{controller.model.name}-{serial}" if controller.model is not None else ""

    @property
    def _kept(self) -> list[str]:
        """Of the settings file, as far as it is what this program wrote."""
        found = self._settings.get(KEY).get(self._whose)
        return [each for each in found if isinstance(each, str)] if isinstance(found, list) else []

    def _keep(self, names: list[str]) -> None:
        if self._whose:
            self._settings.set(KEY, {**self._settings.get(KEY), self._whose: names})
