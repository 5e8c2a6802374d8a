"""Text to tree: hand-written, exact about columns, never raising on any text."""

from __future__ import annotations

import re
from functools import lru_cache

from codegen.twoletter.arguments import LABEL_NAME, READERS, assigned, index_and_numbers
from codegen.twoletter.braces import local_format
from codegen.twoletter.commands import COMMANDS, FREE, KEYWORDS, LATER
from codegen.twoletter.expression import DEEPEST, expression, operand, variable
from codegen.twoletter.nodes import (
    Assign,
    Broken,
    Command,
    Comment,
    Element,
    Foreign,
    Keyword,
    Label,
    Line,
    Nothing,
    Operand,
    Print,
    Query,
    Source,
    Span,
    Statement,
    Variable,
)
from codegen.twoletter.rows import Row, Takes
from codegen.twoletter.tokens import END, LABEL, OPERAND, Cursor, Refused

LONGEST_LINE = 512  # columns; the controllers take 80 or 40
_START = re.compile(r"[ \t]*([A-Za-z][A-Za-z0-9]*)?[ \t]*")
_HOST_COMMENT = re.compile(r"[ \t]*(?:(REM)(?![A-Za-z0-9])|('))(.*)\Z", re.DOTALL).match
_STATEMENT = re.compile(r'(?:[^;"]|"[^"]*(?:"|\Z))*').match
_ASSIGNED = re.compile(r"[ \t]*=").match
_AXIS_LETTERS = frozenset("XYZW")
_BLANKS = " \t"


def parse(text: str) -> Source:
    """A whole source text; lines end with LF, CR LF or CR."""
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    if not lines[-1]:
        lines.pop()
    return Source(tuple(map(parse_line, lines)))


def parse_line(text: str, deepest: int = DEEPEST) -> Line:
    """One line without its line end; what is no statement becomes Broken or Foreign."""
    if len(text) > LONGEST_LINE and not _HOST_COMMENT(text):
        span = Span(0, len(text))
        return Line((Broken(text, "line-too-long", 60, span, Span(LONGEST_LINE, len(text))),), text)
    return _parse_line(text, deepest)


@lru_cache(maxsize=16384)
def _parse_line(text: str, deepest: int) -> Line:
    if match := _HOST_COMMENT(text):
        mark = match[1] or match[2]
        return Line((Comment(mark, match[3].strip(_BLANKS), Span(match.start(1 if match[1] else 2), len(text))),), text)
    if not text.strip(_BLANKS):
        return Line((), text)
    statements: list[Statement] = []
    position = 0
    while True:
        statement, position = _statement(text, position, deepest)
        statements.append(statement)
        if position >= len(text):
            return Line(tuple(statements), text)
        position += 1


def _statement(text: str, position: int, deepest: int) -> tuple[Statement, int]:
    """One statement and the column of the `;` (or line end) behind it."""
    match = _START.match(text, position)
    assert match is not None
    name, after = match[1] or "", match.end()
    following = text[after : after + 1]
    if name[:2] == "NO" and (name == "NO" or not _is_assignment(text, after)):
        return _comment(text, match.start(1))
    if not name and following in ("", ";"):
        return Nothing(Span(after, after)), after
    start = match.start(1) if name else after
    try:
        cursor = Cursor(text, start, deepest)
        statement = _read(cursor, name, following)
        cursor.finish()
        return statement, cursor.start
    except Refused as refused:
        end = _end_of_statement(text, start)
        span = Span(start, len(text[:end].rstrip(_BLANKS)))
        kind = Foreign if refused.foreign else Broken
        return kind(text[span.start : span.end], refused.rule, refused.code, span, refused.place), end


def _end_of_statement(text: str, start: int) -> int:
    match = _STATEMENT(text, start)
    assert match is not None
    return match.end()


def _comment(text: str, start: int) -> tuple[Statement, int]:
    """NO with everything up to `;` or the line end."""
    end = text.find(";", start)
    if end < 0:
        end = len(text)
    return Comment("NO", text[start + 2 : end].strip(_BLANKS), Span(start, end)), end


def _read(cursor: Cursor, name: str, following: str) -> Statement:
    """The statement that begins at the cursor with that name (or none) and the sign behind it."""
    if not name:
        return _unnamed(cursor)
    if following == "=":
        return _assignment(cursor, name)
    if following == "[":
        if name == "ET":
            return _table_entry(cursor)
        if _is_assignment(cursor.text, cursor.end):
            return _assign(cursor, variable(cursor))
    if name in LATER and len(name) > 2:
        raise cursor.refuse("later-command", 1, foreign=True)
    return _command(cursor, name)


def _unnamed(cursor: Cursor) -> Statement:
    """A label, a printed operand, or nothing known."""
    if cursor.kind == LABEL:
        name, start = cursor.value[1:].strip(_BLANKS), cursor.start
        if not LABEL_NAME(name):
            raise cursor.refuse("bad-label", 61)
        end = cursor.end
        cursor.advance()
        if cursor.kind != END:
            raise cursor.refuse("bad-label", 61)
        return Label(name, Span(start, end))
    if cursor.kind == OPERAND:
        node = operand(cursor)
        if cursor.value != "=":
            raise cursor.refuse("unknown-command", 1)
        cursor.advance()
        return _print(cursor, node, "not-assignable", 1)
    if cursor.at("~"):
        raise cursor.refuse("later-form", 1, foreign=True)
    raise cursor.refuse("unknown-command", 1)


def _command(cursor: Cursor, name: str) -> Command:
    letters, start = name[:2], cursor.start
    row = COMMANDS.get(letters)
    if row is None or row.takes in (Takes.OPERAND, Takes.BYTES):
        cursor.end = start + len(letters)
        if letters in LATER:
            raise cursor.refuse("later-command", 1, foreign=True)
        raise cursor.refuse("unknown-command", 1)
    cursor.end = start + 2
    cursor.advance()
    if row.takes is Takes.TABLE:
        raise cursor.refuse("square-brackets", 55)
    arguments = READERS[row.takes](cursor, row)
    if len(arguments) < row.minimum and not (arguments and isinstance(arguments[0], Query)):
        cursor.finish()
        raise cursor.refuse("too-few", 50)
    return Command(letters, arguments, span=Span(start, _last(cursor, start)))


def _last(cursor: Cursor, start: int) -> int:
    """The column behind the last sign before the cursor."""
    return len(cursor.text[start : cursor.start].rstrip(_BLANKS)) + start


def _table_entry(cursor: Cursor) -> Command:
    start, row = cursor.start, COMMANDS["ET"]
    cursor.advance()
    index, arguments = index_and_numbers(cursor, row)
    if not arguments:
        raise cursor.refuse("too-few", 50)
    return Command("ET", arguments, index=index, span=Span(start, _last(cursor, start)))


def _is_assignment(text: str, position: int) -> bool:
    """Whether `=`, or a bracketed index and `=`, follow."""
    depth = 0
    for column in range(position, _end_of_statement(text, position)):
        sign = text[column]
        if sign == "[":
            depth += 1
        elif sign == "]":
            depth -= 1
            if depth == 0:
                return _ASSIGNED(text, column + 1) is not None
        elif depth == 0 and sign not in _BLANKS:
            return sign == "="
    return False


def _assignment(cursor: Cursor, name: str) -> Statement:
    """`name=…`: a variable, a keyword that is printed, or one axis of a command (`PRX=5`)."""
    if name in KEYWORDS:
        keyword = Keyword(name, Span(cursor.start, cursor.end))
        cursor.advance()
        cursor.advance()
        return _print(cursor, keyword, "not-assignable", 9)
    if name in COMMANDS and name not in FREE:
        raise cursor.refuse("assigned-command", 1)
    row = COMMANDS.get(name[:2])
    if row is not None and len(name) == 3 and name[2] in _AXIS_LETTERS and row.takes is Takes.AXIS_NUMBERS:
        return _axis_command(cursor, row, name)
    return _assign(cursor, variable(cursor))


def _axis_command(cursor: Cursor, row: Row, name: str) -> Statement:
    place = Variable(name, Span(cursor.start, cursor.end))
    start = cursor.start
    cursor.advance()
    cursor.advance()
    if cursor.kind == END or cursor.at("{"):
        return _print(cursor, place, "bad-argument", 4)
    arguments = assigned(cursor, row)
    return Command(row.name, arguments, axis=name[2], span=Span(start, _last(cursor, start)))


def _assign(cursor: Cursor, place: Variable | Element) -> Statement:
    """What follows a place that can be assigned: `=value`, or `=` alone, which prints it."""
    cursor.advance()
    if cursor.kind == END or cursor.at("{"):
        return _print(cursor, place, "bad-argument", 4)
    value = expression(cursor)
    return Assign(place, value, Span(place.span.start, value.span.end))


def _print(cursor: Cursor, place: Variable | Element | Operand | Keyword, rule: str, code: int) -> Print:
    """`=` alone or with a format; anything else is refused with that rule."""
    if cursor.at("{"):
        form = local_format(cursor)
        return Print(place, form, Span(place.span.start, form.span.end))
    if cursor.kind != END:
        raise cursor.refuse(rule, code)
    return Print(place, None, Span(place.span.start, _last(cursor, place.span.start)))
