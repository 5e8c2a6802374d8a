"""What can be done to the program from menu, right click and keyboard: one row each."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QWidget

from widgets.parts.icons import icon


@dataclass(frozen=True)
class CommandRow:
    """Name of the method of the program view, words, keys, picture, and what it does in one sentence."""

    name: str
    text: str
    keys: str
    picture: str
    help: str
    in_menu: bool = True  # of the right click; its keys work in the program, those of the others in the whole window


COMMANDS = (
    CommandRow("print_program", "Print program…", "Ctrl+P", "", "The program in English: preview, printer, PDF", False),
    CommandRow("print_code", "Print code…", "Ctrl+Shift+P", "", "The two-letter code: preview, printer, PDF", False),
    CommandRow("undo", "Undo", "Ctrl+Z", "undo", "Takes the last change back", False),
    CommandRow("redo", "Redo", "Ctrl+Y", "redo", "Makes the change again that was taken back", False),
    CommandRow("modify", "Modify…", "Ctrl+M", "edit", "Opens the dialog of the step (Enter or double click)"),
    CommandRow("insert", "Insert before…", "Ctrl+I", "add", "The next new step goes in front of this one"),
    CommandRow("comment", "Insert comment…", "Ctrl+E", "comment", "Adds a remark in front of this step"),
    CommandRow(
        "comment_out", "Comment out", "Ctrl+U", "close", "Keeps the step but sends nothing; again brings it back"
    ),
    CommandRow("view_code", "View code", "Ctrl+D", "code", "Shows the two-letter code of the step"),
    CommandRow("cut", "Cut", "Ctrl+X", "cut", "Takes the steps out, to be pasted elsewhere"),
    CommandRow("copy", "Copy", "Ctrl+C", "copy", "Copies the steps"),
    CommandRow("paste", "Paste", "Ctrl+V", "paste", "Adds the copied steps in front of the selected one"),
    CommandRow("duplicate", "Duplicate", "Ctrl+Shift+D", "duplicate", "Adds the same steps again behind these"),
    CommandRow("delete", "Delete", "Del", "delete", "Removes the steps; Undo brings them back"),
    CommandRow("move_up", "Move up", "Alt+Up", "up", "Moves the steps one place up"),
    CommandRow("move_down", "Move down", "Alt+Down", "down", "Moves the steps one place down"),
    CommandRow("fold_all", "Fold all", "Alt+Left", "up", "Hides what subroutines and repeats hold", False),
    CommandRow("unfold_all", "Unfold all", "Alt+Right", "down", "Shows what subroutines and repeats hold", False),
    CommandRow("end_of_repeat", "End of repeat", "Ctrl+Return", "loop", "New steps go behind the repeat again", False),
    CommandRow("find_text", "Find…", "Ctrl+F", "search", "Finds words in the English and the code", False),
    CommandRow("replace_text", "Replace…", "Ctrl+H", "", "Replaces names, numbers and notes you typed", False),
    CommandRow("find_next", "Find next", "F3", "", "The next step that holds what was searched", False),
    CommandRow("find_previous", "Find previous", "Shift+F3", "", "The step before that holds it", False),
    CommandRow("find", "Find instruction", "Ctrl+Shift+F", "search", "Searches the instructions", False),
    CommandRow("trace", "Trace", "F8", "", "Follows a thread of the running program by its instructions", False),
    CommandRow("program_status", "Program status…", "Shift+F8", "", "The threads and what they wait for", False),
    CommandRow("mode_program", "Program", "Ctrl+1", "program", "Plain English beside its code", False),
    CommandRow("mode_both", "Both", "Ctrl+2", "both", "Plain English and the whole code side by side", False),
    CommandRow("mode_code", "Code", "Ctrl+3", "code", "Only the two-letter code", False),
)


def make_actions(owner: QWidget) -> dict[str, QAction]:
    """An action for each row; it calls the method of that name."""
    actions = {}
    for row in COMMANDS:
        action = QAction(row.text, owner)
        if row.picture:
            action.setIcon(icon(row.picture))
        action.setShortcut(QKeySequence(row.keys))
        action.setToolTip(f"{row.help} ({row.keys})")
        action.setStatusTip(row.help)
        action.triggered.connect(getattr(owner, row.name))
        actions[row.name] = action
    return actions
