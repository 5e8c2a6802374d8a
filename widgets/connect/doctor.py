"""The connection doctor: a port is examined, and what is wrong is said with the next steps and the switches."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QHBoxLayout,
    QLabel,
    QProgressBar,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from widgets.connect.dip_switches import DipSwitches
from widgets.connect.rates import RATES
from widgets.parts.foot import foot

NOTE = (
    "Only an empty line and a request for the version are sent; another kind of device may take even that for an order."
)
PAGE, TROUBLE = "Connecting", "Troubleshooting"  # of the help
NO_PORT = "This computer has no serial port. Plug in the adapter of the controller."


class DoctorWindow(QDialog):
    """Never modal. It is told how far an examination is and what came of it; nothing is decided here."""

    examine_wanted = Signal(str)  # port
    cancel_wanted = Signal()
    connect_wanted = Signal(str, int)  # port, baud
    help_wanted = Signal(str)  # page

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Examine the connection")
        self.setProperty("helpPage", PAGE)
        self.setModal(False)
        self.ports, self.examine, self.cancel = QComboBox(), QPushButton("Examine"), QPushButton("Cancel")
        self.busy, self.phase = QProgressBar(), QLabel()
        self.sentence, self.steps, self.switches = QLabel(), QLabel(), DipSwitches()
        self.take, self.close_, self.more = QPushButton(), QPushButton("Close"), QPushButton("More help")
        self._baud = 0
        self._lay_out()
        self.examine.clicked.connect(lambda: self.examine_wanted.emit(self.ports.currentData()))
        self.cancel.clicked.connect(self.cancel_wanted)
        self.take.clicked.connect(lambda: self.connect_wanted.emit(self.ports.currentData(), self._baud))
        self.more.clicked.connect(lambda: self.help_wanted.emit(self.property("helpPage")))
        self.close_.clicked.connect(self.close)
        self.rejected.connect(self.cancel_wanted)

    def show_ports(self, ports: Sequence[tuple[str, str]], chosen: str) -> None:
        """Device and words of each; the one used last is chosen."""
        self.ports.clear()
        for device, words in ports:
            self.ports.addItem(f"{device} – {words}" if words else device, device)
        self.ports.setCurrentIndex(max(self.ports.findData(chosen), 0))
        self.examine.setEnabled(bool(ports))
        self.examine.setToolTip("" if ports else NO_PORT)
        self._clear(NOTE if ports else NO_PORT)

    def show_busy(self, phase: str, fraction: float) -> None:
        """What is tried now."""
        self._clear("")
        self.busy.setValue(round(100 * fraction))
        self.phase.setText(f"{phase}…")
        for widget, shown in ((self.busy, True), (self.phase, True), (self.cancel, True), (self.examine, False)):
            widget.setVisible(shown)
        self.ports.setEnabled(False)

    def show_diagnosis(
        self, sentence: str, steps: Sequence[str], baud: int | None, fine: bool, page: str = PAGE
    ) -> None:
        """What was found; `baud` is where the controller answers, `page` tells more."""
        self._clear(sentence)
        self.setProperty("helpPage", page)
        self.more.setVisible(not fine)
        self.steps.setText(
            "".join(f"<li>{_plain(step)}</li>" for step in steps).join(("<ol>", "</ol>")) if steps else ""
        )
        self.steps.setVisible(bool(steps))
        self._baud = baud or 0
        self.switches.setVisible(not fine and baud in RATES)
        if baud in RATES:
            self.switches.show_setting(baud, True)
        socket = "://" in str(self.ports.currentData())  # the speed is set at its other end
        self.take.setText("Connect" if socket else f"Connect at {baud} baud")
        self.take.setVisible(baud is not None)
        self.take.setFocus() if baud is not None else self.close_.setFocus()
        self.adjustSize()

    def words(self) -> str:
        """What is shown, as text."""
        return f"{self.sentence.text()}\n{self.steps.text()}".strip()

    def _clear(self, sentence: str) -> None:
        self.sentence.setText(sentence)
        self.sentence.setVisible(bool(sentence))
        self.setProperty("helpPage", PAGE)
        for widget in (self.busy, self.phase, self.cancel, self.steps, self.switches, self.take, self.more):
            widget.hide()
        self.examine.show()
        self.ports.setEnabled(True)

    def _lay_out(self) -> None:
        self.ports.setAccessibleName("Port to examine")
        self.busy.setAccessibleName("Progress of the examination")
        self.busy.setRange(0, 100)
        self.busy.setTextVisible(False)
        for label in (self.sentence, self.steps):
            label.setWordWrap(True)
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.steps.setTextFormat(Qt.TextFormat.RichText)
        self.examine.setProperty("role", "primary")
        self.take.setProperty("role", "primary")
        top = QHBoxLayout()
        top.addWidget(self.ports, 1)
        top.addWidget(self.examine)
        top.addWidget(self.cancel)
        column = QVBoxLayout(self)
        column.setContentsMargins(24, 24, 24, 16)
        column.setSpacing(12)
        column.addLayout(top)
        for widget in (self.busy, self.phase, self.sentence, self.steps):
            column.addWidget(widget)
        column.addWidget(self.switches, 0, Qt.AlignmentFlag.AlignHCenter)
        column.addStretch(1)
        column.addWidget(foot(self.take, away=self.close_, explains=self.more))
        self.setMinimumWidth(560)


def _plain(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;")
