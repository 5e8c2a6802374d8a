"""Random two-letter source for property tests: valid statements with odd spacing, and mutations of them."""

from __future__ import annotations

from hypothesis import strategies as st

from codegen.twoletter.commands import ALL, COMMANDS, FUNCTIONS, KEYWORDS, RECORDABLE
from codegen.twoletter.rows import Row, Takes

BLANKS = st.sampled_from(["", "", "", " ", "  ", "\t"])
DIGITS = st.integers(0, 2_000_000_000)


def _is_free(name: str) -> bool:
    """Whether a statement can begin with that name and `=` without being something else."""
    return (
        name not in COMMANDS
        and name not in KEYWORDS
        and name[:3] != "REM"
        and not (name[:2] in COMMANDS and len(name) == 3)
    )


NAMES = st.from_regex(r"[A-Z][A-Za-z0-9]{0,7}", fullmatch=True).filter(_is_free)
LABELS = st.from_regex(r"[A-Za-z][A-Za-z0-9]{0,6}", fullmatch=True)
TEXTS = st.text(st.characters(min_codepoint=32, max_codepoint=126, exclude_characters='"'), max_size=20)
SHORT_TEXTS = st.text(st.characters(min_codepoint=32, max_codepoint=126, exclude_characters='"'), max_size=6)
AXES = st.sets(st.sampled_from("XYZW"), min_size=1).map(lambda letters: "".join(sorted(letters)))


def _literals() -> st.SearchStrategy[str]:
    return st.one_of(
        DIGITS.map(str),
        st.tuples(st.integers(0, 99999), st.integers(0, 99999)).map(lambda parts: f"{parts[0]}.{parts[1]}"),
        st.integers(0, 9999).map(lambda value: f".{value}"),
        st.integers(0, 0xFFFFFFFF).map(lambda value: f"${value:X}"),
    )


def _operands() -> st.SearchStrategy[str]:
    rows = [row for row in ALL if row.operand]
    names = [
        "_" + row.name.lstrip("_") + ("X" if row.operand.startswith("axis") else "") for row in rows if row.operand
    ]
    return st.sampled_from(names)


def _atoms() -> st.SearchStrategy[str]:
    return st.one_of(
        _literals(),
        NAMES,
        _operands(),
        st.sampled_from(sorted(KEYWORDS)),
        SHORT_TEXTS.map(lambda text: f'"{text}"'),
    )


def _spaced(*parts: st.SearchStrategy[str] | str) -> st.SearchStrategy[str]:
    """The parts joined with random blanks."""
    strategies = [part if isinstance(part, st.SearchStrategy) else st.just(part) for part in parts]
    woven: list[st.SearchStrategy[str]] = []
    for strategy in strategies:
        woven += [strategy, BLANKS]
    return st.tuples(*woven).map("".join)


def _compound(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    operators = st.sampled_from(["+", "-", "*", "/", "&", "|", "<", ">", "=", "<=", ">=", "<>", "< >", "< ="])
    functions = st.sampled_from(sorted("@" + name for name in FUNCTIONS))
    return st.one_of(
        _spaced(inner, operators, inner),
        _spaced("(", inner, ")"),
        _spaced("-", inner),
        _spaced(functions, "[", inner, "]"),
        _spaced(NAMES, "[", inner, "]"),
    )


EXPRESSIONS = st.recursive(_atoms(), _compound, max_leaves=6)
SIMPLE = st.recursive(
    _atoms().filter(lambda text: "<" not in text),
    lambda inner: _spaced(inner, st.sampled_from("+-*/&|"), inner),
    max_leaves=3,
)
FORMATS = st.one_of(
    st.tuples(st.sampled_from("F$"), st.integers(0, 10), st.integers(0, 4)).map(lambda f: f"{{{f[0]}{f[1]}.{f[2]}}}"),
    st.sampled_from(["{S}", "{S3}", "{F5}"]),
)


def _lists(places: int, least: int = 1, value: st.SearchStrategy[str] = EXPRESSIONS) -> st.SearchStrategy[str]:
    """Comma lists with empty places; not empty as a whole where a value is needed."""
    lists = st.lists(st.one_of(value, value, st.just("")), min_size=max(least, 1), max_size=max(places, 1)).map(
        ",".join
    )
    return lists.filter(bool) if least else lists


def _target() -> st.SearchStrategy[str]:
    return st.one_of(_spaced("#", LABELS), DIGITS.map(str))


def _items() -> st.SearchStrategy[str]:
    item = st.one_of(
        TEXTS.map(lambda text: f'"{text}"'),
        EXPRESSIONS,
        _spaced(EXPRESSIONS, FORMATS),
        st.integers(1, 255).map(lambda code: f"{{^{code}}}"),
        st.sampled_from(["{N}", "{P1}", "{P2}"]),
    )
    return st.lists(item, max_size=3).map(",".join)


ARGUMENTS: dict[Takes, st.SearchStrategy[str]] = {
    Takes.NONE: st.just(""),
    Takes.AXES: AXES,
    Takes.AXES_S: st.one_of(AXES, st.just("S"), st.just("")),
    Takes.AXES_OR_ONE: st.one_of(AXES, st.just("1")),
    Takes.AXIS: st.sampled_from(["X", "A", "N"]),
    Takes.PLANE: st.sampled_from(["XY", "XYZ", "XYN", "ZW"]),
    Takes.MASTER: st.sampled_from(["X", "DX", "CY", "S", "DD"]),
    Takes.AXIS_NUMBERS: _lists(4),
    Takes.ONE_AXIS_NUMBER: st.tuples(st.sampled_from(["", ",", ",,", ",,,"]), EXPRESSIONS).map("".join),
    Takes.SEGMENT_AXES: _spaced(_lists(4, value=SIMPLE), st.sampled_from(["", "<500"])),
    Takes.SEGMENT: st.lists(SIMPLE, min_size=3, max_size=3).map(",".join),
    Takes.TARGET: st.one_of(_target(), _spaced(_target(), ",", EXPRESSIONS)),
    Takes.DIMENSIONS: st.lists(_spaced(NAMES, "[", DIGITS.map(str), "]"), min_size=1, max_size=3).map(",".join),
    Takes.DEALLOCATE: st.lists(
        st.one_of(NAMES, st.just("*"), st.just("*[0]"), NAMES.map(lambda n: n + "[]")), min_size=1, max_size=3
    ).map(",".join),
    Takes.ARRAYS: st.lists(NAMES.map(lambda name: name + "[]"), min_size=1, max_size=4).map(",".join),
    Takes.SOURCES: st.lists(st.sampled_from(sorted("_" + name for name in RECORDABLE)), min_size=1, max_size=4).map(
        ",".join
    ),
    Takes.ARRAY_RANGE: _spaced(NAMES.map(lambda name: name + "[]"), ",", DIGITS.map(str)),
    Takes.MESSAGE: _items(),
    Takes.INPUT: _spaced(
        st.sampled_from(["", "{P2}"]),
        TEXTS.map(lambda text: f'"{text}"'),
        ",",
        NAMES,
        st.sampled_from(["", "{S}", "{S2}"]),
    ),
    Takes.TEXT: TEXTS.map(lambda text: text.replace(";", "")),
}


def commands_of(row: Row) -> st.SearchStrategy[str]:
    """Random valid uses of one command."""
    if row.takes is Takes.TABLE:
        return _spaced(row.name, "[", EXPRESSIONS, "]", "=", _lists(4))
    if row.takes is Takes.NUMBERS:
        least = max(row.minimum, 0 if not row.minimum else 1)
        arguments = _lists(row.most or len(row.fields), least)
    elif row.name == "VP":
        arguments = st.lists(SIMPLE, min_size=2, max_size=2).map(",".join)
    elif row.takes is Takes.TARGET and not row.fields:
        arguments = _target()
    else:
        arguments = ARGUMENTS[row.takes]
    # a blank keeps `MG V=1` from becoming the assignment `MGV=1`
    return arguments.map(lambda text: f"{row.name} {text}")


TYPED = tuple(row for row in ALL if row.takes not in (Takes.OPERAND, Takes.BYTES))
STATEMENTS = st.one_of(
    *(commands_of(row) for row in TYPED),
    LABELS.map(lambda name: "#" + name),
    _spaced(NAMES, "=", EXPRESSIONS),
    _spaced(NAMES, "[", EXPRESSIONS, "]", "=", EXPRESSIONS),
    _spaced(NAMES, "=", st.one_of(st.just(""), FORMATS)),
)
LINES = st.one_of(
    st.lists(STATEMENTS, min_size=1, max_size=3).map(";".join),
    TEXTS.map(lambda text: "REM " + text),
    TEXTS.map(lambda text: "'" + text),
    st.just(""),
)
SOURCES = st.lists(LINES, max_size=8).map("\n".join)
