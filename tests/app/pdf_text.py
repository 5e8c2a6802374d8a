"""The words in a PDF file as Qt writes it: every string that is drawn, by its font's own table of letters."""

from __future__ import annotations

import re
import zlib
from pathlib import Path

OBJECT = re.compile(rb"(\d+) 0 obj\s*(.*?)endobj", re.DOTALL)
STREAM = re.compile(rb"stream\r?\n(.*?)\r?\nendstream", re.DOTALL)
DRAWN = re.compile(r"/(F\d+) [\d.-]+ Tf|<([0-9a-fA-F]+)>")
LETTER = re.compile(r"<([0-9a-fA-F]{4})> <([0-9a-fA-F]{4})> <([0-9a-fA-F]+)>")


def pdf_text(path: Path) -> str:
    """Everything that is written on the pages, in the order in which it is drawn."""
    data = path.read_bytes()
    assert data.startswith(b"%PDF") and data.rstrip().endswith(b"%%EOF")
    objects = {int(number): body for number, body in OBJECT.findall(data)}
    fonts: dict[str, dict[str, str]] = {}
    for name, number in re.findall(rb"/(F\d+) (\d+) 0 R", data):
        table = re.search(rb"/ToUnicode (\d+) 0 R", objects[int(number)])
        assert table is not None
        fonts[name.decode()] = _letters(_stream(objects[int(table.group(1))]))
    words = []
    for body in objects.values():
        text = _stream(body)
        font: dict[str, str] = {}
        for name, drawn in DRAWN.findall(text) if " Tf" in text else ():
            font = fonts[name] if name else font
            words += [font.get(drawn[at : at + 4].lower(), "") for at in range(0, len(drawn), 4)]
    return "".join(words).replace("\t", " ").replace("\u00a0", " ")  # a blank and a tabulator are one glyph


def _stream(body: bytes) -> str:
    found = STREAM.search(body)
    if found is None or b"/Image" in body:
        return ""
    raw = zlib.decompress(found.group(1)) if b"FlateDecode" in body else found.group(1)
    return raw.decode("latin-1")


def _letters(table: str) -> dict[str, str]:
    """Glyph to letter: ranges of one or more, in hexadecimal."""
    found = {}
    for first, last, letter in LETTER.findall(table):
        for step in range(int(last, 16) - int(first, 16) + 1):
            found[f"{int(first, 16) + step:04x}"] = chr(int(letter[:4], 16) + step)
    for first, _, letters in re.findall(r"<([0-9a-fA-F]{4})> <([0-9a-fA-F]{4})> \[(.*?)\]", table, re.DOTALL):
        for step, letter in enumerate(re.findall(r"<([0-9a-fA-F]+)>", letters)):
            found[f"{int(first, 16) + step:04x}"] = chr(int(letter[:4], 16))
    return found
