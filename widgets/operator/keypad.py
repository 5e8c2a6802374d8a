"""The keys of the terminal: each shows what it sends alone, with SHIFT and with CTRL."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtWidgets import QGridLayout, QPushButton, QSizePolicy, QWidget

from device.terminal1500 import CONTROL, SHIFT, Key
from widgets.parts.look import look

NAMES = {" ": "SPACE", "\x1b": "ESC"}
CORNER = 6  # px


def shown(code: int) -> str:
    """A character as a key cap has it: "A", "ESC", "^R" for control codes, nothing for 0."""
    character = chr(code)
    if not code:
        return ""
    return NAMES.get(character) or (f"^{chr(code + 64)}" if code < 32 else character)


class Cap(QPushButton):
    """One key; the name large, SHIFT above left, CTRL above right."""

    def __init__(self, key: Key, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.key = key
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        shifted, controlled = shown(key.shifted), shown(key.controlled)
        own = key.name if key.alone or key.name in (SHIFT, CONTROL) else ""
        self.setAccessibleName(own or shifted)
        parts = [own, f"SHIFT {shifted}" if shifted else "", f"CTRL {controlled}" if controlled else ""]
        if key.name not in (SHIFT, CONTROL):
            self.setToolTip(", ".join(part for part in parts if part))

    def sizeHint(self) -> QSize:
        return QSize(58, look().space["touch"] + 8)

    def minimumSizeHint(self) -> QSize:
        return QSize(44, look().space["touch"] + 8)

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        painter = QPainter(self)
        usable = self.isEnabled()
        room = QRectF(self.rect()).adjusted(CORNER, 3, -CORNER, -4)
        own = self.key.name if self.key.alone or self.key.name in (SHIFT, CONTROL) else ""
        small = look().small_font()
        painter.setFont(small)
        painter.setPen(look().colour("accent" if usable else "disabled"))
        if self.key.name not in (SHIFT, CONTROL):
            painter.drawText(room, Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignLeft, shown(self.key.shifted))
            painter.setPen(look().colour("group_servo" if usable else "disabled"))
            painter.drawText(room, Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignRight, shown(self.key.controlled))
        font = look().body_font()
        font.setBold(True)
        if len(own) > 2:
            font.setPointSizeF(small.pointSizeF())
        painter.setFont(font)
        painter.setPen(look().colour("selection_text" if self.isChecked() else "text" if usable else "disabled"))
        low = room.adjusted(-CORNER + 2, 12, CORNER - 2, 0)
        painter.drawText(low, Qt.AlignmentFlag.AlignCenter, own)


class Keypad(QWidget):
    """All keys in their rows; SHIFT and CTRL stay down until the next key."""

    pressed = Signal(object, bool, bool)  # Key, shift, control

    def __init__(self, keys: tuple[tuple[Key, ...], ...], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(4)
        self.caps: dict[str, Cap] = {}
        self._shift: list[Cap] = []
        self._control: list[Cap] = []
        for row, line in enumerate(keys):
            for column, key in enumerate(line):
                cap = Cap(key, self)
                grid.addWidget(cap, row, column)
                self.caps.setdefault(cap.accessibleName(), cap)
                if key.name in (SHIFT, CONTROL):
                    cap.setCheckable(True)
                    (self._shift if key.name == SHIFT else self._control).append(cap)
                else:
                    cap.clicked.connect(partial(self._press, key))

    def _press(self, key: Key) -> None:
        shift = any(cap.isChecked() for cap in self._shift)
        control = any(cap.isChecked() for cap in self._control)
        for cap in (*self._shift, *self._control):
            cap.setChecked(False)
        self.pressed.emit(key, shift, control)
