"""Arguments that name arrays, variables and recorded operands."""

from __future__ import annotations

from codegen.twoletter.commands import RECORDABLE
from codegen.twoletter.expression import LETTERS, LONGEST_NAME, in_square_brackets, operand
from codegen.twoletter.nodes import Dimension, Operand, Span
from codegen.twoletter.tokens import NAME, OPERAND, Cursor


def _array_name(cursor: Cursor) -> str:
    name = cursor.value
    if cursor.kind != NAME or not name[0].isupper() or len(name) > LONGEST_NAME:
        raise cursor.refuse("bad-array", 57)
    cursor.advance()
    return name


def _empty_brackets(cursor: Cursor) -> int:
    """`[]`; the column behind it."""
    if not cursor.take("[") or not cursor.at("]"):
        raise cursor.refuse("square-brackets", 55)
    end = cursor.end
    cursor.advance()
    return end


def whole_array(cursor: Cursor) -> Dimension:
    start = cursor.start
    name = _array_name(cursor)
    return Dimension(name, None, True, Span(start, _empty_brackets(cursor)))


def dimension(cursor: Cursor) -> Dimension:
    start = cursor.start
    name = _array_name(cursor)
    size, end = in_square_brackets(cursor)
    return Dimension(name, size, True, Span(start, end))


def freed(cursor: Cursor) -> Dimension:
    """`name`, `name[]`, `name[0]`, `*` or `*[0]`."""
    start, end = cursor.start, cursor.end
    if cursor.take("*"):
        name = "*"
    elif cursor.kind == NAME and len(cursor.value) <= LONGEST_NAME:
        name = cursor.value
        cursor.advance()
    else:
        raise cursor.refuse("bad-name", 9)
    if not cursor.at("["):
        return Dimension(name, None, False, Span(start, end))
    before = cursor.end
    cursor.advance()
    if cursor.at("]"):
        end = cursor.end
        cursor.advance()
        return Dimension(name, None, True, Span(start, end))
    cursor.end = before - 1
    cursor.advance()
    size, end = in_square_brackets(cursor)
    return Dimension(name, size, True, Span(start, end))


def source(cursor: Cursor) -> Operand:
    """An operand RD can record; some of them (`_SH`, `_NO`) exist only there."""
    name, suffix = cursor.value[1:3], cursor.value[3:]
    if cursor.kind != OPERAND or name not in RECORDABLE:
        raise cursor.refuse("bad-operand", 58)
    if suffix in LETTERS or not suffix:
        node = Operand(name, LETTERS.get(suffix, ""), Span(cursor.start, cursor.end))
        cursor.advance()
        return node
    return operand(cursor)
