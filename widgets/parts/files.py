"""Choosing files in our own window, so that F12 works while it is open."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QWidget

PROGRAMS = "Programs (*.tlp)"
CODE = "Two-letter code (*.dmc)"
SETUPS = "Setups (*.tls)"
PICTURES = "Pictures (*.png)"
LOGS = "Logs (*.log *.txt)"


def ask_open(
    parent: QWidget, title: str, filters: str, call: Callable[[Path], None], folder: Path | None = None
) -> QFileDialog:
    """Shows the window at once and calls back with the file that was chosen."""
    dialog = _dialog(parent, title, filters, folder)
    dialog.setFileMode(QFileDialog.FileMode.ExistingFile)
    dialog.fileSelected.connect(lambda name: call(Path(name)))
    dialog.show()
    return dialog


def ask_save(
    parent: QWidget, title: str, filters: str, call: Callable[[Path], None], proposed: Path, suffix: str
) -> QFileDialog:
    """The same for a file to be written; an existing one is asked about by the window itself."""
    dialog = _dialog(parent, title, filters, proposed.parent)
    dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
    dialog.setDefaultSuffix(suffix)
    dialog.selectFile(proposed.name)
    dialog.fileSelected.connect(lambda name: call(Path(name)))
    dialog.show()
    return dialog


def _dialog(parent: QWidget, title: str, filters: str, folder: Path | None) -> QFileDialog:
    dialog = QFileDialog(parent, title, str(folder or Path.home()), f"{filters};;All files (*)")
    dialog.setOption(QFileDialog.Option.DontUseNativeDialog)
    dialog.setModal(False)
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    return dialog
