"""Checks along the ways through a program: running into subroutines, the stack, sequences that are never closed."""

from __future__ import annotations

from collections.abc import Iterator

from codegen.twoletter.checks.rules import RULES
from codegen.twoletter.facts import Facts
from codegen.twoletter.graph import ROUTINES, Graph, graph
from codegen.twoletter.nodes import Axes, Command, Label
from codegen.twoletter.problems import Problem, Rule

OPENS = ("LM", "VM")
CLOSES = ("LE", "VE")
SEGMENTS = {"LI": "LM", "VP": "VM", "CR": "VM"}
ALONE = {**SEGMENTS, "CD": "CM", "WC": "CM"}  # what needs its mode somewhere in the program
ENDLESS = -1  # the depth of a subroutine that calls itself
ROOM = 511  # segments that can wait (commands.md, coordinated motion)


def _problem(facts: Facts, number: int, rule: Rule, **values: object) -> Problem:
    placed = facts.statements[number]
    span = placed.statement.span
    return rule.problem(placed.line, span.start, span.end, 0, **values)


def _subroutines(ways: Graph) -> dict[int, str]:
    """Where subroutines begin, called ones and automatic ones, with their names."""
    found = {number: name for name, number in ways.facts.at_label.items() if name in ROUTINES and name != "AUTO"}
    for number in ways.calls.values():
        label = ways.facts.statements[number].statement
        if isinstance(label, Label):
            found[number] = label.name
    return found


def runs_into(facts: Facts) -> Iterator[Problem]:
    """The way goes on into a subroutine that stands below it: its end would end the program.

    Of two called subroutines the first may end with the second; automatic ones are never come to so.
    """
    ways = graph(facts)
    main = ways.main()
    begins = _subroutines(ways)
    inside = set(ways.reached(*begins, stop=("ZS",)))
    for number, name in begins.items():
        above = main | inside if name in ROUTINES else main
        if number in ways.starts or number - 1 not in above or number not in ways.nexts[number - 1]:
            continue
        yield _problem(facts, number - 1, RULES["runs-into"], name=name)


def stack_grows(facts: Facts) -> Iterator[Problem]:
    """A subroutine is left with a jump to the main program and ZS was not given: the stack fills up."""
    ways = graph(facts)
    main = ways.main()
    told: set[int] = set()
    for start, name in _subroutines(ways).items():
        if start in main:
            continue  # runs-into says it
        for number in ways.reached(start, stop=("ZS",)):
            command = ways.command(number)
            out = [each for each in ways.nexts[number] if each in main]
            if out and number not in main and number not in told and command is not None and command.name == "JP":
                told.add(number)
                yield _problem(facts, number, RULES["stack-grows"], name=name)


def call_depth(facts: Facts) -> Iterator[Problem]:
    """Calls inside calls beyond the stack (error 12), and subroutines that call themselves."""
    ways = graph(facts)
    starts = tuple(dict.fromkeys(ways.calls.values()))
    inside = {start: set(ways.reached(start, stop=("ZS",))) for start in starts}  # behind ZS the stack is empty again
    called = {start: {ways.calls[each] for each in inside[start] if each in ways.calls} for start in starts}
    depths, everything = _depths(called), {start: _all_called(called, start) for start in starts}
    main, limit = ways.main(), facts.model.subroutine_levels
    for number, target in ways.calls.items():
        back = next((each for each in starts if number in inside[each] and each in {target, *everything[target]}), None)
        if back is not None:
            yield _problem(facts, number, RULES["calls-itself"], name=_name(facts, back), limit=limit)
        elif depths[target] > limit and number in main:
            yield _problem(
                facts, number, RULES["stack-full"], name=_name(facts, target), depth=depths[target], limit=limit
            )


def _name(facts: Facts, number: int) -> str:
    label = facts.statements[number].statement
    return label.name if isinstance(label, Label) else ""


def _all_called(called: dict[int, set[int]], start: int) -> set[int]:
    """What a subroutine calls, and what that calls."""
    waiting, seen = list(called[start]), set[int]()
    while waiting:
        number = waiting.pop()
        if number not in seen:
            seen.add(number)
            waiting += called[number]
    return seen


def _depths(called: dict[int, set[int]]) -> dict[int, int]:
    """How many returns a call of each subroutine needs; ENDLESS where it comes back to itself."""
    depths: dict[int, int] = {}
    left = dict(called)
    while left:
        ready = [start for start, inner in left.items() if all(each in depths for each in inner)]
        if not ready:
            return {**dict.fromkeys(left, ENDLESS), **depths}
        for start in ready:
            depths[start] = 1 + max((depths[each] for each in left.pop(start)), default=0)
    return depths


# ------------------------------------------------------------------- sequences


def sequences(facts: Facts) -> Iterator[Problem]:
    """LM or VM that no LE or VE closes; segments without LM or VM; more segments than can wait."""
    ways = graph(facts)
    opened = {command.name for _, command in facts.commands("CM") if command.arguments or len(facts.model.axes) == 1}
    for number in range(len(facts.statements)):
        command = ways.command(number)
        if command is None or not _opens(command):
            continue
        opened.add(command.name)
        if not _closed(ways, number):
            closing = "LE" if command.name == "LM" else "VE"
            yield _problem(facts, number, RULES["sequence-open"], text=command.name, closing=closing)
    for number in range(len(facts.statements)):
        command = ways.command(number)
        wanted = ALONE.get(command.name) if command is not None else None
        if command is not None and wanted is not None and wanted not in opened:
            yield _problem(facts, number, RULES["segment-alone"], text=command.name, mode=wanted)
            return
    yield from _too_many(facts, ways)


def _opens(command: Command) -> bool:
    return command.name in OPENS and any(isinstance(argument, Axes) for argument in command.arguments)


def _closed(ways: Graph, start: int) -> bool:
    """Whether some way from the opening comes to its end before another sequence is opened."""
    on = ways.nexts[start]
    for number in ways.reached(*on, stop=(*CLOSES, *OPENS), calls=True):
        command = ways.command(number)
        if command is not None and command.name in CLOSES:
            return True
    return False


def _too_many(facts: Facts, ways: Graph) -> Iterator[Problem]:
    """Segments one after the other with nothing between that could make room."""
    count = 0
    for number, placed in enumerate(facts.statements):
        command = ways.command(number)
        if isinstance(placed.statement, Label) or (command is not None and command.name in (*OPENS, "BG", "CS")):
            count = 0
        elif command is not None and command.name in SEGMENTS:
            count += 1
            if count == ROOM + 1:
                yield _problem(facts, number, RULES["too-many-segments"], limit=ROOM)
