"""Variables and arrays: what the panel asks for is read and set; recipes are files."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject

from app.asked import AskedOfMachine
from app.connection import Connection
from app.run import Ask
from app.settings import Settings
from app.tick import Tick, failure_of
from app.typed_names import TypedNames
from codegen.disk import save_text
from device.wire import FRAME_COLUMNS
from widgets.parts.files import ask_open, ask_save
from widgets.values.panel import ValuesPanel
from widgets.values.typed import assignment

if TYPE_CHECKING:
    from device.values import Elements, Value, Values

RECIPES = "Recipes (*.tlr)"
KIND = "twoletter recipe"


class RecipeUnreadable(Exception):
    """The text is the sentence to show."""


class Variables(QObject):
    """One thing at a time; every failure is a sentence in the panel."""

    def __init__(
        self,
        connection: Connection,
        tick: Tick,
        panel: ValuesPanel,
        ask: Ask,
        folder: Callable[[], Path],
        settings: Settings,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._typed = TypedNames(connection, settings)
        self._connection, self._tick, self._panel, self._folder = connection, tick, panel, folder
        self._ask = AskedOfMachine(connection, ask, lambda why: panel.say(why, good=False))
        self._elements: Elements | None = None  # an array that is being read
        self._shown = 0  # of its elements
        self._another = False  # a name was typed that is not shown yet
        tick.each(self._look)
        panel.names_wanted.connect(self.read)
        panel.values_wanted.connect(self._read_values)
        panel.array_wanted.connect(self._read_array)
        panel.set_wanted.connect(self._set)
        panel.name_added.connect(self._add)
        panel.name_forgotten.connect(self._forget)
        panel.recipe_load_wanted.connect(self._ask_recipe)
        panel.recipe_save_wanted.connect(self._ask_save)
        panel.recipe_send_wanted.connect(self._ask_send)

    @property
    def _values(self) -> Values:
        from device.values import Values

        return Values(self._connection.controller)

    def read(self) -> None:
        """Names first, then what they hold."""

        def named(found: tuple[list[str], list[str]]) -> None:
            names, arrays = (list(dict.fromkeys((*a, *b))) for a, b in zip(found, self._typed.names, strict=True))
            self._panel.show_names(names, arrays)
            self._read_values(names)

        self._expect(self._values.names(), named)

    def hear(self, line: str) -> None:
        """A line that was typed elsewhere, and taken: what it names is shown as well."""
        self._another = self._typed.hear(line) or self._another

    def _add(self, name: str) -> None:
        problem = self._typed.add(name)
        self._panel.say(problem, good=False)
        if not problem:
            self._panel.new.clear()
            self.read()

    def _forget(self, name: str) -> None:
        if self._typed.forget(name):
            self.read()
        else:
            self._panel.say(f"{name} is named by the controller or its program: it stays.")

    def _read_values(self, names: Sequence[str]) -> None:
        if names:
            self._expect(self._values.read(names), self._show_values)

    def _show_values(self, values: Mapping[str, Value]) -> None:
        from codegen.difference_values import number_text
        from device.values import letters_of

        told = {name: (number_text(each), letters_of(each)) for name, each in values.items()}
        self._panel.show_values(told)
        for name, (number, _) in told.items():
            self._panel.show_element(name, number)

    def _read_array(self, name: str) -> None:
        """What comes is shown while it comes; another array ends it."""
        from device.values import Elements

        if self._elements is not None:
            self._elements.wanted = False
        elements = self._elements = Elements(name)
        self._shown = 0

        def done(future: Future[Any]) -> None:
            if elements is self._elements:
                failure = failure_of(future)
                self._show_elements()
                self._elements = None
                self._panel.say(failure, good=not failure)

        self._tick.when_done(self._values.elements(elements), done)

    def _look(self) -> None:
        """With every tick."""
        if self._another and self._panel.in_sight and not self._connection.controller.resting():
            self._another = False
            self.read()
        self._show_elements()

    def _show_elements(self) -> None:
        """The elements that have come since."""
        from codegen.difference_values import number_text

        reading = self._elements
        if reading is None:
            return
        count, total = len(reading.values), reading.total
        self._panel.say(f"Reading {reading.name}: {count} of {total}…" if total else f"Reading {reading.name}…")
        if count > self._shown:
            new = [number_text(each) for each in reading.values[self._shown : count]]
            self._panel.show_elements(reading.name, new, self._shown, total)
            self._shown = count

    def _set(self, name: str, text: str) -> None:
        command, problem = assignment(name, text)
        if problem:
            self._panel.say(problem, good=False)
            return

        def done(reply: Any) -> None:
            self._panel.say("" if reply.accepted else f"{command}: {reply.reason}", good=reply.accepted)
            self._read_values([name])

        self._expect(self._connection.controller.ask(command), done)

    # ---- recipes

    def _ask_recipe(self) -> None:
        ask_open(self._panel.window(), "Open recipe", RECIPES, self.open_recipe, self._folder())

    def open_recipe(self, path: Path) -> None:
        """Shows it beside what the controller holds; nothing is sent."""
        try:
            recipe = read_recipe(path.read_text(encoding="utf-8"))
        except (OSError, UnicodeDecodeError, RecipeUnreadable) as reason:
            self._panel.say(f"{path.name} was not opened: {reason}", good=False)
            return
        self._panel.show_recipe(recipe)
        self._panel.say(f"{path.name}: {len(recipe)} values. Send recipe writes them into the controller.")

    def _ask_save(self) -> None:
        proposed = self._folder() / "recipe.tlr"
        ask_save(self._panel.window(), "Save recipe", RECIPES, self.save_recipe, proposed, "tlr")

    def save_recipe(self, path: Path) -> None:
        """All variables and arrays as they are in the controller now."""
        names, arrays = self._panel.names, self._panel.arrays

        def read(values: Mapping[str, Value]) -> None:
            self._save_arrays(path, dict(values), list(arrays))

        self._expect(self._values.read(names), read)

    def _save_arrays(self, path: Path, values: dict[str, Value], left: list[str]) -> None:
        """One array after the other, then the file."""
        from device.values import Elements

        if not left:
            self._write(path, values)
            return
        name, rest = left[0], left[1:]
        self._panel.say(f"Reading {name} for {path.name}…")

        def read(elements: Elements) -> None:
            found = {f"{name}[{place}]": value for place, value in enumerate(elements.values)}
            self._save_arrays(path, {**values, **found}, rest)

        self._expect(self._values.elements(Elements(name)), read)

    def _write(self, path: Path, values: Mapping[str, Value]) -> None:
        from codegen.difference_values import number_text

        try:
            save_text(path, recipe_text({name: number_text(each) for name, each in values.items()}))
        except OSError as reason:
            self._panel.say(f"{path.name} was not saved: {reason.strerror or reason}", good=False)
        else:
            self._panel.say(f"{len(values)} values saved in {path.name}.")

    def _ask_send(self) -> None:
        recipe = self._panel.recipe
        words = (
            f"{len(recipe)} values are written into the controller's variables. A running program uses them at once."
        )
        self._ask("Send the recipe?", words, [("Send", lambda: self._send(list(recipe.items())))], "warning")

    def _send(self, left: list[tuple[str, str]]) -> None:
        """As many values a line as fit; the first line that is refused ends it."""
        model = self._connection.controller.model
        commands, problem = [], ""
        for name, text in left:
            command, wrong = assignment(name, text)
            commands.append(command)
            problem = problem or wrong
        if problem:
            self._panel.say(f"{problem} Nothing of the recipe was sent.", good=False)
        else:
            self._send_lines(joined(commands, (model.columns if model is not None else 40) - FRAME_COLUMNS - 2))

    def _send_lines(self, left: list[str]) -> None:
        if not left:
            self._panel.say("The recipe is in the controller.")
            self.read()
            return
        line, rest = left[0], left[1:]
        self._panel.say(f"Sending: {len(left)} lines left…")

        def done(reply: Any) -> None:
            if reply.accepted:
                self._typed.hear(line)
                self._send_lines(rest)
            else:
                self._panel.say(f"{line}: {reply.reason} The rest of the recipe was not sent.", good=False)

        self._expect(self._connection.controller.ask(line), done)

    # ---- inside

    def _expect(self, future: Future[Any], call: Callable[[Any], None]) -> None:
        def done(future: Future[Any]) -> None:
            failure = failure_of(future)
            if failure:
                self._panel.say(failure, good=False)
            else:
                call(future.result())

        self._tick.when_done(future, done)


def joined(commands: Sequence[str], room: int) -> list[str]:
    """Commands in as few lines as fit into so many characters."""
    lines: list[str] = []
    for command in commands:
        if lines and len(lines[-1]) + 1 + len(command) <= room:
            lines[-1] += f";{command}"
        else:
            lines.append(command)
    return lines


def recipe_text(values: Mapping[str, str]) -> str:
    """A readable file: names and numbers as texts, so that nothing is rounded."""
    return json.dumps({"kind": KIND, "version": 1, "values": dict(values)}, indent=1) + "\n"


def read_recipe(text: str) -> dict[str, str]:
    """What `recipe_text` wrote; RecipeUnreadable with a sentence otherwise."""
    try:
        found = json.loads(text)
    except json.JSONDecodeError as reason:
        raise RecipeUnreadable(f"it is no recipe (line {reason.lineno}: {reason.msg}).") from reason
    if not isinstance(found, dict) or found.get("kind") != KIND:
        raise RecipeUnreadable("it is no recipe.")
    if found.get("version") != 1:
        raise RecipeUnreadable("it was written by a newer version of the studio.")
    values = found.get("values")
    if not isinstance(values, dict) or not all(isinstance(each, str) for each in values.values()):
        raise RecipeUnreadable("its values are no texts.")
    for name, value in values.items():
        if problem := assignment(name, value)[1]:
            raise RecipeUnreadable(problem)
    return values
