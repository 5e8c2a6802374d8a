"""Checks of the way through a program: labels, jumps, ends, threads and automatic routines."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from codegen.twoletter.checks.rules import RULES
from codegen.twoletter.evaluate import constant
from codegen.twoletter.facts import Facts
from codegen.twoletter.nodes import EXPRESSIONS, Command, Label, Statement, Target
from codegen.twoletter.problems import Problem

RETURNS = ("EN", "RE", "RI")
# The automatic routines and the command each ends with (dmc-1412-1414.txt l.2950-3091).
ROUTINES = {
    "AUTO": "EN",
    "LIMSWI": "RE",
    "POSERR": "RE",
    "ININT": "RI",
    "MCTIME": "EN",
    "CMDERR": "EN",
    "COMINT": "EN",
}


def ends(statement: Statement) -> bool:
    """Whether the program never goes on behind this statement."""
    if not isinstance(statement, Command):
        return False
    if statement.name == "HX":
        return not statement.arguments  # halts every thread
    return statement.name in RETURNS or (statement.name == "JP" and len(statement.arguments) == 1)


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


def _reached(facts: Facts, start: int, calls: bool, stop: tuple[str, ...] = ()) -> Iterator[int]:
    """Numbers of the statements that can be reached from one; `calls` follows JS, `stop` ends a path."""
    waiting, seen = [start], set[int]()
    while waiting:
        number = waiting.pop()
        if number in seen or number >= len(facts.statements):
            continue
        seen.add(number)
        yield number
        statement = facts.statements[number].statement
        if isinstance(statement, Command):
            if statement.name in stop:
                continue
            waiting += _jump(facts, statement, calls)
        if not ends(statement):
            waiting.append(number + 1)


def _jump(facts: Facts, command: Command, calls: bool) -> list[int]:
    """Where a JP (or JS) may go."""
    if command.name == "JP" or (calls and command.name == "JS"):
        target = command.arguments[0]
        if isinstance(target, Target) and target.label in facts.at_label:
            return [facts.at_label[target.label]]
    return []


def input_threads(facts: Facts) -> Iterator[Problem]:
    """IN in what XQ starts in a thread other than 0."""
    told: set[int] = set()
    for line, command, target in _targets(facts):
        if command.name != "XQ" or len(command.arguments) < 2 or target.label not in facts.at_label:
            continue
        thread = _thread(command)
        if not thread:
            continue
        for number in _reached(facts, facts.at_label[target.label], calls=True):
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
    for name, wanted in ROUTINES.items():
        if name not in facts.at_label:
            continue
        for number in _reached(facts, facts.at_label[name], calls=False, stop=("ZS",)):
            placed = facts.statements[number]
            statement = placed.statement
            if isinstance(statement, Command) and statement.name in RETURNS and statement.name != wanted:
                span = statement.span
                yield RULES["wrong-return"].problem(
                    placed.line, span.start, span.end, name=name, wanted=wanted, found=statement.name
                )
