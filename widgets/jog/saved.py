"""The page of saved points: save where the axes are, go there, rename, delete."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QLineEdit,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from codegen.fields import Dimension
from codegen.points import LONGEST, Point, name_problem
from codegen.setup import Setup
from device.jog import Places, Plan
from widgets.jog import plans
from widgets.jog.ends import ends_words
from widgets.jog.one_axis import enable
from widgets.jog.speed import PaceChoice
from widgets.panel import set_text, show_role
from widgets.parts.look import look
from widgets.parts.units import decimals_of

NOBODY = "Save where the axes are under a name; then you can go back there."
CHOOSE = "Choose a point in the list."
ELSEWHERE = 4  # decimals of a place that this setup cannot go to, at most


def places_words(point: Point, setup: Setup) -> str:
    """With the fixed decimals of each axis; shortened where its unit is another one now, or the axis not there."""
    told = []
    for each in point.places:
        same = each.axis in setup.letters and each.unit == setup.unit_text(Dimension.POSITION, each.axis)
        number = f"{float(each.number):.{decimals_of(setup.axis(each.axis)) if same else ELSEWHERE}f}"
        told.append(f"{each.axis} {number if same else number.rstrip('0').rstrip('.')} {each.unit}")
    return ", ".join(told)


class SavedPage(QWidget):
    """Emits what the person wants; whoever keeps the points shows them again afterwards."""

    save_wanted = Signal(str)
    go_wanted = Signal(object)  # Plan
    rename_wanted = Signal(str, str)
    delete_wanted = Signal(str)

    def __init__(self, setup: Setup, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._setup, self._letters = setup, setup.letters
        self._speeds: Mapping[str, Mapping[str, str]] = {}
        self._places = Places({})
        self._points: tuple[Point, ...] = ()
        self._reason = ""
        self.table, self.name = QTableWidget(0, 2), QLineEdit()
        self.save, self.rename = QPushButton("Save here"), QPushButton("Rename")
        self.go, self.delete = QPushButton("Go there…"), QPushButton("Delete…")
        self.pace, self.ends = PaceChoice("Speed"), QLabel(NOBODY)
        self._lay_out()
        self.table.itemSelectionChanged.connect(self._chosen)
        self.name.textChanged.connect(self._refresh)
        self.pace.changed.connect(self._refresh)
        self.save.clicked.connect(lambda: self.save_wanted.emit(self.name.text().strip()))
        self.rename.clicked.connect(self._rename)
        self.delete.clicked.connect(self._delete)
        self.go.clicked.connect(self._go)
        self._refresh()

    def show_setup(self, setup: Setup, letters: str) -> None:
        """Another machine."""
        self._setup, self._letters = setup, letters or setup.letters
        self._refresh()

    def show_points(self, points: Sequence[Point]) -> None:
        """Those of this machine; the chosen one stays chosen."""
        before = self.point.name if self.point is not None else ""
        self._points = tuple(points)
        self.table.blockSignals(True)
        self.table.setRowCount(len(points))
        for row, point in enumerate(points):
            for column, text in enumerate((point.name, places_words(point, self._setup))):
                item = QTableWidgetItem(text)
                item.setToolTip(f"{point.name}: {point.words}")
                self.table.setItem(row, column, item)
        self.table.clearSelection()
        for row, point in enumerate(points):
            if point.name == before:
                self.table.selectRow(row)
        self.table.blockSignals(False)
        self._refresh()

    def choose(self, name: str) -> None:
        """Selects a point by its name."""
        for row, point in enumerate(self._points):
            if point.name == name:
                self.table.selectRow(row)

    def show_speeds(self, speeds: Mapping[str, Mapping[str, str]]) -> None:
        """Slow, medium and fast of every axis."""
        if speeds != self._speeds:
            self._speeds = speeds
            self._refresh()

    def show_ends(self, places: Places) -> None:
        """Where the axes are."""
        if places != self._places:
            self._places = places
            self._refresh()

    def show_usable(self, reason: str) -> None:
        """Why nothing may be moved now, or nothing."""
        if reason != self._reason:
            self._reason = reason
            self._refresh()

    @property
    def point(self) -> Point | None:
        """The chosen one."""
        rows = self.table.selectionModel().selectedRows() if self.table.selectionModel() else []
        return self._points[rows[0].row()] if rows and rows[0].row() < len(self._points) else None

    @property
    def plan(self) -> Plan | str:
        """The way to the chosen point, or why there is none."""
        if self.point is None:
            return CHOOSE if self._points else NOBODY
        speeds = {axis: kept.get(self.pace.pace, "") for axis, kept in self._speeds.items()}
        return plans.to_point(self.point, self._letters, speeds, self._setup)

    def looked_at(self) -> Plan | None:
        """The chosen point's, while the page is looked at."""
        return self.plan if isinstance(self.plan, Plan) else None

    def _refresh(self) -> None:
        plan, names = self.plan, [each.name for each in self._points]
        words, warns = (plan, self.point is not None) if isinstance(plan, str) else self._words(plan)
        set_text(self.ends, words)
        show_role(self.ends, "problem" if warns else "quiet")
        none = "" if self.point is not None else CHOOSE
        enable(self.go, self._reason or (plan if isinstance(plan, str) else ""))
        enable(self.delete, none)
        others = [each for each in names if self.point is None or each != self.point.name]
        enable(self.rename, none or name_problem(self.name.text(), others))
        missing = "" if self._places.commanded else "The places of the axes are not read at the moment."
        enable(self.save, missing or name_problem(self.name.text(), names))

    def _words(self, plan: Plan) -> tuple[str, bool]:
        return ends_words(plan, self._places, self._setup)

    def _chosen(self) -> None:
        if self.point is not None:
            self.name.setText(self.point.name)
        self._refresh()

    def _rename(self) -> None:
        if self.point is not None:
            self.rename_wanted.emit(self.point.name, self.name.text().strip())

    def _delete(self) -> None:
        if self.point is not None:
            self.delete_wanted.emit(self.point.name)

    def _go(self) -> None:
        plan = self.plan
        if isinstance(plan, Plan):
            self.go_wanted.emit(plan)

    def _lay_out(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(8)
        self.table.setHorizontalHeaderLabels(["Point", "Place"])
        self.table.setAccessibleName("Saved points")
        self.table.verticalHeader().hide()
        self.table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.table.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setTabKeyNavigation(False)
        self.table.horizontalHeader().setSectionResizeMode(0, QHeaderView.ResizeMode.ResizeToContents)
        self.table.horizontalHeader().setStretchLastSection(True)
        self.table.horizontalHeader().setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self.table.setMinimumHeight(160)
        column.addWidget(self.table, 1)
        self.ends.setWordWrap(True)
        self.ends.setProperty("role", "quiet")
        column.addWidget(self.ends)
        column.addWidget(self.pace)
        first = QHBoxLayout()
        self.go.setMinimumHeight(look().space["touch"])
        first.addWidget(self.go, 1)
        first.addWidget(self.delete)
        column.addLayout(first)
        line = QHBoxLayout()
        label = QLabel("Name")
        label.setBuddy(self.name)
        self.name.setAccessibleName("Name of the point")
        self.name.setMaxLength(LONGEST)
        line.addWidget(label)
        line.addWidget(self.name, 1)
        line.addWidget(self.save)
        line.addWidget(self.rename)
        column.addLayout(line)
