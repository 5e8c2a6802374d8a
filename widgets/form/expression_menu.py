"""A menu of what expressions are made of: variables, functions, operators, live values of the controller."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QMenu, QWidget

from codegen.expressions import FUNCTIONS
from codegen.twoletter.commands import COMMANDS
from widgets.form.offers import Offers

FUNCTION_HELP = {
    "ABS": "absolute value",
    "AN": "analog input, volts",
    "COM": "bitwise complement",
    "COS": "cosine of degrees",
    "FRAC": "part behind the point",
    "IN": "state of an input, 1 or 0",
    "INT": "part before the point",
    "OUT": "state of an output, 1 or 0",
    "RND": "rounded to a whole number",
    "SIN": "sine of degrees",
    "SQR": "square root",
}
OPERATORS = {
    "Arithmetic": (("+", "add"), ("-", "subtract"), ("*", "multiply"), ("/", "divide"), ("( )", "group")),
    "Comparison": (
        ("<", "less than"),
        (">", "greater than"),
        ("=", "equal"),
        ("<=", "at most"),
        (">=", "at least"),
        ("<>", "not equal"),
    ),
    "Logic": (("&", "and"), ("|", "or")),
}


class ExpressionMenu(QMenu):
    """Emits the text to put in, and how far the cursor goes back from its end."""

    chosen = Signal(str, int)

    def __init__(self, offers: Offers, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        variables = self.addMenu("Variables")
        for name in offers.variables:
            self._offer(variables, name, "", name, 0)
        variables.setEnabled(bool(offers.variables))
        functions = self.addMenu("Functions")
        for name in FUNCTIONS:
            self._offer(functions, f"@{name}[ ]", FUNCTION_HELP.get(name, ""), f"@{name}[]", 1)
        for title, operators in OPERATORS.items():
            menu = self.addMenu(title)
            for sign, meaning in operators:
                group = sign == "( )"
                self._offer(menu, sign, meaning, "()" if group else sign, 1 if group else 0)
        self._live_values(offers)

    def _live_values(self, offers: Offers) -> None:
        live = self.addMenu("Controller values")
        groups: dict[str, QMenu] = {}
        for name, row in COMMANDS.items():
            if not row.operand:
                continue
            if row.group not in groups:
                groups[row.group] = live.addMenu(str(row.group))
            suffixes = offers.setup.letters if row.operand == "axis" else " "
            for suffix in suffixes:
                text = f"_{name}{suffix}".strip()
                self._offer(groups[row.group], text, row.title, text, 0)

    def _offer(self, menu: QMenu, shown: str, meaning: str, text: str, back: int) -> None:
        action = menu.addAction(f"{shown}    {meaning}".rstrip().replace("&", "&&"))
        action.triggered.connect(lambda: self.chosen.emit(text, back))
