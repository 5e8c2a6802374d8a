"""An unexpected error: motion is stopped first, then it is written down and shown; the program stays up."""

from __future__ import annotations

import platform
import sys
import threading
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from types import TracebackType

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import (
    QApplication,
    QDialog,
    QLabel,
    QPlainTextEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from widgets.parts.foot import foot

Hook = Callable[[type[BaseException], BaseException, TracebackType | None], object]


class CrashDialog(QDialog):
    """Not modal: what happened, where it is written down, and the text to hand on."""

    def __init__(self, text: str, path: Path | None, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Something went wrong in the studio")
        self.setModal(False)
        where = f"It is written down in {path}." if path is not None else "It could not be written down."
        words = QLabel(
            "Something went wrong in the studio, not in your work. A stop was sent first. "
            f"Your program file is untouched and you can go on; saving now is wise.\n{where}"
        )
        words.setWordWrap(True)
        self.text = QPlainTextEdit(text)
        self.text.setReadOnly(True)
        self.text.setAccessibleName("Error text")
        self.copy_button, self.close_button = QPushButton("Copy text"), QPushButton("Go on")
        self.close_button.setProperty("role", "primary")
        self.copy_button.clicked.connect(lambda: QGuiApplication.clipboard().setText(text))
        self.close_button.clicked.connect(self.accept)
        column = QVBoxLayout(self)
        column.setContentsMargins(24, 24, 24, 16)
        column.setSpacing(16)
        column.addWidget(words)
        column.addWidget(self.text, 1)
        column.addWidget(foot(away=self.close_button, left=(self.copy_button,)))
        self.resize(720, 440)


class CrashHook(QObject):
    """Takes over sys.excepthook; `uninstall` gives it back."""

    happened = Signal(str, object)  # text, path

    def __init__(self, folder: Path, stop: Callable[[], None], parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._folder, self._stop = folder, stop
        self._busy = False
        self._before: Hook = sys.excepthook
        self._before_thread = threading.excepthook
        self.dialogs: list[CrashDialog] = []
        self.happened.connect(self._show)

    def install(self) -> None:
        """From now on unexpected errors end here."""
        sys.excepthook = self.take
        threading.excepthook = self._take_thread

    def uninstall(self) -> None:
        """Gives the hooks back."""
        sys.excepthook = self._before
        threading.excepthook = self._before_thread

    def take(self, kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        """Stop first, then write, then show."""
        if issubclass(kind, KeyboardInterrupt):
            self._before(kind, error, trace)
            return
        text = report("".join(traceback.format_exception(kind, error, trace)))
        if self._busy:  # the stop itself failed, or the writing
            self._before(kind, error, trace)
            return
        self._busy = True
        try:
            self._stop()
        finally:
            path = write_report(self._folder, text)
            self._busy = False
            self._before(kind, error, trace)
            self.happened.emit(text, path)

    def _take_thread(self, args: threading.ExceptHookArgs) -> None:
        if args.exc_value is not None:
            self.take(args.exc_type, args.exc_value, args.exc_traceback)

    def _show(self, text: str, path: Path | None) -> None:
        if QApplication.instance() is None or any(dialog.isVisible() for dialog in self.dialogs):
            return
        parent = QApplication.activeWindow()
        dialog = CrashDialog(text, path, parent)
        self.dialogs = [dialog]
        dialog.show()


def report(trace: str) -> str:
    """The text of a crash file."""
    return f"Python {platform.python_version()} on {platform.system()} {platform.release()}\n\n{trace}"


def write_report(folder: Path, text: str) -> Path | None:
    """Writes `crash-DATE.txt`; None when that fails too."""
    path = folder / time.strftime("crash-%Y-%m-%d-%H%M%S.txt")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    except OSError:
        return None
    return path
