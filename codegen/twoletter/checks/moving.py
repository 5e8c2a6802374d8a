"""What may still move at each statement, along the ways through the program, and who is refused then.

A way is followed only where it can be run through for certain: what depends on the outside (inputs, positions,
answers) may just have waited for the end of the motion, so nothing is known behind it.

A state is a set of marks: `X` moves, `+X` moves until it is stopped (JG), `jX` will do so at the next BG.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from codegen.twoletter.checks.rules import RULES
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.facts import Facts, expressions_of, walk
from codegen.twoletter.graph import ROUTINES, Graph, ends, graph
from codegen.twoletter.nodes import (
    Assign,
    Axes,
    Command,
    Element,
    Empty,
    Format,
    Function,
    Keyword,
    Operand,
    Query,
    Statement,
    Variable,
)
from codegen.twoletter.problems import Problem
from codegen.twoletter.rows import BY_AXIS, Row

SEQUENCE = "S"
NOTHING: frozenset[str] = frozenset()
_AXES = "XYZW"
_UNKNOWN_BEHIND = frozenset({"ZS", "AB", "HX", "XQ"})  # what they leave moving is not worth a guess


def axes_named(command: Command, row: Row, model_axes: str) -> frozenset[str]:
    """The axes a command sets or moves; S is the coordinated sequence."""
    if command.axis is not None:
        return frozenset(command.axis)
    if row.needs == "coordinated":
        return frozenset(SEQUENCE)
    if row.takes in BY_AXIS:
        places = zip(_AXES, command.arguments, strict=False)
        return frozenset(axis for axis, argument in places if not isinstance(argument, Empty | Query | Format))
    letters = "".join(argument.letters for argument in command.arguments if isinstance(argument, Axes))
    return frozenset(letters or model_axes)


@dataclass(slots=True)
class _Ways:
    """The state before each statement, found by going round until nothing changes."""

    facts: Facts
    ways: Graph
    before: dict[int, frozenset[str]] = field(default_factory=dict)
    counters: frozenset[str] = NOTHING
    calls_wait: dict[int, bool] = field(default_factory=dict)

    def solve(self) -> None:
        """Every beginning with nothing moving, then on and on."""
        starts = {*self.ways.starts, *self.ways.calls.values()}
        starts |= {number for name, number in self.facts.at_label.items() if name in ROUTINES}
        waiting = sorted(starts, reverse=True)
        for number in waiting:
            self.before[number] = NOTHING
        while waiting:
            number = waiting.pop()
            behind = self.behind(number)
            state = behind if self.certain(number) else _resting(behind)
            for following in self.ways.nexts[number]:
                known = self.before.get(following)
                if known is None or not state <= known:
                    self.before[following] = state | (known or NOTHING)
                    waiting.append(following)

    def behind(self, number: int) -> frozenset[str]:
        """What moves behind a statement."""
        state, command = self.before[number], self.ways.command(number)
        if command is None:
            return state
        row = COMMANDS[command.name]
        if row.trippoint or command.name in _UNKNOWN_BEHIND:
            return state if self.waits_for_nothing(command, state) else _resting(state)
        if command.name == "IN":  # while the operator thinks, moves end; jogs go on
            return frozenset(mark for mark in state if len(mark) > 1)
        if command.name == "JS":
            return _resting(state) if self.waits(self.ways.calls.get(number)) else state
        axes = axes_named(command, row, self.facts.model.axes)
        if command.name == "JG":
            return state | {f"j{axis}" for axis in axes}
        if row.moving_mode == "idle":
            return state | {f"+{axis}" if f"j{axis}" in state else axis for axis in axes}
        if not row.moving and row.moving_mode != "jog" and not _only_asks(command):
            return state - {f"{mark}{axis}" for axis in axes for mark in ("", "+", "j")}  # told once; another target
        return state

    def waits_for_nothing(self, command: Command, state: frozenset[str]) -> bool:
        """`AM Y` while only X moves."""
        named = axes_named(command, COMMANDS[command.name], self.facts.model.axes)
        return command.name in ("AM", "MC") and named.isdisjoint(moving_in(state))

    def certain(self, number: int) -> bool:
        """Whether the ways from a statement need nothing from outside."""
        command = self.ways.command(number)
        if command is None or command.name not in ("JP", "JS") or len(command.arguments) < 2:
            return True
        return self.goes_back(number) and self.known(command)

    def goes_back(self, number: int) -> bool:
        """Whether a jump closes a loop; other conditions choose between ways that may exclude each other."""
        return any(each <= number for each in self.ways.nexts[number])

    def known(self, command: Command) -> bool:
        """Whether a condition counts only."""
        return all(
            not isinstance(node, Operand | Function | Keyword | Element)
            and (not isinstance(node, Variable) or node.name in self.counters)
            for expression in expressions_of(command)
            for node in walk(expression)
        )

    def waits(self, start: int | None) -> bool:
        """Whether a subroutine, or what it calls, may wait for an end, or moves things itself."""
        if start is None:
            return True
        if start not in self.calls_wait:
            commands = (self.ways.command(each) for each in self.ways.reached(start, calls=True))
            self.calls_wait[start] = any(
                COMMANDS[each.name].trippoint or each.name in (*_UNKNOWN_BEHIND, "BG", "JP", "IN")
                for each in commands
                if each is not None
            )
        return self.calls_wait[start]


def _resting(state: frozenset[str]) -> frozenset[str]:
    """The state without what moves."""
    return frozenset(mark for mark in state if mark.startswith("j"))


def moving_in(state: frozenset[str]) -> frozenset[str]:
    """The axes that move."""
    return frozenset(mark[-1] for mark in state if not mark.startswith("j"))


def _counters(facts: Facts) -> frozenset[str]:
    """Variables that are only ever given numbers and sums of such variables."""
    given: dict[str, list[Assign]] = {}
    other = {node.name for _, node in facts.assigned}
    for placed in facts.statements:
        if isinstance(placed.statement, Assign) and isinstance(placed.statement.target, Variable):
            given.setdefault(placed.statement.target.name, []).append(placed.statement)
    asked = {name for placed in facts.statements for name in _asked(placed.statement)}
    known = set(given) & other - asked
    while True:
        wrong = {name for name in known if not all(_only(each, known) for each in given[name])}
        if not wrong:
            return frozenset(known)
        known -= wrong


def _asked(statement: Statement) -> Iterator[str]:
    """The variables a statement lets the operator set."""
    if isinstance(statement, Command) and statement.name == "IN":
        for argument in statement.arguments:
            node = getattr(argument, "expression", argument)
            if isinstance(node, Variable):
                yield node.name


def _only(statement: Assign, known: set[str]) -> bool:
    return all(
        not isinstance(node, Operand | Function | Keyword | Element)
        and (not isinstance(node, Variable) or node.name in known)
        for node in walk(statement.value)
    )


def still_moving(facts: Facts) -> Iterator[Problem]:
    """PR, BG … of an axis that was begun on a way that leads here, with nothing that waits (error 7 or 21)."""
    found = _Ways(facts, graph(facts), counters=_counters(facts))
    found.solve()
    for number, state in sorted(found.before.items()):
        command = found.ways.command(number)
        if command is None or not state or ends(command):
            continue
        row = COMMANDS[command.name]
        axes = axes_named(command, row, facts.model.axes) & moving_in(state)
        if row.moving or row.moving_mode == "jog" or not axes or row.trippoint or _only_asks(command):
            continue
        yield RULES["still-moving"].problem(
            facts.statements[number].line,
            command.span.start,
            command.span.end,
            21 if row.moving_mode == "idle" else 7,
            text=command.name,
            axes=" ".join(sorted(axes)),
        )


def _only_asks(command: Command) -> bool:
    return any(isinstance(argument, Query) for argument in command.arguments)
