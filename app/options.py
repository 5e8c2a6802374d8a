"""The settings window, made from the rows of the settings."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from PySide6.QtWidgets import QWidget

from app.settings import Settings

if TYPE_CHECKING:
    from widgets.options.page import Option, OptionsPage

SHOWN = ("theme", "look_at_start", "simulator_baud", "idle_minutes")  # the line itself: serial communication setup
KEPT = ("ports_used", "known_models", "recent_files")
UNITS = {"idle_minutes": "min"}
SPOKEN = {"system": "As the system", "light": "Light", "dark": "Dark"}


class Options:
    """Shows them; `choose_theme` puts new colours on at once."""

    def __init__(self, settings: Settings, choose_theme: Callable[[str], None], window: QWidget) -> None:
        self._settings, self._choose_theme, self._window = settings, choose_theme, window
        self.page: OptionsPage | None = None

    def show(self) -> None:
        """In front, with what holds now."""
        from widgets.options.page import Kept, OptionsPage

        if self.page is not None:
            self.page.close()
        rows, get = self._settings.rows, self._settings.get
        kept = [Kept(key, rows[key].label, rows[key].help, len(get(key))) for key in KEPT]
        self.page = OptionsPage([self._option(key) for key in SHOWN], kept, self._window)
        self.page.changed.connect(self._changed)
        self.page.forgotten.connect(self._forget)
        self.page.show()

    def _option(self, key: str) -> Option:
        from widgets.options.page import Option

        row = self._settings.rows[key]
        choices = tuple((each, _spoken(each)) for each in row.choices)
        low, high = row.low or 0.0, row.high or 0.0
        return Option(key, row.label, row.help, self._settings.get(key), choices, low, high, UNITS.get(key, ""))

    def _changed(self, key: str, value: object) -> None:
        if key == "theme":
            self._choose_theme(str(value))
        else:
            self._settings.set(key, value)

    def _forget(self, key: str) -> None:
        self._settings.set(key, type(self._settings.get(key))())


def _spoken(value: Any) -> str:
    return f"{value:,} baud".replace(",", " ") if isinstance(value, int) else SPOKEN.get(value, str(value))
