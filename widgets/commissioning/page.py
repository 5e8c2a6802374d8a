"""What the window shows, as plain values: a list of steps and one page of them; whoever joins it fills them in."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Entry:
    """A step in the list; `mark` is open, passed, failed or skipped."""

    title: str
    mark: str = "open"
    words: str = ""


@dataclass(frozen=True)
class Reading:
    """A live value, large; `role` is a role of the style sheet: ok, warning, quiet."""

    label: str
    text: str
    role: str = ""


@dataclass(frozen=True)
class Entered:
    """A field to type into, or with `choices` (value, words) to choose from."""

    name: str
    label: str
    text: str = ""
    unit: str = ""
    choices: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class Tick:
    """Something the person confirms."""

    name: str
    label: str
    on: bool = False


@dataclass(frozen=True)
class Act:
    """A button; grey with the reason where it cannot be pressed now. `moves`: something moves when it is pressed."""

    name: str
    label: str
    reason: str = ""
    primary: bool = False
    moves: bool = False


@dataclass(frozen=True)
class Page:
    """One step as it stands now."""

    key: str
    heading: str
    todo: tuple[str, ...]
    source: str = ""
    judged: str = ""
    readings: tuple[Reading, ...] = ()
    fields: tuple[Entered, ...] = ()
    ticks: tuple[Tick, ...] = ()
    acts: tuple[Act, ...] = ()
    mark: str = "open"
    sentence: str = ""
    advice: tuple[str, ...] = ()
    facts: tuple[tuple[str, str], ...] = ()
    blocked: str = ""  # why nothing can be done here yet
    busy: str = ""

    @property
    def shape(self) -> tuple[object, ...]:
        """What the page is made of; the widgets are made anew when it changes."""
        return (
            self.key,
            self.todo,
            tuple(each.label for each in self.readings),
            tuple((each.name, each.label, each.unit, each.choices) for each in self.fields),
            tuple((each.name, each.label) for each in self.ticks),
            tuple((each.name, each.label) for each in self.acts),
        )


MARK_WORDS = {"open": "not done", "passed": "passed", "failed": "failed", "skipped": "skipped"}
MARK_ROLES = {"passed": "ok", "failed": "fault", "skipped": "quiet", "open": "quiet"}
