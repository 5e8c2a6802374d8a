"""Handover: author and revision are typed, undone, burned, read back; the pack is a PDF with everything in it."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QTextDocument
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLineEdit, QPlainTextEdit

from codegen.handover import Handover
from tests.app.pauses import Ticks, too_long
from tests.app.test_run import answer, idle, same_model, trigger
from tests.benchmarks.editing import large_document
from tests.long import is_long
from tests.stage import Stage
from widgets.backup.handover import HandoverPage
from widgets.program.printing import PrintPreview

WHOLE = True  # the panels at the machine are there from the beginning
SHIFT_CTRL = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier


def page_of(stage: Stage) -> HandoverPage:
    QTest.keyClick(stage.studio.window, Qt.Key.Key_H, SHIFT_CTRL)
    stage.go()
    page = stage.studio.proof.handing.page
    assert page is not None and page.isVisible()
    return page


def write(widget: QLineEdit | QPlainTextEdit, text: str) -> None:
    widget.setFocus()
    QTest.keyClicks(widget, text)


def filled(stage: Stage) -> HandoverPage:
    page = page_of(stage)
    page._today = "2026-11-22"
    write(page.author, "J. Smith")
    write(page.revision, "C")
    write(page.changes, "C: longer stroke")
    return page


def test_what_is_typed_is_in_the_document_and_can_be_undone(stage: Stage) -> None:
    page = filled(stage)
    session = stage.studio.session
    assert session.document.handover == Handover("J. Smith", "C", "2026-11-22", "C: longer stroke")
    assert page.date.text() == "2026-11-22"  # by itself with the revision
    assert page.line.text() == "NO CUTTER, rev C, 2026-11-22, by J. Smith" == session.listing.lines[0].text
    assert session.undo_text == "Change handover"
    while session.can_undo:
        session.undo()
    assert session.document.handover == Handover() and page.revision.text() == ""
    assert "Without a revision" in page.words.text()


def test_the_revision_is_burned_and_told_when_somebody_connects(stage: Stage) -> None:
    filled(stage)
    rig = same_model(stage, "machine")
    stage.download()
    trigger(stage, "burn")
    answer(stage, "Burn")
    idle(stage)
    rig.simulation.stimulus("reset", 0)
    stage.later(3.0)
    assert rig.program[0] == "NO CUTTER, rev C, 2026-11-22, by J. Smith"
    again = stage.connect("machine", stage.studio.model(), program="\n".join(rig.program))
    told = "The controller holds CUTTER, revision C, 2026-11-22, by J. Smith."
    stage.until(lambda: told in stage.studio.messages.texts(), 5.0)
    assert not again.controller.control


def test_a_running_program_is_said_to_run_and_others_say_nothing(stage: Stage) -> None:
    code = "NO CUTTER, rev C, 2026-11-22\n#A\nWT 100\nJP #A"
    rig = stage.connect("machine", "ssc1")
    stage.go(30)
    assert not any("revision" in text for text in stage.studio.messages.texts())
    rig = stage.connect("machine", "ssc1", program=code, scene="")
    rig.start(code)
    stage.studio.proof.handing._met = None
    stage.until(lambda: rig.controller.waiting.position, 5.0)
    stage.studio.proof.handing._met = None
    stage.until(lambda: any("controller runs CUTTER, revision C, 2026-11-22" in text
                            for text in stage.studio.messages.texts()), 5.0)  # fmt: skip


def text_of(preview: PrintPreview) -> str:
    return preview.pages.toPlainText()


def test_the_pack_has_everything_and_a_header_on_every_page(stage: Stage, tmp_path: Path) -> None:
    page = filled(stage)
    QTest.mouseClick(page.pack, Qt.MouseButton.LeftButton)
    stage.go()
    preview = stage.studio.proof.handing.preview
    assert preview is not None and preview.isVisible()
    text = text_of(preview)
    for words in (
        "Handover: CUTTER", "J. Smith", "C: longer stroke", "Move X by 10 in", "PR 6370", "Counts per unit", "637",
        "Proportional gain", "Forward limit", "Input 1", "Output 8", "Checklist", "Emergency stop",
    ):  # fmt: skip
        assert words in text
    title = preview.pages.metaInformation(QTextDocument.MetaInformation.DocumentTitle)
    assert title == "CUTTER, revision C"
    assert preview.pages.pageCount() >= 4
    preview.save(tmp_path / "pack.pdf")
    data = (tmp_path / "pack.pdf").read_bytes()
    assert data.startswith(b"%PDF-")
    assert data.count(b"/Type /Page\n") == preview.pages.pageCount()
    preview.close()


def long_pack(stage: Stage) -> PrintPreview:
    """Of a program of 1000 steps."""
    stage.studio.session.set_document(large_document(), "Long")
    stage.studio.actions["print_pack"].trigger()
    preview = stage.studio.proof.handing.preview
    assert preview is not None
    return preview


@pytest.mark.alone
def test_a_long_pack_is_written_page_by_page_and_can_be_cancelled(stage: Stage, tmp_path: Path) -> None:
    preview, path, said = long_pack(stage), tmp_path / "pack.pdf", stage.studio.messages.texts
    pages = preview.pages.pageCount()
    assert pages > 20
    path.write_bytes(b"earlier")
    preview.save(path)
    assert preview.progress.isVisible() and 0 < preview.progress.value() < pages
    assert not preview.buttons["Print"].isEnabled()
    preview.save(tmp_path / "second.pdf")  # one after the other
    QTest.keyClick(preview, Qt.Key.Key_F12)
    QTest.mouseClick(preview.cancel, Qt.MouseButton.LeftButton)
    assert said()[-1] == "Cancelled: no file was written." and not preview.progress.isVisible()
    assert [each.name for each in tmp_path.glob("*pdf*")] == ["pack.pdf"] and path.read_bytes() == b"earlier"

    def writing() -> dict[str, float]:
        ticks = Ticks(stage)
        count = said().count("Saved pack.pdf")
        ticks.phase("longest turn while 25 pages are written", lambda: preview.save(path),
            lambda: said().count("Saved pack.pdf") > count)  # fmt: skip
        return ticks.worst

    assert too_long("pytest tests/app/test_handover.py", writing, bare=is_long()) == {}
    assert path.read_bytes().count(b"/Type /Page\n") == pages
    preview.save(tmp_path / "never.pdf")
    preview.close()  # in the middle of it
    assert not list(tmp_path.glob("never*"))


@pytest.mark.long
def test_the_pack_says_what_was_compared(stage: Stage) -> None:
    same_model(stage)
    stage.download()
    stage.studio.actions["print_pack"].trigger()
    preview = stage.studio.proof.handing.preview
    assert preview is not None
    assert "The controller holds exactly the open program (15 lines)." in text_of(preview)
    preview.close()
