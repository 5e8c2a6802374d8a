"""Pictures in a page of text, no wider than the page."""

from __future__ import annotations

from PySide6.QtCore import QUrl
from PySide6.QtGui import QImage, QTextCursor, QTextDocument
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
            found = browser.loadResource(QTextDocument.ResourceType.ImageResource.value, QUrl(picture.name()))
            image = QImage.fromData(found) if found is not None else QImage()
            if image.isNull() or image.width() <= room:
                continue
            picture.setWidth(room)
            picture.setHeight(round(room * image.height() / image.width()))
            cursor = QTextCursor(browser.document())
            cursor.setPosition(fragment.position())
            cursor.setPosition(fragment.position() + fragment.length(), QTextCursor.MoveMode.KeepAnchor)
            cursor.setCharFormat(picture)
        block = block.next()
