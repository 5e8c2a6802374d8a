"""What a program's question takes for an answer, and why a text is none: nothing is guessed, nothing cut off. Pure."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from codegen.numbers import number_problem, parse_number
from codegen.twoletter import nodes
from codegen.twoletter.fixed import STRING_BYTES, read_hexadecimal, read_number
from codegen.twoletter.parse import parse_line

MOST = "2147483647.9999"  # of a variable, either side of zero (dmc-1412-1414.txt l.3219)


@dataclass(frozen=True)
class Asked:
    """What an `IN` reads: a number, or a text of so many characters (dmc-1412-1414.txt l.3640)."""

    characters: int = 0  # 0: a number

    @property
    def words(self) -> str:
        """What to type, as a hint in the field."""
        what = f"Text, up to {self.characters} characters" if self.characters else "Number"
        return f"{what}; empty keeps the old value"


def asked_in(source: Sequence[str], lines: Iterable[int], prompt: str) -> Asked | None:
    """What the questions of these lines with this text take; None when that is not known or differs."""
    there = [question for line in lines if line < len(source) for question in _questions(source[line])]
    found = {asked for text, asked in there if _may_be(text.strip(), prompt.strip())}
    return found.pop() if len(found) == 1 else None


def answer_problem(text: str, asked: Asked | None) -> str:
    """Why `text` is no answer to the question, in a sentence; empty when it can be sent."""
    if not text:
        return ""  # keeps the old value (ssc-tol-o-motion.txt l.2390)
    if ";" in text:
        return "A semicolon ends the answer and the rest would be taken for a command: leave it out."
    odd = next((each for each in text if not " " <= each <= "~"), "")
    if asked is None:
        return _odd(odd) or (_number_problem(text) if _meant_as_number(text) else _too_long(text, STRING_BYTES))
    if not asked.characters:
        return _number_problem(text)
    return _odd(odd) or _too_long(text, asked.characters)


def answer_sent(text: str, asked: Asked | None) -> str:
    """The answer as it is sent: a number without blanks around it and without a plus."""
    bare = text.strip()
    number = (asked is not None and not asked.characters) or (asked is None and _meant_as_number(text))
    return bare.removeprefix("+") if number else text


def _questions(line: str) -> Iterator[tuple[str, Asked]]:
    for statement in parse_line(line).statements:
        if isinstance(statement, nodes.Command) and statement.name == "IN":
            texts = [item.text for item in statement.arguments if isinstance(item, nodes.String)]
            forms = [item.format for item in statement.arguments if isinstance(item, nodes.Formatted)]
            characters = [form.digits or STRING_BYTES for form in forms if form.kind == "S"]
            yield (texts[0] if texts else ""), Asked(characters[0] if characters else 0)


def _may_be(text: str, prompt: str) -> bool:
    """Whether a question may be the one that is shown; one text may end as the other does."""
    return text.endswith(prompt) or prompt.endswith(text)


def _number_problem(text: str) -> str:
    bare = text.strip()
    if not bare:
        return "Only blanks: type a number, or leave the field empty to keep the old value."
    if bare.startswith(("$", "-$")):
        good = read_hexadecimal(bare) is not None
        return "" if good else f"“{bare}” is no hexadecimal number: $ and up to eight of 0-9 and A-F, such as $1F."
    reason = number_problem(bare)
    if reason is not None and reason.startswith("write "):
        return f"“{bare}” is no number as the controller reads it: {reason}."
    if reason is not None:
        return f"The program asks for a number, and “{bare}” is none: write digits, with . for decimals, such as 12.5."
    if read_number(bare.removeprefix("+")) is None:
        return f"{bare} is outside of what a variable holds: -{MOST} to {MOST}."
    return ""


def _meant_as_number(text: str) -> bool:
    """Where it is not known what is asked: what begins as numbers do must be a number."""
    bare = text.strip()
    return parse_number(bare) is not None or bare[:1].isdigit() or bare[:1] in tuple("+-.,$")


def _too_long(text: str, most: int) -> str:
    return f"“{text}” has {len(text)} characters, the program takes {most}." if len(text) > most else ""


def _odd(character: str) -> str:
    return f"The controller knows no “{character}”: write plain letters and digits." if character else ""
