"""What the checks want to know about a source, gathered once: statements, labels, names and where they stand."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache

from codegen.models import Model
from codegen.twoletter.nodes import (
    EXPRESSIONS,
    Assign,
    Binary,
    Command,
    Comment,
    Dimension,
    Element,
    Expression,
    Formatted,
    Function,
    Group,
    Label,
    Line,
    Negative,
    Nothing,
    Print,
    SegmentSpeed,
    Source,
    Statement,
    Target,
    Variable,
)
from codegen.twoletter.parse import parse_line

HOST_MARKS = ("REM", "'")


def is_host_comment(line: Line) -> bool:
    """Whether the download leaves the line out."""
    first = line.statements[0] if line.statements else None
    return isinstance(first, Comment) and first.mark in HOST_MARKS


def walk(expression: Expression) -> Iterator[Expression]:
    """The expression and everything in it."""
    waiting = [expression]
    while waiting:
        node = waiting.pop()
        yield node
        match node:
            case Binary(_, left, right):
                waiting += (right, left)
            case Group(inner) | Negative(inner):
                waiting.append(inner)
            case Function(_, argument):
                waiting.append(argument)
            case Element(_, index) if index is not None:
                waiting.append(index)


def expressions_of(statement: Statement) -> Iterator[Expression]:
    """The outermost expressions a statement reads."""
    match statement:
        case Assign(target, value):
            if isinstance(target, Element) and target.index is not None:
                yield target.index
            yield value
        case Print(target):
            yield target
        case Command():
            yield from _expressions_of_command(statement)


def _expressions_of_command(command: Command) -> Iterator[Expression]:
    if command.index is not None:
        yield command.index
    for argument in command.arguments:
        match argument:
            case Formatted(Variable()) if command.name == "IN":
                pass
            case Variable() if command.name == "IN":
                pass
            case SegmentSpeed(inner) | Formatted(inner):
                yield inner
            case Dimension(_, inner) if inner is not None:
                yield inner
            case Target(_, inner) if inner is not None:
                yield inner
            case _ if isinstance(argument, EXPRESSIONS):
                yield argument


@dataclass(frozen=True, slots=True)
class LineFacts:
    """Names in one line, with their nodes."""

    read: tuple[Variable, ...]
    assigned: tuple[Variable, ...]
    elements: tuple[Element, ...]


@lru_cache(maxsize=16384)
def line_facts(text: str) -> LineFacts:
    """The names in a line."""
    read: list[Variable] = []
    assigned: list[Variable] = []
    elements: list[Element] = []
    for statement in parse_line(text).statements:
        for expression in expressions_of(statement):
            for node in walk(expression):
                if isinstance(node, Variable):
                    read.append(node)
                elif isinstance(node, Element):
                    elements.append(node)
        match statement:
            case Assign(Variable() as target):
                assigned.append(target)
            case Assign(Element() as target):
                elements.append(target)
            case Command("IN", arguments) if arguments:
                last = arguments[-1]
                place = last.expression if isinstance(last, Formatted) else last
                if isinstance(place, Variable):
                    assigned.append(place)
    return LineFacts(tuple(read), tuple(assigned), tuple(elements))


@dataclass(frozen=True, slots=True)
class Placed:
    """A statement with the number of its line."""

    line: int
    statement: Statement


@dataclass(slots=True)
class Facts:
    """A program as the checks see it; lines are those of the text, from 0."""

    model: Model
    lines: tuple[Line, ...]
    statements: list[Placed] = field(default_factory=list)
    labels: dict[str, list[tuple[int, Label]]] = field(default_factory=dict)
    at_label: dict[str, int] = field(default_factory=dict)
    read: list[tuple[int, Variable]] = field(default_factory=list)
    assigned: list[tuple[int, Variable]] = field(default_factory=list)
    elements: list[tuple[int, Element]] = field(default_factory=list)
    sent: list[int] = field(default_factory=list)

    def commands(self, *names: str) -> Iterator[tuple[int, Command]]:
        """The commands of these names with their lines."""
        for placed in self.statements:
            if isinstance(placed.statement, Command) and placed.statement.name in names:
                yield placed.line, placed.statement


def gather(source: Source, model: Model) -> Facts:
    """All facts; comments of the host and empty statements are left out."""
    facts = Facts(model, source.lines)
    for number, line in enumerate(source.lines):
        if is_host_comment(line):
            continue
        facts.sent.append(number)
        names = line_facts(line.text)
        facts.read += [(number, node) for node in names.read]
        facts.assigned += [(number, node) for node in names.assigned]
        facts.elements += [(number, node) for node in names.elements]
        for statement in line.statements:
            if isinstance(statement, Nothing | Comment):
                continue
            if isinstance(statement, Label):
                facts.labels.setdefault(statement.name, []).append((number, statement))
                facts.at_label.setdefault(statement.name, len(facts.statements))
            facts.statements.append(Placed(number, statement))
    return facts
