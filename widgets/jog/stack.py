"""Pages of which one is open."""

from __future__ import annotations

from PySide6.QtCore import QSize
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QStackedWidget


class Stack(QStackedWidget):
    """As high as the open page needs at its width, not as the highest."""

    def sizeHint(self) -> QSize:
        page = self.currentWidget()
        return self._high(page.sizeHint()) if page is not None else super().sizeHint()

    def minimumSizeHint(self) -> QSize:
        page = self.currentWidget()
        return self._high(page.minimumSizeHint()) if page is not None else super().minimumSizeHint()

    def hasHeightForWidth(self) -> bool:
        """The layout of all pages would be asked then."""
        return False

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if event.oldSize().width() != event.size().width():
            self.updateGeometry()

    def _high(self, size: QSize) -> QSize:
        page = self.currentWidget()
        if page.hasHeightForWidth():
            size.setHeight(page.heightForWidth(max(self.width(), size.width())))
        return size
