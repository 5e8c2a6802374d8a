"""A program for its first run: every speed at a part of what was written, nothing else changed.

Scaled are SP, JG, VS and the speed of a segment (`<n`); an interval of contour mode becomes 2, 4 or 16 times as long
(its steps are powers of two). Accelerations, pauses, gears and cams stay: the machine stops as hard as in earnest from
less speed, and VR multiplies a speed that is scaled already. Lines keep their numbers, so the source map stays true.
"""

from __future__ import annotations

import dataclasses as dc
import re
from collections.abc import Iterator

from codegen.document import Document
from codegen.generate import Line, Listing, generate
from codegen.setup import Finding, Setup
from codegen.twoletter.fixed import ONE
from codegen.twoletter.format import format_line
from codegen.twoletter.nodes import (
    EXPRESSIONS,
    Argument,
    Axes,
    Binary,
    Command,
    Empty,
    Expression,
    Group,
    Negative,
    Number,
    SegmentSpeed,
    Statement,
)
from codegen.twoletter.nodes import Line as Source
from codegen.twoletter.parse import parse, parse_line
from codegen.twoletter.slow_mark import BURNS, FULL, MARK

PERCENTS = (50, 25, 10)
FINEST = 2  # counts/s: SP, JG and VS are kept in twos (dmc-1412-1414.txt, SP)
LONGEST_INTERVAL = 8  # DT
SPEEDS = frozenset({"SP", "JG", "VS"})
READS = re.compile(r"_(SP|JG|VS|DT)(?![A-Z0-9]{2})")


def slowed(document: Document, percent: int) -> Listing:
    """The listing of a program at a part of its speed; what stands in the way is an error of the listing."""
    listing = generate(document)
    if percent == FULL:
        return listing
    limits = document.working_setup.limits
    lines = [_slow_line(line, FULL // percent) for line in listing.lines]
    lines.append(Line(MARK.format(percent)))
    found = list(_problems(listing, document.working_setup, percent))
    for number, line in enumerate(lines):
        if len(line.text) > limits.columns:
            words = f"Line {number} gets too long for the controller when its speed is divided: use a variable for it"
            found.append(Finding("", words, "error", "", line.step, "line-too-long"))
    if len(lines) > limits.lines:
        words = f"A slowed program needs one line more, and the controller takes {limits.lines}"
        found.append(Finding("", words, rule="too-many-lines"))
    return Listing(tuple(lines), (*listing.problems, *found))


def _slow_line(line: Line, divisor: int) -> Line:
    if line.parts:
        parts = tuple(_slow_line(part, divisor) for part in line.parts)
        return line._replace(text=";".join(part.text for part in parts), parts=parts)
    source = parse_line(line.text)
    statements = tuple(_slow(statement, divisor) for statement in source.statements)
    return line if statements == source.statements else line._replace(text=format_line(Source(statements, "")))


def _slow(statement: Statement, divisor: int) -> Statement:
    if not isinstance(statement, Command):
        return statement
    if statement.name == "DT":
        return dc.replace(statement, arguments=tuple(_interval(each, divisor) for each in statement.arguments))
    whole = statement.name in SPEEDS
    return dc.replace(statement, arguments=tuple(_argument(each, whole, divisor) for each in statement.arguments))


def _argument(argument: Argument, whole: bool, divisor: int) -> Argument:
    if isinstance(argument, SegmentSpeed):
        return dc.replace(argument, value=_speed(argument.value, divisor))
    return _speed(argument, divisor) if whole and isinstance(argument, EXPRESSIONS) else argument


def _speed(speed: Expression, divisor: int) -> Expression:
    """A number is rounded down, but never to nothing: a move that never ends helps nobody."""
    if isinstance(speed, Number):
        return _number(speed.scaled, divisor)
    if isinstance(speed, Negative) and isinstance(speed.operand, Number):
        return Negative(_number(speed.operand.scaled, divisor))
    inner = Group(speed) if isinstance(speed, Binary | Negative) else speed
    return Binary("/", inner, Number(divisor * ONE, str(divisor)))


def _number(scaled: int, divisor: int) -> Number:
    counts = abs(scaled) // divisor // (FINEST * ONE) * FINEST
    if scaled and not counts:
        counts = FINEST
    counts = -counts if scaled < 0 else counts
    return Number(counts * ONE, str(counts))


def _interval(argument: Argument, divisor: int) -> Argument:
    """Twice as long for each half; 0 ends the mode and stays."""
    if not isinstance(argument, Number) or not argument.scaled:
        return argument
    longer = argument.scaled // ONE + (divisor - 1).bit_length()
    return Number(longer * ONE, str(longer))


# ------------------------------------------------------- what cannot be slowed


def _problems(listing: Listing, setup: Setup, percent: int) -> Iterator[Finding]:
    for number, statement in parse(listing.text).statements():
        words = _problem(statement, listing.lines[number].text, percent) if isinstance(statement, Command) else ""
        if words:
            yield Finding("", words, "error", "", listing.step_of(number, _column(statement)), "not-slowed")
    bare = _unset(listing, setup)
    if bare:
        words = f"The program never sets the speed of {' and '.join(bare)}: what the controller has cannot be slowed"
        yield Finding("", words, rule="not-slowed")


def _column(statement: Statement) -> int:
    return statement.span.start


def _problem(command: Command, line: str, percent: int) -> str:
    if command.name in BURNS:
        return "This burns into the EEPROM, slowed speeds too: comment it out for a slowed run"
    if command.name == "DT" and command.arguments:
        first = command.arguments[0]
        if not isinstance(first, Number):
            return "The interval of this contour is not known before it runs, so it cannot be slowed"
        if _interval(first, FULL // percent) != first and _shown(first, percent) > LONGEST_INTERVAL:
            return f"This contour cannot run at {percent} %: its interval would be longer than DT {LONGEST_INTERVAL}"
    read = READS.search(line) if command.name != "MG" else None
    return f"This works with the speed in the controller (_{read[1]}), which is slowed already" if read else ""


def _shown(interval: Number, percent: int) -> int:
    return interval.scaled // ONE + (FULL // percent - 1).bit_length()


def _unset(listing: Listing, setup: Setup) -> list[str]:
    """Axes, and the common path, that move without a speed anywhere in the program."""
    speeds: set[str] = set()
    begun: set[str] = set()
    targets: set[str] = set()
    for _, statement in parse(listing.text).statements():
        if not isinstance(statement, Command):
            continue
        places = _places(statement)
        if statement.name in ("SP", "JG"):
            speeds |= places
        elif statement.name == "VS" or any(isinstance(each, SegmentSpeed) for each in statement.arguments):
            speeds.add("S")
        elif statement.name in ("PR", "PA", "IP"):
            targets |= places
            begun |= places if statement.name == "IP" else set()
        elif statement.name == "BG":
            begun |= set(_letters(statement)) or {"*"}
    if "*" in begun:
        begun = (begun - {"*"}) | targets
    names = [f"axis {letter}" for letter in setup.letters if letter in begun - speeds]
    return names + (["the common path"] if "S" in begun - speeds else [])


def _places(command: Command) -> set[str]:
    if command.axis is not None:
        return {command.axis}
    return {letter for letter, each in zip("XYZW", command.arguments, strict=False) if not isinstance(each, Empty)}


def _letters(command: Command) -> str:
    return "".join(each.letters for each in command.arguments if isinstance(each, Axes))
