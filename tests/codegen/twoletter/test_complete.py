"""Completion and the help of parameters: from the table and the names of the program."""

from __future__ import annotations

import pytest

from codegen.models import model
from codegen.twoletter.complete import Names, complete, names_of, parameter_help
from codegen.twoletter.parse import parse

NAMES = Names(labels=("A", "LOOP"), variables=("N", "LENGTH"), arrays=("POS",))


def texts(line: str, name: str = "ssc2", column: int | None = None) -> list[str]:
    """What is offered at the end of the line."""
    place = len(line) if column is None else column
    return [each.text for each in complete(line, place, model(name), NAMES)]


@pytest.mark.parametrize(
    ("line", "offered", "not_offered"),
    [
        ("P", ["PR", "PA", "PF", "POS["], ["SP", "RS"]),
        ("", ["BG", "N"], ["RS", "LS"]),  # only from the port
        ("BG X;S", ["SP", "ST"], ["BG"]),
        ("JP ", ["#A", "#LOOP", "N"], []),
        ("JP #L", ["#LOOP"], ["#A"]),
        ("JP #A,", ["N", "@IN[", "_TPX", "TIME"], ["#A"]),
        ("V1=_TP", ["_TPX", "_TPY"], ["_TPZ", "_TEX"]),
        ("V1=_BG", ["_BGX", "_BGS"], []),
        ("V1=_X", ["_XQ0", "_XQ3"], []),
        ("V1=@S", ["@SIN[", "@SQR["], ["@COS["]),
        ("PR L", ["LENGTH"], ["LM", "LI"]),
        ("BG ", [], ["N", "_TPX"]),
    ],
)
def test_candidates(line: str, offered: list[str], not_offered: list[str]) -> None:
    found = texts(line)
    assert set(offered) <= set(found)
    assert not set(not_offered) & set(found)


@pytest.mark.parametrize("line", ['MG "P', "NO P", "REM P", "'P", 'IN "LEN'])
def test_nothing_is_offered_in_text(line: str) -> None:
    assert texts(line) == []


def test_the_model_decides() -> None:
    assert "LM" in texts("L", "ssc2") and "LM" not in texts("L", "dmc1412")
    assert "@COM[" in texts("V1=@C", "dmc1412") and "@COM[" not in texts("V1=@C", "ssc2")
    assert "BZ" in texts("B", "dmc1412") and "BZ" not in texts("B", "dmc1414")


def test_a_candidate_replaces_the_word_typed() -> None:
    (found,) = [each for each in complete("SP 5;JP #LO", 11, model("ssc1"), NAMES) if each.text == "#LOOP"]
    assert (found.start, found.end, found.kind) == (8, 11, "label")
    (command,) = complete("SP 5;X", 6, model("ssc1"))
    assert (command.text, command.title, command.kind) == ("XQ", "Execute", "command")
    assert command.help == "Start a program at a label or line, in a thread."


def test_names_of_a_source() -> None:
    names = names_of(parse("#A\nN=0;DM POS[5]\nPOS[N]=LEN\nEN").lines, model("ssc1"))
    assert names == Names(("A",), ("N", "LEN"), ("POS",))


@pytest.mark.parametrize(
    ("line", "command", "current", "count"),
    [
        ("PR 5,", "PR", 1, 2),
        ("PR", "PR", 0, 2),
        ("CC 9600,0,", "CC", 2, 4),
        ("JP #A,(N<5),", "JP", 2, 2),
        ('MG "a,b",', "MG", 1, 0),
        ("WT 5;SP POS[1,2],", "SP", 1, 2),
    ],
)
def test_help_of_parameters(line: str, command: str, current: int, count: int) -> None:
    told = parameter_help(line, len(line), model("ssc2"))
    assert told is not None
    assert (told.command, told.current, len(told.parameters)) == (command, current, count)


def test_help_names_range_and_default() -> None:
    told = parameter_help("SP ", 3, model("ssc1"))
    assert told is not None
    (parameter,) = told.parameters
    assert (parameter.range, parameter.default) == ("0 to 8000000 counts/s", "25000")


@pytest.mark.parametrize("line", ["", "V1=5", "#A", "NO PR", 'MG "PR', "P"])
def test_no_help_where_there_is_no_command(line: str) -> None:
    assert parameter_help(line, len(line), model("ssc1")) is None
