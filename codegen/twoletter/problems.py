"""Problems as data: what is wrong, where, and the rule behind it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from codegen.twoletter.advice import ARRIVED as ARRIVED
from codegen.twoletter.advice import FOUND as FOUND
from codegen.twoletter.advice import RUNNING as RUNNING
from codegen.twoletter.advice import STOP_STEPS as STOP_STEPS
from codegen.twoletter.advice import USUAL_STEP as USUAL_STEP
from codegen.twoletter.advice import error_step as error_step
from codegen.twoletter.tables import ERROR_TEXTS as ERROR_TEXTS
from codegen.twoletter.tables import LATER_ERROR_TEXTS as LATER_ERROR_TEXTS
from codegen.twoletter.tables import NO_BITS as NO_BITS
from codegen.twoletter.tables import STOP_TEXTS as STOP_TEXTS
from codegen.twoletter.tables import TB_BITS as TB_BITS
from codegen.twoletter.tables import TS_BITS as TS_BITS

Severity = Literal["error", "warning"]


@dataclass(frozen=True, slots=True)
class Problem:
    """One finding; `line`, `column` and `end` count from 0, `code` is the controller's error code (0: none)."""

    rule: str
    severity: Severity
    line: int
    column: int
    end: int
    message: str
    code: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """One rule: its message with {values}, and a snippet that breaks it and one that does not."""

    name: str
    severity: Severity
    message: str
    bad: str
    good: str
    model: str = "ssc4"
    code: int = 0

    def problem(self, line: int, column: int, end: int, code: int = 0, **values: object) -> Problem:
        """A finding of this rule at that place."""
        return Problem(self.name, self.severity, line, column, end, self.message.format(**values), code or self.code)


def by_name(rows: tuple[Rule, ...]) -> dict[str, Rule]:
    """The rules by name; two of one name are a fault of the table."""
    rules = {row.name: row for row in rows}
    assert len(rules) == len(rows), "two rules of one name"
    return rules
