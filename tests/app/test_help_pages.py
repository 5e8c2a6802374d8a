"""Help: the shipped pages are those of the tables, each can be found, and their pictures are there."""

from __future__ import annotations

import re
from pathlib import Path
from urllib.parse import unquote

import pytest
from PySide6.QtCore import QUrl
from PySide6.QtGui import QImage, QTextDocument
from PySide6.QtWidgets import QTextBrowser

import resources
from app.actions import ROWS
from app.help_pages import Pages, generated, title_of, write
from codegen.instructions import ALL
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.tables import ERROR_TEXTS
from tests.stage import Stage

HELP = resources.path("help")
PICTURES = sorted((HELP / "pictures").glob("*.png"))


def test_the_shipped_pages_are_those_of_the_tables() -> None:
    shipped = {
        path.relative_to(HELP).as_posix(): path.read_text(encoding="utf-8")
        for folder in ("instructions", "reference")
        for path in (HELP / folder).glob("*.md")
    }
    wanted = generated()
    changed = sorted({name for name in {*shipped, *wanted} if shipped.get(name) != wanted.get(name)})
    assert changed == [], "write them with: python -m app.help_pages"


def test_writing_puts_right_what_was_edited_and_removes_what_is_no_page(tmp_path: Path) -> None:
    everything = write(tmp_path)
    assert everything == len(generated())
    assert write(tmp_path) == 0
    (tmp_path / "reference" / "keys.md").write_text("# Keys\n")
    (tmp_path / "instructions" / "old.md").write_text("# Old\n")
    assert write(tmp_path) == 2
    assert "F12" in (tmp_path / "reference" / "keys.md").read_text(encoding="utf-8")
    assert not (tmp_path / "instructions" / "old.md").exists()


def test_every_page_has_a_title_of_its_own() -> None:
    paths = list(HELP.rglob("*.md"))
    assert len(Pages()) == len(paths)
    assert all(title_of(path.read_text(encoding="utf-8")) for path in paths)


def test_every_instruction_command_error_and_key_is_in_the_help() -> None:
    pages = Pages()
    assert {kind.title for kind in ALL} <= set(pages)
    commands = "\n".join(text for title, text in pages.items() if title.startswith("Commands: "))
    assert sorted(re.findall(r"(?m)^## (\S+):", commands)) == sorted(COMMANDS)
    assert all(f"| {code} | {text} |" in pages["Error and stop codes"] for code, text in ERROR_TEXTS.items())
    assert all(f"| {row.shortcut} | {row.help} |" in pages["Keys"] for row in ROWS if row.shortcut)


@pytest.mark.parametrize("path", PICTURES, ids=lambda path: path.name)
def test_a_picture_is_no_larger_than_it_must_be(path: Path) -> None:
    assert path.stat().st_size < 200_000
    image = QImage(str(path))
    assert image.width() <= 1280 and image.height() <= 800


def test_pictures_of_pages_are_there_and_shown(stage: Stage) -> None:
    links = {link for text in Pages().values() for link in re.findall(r"!\[[^]]*\]\(([^)]+)\)", text)}
    assert {HELP / link for link in links} == set(PICTURES)
    stage.studio.desk.show_help("Program window")
    stage.go()
    assert stage.studio.desk.help is not None
    browser = stage.studio.desk.help.findChildren(QTextBrowser)[0]
    for link in links:
        assert browser.loadResource(QTextDocument.ResourceType.ImageResource.value, QUrl(link)) is not None
    shown = re.findall(r'<img src="pictures/program.png"[^>]* width="(\d+)" height="(\d+)"', browser.toHtml())
    assert len(shown) == 1
    width, height = map(int, shown[0])
    assert 300 < width < browser.viewport().width()
    assert abs(width * 800 / 1280 - height) <= 1


def test_help_for_something_without_a_page_is_that_of_the_program_window(stage: Stage) -> None:
    stage.studio.desk.show_help("No such page")
    stage.go()
    assert stage.studio.desk.help is not None
    assert "Download" in stage.studio.desk.help.findChildren(QTextBrowser)[0].toPlainText()


def test_every_panel_has_a_page(stage: Stage) -> None:
    assert set(stage.studio.window.docks) <= set(Pages())


def test_every_link_is_one_and_leads_to_a_page(qapp: object) -> None:
    pages = Pages()
    links = 0
    for title, text in pages.items():
        shown = QTextDocument()
        shown.setMarkdown(text)
        assert "](" not in shown.toPlainText(), title  # such as a blank in an address: no link then
        for href in re.findall(r'href="([^"]+)"', shown.toHtml()):
            target = unquote(href).removeprefix("page:").removeprefix("#").removesuffix(".md")
            assert target in pages or target.partition("#")[0] in pages, (title, href)
            links += 1
    assert links > 80
