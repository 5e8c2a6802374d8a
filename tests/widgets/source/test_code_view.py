"""The code beside the program: replaces only what differs, keeps its colours and marks."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
from PySide6.QtGui import QTextDocument
from pytestqt.qtbot import QtBot

from widgets.parts.look import look
from widgets.source.highlight import Highlighter
from widgets.source.view import CodeView

LINES = st.lists(st.sampled_from(["PR 1", "BG X", "AM X", "#A", "EN", ""]), max_size=12)


@given(st.lists(LINES, max_size=6))
@settings(max_examples=60)
def test_the_text_equals_the_lines_after_any_changes(listings: list[list[str]]) -> None:
    view = CodeView()
    for lines in listings:
        view.show_lines(lines, {})
        assert view.toPlainText() == "\n".join(lines)
    view.deleteLater()


def test_only_the_lines_that_differ_are_replaced(qtbot: QtBot) -> None:
    view = CodeView()
    qtbot.addWidget(view)
    view.show_lines([f"WT {number}" for number in range(1, 101)], {})
    changes: list[tuple[int, int, int]] = []
    view.document().contentsChange.connect(lambda *what: changes.append(what))
    lines = [f"WT {number}" for number in range(1, 101)]
    lines[49] = "WT 999"
    view.show_lines(lines, {})
    assert sum(removed for _, removed, _ in changes) == len("WT 50\n")
    assert view.document().findBlockByNumber(49).text() == "WT 999"


@given(st.lists(st.tuples(st.integers(0, 59), st.integers(1, 14), st.integers(0, 59)), max_size=8))
@settings(max_examples=60)
def test_lines_that_are_moved_come_out_right(moves: list[tuple[int, int, int]]) -> None:
    view = CodeView()
    lines = [f"WT {number % 20}" for number in range(60)]  # some are the same
    view.show_lines(lines, {})
    for start, count, place in moves:
        block, rest = lines[start : start + count], lines[:start] + lines[start + count :]
        lines = [*rest[:place], *block, *rest[place:]]
        view.show_lines(lines, {})
        assert view.toPlainText() == "\n".join(lines)
    view.deleteLater()


def test_of_moved_lines_only_these_are_written_again(qtbot: QtBot) -> None:
    view = CodeView()
    qtbot.addWidget(view)
    lines = [f"WT {number}" for number in range(100, 200)]
    view.show_lines(lines, {})
    changes: list[tuple[int, int, int]] = []
    view.document().contentsChange.connect(lambda *what: changes.append(what))
    view.show_lines([*lines[:10], *lines[11:80], lines[10], *lines[80:]], {})
    assert [removed + added for _, removed, added in changes if removed + added] == [len("WT 110\n")] * 2


def test_the_same_lines_again_change_nothing(qtbot: QtBot) -> None:
    view = CodeView()
    qtbot.addWidget(view)
    view.show_lines(["#A", "EN"], {})
    revision = view.document().revision()
    view.show_lines(["#A", "EN"], {})
    assert view.document().revision() == revision


def colours(text: str) -> dict[str, str]:
    """The colour of each part of a line."""
    document = QTextDocument(text)
    highlighter = Highlighter(document)
    highlighter.rehighlight()
    ranges = document.firstBlock().layout().formats()
    return {
        text[part.start : part.start + part.length].strip(): part.format.foreground().color().name() for part in ranges
    }


def test_commands_numbers_labels_texts_and_remarks_have_their_colours(qtbot: QtBot) -> None:
    def of(token: str) -> str:
        return look().colour(token).name()

    assert colours("PR 6370;BG X") == {"PR": of("code_command"), "6370": of("code_number"), "BG": of("code_command")}
    assert colours('MG "PR 1"') == {"MG": of("code_command"), '"PR 1"': of("code_string")}
    assert colours("JP #A,V1<3")["#A"] == of("code_label")
    assert colours("NO PR 1") == {"NO PR 1": of("code_comment")}
    assert colours("QX 1")["QX"] == of("code_error")  # no such command
    assert colours("RC1=10")["10"] == of("code_number")
    assert "RC" not in colours("RC1=10")  # a variable, not the command RC


def test_running_problem_and_error_lines_are_marked(qtbot: QtBot) -> None:
    view = CodeView()
    qtbot.addWidget(view)
    view.show_lines(["#A", "PR 1", "EN"], {1: "Distance is missing"})
    view.show_executing({0: 2, 1: None})
    assert view.threads_at(2) == (0,)
    assert view.problem_lines == {1: "Distance is missing"}
    view.show_chosen([1])
    view.show_error(2)
    assert len(view.extraSelections()) == 3


def test_lines_get_their_colours_when_they_come_into_sight(qtbot: QtBot) -> None:
    view = CodeView()
    qtbot.addWidget(view)
    view.resize(400, 300)
    view.show()
    qtbot.waitExposed(view)
    view.show_lines([f"PR {number}" for number in range(500)], {})

    def coloured(number: int) -> bool:
        return bool(view.document().findBlockByNumber(number).layout().formats())

    qtbot.waitUntil(lambda: coloured(0))
    assert not coloured(300)
    view.verticalScrollBar().setValue(300)
    shown = [number for number, _, _ in view.visible_lines()]
    assert 300 in shown and all(map(coloured, shown))
    view.show_lines([f"SP {number}" for number in range(500)], {})  # all of them are others now
    view.verticalScrollBar().setValue(0)
    assert coloured(0) and not coloured(450)
