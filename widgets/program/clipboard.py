"""Steps on the clipboard: for ourselves with all they are, for other programs as plain code."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QMimeData
from PySide6.QtWidgets import QApplication

from widgets.program.model import STEPS_MIME


def put(ids: Sequence[str], steps: str, plain: str) -> None:
    """Copies steps (as text of a file) and what other programs are to see of them."""
    data = QMimeData()
    data.setData(STEPS_MIME, ("\n".join(ids) + "\f" + steps).encode())
    data.setText(plain)
    QApplication.clipboard().setMimeData(data)


def has_steps() -> bool:
    """Whether there is anything that could become a step."""
    data = QApplication.clipboard().mimeData()
    return data is not None and (data.hasFormat(STEPS_MIME) or data.hasText())


def take() -> tuple[str, str]:
    """What is there: ("steps", text of a file), ("code", two-letter code) or ("", "")."""
    data = QApplication.clipboard().mimeData()
    if data is None:
        return "", ""
    if data.hasFormat(STEPS_MIME):
        return "steps", bytes(data.data(STEPS_MIME).data()).decode().partition("\f")[2]
    return ("code", data.text()) if data.hasText() else ("", "")
