"""What a person types as the value of a variable, as the controller takes it. Pure."""

from __future__ import annotations

from fractions import Fraction

from codegen.numbers import number_problem, parse_number, plain
from codegen.twoletter.fixed import ONE, STRING_BYTES

LOW, HIGH = Fraction(-(2**31)), Fraction(2**31) - Fraction(1, ONE)


def assignment(name: str, text: str) -> tuple[str, str]:
    """The command that gives `name` this value, and what is wrong; one of them is empty.

    A number, or a text in quotation marks. A number is sent exactly or refused, never cut off unseen.
    """
    text = text.strip()
    if text[:1] == '"':
        return _string(name, text)
    number = parse_number(text)
    if number is None:
        return "", f"{name}: {number_problem(text) or 'write a number, or a text in quotation marks'}."
    if not LOW <= number <= HIGH:
        return "", f"{name}: a variable holds -2147483648 to 2147483647.9999."
    return f"{name}={plain(number)}", ""


def _string(name: str, text: str) -> tuple[str, str]:
    inner = text[1:-1]
    if len(text) < 2 or text[-1] != '"' or '"' in inner or ";" in inner:
        return "", f'{name}: write a text as "ABC", without quotation marks or a semicolon in it.'
    if len(inner) > STRING_BYTES:
        return "", f"{name}: a variable holds {STRING_BYTES} characters, not {len(inner)}."
    odd = next((each for each in inner if not " " <= each <= "~"), "")
    return ("", f"{name}: the controller has no character {odd}.") if odd else (f"{name}={text}", "")
