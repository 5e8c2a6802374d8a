"""The facts of the manuals, typed by hand, against the command table and the simulator."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from codegen.models import model
from codegen.twoletter import nodes
from codegen.twoletter.commands import COMMANDS, KEYWORDS
from codegen.twoletter.evaluate import EvaluationError, evaluate
from codegen.twoletter.fixed import ONE, as_integer, scaled
from codegen.twoletter.parse import parse_line
from codegen.twoletter.problems import ERROR_TEXTS
from codegen.twoletter.rows import Row
from tests.examples import manual
from tests.examples.script import Bench, commands_in
from tests.facts.sheet import sheet

Fact = dict[str, Any]


def facts(name: str) -> list[Any]:
    """The facts of one file as test parameters, named by what they say and where they stand."""
    rows = tomllib.loads(Path(__file__).with_name(f"{name}.toml").read_text(encoding="utf-8"))["fact"]
    return [
        pytest.param(row, id=f"{row.get('command', row.get('model', ''))}-{row.get('fact', index)}-l.{row['line']}")
        for index, row in enumerate(rows)
    ]


def where(fact: Fact) -> str:
    """The place in the manual, for messages."""
    return f"{fact['manual']} l.{fact['line']}"


def test_there_are_facts_of_every_kind() -> None:
    counts = {name: len(facts(name)) for name in ("commands", "numbers", "models", "expressions", "wire", "codes")}
    assert counts["commands"] > 240 and counts["numbers"] > 130 and counts["models"] > 90
    assert counts["expressions"] > 35 and counts["wire"] > 25 and counts["codes"] >= 3


@pytest.mark.parametrize("fact", facts("commands"))
def test_every_command_of_the_manuals_is_in_the_table(fact: Fact) -> None:
    name = fact["command"]
    if name in KEYWORDS or name.lstrip("_") in KEYWORDS:
        return
    assert name in COMMANDS, where(fact)
    for each in fact["models"]:
        assert COMMANDS[name].known_to(model(each)), f"{name} on {each}: {where(fact)}"


CHAPTERS = ("6", "11")  # of the command facts, beside their rows
SSC_LIST = range(473, 615)  # the list of chapter 12 in the table of contents of the SSC's manual
NO_COMMAND = {494, 538, 539, 540, 541, 542, 586}  # empty lines and headings between its pages
# What only the command facts give to the other family: no word of its manual says whether it has it.
UNTOLD = {("AF", "dmc"), ("CW", "ssc"), ("^R^V", "ssc")}


def named(manual: str) -> dict[str, int]:
    """Commands that a manual names, with their lines."""
    rows = tomllib.loads(Path(__file__).with_name("commands.toml").read_text(encoding="utf-8"))["fact"]
    return {row["command"]: row["line"] for row in rows if row["manual"].startswith(manual)}


def test_every_line_of_chapter_12s_list_is_a_fact() -> None:
    assert set(named("ssc").values()) == set(SSC_LIST) - NO_COMMAND


@pytest.mark.parametrize("family", ["ssc", "dmc"])
def test_the_fact_sheet_has_the_commands_of_each_manual(family: str) -> None:
    on_sheet = {name for name, entry in sheet().items() if any(each.startswith(family) for each in entry.models)}
    assert on_sheet - {name for name, untold in UNTOLD if untold == family} == set(named(family))


def cited() -> set[tuple[str, int]]:
    """Every line of a manual that a fact names."""
    here = Path(__file__).parent
    found = {
        (row["manual"][:3], row["line"])
        for path in here.glob("*.toml")
        for row in tomllib.loads(path.read_text(encoding="utf-8"))["fact"]
    }
    sources = {source for entry in sheet().values() for fact in entry.facts for source in fact.sources}
    statements = "".join(path.read_text(encoding="utf-8") for path in here.glob("*.txt"))
    sources |= {":".join(each) for each in re.findall(r"^== \w+ (dmc|ssc)-[^:]*:(\d+) ", statements, re.MULTILINE)}
    return found | {(source[:3], int(source[4:])) for source in sources if not source.startswith("spec")}


@pytest.mark.skipif(manual.folder() is None, reason="the manuals are not here (TWOLETTER_MANUALS)")
def test_every_line_that_is_cited_has_words() -> None:
    where = manual.folder()
    assert where is not None
    texts = {name: (where / file).read_text(encoding="utf-8").split("\n") for name, file in manual.FILES.items()}
    places = cited()
    assert len(places) > 400
    assert not [place for place in places if not texts[place[0]][place[1] - 1].strip()]


@pytest.mark.parametrize(
    "source", sorted({source for entry in sheet().values() for fact in entry.facts for source in fact.sources})
)
def test_every_row_of_the_command_facts_that_is_cited_is_one(source: str) -> None:
    manual_name, _, row = source.partition(":")
    assert manual_name in ("dmc", "ssc") or row in COMMANDS or row in CHAPTERS


def ends(name: str, model_name: str, stepper: bool = False) -> tuple[set[float], set[float]]:
    """Lowest and highest values of a command and of its places."""
    row = COMMANDS[name]
    kind = model(model_name)
    pairs = [row.range_for(kind, stepper), *(place.range_for(kind, stepper) for place in row.fields_for(kind))]
    return {low for low, _ in pairs if low is not None}, {high for _, high in pairs if high is not None}


def defaults(name: str, model_name: str) -> set[object]:
    """Defaults of a command and of its places."""
    row = COMMANDS[name]
    return {row.default, *(place.default for place in row.fields_for(model(model_name)))}


def steps(name: str, model_name: str) -> set[float]:
    """Resolutions of a command and of its places."""
    row = COMMANDS[name]
    return {step for step in (row.step, *(place.step for place in row.fields_for(model(model_name)))) if step}


def near_one_of(values: set[object], value: float, tolerance: float) -> bool:
    """Whether one of the values is that number, nearly."""
    return any(isinstance(each, int | float) and abs(each - value) <= tolerance for each in values)


def moves_on(row: Row) -> bool:
    """Whether a command is valid while its axis moves, in some mode."""
    return row.moving or row.moving_mode == "jog"


def refused_moving(row: Row) -> bool:
    """Whether a command is refused while its axis makes a position move."""
    return not row.moving or row.moving_mode in ("jog", "idle")


# What each kind of fact asks of (lowest values, highest values, row, model name) and the manual's value.
ASKS: dict[str, Callable[[set[float], set[float], Row, str, Any], bool]] = {
    "low": lambda lows, highs, row, name, value: value in lows,
    "model_low": lambda lows, highs, row, name, value: value in lows,
    "high": lambda lows, highs, row, name, value: value in highs,
    "model_high": lambda lows, highs, row, name, value: value in highs,
    "stepper_high": lambda lows, highs, row, name, value: value in highs,
    "whole_high": lambda lows, highs, row, name, value: value in {int(high) for high in highs},
    "at_least": lambda lows, highs, row, name, value: any(high >= value for high in highs),
    "at_most_low": lambda lows, highs, row, name, value: any(low <= value for low in lows),
    "default": lambda lows, highs, row, name, value: value in defaults(row.name, name),
    "rounded_default": lambda lows, highs, row, name, value: near_one_of(defaults(row.name, name), value, 0.01),
    "step": lambda lows, highs, row, name, value: near_one_of(set(steps(row.name, name)), value, value * 0.02),
    "finer_than": lambda lows, highs, row, name, value: all(step <= value * 1.02 for step in steps(row.name, name)),
    "moving": lambda lows, highs, row, name, value: moves_on(row) if value else refused_moving(row),
    "program": lambda lows, highs, row, name, value: row.program == value,
    "port": lambda lows, highs, row, name, value: row.port == value,
    "trippoint": lambda lows, highs, row, name, value: row.trippoint == value,
    "queries": lambda lows, highs, row, name, value: (row.reply is not None) == value,
    "operand": lambda lows, highs, row, name, value: (row.operand is not None) == value,
}


def holds(fact: Fact, model_name: str) -> bool:
    """Whether the table says what the manual says."""
    lows, highs = ends(fact["command"], model_name, fact["fact"] == "stepper_high")
    return ASKS[fact["fact"]](lows, highs, COMMANDS[fact["command"]], model_name, fact["value"])


@pytest.mark.parametrize("fact", facts("numbers"))
def test_ranges_defaults_and_validity(fact: Fact) -> None:
    for each in fact["models"]:
        if not COMMANDS[fact["command"]].known_to(model(each)):
            continue
        row = COMMANDS[fact["command"]]
        message = f"{fact['command']} {fact['fact']} on {each} should be {fact['value']} ({where(fact)}): {row}"
        assert holds(fact, each), message


@pytest.mark.parametrize("fact", facts("models"))
def test_what_each_controller_has(fact: Fact) -> None:
    value = getattr(model(fact["model"]), fact["fact"])
    if isinstance(value, tuple):
        value = list(value)
    assert value == fact["value"], where(fact)


class Given:
    """Names with given values, for expressions."""

    def __init__(self, values: dict[str, int]) -> None:
        self.values = values

    def variable(self, name: str) -> int:
        """A variable's value."""
        return self.values[name]

    def element(self, name: str, index: int) -> int:
        """No arrays here."""
        raise EvaluationError(57)

    def operand(self, name: str, suffix: str) -> int:
        """No operands here."""
        raise EvaluationError(58)

    def keyword(self, name: str) -> int:
        """No keywords here."""
        raise EvaluationError(57)

    def function(self, name: str, argument: int) -> int:
        """No inputs here."""
        raise EvaluationError(57)


@pytest.mark.parametrize("fact", facts("expressions"))
def test_expressions(fact: Fact) -> None:
    statement = parse_line(f"RESULT={fact['expression']}").statements[0]
    assert isinstance(statement, nodes.Assign), where(fact)
    values = {name: scaled(text) for name, _, text in (given.partition("=") for given in fact.get("names", []))}
    came = evaluate(statement.value, Given(values))
    wanted = scaled(fact["value"])
    assert abs(came - wanted) <= round(fact.get("tolerance", 0) * ONE), (
        f"{fact['expression']} is {came / ONE} (floor {as_integer(came)}), not {fact['value']} ({where(fact)})"
    )


@pytest.mark.parametrize("fact", facts("codes"))
def test_error_texts(fact: Fact) -> None:
    assert ERROR_TEXTS[fact["code"]] == fact["text"], where(fact)


@pytest.mark.parametrize("fact", facts("wire"))
def test_what_comes_back(fact: Fact) -> None:
    bench = Bench.of(fact["model"])
    if "stimulus" in fact:
        signal, _, value = fact["stimulus"].partition(",")
        bench.simulation.stimulus(signal, float(value))
        bench.run(0.01)
    if fact.get("before"):
        bench.answer(fact["before"], commands_in(fact["before"]))
    came = bench.answer(fact["send"].rstrip("\r"), 1)
    if "reply_value" in fact:
        assert int(came.strip(": \r\n")) == fact["reply_value"], where(fact)
        return
    wanted = fact["reply"].replace("<07>", "\x07").replace("<FF>", "\xff")
    assert came == wanted, where(fact)
