"""The questions of the conformance script about expressions: numbers, brackets, operands, what an assignment means."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from device.conform_talk import Odd, Seen, Talk, highest

if TYPE_CHECKING:
    from device.conform import Session

LOST: Final = "-1/3*30000"  # of a third cut to 1/65536: -9999.85, or -10000.31 where it was cut downwards
BY_ZERO: Final = {6: "error 6", 9: "error 9"}
LARGEST: Final = 2147483647
DEEPEST: Final = 20
PLACE: Final = "TWA"  # TW of X acts on nothing that stands; 1234 is no value that anybody uses


def numbers(session: Session) -> Seen:
    """Functions and sums where the manuals leave two ways open."""
    talk = session.talk
    yield "int_of_negative", _which(talk, "@INT[-2.5]", {-2: "towards zero", -3: "down"})
    yield "round_half", _which(talk, "@RND[-2.5]", {-2: "up", -3: "away from 0"})
    reply = talk.line("MG @SQR[-4]{F4.2}")
    if reply.accepted and "2.00" not in reply.text:
        raise reply.odd()
    yield "root_of_negative", "of the magnitude" if reply.accepted else "error 6"
    sum_ = talk.number("2147483647+2147483647", "F10.0")
    yield "overflow", "wraps" if sum_ == -2 else "stops at the limit"
    if sum_ != -2 and abs(sum_ - 2147483647) > 1:
        raise Odd(f"2147483647+2147483647 is {sum_}")
    talk.code()


def _which(talk: Talk, expression: str, known: dict[int, str]) -> str:
    value = talk.number(expression)
    if value not in known:
        raise Odd(f"{expression} is {value}")
    return known[int(value)]


def division(session: Session) -> Seen:
    """What a division by zero is, and how quotients are cut."""
    talk = session.talk
    reply = talk.line("MG 1/0{F10.0}")
    if reply.refused:
        code = talk.code()
        if code not in BY_ZERO:
            raise Odd(f"'MG 1/0' is error {code}")
        yield "division_by_zero", BY_ZERO[code]
    elif talk.number("1/0", "F10.0") in (LARGEST, LARGEST + 1):
        yield "division_by_zero", "largest number"
    else:
        raise reply.odd()
    lost = talk.number(LOST)
    yield "cut", "towards zero" if lost > -10000 else "down"


def brackets(session: Session) -> Seen:
    """How many brackets may stand in brackets."""
    yield "bracket_levels", highest(lambda n: session.talk.line(f"MG {'(' * n}1{')' * n}").accepted, 1, DEEPEST)
    session.talk.code()


def assignments(session: Session) -> Seen:
    """Whether TWA=1234 is the variable TWA or TW of the axis."""
    talk = session.talk
    if talk.line(f"MG {PLACE}").accepted:
        raise Odd(f"the variable {PLACE} is there")
    talk.code()
    with session.kept("TW"):
        talk.do(f"{PLACE}=1234")
        is_command = talk.number("_TWX") == 1234
        if not is_command:
            talk.do(f"DA {PLACE}")
    yield "axis_assignment", "command" if is_command else "variable"


def operands(session: Session) -> Seen:
    """Whether threads tell the depth of their stack."""
    yield "stack_operand", session.talk.line("MG _ZS0").accepted
    session.talk.code()
