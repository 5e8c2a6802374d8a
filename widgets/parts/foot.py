"""The buttons at the foot of a dialog, everywhere in the order that people know from the rest of their computer."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtWidgets import QDialogButtonBox, QPushButton

Role = QDialogButtonBox.ButtonRole


def foot(
    main: QPushButton | None = None,
    *others: QPushButton,
    away: QPushButton | None = None,
    left: Sequence[QPushButton] = (),
    explains: QPushButton | None = None,
) -> QDialogButtonBox:
    """What the dialog is for, what else it can do, what closes it; apart from them what has to do with all of it."""
    box = QDialogButtonBox()
    if main is not None:
        main.setDefault(False)  # the box makes it the default of its dialog, once it is in one
    several: list[tuple[QPushButton | None, Role]] = [(main, Role.AcceptRole)]
    several += [(button, Role.ActionRole) for button in others]
    several += [(away, Role.RejectRole), (explains, Role.HelpRole)]
    several += [(button, Role.ResetRole) for button in left]  # every platform has these on the left
    for button, role in several:
        if button is not None:
            box.addButton(button, role)
    return box
