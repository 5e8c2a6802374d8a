"""The operator terminal: display and keys of a TERM-1500 at port 2 of the controller or of the simulator."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QTimer, Signal
from PySide6.QtWidgets import (
    QApplication,
    QCheckBox,
    QComboBox,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from device.api import ONLY_WATCHED, Kind
from device.terminal1500 import HAND_HELD, PANEL, Key, Terminal
from widgets.operator.keypad import Keypad
from widgets.operator.screen import Screen
from widgets.panel import Panel, set_text, set_tip, show_role
from widgets.parts.pieces import dressed

if TYPE_CHECKING:
    from device.api import Row

SIMULATED = "Port 2 of the simulator"
NOWHERE = "Connect the controller's main port first: STOP goes through it."
WATCHED = "This is Watch: switch to Control first; a key can start a motion."
CLOSED = "Not connected"
BEEPS = {"short bell": 1, "long bell": 2, "alert": 3}  # key clicks are not heard
BEEP_MS, TOLD_MS = 250, 2000
FORMS = {"Hand-held": HAND_HELD, "Panel": PANEL}


class OperatorPanel(Panel):
    """Keys by mouse; or typed while the display has the focus, Shift+F1 to Shift+F5 for F1 to F5."""

    title = "Operator terminal"
    moves = True
    connect_wanted = Signal(str)  # a device, or SIMULATED
    close_wanted = Signal()
    keys = Signal(bytes)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.terminal = Terminal()
        self.screen = Screen(self.terminal)
        self.screen.named.connect(lambda name: self._pressed(self.terminal.by_name[name], False, False))
        self.screen.typed.connect(self._typed)
        self.line, self.form = QComboBox(), QComboBox()
        self.connect_button = QPushButton("Connect")
        self.sounds, self.heard = QCheckBox("Sounds"), QLabel()
        self._quiet = QTimer(self, singleShot=True, interval=TOLD_MS)
        self._quiet.timeout.connect(self.heard.clear)
        self.state, self.note = QLabel(CLOSED), QLabel()
        self._open = False
        self.pads: dict[str, Keypad] = {}  # made when first seen: the window opens sooner
        self._lay_out()
        self.connect_button.clicked.connect(self._connect)
        self.form.currentTextChanged.connect(self._show_form)
        self._show_usable()

    def pieces(self) -> Iterator[None]:
        pad = self._pad(self.form.currentText())
        pad.hide()
        yield from dressed(pad)
        self._show_form(self.form.currentText())

    def show_controller(self) -> None:
        self._show_usable()

    def show_lines(self, devices: Sequence[str]) -> None:
        """The serial devices there are."""
        simulated = self.controller is not None and self.controller.kind is Kind.SIMULATOR
        wanted = [SIMULATED] if simulated else list(devices)
        if wanted != [self.line.itemText(index) for index in range(self.line.count())]:
            before = self.line.currentText()
            self.line.clear()
            self.line.addItems(wanted)
            self.line.setCurrentText(before)
            self._show_usable()

    def show_line(self, text: str, is_open: bool, failed: bool) -> None:
        """What has become of the line to port 2."""
        set_text(self.state, text)
        show_role(self.state, "problem" if failed else "quiet")
        self._open = is_open
        set_words = "Disconnect" if is_open else "Connect"
        if self.connect_button.text() != set_words:
            self.connect_button.setText(set_words)
        self._show_usable()

    def received(self, data: bytes) -> None:
        """What port 2 sent."""
        if data:
            self.terminal.receive(data)
            if self.terminal.answers:
                self.keys.emit(bytes(self.terminal.answers))
                self.terminal.answers.clear()
        self._sound()
        self.screen.refresh()

    def refresh(self, row: Row) -> None:
        self._show_usable()

    def words(self) -> str:
        """What the display shows."""
        return self.screen.accessibleDescription()

    # ---- keys

    def _typed(self, character: str) -> None:
        try:
            self._send(self.terminal.type(character))
        except KeyError:
            set_text(self.note, f"The terminal has no key for {character}.")

    def _pressed(self, key: Key, shift: bool, control: bool) -> None:
        if self.reason:
            return
        self._send(self.terminal.press(key, shift=shift, control=control))
        if self.terminal.configuring:
            self.terminal.configuring = False
            set_text(self.note, "CTRL-SHIFT-F1 sets a real terminal's speed and echo; here they follow the line.")

    def _send(self, data: bytes) -> None:
        if data and not self.reason:
            set_text(self.note, "")
            self.keys.emit(data)
        self._sound()
        self.screen.refresh()

    @property
    def reason(self) -> str:
        """Why no key may be pressed now; nothing when it may."""
        controller = self.controller
        if controller is None or controller.kind is Kind.OFFLINE:
            return NOWHERE
        if controller.kind is Kind.REPLAY:
            return ONLY_WATCHED
        if not controller.control:
            return WATCHED
        return "" if self._open else "Connect the line to port 2 first."

    def _sound(self) -> None:
        """A bell is shown for a moment, and heard where that is wanted: the long one and the alert as several beeps."""
        bells = [sound for sound in self.terminal.sounds if sound in BEEPS]
        self.terminal.sounds.clear()
        if not bells:
            return
        set_text(self.heard, f"♪ {bells[-1]}")
        self._quiet.start()
        for number in range(BEEPS[bells[-1]] if self.sounds.isChecked() else 0):
            QTimer.singleShot(number * BEEP_MS, self, QApplication.beep)

    # ---- arrangement

    def _connect(self) -> None:
        if self._open:
            self.close_wanted.emit()
        elif self.line.currentText():
            self.connect_wanted.emit(self.line.currentText())

    def _pad(self, name: str) -> Keypad:
        if name not in self.pads:
            pad = self.pads[name] = Keypad(FORMS[name], self._column.parentWidget())
            pad.pressed.connect(self._pressed)
            self._column.insertWidget(self._column.count() - 1, pad)
        return self.pads[name]

    def _show_form(self, name: str) -> None:
        self._pad(name)
        for form, pad in self.pads.items():
            pad.setVisible(form == name)
        self.terminal.keys = FORMS[name]
        self._show_usable()

    def _show_usable(self) -> None:
        reason = self.reason
        for pad in self.pads.values():
            if pad.isEnabled() == bool(reason):
                pad.setEnabled(not reason)
                pad.setToolTip(reason)
        linked = self.controller is not None and self.controller.kind is not Kind.OFFLINE
        usable = linked and bool(self.line.currentText() or self._open)
        if self.connect_button.isEnabled() != usable:
            self.connect_button.setEnabled(usable)
        set_tip(self.connect_button, "" if linked else NOWHERE)
        if not self._open and not linked:
            set_text(self.note, NOWHERE)
        elif self._open and reason:
            set_text(self.note, reason)
        elif self.note.text() in (NOWHERE, WATCHED):
            set_text(self.note, "")
        self.note.setVisible(bool(self.note.text()))

    def _lay_out(self) -> None:
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        area, inside = QScrollArea(), QWidget()
        area.setWidgetResizable(True)
        area.setWidget(inside)
        outer.addWidget(area)
        column = QVBoxLayout(inside)
        column.setContentsMargins(8, 4, 8, 8)
        column.setSpacing(8)
        head = QHBoxLayout()
        self.line.setAccessibleName("Line to port 2")
        self.line.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)
        head.addWidget(self.line, 1)
        head.addWidget(self.connect_button)
        column.addLayout(head)
        self.state.setProperty("role", "quiet")
        self.state.setWordWrap(True)
        self.note.setWordWrap(True)
        self.note.setProperty("role", "problem")
        column.addWidget(self.state)
        column.addWidget(self.note)
        column.addWidget(self.screen)
        tools = QHBoxLayout()
        label = QLabel("Keys")
        label.setBuddy(self.form)
        self.form.setAccessibleName("Which form of the terminal")
        self.form.addItems(list(FORMS))
        tools.addWidget(label)
        tools.addWidget(self.form)
        tools.addStretch(1)
        self.sounds.setToolTip(
            "The bells of the terminal are heard: one beep, two for the long bell, three for the alert."
        )
        self.heard.setProperty("role", "quiet")
        self.heard.setAccessibleName("Bell of the terminal")
        tools.addWidget(self.heard)
        tools.addWidget(self.sounds)
        column.addLayout(tools)
        column.addStretch(1)
        self._column = column
