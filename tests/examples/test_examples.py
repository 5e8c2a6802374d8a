"""Every example of the manuals runs on the simulator with the result the manual states, and none is left out."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import pytest

from tests.examples import manual
from tests.examples.script import Example, Player, read_examples

HERE = Path(__file__).parent
TEXTS = sorted({*HERE.glob("chapter*.txt"), *HERE.glob("ssc-chapters*.txt")})
EXAMPLES = [example for path in TEXTS for example in read_examples(path)]
RANGE = re.compile(r"(?:(ssc)\.)?l\.(\d+)(?:-(\d+))?").fullmatch
PLACE = re.compile(r"(dmc|ssc):(\d+)(?:-(\d+))? +\S.*").fullmatch


@pytest.mark.parametrize("example", EXAMPLES, ids=str)
def test_example_of_the_manual(example: Example) -> None:
    player = Player(example)
    player.play()
    assert player.place, "nothing was done"


@pytest.mark.parametrize("example", EXAMPLES, ids=str)
def test_an_example_can_fail(example: Example) -> None:
    words = {line.split(" ", 1)[0] for _, line in example.steps}
    assert words & {"expect", "said", "said2", "refused", "badprogram"} or any(
        " -> " in line for _, line in example.steps
    )


def lines_of(match: re.Match[str]) -> set[tuple[str, int]]:
    """The lines of a manual that a place names."""
    first = int(match[2])
    return {(match[1] or "dmc", number) for number in range(first, int(match[3] or first) + 1)}


def reasons(name: str) -> dict[tuple[str, int], str]:
    """Lines of a list, with the row that says why they are on it."""
    found = {}
    rows = (HERE / name).read_text(encoding="utf-8").splitlines()[2:]
    for row in rows:
        match = PLACE(row)
        assert match, row
        found.update(dict.fromkeys(lines_of(match), row))
    return found


def excused() -> dict[tuple[str, int], str]:
    """Lines that are no examples."""
    return reasons("not-programs.txt")


@cache
def shown() -> dict[tuple[str, int], list[Example]]:
    """Lines of the manuals with the examples that show them."""
    found: dict[tuple[str, int], list[Example]] = {}
    for example in EXAMPLES:
        match = RANGE(example.lines)
        assert match, example.lines
        for place in lines_of(match):
            found.setdefault(place, []).append(example)
    return found


def test_every_line_of_code_in_the_manuals_is_an_example_or_has_a_reason() -> None:
    places = set(shown()) | set(excused())
    left_out = [f"{each.place} {each.text}" for each in manual.listed() if (each.manual, each.line) not in places]
    assert not left_out, "\n".join(left_out)


@pytest.mark.parametrize("name", ["not-programs.txt", "repairs.txt"])
def test_no_reason_is_given_for_what_is_no_code(name: str) -> None:
    code = {(each.manual, each.line) for each in manual.listed()}
    rows = reasons(name)
    assert not set(rows.values()) - {row for place, row in rows.items() if place in code}


def plain(text: str) -> str:
    """Without blanks."""
    return re.sub(r"\s", "", text)


def typed(example: Example) -> set[str]:
    """Everything an example sends or loads, whole and command by command."""
    found = set()
    for _, line in example.steps:
        word, _, rest = line.strip().partition(" ")
        sent = rest.split(" -> ")[0] if word in ("port", "raw", "xq") else rest if word == "refused" else line
        pieces = sent.replace("\\r", "\n").split("\n")
        found |= {plain(part) for piece in pieces for part in (piece, *piece.split(";"), piece.partition(" ")[2])}
    return {text for text in found if len(text) >= 2}


def runs(line: manual.CodeLine, example: Example) -> bool:
    """Whether the example has the line's code: what follows it in the manual's text explains it."""
    code = plain(line.text)
    return any(
        code.startswith(text) or text.startswith(code) or (len(code) > 3 and code in text) for text in typed(example)
    )


def test_every_line_of_code_is_in_its_example_or_was_repaired() -> None:
    repaired, missing = {**reasons("repairs.txt"), **excused()}, []
    for line in manual.listed():
        place = (line.manual, line.line)
        if place not in repaired and place in shown() and not any(runs(line, each) for each in shown()[place]):
            missing.append(f"{line.place} {line.text}")
    assert not missing, "\n".join(missing)


@pytest.mark.skipif(manual.folder() is None, reason="the manuals are not here (TWOLETTER_MANUALS)")
def test_the_list_is_what_the_scan_of_the_manuals_finds() -> None:
    where = manual.folder()
    assert where is not None
    assert manual.scan(where) == manual.listed()


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("JP #LOOP, N<=100 Repeat the process", "JP #LOOP, N<=100 Repeat the process"),
        ("BM 62000 < CR>", "BM 62000 < CR>"),
        ("- AB Abort Motion", "AB Abort Motion"),
        ("$V1 = _TP$\tDetermine distance to zero", "V1 = _TP"),
        (":TPX Tell position", "TPX Tell position"),
        ("Internal Variable\t_TPX=0", "_TPX=0"),
        ("*RX=\\_TPX-(@COS[45]\\*40)*", "RX=_TPX-(@COS[45]*40)"),
        ("The motor will probably not move.", ""),
        ("Note that the contour mode is different.", ""),
    ],
)
def test_the_scan_knows_code_from_words(line: str, code: str) -> None:
    assert manual.code_in(line) == code
