"""The report of an axis on paper: every step, what was found, the figures, and room for a signature."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

from PySide6.QtGui import QTextDocument

from codegen.document import Document
from widgets.commissioning.page import MARK_WORDS
from widgets.program.printing import make_pages

SIGNS = {"passed": "✓", "failed": "✗", "skipped": "–", "open": "○"}


@dataclass(frozen=True)
class Line:
    """One step in the report."""

    title: str
    mark: str
    sentence: str
    facts: tuple[tuple[str, str], ...] = ()
    advice: tuple[str, ...] = ()
    when: str = ""
    source: str = ""


def report_pages(
    document: Document, title: str, about: Sequence[tuple[str, str]], lines: Sequence[Line]
) -> QTextDocument:
    """`about` is the axis, its controller, the date; `title` stands on top of each page."""
    done = sum(line.mark == "passed" for line in lines)
    state = f"{done} of {len(lines)} steps passed"
    facts = "".join(
        f"<tr><td class='quiet' width='28%'>{escape(name)}</td><td>{escape(text)}</td></tr>"
        for name, text in (*about, ("State", state))
        if text
    )
    rows = "".join(map(_row, lines))
    html = (
        f"<h1>{escape(title)}</h1><table width='100%' cellspacing='0' cellpadding='3'>{facts}</table>"
        f"<p style='font-size: 5pt'>&nbsp;</p><table width='100%' cellspacing='0' cellpadding='4'>{rows}</table>"
        "<p style='font-size: 20pt'>&nbsp;</p>"
        "<table width='100%'><tr><td width='50%'>Date: ______________________</td>"
        "<td>Commissioned by: ______________________</td></tr></table>"
    )
    pages = make_pages(html, document)
    pages.setMetaInformation(QTextDocument.MetaInformation.DocumentTitle, title)
    return pages


def _row(line: Line) -> str:
    facts = "; ".join(f"{name}: {text}" for name, text in line.facts)
    advice = "".join(f"<br/>• {escape(each)}" for each in line.advice) if line.mark == "failed" else ""
    figures = f"<br/><span class='quiet'>{escape(facts)}</span>" if facts else ""
    when = f"<br/><span class='quiet'>{escape(line.when)}</span>" if line.when else ""
    found = f"{escape(line.sentence)}{advice}{figures}<br/><span class='quiet'><i>{escape(line.source)}</i></span>"
    return (
        "<tr><td colspan='3' style='font-size: 4pt'>&nbsp;</td></tr>"
        f"<tr><td width='5%'><b>{SIGNS[line.mark]}</b></td>"
        f"<td width='25%'><b>{escape(line.title)}</b><br/>{MARK_WORDS[line.mark]}{when}</td><td>{found}</td></tr>"
    )
