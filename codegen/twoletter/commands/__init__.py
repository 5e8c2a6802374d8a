"""The one command table: every row of every group, in explicit lists."""

from __future__ import annotations

from codegen.models import MODELS
from codegen.twoletter.commands.commutation import COMMUTATION
from codegen.twoletter.commands.configuration import CONFIGURATION
from codegen.twoletter.commands.contour import CONTOUR
from codegen.twoletter.commands.coordinated import COORDINATED
from codegen.twoletter.commands.flow import FLOW
from codegen.twoletter.commands.io import IO
from codegen.twoletter.commands.limits import LIMITS
from codegen.twoletter.commands.messages import MESSAGES
from codegen.twoletter.commands.motion import MOTION
from codegen.twoletter.commands.servo import SERVO
from codegen.twoletter.commands.status import STATUS
from codegen.twoletter.commands.system import SYSTEM
from codegen.twoletter.commands.values import FUNCTION_ROWS, KEYWORD_ROWS, LATER, RECORDABLE
from codegen.twoletter.commands.waits import WAITS
from codegen.twoletter.rows import BOTH, FunctionRow, KeywordRow, Row, table

ALL: tuple[Row, ...] = (
    *CONFIGURATION,
    *IO,
    *MOTION,
    *COORDINATED,
    *CONTOUR,
    *FLOW,
    *WAITS,
    *MESSAGES,
    *SERVO,
    *LIMITS,
    *STATUS,
    *SYSTEM,
    *COMMUTATION,
)
COMMANDS: dict[str, Row] = table(ALL)
KEYWORDS: dict[str, KeywordRow] = {row.name: row for row in KEYWORD_ROWS}
FUNCTIONS: dict[str, FunctionRow] = {row.name: row for row in FUNCTION_ROWS}
FREE: frozenset[str] = frozenset(
    name
    for name, row in COMMANDS.items()
    if any(not row.known_to(model) for model in MODELS.values() if model.family in BOTH) and name.isalpha()
)
"""Commands that some controllers have not: a variable may have such a name there (`VS`, dmc-1412-1414.txt l.3245)."""

__all__ = ["ALL", "COMMANDS", "FREE", "FUNCTIONS", "KEYWORDS", "LATER", "RECORDABLE"]
