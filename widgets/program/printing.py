"""The program and its code on paper: pages, their preview, and the same as PDF."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Generator, Iterator
from functools import partial
from html import escape
from pathlib import Path

from PySide6.QtCore import QMarginsF, QRectF, QSizeF, Qt, QTimer, QUrl, Signal
from PySide6.QtGui import (
    QColor,
    QDesktopServices,
    QFont,
    QPageLayout,
    QPageSize,
    QPainter,
    QPaintEvent,
    QPdfWriter,
    QTextDocument,
)
from PySide6.QtWidgets import (
    QDialog,
    QHBoxLayout,
    QLabel,
    QProgressBar,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from codegen.document import Document
from codegen.models import MODELS
from codegen.program import Section, Steps
from widgets.parts import files
from widgets.parts.foot import foot
from widgets.parts.look import look
from widgets.program.node import TITLES
from widgets.program.words import Words

PDF = "PDF files (*.pdf)"
RESOLUTION = 600  # dots an inch
PAGE = QSizeF(794, 1123)  # A4 at 96 dots an inch
MARGIN = 76.0  # 20 mm
GAP = 12  # between pages on the screen
FEW = 6  # pages that are written at once
INDENT = "&nbsp;" * 5  # for each step inwards
STYLE = """
body, h1, h2, p, td, pre { color: #000000; }
h1 { font-size: 16pt; margin-bottom: 2pt; } h2 { font-size: 12pt; margin-top: 12pt; margin-bottom: 4pt; }
p, td { font-size: 9pt; } td { padding: 1pt 6pt 1pt 0; } .quiet { color: #555555; }
.code, pre { font-family: 'Noto Sans Mono', 'DejaVu Sans Mono', monospace; font-size: 8.5pt; }
"""


def program_pages(document: Document, words: Words, date: str) -> QTextDocument:
    """Every step in English beside its code, section by section."""
    return make_pages(f"{_heading(document, date)}{program_html(document, words)}", document)


def program_html(document: Document, words: Words) -> str:
    """Every step in English beside its code."""
    parts = []
    for section in Section:
        steps = document.program.section(section)
        if steps:
            parts.append("<p style='font-size: 5pt'>&nbsp;</p>")
            parts.append(f"<h2>{TITLES[section.value]}</h2><table width='100%' cellspacing='0'>")
            parts += _rows(steps, words, 0)
            parts.append("</table>")
    return "".join(parts)


def code_pages(document: Document, words: Words, date: str) -> QTextDocument:
    """The two-letter code with its line numbers, as the controller counts them."""
    return make_pages(f"{_heading(document, date)}{code_html(words)}", document)


def code_html(words: Words) -> str:
    """The lines with their numbers."""
    listing = words.listing.lines if words.listing is not None else ()
    lines = "".join(f"{number:>4}  {escape(line.text)}\n" for number, line in enumerate(listing))
    return f"<pre style='white-space: pre-wrap'>{lines}</pre>"


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


def make_pages(html: str, document: Document) -> QTextDocument:
    """Pages of paper; name and revision stand on top of each."""
    pages = QTextDocument()
    pages.setDefaultStyleSheet(STYLE)
    pages.setDocumentMargin(MARGIN)
    pages.setHtml(html)
    revision = f", revision {document.handover.revision}" if document.handover.revision else ""
    title = f"{document.program.name or 'Program'}{revision}"
    pages.setMetaInformation(QTextDocument.MetaInformation.DocumentTitle, title)  # setHtml clears it
    pages.setPageSize(PAGE)
    return pages


def write_pages(pages: QTextDocument, path: Path) -> Generator[int, None, None]:
    """Writes one page after the other and tells its number; raises OSError. The file is there once all are done."""
    fresh, part = not path.exists(), path.with_name(f"{path.name}.part")
    path.open("ab").close()  # Qt says nothing when it cannot write
    writer = QPdfWriter(str(part))
    writer.setPageLayout(_layout())
    writer.setResolution(RESOLUTION)
    writer.setTitle(pages.metaInformation(QTextDocument.MetaInformation.DocumentTitle))
    painter, whole = QPainter(), False
    try:
        if not painter.begin(writer):
            raise OSError(0, "its folder takes no other file")
        scale = writer.width() / PAGE.width()
        painter.scale(scale, scale)
        for number in range(pages.pageCount()):
            if number:
                writer.newPage()
            draw_page(painter, pages, number)
            yield number + 1
        whole = painter.end()
        if not whole:
            raise OSError(0, "the disk may be full")
        part.replace(path)
    finally:
        if not whole:
            painter.end()
            part.unlink(missing_ok=True)
            if fresh:
                path.unlink(missing_ok=True)


def write_pdf(pages: QTextDocument, path: Path) -> str:
    """Writes all pages at once; gives why it could not, or nothing."""
    try:
        for _ in write_pages(pages, path):
            pass
    except OSError as failure:
        return f"{path.name} cannot be written: {failure.strerror or failure}"
    return ""


def draw_page(painter: QPainter, pages: QTextDocument, number: int) -> None:
    """One page with its header and its number, at the painter's origin."""
    painter.save()
    painter.translate(0, -number * PAGE.height())
    pages.drawContents(painter, QRectF(0, number * PAGE.height(), PAGE.width(), PAGE.height()))
    painter.restore()
    font = QFont(pages.defaultFont())
    font.setPointSizeF(8)
    painter.setFont(font)
    painter.setPen(QColor("#555555"))
    left, right = Qt.AlignmentFlag.AlignLeft, Qt.AlignmentFlag.AlignRight
    line = QRectF(MARGIN, MARGIN / 2, PAGE.width() - 2 * MARGIN, 20)
    painter.drawText(line, left, pages.metaInformation(QTextDocument.MetaInformation.DocumentTitle))
    line.moveTop(PAGE.height() - MARGIN / 2 - 20)
    painter.drawText(line, right, f"Page {number + 1} of {pages.pageCount()}")


def _layout() -> QPageLayout:
    margins = QMarginsF(0, 0, 0, 0)  # the document has its own
    return QPageLayout(
        QPageSize(QPageSize.PageSizeId.A4), QPageLayout.Orientation.Portrait, margins, QPageLayout.Unit.Millimeter
    )


class Sheets(QWidget):
    """The pages below each other, drawn where they are in sight."""

    def __init__(self, pages: QTextDocument) -> None:
        super().__init__()
        self._pages = pages
        self.setAccessibleName("Pages")
        width, height = round(PAGE.width()), round(PAGE.height()) + GAP
        self.setFixedSize(width, height * pages.pageCount())

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        step = round(PAGE.height()) + GAP
        first, last = event.rect().top() // step, event.rect().bottom() // step
        for number in range(first, min(last, self._pages.pageCount() - 1) + 1):
            painter.save()
            painter.translate(0, number * step)
            painter.fillRect(QRectF(0, 0, PAGE.width(), PAGE.height()), Qt.GlobalColor.white)
            draw_page(painter, self._pages, number)
            painter.restore()


class PrintPreview(QDialog):
    """The pages as they will come out; saved as PDF, or opened in the PDF viewer of the system, which prints.

    The library of Qt that prints itself is left alone: once it is loaded, its types crash the program under an event
    filter, and the dialog of the system is native on some systems, where STOP does not hear its key.
    """

    said = Signal(str)

    def __init__(self, title: str, pages: QTextDocument, name: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setModal(False)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(title)
        self.setProperty("helpPage", "Program window")
        self.pages, self.suggested = pages, Path.home() / f"{name or 'program'}.pdf"
        self.sheets = QScrollArea()
        self.sheets.setWidget(Sheets(pages))
        self.sheets.setAlignment(Qt.AlignmentFlag.AlignHCenter)
        count = pages.pageCount()
        self.count = QLabel("1 page" if count == 1 else f"{count} pages")
        self.count.setProperty("role", "quiet")
        self.buttons = {
            text: self._button(text, action)
            for text, action in (
                ("Print", self.print_out),
                ("Save as PDF…", self.choose_file),
                ("Close", self.accept),
            )
        }
        self.buttons["Print"].setToolTip("Opens the pages in the PDF viewer of this computer, which prints them")
        *outs, away = self.buttons.values()
        self.progress, self.cancel = QProgressBar(), self._button("Cancel", self.stop_writing)
        self.progress.setAccessibleName("Pages written")
        self.progress.setRange(0, count)
        self._writing: Generator[int, None, None] | None = None
        self._written: Callable[[], str] = str
        self._name = ""
        self._next = QTimer(self, singleShot=True, interval=0)
        self._next.timeout.connect(self._write_page)
        row = QHBoxLayout()
        row.addWidget(self.count, 1)
        row.addWidget(self.progress, 1)
        row.addWidget(self.cancel)
        row.addWidget(foot(None, *outs, away=away))
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 16, 16, 16)
        column.setSpacing(12)
        column.addWidget(self.sheets, 1)
        column.addLayout(row)
        self._show_writing(False)
        self.resize(860, 760)

    def print_out(self) -> None:
        """Hands the pages to the PDF viewer."""
        path = Path(tempfile.mkdtemp(prefix="twoletter-print-")) / self.suggested.name
        self._write(path, partial(_opened, path))

    def choose_file(self) -> None:
        """Asks where the PDF goes."""
        files.ask_save(self, "Save as PDF", PDF, self.save, self.suggested, "pdf")

    def save(self, path: Path) -> None:
        """Writes the PDF and says so."""
        self._write(path, lambda: f"Saved {path.name}")

    def stop_writing(self) -> None:
        """Nothing is written; what was there before stays."""
        if self._writing is not None:
            self._next.stop()
            self._writing.close()
            self._ended("Cancelled: no file was written.")

    def done(self, result: int) -> None:
        self.stop_writing()
        super().done(result)

    def _write(self, path: Path, written: Callable[[], str]) -> None:
        """A few pages at once, many one after the other, so that the window goes on; `written` gives what to say."""
        if self._writing is not None:
            return
        self._writing, self._written, self._name = write_pages(self.pages, path), written, path.name
        few = self.pages.pageCount() <= FEW
        self._show_writing(not few)
        self._write_page()
        while few and self._writing is not None:
            self._write_page()

    def _write_page(self) -> None:
        if self._writing is None:
            return
        try:
            number = next(self._writing)
        except StopIteration:
            self._ended(self._written())
        except OSError as failure:
            self._ended(f"{self._name} cannot be written: {failure.strerror or failure}")
        else:
            self.progress.setValue(number)
            self._next.start()

    def _ended(self, words: str) -> None:
        self._writing = None
        self._next.stop()
        self._show_writing(False)
        self.said.emit(words)

    def _show_writing(self, on: bool) -> None:
        for widget in (self.progress, self.cancel):
            widget.setVisible(on)
        self.count.setVisible(not on)
        for text in ("Print", "Save as PDF…"):
            self.buttons[text].setEnabled(not on)

    def _button(self, text: str, action: Callable[[], object]) -> QPushButton:
        button = QPushButton(text)
        button.setMinimumHeight(look().control)
        button.setAutoDefault(False)
        button.clicked.connect(lambda: action())
        return button


def _opened(path: Path) -> str:
    """Opens a PDF in the viewer; what to say about it."""
    if QDesktopServices.openUrl(QUrl.fromLocalFile(str(path))):
        return "The pages are open in the PDF viewer; print them there."
    return "There is no program for PDF files on this computer; save as PDF and print it elsewhere."
