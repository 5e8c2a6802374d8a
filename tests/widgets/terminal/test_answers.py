"""What a question takes for an answer: the kind comes from the program's own line, odd texts get a sentence."""

from __future__ import annotations

import pytest

from widgets.terminal.answers import Asked, answer_problem, answer_sent, asked_in

NUMBER, TEXT3 = Asked(), Asked(3)
# forms of dmc-1412-1414.txt: l.3490, l.3129, l.3640 ("if n is not specified, six characters will be accepted"), l.5352
SOURCE = (
    "#A",
    'IN "Enter Length",LENX',
    'IN "ENTER",LEN{S3}',
    'IN "Enter X, Y or Z",V{S}',
    'IN "How many",N;IN "Name",NAME{S4}',
    'IN "Enter",A[2]',
)


@pytest.mark.parametrize(
    ("lines", "prompt", "asked"),
    [
        ((1,), "Enter Length", Asked(0)),
        ((2,), "ENTER", Asked(3)),
        ((3,), "Enter X, Y or Z", Asked(6)),
        ((4,), "How many", Asked(0)),
        ((4,), "Name", Asked(4)),
        ((5,), "Enter", Asked(0)),
        ((), "Enter", None),  # not known where it comes from
        ((99,), "Enter", None),
    ],
)
def test_the_line_of_the_question_tells_what_it_takes(lines: tuple[int, ...], prompt: str, asked: Asked | None) -> None:
    assert asked_in(SOURCE, lines, prompt) == asked


def test_questions_that_can_not_be_told_apart_are_not_guessed() -> None:
    source = ('IN "Size",A', 'IN "Size",B{S6}')
    assert asked_in(source, (0,), "Size") == Asked(0)
    assert asked_in(source, (0, 1), "Size") is None


@pytest.mark.parametrize("text", ["0", "12.5", "-3", ".5", "5.", " 7 ", "+4", "$1F", "-$10", "2147483647.9999", ""])
def test_numbers_as_the_controller_reads_them(text: str) -> None:
    assert answer_problem(text, NUMBER) == ""
    assert answer_problem(text, None) == ""


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("12,5", "write 12.5"),
        ("1e3", "write 1000"),
        ("1.234.567", "is none"),
        ("1,234,567", "is none"),
        ("1 000", "write 1000 without blanks"),
        ("１２", "is none"),  # full-width digits
        ("٣", "is none"),
        ("12 mm", "is none"),
        ("12in", "is none"),
        ("−5", "write -5 with a plain minus"),
        ("0x1F", "is none"),
        ("$1FG", "no hexadecimal number"),
        ("$123456789", "no hexadecimal number"),
        ("2147483648", "outside of what a variable holds"),
        ("-9999999999", "outside of what a variable holds"),
        ("LEN*2", "is none"),
        ("12;MO", "A semicolon ends the answer"),
        ("   ", "Only blanks"),
        ("nan", "is none"),
        ("--5", "is none"),
        ("1_000", "write 1000"),
    ],
)
def test_odd_numbers_are_refused_in_a_sentence(text: str, words: str) -> None:
    said = answer_problem(text, NUMBER)
    assert words in said
    assert said.endswith((".", ".0", "12.5.", "it out."))


@pytest.mark.parametrize("text", ["12,5", "1e3", "1.234.567", "12 mm", "１２", "-", "2147483648", "$XY", "1;ST"])
def test_where_it_is_not_known_what_is_asked_odd_numbers_are_refused_too(text: str) -> None:
    assert answer_problem(text, None)


def test_texts_are_neither_cut_off_nor_changed() -> None:
    assert answer_problem("ABC", TEXT3) == ""
    assert answer_problem("12,", TEXT3) == ""  # a text may look like anything
    assert "has 4 characters, the program takes 3" in answer_problem("ABCD", TEXT3)
    assert "knows no “Ä”" in answer_problem("Ä", TEXT3)
    assert "knows no “\t”" in answer_problem("A\t", TEXT3)
    assert "semicolon" in answer_problem("A;B", TEXT3)
    assert answer_sent(" A ", TEXT3) == " A "
    assert answer_problem("STEEL7", None) == ""
    assert "takes 6" in answer_problem("STEEL70", None)


def test_a_number_is_sent_without_blanks_and_plus() -> None:
    assert answer_sent(" +12.5 ", NUMBER) == "12.5"
    assert answer_sent(" 7", None) == "7"
