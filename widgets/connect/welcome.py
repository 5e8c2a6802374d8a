"""What greets the person: what was looked for, what was found, and everything that can be done without a controller."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import QDialog, QFrame, QHBoxLayout, QLabel, QProgressBar, QPushButton, QVBoxLayout, QWidget

from widgets.parts.foot import foot
from widgets.parts.icons import icon

DANGER = "Machinery in motion is dangerous. STOP (F12) is not an emergency stop: keep the machine's own within reach."


@dataclass(frozen=True)
class Way:
    """One thing to do: its name, what it means, its icon."""

    name: str
    title: str
    words: str
    icon: str


WAYS = (
    Way(
        "simulator",
        "Use the simulator",
        "A complete controller without hardware; nothing real moves.",
        "simulator",
    ),
    Way(
        "serial",
        "Serial communication setup",
        "Port, baud rate and flow control, with the switches on the controller.",
        "connect",
    ),
    Way("setup", "Offline controller setup", "Model, axes, units and scaling; saved with the program.", "setup"),
    Way("offline", "Offline programming", "Write programs without a controller; download them later.", "program"),
)


class Welcome(QDialog):
    """Never modal. `way` tells what was chosen: simulator, serial, setup, offline, again, doctor, exit, allow, skip."""

    way = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Twoletter Studio")
        self.setProperty("helpPage", "Connecting")
        self.setModal(False)
        self.heading, self.sentence, self.busy = QLabel(), QLabel(), QProgressBar()
        self.ask = QFrame()
        self.question = QLabel()
        self.allow, self.skip = QPushButton("Ask this port"), QPushButton("Leave it alone")
        self.ways: dict[str, QPushButton] = {}
        self.again, self.doctor, self.exit = (QPushButton(text) for text in ("Try again", "What is wrong?", "Exit"))
        self._lay_out()
        self.show_looking("Looking for a controller…")

    def show_looking(self, sentence: str) -> None:
        """While ports are being tried."""
        self._say("Looking for a controller", sentence, busy=True)

    def show_question(self, device: str, words: str) -> None:
        """Before anything is written to a port that was never used."""
        self.question.setText(
            f"{words} ({device}) was never used here. May it be asked who it is? Only an empty line and a request for "
            "the version are sent; another kind of device may take even that for an order."
        )
        self._say("A new port", "", busy=False)
        self.ask.show()
        self.adjustSize()
        self.allow.setFocus()

    def show_nothing(self, sentence: str, heading: str = "No controller connected") -> None:
        """No controller answered: the reason, and what can be done."""
        self._say(heading, sentence, busy=False)

    def _say(self, heading: str, sentence: str, busy: bool) -> None:
        self.heading.setText(heading)
        self.sentence.setText(sentence)
        self.sentence.setVisible(bool(sentence))
        self.busy.setVisible(busy)
        self.again.setEnabled(not busy)
        self.doctor.setEnabled(not busy)
        self.again.setToolTip("Still looking" if busy else "Looks for a controller once more")
        self.ask.hide()
        self.adjustSize()

    def _lay_out(self) -> None:
        self.heading.setProperty("role", "title")
        self.sentence.setWordWrap(True)
        self.question.setMinimumHeight(64)  # three lines: a wrapped label asks for less than it needs
        self.question.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.busy.setRange(0, 0)
        self.busy.setTextVisible(False)
        self.busy.setStyleSheet("min-height: 6px; max-height: 6px;")
        self.busy.setAccessibleName("Looking for a controller")
        column = QVBoxLayout(self)
        column.setContentsMargins(24, 24, 24, 16)
        column.setSpacing(12)
        column.addWidget(self.heading)
        column.addWidget(self.sentence)
        column.addWidget(self.busy)
        column.addWidget(self._question())
        for way in WAYS:
            column.addWidget(self._button(way))
        danger = QLabel(DANGER)
        danger.setWordWrap(True)
        danger.setProperty("role", "note")
        column.addWidget(danger)
        column.addStretch(1)
        self.again.setIcon(icon("refresh"))
        self.again.clicked.connect(lambda: self.way.emit("again"))
        self.exit.clicked.connect(lambda: self.way.emit("exit"))
        self.doctor.setIcon(icon("search"))
        self.doctor.setToolTip("Examines a port: cable, speed, handshake, permission; says what to do")
        self.doctor.clicked.connect(lambda: self.way.emit("doctor"))
        column.addWidget(foot(away=self.exit, left=(self.again, self.doctor)))
        self.setMinimumWidth(608)

    def _question(self) -> QFrame:
        self.ask.setProperty("role", "card")
        self.question.setWordWrap(True)
        self.allow.setProperty("role", "primary")
        self.allow.clicked.connect(lambda: self.way.emit("allow"))
        self.skip.clicked.connect(lambda: self.way.emit("skip"))
        column = QVBoxLayout(self.ask)
        column.setContentsMargins(16, 12, 16, 12)
        column.setSpacing(12)
        column.addWidget(self.question)
        column.addWidget(foot(self.allow, away=self.skip))
        return self.ask

    def _button(self, way: Way) -> QPushButton:
        button = QPushButton()
        button.setProperty("role", "choice")
        button.setAccessibleName(way.title)
        button.setAccessibleDescription(way.words)
        inside = QHBoxLayout(button)
        inside.setContentsMargins(16, 8, 16, 8)
        inside.setSpacing(16)
        picture = QLabel()
        picture.setPixmap(icon(way.icon, "accent").pixmap(QSize(28, 28), self.devicePixelRatioF()))
        title, words = QLabel(way.title), QLabel(way.words)
        words.setProperty("role", "quiet")
        font = title.font()
        font.setBold(True)
        title.setFont(font)
        texts = QVBoxLayout()
        texts.setSpacing(0)
        texts.addWidget(title)
        texts.addWidget(words)
        inside.addWidget(picture)
        inside.addLayout(texts, 1)
        for label in (picture, title, words):
            label.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        button.setMinimumHeight(72)
        button.clicked.connect(lambda: self.way.emit(way.name))
        self.ways[way.name] = button
        return button
