"""Help pages: a list with search on the left, the page on the right, links in between."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QSignalBlocker, Qt, QUrl, Signal
from PySide6.QtGui import QKeySequence, QShortcut, QTextBlock, QTextCursor
from PySide6.QtWidgets import (
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QListWidget,
    QPushButton,
    QSplitter,
    QTextBrowser,
    QTextEdit,
    QVBoxLayout,
    QWidget,
)

from widgets.help.search import Word, pages_with, words_of
from widgets.parts.icons import icon
from widgets.parts.look import look


def _is_entry(block: QTextBlock) -> bool:
    return block.blockFormat().headingLevel() > 0 or block.textList() is not None


def _blocks(browser: QTextBrowser) -> list[QTextBlock]:
    block, found = browser.document().begin(), []
    while block.isValid():
        found.append(block)
        block = block.next()
    return found


class HelpPanel(QWidget):
    """Shows pages of Markdown by their title; `[words](page:Title)` leads to another page."""

    opened = Signal(str)
    title = "Help"

    def __init__(
        self,
        pages: Mapping[str, str],
        also: Mapping[str, tuple[str, ...]] | None = None,
        parent: QWidget | None = None,
    ) -> None:
        """`also`: words people type, and those that the pages use for the same."""
        super().__init__(parent)
        self.setAccessibleName(self.title)
        self.pages = dict(pages)
        self.also = dict(also or {})
        self.words: list[Word] = []
        self.past: list[str] = []
        self.page = ""
        self.search = QLineEdit()
        self.search.setPlaceholderText("Search help")
        self.search.setClearButtonEnabled(True)
        self.search.setMinimumHeight(look().control)
        self.search.setAccessibleName("Search help")
        self.search.textChanged.connect(self._filter)
        self.search.returnPressed.connect(lambda: self.list.setCurrentRow(0))
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
        self.back.setAutoDefault(False)  # Enter belongs to the search
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
            self._scroll_to_block(block)

    def _scroll_to_block(self, block: QTextBlock) -> None:
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
        if not found:  # what was looked for leaves it out
            self.search.clear()
            found = self.list.findItems(page, Qt.MatchFlag.MatchExactly)
        if self.list.currentItem() is not found[0]:
            with QSignalBlocker(self.list):
                self.list.setCurrentItem(found[0])
        self._mark()
        self.opened.emit(page)

    def _picked(self, page: str) -> None:
        if page and page != self.page:
            self.open(page)
            self._scroll_to_words()

    def _link(self, url: QUrl) -> None:
        target = url.toString(QUrl.ComponentFormattingOption.FullyDecoded)
        for prefix in ("page:", "#"):
            target = target.removeprefix(prefix)
        self.open(target.removesuffix(".md"))

    def _filter(self, text: str) -> None:
        """Only pages that hold the words, the best first."""
        self.words = words_of(text, self.also)
        titles = pages_with(self.words, self.pages) if self.words else sorted(self.pages, key=str.lower)
        with QSignalBlocker(self.list):
            self.list.clear()
            self.list.addItems(titles)
            if self.page in titles:
                self.list.setCurrentRow(titles.index(self.page))
        self.none.setVisible(not titles)
        self._mark()

    def _mark(self) -> None:
        """The words that were looked for, on their ground colour."""
        marks = []
        for word in self.words:
            for block in _blocks(self.browser):
                for found in word.pattern.finditer(block.text()):
                    mark = QTextEdit.ExtraSelection()
                    mark.cursor = QTextCursor(block)
                    mark.cursor.setPosition(block.position() + found.start())
                    mark.cursor.setPosition(block.position() + found.end(), QTextCursor.MoveMode.KeepAnchor)
                    mark.format.setBackground(look().colour("executing"))
                    marks.append(mark)
        self.browser.setExtraSelections(marks)

    def _scroll_to_words(self) -> None:
        """To the heading, else to the paragraph that says most of the words; the top where the title does."""
        blocks = _blocks(self.browser)[1:]
        weights = [
            (sum(word.weight(block.text()) for word in self.words), block.blockFormat().headingLevel() > 0)
            for block in blocks
        ]
        best = max(weights, default=(0, False))
        if best[0]:
            self._scroll_to_block(blocks[weights.index(best)])
