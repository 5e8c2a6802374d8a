"""The instructions to choose from: groups, search, a dot in the group's colour, and why one is not to be had."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QEvent, QMimeData, QObject, QSize, Qt, Signal
from PySide6.QtGui import QColor, QIcon, QKeyEvent, QPainter, QPixmap
from PySide6.QtWidgets import QAbstractItemView, QLabel, QLineEdit, QTreeWidget, QTreeWidgetItem, QVBoxLayout, QWidget

from codegen import read
from codegen.instructions import ALL, GROUPS, Instruction
from codegen.setup import Setup
from widgets.parts.look import look
from widgets.program.model import NEW_MIME

MODES = QIcon.Mode
STRENGTHS = ((MODES.Normal, 255), (MODES.Active, 255), (MODES.Selected, 255), (MODES.Disabled, 90))
KIND = Qt.ItemDataRole.UserRole
DOT = 10
LEAST = 100  # px: names of instructions can be told apart
HINT = "Enter or a double click opens the dialog; or drag an instruction into the program."


class PaletteTree(QTreeWidget):
    """Groups and instructions; an instruction can be dragged into the program."""

    def mimeTypes(self) -> list[str]:
        """What a drag carries."""
        return [NEW_MIME]

    def mimeData(self, items: Sequence[QTreeWidgetItem]) -> QMimeData:
        """The title of the dragged instruction."""
        data = QMimeData()
        kind = items[0].data(0, KIND) if items else None
        if kind is not None:
            data.setData(NEW_MIME, kind.title.encode())
        return data


class Palette(QWidget):
    """Emits the class of the instruction that was chosen with Enter or a double click."""

    chosen = Signal(object)
    pointed_at = Signal(str)  # what the instruction under the cursor is for
    title = "Instructions"

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName(self.title)
        self.search = QLineEdit()
        self.search.setPlaceholderText("Search (Ctrl+Shift+F)")
        self.search.setClearButtonEnabled(True)
        self.search.setMinimumHeight(look().control)
        self.search.setAccessibleName("Search instructions")
        self.search.textChanged.connect(self._filter)
        self.search.installEventFilter(self)
        self.tree = PaletteTree()
        self.tree.setHeaderHidden(True)
        self.tree.setAccessibleName("Instructions")
        self.tree.setIndentation(16)
        self.tree.setUniformRowHeights(True)
        self.tree.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.tree.setMinimumWidth(LEAST)
        self.tree.setDragDropMode(QAbstractItemView.DragDropMode.DragOnly)
        self.tree.itemActivated.connect(self._activated)
        self.tree.itemClicked.connect(self._clicked)
        self.tree.currentItemChanged.connect(self._current_changed)
        self.tree.setIconSize(QSize(DOT, DOT))
        self.about = QLabel(HINT)
        self.about.setProperty("role", "quiet")
        self.about.setWordWrap(True)
        self.about.setMinimumHeight(64)
        self.about.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.nothing = QLabel("No instruction matches. Try another word, or 2-Letter Code.")
        self.nothing.setProperty("role", "quiet")
        self.nothing.setWordWrap(True)
        self.nothing.hide()
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 8, 8, 8)
        column.setSpacing(8)
        for widget in (self.search, self.nothing, self.tree, self.about):
            column.addWidget(widget)
        column.setStretchFactor(self.tree, 1)
        self.items: dict[str, QTreeWidgetItem] = {}
        self.groups: dict[str, QTreeWidgetItem] = {}
        self._fill()

    # ---- what is offered

    def show_setup(self, setup: Setup) -> None:
        """Greys what this machine's controller cannot do, with the reason."""
        for kind in ALL:
            reason = read.cannot(kind, setup)
            item = self.items[kind.title]
            item.setDisabled(reason is not None)
            item.setToolTip(0, reason or kind.help)
            item.setData(
                0,
                Qt.ItemDataRole.AccessibleTextRole,
                f"{kind.title}, not available: {reason}" if reason else kind.title,
            )

    def focus_search(self) -> None:
        """Puts the cursor into the search."""
        self.search.setFocus(Qt.FocusReason.ShortcutFocusReason)
        self.search.selectAll()

    def recolour(self) -> None:
        """Takes the colours of the theme that is on now."""
        dots = {title: _dot(look().group(title)) for title in self.groups}
        for kind in ALL:
            self.items[kind.title].setIcon(0, dots[str(kind.group)])
        for title, item in self.groups.items():
            item.setIcon(0, dots[title])

    def changeEvent(self, event: QEvent) -> None:
        """Follows light and dark."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and hasattr(self, "groups"):
            self.recolour()

    # ---- choosing

    def _activated(self, item: QTreeWidgetItem) -> None:
        kind: type[Instruction] | None = item.data(0, KIND)
        if kind is not None and not item.isDisabled():
            self.chosen.emit(kind)

    def _clicked(self, item: QTreeWidgetItem) -> None:
        if item.data(0, KIND) is None:
            item.setExpanded(not item.isExpanded())

    def _current_changed(self, item: QTreeWidgetItem | None) -> None:
        kind = None if item is None else item.data(0, KIND)
        text = "" if kind is None or item is None else item.toolTip(0)
        self.about.setText(text or HINT)
        self.pointed_at.emit(text)
        self.setProperty("helpPage", kind.title if kind is not None else "Program window")

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """From the search, arrows walk the list and Enter takes what is marked."""
        if watched is self.search and isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            if event.key() in (Qt.Key.Key_Down, Qt.Key.Key_Up):
                self._walk(1 if event.key() == Qt.Key.Key_Down else -1)
                return True
            control = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)  # Ctrl+Enter: End of repeat
            if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and not control:
                current = self.tree.currentItem()
                if current is not None:
                    self.search.clear()
                    self._activated(current)
                return True
            if event.key() == Qt.Key.Key_Escape and self.search.text():
                self.search.clear()
                return True
        return super().eventFilter(watched, event)

    def _walk(self, by: int) -> None:
        shown = [item for item in self.items.values() if not item.isHidden() and not item.isDisabled()]
        if not shown:
            return
        current = self.tree.currentItem()
        at = shown.index(current) + by if current in shown else 0
        self.tree.setCurrentItem(shown[max(0, min(at, len(shown) - 1))])

    def _filter(self, text: str) -> None:
        words = text.lower().split()
        best: tuple[int, QTreeWidgetItem] | None = None
        for kind in ALL:
            item = self.items[kind.title]
            rank = _rank(kind, words)
            item.setHidden(rank is None)
            if rank is not None and not item.isDisabled() and (best is None or rank < best[0]):
                best = (rank, item)
        for group in self.groups.values():
            children = [group.child(row) for row in range(group.childCount())]
            group.setHidden(all(child.isHidden() for child in children))
            if words:
                group.setExpanded(True)
        self.nothing.setVisible(all(item.isHidden() for item in self.items.values()))
        if words and best is not None:
            self.tree.setCurrentItem(best[1])

    # ---- filling

    def _fill(self) -> None:
        for group in GROUPS:
            item = QTreeWidgetItem(self.tree, [str(group)])
            item.setFlags(Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable)
            font = item.font(0)
            font.setBold(True)
            item.setFont(0, font)
            item.setSizeHint(0, QSize(0, look().control))
            self.groups[str(group)] = item
        for kind in ALL:
            item = QTreeWidgetItem(self.groups[str(kind.group)], [kind.title])
            item.setData(0, KIND, kind)
            item.setToolTip(0, kind.help)
            item.setSizeHint(0, QSize(0, look().control))
            self.items[kind.title] = item
        for group_item in self.groups.values():
            group_item.setHidden(group_item.childCount() == 0)
        self.tree.expandAll()
        self.recolour()


def _rank(kind: type[Instruction], words: Sequence[str]) -> int | None:
    """How well an instruction answers a search: 0 is best, None not at all."""
    title = kind.title.lower()
    everything = f"{title} {str(kind.group).lower()} {kind.help.lower()}"
    if not all(word in everything for word in words):
        return None
    if words and title.startswith(" ".join(words)):
        return 0 if title == " ".join(words) else 1
    return 2 if all(word in title for word in words) else 3


def _dot(colour: QColor) -> QIcon:
    icon = QIcon()
    for mode, strength in STRENGTHS:
        picture = QPixmap(DOT * 2, DOT * 2)
        picture.setDevicePixelRatio(2)
        picture.fill(Qt.GlobalColor.transparent)
        painter = QPainter(picture)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        tone = QColor(colour)
        tone.setAlpha(strength)
        painter.setBrush(tone)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.drawEllipse(1, 1, DOT - 2, DOT - 2)
        painter.end()
        icon.addPixmap(picture, mode)
    return icon
