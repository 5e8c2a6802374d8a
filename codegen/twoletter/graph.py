"""The ways through a program: where each statement goes on, what calls what, where threads and routines begin."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

from codegen.twoletter.facts import Facts
from codegen.twoletter.nodes import Command, Statement, Target

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


def target_of(facts: Facts, statement: Statement, *names: str) -> int | None:
    """The number of the statement a JP, JS or XQ of these names leads to."""
    if not isinstance(statement, Command) or statement.name not in names or not statement.arguments:
        return None
    target = statement.arguments[0]
    return facts.at_label.get(target.label) if isinstance(target, Target) and target.label is not None else None


@dataclass(frozen=True, slots=True)
class Graph:
    """Statements by their number in `facts.statements`."""

    facts: Facts
    nexts: tuple[tuple[int, ...], ...]  # a call comes back to the next statement
    calls: Mapping[int, int]  # statement with JS -> first statement of the subroutine
    starts: tuple[int, ...]  # of threads: the first statement and what XQ names

    def command(self, number: int) -> Command | None:
        """The command there, if it is one."""
        statement = self.facts.statements[number].statement
        return statement if isinstance(statement, Command) else None

    def reached(self, *starts: int, stop: Collection[str] = (), calls: bool = False) -> Iterator[int]:
        """Statements on all ways from `starts`; commands in `stop` end a way; `calls` goes into subroutines too."""
        waiting, seen = list(starts), set[int]()
        while waiting:
            number = waiting.pop()
            if number in seen:
                continue
            seen.add(number)
            yield number
            command = self.command(number)
            if command is not None and command.name in stop:
                continue
            waiting += self.nexts[number]
            if calls and number in self.calls:
                waiting.append(self.calls[number])

    def main(self) -> set[int]:
        """What threads come to outside subroutines."""
        return set(self.reached(*self.starts))


def graph(facts: Facts) -> Graph:
    """The graph of a program, made once for all checks."""
    nexts: list[tuple[int, ...]] = []
    calls: dict[int, int] = {}
    starts = [0] if facts.statements else []
    last = len(facts.statements) - 1
    for number, placed in enumerate(facts.statements):
        statement = placed.statement
        on = () if ends(statement) or number == last else (number + 1,)
        jump = target_of(facts, statement, "JP")
        nexts.append(on if jump is None else (*on, jump))
        if (called := target_of(facts, statement, "JS")) is not None:
            calls[number] = called
        if (started := target_of(facts, statement, "XQ")) is not None:
            starts.append(started)
    return Graph(facts, tuple(nexts), calls, tuple(dict.fromkeys(starts)))
