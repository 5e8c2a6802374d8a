"""One statement as tokens: names, numbers, strings and signs with their columns; blanks are skipped."""

from __future__ import annotations

import re

from codegen.twoletter.nodes import Span

NAME = "name"
NUMBER = "number"
STRING = "string"
OPERAND = "operand"
FUNCTION = "function"
LABEL = "label"
COMPARISON = "comparison"
SIGN = "sign"
END = "end"

_TOKEN = re.compile(
    r"""[ \t]*(?:
      (?P<name>[A-Za-z][A-Za-z0-9]*)
    | (?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)|\$[0-9A-Fa-f]*\.?[0-9A-Fa-f]*)
    | (?P<end>;)
    | (?P<string>"[^"]*"?)
    | (?P<operand>_[A-Za-z0-9]*)
    | (?P<function>@[A-Za-z0-9]*)
    | (?P<label>\#[ \t]*[A-Za-z0-9]*)
    | (?P<comparison><[ \t]*[=>]|>[ \t]*=|[<>=])
    | (?P<sign>[^ \t])
    )""",
    re.VERBOSE | re.DOTALL,
).match
_BRACES = re.compile(r"\{([^{}\"]*)\}").match


class Refused(Exception):
    """A statement the controller would answer with `?`: the rule broken, the error code, and where."""

    def __init__(self, rule: str, code: int, start: int, end: int, foreign: bool = False) -> None:
        super().__init__(rule, code)
        self.rule = rule
        self.code = code
        self.place = Span(start, end)
        self.foreign = foreign


class Cursor:
    """Walks over the tokens of one statement; the present token is `kind`, `value`, `start`, `end`."""

    __slots__ = ("deepest", "depth", "end", "kind", "start", "text", "value")

    def __init__(self, text: str, position: int, deepest: int) -> None:
        self.text = text
        self.deepest = deepest  # brackets within brackets
        self.depth = 0
        self.end = position
        self.advance()

    def advance(self) -> None:
        """Go to the next token; behind the last one `kind` stays END."""
        match = _TOKEN(self.text, self.end)
        if match is None:
            self.kind = END
            self.value = ""
            self.start = self.end = len(self.text)
            return
        kind = match.lastgroup
        assert kind is not None
        self.kind = kind
        self.start, end = match.span(kind)
        self.value = self.text[self.start : end]
        self.end = self.start if kind == END else end

    def at(self, sign: str) -> bool:
        """Whether the present token is this sign."""
        return self.kind == SIGN and self.value == sign

    def take(self, sign: str) -> bool:
        """Go on when the present token is this sign."""
        if self.kind == SIGN and self.value == sign:
            self.advance()
            return True
        return False

    def braces(self) -> tuple[str, int, int]:
        """The text between `{` (the present token) and `}`, without blanks, and the columns of both; goes on behind."""
        match = _BRACES(self.text, self.start)
        if match is None:
            raise self.refuse("bad-format", 53)
        start, self.end = match.span()
        end = self.end
        self.advance()
        return match.group(1).replace(" ", "").replace("\t", ""), start, end

    def refuse(self, rule: str, code: int, foreign: bool = False) -> Refused:
        """The refusal of the present token."""
        return Refused(rule, code, self.start, max(self.end, self.start + 1), foreign)

    def finish(self) -> None:
        """Refuse whatever is left over before the end of the statement."""
        if self.kind == END:
            return
        if self.kind == STRING and (len(self.value) < 2 or not self.value.endswith('"')):
            raise self.refuse("missing-quote", 52)
        rule, code, foreign = _LEFT_OVER.get(self.value, ("bad-argument", 4, False))
        raise self.refuse(rule, code, foreign)


_LEFT_OVER = {
    ")": ("brackets", 59, False),
    "(": ("brackets", 59, False),
    "]": ("square-brackets", 55, False),
    "[": ("square-brackets", 55, False),
    "}": ("bad-format", 53, False),
    "{": ("bad-format", 53, False),
    "?": ("question-mark", 51, False),
    "~": ("later-form", 1, True),
}
