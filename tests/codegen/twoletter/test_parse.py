"""Parser: trees, columns, error codes; spellings of the manual by line."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen.models import model
from codegen.twoletter.check import check
from codegen.twoletter.fixed import ONE
from codegen.twoletter.nodes import (
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
    Foreign,
    Format,
    Formatted,
    Keyword,
    Label,
    Negative,
    NoLineEnd,
    Nothing,
    Number,
    Operand,
    Port,
    Print,
    Query,
    SegmentSpeed,
    Span,
    Statement,
    String,
    Target,
    Variable,
)
from codegen.twoletter.parse import parse, parse_line
from tests.codegen.twoletter.strategies import LINES


def one(text: str) -> Statement:
    """The only statement of a line."""
    (statement,) = parse_line(text).statements
    return statement


def number(value: float) -> Number:
    """A literal."""
    return Number(round(value * ONE), str(value))


@pytest.mark.parametrize(
    ("text", "tree"),
    [
        ("PR 4000", Command("PR", (number(4000),))),  # l.1376
        ("PR4000", Command("PR", (number(4000),))),
        ("PR ,2000", Command("PR", (Empty(), number(2000)))),
        ("PR ?", Command("PR", (Query(),))),
        ("CI ,2", Command("CI", (Empty(), number(2)))),
        ("CN,-1", Command("CN", (Empty(), number(-1)))),
        ("BG", Command("BG")),
        ("BGX", Command("BG", (Axes("X"),))),
        ("SHA", Command("SH", (Axes("X"),))),
        ("AMS", Command("AM", (Axes("S"),))),
        ("SC1", Command("SC", (number(1),))),
        ("JP# DONE,N>300", Command("JP", (Target("DONE"), Binary(">", Variable("N"), number(300))))),  # l.3464
        ("JP 5", Command("JP", (Target(None, number(5)),))),
        ("XQ #TASK1,1", Command("XQ", (Target("TASK1"), number(1)))),
        ("XQ", Command("XQ")),
        ("DL #", Command("DL", (Target(""),))),
        ("LS #A,9", Command("LS", (Target("A"), number(9)))),  # l.2477
        ("DM POSX[7]", Command("DM", (Dimension("POSX", number(7), True),))),  # l.3334
        ("DA *[0]", Command("DA", (Dimension("*", number(0), True),))),
        ("DA *,V1", Command("DA", (Dimension("*", None, False), Dimension("V1", None, False)))),
        ("RA XPOS[],XERR[]", Command("RA", (Dimension("XPOS", None, True), Dimension("XERR", None, True)))),
        ("RD _TP, _TE", Command("RD", (Operand("TP", ""), Operand("TE", "")))),  # l.3455
        ("RD_SHX,_NO", Command("RD", (Operand("SH", "X"), Operand("NO", "")))),
        ("QU A[],0,9,1", Command("QU", (Dimension("A", None, True), number(0), number(9), number(1)))),
        ("ET[0]=0", Command("ET", (number(0),), index=number(0))),
        ("ET[N]=X,5", Command("ET", (Variable("X"), number(5)), index=Variable("N"))),
        ("BZX=-1", Command("BZ", (number(-1),), axis="X")),  # l.786
        ("PRX=_TPX", Command("PR", (Operand("TP", "X"),), axis="X")),
        ("LI 1,2<500", Command("LI", (number(1), number(2), SegmentSpeed(number(500))))),
        ("GA DY", Command("GA", (Axes("DY"),))),
        ("VM XYN", Command("VM", (Axes("XYN"),))),
        ("TP {F2.2}", Command("TP", (Format("F", 2, 2),))),  # l.3814
        ("TP{$4.2}", Command("TP", (Format("$", 4, 2),))),
        (
            'IN{P2}"ENTER",LEN{S6}',
            Command("IN", (Port(2), String("ENTER"), Formatted(Variable("LEN"), Format("S", 6)))),
        ),
        ('IN "enter Length(IN)", LEN', Command("IN", (String("enter Length(IN)"), Variable("LEN")))),  # l.3510
        (
            'MG "ENTER",P2CH{S},"AXIS SPEED" {N}',  # l.3616
            Command(
                "MG",
                (String("ENTER"), Formatted(Keyword("P2CH"), Format("S", 6)), String("AXIS SPEED"), NoLineEnd()),
            ),
        ),
        ("MG {^07},{^255}", Command("MG", (Character(7), Character(255)))),  # l.3709
        ('MG{P2}"TYPE X"', Command("MG", (Port(2), String("TYPE X")))),
        ('MG "a;b#c"', Command("MG", (String("a;b#c"),))),
        ("#Loop", Label("Loop")),
        ("# A", Label("A")),
        ("SPEED=7.5", Assign(Variable("SPEED"), number(7.5))),  # l.3116
        ("TEMP=@IN[1]", Assign(Variable("TEMP"), parse_line("V=@IN[1]").statements[0].value)),  # type: ignore[union-attr]
        ("SPD=4", Assign(Variable("SPD"), number(4))),
        ("V2=-A", Assign(Variable("V2"), Negative(Variable("A")))),
        ("V2=5--5", Assign(Variable("V2"), Binary("-", number(5), number(-5)))),
        ("POS[N]=_TP", Assign(Element("POS", Variable("N")), Operand("TP", ""))),
        ("V1=", Print(Variable("V1"))),
        ("V1={S4}", Print(Variable("V1"), Format("S", 4))),  # l.3873
        ("XERR[N] =", Print(Element("XERR", Variable("N")))),  # l.3471
        ("_KP=", Print(Operand("KP", ""))),
        ("TIME=", Print(Keyword("TIME"))),
        ("NO SPEED 10000 COUNTS/SECOND", Comment("NO", "SPEED 10000 COUNTS/SECOND")),  # l.2542
        ("NO A=5", Comment("NO", "A=5")),
        ("NO DON'T \"QUOTE", Comment("NO", "DON'T \"QUOTE")),
        ("NO=====", Comment("NO", "=====")),
        ("NOPOS[1", Comment("NO", "POS[1")),
        ("NOPOS[1]=5", Assign(Element("NOPOS", number(1)), number(5))),
        ("NOTE=5", Assign(Variable("NOTE"), number(5))),
        ("REM SIMPLE MOVE;BG", Comment("REM", "SIMPLE MOVE;BG")),  # l.2592
        ("'note", Comment("'", "note")),
        ("REMOTE=5", Assign(Variable("REMOTE"), number(5))),
    ],
)
def test_trees(text: str, tree: Statement) -> None:
    assert one(text) == tree


@pytest.mark.parametrize(
    ("text", "rule", "code"),
    [
        ("bg", "unknown-command", 1),  # l.1396
        ("QQ 5", "unknown-command", 1),
        ("V1", "unknown-command", 1),
        ("5", "unknown-command", 1),
        ("\x12\x16", "unknown-command", 1),
        ("ER=5", "assigned-command", 1),  # l.4065 example renamed
        ("_KP=2", "not-assignable", 1),  # l.3269
        ("TIME=5", "not-assignable", 9),
        ("PR 5 6", "bad-argument", 4),
        ("V1=5+", "value-missing", 4),
        ("WT 1,2", "too-many", 4),
        ("AD 1,2", "one-axis", 4),
        ("PR", "too-few", 50),
        ("OB 1", "too-few", 50),
        ("JP", "too-few", 50),
        ("CR 5,6", "too-few", 50),
        ("V1=3000000000", "number-too-big", 6),
        ("WT ?", "question-mark", 51),
        ("V1=?", "question-mark", 51),
        ('MG "HELLO', "missing-quote", 52),
        ('XQ #A,1"', "missing-quote", 52),
        ('XQ #A,1"\t', "missing-quote", 52),
        ('V1="ALPHABET"', "string-too-long", 52),
        ('MG "' + "A" * 73 + '"', "string-too-long", 52),
        ("MG V1{Q}", "bad-format", 53),
        ("MG V1{F11.2}", "bad-format", 53),
        ("MG {^256}", "bad-format", 53),
        ("V1=@SIN[5", "square-brackets", 55),
        ("DM POS", "square-brackets", 55),
        ("V1=POS[]", "index-missing", 56),
        ("V1=@SINE[5]", "bad-function", 57),
        ("DM pos[5]", "bad-array", 57),
        ("V1=_QQX", "bad-operand", 58),
        ("V1=_BTX", "bad-operand", 58),
        ("V1=(5", "brackets", 59),
        ("V1=5)", "brackets", 59),
        ("V1=(((((5)))))", "too-deep", 59),
        ("V1=A[A[A[A[A[5]]]]]", "too-deep", 59),
        ("#1Square", "bad-label", 61),  # l.2503
        ("#123", "bad-label", 61),
        ("#TOOLONGX", "bad-label", 61),
        ("JP #123", "bad-target", 11),
        ('IN "x" V', "input-comma", 65),
        ("IN V", "input-comma", 65),
        ('IN "x",', "input-variable", 25),
        ('IN "x",5', "input-variable", 25),
        ("BG Q", "bad-axis", 90),
        ("BG x", "bad-axis", 90),
        ("VM XX", "bad-axis", 90),
        ("REALLONGNAME=1", "bad-name", 9),  # l.3206
        ("é=5", "unknown-command", 1),
        ("V" * 600, "line-too-long", 60),
    ],
)
def test_what_is_refused(text: str, rule: str, code: int) -> None:
    statement = one(text)
    assert isinstance(statement, Broken)
    assert (statement.rule, statement.code) == (rule, code)


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        ("IF (V1=1)", "later-command"),
        ("ELSE", "later-command"),
        ("ENDIF", "later-command"),
        ("YA 5", "later-command"),
        ("BG E", "later-axis"),
        ("PR 1,2,3,4,5", "later-axis"),
        ("V1=_TPE", "later-axis"),
        ("BG ~a", "later-form"),
        ("~a=1", "later-form"),
        ("LI 1,2<5>6", "later-form"),
        ("GA X,Y", "later-form"),
        ("MG V1{Z4.2}", "later-form"),
        ("V1=@ATAN[1]", "later-form"),
    ],
)
def test_forms_of_later_controllers(text: str, rule: str) -> None:
    statement = one(text)
    assert isinstance(statement, Foreign)
    assert statement.rule == rule


def test_statements_of_a_line() -> None:
    line = parse_line("JG SPEED;BG;")  # l.3071
    assert line.statements == (Command("JG", (Variable("SPEED"),)), Command("BG"), Nothing())
    assert parse_line("").statements == parse_line("  \t").statements == ()
    assert parse_line(";").statements == (Nothing(), Nothing())
    assert parse_line("NO a;BG").statements == (Comment("NO", "a"), Command("BG"))


def test_a_refused_statement_leaves_the_others_alone() -> None:
    first, second, third = parse_line('QQ "a;b";BG X;WT )').statements
    assert isinstance(first, Broken) and first.text == 'QQ "a;b"'
    assert second == Command("BG", (Axes("X"),))
    assert isinstance(third, Broken) and third.text == "WT )"


def test_places_are_exact() -> None:
    text = ' PR 5, (V1 + 12) ;MG "A",V2{F1.0}'
    command, message = parse_line(text).statements
    assert isinstance(command, Command) and isinstance(message, Command)
    assert text[command.span.start : command.span.end] == "PR 5, (V1 + 12)"
    assert [text[each.span.start : each.span.end] for each in command.arguments] == ["5", "(V1 + 12)"]
    assert [text[each.span.start : each.span.end] for each in message.arguments] == ['"A"', "V2{F1.0}"]
    broken = one("  PR 5, QQQQQQQQQQQ ")
    assert isinstance(broken, Broken)
    assert (broken.span, broken.place) == (Span(2, 19), Span(8, 19))


def test_places_do_not_take_part_in_comparisons() -> None:
    assert parse_line("PR  5,  V1") == parse_line("PR5,V1")


def test_line_ends_of_every_kind() -> None:
    assert [line.text for line in parse("#A\r\nBG\rEN\n").lines] == ["#A", "BG", "EN"]
    assert parse("").lines == ()
    assert [line.text for line in parse("\n\n").lines] == ["", ""]


@given(LINES)
def test_spans_lie_in_the_line_and_in_order(text: str) -> None:
    end = 0
    for statement in parse_line(text).statements:
        assert end <= statement.span.start <= statement.span.end <= len(text)
        end = statement.span.end


@given(st.text())
def test_any_text_is_parsed(text: str) -> None:
    assert len(parse(text).lines) >= (1 if text else 0)


@pytest.mark.parametrize(
    "text", ["(" * 1_000_000, "1+" * 5_000_000, ";" * 10_000_000, '"' * 1_000_001, "V=" + "-" * 400]
)
def test_monstrous_lines_do_no_harm(text: str) -> None:
    statements = parse_line(text).statements
    assert len(statements) == 1 and isinstance(statements[0], Broken)


def test_a_long_comment_of_the_host_is_no_problem() -> None:
    assert one("REM " + "x" * 5000) == Comment("REM", "x" * 5000)


@pytest.mark.parametrize(("name", "free"), [("dmc1412", True), ("dmc1414", True), ("ssc2", False), ("ssc4", False)])
def test_a_name_that_is_a_command_of_other_controllers(name: str, free: bool) -> None:
    # dmc-1412-1414.txt l.3245 assigns VS*2000 to SP: the DMC-141x has no VS, so it is a variable there
    source = "#A\nVS=3;SP VS*2000;VS=\nEN"
    found = [problem.rule for problem in check(source, model(name)) if problem.severity == "error"]
    assert (found == []) if free else ("assigned-command" in found)
