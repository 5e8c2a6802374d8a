"""Texts, code, and the names of labels, variables, inputs and outputs."""

from __future__ import annotations

import dataclasses as dc
import re

from codegen.expressions import KEYWORDS, NAME, Element, Variable, parse_expression
from codegen.fields.field import Context, Field


@dc.dataclass(frozen=True, kw_only=True)
class Text(Field):
    """Free text."""

    lines: bool = False  # several lines
    most: int = 0  # most characters; 0 = no limit

    def wrong(self, value: str, context: Context) -> str | None:
        if not self.lines and "\n" in value:
            return f"{self.label} must be one line"
        if self.most and len(value) > self.most:
            return f"{self.label} may have at most {self.most} characters"
        if not all(character.isprintable() or character == "\n" for character in value):
            return f"{self.label} holds a character that cannot be shown"
        return None


@dc.dataclass(frozen=True, kw_only=True)
class MessageText(Text):
    """Text the controller sends: plain characters without the quotation mark."""

    def wrong(self, value: str, context: Context) -> str | None:
        if problem := super().wrong(value, context):
            return problem
        odd = next((character for character in value if not " " <= character <= "~" or character in '"\\'), None)
        return f"{self.label}: the controller cannot send {odd}" if odd else None

    def text(self, value: str, context: Context) -> str:
        return f'"{value}"'


@dc.dataclass(frozen=True, kw_only=True)
class Code(Field):
    """Two-letter code, one statement or several lines."""

    def wrong(self, value: str, context: Context) -> str | None:
        return context.setup.code_problem(value)

    def text(self, value: str, context: Context) -> str:
        return "; ".join(line.strip() for line in value.splitlines() if line.strip())


LABEL = re.compile(r"[A-Z][A-Z0-9]{0,6}\Z", re.ASCII)
SYSTEM_LABELS = ("AUTO", "ININT", "MCTIME", "POSERR", "LIMSWI", "CMDERR", "COMINT")


@dc.dataclass(frozen=True, kw_only=True)
class LabelName(Field):
    """A label without its `#`: a capital letter and up to six capitals or digits."""

    defines: bool = False

    def wrong(self, value: str, context: Context) -> str | None:
        if LABEL.match(value) is None:
            return f"{self.label} must be a letter and up to 6 letters or digits, in capitals"
        if self.defines and value in SYSTEM_LABELS:
            return f"{self.label}: {value} belongs to the controller; use Subroutine or Auto Execution"
        return None


@dc.dataclass(frozen=True, kw_only=True)
class VariableName(Field):
    """A variable, or with `elements` also one element of an array: `A[3]`."""

    elements: bool = False
    array: bool = False

    def wrong(self, value: str, context: Context) -> str | None:
        tree = parse_expression(value)
        if isinstance(tree, Element) and self.elements:
            return None
        if not isinstance(tree, Variable) or NAME.match(value) is None or value.upper() in KEYWORDS:
            return f"{self.label} must be a letter and up to 7 letters or digits"
        if len(value) == 2 and value.isupper() and context.setup.is_command(value):
            return f"{self.label}: {value} is a command of the controller; choose another name"
        if self.array and not value[0].isupper():
            return f"{self.label} must begin with a capital letter"
        return None


@dc.dataclass(frozen=True, kw_only=True)
class InputNumber(Field):
    """An input, by its number or by its name in the setup."""

    def wrong(self, value: str, context: Context) -> str | None:
        return _channel_problem(self.label, value, context.setup.input_number(value), context.setup.inputs)

    def text(self, value: str, context: Context) -> str:
        return context.setup.channel_text(value, context.setup.input_names, context.setup.input_number(value))


@dc.dataclass(frozen=True, kw_only=True)
class OutputNumber(Field):
    """An output, by its number or by its name in the setup."""

    def wrong(self, value: str, context: Context) -> str | None:
        return _channel_problem(self.label, value, context.setup.output_number(value), context.setup.outputs)

    def text(self, value: str, context: Context) -> str:
        return context.setup.channel_text(value, context.setup.output_names, context.setup.output_number(value))


def _channel_problem(label: str, value: str, number: int | None, count: int) -> str | None:
    if number is None:
        return f"{label}: '{value}' is neither a number nor a name of the setup"
    return None if 1 <= number <= count else f"{label} must lie between 1 and {count}"
