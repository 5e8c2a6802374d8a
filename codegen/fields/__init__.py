"""Kinds of value an instruction can hold: what is wrong with a value, how it reads, what is sent for it.

Values are kept as the text the person typed ("" = not given); choices are members of a StrEnum, per-axis
values are four texts in the order X Y Z W.
"""

from __future__ import annotations

from codegen.fields.choices import AxisName, AxisSet, Choice, Flag, PerAxis, axes_problem, joined
from codegen.fields.field import (
    AXES,
    NONE,
    Context,
    Counts,
    Field,
    ListOf,
    PerAxisText,
    fields_of,
    is_shown,
    value,
)
from codegen.fields.numeric import (
    OFF,
    Condition,
    Dimension,
    ExpressionField,
    Limit,
    Number,
    Quantity,
    Smoothing,
    value_of,
)
from codegen.fields.paths import PathQuantity, base_letter
from codegen.fields.table import Table
from codegen.fields.texts import (
    LABEL,
    SYSTEM_LABELS,
    Code,
    InputNumber,
    LabelName,
    MessageText,
    OutputNumber,
    Text,
    VariableName,
)

__all__ = [
    "AXES",
    "LABEL",
    "NONE",
    "OFF",
    "SYSTEM_LABELS",
    "AxisName",
    "AxisSet",
    "Choice",
    "Code",
    "Condition",
    "Context",
    "Counts",
    "Dimension",
    "ExpressionField",
    "Field",
    "Flag",
    "InputNumber",
    "LabelName",
    "Limit",
    "ListOf",
    "MessageText",
    "Number",
    "OutputNumber",
    "PathQuantity",
    "PerAxis",
    "PerAxisText",
    "Quantity",
    "Smoothing",
    "Table",
    "Text",
    "VariableName",
    "axes_problem",
    "base_letter",
    "fields_of",
    "is_shown",
    "joined",
    "value",
    "value_of",
]
