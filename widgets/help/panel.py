"""Help pages: a list with search on the left, the page on the right, links in between."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import Qt, QUrl, Signal
from PySide6.QtGui import QKeySequence, QShortcut, QTextBlock, QTextCursor
from PySide6.QtWidgets import (
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QListWidget,
    QPushButton,
    QSplitter,
    QTextBrowser,
    QVBoxLayout,
    QWidget,
)

from widgets.parts.icons import icon
from widgets.parts.look import look


def _is_entry(block: QTextBlock) -> bool:
    return block.blockFormat().headingLevel() > 0 or block.textList() is not None


class HelpPanel(QWidget):
    """Shows pages of Markdown by their title; `[words](page:Title)` leads to another page."""

    opened = Signal(str)
    title = "Help"

    def __init__(self, pages: Mapping[str, str], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName(self.title)
        self.pages = dict(pages)
        self.past: list[str] = []
        self.page = ""
        self.search = QLineEdit()
        self.search.setPlaceholderText("Search help")
        self.search.setClearButtonEnabled(True)
        self.search.setMinimumHeight(look().control)
        self.search.setAccessibleName("Search help")
        self.search.textChanged.connect(self._filter)
        self.list = QListWidget()
        self.list.setAccessibleName("Help pages")
        self.list.addItems(sorted(self.pages, key=str.lower))
        self.list.currentTextChanged.connect(self._picked)
        self.none = QLabel("No page has these words.")
        self.none.setProperty("role", "quiet")
        self.none.hide()
        self.browser = QTextBrowser()
        self.browser.setOpenLinks(False)
        self.browser.setAccessibleName("Help page")
        self.browser.anchorClicked.connect(self._link)
        self.browser.document().setDocumentMargin(16)
        self.back = QPushButton(icon("left"), "Back")
        self.back.setMinimumHeight(look().control)
        self.back.setEnabled(False)
        self.back.setToolTip("The page before (Alt+Left)")
        self.back.clicked.connect(self.go_back)
        back = QShortcut(QKeySequence("Alt+Left"), self, activated=self.go_back)
        back.setContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
        self._lay_out()

    def _lay_out(self) -> None:
        left = QWidget()
        column = QVBoxLayout(left)
        column.setContentsMargins(8, 8, 0, 8)
        for widget in (self.search, self.none, self.list):
            column.addWidget(widget)
        right = QWidget()
        pages = QVBoxLayout(right)
        pages.setContentsMargins(0, 8, 8, 8)
        bar = QHBoxLayout()
        bar.addWidget(self.back)
        bar.addStretch(1)
        pages.addLayout(bar)
        pages.addWidget(self.browser)
        splitter = QSplitter()
        splitter.addWidget(left)
        splitter.addWidget(right)
        splitter.setStretchFactor(1, 1)
        splitter.setSizes([220, 560])
        whole = QVBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.addWidget(splitter)

    def open(self, page: str) -> bool:
        """Shows a page, `Title` or `Title#part of a heading`; says whether there is one of that name."""
        title, _, part = (page, "", "") if page in self.pages else page.partition("#")
        if title not in self.pages:
            return False
        if self.page and title != self.page:
            self.past.append(self.page)
        self._show(title)
        if part:
            self._scroll_to(part)
        return True

    def _scroll_to(self, part: str) -> None:
        """The heading or the entry of a list that begins so, at the top."""
        block = self.browser.document().begin()
        while block.isValid() and not (_is_entry(block) and block.text().startswith(part)):
            block = block.next()
        if block.isValid():
            self.browser.setTextCursor(QTextCursor(block))
            place = self.browser.document().documentLayout().blockBoundingRect(block).top()
            self.browser.verticalScrollBar().setValue(int(place))

    def go_back(self) -> None:
        """The page before."""
        if self.past:
            self._show(self.past.pop())

    def _show(self, page: str) -> None:
        self.page = page
        self.browser.setMarkdown(self.pages[page])
        self.back.setEnabled(bool(self.past))
        found = self.list.findItems(page, Qt.MatchFlag.MatchExactly)
        if found and self.list.currentItem() is not found[0]:
            self.list.blockSignals(True)
            self.list.setCurrentItem(found[0])
            self.list.blockSignals(False)
        self.opened.emit(page)

    def _picked(self, page: str) -> None:
        if page and page != self.page:
            self.open(page)

    def _link(self, url: QUrl) -> None:
        target = url.toString(QUrl.ComponentFormattingOption.FullyDecoded)
        for prefix in ("page:", "#"):
            target = target.removeprefix(prefix)
        self.open(target.removesuffix(".md"))

    def _filter(self, text: str) -> None:
        words = text.lower().split()
        shown = 0
        for row in range(self.list.count()):
            item = self.list.item(row)
            everything = f"{item.text()} {self.pages[item.text()]}".lower()
            hit = all(word in everything for word in words)
            item.setHidden(not hit)
            shown += hit
        self.none.setVisible(not shown)
