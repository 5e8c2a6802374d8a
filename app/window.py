"""The main window: header, docks, centre, status bar and title. It decides nothing."""

from __future__ import annotations

from itertools import pairwise

from PySide6.QtCore import QByteArray, Qt, QTimer, Signal
from PySide6.QtGui import QCloseEvent, QShowEvent
from PySide6.QtWidgets import QMainWindow, QMenu, QTabBar, QVBoxLayout, QWidget

from app.docks import Dock
from app.header import Header
from app.run_bar import RunBar
from app.status import Status
from device.api import Kind, StopState
from widgets.panel import Panel
from widgets.parts.kind import WORDS
from widgets.terminal.prompt import PromptBox

LEFT, RIGHT, BOTTOM = (
    Qt.DockWidgetArea.LeftDockWidgetArea,
    Qt.DockWidgetArea.RightDockWidgetArea,
    Qt.DockWidgetArea.BottomDockWidgetArea,
)
VERSION = 1  # of the arrangement that is remembered


class Window(QMainWindow):
    """Everything it shows is handed to it."""

    stop = Signal()
    first_shown = Signal()
    came = Signal(object)  # a panel that has come to the front
    closing = Signal(object)  # the QCloseEvent; the owner may ignore it

    def __init__(self, centre: QWidget) -> None:
        super().__init__()
        self.setDockNestingEnabled(True)
        self.setAnimated(False)  # each step would lay out and paint everything, diagrams included
        for corner, area in ((Qt.Corner.BottomLeftCorner, LEFT), (Qt.Corner.BottomRightCorner, RIGHT)):
            self.setCorner(corner, area)
        self.setTabPosition(Qt.DockWidgetArea.AllDockWidgetAreas, self.tabPosition(BOTTOM).North)
        self.header, self.status, self.run_bar, self.prompt = Header(), Status(), RunBar(), PromptBox()
        self.header.stop.stop.connect(self.stop)
        self.setMenuWidget(self.header)
        self.setStatusBar(self.status)
        self.docks: dict[str, Dock] = {}
        self.submenus = {
            "recent": QMenu("Open recent"),
            "panels": QMenu("Panels"),
            "floats": QMenu("Panel in a window of its own"),
            "slow": QMenu("Execute slowed"),
            "examples": QMenu("Examples"),
        }
        self._areas: dict[Qt.DockWidgetArea, list[Dock]] = {}
        self._was_shown = False
        self._titles = QTimer(self)
        self._titles.setSingleShot(True)
        self._titles.setInterval(0)
        self._titles.timeout.connect(self.show_titles)
        self._shown: tuple[str, Kind] | None = None
        middle = QWidget()
        column = QVBoxLayout(middle)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        for widget, stretch in ((self.run_bar, 0), (self.prompt, 0), (centre, 1)):
            column.addWidget(widget, stretch)
        self.setCentralWidget(middle)
        self.show_title("", Kind.OFFLINE)

    def add(self, title: str, content: QWidget, area: Qt.DockWidgetArea, moves: bool = False) -> Dock:
        """A new dock; `arrange` makes those of one area tabs of each other."""
        dock = self._made(title, content, area, moves)
        self.addDockWidget(area, dock)
        dock.hide()
        return dock

    def _made(self, title: str, content: QWidget, area: Qt.DockWidgetArea, moves: bool) -> Dock:
        dock = Dock(title, content, moves, self)
        dock.brought.connect(self.show_titles)
        dock.stop.connect(self.stop)
        self._areas.setdefault(area, []).append(dock)
        self.docks[title] = dock
        panels, floats = self.submenus["panels"], self.submenus["floats"]
        panels.addAction(dock.toggleViewAction())
        floats.addAction(title, lambda: dock.setFloating(not dock.isFloating()))
        for signal in (dock.dockLocationChanged, dock.visibilityChanged, dock.topLevelChanged):
            signal.connect(self._titles.start)
        if isinstance(content, Panel):
            dock.visibilityChanged.connect(lambda seen: self.came.emit(content) if seen else None)
        return dock

    def add_late(self, title: str, content: Panel, area: Qt.DockWidgetArea, shown: bool) -> None:
        """The same after the others have been arranged: behind them, unless it is remembered to be elsewhere."""
        before = [dock for dock in self._areas.get(area, []) if not dock.isFloating()]
        dock = self._made(title, content, area, content.moves)
        if self.restoreDockWidget(dock):  # before it is in any area, else there is always something to restore
            return
        self.addDockWidget(area, dock)
        if before:
            front = next((each for each in before if not each.visibleRegion().isEmpty()), before[0])
            self.tabifyDockWidget(before[-1], dock)
            front.raise_()
        dock.setVisible(shown)

    def show_title(self, name: str, kind: Kind) -> None:
        """The program's name and the kind, in the title bar of the system."""
        if (name, kind) != self._shown:
            self._shown = (name, kind)
            self.setWindowTitle(
                f"{name} – Twoletter Studio – {WORDS[kind]}" if name else f"Twoletter Studio – {WORDS[kind]}"
            )

    def show_stop(self, kind: Kind, state: StopState, control: bool) -> None:
        """The STOP button here and in every floating panel, and the Watch/Control switch."""
        self.header.stop.show_state(kind, state)
        self.header.switch.show_state(kind, control)
        for dock in self.docks.values():
            dock.show_state(kind, state)

    def arrange(self, panels: tuple[str, ...], front: tuple[str, ...], program: bool = True) -> None:
        """A ready layout: every dock back in its place, those of the layout open, those named in front."""
        if not program:
            self.centralWidget().hide()
        for dock in self.docks.values():
            if dock.isFloating():
                dock.setFloating(False)
        for docks in self._areas.values():
            for before, after in pairwise(docks):
                self.tabifyDockWidget(before, after)
        for dock in (each for title, each in self.docks.items() if title not in panels):
            dock.hide()  # first, so that a wide one does not make the window wider beside those that come
        for dock in (each for title, each in self.docks.items() if title in panels):
            dock.show()
        for title in front:
            if title in self.docks:  # some are made later
                self.docks[title].raise_()
        self.centralWidget().setVisible(program)
        self._size_docks()

    def show_titles(self) -> None:
        """Docks among tabs have no title row; double click on the tab makes them float."""
        for dock in self.docks.values():
            beside = [each for each in self.tabifiedDockWidgets(dock) if not each.isHidden()]
            dock.show_title(dock.isFloating() or not beside)
        for bar in self.findChildren(QTabBar, options=Qt.FindChildOption.FindDirectChildrenOnly):
            if not bar.property("floats"):
                bar.setProperty("floats", True)
                bar.setAccessibleName("Panels")
                bar.setToolTip("Double click: in a window of its own")
                bar.setElideMode(Qt.TextElideMode.ElideNone)
                bar.setUsesScrollButtons(True)
                bar.tabBarDoubleClicked.connect(lambda index, bar=bar: self._float(bar.tabText(index)))

    def _float(self, title: str) -> None:
        for dock in self.docks.values():
            if dock.windowTitle() == title:
                dock.setFloating(True)

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        if not self._was_shown:
            self._was_shown = True
            # docks made tabs before it is shown leave stray tab bars behind; the very next thing after that
            QTimer.singleShot(0, self, self.first_shown.emit)

    def _size_docks(self) -> None:
        sides = [self.docks[title] for title in ("Instructions", "Display") if title in self.docks]
        self.resizeDocks(sides, [264, 360][: len(sides)], Qt.Orientation.Horizontal)
        if "Problems" in self.docks:
            self.resizeDocks([self.docks["Problems"]], [184], Qt.Orientation.Vertical)

    def arrangement(self) -> dict[str, str]:
        """Place, size and docks, as text for the settings."""
        return {"geometry": _text(self.saveGeometry()), "docks": _text(self.saveState(VERSION))}

    def restore(self, arrangement: dict[str, str]) -> bool:
        """Puts a remembered arrangement back; False when there is none or it does not fit."""
        try:
            geometry, docks = (QByteArray.fromBase64(arrangement[key].encode()) for key in ("geometry", "docks"))
        except (KeyError, AttributeError):
            return False
        return self.restoreGeometry(geometry) and self.restoreState(docks, VERSION)

    def closeEvent(self, event: QCloseEvent) -> None:
        event.accept()
        self.closing.emit(event)


def _text(data: QByteArray) -> str:
    return bytes(data.toBase64().data()).decode()
