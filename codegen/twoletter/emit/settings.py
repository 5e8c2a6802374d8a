"""Variables, equations, code written by hand, comments, and what belongs to the frame of the program."""

from __future__ import annotations

from collections.abc import Iterator

from codegen.instructions.configuration import AutoExecution, Declare, ValueKind, VariableArray
from codegen.instructions.math import MathematicalEquation
from codegen.instructions.raw import Comment, TwoLetterCode
from codegen.instructions.servo import LoopRate
from codegen.numbers import parse_number
from codegen.twoletter.calls import Assign, Raw, Statement, listed, numbers
from codegen.twoletter.emit.build import Build, raw


def two_letter_code(code: TwoLetterCode, build: Build) -> Iterator[Statement]:
    """The lines as they are."""
    yield from (Raw(line.strip()) for line in code.text.splitlines() if line.strip())


def comment(comment: Comment, build: Build) -> Iterator[Statement]:
    """Nothing, or lines the controller skips, as long as a line may be."""
    if not comment.in_code:
        return
    room = min(build.setup.limits.columns - len("NO "), 38 if build.setup.limits.family == "dmc141x" else 77)
    for line in comment.text.splitlines():
        words = "".join(character if " " <= character <= "~" else "?" for character in line).replace(";", ",").strip()
        while words:
            cut = words.rfind(" ", 1, room + 1) if len(words) > room else len(words)
            cut = room if cut <= 0 else cut
            yield listed("NO", words[:cut].rstrip())
            words = words[cut:].lstrip()


def auto_execution(auto: AutoExecution, build: Build) -> Iterator[Statement]:
    """Nothing here: the frame of the program starts with its label."""
    yield from ()


def variable_array(declaration: VariableArray, build: Build) -> Iterator[Statement]:
    """A first value, an array, a format, or an array freed."""
    match declaration.mode:
        case Declare.VARIABLE:
            text = f'"{declaration.text}"' if declaration.holds is ValueKind.TEXT else raw(declaration.number)
            yield Assign(declaration.variable.strip(), text)
        case Declare.ARRAY:
            yield listed("DM", f"{declaration.array.strip()}[{raw(declaration.size)}]")
        case Declare.FORMAT:
            digits = int(parse_number(declaration.digits) or 0) * (-1 if declaration.hexadecimal else 1)
            yield numbers("VF", f"{digits}.{raw(declaration.decimals)}")
        case Declare.FREE:
            yield listed("DA", f"{declaration.freed.strip()}[]")


def mathematical_equation(equations: MathematicalEquation, build: Build) -> Iterator[Statement]:
    """One assignment after the other."""
    for equation in equations.equations:
        yield Assign(raw(equation.variable), raw(equation.expression))


def loop_rate(rate: LoopRate, build: Build) -> Iterator[Statement]:
    """Microseconds, or -1 for the external clock (ssc-tol-o-motion.txt l.1231)."""
    yield numbers("TM", -1 if rate.external else int(parse_number(rate.period) or 1000))
