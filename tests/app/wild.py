"""A person gone wild: random buttons, actions, instructions, texts and keys, and a world that does what it likes."""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QEvent, QPoint, Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QApplication,
    QComboBox,
    QDialog,
    QFileDialog,
    QLabel,
    QLineEdit,
    QMessageBox,
    QPlainTextEdit,
    QPushButton,
    QTextBrowser,
    QWidget,
)

from codegen import files
from codegen.instructions import ALL, Instruction
from codegen.models import MODELS
from device.api import State
from tests.stage import Stage
from widgets.parts.question import Question

LEFT = Qt.MouseButton.LeftButton
NEVER = {"exit"}  # ends the program
TEXTS = (
    "10", "-3.5", "12,5", "1e3", "", " ", "X", "LEN*2", "１２", "A B", "#A", "@IN[1]", "99999999999", "Ä", "x" * 50,
    "%s", "1;2", "$FF", "\"", "\\", "(", "0",
)  # fmt: skip
COMMANDS = (
    "TP", "MG _TPX", "KP ?", "PR 500;BGX", "JG 2000;BGX", "ST", "SB 1", "CB 1", "V1=5", "XQ", "HX", "MO", "SH", "TC1",
    "UL", "LS", "DP 0", "KP 9999", "XX", "TR 1", "TR 0", "MG \"a:b?\"", "RS", "FE X;BGX", "%", ";;", "AM", "OP 3", "LV",
)  # fmt: skip
KEYS = (
    Qt.Key.Key_Delete, Qt.Key.Key_Return, Qt.Key.Key_Escape, Qt.Key.Key_Tab, Qt.Key.Key_Up, Qt.Key.Key_Down,
    Qt.Key.Key_Space, Qt.Key.Key_F12, Qt.Key.Key_Home, Qt.Key.Key_End, Qt.Key.Key_Left, Qt.Key.Key_Right,
)  # fmt: skip
CONTROLLED = (
    Qt.Key.Key_Z, Qt.Key.Key_Y, Qt.Key.Key_C, Qt.Key.Key_X, Qt.Key.Key_V, Qt.Key.Key_A, Qt.Key.Key_D, Qt.Key.Key_M,
    Qt.Key.Key_I, Qt.Key.Key_E, Qt.Key.Key_U,
)  # fmt: skip
STIMULI = ("fls_x", "rls_x", "home_x", "abort")
PROGRAM = '#A\nPR 300\nBGX\nAMX\nMG "turn",_TPX\nWT 50\nIN "Length?",LEN\nJP#A,LEN>0\nEN'


class Wild:
    """`step` does one thing; what was done is kept, to be told when something breaks."""

    def __init__(self, stage: Stage, seed: int, folder: Path) -> None:
        self.stage, self.dice, self.folder = stage, random.Random(seed), folder
        self.done: list[str] = []
        self._ways: tuple[tuple[int, Callable[[], str]], ...] = (
            (30, self.click), (16, self.act), (8, self.add), (10, self.write), (10, self.press_key), (8, self.command),
            (6, self.happen), (3, self.link), (3, self.wait), (3, self.stop), (4, self.answer), (3, self.control),
        )  # fmt: skip
        self._closer = QTimer(interval=20)
        self._closer.timeout.connect(self._leave_blocking)
        self._closer.start()

    def step(self) -> None:
        """One thing, some time, then everything must be in order."""
        weights, ways = zip(*self._ways, strict=True)
        way = self.dice.choices(ways, weights)[0]
        self.done.append(f"{way.__name__}…")
        self.done[-1] = f"{way.__name__} {way()}"
        self.stage.go(self.dice.choice((1, 1, 2, 5)))
        self._file_dialogs()
        self._tidy()

    def end(self) -> None:
        """Nothing is left open."""
        self._closer.stop()
        for window in QApplication.topLevelWidgets():
            if isinstance(window, QDialog):
                window.close()
                window.deleteLater()
        QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        QApplication.clipboard().clear()  # off-screen it would outlive the interpreter that made what is in it

    # ---- what a person does

    def click(self) -> str:
        buttons = [each for each in self._shown(QAbstractButton) if self._allowed(each)]
        if not buttons:
            return ""
        button = self.dice.choice(buttons)
        QTest.mouseClick(button, LEFT, pos=QPoint(button.width() // 2, button.height() // 2))
        return f"{type(button).__name__} {button.text() or button.accessibleName()!r}"

    def act(self) -> str:
        actions = {**self.stage.studio.actions.actions, **self.stage.studio.program.commands}
        enabled = [name for name, action in actions.items() if action.isEnabled() and name not in NEVER]
        name = self.dice.choice(sorted(enabled))
        actions[name].trigger()
        return name

    def add(self) -> str:
        kind: type[Instruction] = self.dice.choice(ALL)
        palette = self.stage.studio.program.instructions
        palette.chosen.emit(kind)
        return kind.title

    def write(self) -> str:
        fields = [each for each in self._shown(QLineEdit) if each.isEnabled() and not self._is_file(each)]
        if not fields:
            return ""
        field, text = self.dice.choice(fields), self.dice.choice(TEXTS)
        box = field.parentWidget()
        if isinstance(box, QComboBox) and box.count():
            box.setCurrentIndex(self.dice.randrange(box.count()))
        field.setFocus()
        field.setText(text)
        if self.dice.random() < 0.5:
            QTest.keyClick(field, Qt.Key.Key_Return)
        return f"{field.accessibleName()!r}: {text!r}"

    def press_key(self) -> str:
        places = [*self._shown(QAbstractItemView), *self._shown(QPlainTextEdit)]
        focus = QApplication.focusWidget() or self.stage.studio.program.tree
        target = self.dice.choice(places) if places and self.dice.random() < 0.4 else focus
        if self._is_file(target):
            return ""
        if self.dice.random() < 0.4:
            key = self.dice.choice(CONTROLLED)
            QTest.keyClick(target, key, Qt.KeyboardModifier.ControlModifier)
            return f"Ctrl+{key.name} at {target.accessibleName()!r}"
        key = self.dice.choice(KEYS)
        QTest.keyClick(target, key)
        return f"{key.name} at {target.accessibleName()!r}"

    def command(self) -> str:
        terminal = self.stage.studio.terminal
        text = self.dice.choice(COMMANDS)
        terminal.line.setText(text)
        QTest.keyClick(terminal.line, Qt.Key.Key_Return)
        return text

    def answer(self) -> str:
        box = self.stage.studio.window.prompt
        text = self.dice.choice(("5", "0", *TEXTS))
        if box.isVisible():
            box.line.setText(text)
            QTest.keyClick(box.line, Qt.Key.Key_Return)
        return text

    def control(self) -> str:
        self.stage.studio.actions["take_control"].trigger()
        return str(self.stage.controller.control)

    def stop(self) -> str:
        QTest.keyClick(self.stage.studio.window, Qt.Key.Key_F12)
        return ""

    # ---- what the world does

    def happen(self) -> str:
        live = [rig for rig in self.stage.rigs if rig.controller is self.stage.controller]
        if not live:
            return ""
        if self.dice.random() < 0.15:
            live[0].simulation.stimulus("reset", 0)
            return "reset"
        if self.dice.random() < 0.2:
            live[0].start(PROGRAM)
            return "a program"
        there = [f"in{n}" for n in range(1, (self.stage.controller.model or MODELS["dmc1412"]).inputs + 1)]
        name, level = self.dice.choice([*there, *STIMULI]), self.dice.randrange(2)
        live[0].simulation.stimulus(name, level)
        return f"{name} {level}"

    def link(self) -> str:
        live = [rig for rig in self.stage.rigs if rig.controller is self.stage.controller]
        if live and self.dice.random() < 0.6:
            live[0].loopback.unplugged = not live[0].loopback.unplugged
            return f"unplugged {live[0].loopback.unplugged}"
        kind, model = self.dice.choice(("simulator", "machine")), self.dice.choice(("ssc1", "ssc2", "ssc4", "dmc1412"))
        self.stage.connect(kind, model, answers=False, program=PROGRAM if self.dice.random() < 0.5 else "")
        return f"{kind} {model}"

    def wait(self) -> str:
        seconds = self.dice.choice((0.3, 1.0, 3.0))
        self.stage.later(seconds)
        return f"{seconds:g} s"

    # ---- in order?

    def faults(self) -> list[str]:
        """What is not as it must always be."""
        found = []
        session = self.stage.studio.session
        if files.loads(files.dumps(session.document)) != session.document:
            found.append("the document is not what is read back from its file")
        for dialog in (
            each for each in QApplication.topLevelWidgets() if isinstance(each, QDialog) and each.isVisible()
        ):
            words = dialog.words if isinstance(dialog, Question) else " ".join(_texts(dialog))
            if isinstance(words, QLabel):
                words = words.text()
            if not dialog.windowTitle() or len(words) < 10 or "Traceback" in words:
                found.append(f"a window without a sentence: {dialog.windowTitle()!r} {words!r}")
            if isinstance(dialog, Question) and words.rstrip()[-1:] not in ".?:…)" and "\n\n" not in words:
                found.append(f"a question that does not end: {words!r}")
        if self.stage.controller.state is State.OFFLINE and self.stage.studio.run.doing:
            found.append(f"{self.stage.studio.run.doing!r} although nothing is connected")
        return found

    # ---- inside

    def _shown(self, kind: type[QWidget]) -> list[QWidget]:
        return [
            each
            for window in QApplication.topLevelWidgets()
            if window.isVisible()
            for each in (window.findChildren(kind))
            if each.isVisible() and each.isEnabled()
        ]

    def _allowed(self, button: QWidget) -> bool:
        default = getattr(button, "defaultAction", lambda: None)()
        name = default.objectName() if default is not None else ""
        words = button.text() if isinstance(button, QAbstractButton) else ""
        return name not in NEVER and words not in ("Exit", "Exit program") and not self._is_file(button)

    def _is_file(self, widget: QWidget) -> bool:
        return isinstance(widget.window(), QFileDialog)

    def _file_dialogs(self) -> None:
        """Files are chosen in the folder of the test only."""
        for dialog in (each for each in QApplication.topLevelWidgets() if isinstance(each, QFileDialog)):
            if not dialog.isVisible():
                continue
            if self.dice.random() < 0.5:
                dialog.reject()
                continue
            saves = dialog.acceptMode() is QFileDialog.AcceptMode.AcceptSave
            there = sorted(self.folder.glob("*.tlp")) + sorted(self.folder.glob("*.dmc"))
            name = self.folder / f"wild{self.dice.randrange(3)}.tlp" if saves or not there else self.dice.choice(there)
            dialog.close()
            dialog.fileSelected.emit(str(name))
            self.done.append(f"file {name.name}")

    def _tidy(self) -> None:
        dialogs = [each for each in QApplication.topLevelWidgets() if isinstance(each, QDialog) and each.isVisible()]
        for dialog in dialogs[4:]:
            dialog.close()

    def _leave_blocking(self) -> None:
        """Menus and boxes that run a loop of their own are left."""
        popup, modal = QApplication.activePopupWidget(), QApplication.activeModalWidget()
        if popup is not None:
            popup.close()
        if isinstance(modal, QMessageBox):
            modal.reject()


def _texts(dialog: QDialog) -> list[str]:
    """What can be read in a window."""
    labels = [each.text() for each in dialog.findChildren(QLabel) if each.isVisible()]
    pages = [each.toPlainText()[:200] for each in dialog.findChildren(QTextBrowser) if each.isVisible()]
    return [*labels, *pages, *(each.text() for each in dialog.findChildren(QPushButton) if each.isVisible())]
