"""Tree to text in one canonical spacing, and numbers as the controller prints them.

`parse(format_source(tree)) == tree` for every tree the parser gives.
"""

from __future__ import annotations

from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import ONE, read_number
from codegen.twoletter.nodes import (
    Argument,
    Assign,
    Axes,
    Binary,
    Broken,
    Character,
    Command,
    Comment,
    Dimension,
    Element,
    Empty,
    Expression,
    Foreign,
    Format,
    Formatted,
    Function,
    Group,
    Keyword,
    Label,
    Line,
    Negative,
    NoLineEnd,
    Nothing,
    Number,
    Operand,
    Port,
    Print,
    Query,
    SegmentSpeed,
    Source,
    Statement,
    String,
    Target,
    Variable,
)
from codegen.twoletter.rows import Takes


def format_source(source: Source) -> str:
    """The whole text, every line ended by a line feed."""
    return "".join(format_line(line) + "\n" for line in source.lines)


def format_line(line: Line) -> str:
    """One line without line end."""
    return ";".join(map(format_statement, line.statements))


def format_statement(statement: Statement, compact: bool = False) -> str:
    """One statement; `compact` leaves out the blank behind the two letters where that is safe."""
    match statement:
        case Command():
            return _command(statement, compact)
        case Label(name):
            return "#" + name
        case Assign(target, value):
            return f"{format_expression(target)}={format_expression(value)}"
        case Print(target, form):
            return f"{format_expression(target)}={_braces(form) if form else ''}"
        case Comment(mark, text):
            return f"{mark}{' ' if text and mark != chr(39) else ''}{text}"
        case Nothing():
            return ""
        case Broken(text) | Foreign(text):
            return text


def _command(command: Command, compact: bool) -> str:
    arguments = _arguments(command)
    if command.axis is not None:
        return f"{command.name}{command.axis}={arguments}"
    if command.index is not None:
        return f"{command.name}[{format_expression(command.index)}]={arguments}"
    if not arguments:
        return command.name
    # a name directly behind the letters could make an assignment of it: MG V=1
    tight = compact and not (arguments[0].isalpha() and "=" in arguments)
    return f"{command.name}{'' if tight else ' '}{arguments}"


def _arguments(command: Command) -> str:
    row = COMMANDS.get(command.name)
    if row is not None and row.takes in (Takes.MESSAGE, Takes.INPUT):
        return _items(command.arguments)
    text = ""
    for number, argument in enumerate(command.arguments):
        joined = number and not isinstance(argument, Format | SegmentSpeed)
        text += ("," if joined else "") + format_argument(argument)
    return text


def _items(items: tuple[Argument, ...]) -> str:
    """Items of MG and IN: no comma behind a port, none before `{N}`."""
    text = ""
    before: Argument | None = None
    for item in items:
        if before is not None and not isinstance(before, Port) and not isinstance(item, NoLineEnd):
            text += ","
        text += format_argument(item)
        before = item
    return text


def format_argument(argument: Argument) -> str:
    """One place of an argument list."""
    match argument:
        case Empty():
            return ""
        case Query():
            return "?"
        case Axes(letters):
            return letters
        case Target(label, line):
            return f"#{label}" if line is None else format_expression(line)
        case Format() | Character() | Port() | NoLineEnd():
            return _braces(argument)
        case Formatted(expression, form):
            return format_expression(expression) + _braces(form)
        case Dimension(name, size, is_array):
            index = "" if size is None else format_expression(size)
            return f"{name}[{index}]" if is_array else name
        case SegmentSpeed(value):
            return f"<{format_expression(value)}"
        case _:
            return format_expression(argument)


def _braces(node: Format | Character | Port | NoLineEnd) -> str:
    match node:
        case Format("S", digits):
            return f"{{S{digits}}}"
        case Format(kind, digits, decimals):
            return f"{{{kind}{digits}.{decimals}}}"
        case Character(code):
            return f"{{^{code}}}"
        case Port(number):
            return f"{{P{number}}}"
        case NoLineEnd():
            return "{N}"


def format_expression(expression: Expression) -> str:
    """An expression without any blanks; literals as they were written."""
    match expression:
        case Number(scaled, text):
            return text if read_number(text) == scaled else format_scaled(scaled)
        case String(text):
            return f'"{text}"'
        case Variable(name) | Keyword(name):
            return name
        case Element(name, index):
            return f"{name}[{'' if index is None else format_expression(index)}]"
        case Operand(name, suffix):
            return f"_{name}{suffix}"
        case Function(name, argument):
            return f"@{name}[{format_expression(argument)}]"
        case Negative(inner):
            return f"-{format_expression(inner)}"
        case Binary(operator, left, right):
            return f"{format_expression(left)}{operator}{format_expression(right)}"
        case Group(inner):
            return f"({format_expression(inner)})"


def format_scaled(scaled: int) -> str:
    """The shortest literal that reads back as this number: `-3.25`, `0.3333`."""
    sign, magnitude = ("-" if scaled < 0 else ""), abs(scaled)
    for decimals in range(6):
        unit = 10**decimals
        rounded = (magnitude * unit * 2 + ONE) // (2 * ONE)
        whole, fraction = divmod(rounded, unit)
        text = f"{sign}{whole}.{fraction:0{decimals}d}" if decimals else f"{sign}{whole}"
        if read_number(text) == scaled:
            return text
    return text


# ------------------------------------------------------------ printed numbers


def format_number(
    scaled: int, digits: int, decimals: int, leading_zeros: bool = True, hexadecimal: bool = False
) -> str:
    """A number as the controller prints it: sign column, zeros, all nines when it does not fit.

    Decimals are rounded half away from zero (dmc-1412-1414.txt l.3676); hexadecimal is two's complement (l.3766).
    """
    if hexadecimal:
        return _hexadecimal(scaled, digits, decimals, leading_zeros)
    unit = 10**decimals
    rounded = (abs(scaled) * unit * 2 + ONE) // (2 * ONE)
    whole, fraction = divmod(rounded, unit)
    if whole >= 10**digits:
        whole, fraction = 10**digits - 1, unit - 1
    text = str(whole)
    if digits == 0:
        text = ""
    elif leading_zeros:
        text = text.zfill(digits)
    sign = "-" if scaled < 0 and (whole or fraction) else " "
    return f"{sign}{text}.{fraction:0{decimals}d}" if decimals else sign + text


def _hexadecimal(scaled: int, digits: int, decimals: int, leading_zeros: bool) -> str:
    """`$` and `digits` figures of the integer, `decimals` of the fraction; the largest value when it does not fit."""
    digits, decimals = max(digits, 1), min(decimals, 4)
    whole, fraction = scaled >> 16, scaled & 0xFFFF
    half = 1 << (4 * digits - 1)
    if whole >= half:
        whole, fraction = half - 1, 0xFFFF
    elif whole < -half:
        whole, fraction = -half, 0
    pattern = f"{whole & (2 * half - 1):0{digits}X}"
    if not leading_zeros:
        pattern = pattern.lstrip("0") or "0"
    return f"${pattern}.{fraction >> (16 - 4 * decimals):0{decimals}X}" if decimals else f"${pattern}"
