"""Which arguments are expressions: the classes of `nodes.Expression`, for isinstance."""

from __future__ import annotations

from typing import Final

from codegen.twoletter.nodes import (
    Binary,
    Element,
    Function,
    Group,
    Keyword,
    Negative,
    Number,
    Operand,
    String,
    Variable,
)

VALUES: Final = (Number, String, Variable, Element, Operand, Keyword, Function, Negative, Binary, Group)
