"""What follows the two letters: one reader for each shape of arguments."""

from __future__ import annotations

import re
from collections.abc import Callable

from codegen.twoletter.array_arguments import dimension, freed, source, whole_array
from codegen.twoletter.braces import brace, local_format
from codegen.twoletter.expression import (
    LATER_LETTERS,
    LETTERS,
    arithmetic,
    expression,
    in_square_brackets,
    quoted,
    variable,
)
from codegen.twoletter.nodes import (
    Argument,
    Axes,
    Character,
    Dimension,
    Element,
    Empty,
    Expression,
    Format,
    Formatted,
    NoLineEnd,
    Operand,
    Port,
    Query,
    SegmentSpeed,
    Span,
    Target,
    Variable,
)
from codegen.twoletter.rows import Row, Takes
from codegen.twoletter.tokens import COMPARISON, END, LABEL, NAME, STRING, Cursor

LONGEST_TEXT = 72  # characters between the quotes of MG and IN
LABEL_NAME = re.compile(r"[A-Za-z][A-Za-z0-9]{0,6}\Z").match

Arguments = tuple[Argument, ...]


def _closing_format(cursor: Cursor) -> Arguments:
    return (local_format(cursor),) if cursor.at("{") else ()


# -------------------------------------------------------------- axis letters


def _letters(cursor: Cursor, extra: str) -> Axes | None:
    """Axis letters as X Y Z W; `extra` are further letters allowed."""
    letters, start, end = "", cursor.start, cursor.end
    while cursor.kind == NAME:
        for letter in cursor.value:
            if letter in extra:
                letters += letter
            elif letter in LETTERS:
                letters += LETTERS[letter]
            elif letter in LATER_LETTERS:
                raise cursor.refuse("later-axis", 90, foreign=True)
            else:
                raise cursor.refuse("bad-axis", 28 if letter == "S" else 90)
        end = cursor.end
        cursor.advance()
    return Axes(letters, Span(start, end)) if letters else None


def _query(cursor: Cursor, row: Row) -> Query:
    if row.reply is None or row.tells:
        raise cursor.refuse("question-mark", 51)
    node = Query(Span(cursor.start, cursor.end))
    cursor.advance()
    return node


def _axes(cursor: Cursor, row: Row) -> Arguments:
    if cursor.at("?"):
        return (_query(cursor, row), *_closing_format(cursor))
    axes = _letters(cursor, "S" if row.takes is Takes.AXES_S else "")
    form = _closing_format(cursor) if row.tells else ()
    return (axes, *form) if axes else form


def _axes_or_one(cursor: Cursor, row: Row) -> Arguments:
    if cursor.kind == "number" and cursor.value == "1":
        return (arithmetic(cursor),)
    return _axes(cursor, row)


def _axis(cursor: Cursor, row: Row) -> Arguments:
    refused = cursor.refuse("bad-axis", 90)
    axes = _letters(cursor, "N")
    if axes is None:
        return ()
    if len(axes.letters) != 1:
        raise refused
    return (axes,)


def _plane(cursor: Cursor, row: Row) -> Arguments:
    refused = cursor.refuse("bad-axis", 90)
    axes = _letters(cursor, "N")
    if axes is None:
        return ()
    if not 2 <= len(axes.letters) <= 3 or "N" in axes.letters[:2] or len(set(axes.letters)) != len(axes.letters):
        raise refused
    return (axes,)


def _master(cursor: Cursor, row: Row) -> Arguments:
    """One axis (`X`), an auxiliary encoder (`DX`), a commanded position (`CX`) or the vector motion (`S`)."""
    if cursor.kind == END:
        return ()
    if cursor.at("?"):
        return (_query(cursor, row),)
    text = cursor.value
    if cursor.kind != NAME:
        raise cursor.refuse("bad-axis", 90)
    if len(text) == 2 and text[0] in "DC" and text[1] in LETTERS:
        letters = text[0] + LETTERS[text[1]]
    elif text == "S" or text in LETTERS:
        letters = LETTERS.get(text, text)
    else:
        raise cursor.refuse("bad-axis", 90)
    node = Axes(letters, Span(cursor.start, cursor.end))
    cursor.advance()
    if cursor.at(","):
        raise cursor.refuse("later-form", 4, foreign=True)
    return (node,)


# ------------------------------------------------------------------- numbers


def _place(cursor: Cursor, row: Row, value: Callable[[Cursor], Expression]) -> Argument:
    """One place of a comma list: empty, `?` or a value."""
    if cursor.kind in (END, COMPARISON) or cursor.at(",") or cursor.at("{"):
        return Empty(Span(cursor.start, cursor.start))
    if cursor.at("?"):
        return _query(cursor, row)
    return value(cursor)


def _list(cursor: Cursor, row: Row, most: int, value: Callable[[Cursor], Expression] = expression) -> list[Argument]:
    """A comma list of at most `most` places; nothing at all is no place."""
    if cursor.kind == END or cursor.at("{"):
        return []
    places = [_place(cursor, row, value)]
    while cursor.at(","):
        if len(places) >= most:
            later = row.takes in (Takes.AXIS_NUMBERS, Takes.SEGMENT_AXES) and len(places) < 8
            raise cursor.refuse("later-axis" if later else "too-many", 4, foreign=later)
        cursor.advance()
        places.append(_place(cursor, row, value))
    return places


def axis_numbers(cursor: Cursor, row: Row) -> Arguments:
    """x,y,z,w"""
    places = _list(cursor, row, 4)
    return (*places, *_closing_format(cursor)) if row.reply else tuple(places)


def _one_axis_number(cursor: Cursor, row: Row) -> Arguments:
    refused = cursor.refuse("one-axis", 4)
    places = _list(cursor, row, 4)
    if places and sum(not isinstance(place, Empty) for place in places) != 1:
        raise refused
    return tuple(places)


def _numbers(cursor: Cursor, row: Row) -> Arguments:
    places = _list(cursor, row, row.most or len(row.fields))
    return (*places, *_closing_format(cursor)) if row.reply else tuple(places)


def _segment(cursor: Cursor, row: Row) -> Arguments:
    most = 4 if row.takes is Takes.SEGMENT_AXES else len(row.fields)
    places = _list(cursor, row, most, arithmetic)
    if cursor.kind == COMPARISON and cursor.value == "<":
        start = cursor.start
        cursor.advance()
        speed = arithmetic(cursor)
        places.append(SegmentSpeed(speed, Span(start, speed.span.end)))
    if cursor.kind == COMPARISON and cursor.value == ">":
        raise cursor.refuse("later-form", 4, foreign=True)
    return tuple(places)


# ------------------------------------------------------------- jump and text


def target(cursor: Cursor, empty: bool = False) -> Target:
    """`#LABEL` or a line number; `empty` allows `#` alone."""
    start, end = cursor.start, cursor.end
    if cursor.kind == LABEL:
        name = cursor.value[1:].strip()
        if not LABEL_NAME(name) and not (empty and not name):
            raise cursor.refuse("bad-target", 11)
        cursor.advance()
        return Target(name, None, Span(start, end))
    line = expression(cursor)
    return Target(None, line, line.span)


def _target(cursor: Cursor, row: Row) -> Arguments:
    if cursor.kind == END:
        return ()
    first: Argument
    if cursor.at(",") and row.name == "XQ":
        first = Empty(Span(cursor.start, cursor.start))
    else:
        first = target(cursor, empty=row.name == "DL")
    if not cursor.at(","):
        return (first,)
    if not row.fields:
        raise cursor.refuse("too-many", 4)
    cursor.advance()
    if cursor.kind == END:
        raise cursor.refuse("too-few", 50)
    return (first, target(cursor) if row.name == "LS" and cursor.kind == LABEL else expression(cursor))


def _item(cursor: Cursor) -> Argument:
    """One item of MG: text, a value with or without format, or braces alone."""
    if cursor.at("{"):
        refused = cursor.refuse("bad-format", 53)
        node = brace(cursor)
        if isinstance(node, Format):
            raise refused
        return node
    value = quoted(cursor, LONGEST_TEXT) if cursor.kind == STRING else expression(cursor)
    if not cursor.at("{"):
        return value
    return _with_format(cursor, value) or value


def _with_format(cursor: Cursor, value: Expression) -> Formatted | None:
    """The value with the format behind it; None (and nothing taken) when the braces are something else."""
    before = cursor.start
    node = brace(cursor)
    if isinstance(node, Format):
        return Formatted(value, node, Span(value.span.start, node.span.end))
    cursor.end = before
    cursor.advance()
    return None


def _message(cursor: Cursor, row: Row) -> Arguments:
    if cursor.kind == END:
        return ()
    items = [_item(cursor)]
    while cursor.kind != END:
        if not (cursor.take(",") or cursor.at("{") or isinstance(items[-1], Port | Character | NoLineEnd)):
            break
        items.append(_item(cursor))
    return tuple(items)


def _input(cursor: Cursor, row: Row) -> Arguments:
    """[{P2}] "prompt",variable[{Sn}]"""
    items: list[Argument] = []
    if cursor.at("{"):
        refused = cursor.refuse("bad-format", 53)
        port = brace(cursor)
        if not isinstance(port, Port):
            raise refused
        items.append(port)
        cursor.take(",")
    if cursor.kind != STRING:
        raise cursor.refuse("input-comma", 65)
    items.append(quoted(cursor, LONGEST_TEXT))
    if not cursor.take(","):
        raise cursor.refuse("input-comma", 65)
    if cursor.kind != NAME:
        raise cursor.refuse("input-variable", 25)
    place = variable(cursor)
    items.append(_with_string_format(cursor, place) if cursor.at("{") else place)
    return tuple(items)


def _with_string_format(cursor: Cursor, place: Variable | Element) -> Formatted:
    form = local_format(cursor)
    if form.kind != "S":
        raise cursor.refuse("bad-format", 53)
    return Formatted(place, form, Span(place.span.start, form.span.end))


def _names(item: Callable[[Cursor], Dimension | Operand]) -> Callable[[Cursor, Row], Arguments]:
    def read(cursor: Cursor, row: Row) -> Arguments:
        if cursor.kind == END:
            return ()
        if cursor.at("?"):
            return (_query(cursor, row),)
        items = [item(cursor)]
        while cursor.take(","):
            items.append(item(cursor))
        return tuple(items)

    return read


def _array_range(cursor: Cursor, row: Row) -> Arguments:
    if cursor.kind == END:
        return ()
    array = whole_array(cursor)
    if not cursor.take(","):
        return (array,)
    return (array, *_list(cursor, row, len(row.fields) - 1))


def _nothing(cursor: Cursor, row: Row) -> Arguments:
    return (_query(cursor, row),) if cursor.at("?") else ()


def index_and_numbers(cursor: Cursor, row: Row) -> tuple[Expression, Arguments]:
    """`[i]=x,y,z,w`"""
    index, _ = in_square_brackets(cursor)
    if cursor.kind != COMPARISON or cursor.value != "=":
        raise cursor.refuse("bad-argument", 4)
    cursor.advance()
    return index, tuple(_list(cursor, row, 4))


def assigned(cursor: Cursor, row: Row) -> Arguments:
    """What follows `PRX=`: one value or `?`."""
    return (_place(cursor, row, expression),)


READERS: dict[Takes, Callable[[Cursor, Row], Arguments]] = {
    Takes.NONE: _nothing,
    Takes.AXES: _axes,
    Takes.AXES_S: _axes,
    Takes.AXES_OR_ONE: _axes_or_one,
    Takes.AXIS: _axis,
    Takes.PLANE: _plane,
    Takes.MASTER: _master,
    Takes.AXIS_NUMBERS: axis_numbers,
    Takes.ONE_AXIS_NUMBER: _one_axis_number,
    Takes.NUMBERS: _numbers,
    Takes.SEGMENT_AXES: _segment,
    Takes.SEGMENT: _segment,
    Takes.TARGET: _target,
    Takes.DIMENSIONS: _names(dimension),
    Takes.DEALLOCATE: _names(freed),
    Takes.ARRAYS: _names(whole_array),
    Takes.SOURCES: _names(source),
    Takes.ARRAY_RANGE: _array_range,
    Takes.MESSAGE: _message,
    Takes.INPUT: _input,
}
