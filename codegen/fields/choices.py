"""Choices, switches and axes."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from codegen.fields.field import AXES, Context, Field, PerAxisText

if TYPE_CHECKING:
    from codegen.setup import Setup


@dc.dataclass(frozen=True, kw_only=True)
class Choice(Field):
    """One of a few: values of `kind` stand in files, `words` are offered, `phrases` stand in the sentence."""

    kind: type[StrEnum]
    words: Mapping[Any, str] = dc.field(default_factory=dict)
    phrases: Mapping[Any, str] = dc.field(
        default_factory=dict
    )  # where the sentence says it in another way; "" says nothing

    def wrong(self, value: Any, context: Context) -> str | None:
        return None if value in tuple(self.kind) else f"{self.label}: '{value}' is not one of the choices"

    def text(self, value: Any, context: Context) -> str:
        return self.phrases.get(value, self.words.get(value, str(value)))


@dc.dataclass(frozen=True, kw_only=True)
class Flag(Field):
    """Yes or no; `phrase` and `off_phrase` are what the sentence says for them ("" = nothing)."""

    phrase: str = ""
    off_phrase: str = ""
    required: bool = False

    def empty(self, value: Any) -> bool:
        return value in ("",)

    def wrong(self, value: Any, context: Context) -> str | None:
        return None if value in (True, False, "on", "off") else f"{self.label} must be on or off"

    def text(self, value: Any, context: Context) -> str:
        return self.phrase if value in (True, "on") else self.off_phrase


@dc.dataclass(frozen=True, kw_only=True)
class AxisName(Field):
    """One axis of the controller."""

    servo_only: bool = False

    def wrong(self, value: str, context: Context) -> str | None:
        return axes_problem(value if len(value) == 1 else "?", self.label, context.setup, self.servo_only)


@dc.dataclass(frozen=True, kw_only=True)
class AxisSet(Field):
    """Some axes of the controller, in the order X Y Z W."""

    servo_only: bool = False

    def wrong(self, value: str, context: Context) -> str | None:
        if value != "".join(letter for letter in AXES if letter in value):
            return f"{self.label}: name each axis once, in the order X Y Z W"
        return axes_problem(value, self.label, context.setup, self.servo_only)

    def text(self, value: str, context: Context) -> str:
        return joined(tuple(value))


def joined(words: tuple[str, ...], last: str = "and") -> str:
    """`X, Y and Z`"""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} {last} {words[-1]}" if words else ""


def axes_problem(letters: str, label: str, setup: Setup, servo_only: bool = False) -> str | None:
    """Why these axes cannot be used on this machine."""
    for letter in letters:
        if letter not in AXES:
            return f"{label}: choose one of the axes {', '.join(setup.letters)}"
        if letter not in setup.letters:
            return f"{label}: this controller has no axis {letter}"
        if servo_only and setup.axis(letter).is_stepper:
            return f"{label}: axis {letter} is a stepper, and this is for servo axes"
    return None


@dc.dataclass(frozen=True, kw_only=True)
class PerAxis(Field):
    """One value for each axis; an empty one leaves its axis alone."""

    of: Field
    servo_only: bool = False

    def wrong(self, value: PerAxisText, context: Context) -> str | None:
        found = (self.problem_of(value, letter, context) for letter in AXES)
        return next((problem for problem in found if problem), None)

    def problem_of(self, value: PerAxisText, letter: str, context: Context) -> str | None:
        """What is wrong with the value of one axis."""
        own = value[AXES.index(letter)]
        if own == "":
            return None
        if problem := axes_problem(letter, self.label, context.setup, self.servo_only):
            return problem
        problem = self.of.problem(own, Context(context.setup, letter))
        return f"{letter}: {problem}" if problem else None

    def given(self, value: PerAxisText) -> str:
        """Letters of the axes that have a value."""
        return "".join(letter for letter, text in zip(AXES, value, strict=True) if text != "")

    def text(self, value: PerAxisText, context: Context) -> str:
        parts = (
            f"{letter} {self.of.text(text, Context(context.setup, letter))}"
            for letter, text in zip(AXES, value, strict=True)
            if text != ""
        )
        return ", ".join(parts)
