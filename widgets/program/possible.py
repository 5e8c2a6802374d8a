"""What can be done to the program now; what cannot says why."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from PySide6.QtGui import QAction

from codegen.program import find
from widgets.program import clipboard
from widgets.program.commands import COMMANDS
from widgets.program.tree import ProgramTree

if TYPE_CHECKING:
    from widgets.program.editing import Editing

NEEDS_STEP = frozenset(
    {"modify", "comment_out", "view_code", "cut", "copy", "delete", "duplicate", "move_up", "move_down"}
)


def reason_of(name: str, session: Editing, tree: ProgramTree, chosen: Sequence[str]) -> str | None:
    """None when the command is possible now, else the reason in words; `chosen`: ids of the selected steps."""
    if name == "undo":
        return None if session.can_undo else "Nothing to undo"
    if name == "redo":
        return None if session.can_redo else "Nothing to redo"
    if name in NEEDS_STEP and not chosen:
        return "Select a step first"
    if name == "insert" and tree.current() is None:
        return "Select the step to insert before"
    if name == "end_of_repeat" and session.open_body is None and session.before is None:
        return "New steps already go to the end"
    if name == "paste" and not clipboard.has_steps():
        return "Copy steps of a program first"
    return None


def show_possible(commands: Mapping[str, QAction], session: Editing, tree: ProgramTree) -> None:
    """Greys what is not possible now; only what changed is touched."""
    chosen, program = tree.chosen(), session.document.program
    for row in COMMANDS:
        action, reason = commands[row.name], reason_of(row.name, session, tree, chosen)
        if action.isEnabled() != (reason is None) or action.statusTip() != (reason or row.help):
            action.setEnabled(reason is None)
            action.setStatusTip(reason or row.help)
            action.setToolTip(f"{reason or row.help} ({row.keys})")
    for name, label in (("undo", session.undo_text), ("redo", session.redo_text)):
        commands[name].setText(f"{name.capitalize()}: {label}" if label else name.capitalize())
    off = bool(chosen) and not any(find(program, step_id).enabled for step_id in chosen)
    commands["comment_out"].setText("Bring back" if off else "Comment out")
