"""The program and its code on paper: pages, their preview, and the same as PDF."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QMarginsF, Qt, Signal
from PySide6.QtGui import QPageLayout, QPageSize, QPdfWriter, QTextDocument
from PySide6.QtWidgets import QDialog, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from codegen.document import Document
from codegen.models import MODELS
from codegen.program import Section, Steps
from widgets.parts import files
from widgets.parts.look import look
from widgets.program.node import TITLES
from widgets.program.words import Words

if TYPE_CHECKING:
    from PySide6.QtPrintSupport import QPrinter

PDF = "PDF files (*.pdf)"
RESOLUTION = 600  # dots an inch
INDENT = "&nbsp;" * 5  # for each step inwards
STYLE = """
body, h1, h2, p, td, pre { color: #000000; }
h1 { font-size: 16pt; margin-bottom: 2pt; } h2 { font-size: 12pt; margin-top: 12pt; margin-bottom: 4pt; }
p, td { font-size: 9pt; } td { padding: 1pt 6pt 1pt 0; } .quiet { color: #555555; }
.code, pre { font-family: 'Noto Sans Mono', 'DejaVu Sans Mono', monospace; font-size: 8.5pt; }
"""


def program_pages(document: Document, words: Words, date: str) -> QTextDocument:
    """Every step in English beside its code, section by section."""
    parts = [_heading(document, date)]
    for section in Section:
        steps = document.program.section(section)
        if steps:
            parts.append("<p style='font-size: 5pt'>&nbsp;</p>")
            parts.append(f"<h2>{TITLES[section.value]}</h2><table width='100%' cellspacing='0'>")
            parts += _rows(steps, words, 0)
            parts.append("</table>")
    return _pages("".join(parts))


def code_pages(document: Document, words: Words, date: str) -> QTextDocument:
    """The two-letter code with its line numbers, as the controller counts them."""
    listing = words.listing.lines if words.listing is not None else ()
    lines = "".join(f"{number:>4}  {escape(line.text)}\n" for number, line in enumerate(listing))
    return _pages(f"{_heading(document, date)}<pre style='white-space: pre-wrap'>{lines}</pre>")


def _heading(document: Document, date: str) -> str:
    program, setup = document.program, document.setup
    machine = f"{setup.name}, " if setup.name else ""
    controller = MODELS[setup.model].title if setup.model in MODELS else setup.model
    axes = ", ".join(
        f"{letter}: {setup.axis(letter).counts_per_unit or '?'} counts/{setup.axis(letter).symbol}"
        for letter in (setup.letters if setup.model in MODELS else "")
    )
    return (
        f"<h1>{escape(program.name or 'Program')}</h1><p>{escape(program.description)}</p>"
        f"<p class='quiet'>{escape(f'{machine}{controller} · {axes} · printed {date}')}</p>"
    )


def _rows(steps: Steps, words: Words, depth: int) -> Iterator[str]:
    for step in steps:
        problem = (
            f"<br/>{INDENT * depth}! {escape(words.problem(step))}" if words.problem(step) and step.enabled else ""
        )
        note = f"<br/>{INDENT * depth}<i>{escape(step.note)}</i>" if step.note else ""
        yield (
            f"<tr><td width='62%'>{INDENT * depth}{escape(words.english(step))}{note}{problem}"
            f"</td><td class='code'>{escape(words.code(step))}</td></tr>"
        )
        yield from _rows(step.body, words, depth + 1)


def _pages(html: str) -> QTextDocument:
    pages = QTextDocument()
    pages.setDefaultStyleSheet(STYLE)
    pages.setHtml(html)
    return pages


def write_pdf(pages: QTextDocument, path: Path) -> str:
    """Writes the pages; gives why it could not, or nothing."""
    try:
        path.open("ab").close()  # Qt says nothing when it cannot write
    except OSError as failure:
        return f"{path.name} cannot be written: {failure.strerror or failure}"
    writer = QPdfWriter(str(path))
    writer.setPageLayout(_layout())
    writer.setResolution(RESOLUTION)
    pages.print_(writer)
    return ""


def _layout() -> QPageLayout:
    margins = QMarginsF(5, 5, 5, 5)  # and the document leaves 20 mm
    return QPageLayout(
        QPageSize(QPageSize.PageSizeId.A4), QPageLayout.Orientation.Portrait, margins, QPageLayout.Unit.Millimeter
    )


class PrintPreview(QDialog):
    """The pages as they will come out; Print, or save as PDF. Not modal."""

    said = Signal(str)

    def __init__(self, title: str, pages: QTextDocument, name: str, parent: QWidget | None = None) -> None:
        from PySide6.QtPrintSupport import QPrinter, QPrintPreviewWidget  # late: few print, all start

        super().__init__(parent)
        self.setModal(False)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(title)
        self.setProperty("helpPage", "Program window")
        self.pages, self.suggested = pages, Path.home() / f"{name or 'program'}.pdf"
        self.printer: QPrinter = QPrinter(QPrinter.PrinterMode.HighResolution)
        self.printer.setPageLayout(_layout())
        self.preview = QPrintPreviewWidget(self.printer)
        self.preview.setAccessibleName("Pages")
        self.preview.paintRequested.connect(self.pages.print_)
        self.count = QLabel()
        self.count.setProperty("role", "quiet")
        self.preview.previewChanged.connect(self._show_count)
        buttons = QHBoxLayout()
        buttons.addWidget(self.count, 1)
        self.buttons = {
            text: self._button(text, action)
            for text, action in (
                ("Print…", self.choose_printer),
                ("Save as PDF…", self.choose_file),
                ("Close", self.accept),
            )
        }
        for button in self.buttons.values():
            buttons.addWidget(button)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 16, 16, 16)
        column.setSpacing(12)
        column.addWidget(self.preview, 1)
        column.addLayout(buttons)
        self.resize(640, 720)

    def choose_printer(self) -> None:
        """The system's dialog of printers."""
        from PySide6.QtPrintSupport import QPrintDialog

        dialog = QPrintDialog(self.printer, self)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.accepted.connect(self._print)
        dialog.open()

    def choose_file(self) -> None:
        """Asks where the PDF goes."""
        files.ask_save(self, "Save as PDF", PDF, self.save, self.suggested, "pdf")

    def save(self, path: Path) -> None:
        """Writes the PDF and says so."""
        self.said.emit(write_pdf(self.pages, path) or f"Saved {path.name}")

    def _print(self) -> None:
        self.pages.print_(self.printer)
        self.said.emit(f"Sent to {self.printer.printerName() or 'the printer'}")

    def _show_count(self) -> None:
        count = self.preview.pageCount()
        self.count.setText("1 page" if count == 1 else f"{count} pages")

    def _button(self, text: str, action: Callable[[], object]) -> QPushButton:
        button = QPushButton(text)
        button.setMinimumHeight(look().control)
        button.setAutoDefault(False)
        button.clicked.connect(lambda: action())
        return button
