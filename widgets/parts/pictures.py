"""Pictures in a page of text, no wider than the page."""

from __future__ import annotations

from PySide6.QtCore import QBuffer, QByteArray, QSize, QUrl
from PySide6.QtGui import QImage, QImageReader, QPixmap, QTextCursor, QTextDocument
from PySide6.QtWidgets import QTextBrowser

MARGIN = 48  # px beside a picture


def fit_pictures(browser: QTextBrowser) -> None:
    """Makes every picture as wide as the page at most; called after a page was shown."""
    room = browser.viewport().width() - MARGIN
    block = browser.document().begin()
    while block.isValid():
        for fragment in (each.fragment() for each in block):
            shape = fragment.charFormat()
            if not shape.isImageFormat():
                continue
            picture = shape.toImageFormat()
            kind = QTextDocument.ResourceType.ImageResource.value
            size = size_of(browser.document().resource(kind, QUrl(picture.name())))
            if size.width() <= room:
                continue
            picture.setWidth(room)
            picture.setHeight(round(room * size.height() / size.width()))
            cursor = QTextCursor(browser.document())
            cursor.setPosition(fragment.position())
            cursor.setPosition(fragment.position() + fragment.length(), QTextCursor.MoveMode.KeepAnchor)
            cursor.setCharFormat(picture)
        block = block.next()


def size_of(found: object) -> QSize:
    """Of a picture as the document has it: painted already, or a file of which only the head is read."""
    if isinstance(found, QPixmap | QImage):
        return found.size()
    if not isinstance(found, QByteArray):
        return QSize()
    buffer = QBuffer(found)
    return QImageReader(buffer).size()
