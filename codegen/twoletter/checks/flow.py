"""Checks of the way through a program: labels, jumps, ends, threads and automatic routines."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from codegen.twoletter.checks.rules import RULES
from codegen.twoletter.evaluate import constant
from codegen.twoletter.facts import Facts
from codegen.twoletter.graph import RETURNS, ROUTINES, ends, graph
from codegen.twoletter.nodes import EXPRESSIONS, Command, Label, Target
from codegen.twoletter.problems import Problem


def _targets(facts: Facts) -> Iterator[tuple[int, Command, Target]]:
    for line, command in facts.commands("JP", "JS", "XQ"):
        first = command.arguments[0] if command.arguments else None
        if isinstance(first, Target):
            yield line, command, first


def duplicate_labels(facts: Facts) -> Iterator[Problem]:
    """The same label twice."""
    for name, places in facts.labels.items():
        for line, label in places[1:]:
            yield RULES["duplicate-label"].problem(
                line, label.span.start, label.span.end, name=name, first=places[0][0] + 1
            )


def targets(facts: Facts) -> Iterator[Problem]:
    """Jumps to labels and lines that do not exist, and to line numbers at all."""
    for line, _, target in _targets(facts):
        span = target.span
        if target.label is not None:
            if target.label not in facts.labels:
                yield RULES["missing-label"].problem(line, span.start, span.end, name=target.label)
            continue
        value = constant(target.line) if target.line is not None else None
        if value is None:
            continue
        if 0 <= value >> 16 < len(facts.sent):
            yield RULES["line-number"].problem(line, span.start, span.end)
        else:
            yield RULES["missing-line"].problem(
                line, span.start, span.end, number=value >> 16, last=len(facts.sent) - 1
            )


def never_reached(facts: Facts) -> Iterator[Problem]:
    """Statements behind an end, without a label; a closing EN is customary and not worth a word."""
    dead = told = False
    for placed in facts.statements:
        statement = placed.statement
        if isinstance(statement, Label):
            dead = told = False
        elif dead and not told and not (isinstance(statement, Command) and statement.name in RETURNS):
            told = True
            yield RULES["never-reached"].problem(placed.line, statement.span.start, statement.span.end)
        dead = dead or ends(statement)


def missing_end(facts: Facts) -> Iterator[Problem]:
    """The last statement goes on into nothing."""
    if facts.statements and not ends(facts.statements[-1].statement):
        last = facts.statements[-1]
        yield RULES["missing-end"].problem(last.line, last.statement.span.start, last.statement.span.end)


def bare_stop(facts: Facts) -> Iterator[Problem]:
    """`ST` without letters in an SSC program ends the program too."""
    if facts.model.family != "ssc":
        return
    for placed, following in pairwise(facts.statements):
        statement = placed.statement
        if isinstance(statement, Command) and statement.name == "ST" and not statement.arguments:
            after = following.statement
            if not (isinstance(after, Command) and after.name == "EN"):
                yield RULES["bare-stop"].problem(placed.line, statement.span.start, statement.span.end)


def input_threads(facts: Facts) -> Iterator[Problem]:
    """IN in what XQ starts in a thread other than 0."""
    told: set[int] = set()
    ways = graph(facts)
    for line, command, target in _targets(facts):
        if command.name != "XQ" or len(command.arguments) < 2 or target.label not in facts.at_label:
            continue
        thread = _thread(command)
        if not thread:
            continue
        for number in ways.reached(facts.at_label[target.label], calls=True):
            placed = facts.statements[number]
            statement = placed.statement
            if isinstance(statement, Command) and statement.name == "IN" and number not in told:
                told.add(number)
                span = statement.span
                yield RULES["input-thread"].problem(
                    placed.line, span.start, span.end, from_line=line + 1, thread=thread
                )


def _thread(command: Command) -> int:
    argument = command.arguments[1]
    value = constant(argument) if isinstance(argument, EXPRESSIONS) else None
    return 0 if value is None else value >> 16


def wrong_returns(facts: Facts) -> Iterator[Problem]:
    """Automatic routines that end with the wrong command; behind ZS nothing is asked."""
    ways = graph(facts)
    for name, wanted in ROUTINES.items():
        if name not in facts.at_label:
            continue
        for number in ways.reached(facts.at_label[name], stop=("ZS",)):
            placed = facts.statements[number]
            statement = placed.statement
            if isinstance(statement, Command) and statement.name in RETURNS and statement.name != wanted:
                span = statement.span
                yield RULES["wrong-return"].problem(
                    placed.line, span.start, span.end, name=name, wanted=wanted, found=statement.name
                )


def stray_returns(facts: Facts) -> Iterator[Problem]:
    """RE and RI where no automatic routine leads to."""
    ways = graph(facts)
    routines = [number for name, number in facts.at_label.items() if name in ROUTINES and name != "AUTO"]
    inside = set(ways.reached(*routines, calls=True))
    for number in sorted(set(ways.reached(*ways.starts, calls=True)) - inside):
        statement = facts.statements[number].statement
        if isinstance(statement, Command) and statement.name in ("RE", "RI"):
            belongs = "#LIMSWI and #POSERR" if statement.name == "RE" else "#ININT"
            span = statement.span
            yield RULES["stray-return"].problem(
                facts.statements[number].line, span.start, span.end, found=statement.name, belongs=belongs
            )
