"""Checks of interrupts without their routine, of recording, of contours."""

from __future__ import annotations

from collections.abc import Iterator

from codegen.twoletter.checks.rules import RULES
from codegen.twoletter.evaluate import constant
from codegen.twoletter.facts import Facts
from codegen.twoletter.graph import Graph, graph
from codegen.twoletter.nodes import EXPRESSIONS, Command
from codegen.twoletter.problems import Problem


def routine_missing(facts: Facts) -> Iterator[Problem]:
    """II without #ININT, CI with an interrupt but without #COMINT."""
    for line, command in facts.commands("II", "CI"):
        label = "ININT" if command.name == "II" else "COMINT"
        if label not in facts.labels and _interrupts(command):
            yield RULES["routine-missing"].problem(
                line, command.span.start, command.span.end, text=command.name, label=label
            )


def _interrupts(command: Command) -> bool:
    """Whether a constant argument asks for an interrupt (the third of CI is no interrupt)."""
    arguments = command.arguments[:2] if command.name == "CI" else command.arguments
    values = [constant(argument) for argument in arguments if isinstance(argument, EXPRESSIONS)]
    return any(value is not None and value > 0 for value in values)


def recordings(facts: Facts) -> Iterator[Problem]:
    """RA and RD pair arrays and values one by one."""
    arrays: Command | None = None
    for line, command in facts.commands("RA", "RD"):
        if command.name == "RA":
            arrays = command
        elif arrays is not None and command.arguments and len(command.arguments) != len(arrays.arguments):
            yield RULES["record-pairs"].problem(
                line,
                command.span.start,
                command.span.end,
                values=len(command.arguments),
                arrays=len(arrays.arguments),
            )


def contours(facts: Facts) -> Iterator[Problem]:
    """CM whose records no DT 0 ends: the axes wait for the next one and take no other move."""
    ways = graph(facts)
    for number in range(len(facts.statements)):
        command = ways.command(number)
        if command is None or command.name != "CM" or not _records(ways, number):
            continue
        reached = (ways.command(each) for each in ways.reached(*ways.nexts[number], calls=True))
        if not any(each is not None and each.name == "DT" and _zero(each) for each in reached):
            span = command.span
            yield RULES["contour-open"].problem(facts.statements[number].line, span.start, span.end)


def _records(ways: Graph, number: int) -> bool:
    reached = (ways.command(each) for each in ways.reached(*ways.nexts[number], calls=True))
    return any(each is not None and each.name == "CD" for each in reached)


def _zero(command: Command) -> bool:
    """Whether the interval may be 0; of an expression nobody knows."""
    first = command.arguments[0] if command.arguments else None
    value = constant(first) if isinstance(first, EXPRESSIONS) else None
    return value is None or value == 0
