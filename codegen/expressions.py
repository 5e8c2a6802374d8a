"""Expressions in dialog fields: a neutral tree that each language writes in its own way.

Two different operators next to each other must be grouped, because the controllers work strictly from left
to right while people do not: `A+B*2` is a problem that offers both readings.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import TypeAlias

from codegen.numbers import parse_number, plain

FUNCTIONS = ("ABS", "AN", "COM", "COS", "FRAC", "IN", "INT", "OUT", "RND", "SIN", "SQR")
KEYWORDS = ("TIME", "P1CH", "P2CH", "P1ST", "P2ST", "P1NM", "P2NM", "P1CD", "P2CD", "F1", "F2", "F3", "F4", "F5")
COMPARISONS = ("<=", ">=", "<>", "<", ">", "=")
ARITHMETIC = ("+", "-", "*", "/", "&", "|")
DEEPEST = 4  # brackets inside brackets a controller understands (ssc-tol-o-motion.txt, mathematical functions)
NAME = re.compile(r"[A-Za-z][A-Za-z0-9]{0,7}\Z", re.ASCII)


@dataclass(frozen=True, slots=True)
class Number:
    """A plain number; `hexadecimal` keeps `$FF` as it was typed."""

    value: Fraction
    hexadecimal: str = ""


@dataclass(frozen=True, slots=True)
class String:
    """Quoted text of up to six characters, compared or assigned as one value."""

    text: str


@dataclass(frozen=True, slots=True)
class Variable:
    name: str


@dataclass(frozen=True, slots=True)
class Element:
    """One element of an array."""

    name: str
    index: Expression


@dataclass(frozen=True, slots=True)
class Operand:
    """A live value of the controller: `_TPX` is name `TP`, suffix `X`."""

    name: str
    suffix: str


@dataclass(frozen=True, slots=True)
class Keyword:
    """A live value with a name of its own: `TIME`."""

    name: str


@dataclass(frozen=True, slots=True)
class Function:
    """`@SIN[argument]`"""

    name: str
    argument: Expression


@dataclass(frozen=True, slots=True)
class Negative:
    operand: Expression


@dataclass(frozen=True, slots=True)
class Binary:
    """Two values and what joins them; a chain of one operator leans to the left."""

    operator: str
    left: Expression
    right: Expression


@dataclass(frozen=True, slots=True)
class Group:
    """Brackets the person wrote."""

    inner: Expression


Expression: TypeAlias = Number | String | Variable | Element | Operand | Keyword | Function | Negative | Binary | Group


@dataclass(frozen=True, slots=True)
class Bad:
    """Why a text is no expression, in one sentence."""

    message: str


_TOKEN = re.compile(
    r"\s*(?:\"(?P<string>[^\"]*)\"|(?P<number>\d+\.?\d*|\.\d+)|(?P<hex>\$[0-9A-Fa-f]+)|_(?P<operand>[A-Za-z]{2})(?P<suffix>[A-Za-z0-9]?)"
    r"|@(?P<function>[A-Za-z]+)|(?P<name>[A-Za-z][A-Za-z0-9]*)|(?P<mark><=|>=|<>|[-+*/&|<>=()\[\]]))",
    re.ASCII,
)


@dataclass(slots=True)
class _Token:
    kind: str
    text: str
    suffix: str = ""


class _Wrong(Exception):
    """Leaves the parser with the sentence for the person."""


def _tokens(text: str) -> list[_Token]:
    found: list[_Token] = []
    place = 0
    text = text.rstrip()
    while place < len(text):
        match = _TOKEN.match(text, place)
        if match is None:
            rest = text[place:].strip()
            if rest.startswith(","):
                raise _Wrong("a comma has no place here; the decimal sign is a point")
            raise _Wrong(f"'{rest[0]}' has no place in an expression")
        kind = next(
            name
            for name in ("string", "number", "hex", "operand", "function", "name", "mark")
            if match[name] is not None
        )
        found.append(_Token(kind, match[kind], match["suffix"] or ""))
        place = match.end()
    return found


class _Parser:
    def __init__(self, text: str) -> None:
        self.tokens = _tokens(text)
        self.place = 0
        self.depth = 0

    def peek(self) -> str:
        token = self.tokens[self.place] if self.place < len(self.tokens) else None
        return token.text if token is not None and token.kind == "mark" else ""

    def whole(self) -> Expression:
        if not self.tokens:
            raise _Wrong("an expression is missing")
        tree = self.comparison()
        if self.place < len(self.tokens):
            text = self.tokens[self.place].text
            raise _Wrong(
                "a bracket is closed that was not opened" if text in ")]" else f"'{text}' is not expected here"
            )
        return tree

    def comparison(self) -> Expression:
        left = self.arithmetic()
        operator = self.peek()
        if operator not in COMPARISONS:
            return left
        self.place += 1
        right = self.arithmetic()
        if self.peek() in COMPARISONS:
            raise _Wrong("put each comparison in brackets: (A<B)&(B<C)")
        for side in (left, right):
            if isinstance(side, Binary) and side.operator in "&|":
                raise _Wrong("put each comparison in brackets: (A<B)&(C<D)")
        return Binary(operator, left, right)

    def arithmetic(self) -> Expression:
        tree = self.value()
        first = ""
        while (operator := self.peek()) in ARITHMETIC:
            self.place += 1
            right = self.value()
            if first and operator != first and isinstance(tree, Binary):
                left_first = f"({write(tree)}){operator}{write(right)}"
                right_first = f"{write(tree.left)}{tree.operator}({write(tree.right)}{operator}{write(right)})"
                raise _Wrong(f"group it with brackets: {left_first} or {right_first}")
            first = operator
            tree = Binary(operator, tree, right)
        return tree

    def value(self) -> Expression:
        if self.place >= len(self.tokens):
            raise _Wrong("something is missing at the end")
        token = self.tokens[self.place]
        self.place += 1
        if token.kind == "number":
            return Number(parse_number(token.text) or Fraction(0))
        if token.kind == "string":
            if len(token.text) > 6:
                raise _Wrong(f"the text {token.text!r} is longer than 6 characters")
            return String(token.text)
        if token.kind == "hex":
            return Number(Fraction(int(token.text[1:], 16)), token.text.upper())
        if token.kind == "operand":
            return Operand(token.text.upper(), token.suffix.upper())
        if token.kind == "function":
            return self.function(token.text.upper())
        if token.kind == "name":
            return self.name(token.text)
        return self.marked(token.text)

    def marked(self, mark: str) -> Expression:
        if mark in "+-" and self.peek() in ("+", "-"):
            raise _Wrong("two signs stand next to each other: keep one")
        if mark == "-":
            inner = self.value()
            return Number(-inner.value) if isinstance(inner, Number) and not inner.hexadecimal else Negative(inner)
        if mark == "+":
            return self.value()
        if mark == "(":
            return Group(self.bracketed(")"))
        raise _Wrong(f"'{mark}' is not expected here")

    def bracketed(self, closing: str) -> Expression:
        self.depth += 1
        if self.depth > 40:
            raise _Wrong("too many brackets inside each other")
        inner = self.comparison()
        if self.peek() != closing:
            raise _Wrong(f"'{closing}' is missing")
        self.place += 1
        self.depth -= 1
        return inner

    def function(self, name: str) -> Expression:
        if name not in FUNCTIONS:
            raise _Wrong(f"there is no function @{name}; there are " + ", ".join(f"@{each}" for each in FUNCTIONS))
        if self.peek() != "[":
            raise _Wrong(f"write @{name}[…]")
        self.place += 1
        return Function(name, self.bracketed("]"))

    def name(self, name: str) -> Expression:
        if self.peek() == "[":
            self.place += 1
            return Element(_checked(name), self.bracketed("]"))
        return Keyword(name) if name in KEYWORDS else Variable(_checked(name))


def _checked(name: str) -> str:
    if len(name) > 8:
        raise _Wrong(f"the name {name} is longer than 8 characters")
    return name


@lru_cache(maxsize=8192)
def parse_expression(text: str) -> Expression | Bad:
    """The tree of `text`, or what is wrong with it."""
    if len(text) > 200:
        return Bad("this expression is too long")
    try:
        tree = _Parser(text).whole()
    except _Wrong as wrong:
        return Bad(str(wrong))
    if depth(tree) > DEEPEST:
        return Bad(f"the controller understands at most {DEEPEST} brackets inside each other")
    return tree


def constant(tree: Expression) -> Fraction | None:
    """The number a tree is, when it is only a number."""
    if isinstance(tree, Number):
        return tree.value
    return constant(tree.inner) if isinstance(tree, Group) else None


def children(tree: Expression) -> tuple[Expression, ...]:
    """The parts directly below."""
    match tree:
        case Binary(left=left, right=right):
            return (left, right)
        case Group(inner=inner):
            return (inner,)
        case Negative(operand=inner) | Function(argument=inner) | Element(index=inner):
            return (inner,)
        case _:
            return ()


def walk(tree: Expression) -> Iterator[Expression]:
    """The tree and everything in it."""
    yield tree
    for child in children(tree):
        yield from walk(child)


def depth(tree: Expression) -> int:
    """How deep round brackets stand inside each other once every grouping is bracketed."""
    own = 0
    match tree:
        case Group():
            own = 1
        case Binary(operator=operator, left=left, right=right):
            return max(
                depth(left) + (isinstance(left, Binary) and left.operator != operator),
                depth(right) + isinstance(right, Binary),
            )
        case _:
            own = 0
    return own + max((depth(child) for child in children(tree)), default=0)


def names(tree: Expression) -> tuple[str, ...]:
    """Variables and arrays that the tree reads."""
    return tuple(dict.fromkeys(node.name for node in walk(tree) if isinstance(node, Variable | Element)))


def write(tree: Expression) -> str:
    """The tree as a person would type it; parsing it again gives the same tree."""
    match tree:
        case Number(value=value, hexadecimal=hexadecimal):
            return hexadecimal or plain(value)
        case String(text=text):
            return f'"{text}"'
        case Variable(name=name) | Keyword(name=name):
            return name
        case Element(name=name, index=index):
            return f"{name}[{write(index)}]"
        case Operand(name=name, suffix=suffix):
            return f"_{name}{suffix}"
        case Function(name=name, argument=argument):
            return f"@{name}[{write(argument)}]"
        case Negative(operand=inner):
            return f"-({write(inner)})" if isinstance(inner, Binary | Negative) else f"-{write(inner)}"
        case Group(inner=inner):
            return f"({write(inner)})"
        case Binary(operator=operator, left=left, right=right):
            first = f"({write(left)})" if isinstance(left, Binary) and left.operator != operator else write(left)
            second = f"({write(right)})" if isinstance(right, Binary) else write(right)
            return f"{first}{operator}{second}"
