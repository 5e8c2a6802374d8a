"""The syntax tree of two-letter source: frozen nodes that know where they stand.

Positions (`Span`) never take part in comparisons, so trees of differently spaced texts compare equal.
Numbers are held as the controller holds them: integers counting 1/65536 (4 bytes integer, 2 bytes fraction).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TypeAlias

from codegen.twoletter.fixed import ONE as ONE


@dataclass(frozen=True, slots=True)
class Span:
    """Columns `start` (inclusive) to `end` (exclusive) of one line, both from 0."""

    start: int
    end: int


NOWHERE = Span(0, 0)


# ---------------------------------------------------------------- expressions


@dataclass(frozen=True, slots=True)
class Number:
    """A literal; `scaled` counts 1/65536, `text` is what was written (`$FF`, `.5`)."""

    scaled: int
    text: str = field(compare=False)
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class String:
    """Quoted text. As a value its first six bytes fill the number from the top byte down."""

    text: str
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Variable:
    name: str
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Element:
    """`name[index]`; `index` is None for a whole array (`POS[]`)."""

    name: str
    index: Expression | None
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Operand:
    """`_TPX`: command letters and what follows them (axis letter, `S`, a digit, or nothing)."""

    name: str
    suffix: str
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Keyword:
    """A value without underscore: `TIME`, `P1CH`, `P2NM`, `F1` …"""

    name: str
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Function:
    """`@SIN[argument]`"""

    name: str
    argument: Expression
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Negative:
    """Unary minus."""

    operand: Expression
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Binary:
    """`+ - * / & |` strictly left to right; comparisons bind weaker than all of them."""

    operator: str
    left: Expression
    right: Expression
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Group:
    """A bracketed expression."""

    inner: Expression
    span: Span = field(default=NOWHERE, compare=False)


Expression: TypeAlias = Number | String | Variable | Element | Operand | Keyword | Function | Negative | Binary | Group

EXPRESSIONS = (Number, String, Variable, Element, Operand, Keyword, Function, Negative, Binary, Group)  # for isinstance


# ------------------------------------------------------------------ arguments


@dataclass(frozen=True, slots=True)
class Empty:
    """An empty place in a comma list: keeps what the axis has."""

    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Query:
    """`?`"""

    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Axes:
    """Axis letters, `XY`, `S`; canonical letters X Y Z W (A B C D are read as synonyms)."""

    letters: str
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Target:
    """A jump target: `#LABEL` (name without `#`) or a line number expression."""

    label: str | None
    line: Expression | None = None
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Format:
    """A local format in braces: kind `F` (decimal), `$` (hexadecimal) or `S` (string)."""

    kind: str
    digits: int = 0
    decimals: int = 0
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Character:
    """`{^n}`"""

    code: int
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Port:
    """`{P1}` or `{P2}`"""

    number: int
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class NoLineEnd:
    """`{N}`"""

    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Formatted:
    """An expression with its local format: `V1{F4.2}`."""

    expression: Expression
    format: Format
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Dimension:
    """`name[size]` in DM; `name[]`, `name`, `*`, `*[0]` in DA, RA."""

    name: str
    size: Expression | None
    is_array: bool
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class SegmentSpeed:
    """`< n` behind LI, VP, CR: the vector speed of this segment."""

    value: Expression
    span: Span = field(default=NOWHERE, compare=False)


Argument: TypeAlias = (
    Expression
    | Empty
    | Query
    | Axes
    | Target
    | Format
    | Character
    | Port
    | NoLineEnd
    | Formatted
    | Dimension
    | SegmentSpeed
)


# ----------------------------------------------------------------- statements


@dataclass(frozen=True, slots=True)
class Command:
    """`PR 6370,,5`; `axis` is set in the form `PRX=5`, `index` in `ET[n]=…`."""

    name: str
    arguments: tuple[Argument, ...] = ()
    axis: str | None = None
    index: Expression | None = None
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Label:
    name: str
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Assign:
    """`V1=expression`"""

    target: Variable | Element
    value: Expression
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Print:
    """`V1=` or `V1={F4.2}`: sends the value."""

    target: Variable | Element | Operand | Keyword
    format: Format | None = None
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Comment:
    """`NO text` (sent to the controller), `REM text` (the host's, removed at download) or `' text`."""

    mark: str
    text: str
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Nothing:
    """An empty statement (`BG;`)."""

    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Broken:
    """Text that is no statement of any controller: why, where (`place`), and the controller's error code."""

    text: str
    rule: str
    code: int
    span: Span = field(default=NOWHERE, compare=False)
    place: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Foreign:
    """A statement of later controllers (`IF`, `PRA=`, axis `E`): understood, but not on this one."""

    text: str
    rule: str
    code: int
    span: Span = field(default=NOWHERE, compare=False)
    place: Span = field(default=NOWHERE, compare=False)


Statement: TypeAlias = Command | Label | Assign | Print | Comment | Nothing | Broken | Foreign


@dataclass(frozen=True, slots=True)
class Line:
    """One source line; `text` without its line end."""

    statements: tuple[Statement, ...]
    text: str = field(compare=False)


@dataclass(frozen=True, slots=True)
class Source:
    lines: tuple[Line, ...]

    def statements(self) -> Iterator[tuple[int, Statement]]:
        """All statements with the number of their line, from 0."""
        for number, line in enumerate(self.lines):
            for statement in line.statements:
                yield number, statement
