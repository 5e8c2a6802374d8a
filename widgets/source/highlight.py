"""Colours for two-letter source, from the parser's own tokens; one line at a time."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import lru_cache

from PySide6.QtGui import QFont, QSyntaxHighlighter, QTextBlock, QTextCharFormat, QTextDocument

from codegen.twoletter.commands import COMMANDS
from widgets.parts.look import look

# The order counts: comments and texts first, so that nothing inside them is taken for a command.
PARTS = re.compile(
    r"(?P<comment>(?:^|(?<=;))\s*(?:NO\b|REM\b|').*$)"
    r"|(?P<variable>(?:^|(?<=;))\s*(?![A-Z]{2}[XYZW]=)[A-Za-z][A-Za-z0-9]{0,7}(?:\[[^\]]*\])?\s*(?==))"
    r"|(?P<string>\"[^\"]*\"?)"
    r"|(?P<label>#[A-Za-z][A-Za-z0-9]{0,6})"
    r"|(?P<operand>_[A-Z]{2}[A-Z0-9]?|@[A-Z]{2,4})"
    r"|(?P<command>(?:^|(?<=;))\s*[A-Z]{2}(?=$|[^A-Za-z0-9_=\[]|\d|[XYZWS]+\b))"
    r"|(?P<number>\$[0-9A-F]+|(?<![A-Za-z0-9_])\d+(?:\.\d+)?)"
)
EVERYTHING = range(1_000_000)
COLOURS = {
    "comment": "code_comment",
    "string": "code_string",
    "label": "code_label",
    "operand": "code_command",
    "command": "code_command",
    "variable": "text",
    "error": "code_error",
    "number": "code_number",
}


@lru_cache(maxsize=4096)
def parts_of(text: str) -> tuple[tuple[int, int, str], ...]:
    """What has a colour in a line: first column, length, kind; lines come again and again."""
    found = []
    for part in PARTS.finditer(text):
        kind = part.lastgroup or ""
        if kind == "command" and part.group().strip() not in COMMANDS:
            kind = "error"
        found.append((part.start(), part.end() - part.start(), kind))
    return tuple(found)


class Highlighter(QSyntaxHighlighter):
    """Colours commands, labels, numbers, texts and comments of the lines in sight."""

    def __init__(self, document: QTextDocument, sight: Callable[[], range] = lambda: EVERYTHING) -> None:
        super().__init__(document)
        self._sight = sight
        self._formats: dict[str, QTextCharFormat] = {}

    def highlightBlock(self, text: str) -> None:
        """Colours one line in sight. Its shapes are kept, which marks it too; others wait until they are seen."""
        block = self.currentBlock()
        seen = block.blockNumber() in self._sight()
        block.layout().setCacheEnabled(seen)
        if not seen:
            return
        for start, count, kind in parts_of(text):
            self.setFormat(start, count, self._format(kind))

    def colour(self, block: QTextBlock, end: int) -> None:
        """Colours what has come into sight, from a line up to a number (exclusive)."""
        while block.isValid() and block.blockNumber() < end:
            if not block.layout().cacheEnabled():
                self.rehighlightBlock(block)
            block = block.next()

    def recolour(self) -> None:
        """Takes the colours of the theme that is on now."""
        self._formats.clear()
        self.rehighlight()

    def _format(self, kind: str) -> QTextCharFormat:
        if kind not in self._formats:
            format_ = QTextCharFormat()
            format_.setForeground(look().colour(COLOURS[kind]))
            if kind == "label":
                format_.setFontWeight(QFont.Weight.Bold)
            if kind == "comment":
                format_.setFontItalic(True)
            self._formats[kind] = format_
        return self._formats[kind]
