"""Every row of the command table, keyword and function: complete, parsed by its own example, and as the manuals say.

`python -m tests.rows.test_every_command` prints each command on each controller with what was tried: accepted, refused
with its code, asked, read as operand, does what the manual says; and where that stands. A hole fails the build.
"""

from __future__ import annotations

import pytest

from codegen.models import MODELS, Model, model
from codegen.twoletter.check import check
from codegen.twoletter.commands import ALL, COMMANDS, FUNCTIONS, KEYWORDS, LATER
from codegen.twoletter.complete import help_of
from codegen.twoletter.facts import expressions_of, walk
from codegen.twoletter.fixed import scaled
from codegen.twoletter.format import format_line
from codegen.twoletter.nodes import Broken, Command, Comment, Foreign, Function, Keyword, Operand, Query
from codegen.twoletter.parse import parse_line
from codegen.twoletter.problems import ERROR_TEXTS
from codegen.twoletter.rows import BY_AXIS, Row, Takes
from tests.examples.script import Bench
from tests.facts.sheet import COLUMNS, CONTROLLERS, Entry, Fact, Prober, sheet
from tests.long import is_long

ROWS = [pytest.param(row, id=row.name) for row in ALL]
TYPED = [pytest.param(row, id=row.name) for row in ALL if row.takes not in (Takes.OPERAND, Takes.BYTES)]

TOLD = [pytest.param(entry, name, id=f"{entry.name}-{name}") for entry in sheet().values() for name in entry.models]
ABSENT = [
    pytest.param(entry, name, id=f"{entry.name}-{name}")
    for entry in sheet().values()
    for name in CONTROLLERS
    if name not in entry.models
]
NO_EXAMPLE = (Takes.OPERAND, Takes.BYTES, Takes.TEXT)  # of a line with a command
EVERYDAY = ("ssc4", "dmc1412")  # the others run what these do not have; all in the long run


def models_of(row: Row) -> list[Model]:
    """The controllers that have the command."""
    return [each for each in MODELS.values() if row.known_to(each)]


def home(row: Row) -> Model:
    """The largest controller that has the command."""
    return max(models_of(row), key=lambda each: (len(each.axes), each.commutation))


@pytest.mark.parametrize("row", ROWS)
def test_a_row_is_complete(row: Row) -> None:
    assert row.title and row.group and row.example
    assert row.help.endswith(".") or row.takes is Takes.OPERAND
    assert len(row.help) <= 120 and row.help[0].isupper()
    assert models_of(row), "no controller has it"
    assert set(row.errors) <= set(ERROR_TEXTS)
    assert row.confidence == "high" or row.profile, "what is not certain says why"
    assert "recall" not in row.help and "inferred" not in row.help
    assert row.program or row.port
    assert not row.trippoint or (row.program and row.port)


@pytest.mark.parametrize("row", TYPED)
def test_the_example_is_that_command_and_has_no_problems(row: Row) -> None:
    (statement,) = parse_line(row.example).statements
    if row.takes is Takes.TEXT:
        assert isinstance(statement, Comment)
    else:
        assert isinstance(statement, Command) and statement.name == row.name
    assert format_line(parse_line(row.example)) == row.example
    found = {
        problem.rule
        for problem in check(f"#A\nA=0;N=0;LEN=0;V1=0;DM POS[1]\n{row.example}\nEN", home(row))
        if problem.line == 2
    }
    needed = {
        "undimensioned",
        "never-reached",
        "unassigned",
        "dimensioned-twice",
        "routine-missing",
        "segment-alone",
        "sequence-open",
        "calls-itself",
        "stray-return",
    }  # the rest of a real program
    assert found <= needed | (set() if row.program else {"only-from-port"})


@pytest.mark.parametrize("row", ROWS)
def test_limits_defaults_and_steps_agree(row: Row) -> None:
    kind = home(row)
    for place in (row, *row.fields_for(kind)):
        low, high = place.range_for(kind)
        assert low is None or high is None or low < high
        default = place.default
        if isinstance(default, int | float) and not (row.name == "CC" and default == 0):
            assert place.accepts(scaled(default), kind), f"default {default} is out of range"
        if place.step is not None and low is not None and place.step >= 1:
            assert place.stored(scaled(low)) == scaled(low)


@pytest.mark.parametrize("row", TYPED)
def test_a_question_mark_is_taken_where_there_is_a_reply(row: Row) -> None:
    if row.tells or row.takes in (Takes.AXES_OR_ONE, Takes.TABLE, Takes.TEXT, Takes.MESSAGE, Takes.INPUT):
        return
    (statement,) = parse_line(row.name + " ?").statements
    if row.reply is not None:
        assert isinstance(statement, Command) and statement.arguments == (Query(),)
    else:
        assert isinstance(statement, Broken | Foreign)
        assert statement.code in (51, 4, 57, 9, 58, 90, 11, 55)


@pytest.mark.parametrize("row", TYPED)
def test_without_arguments_it_is_refused_where_some_are_needed(row: Row) -> None:
    (statement,) = parse_line(row.name).statements
    if row.takes is Takes.TABLE:
        assert isinstance(statement, Broken) and statement.code == 55
    elif row.minimum and row.takes is not Takes.INPUT:
        assert isinstance(statement, Broken) and statement.code == 50
    elif row.takes is Takes.INPUT:
        assert isinstance(statement, Broken) and statement.code == 65
    else:
        assert isinstance(statement, Command | Comment)


@pytest.mark.parametrize("row", [each for each in ALL if each.operand])
def test_operands_are_parsed(row: Row) -> None:
    name = row.name.lstrip("_")
    suffixes = {"axis": "XYZW", "axis_s": "XYZWS", "thread": "0123", "plain": ""}[row.operand or ""]
    for suffix in ("", *suffixes):
        (statement,) = parse_line(f"V1=_{name}{suffix}").statements
        assert list(expressions_of(statement)) == [Operand(name, suffix)]
    (statement,) = parse_line(f"V1=_{name}Q").statements
    assert isinstance(statement, Broken) and statement.code == 58


@pytest.mark.parametrize("row", [each for each in ALL if not each.operand and len(each.name) == 2])
def test_commands_without_operand_have_none(row: Row) -> None:
    (statement,) = parse_line(f"V1=_{row.name}").statements
    assert isinstance(statement, Broken) and statement.code == 58


@pytest.mark.parametrize("row", [each for each in ALL if each.takes not in NO_EXAMPLE])
def test_what_a_controller_does_not_have_is_said(row: Row) -> None:
    for kind in (each for each in MODELS.values() if each.family != "smartmotor"):
        rules = {problem.rule for problem in check(f"#A\n{row.example}\nEN", kind)}
        assert ("not-on-model" in rules) == (not row.known_to(kind)), kind.name


@pytest.mark.parametrize("row", TYPED)
def test_help_at_the_cursor_comes_from_the_row(row: Row) -> None:
    for kind in models_of(row):
        told = help_of(row, kind)
        assert (told.command, told.title, told.example) == (row.name, row.title, row.example)
        if row.takes in BY_AXIS and not row.fields_for(kind):
            assert [each.name for each in told.parameters] == list(kind.axes)


@pytest.mark.parametrize("name", sorted(KEYWORDS))
def test_keywords_are_parsed(name: str) -> None:
    (statement,) = parse_line(KEYWORDS[name].example).statements
    assert not isinstance(statement, Broken)
    found = [*expressions_of(statement)]
    assert any(node == Keyword(name) for each in found for node in walk(each))


@pytest.mark.parametrize("name", sorted(FUNCTIONS))
def test_functions_are_parsed(name: str) -> None:
    (statement,) = parse_line(FUNCTIONS[name].example).statements
    found = [node for each in expressions_of(statement) for node in walk(each) if isinstance(node, Function)]
    assert [node.name for node in found] == [name]


def test_no_command_of_later_controllers_is_in_the_table() -> None:
    assert not set(LATER) & set(COMMANDS)


@pytest.mark.parametrize(
    ("name", "controller", "stepper", "limits"),
    [
        ("SP", "ssc4", False, (0, 8_000_000)),
        ("SP", "ssc4", True, (0, 2_000_000)),
        ("JG", "ssc1", True, (-2_000_000, 2_000_000)),
        ("OP", "dmc1412", False, (0, 7)),
        ("OP", "ssc1", False, (0, 255)),
        ("TM", "ssc1", False, (250, 20000)),
        ("TM", "ssc4", False, (500, 20000)),
        ("AI", "dmc1412", False, (-7, 7)),  # l.2765
        ("AI", "ssc4", False, (-8, 8)),
        ("SB", "dmc1412", False, (1, 3)),
        ("DM", "dmc1412", False, (0, 1000)),  # l.3325
        ("HX", "dmc1412", False, (0, 1)),  # l.2627
        ("HX", "ssc4", False, (0, 3)),
        ("BI", "dmc1412", False, (1, 5)),  # l.616: three consecutive inputs of seven
        ("ER", "ssc4", False, (1, 32767)),
    ],
)
def test_ranges_depend_on_the_controller(
    name: str, controller: str, stepper: bool, limits: tuple[float, float]
) -> None:
    assert COMMANDS[name].range_for(model(controller), stepper) == limits


@pytest.mark.parametrize(
    ("name", "given", "stored"),
    [
        ("AC", 150000, 149504),  # a printed example of the family
        ("AC", 1000000, 999424),
        ("SP", 3185, 3184),
        ("JG", -3185, -3184),
        ("PR", -0.5, -1),  # l.1065
        ("KP", 6.2, 6.125),
        ("IT", 0.004, 0.00390625),
        ("GR", 1.5, 1.5),
    ],
)
def test_registers_keep_their_resolution(name: str, given: float, stored: float) -> None:
    assert COMMANDS[name].stored(scaled(given)) == scaled(stored)


# ------------------------------------------------------------- what the manuals say, put to the simulator


def test_the_sheet_has_every_command_of_the_table_and_no_other() -> None:
    assert set(sheet()) == set(COMMANDS)


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_the_same_controllers_have_it_on_the_sheet_and_in_the_table(name: str) -> None:
    assert {each.name for each in models_of(COMMANDS[name])} == set(sheet()[name].models)


@pytest.mark.parametrize("entry", sheet().values(), ids=lambda each: each.name)
def test_a_command_has_no_hole(entry: Entry) -> None:
    for controller in entry.models:
        assert all(entry.columns(controller).values()), (controller, entry.columns(controller))
    checks = ("expect", "said", "refused", "badprogram", " -> ")
    wordless = [
        fact
        for fact in entry.facts
        if fact.verb == "does" and not any(word in step for _, step in fact.steps for word in checks)
    ]
    assert not wordless, [fact.text for fact in wordless]


def test_only_control_characters_have_no_such_column() -> None:
    assert {entry.name for entry in sheet().values() if any(fact.verb == "never" for fact in entry.facts)} == {
        row.name for row in ALL if row.takes is Takes.BYTES
    }


@pytest.mark.parametrize(("entry", "controller"), TOLD)
def test_what_the_manual_says(entry: Entry, controller: str) -> None:
    assert Prober(entry, controller, EVERYDAY if not is_long() else ()).probe() > 0


@pytest.mark.parametrize(
    ("verb", "text"),
    [
        ("takes", "KP 5000"),
        ("runs", "UL"),
        ("opens", "KP 5"),
        ("sends", "KP 5000\\r"),
        ("refuses", "6 KP 5"),
        ("refuses", "7 KP 5000"),
        ("stops", "6 KP 5"),
        ("answers", "KP? ->  0005.00"),
        ("unasked", "51 KP?"),
        ("reads", "7 _KP"),
        ("unread", "_KP"),
        ("axes", "5000 1 1 1"),
    ],
)
def test_a_wrong_fact_is_seen(verb: str, text: str) -> None:
    fact = Fact(verb, text, frozenset({"ssc2"}), ("spec:KP",), 1)
    with pytest.raises(AssertionError):
        Prober(Entry("KP", ("ssc2",), "", (fact,)), "ssc2").probe()


@pytest.mark.parametrize(("entry", "controller"), ABSENT)
def test_what_the_manual_does_not_have_is_unrecognized(entry: Entry, controller: str) -> None:
    bench = Bench.of(controller)
    assert bench.answer(COMMANDS[entry.name].example, 1).endswith("?")
    assert bench.answer("TC1", 1).startswith("1 Unrecognized command")


def print_table() -> None:
    """The generated table; what does not hold is said beside it."""
    print(f"{'command':8} {'on':8} " + " ".join(f"{column:>8}" for column in COLUMNS) + "  where")
    for entry in sheet().values():
        for name in entry.models:
            cells = " ".join(f"{count or 'HOLE':>8}" for count in entry.columns(name).values())
            try:
                Prober(entry, name).probe()
                wrong = ""
            except AssertionError as reason:
                wrong = f"  WRONG: {reason}".partition("\n")[0][:200]
            print(f"{entry.name:8} {name:8} {cells}  {' '.join(entry.sources(name))}{wrong}")


if __name__ == "__main__":
    print_table()
