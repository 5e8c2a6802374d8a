"""Checks of what a program needs: lines, labels, variables, arrays and their elements."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from codegen.twoletter.checks.rules import RULES
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.evaluate import constant
from codegen.twoletter.facts import Facts, expressions_of, walk
from codegen.twoletter.graph import Graph, graph
from codegen.twoletter.nodes import Dimension, Element, Variable
from codegen.twoletter.problems import Problem
from codegen.twoletter.rows import Takes


def line_count(facts: Facts) -> Iterator[Problem]:
    """More lines than the memory has; comments of the host do not count."""
    limit = facts.model.lines
    if len(facts.sent) > limit:
        number = facts.sent[limit]
        yield RULES["too-many-lines"].problem(
            number, 0, len(facts.lines[number].text), count=len(facts.sent), limit=limit
        )


def label_count(facts: Facts) -> Iterator[Problem]:
    """More labels than the controller keeps."""
    places = sorted((line, label.span) for places in facts.labels.values() for line, label in places[:1])
    limit = facts.model.labels
    if len(places) > limit:
        line, span = places[limit]
        yield RULES["too-many-labels"].problem(line, span.start, span.end, count=len(places), limit=limit)


def _first_uses(facts: Facts) -> dict[str, tuple[int, Variable]]:
    first: dict[str, tuple[int, Variable]] = {}
    for line, node in sorted(facts.assigned + facts.read, key=lambda place: (place[0], place[1].span.start)):
        first.setdefault(node.name, (line, node))
    return first


def variable_count(facts: Facts) -> Iterator[Problem]:
    """More variables than the controller keeps."""
    first, limit = _first_uses(facts), facts.model.variables
    if len(first) > limit:
        line, node = list(first.values())[limit]
        yield RULES["too-many-variables"].problem(line, node.span.start, node.span.end, count=len(first), limit=limit)


def unassigned(facts: Facts) -> Iterator[Problem]:
    """Variables that are read but never set in the program."""
    known = {node.name for _, node in facts.assigned}
    for line, node in facts.read:
        if node.name not in known and node.name not in COMMANDS:
            known.add(node.name)
            yield RULES["unassigned"].problem(line, node.span.start, node.span.end, name=node.name)


def later_assignment(facts: Facts) -> Iterator[Problem]:
    """`PRA=100`, never read: meant as a command of later controllers."""
    read = {node.name for _, node in facts.read}
    for line, node in facts.assigned:
        name = node.name
        row = COMMANDS.get(name[:2])
        if name in read or row is None or len(name) != 3 or name[2] not in "ABCDEFGH":
            continue
        if row.takes is Takes.AXIS_NUMBERS:
            yield RULES["later-assignment"].problem(
                line, node.span.start, node.span.end, name=name, command=row.name, axis=name[2]
            )


@dataclass(slots=True)
class _Arrays:
    """Arrays alive while the program is read from top to bottom: name, line, elements."""

    alive: dict[str, tuple[int, int]] = field(default_factory=dict)
    told: set[str] = field(default_factory=set)

    def free(self, node: Dimension) -> None:
        if node.name == "*" and node.is_array:
            self.alive.clear()
        else:
            self.alive.pop(node.name, None)


def arrays(facts: Facts) -> Iterator[Problem]:
    """DM against the room there is, in the order of the text."""
    state = _Arrays()
    for line, command in facts.commands("DM", "DA"):
        for node in command.arguments:
            if not isinstance(node, Dimension):
                continue
            size = constant(node.size) if node.size is not None else None
            if command.name == "DA" or size == 0:
                state.free(node)
                continue
            yield from _dimensioned(facts, state, line, node, (size or 0) >> 16)


def _dimensioned(facts: Facts, state: _Arrays, line: int, node: Dimension, size: int) -> Iterator[Problem]:
    span, model = node.span, facts.model
    if node.name in state.alive:
        first = state.alive[node.name][0] + 1
        yield RULES["dimensioned-twice"].problem(line, span.start, span.end, name=node.name, first=first)
    state.alive[node.name] = (line, size)
    elements = sum(each for _, each in state.alive.values())
    if len(state.alive) > model.arrays and "too-many-arrays" not in state.told:
        state.told.add("too-many-arrays")
        yield RULES["too-many-arrays"].problem(line, span.start, span.end, count=len(state.alive), limit=model.arrays)
    if elements > model.elements and "too-many-elements" not in state.told:
        state.told.add("too-many-elements")
        yield RULES["too-many-elements"].problem(line, span.start, span.end, count=elements, limit=model.elements)


def _sizes(facts: Facts) -> dict[str, set[int | None]]:
    """The sizes each array is given anywhere; None for one that is not constant."""
    sizes: dict[str, set[int | None]] = {}
    for _, command in facts.commands("DM"):
        for node in command.arguments:
            if isinstance(node, Dimension) and node.size is not None:
                value = constant(node.size)
                sizes.setdefault(node.name, set()).add(None if value is None else value >> 16)
    return sizes


def elements(facts: Facts) -> Iterator[Problem]:
    """Elements of arrays nobody dimensions, or beyond their end."""
    sizes = _sizes(facts)
    told: set[str] = set()
    for line, node in facts.elements:
        known = sizes.get(node.name)
        if known is None:
            if node.name not in told:
                told.add(node.name)
                yield RULES["undimensioned"].problem(line, node.span.start, node.span.end, name=node.name)
            continue
        index = constant(node.index) if node.index is not None else None
        if index is None or None in known:
            continue
        largest = max(size for size in known if size is not None)
        if not 0 <= index >> 16 < largest:
            yield RULES["index-range"].problem(
                line, node.span.start, node.span.end, name=node.name, last=largest - 1, index=index >> 16
            )


def whole_arrays(facts: Facts) -> Iterator[Problem]:
    """RA, QU and QD of arrays nobody dimensions."""
    sizes = _sizes(facts)
    for line, command in facts.commands("RA", "QU", "QD"):
        for node in command.arguments:
            if isinstance(node, Dimension) and node.name not in sizes:
                yield RULES["undimensioned"].problem(line, node.span.start, node.span.end, name=node.name)


def before_dimension(facts: Facts) -> Iterator[Problem]:
    """Elements that the program comes to before the DM of their array."""
    ways = graph(facts)
    made: dict[str, list[int]] = {}
    for number in range(len(facts.statements)):
        command = ways.command(number)
        if command is not None and command.name == "DM":
            for node in command.arguments:
                if isinstance(node, Dimension):
                    made.setdefault(node.name, []).append(number)
    for name, places in made.items():
        early = _reached_without(ways, set(places))
        used = next((number for number in sorted(early) if _uses(facts, number, name)), None)
        if used is not None:
            placed = facts.statements[used]
            span = placed.statement.span
            first = facts.statements[places[0]].line + 1
            yield RULES["dimensioned-later"].problem(placed.line, span.start, span.end, name=name, first=first)


def _reached_without(ways: Graph, barred: set[int]) -> set[int]:
    """What the first thread comes to without passing these statements, subroutines included."""
    waiting, seen = [0] if ways.facts.statements else [], set[int]()
    while waiting:
        number = waiting.pop()
        if number in seen or number in barred:
            continue
        seen.add(number)
        called = ways.calls.get(number)
        if called is None:
            waiting += ways.nexts[number]
        elif barred.isdisjoint(ways.reached(called, calls=True)):
            waiting += (*ways.nexts[number], called)
        else:
            waiting.append(called)  # it makes the array: what follows the call has it
    return seen


def _uses(facts: Facts, number: int, name: str) -> bool:
    """Whether a statement names an element of the array."""
    statement = facts.statements[number].statement
    nodes = [node for expression in expressions_of(statement) for node in walk(expression)]
    target = getattr(statement, "target", None)
    return any(isinstance(node, Element) and node.name == name for node in (*nodes, target))
