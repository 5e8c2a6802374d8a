"""Print Program and Print Code: what is on the pages, the preview, the PDF; nothing of it is imported at start."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest
from PySide6.QtCore import Qt, QUrl
from pytestqt.qtbot import QtBot

from codegen.instructions import Comment, Output, Repeat, SingleAxisMove, Wait
from tests.widgets.program.conftest import Window
from tests.widgets.program.test_drag import in_front
from tests.widgets.program.test_view import fill
from widgets.program.printing import PrintPreview, code_pages, program_pages, write_pdf


def some(window: Window) -> None:
    """A remark that HTML would swallow, a repeat with a move, a note."""
    fill(window, Comment(text="a<b & c"), Repeat())
    fill(window, SingleAxisMove(distance="10", speed="5"))
    window.view.end_of_repeat()
    (last,) = fill(window, Output(output="1"))
    window.session.set_note(last, "the knife")
    window.session.set_program(description="10 in of wire")


def test_the_pages_say_every_step_with_its_code_and_note(window: Window) -> None:
    some(window)
    document = window.session.document
    text = program_pages(document, window.view.words, "2026-11-22").toPlainText()
    for words in ("CUTTER", "10 in of wire", "a<b & c", "Repeat 10 times", "Move X by 10 in at 5 in/s", "PR 6370"):
        assert words in text
    assert "the knife" in text
    assert "printed 2026-11-22" in text
    assert "X: 637 counts/in" in text


def test_the_code_has_the_line_numbers_of_the_controller(window: Window) -> None:
    some(window)
    lines = code_pages(window.session.document, window.view.words, "2026-11-22").toPlainText().split("\n")
    for number, code in enumerate(window.code()):
        assert f"{number:>4}  {code}" in lines


def test_ctrl_p_opens_a_preview_that_saves_as_pdf(window: Window, qtbot: QtBot, tmp_path: Path) -> None:
    some(window)
    qtbot.keyClick(in_front(window), Qt.Key.Key_P, Qt.KeyboardModifier.ControlModifier)
    preview = window.view.preview
    assert isinstance(preview, PrintPreview)
    assert preview.windowTitle() == "Print program"
    assert not preview.isModal()
    assert preview.count.text() == "1 page"
    path = tmp_path / "cutter.pdf"
    with qtbot.waitSignal(window.view.said) as said:
        preview.save(path)
    assert said.args == ["Saved cutter.pdf"]
    assert path.read_bytes().startswith(b"%PDF-")
    both = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
    qtbot.keyClick(in_front(window), Qt.Key.Key_P, both)
    assert window.view.preview.windowTitle() == "Print code"
    preview.close()
    window.view.preview.close()


def test_print_opens_the_pages_in_the_pdf_viewer(window: Window, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch) -> None:
    some(window)
    qtbot.keyClick(in_front(window), Qt.Key.Key_P, Qt.KeyboardModifier.ControlModifier)
    preview = window.view.preview
    assert isinstance(preview, PrintPreview)
    opened: list[bytes] = []

    def viewer(url: QUrl) -> bool:
        opened.append(Path(url.toLocalFile()).read_bytes())
        return len(opened) == 1  # the second time there is none

    monkeypatch.setattr("widgets.program.printing.QDesktopServices", SimpleNamespace(openUrl=viewer))
    for words in ("open in the PDF viewer", "no program for PDF files"):
        with qtbot.waitSignal(window.view.said) as said:
            qtbot.mouseClick(preview.buttons["Print"], Qt.MouseButton.LeftButton)
        assert words in said.args[0]
    assert all(data.startswith(b"%PDF-") for data in opened)
    preview.close()


def test_a_thousand_steps_take_many_pages(window: Window, tmp_path: Path) -> None:
    fill(window, *(Wait(time=str(number + 1)) for number in range(1000)))
    path = tmp_path / "long.pdf"
    assert write_pdf(program_pages(window.session.document, window.view.words, "2026-11-22"), path) == ""
    assert path.read_bytes().count(b"/Type /Page\n") > 10


def test_a_file_that_cannot_be_written_is_one_sentence(window: Window, tmp_path: Path) -> None:
    pages = program_pages(window.session.document, window.view.words, "2026-11-22")
    assert write_pdf(pages, tmp_path) == f"{tmp_path.name} cannot be written: Is a directory"
