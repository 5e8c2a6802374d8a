"""Random and mutated source into parser, formatter, checker and completer: nothing may be raised."""

from __future__ import annotations

import random

import pytest

from codegen.models import MODELS
from codegen.twoletter.check import check
from codegen.twoletter.checks.rules import SYNTAX_RULES
from codegen.twoletter.commands import ALL, FUNCTIONS, KEYWORDS
from codegen.twoletter.complete import complete, parameter_help
from codegen.twoletter.evaluate import EvaluationError, compile_expression
from codegen.twoletter.facts import expressions_of
from codegen.twoletter.fixed import HIGHEST, LOWEST, ONE
from codegen.twoletter.format import format_source, format_statement
from codegen.twoletter.nodes import Broken, Foreign
from codegen.twoletter.parse import parse, parse_line
from codegen.twoletter.problems import ERROR_TEXTS
from tests.long import count, record

SEED = 20_240_501
CHUNK = 2_500
CHUNKS = count(30_000, 500_000) // CHUNK  # of each half
PIECES = [
    *(row.example for row in ALL),
    *(row.name for row in ALL),
    *(f"@{name}[" for name in FUNCTIONS),
    *KEYWORDS,
    *"+-*/&|<>=?,;()[]{}\"#_@$^~'.% \t\x00\x12\x16\x1b\\é\U0001f600",
    *("V1", "POS[1]", "#A", "_TPX", "0", "-1", "2147483648", ".5", "$FF", "{F4.2}", "{S}", "{N}", "\r\n", "\n", "REM "),
]
CONTROLLERS = list(MODELS.values())


def mutated(source: random.Random) -> str:
    """A line glued from pieces, with some characters changed."""
    text = list("".join(source.choice(PIECES) for _ in range(source.randint(1, 8))))
    for _ in range(source.randint(0, 3)):
        if text:
            place = source.randrange(len(text))
            text[place] = source.choice(["", chr(source.randrange(256)), source.choice(PIECES), text[place] * 2])
    return "".join(text)


class Anything:
    """Names of every value."""

    def __init__(self, source: random.Random) -> None:
        self.source = source

    def _value(self) -> int:
        return self.source.choice([0, ONE, -ONE, HIGHEST, LOWEST, self.source.randrange(LOWEST, HIGHEST)])

    def variable(self, name: str) -> int:
        """Some number."""
        return self._value()

    def element(self, name: str, index: int) -> int:
        """Some number; the index must be one."""
        assert -(1 << 31) <= index < (1 << 31)
        return self._value()

    def operand(self, name: str, suffix: str) -> int:
        """Some number."""
        return self._value()

    def keyword(self, name: str) -> int:
        """Some number."""
        return self._value()

    def function(self, name: str, argument: int) -> int:
        """Some number."""
        assert LOWEST <= argument <= HIGHEST
        return self._value()


def evaluate_all(text: str, source: random.Random) -> None:
    """Every expression of the line has a number or an error code."""
    for statement in parse_line(text).statements:
        for expression in expressions_of(statement):
            try:
                value = compile_expression(expression)(Anything(source))
            except EvaluationError as error:
                assert error.code in (6, 52, 56)
            else:
                assert LOWEST <= value <= HIGHEST


@pytest.mark.timeout(600)
@pytest.mark.parametrize("chunk", range(CHUNKS))
def test_nothing_is_raised_whatever_the_text(chunk: int) -> None:
    source = random.Random(SEED + chunk)
    for number in range(CHUNK):
        text = mutated(source)
        tree = parse(text)
        again = format_source(tree)
        assert parse(again) == tree, text
        for line in tree.lines:
            evaluate_all(line.text, source)
            for statement in line.statements:
                format_statement(statement, compact=True)
                if isinstance(statement, Broken | Foreign):
                    assert statement.rule in SYNTAX_RULES and statement.code in ERROR_TEXTS
        if number % 4 == 0:
            check(text, source.choice(CONTROLLERS))
        if number % 16 == 0:
            column = source.randint(0, len(text))
            complete(text, column, source.choice(CONTROLLERS))
            parameter_help(text, column, source.choice(CONTROLLERS))


@pytest.mark.timeout(600)
@pytest.mark.parametrize("chunk", range(CHUNKS))
def test_random_bytes_are_parsed_and_checked(chunk: int) -> None:
    source = random.Random(-SEED - chunk)
    for number in range(CHUNK):
        text = source.randbytes(source.randint(0, 40)).decode("latin-1")
        assert parse(format_source(parse(text))) == parse(text)
        if number % 4 == 0:
            check(text, source.choice(CONTROLLERS))
    if chunk == CHUNKS - 1:
        record("fuzz: lines into the parser, half of them bytes", "tests/codegen/twoletter/test_fuzz.py", SEED,
               2 * CHUNKS * CHUNK, "lines")  # fmt: skip
