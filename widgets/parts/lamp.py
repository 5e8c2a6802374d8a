"""A lamp: filled or hollow, and the word beside it."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRect, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QSizePolicy, QWidget

from widgets.panel import set_tip
from widgets.parts.look import look


class Lamp(QAbstractButton):
    """One input or output: number, name, filled/hollow lamp and on/off. Clickable only when told so."""

    wanted = Signal(bool)  # the person wants it on (True) or off
    rename_wanted = Signal()

    def __init__(self, number: int, name: str = "", height: int | None = None, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._height = height
        self.number = number
        self._name = name
        self._on: bool | None = None
        self._stale = False
        self._switchable = self._renamable = False
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.clicked.connect(self._ask)
        self._tell()

    @property
    def name(self) -> str:
        """The name given in the setup, or nothing."""
        return self._name

    @property
    def words(self) -> str:
        """What the lamp says, in words."""
        state = "unknown" if self._on is None else "on" if self._on else "off"
        return f"{self.number} {self._name}".strip() + f", {state}" + (", stale" if self._stale else "")

    def show_name(self, name: str) -> None:
        """The name given in the setup."""
        if name != self._name:
            self._name = name
            self._tell()

    def show_level(self, on: bool | None, stale: bool = False) -> None:
        """On, off, or None when it is not known; stale values are greyed."""
        if (on, stale) != (self._on, self._stale):
            self._on, self._stale = on, stale
            self._tell()

    def show_switchable(self, switchable: bool, why_not: str = "") -> None:
        """Whether a click asks for the other level; otherwise the reason it does not."""
        set_tip(self, "Click to switch." if switchable else why_not)
        if switchable != self._switchable:
            self._switchable = switchable
            self._fit_focus()
            self.setCursor(Qt.CursorShape.PointingHandCursor if switchable else Qt.CursorShape.ArrowCursor)
            self.update()

    def show_renamable(self) -> None:
        """From now on F2 and its menu ask for another name."""
        self._renamable = True
        self._fit_focus()
        rename = self.addAction("Rename…\tF2")
        rename.triggered.connect(self.rename_wanted)
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.ActionsContextMenu)

    def name_place(self) -> QRect:
        """Where its name is written, for an editor over it."""
        return self.rect().adjusted(26, 0, 0, 0)

    def sizeHint(self) -> QSize:
        return QSize(112, self._height or look().control)

    def minimumSizeHint(self) -> QSize:
        return QSize(84, self._height or look().control)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if self._renamable and event.key() == Qt.Key.Key_F2:
            self.rename_wanted.emit()
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        rect = QRectF(self.rect()).adjusted(1.5, 1.5, -1.5, -1.5)
        if self._switchable:
            painter.setPen(QPen(look().colour("focus" if self.hasFocus() else "border"), 2 if self.hasFocus() else 1))
            painter.setBrush(look().colour("sunken" if self.isDown() else "raised"))
            painter.drawRoundedRect(rect, 4, 4)
        elif self.hasFocus():
            painter.setPen(QPen(look().colour("focus"), 2))
            painter.drawRoundedRect(rect, 4, 4)
        self._paint_lamp(painter, QPointF(rect.left() + 14, rect.center().y()))
        self._paint_words(painter, rect.adjusted(28, 0, -8, 0))

    def _paint_lamp(self, painter: QPainter, centre: QPointF) -> None:
        colour = self._colour()
        painter.setPen(QPen(colour, 1.8))
        painter.setBrush(colour if self._on else Qt.BrushStyle.NoBrush)
        if self._on is None:
            painter.setPen(QPen(colour, 1.8, Qt.PenStyle.DotLine))
        painter.drawEllipse(centre, 6.5, 6.5)

    def _paint_words(self, painter: QPainter, rect: QRectF) -> None:
        state = "?" if self._on is None else "on" if self._on else "off"
        bold = painter.font()
        bold.setBold(bool(self._on))
        painter.setFont(bold)
        painter.setPen(look().colour("stale" if self._stale else "text" if self._on else "quiet"))
        width = painter.fontMetrics().horizontalAdvance("off ")
        painter.drawText(rect, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight, state)
        name = f"{self.number}  {self._name}".rstrip()
        room = rect.adjusted(0, 0, -width - 4, 0)
        painter.setPen(look().colour("stale" if self._stale else "text"))
        painter.drawText(
            room,
            Qt.AlignmentFlag.AlignVCenter,
            painter.fontMetrics().elidedText(name, Qt.TextElideMode.ElideRight, int(room.width())),
        )

    def _colour(self) -> QColor:
        if self._stale or self._on is None:
            return look().colour("stale")
        return look().colour("ok" if self._on else "quiet")

    def _fit_focus(self) -> None:
        reached = self._switchable or self._renamable
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus if reached else Qt.FocusPolicy.NoFocus)

    def _ask(self) -> None:
        if self._switchable:
            self.wanted.emit(not self._on)

    def _tell(self) -> None:
        self.setAccessibleName(self.words)
        self.update()
