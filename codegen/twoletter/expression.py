"""Expressions: strictly left to right, comparisons weaker than + - * / & |, brackets at most four deep."""

from __future__ import annotations

from codegen.twoletter.commands import COMMANDS, FUNCTIONS, KEYWORDS
from codegen.twoletter.fixed import read_number
from codegen.twoletter.nodes import (
    Binary,
    Element,
    Expression,
    Function,
    Group,
    Keyword,
    Negative,
    Number,
    Operand,
    Span,
    String,
    Variable,
)
from codegen.twoletter.tokens import COMPARISON, END, FUNCTION, NAME, NUMBER, OPERAND, SIGN, STRING, Cursor

DEEPEST = 4  # brackets within brackets
LONGEST_NAME = 8
LONGEST_STRING = 6
LETTERS = {"X": "X", "Y": "Y", "Z": "Z", "W": "W", "A": "X", "B": "Y", "C": "Z", "D": "W"}
LATER_LETTERS = frozenset("EFGH")
_LATER_FUNCTIONS = frozenset({"ASIN", "ACOS", "ATAN", "TAN", "REAL", "ROUND", "SQRT", "FLOT", "LOG", "EXP"})
_ARITHMETIC = frozenset("+-*/&|")


def expression(cursor: Cursor) -> Expression:
    """A whole expression with comparisons."""
    left = arithmetic(cursor)
    while cursor.kind == COMPARISON:
        operator = cursor.value.replace(" ", "").replace("\t", "")
        cursor.advance()
        right = arithmetic(cursor)
        left = Binary(operator, left, right, Span(left.span.start, right.span.end))
    return left


def arithmetic(cursor: Cursor) -> Expression:
    """An expression without comparisons on its own level (segments use `<` for the speed)."""
    left = _operand(cursor)
    while cursor.kind == SIGN and cursor.value in _ARITHMETIC:
        operator = cursor.value
        cursor.advance()
        right = _operand(cursor)
        left = Binary(operator, left, right, Span(left.span.start, right.span.end))
    return left


def _operand(cursor: Cursor) -> Expression:
    minus: list[int] = []
    while cursor.kind == SIGN and cursor.value in "+-":
        if cursor.value == "-":
            minus.append(cursor.start)
        cursor.advance()
    if cursor.kind == NUMBER:
        value: Expression = _number(cursor, minus)
    else:
        reader = _READERS.get(cursor.kind)
        if reader is None:
            raise _no_value(cursor)
        value = reader(cursor)
    for start in reversed(minus):
        value = Negative(value, Span(start, value.span.end))
    return value


def _no_value(cursor: Cursor) -> Exception:
    if cursor.at("?"):
        return cursor.refuse("question-mark", 51)
    if cursor.at("~"):
        return cursor.refuse("later-form", 1, foreign=True)
    if cursor.value in (")", "]", "}"):
        return cursor.refuse("brackets", 59)
    return cursor.refuse("value-missing" if cursor.kind == END else "bad-argument", 4)


def _number(cursor: Cursor, minus: list[int]) -> Number:
    """A literal; one minus directly before it belongs to it."""
    start, text = cursor.start, cursor.value
    if minus:
        start, text = minus.pop(), "-" + text
    scaled = read_number(text)
    if scaled is None:
        raise cursor.refuse("number-too-big", 6)
    node = Number(scaled, text, Span(start, cursor.end))
    cursor.advance()
    return node


def _string(cursor: Cursor) -> String:
    return quoted(cursor, LONGEST_STRING)


def quoted(cursor: Cursor, longest: int) -> String:
    """A string in quotes of at most that many characters."""
    text = cursor.value
    if len(text) < 2 or not text.endswith('"'):
        raise cursor.refuse("missing-quote", 52)
    if len(text) - 2 > longest:
        raise cursor.refuse("string-too-long", 52)
    node = String(text[1:-1], Span(cursor.start, cursor.end))
    cursor.advance()
    return node


def _name(cursor: Cursor) -> Variable | Element | Keyword:
    """A variable, an array element or a keyword."""
    name, start, end = cursor.value, cursor.start, cursor.end
    if name in KEYWORDS:
        cursor.advance()
        return Keyword(name, Span(start, end))
    return variable(cursor)


def variable(cursor: Cursor) -> Variable | Element:
    """A variable or an array element."""
    name, start, end = cursor.value, cursor.start, cursor.end
    if len(name) > LONGEST_NAME:
        raise cursor.refuse("bad-name", 9)
    cursor.advance()
    if not cursor.at("["):
        return Variable(name, Span(start, end))
    if not name[0].isupper():
        raise cursor.refuse("bad-array", 57)
    index = in_square_brackets(cursor)
    return Element(name, index[0], Span(start, index[1]))


def in_square_brackets(cursor: Cursor) -> tuple[Expression, int]:
    """`[expression]` and the column behind it."""
    if not cursor.at("["):
        raise cursor.refuse("square-brackets", 55)
    _deeper(cursor)
    cursor.advance()
    if cursor.at("]"):
        raise cursor.refuse("index-missing", 56)
    inner = expression(cursor)
    if not cursor.at("]"):
        raise cursor.refuse("square-brackets", 55)
    cursor.depth -= 1
    end = cursor.end
    cursor.advance()
    return inner, end


def _deeper(cursor: Cursor) -> None:
    cursor.depth += 1
    if cursor.depth > cursor.deepest:
        raise cursor.refuse("too-deep", 59)


def _group(cursor: Cursor) -> Group:
    if not cursor.at("("):
        raise _no_value(cursor)
    start = cursor.start
    _deeper(cursor)
    cursor.advance()
    inner = expression(cursor)
    if not cursor.at(")"):
        raise cursor.refuse("brackets", 59)
    cursor.depth -= 1
    node = Group(inner, Span(start, cursor.end))
    cursor.advance()
    return node


def _function(cursor: Cursor) -> Function:
    name, start = cursor.value[1:], cursor.start
    if name not in FUNCTIONS:
        if name in _LATER_FUNCTIONS:
            raise cursor.refuse("later-form", 57, foreign=True)
        raise cursor.refuse("bad-function", 57)
    cursor.advance()
    argument, end = in_square_brackets(cursor)
    return Function(name, argument, Span(start, end))


def operand(cursor: Cursor) -> Operand:
    """`_TPX`, `_BGS`, `_XQ1`, `_TC` …: only operands the table has."""
    name, suffix = cursor.value[1:3], cursor.value[3:]
    row = COMMANDS.get(name) or COMMANDS.get("_" + name)
    if row is None or row.operand is None:
        raise cursor.refuse("bad-operand", 58)
    if suffix:
        suffix = _suffix(cursor, row.operand, suffix)
    node = Operand(name, suffix, Span(cursor.start, cursor.end))
    cursor.advance()
    return node


def _suffix(cursor: Cursor, kind: str, suffix: str) -> str:
    """The axis letter, S or thread number behind an operand, as X Y Z W."""
    if kind == "axis_s" and suffix == "S":
        return suffix
    if kind == "thread" and suffix in ("0", "1", "2", "3"):
        return suffix
    if kind in ("axis", "axis_s"):
        if suffix in LETTERS:
            return LETTERS[suffix]
        if suffix in LATER_LETTERS:
            raise cursor.refuse("later-axis", 58, foreign=True)
    raise cursor.refuse("bad-operand", 58)


_READERS = {
    NAME: _name,
    STRING: _string,
    OPERAND: operand,
    FUNCTION: _function,
    SIGN: _group,
}
