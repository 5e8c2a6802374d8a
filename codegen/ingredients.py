"""What expressions are made of, by meaning: names, functions, operators, live values of the controller."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from codegen.expressions import Bad, Element, parse_expression
from codegen.instructions import MathematicalEquation, RecordData, VariableArray
from codegen.instructions.configuration import Declare
from codegen.models import Model
from codegen.program import Program
from codegen.twoletter.commands import COMMANDS, FUNCTIONS, KEYWORDS
from codegen.twoletter.rows import Row

OPERATORS = {
    "Arithmetic": (("+", "add"), ("-", "subtract"), ("*", "multiply"), ("/", "divide"), ("()", "group")),
    "Comparison": (
        ("<", "less than"), (">", "greater than"), ("=", "equal"), ("<=", "at most"), (">=", "at least"),
        ("<>", "not equal"),
    ),
    "Logic": (("&", "and"), ("|", "or")),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Ingredient:
    """One thing to put into an expression; the cursor then goes back that far from its end."""

    group: str
    text: str
    meaning: str
    help: str = ""
    back: int = 0


def ingredients(variables: tuple[str, ...], arrays: tuple[str, ...], model: Model) -> tuple[Ingredient, ...]:
    """Everything that can stand in an expression on this controller, in the order in which it is offered."""
    found = [Ingredient("Variables", name, "variable") for name in variables if name not in arrays]
    found += [Ingredient("Arrays", f"{name}[]", "element of an array; the first is [0]", back=1) for name in arrays]
    found += [Ingredient("Functions", f"@{row.name}[]", _small(row.title), row.help, 1) for row in FUNCTIONS.values()]
    for group, signs in OPERATORS.items():
        found += [Ingredient(group, sign, words, back=sign == "()") for sign, words in signs]
    for text, suffix, row in operands(model):
        found.append(Ingredient(f"Controller: {row.group}", text, meaning(row, suffix), row.help))
    family = (row for row in KEYWORDS.values() if model.family in row.families)
    found += [Ingredient("Clock, ports and keys", row.name, _small(row.title), row.help) for row in family]
    return tuple(found)


def _small(words: str) -> str:
    return words[:1].lower() + words[1:]


def operands(model: Model) -> Iterator[tuple[str, str, Row]]:
    """`_TPX` and its like, for every axis and thread of the model: spelling, suffix, row."""
    for row in COMMANDS.values():
        if row.operand is None or not row.known_to(model):
            continue
        name = row.name if row.name.startswith("_") else f"_{row.name}"
        suffixes = tuple(model.axes) if row.operand.startswith("axis") else ("",)
        if row.operand == "thread":
            suffixes = tuple(str(number) for number in range(model.threads))
        if row.operand == "axis_s" and model.coordinated:
            suffixes = (*suffixes, "S")
        yield from ((name + suffix, suffix, row) for suffix in suffixes)


def meaning(row: Row, suffix: str) -> str:
    """`X: actual position, in counts`."""
    words = row.operand_help or _small(row.title)
    of = {"": "", "S": "path: "}.get(suffix, f"thread {suffix}: " if suffix.isdigit() else f"{suffix}: ")
    return of + words


def arrays_of(program: Program) -> tuple[str, ...]:
    """Names of the program that stand for arrays."""
    found: dict[str, None] = {}
    for step in program.steps():
        match step.instruction:
            case VariableArray(mode=Declare.ARRAY, array=name) if name:
                found[name.strip().partition("[")[0]] = None
            case MathematicalEquation(equations=equations):
                trees = [parse_expression(equation.variable) for equation in equations]
                found |= {tree.name: None for tree in trees if not isinstance(tree, Bad) and isinstance(tree, Element)}
            case RecordData(recordings=rows):
                found |= {row.array: None for row in rows if row.array}
    return tuple(found)
