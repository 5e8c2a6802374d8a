"""A question that never blocks: one sentence or two, and a button for every answer."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QApplication, QDialog, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from widgets.help.topic import topic_of
from widgets.parts.foot import foot
from widgets.parts.icons import icon


class Question(QDialog):
    """Not modal. The first answer is the usual one; closing it means none of them."""

    def __init__(
        self,
        title: str,
        words: str,
        answers: Sequence[tuple[str, Callable[[], None]]],
        parent: QWidget | None = None,
        picture: str = "help",
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(title)
        self.setModal(False)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setProperty("helpPage", topic_of(QApplication.focusWidget()))  # of where it was asked
        self.buttons: dict[str, QPushButton] = {}
        heading, text, drawing = QLabel(title), QLabel(words), QLabel()
        self.words = words
        heading.setProperty("role", "title")
        text.setWordWrap(True)
        text.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        text.setMinimumWidth(400)
        drawing.setPixmap(
            icon(picture, "warning" if picture == "warning" else "accent").pixmap(
                QSize(36, 36), self.devicePixelRatioF()
            )
        )
        texts = QVBoxLayout()
        texts.setSpacing(8)
        texts.addWidget(heading)
        texts.addWidget(text)
        top = QHBoxLayout()
        top.setSpacing(16)
        top.addWidget(drawing, 0, Qt.AlignmentFlag.AlignTop)
        top.addLayout(texts, 1)
        cancel = QPushButton("Cancel" if answers else "Close")
        cancel.clicked.connect(self.reject)
        for number, (label, call) in enumerate(answers):
            button = QPushButton(label)
            button.clicked.connect(lambda _=False, call=call: self._answer(call))
            if number == 0:
                button.setProperty("role", "primary")
                button.setDefault(True)
            self.buttons[label] = button
        column = QVBoxLayout(self)
        column.setContentsMargins(24, 24, 24, 16)
        column.setSpacing(24)
        column.addLayout(top)
        column.addWidget(foot(*self.buttons.values(), away=cancel))
        if answers:
            self.buttons[answers[0][0]].setFocus()

    def _answer(self, call: Callable[[], None]) -> None:
        self.accept()
        call()
