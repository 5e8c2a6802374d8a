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
from app.tick import Tick, failure_of
from codegen.disk import save_text
from widgets.parts.files import ask_open, ask_save
from widgets.values.panel import ValuesPanel
from widgets.values.typed import assignment

if TYPE_CHECKING:
    from device.values import Value, Values

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
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._connection, self._tick, self._panel, self._folder = connection, tick, panel, folder
        self._ask = AskedOfMachine(connection, ask, lambda why: panel.say(why, good=False))
        panel.names_wanted.connect(self.read)
        panel.values_wanted.connect(self._read_values)
        panel.array_wanted.connect(self._read_array)
        panel.set_wanted.connect(self._set)
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
            self._panel.show_names(*found)
            self._read_values(found[0])

        self._expect(self._values.names(), named)

    def _read_values(self, names: Sequence[str]) -> None:
        if names:
            self._expect(self._values.read(names), self._show_values)

    def _show_values(self, values: Mapping[str, Value]) -> None:
        from codegen.difference_values import number_text
        from device.values import letters_of

        self._panel.show_values({name: (number_text(each), letters_of(each)) for name, each in values.items()})

    def _read_array(self, name: str) -> None:
        from codegen.difference_values import number_text

        self._panel.say(f"Reading {name}…")

        def done(values: Sequence[Value]) -> None:
            self._panel.say("")
            self._panel.show_elements(name, [number_text(each) for each in values])

        self._expect(self._values.elements(name), done)

    def _set(self, name: str, text: str) -> None:
        command, problem = assignment(name, text)
        if problem:
            self._panel.say(problem, good=False)
            return

        def done(reply: Any) -> None:
            self._panel.say("" if reply.accepted else f"{command}: {reply.reason}", good=reply.accepted)
            array, bracket, _ = name.partition("[")
            if bracket:
                self._read_array(array)
            else:
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
        """All variables as they are in the controller now."""
        names = self._panel.names

        def done(values: Mapping[str, Value]) -> None:
            from codegen.difference_values import number_text

            text = recipe_text({name: number_text(each) for name, each in sorted(values.items())})
            try:
                save_text(path, text)
            except OSError as reason:
                self._panel.say(f"{path.name} was not saved: {reason.strerror or reason}", good=False)
            else:
                self._panel.say(f"{len(values)} values saved in {path.name}.")

        self._expect(self._values.read(names), done)

    def _ask_send(self) -> None:
        recipe = self._panel.recipe
        words = (
            f"{len(recipe)} values are written into the controller's variables. A running program uses them at once."
        )
        self._ask("Send the recipe?", words, [("Send", lambda: self._send(list(recipe.items())))], "warning")

    def _send(self, left: list[tuple[str, str]]) -> None:
        if not left:
            self._panel.say("The recipe is in the controller.")
            self.read()
            return
        (name, text), rest = left[0], left[1:]
        command, problem = assignment(name, text)

        def done(reply: Any) -> None:
            if reply.accepted:
                self._send(rest)
            else:
                self._panel.say(f"{command}: {reply.reason} The rest of the recipe was not sent.", good=False)

        if problem:
            self._panel.say(f"{problem} The rest of the recipe was not sent.", good=False)
        else:
            self._expect(self._connection.controller.ask(command), done)

    # ---- inside

    def _expect(self, future: Future[Any], call: Callable[[Any], None]) -> None:
        def done(future: Future[Any]) -> None:
            failure = failure_of(future)
            if failure:
                self._panel.say(failure, good=False)
            else:
                call(future.result())

        self._tick.when_done(future, done)


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
