"""Code on paper: numbered lines under the name of the file."""

from __future__ import annotations

from html import escape

from PySide6.QtWidgets import QWidget

from codegen.document import Document
from codegen.program import Program
from widgets.program.printing import PrintPreview, make_pages


def preview(parent: QWidget, name: str, text: str, date: str) -> PrintPreview:
    """The pages as they will come out."""
    lines = "".join(f"{number:>4}  {escape(line)}\n" for number, line in enumerate(text.split("\n")))
    html = f"<h1>{escape(name)}</h1><p class='quiet'>printed {date}</p><pre style='white-space: pre-wrap'>{lines}</pre>"
    return PrintPreview("Print code", make_pages(html, Document(program=Program(name=name))), name, parent)
