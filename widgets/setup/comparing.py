"""What was read from a controller beside the setup: what differs, and what was chosen for each value."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping

from codegen.setup import Setup
from codegen.setup_differences import Difference, Key, Readings, difference, differences, take
from codegen.setup_registers import BY_COMMAND
from widgets.setup.pages.compare import Choice, choices_of


@dc.dataclass(frozen=True)
class Comparing:
    """`before`: the setup when it was read, so that what was taken over can be given back."""

    readings: Readings = dc.field(default_factory=dict)
    before: Setup | None = None
    keys: tuple[Key, ...] = ()
    choices: Mapping[Key, Choice] = dc.field(default_factory=dict)

    @classmethod
    def of(cls, setup: Setup, readings: Readings) -> Comparing:
        """Just read: nothing is chosen."""
        return cls(readings, setup, tuple(each.key for each in differences(setup, readings)))

    def edited(self, old: Setup, new: Setup) -> Comparing:
        """A person changed the setup: what differs because of that is to be sent, what agrees needs nothing."""
        was = {each.key: each for each in differences(old, self.readings)}
        now = {each.key: each for each in differences(new, self.readings)}
        fresh = {key: Choice.SEND for key, each in now.items() if each.states and was.get(key) != each}
        kept = {key: each for key, each in self.choices.items() if key in now and key not in fresh}
        order = [*self.keys, *(key for key in now if key not in self.keys)]
        return dc.replace(self, keys=tuple(key for key in order if key in now), choices={**kept, **fresh})

    def choose(self, setup: Setup, key: Key, choice: Choice) -> tuple[Comparing, Setup]:
        """One value: taking it over changes the setup at once, anything else gives back what stood there."""
        held = self.choices.get(key, Choice.LEAVE)
        if choice is Choice.TAKE:
            setup = take(setup, self.readings, {key})
        elif held is Choice.TAKE and self.before is not None:
            setup = given_back(setup, self.before, key)
        return dc.replace(self, choices={**self.choices, key: choice}), setup

    def choose_all(self, setup: Setup, choice: Choice) -> tuple[Comparing, Setup]:
        """Every value for which it is possible."""
        comparing = self
        for row in self.rows(setup):
            if choice in choices_of(row):
                comparing, setup = comparing.choose(setup, row.key, choice)
        return comparing, setup

    def rows(self, setup: Setup) -> tuple[Difference, ...]:
        """Everything that differed or was taken over, with both sides as they are now."""
        return tuple(
            difference(setup, BY_COMMAND[command], letter, self.readings[command, letter])
            for command, letter in self.keys
            if letter in setup.letters
        )

    def to_send(self, setup: Setup) -> frozenset[Key]:
        """What was chosen to be sent and still differs."""
        wanted = {each.key for each in differences(setup, self.readings) if each.states}
        return frozenset(key for key, choice in self.choices.items() if choice is Choice.SEND and key in wanted)


def given_back(setup: Setup, before: Setup, key: Key) -> Setup:
    """The fields of a register as they were before."""
    command, letter = key
    old = before.axis(letter)
    values = {name: getattr(old, name) for name in BY_COMMAND[command].fields}
    return setup.with_axis(letter, dc.replace(setup.axis(letter), **values))
