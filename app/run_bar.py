"""Above the program: Download, Execute, Halt, Burn, Upload, and whether the controller holds this program."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QResizeEvent, QShowEvent
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QToolBar, QWidget

from app.header import ALONE, UNDER, show_texts, tool_bar, width_of
from app.held import Held, Holding
from widgets.panel import show_role

BADGES = {
    Holding.SAME: (
        "ok",
        "✓ In the controller",
        "✓ Same",
        "The controller holds exactly the open program: what was read from it is the same line by line. "
        "Execute runs it.",
    ),
    Holding.EARLIER: (
        "warning",
        "≠ Changed since",
        "≠ Changed",
        "The controller holds {held}, before the changes since. Execute asks which one is meant; Download sends it.",
    ),
    Holding.SLOWED: (
        "warning",
        "◔ Slowed to {percent} %",
        "◔ Slow {percent} %",
        "The controller holds {held}. Execute asks before it goes back to full speed; it cannot be burned.",
    ),
    Holding.OTHER: (
        "warning",
        "≠ Another program",
        "≠ Other",
        "The controller holds {held}. Execute belongs to the verified one: it asks before anything runs.",
    ),
    Holding.EMPTY: ("warning", "○ No program", "○ Empty", "There is no program in the controller: download this one."),
    Holding.UNKNOWN: (
        "quiet",
        "? Not known",
        "? Not known",
        "What is in the controller is not known: download, or upload to look at it.",
    ),
}

EEPROM = {True: ", burned", False: ", not burned", None: ", EEPROM unknown"}
BESIDE = Qt.ToolButtonStyle.ToolButtonTextBesideIcon
ROOM = 48  # px: margins and the space between


class RunBar(QWidget):
    """Its buttons are filled from the action rows."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.toolbar: QToolBar = tool_bar()
        self.toolbar.setObjectName("run")
        self.toolbar.setIconSize(QSize(20, 20))
        self.toolbar.setToolButtonStyle(BESIDE)
        self.badge = QPushButton()
        self.badge.setAutoDefault(False)
        self._widths: dict[Qt.ToolButtonStyle, int] = {}  # px of the buttons, texts beside or under the pictures
        self._shown: Held | None = None
        self._eeprom: bool | None = None
        self._eeprom_words = ""
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 12, 0)
        row.setSpacing(8)
        row.addWidget(self.toolbar)
        row.addStretch(1)
        row.addWidget(self.badge)
        self.badge.setMinimumWidth(0)

    def show_held(self, held: Held | None) -> None:
        """None: nothing is connected, nothing to compare with."""
        if held != self._shown:
            self._shown = held
            self._show_badge()

    def show_eeprom(self, same: bool | None, words: str) -> None:
        """Whether the EEPROM holds what the controller holds (None: not known), and that in a sentence."""
        if (same, words) != (self._eeprom, self._eeprom_words):
            self._eeprom, self._eeprom_words = same, words
            self._show_badge()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._show_badge()

    def showEvent(self, event: QShowEvent) -> None:
        """The buttons are never cut off: their texts are what is pressed."""
        super().showEvent(event)
        if not self._widths:
            self._widths = {style: self._width_with(style) for style in (ALONE, UNDER, BESIDE)}
        self._show_badge()

    def _width_with(self, style: Qt.ToolButtonStyle) -> int:
        show_texts(self.toolbar, style)
        return width_of(self.toolbar)

    def minimumSizeHint(self) -> QSize:
        """Room for the pictures and the sign of the badge."""
        return QSize(self._widths.get(ALONE, 0) + ROOM, super().minimumSizeHint().height())

    def _fitting(self, words: str, short: str) -> tuple[Qt.ToolButtonStyle, str]:
        """Texts beside the pictures and the badge in full, where there is room for that."""
        metrics, room = self.badge.fontMetrics(), self.width() - ROOM
        for style, texts in ((BESIDE, (words, short)), (UNDER, (words, short, short[:1])), (ALONE, (words, short))):
            for text in texts:
                if self._widths.get(style, 0) + metrics.horizontalAdvance(text) <= room:
                    return style, text
        return ALONE, short[:1]

    def _show_badge(self) -> None:
        """What the controller holds, in as many words as there is room for."""
        held = self._shown
        role, words, short, help_text = BADGES[held.holding] if held is not None else ("quiet", "", "", "")
        percent = held.percent if held is not None else 0
        words, short = words.format(percent=percent), short.format(percent=percent)
        if held is not None and held.holding is Holding.SAME:
            words, short = f"{words}{EEPROM[self._eeprom]}", f"{short}{EEPROM[self._eeprom]}"
            role = role if self._eeprom is not False else "warning"
        style, text = self._fitting(words, short)
        show_texts(self.toolbar, style)
        if text != self.badge.text():
            self.badge.setText(text)
        self.badge.setVisible(held is not None)
        about = help_text.format(held=held.words) if held is not None else ""
        self.badge.setToolTip(f"{about}\n{self._eeprom_words}\nClick: compare file, controller and EEPROM (F6)")
        self.badge.setAccessibleName(f"Program in the controller: {words}")
        show_role(self.badge, f"badge_{role}")
