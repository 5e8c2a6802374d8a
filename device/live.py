"""Live values: one row each, how it is read and shown, in the controller's own units (counts, counts/s, V)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from codegen.models import Model
from device.wire import Shape


@dataclass(frozen=True, slots=True)
class Live:
    """One live value; `expression` has `{axis}` where it is one per axis.

    `quick` ones are read in every round, `slow` ones once a second, the others in turn; what is both, in every round
    while a program runs.
    """

    name: str
    label: str
    dimension: str
    expression: str
    digits: int = 10
    decimals: int = 0
    per_axis: bool = True
    slow: bool = False
    quick: bool = False

    @property
    def shape(self) -> Shape:
        return Shape(self.digits, self.decimals)


AT = "at"  # a position of the same moment as the commanded one and the error: read with them, in one exchange
TOGETHER_COLUMNS = 54  # of a line that reads all three
TOGETHER = ("commanded", "error", AT)
ROWS: tuple[Live, ...] = (
    Live("position", "Position", "position", "_TP{axis}", quick=True),
    Live("commanded", "Commanded position", "position", "_RP{axis}"),
    Live("error", "Position error", "position", "_TE{axis}"),
    Live(AT, "Position beside commanded and error", "position", "_TP{axis}"),
    Live("velocity", "Velocity", "speed", "_TV{axis}", 8),
    Live("torque", "Motor command", "voltage", "_TT{axis}", 2, 4, slow=True),
    Live("auxiliary", "Auxiliary encoder", "position", "_TD{axis}"),
    Live("switches", "Switches", "bits", "_TS{axis}", 3),
    Live("stop_code", "Stop code", "code", "_SC{axis}", 3, slow=True),
    Live("motor_off", "Motor off", "flag", "_MO{axis}", 1, slow=True),
    Live("moving", "Moving", "flag", "_BG{axis}", 1, quick=True),
    Live("forward_limit", "Forward limit", "flag", "_LF{axis}", 1),
    Live("reverse_limit", "Reverse limit", "flag", "_LR{axis}", 1),
    Live("home", "Home switch", "flag", "_HM{axis}", 1),
    Live("latch", "Latched position", "position", "_RL{axis}", slow=True),
    Live("inputs", "Inputs", "bits", "_TI", 3, per_axis=False, quick=True),
    Live("outputs", "Outputs", "bits", "_OP", 5, per_axis=False),
    Live("status", "Status byte", "bits", "_TB", 3, per_axis=False),
    Live("time", "Controller clock", "time", "TIME", 10, per_axis=False),
    Live("period", "Sample period (TM)", "time", "_TM", 5, per_axis=False, slow=True),
    Live("error_code", "Error code", "code", "_TC", 3, per_axis=False, slow=True),
    Live("thread0", "Line of thread 0", "line", "_XQ0", 4, per_axis=False, quick=True, slow=True),
    *(Live(f"thread{n}", f"Line of thread {n}", "line", f"_XQ{n}", 4, per_axis=False) for n in range(1, 4)),
    *(Live(f"analog{n}", f"Analog input {n}", "voltage", f"@AN[{n}]", 2, 4, per_axis=False) for n in range(1, 9)),
)
LIVE: dict[str, Live] = {row.name: row for row in ROWS}


def key(name: str, axis: str = "") -> str:
    """`position.x` for a value per axis, `inputs` for a plain one."""
    return f"{name}.{axis.lower()}" if axis else name


def split(live_key: str) -> tuple[Live, str]:
    """The row and the axis letter (or nothing) of a key; KeyError for an unknown one."""
    name, _, axis = live_key.partition(".")
    return LIVE[name], axis.upper()


def columns(model: Model) -> tuple[str, ...]:
    """The keys of everything a controller of this type can tell."""
    found: list[str] = []
    for row in ROWS:
        if row.name == AT and model.columns < TOGETHER_COLUMNS:
            continue
        if row.per_axis:
            found += [key(row.name, axis) for axis in model.axes]
        elif not _beyond(row.name, model):
            found.append(row.name)
    return tuple(found)


def _beyond(name: str, model: Model) -> bool:
    """Whether the model has fewer threads or analog inputs than this row needs."""
    if name.startswith("thread"):
        return int(name[6:]) >= model.threads
    return name.startswith("analog") and int(name[6:]) > model.analog_inputs


def expression(live_key: str) -> tuple[str, Shape]:
    """How a key is read: `_TPX` and its number's shape."""
    row, axis = split(live_key)
    return row.expression.format(axis=axis), row.shape


def beside(values: Mapping[str, float]) -> dict[str, float]:
    """The positions among what one exchange has told that stand beside an error and a commanded position."""
    axes = (axis for name, axis in map(_parts, values) if name == "position")
    return {
        key(AT, axis): values[key("position", axis)]
        for axis in axes
        if {key("commanded", axis), key("error", axis)} <= values.keys()
    }


def _parts(live_key: str) -> tuple[str, str]:
    name, _, axis = live_key.partition(".")
    return name, axis


def known(keys: Sequence[str], available: Sequence[str]) -> tuple[str, ...]:
    """The asked keys that exist here, each once, in column order."""
    wanted = set(keys)
    return tuple(name for name in available if name in wanted)
