"""Serial communication set-up: port, rate, bits, parity, echo, flow control, and the switches on the controller."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from widgets.connect.dip_switches import DipSwitches
from widgets.connect.rates import RATES
from widgets.parts.foot import foot

HANDSHAKES = {"both": "XON/XOFF and RTS/CTS", "rts": "RTS/CTS", "xon": "XON/XOFF", "none": "None"}
PARITIES = {"none": "None", "even": "Even", "odd": "Odd"}


@dataclass(frozen=True)
class SerialChoice:
    """One serial line as chosen; the defaults are those of the manual (chapter 5, l.1503-1512)."""

    port: str = ""
    baud: int = 9600
    bits: int = 8
    stop_bits: int = 1
    parity: str = "none"
    echo: bool = False
    handshake: str = "both"


@dataclass(frozen=True)
class PortShown:
    """A port of this computer: what to open and what to call it."""

    device: str
    words: str


class SerialSetup(QDialog):
    """Not modal; `chosen` when the person wants to connect with what is set."""

    chosen = Signal(object)  # SerialChoice
    search_again = Signal()

    def __init__(self, choice: SerialChoice, ports: Sequence[PortShown], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Serial communication setup")
        self.setProperty("helpPage", "Serial communication setup")
        self.setModal(False)
        self.port = QComboBox()
        self.port.setEditable(True)
        self.port.setMinimumWidth(344)
        self.baud, self.bits, self.stop_bits = QComboBox(), QComboBox(), QComboBox()
        self.parity, self.handshake = QComboBox(), QComboBox()
        self.echo = QCheckBox("Controller echoes what it receives")
        self.echo.setToolTip("Told to the controller (EO) when you take Control; either way is understood.")
        self.switches, self.words = DipSwitches(), QLabel()
        self.connect_button, self.again, self.cancel = (
            QPushButton("Connect"),
            QPushButton("List ports again"),
            QPushButton("Cancel"),
        )
        self._fill()
        self._lay_out()
        self.show_ports(ports)
        self.show_choice(choice)
        self._wire()

    @property
    def choice(self) -> SerialChoice:
        """What is set now."""
        typed = self.port.currentText().strip()
        index = self.port.findText(typed)
        device = str(self.port.itemData(index)) if index >= 0 else typed
        return SerialChoice(
            port=device,
            baud=int(self.baud.currentData()),
            bits=int(self.bits.currentData()),
            stop_bits=int(self.stop_bits.currentData()),
            parity=str(self.parity.currentData()),
            echo=self.echo.isChecked(),
            handshake=str(self.handshake.currentData()),
        )

    def show_ports(self, ports: Sequence[PortShown]) -> None:
        """The ports of this computer; a device name or socket://host:port may be typed as well."""
        before = self.port.currentText()
        self.port.clear()
        for port in ports:
            self.port.addItem(port.words, port.device)
        if before:
            self.port.setCurrentText(before)
        empty = "No serial port found: plug the cable in and list again, or type its name"
        line = self.port.lineEdit()
        if line is not None:
            line.setCursorPosition(0)
            line.setPlaceholderText("Device name or socket://host:port" if ports else empty)
        self._judge()

    def show_choice(self, choice: SerialChoice) -> None:
        """Sets every control."""
        index = self.port.findData(choice.port)
        if index >= 0:
            self.port.setCurrentIndex(index)
        elif choice.port:
            self.port.setCurrentText(choice.port)
        pairs = ((self.baud, choice.baud), (self.bits, choice.bits), (self.stop_bits, choice.stop_bits))
        for box, value in (*pairs, (self.parity, choice.parity), (self.handshake, choice.handshake)):
            box.setCurrentIndex(max(0, box.findData(value)))
        self.echo.setChecked(choice.echo)
        line = self.port.lineEdit()
        if line is not None:
            line.setCursorPosition(0)
        self._judge()

    def _fill(self) -> None:
        for rate in RATES:
            self.baud.addItem(f"{rate:,}".replace(",", " "), rate)
        for bits in (8, 7):
            self.bits.addItem(str(bits), bits)
        for bits in (1, 2):
            self.stop_bits.addItem(str(bits), bits)
        for value, word in PARITIES.items():
            self.parity.addItem(word, value)
        for value, word in HANDSHAKES.items():
            self.handshake.addItem(word, value)

    def _lay_out(self) -> None:
        form = QGridLayout()
        form.setHorizontalSpacing(16)
        form.setVerticalSpacing(8)
        rows = (
            ("Port", self.port), ("Baud rate", self.baud), ("Data bits", self.bits), ("Stop bits", self.stop_bits),
            ("Parity", self.parity), ("Flow control", self.handshake), ("Echo", self.echo),
        )  # fmt: skip
        for row, (label, widget) in enumerate(rows):
            widget.setAccessibleName(label)
            form.addWidget(QLabel(label), row, 0)
            form.addWidget(widget, row, 1)
        form.setRowStretch(len(rows), 1)
        side = QVBoxLayout()
        side.setSpacing(12)
        side.addWidget(QLabel("Set these switches on the controller:"))
        side.addWidget(self.switches)
        self.words.setWordWrap(True)
        self.words.setProperty("role", "quiet")
        self.words.setMaximumWidth(304)
        side.addWidget(self.words)
        side.addStretch(1)
        middle = QHBoxLayout()
        middle.setSpacing(32)
        middle.addLayout(form)
        middle.addLayout(side)
        self.connect_button.setProperty("role", "primary")
        self.connect_button.setDefault(True)
        column = QVBoxLayout(self)
        column.setContentsMargins(24, 24, 24, 16)
        column.setSpacing(24)
        column.addLayout(middle)
        column.addWidget(foot(self.connect_button, away=self.cancel, left=(self.again,)))

    def _wire(self) -> None:
        self.baud.currentIndexChanged.connect(self._judge)
        self.handshake.currentIndexChanged.connect(self._judge)
        self.port.currentTextChanged.connect(self._judge)
        self.connect_button.clicked.connect(self._choose)
        self.again.clicked.connect(self.search_again)
        self.cancel.clicked.connect(self.reject)

    def _judge(self) -> None:
        if self.baud.count() == 0 or self.handshake.count() == 0:
            return
        hardware = str(self.handshake.currentData()) in ("rts", "both")
        self.switches.show_setting(int(self.baud.currentData()), hardware)
        advice = "" if hardware else " Without RTS/CTS a fast rate can lose characters."
        self.words.setText(f"HSHK (5) {'ON: the controller uses RTS/CTS.' if hardware else 'OFF: no RTS/CTS.'}{advice}")
        ready = bool(self.port.currentText().strip())
        self.connect_button.setEnabled(ready)
        self.connect_button.setToolTip("Connects with these settings" if ready else "Choose a port first")

    def _choose(self) -> None:
        self.chosen.emit(self.choice)
        self.accept()
