"""One run of the tuner as the logbook keeps it: gains, response, metrics, what was estimated, the operator's note."""

from __future__ import annotations

import dataclasses as dc
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np

from device.tuning.loop import Gains
from device.tuning.metrics import Metrics, Response

if TYPE_CHECKING:
    from numpy.typing import NDArray

TITLES = {"manual": "Manual", "automatic": "Automatic", "model": "Model-based", "move": "Move"}
TUNED = ("kp", "ki", "kd", "fv", "fa")
PLACES = 4  # decimals of a kept volt
AXES = ("X", "Y", "Z", "W")
MISSING = ("rise_time", "settling_time", "rest_time")  # of the metrics: there may be none


@dc.dataclass(frozen=True, eq=False)
class Entry:
    """`number` counts the runs of a machine; `when` is local time; `estimate` holds an identified plant in words."""

    number: int
    when: str
    axis: str
    method: str
    gains: Gains
    step: int  # counts
    response: Response
    metrics: Metrics | None = None
    words: str = ""
    estimate: Mapping[str, float | str] = dc.field(default_factory=dict)
    note: str = ""
    controller: str = ""

    @property
    def title(self) -> str:
        """As a row of the logbook names it."""
        return f"{self.number}  {self.axis}  {TITLES.get(self.method, self.method)}"


def gains_words(gains: Gains) -> str:
    """`KP 6, KI 0, KD 64`, and the feed-forwards where they are not 0."""
    told = {name: getattr(gains, name) for name in TUNED}
    return ", ".join(f"{name.upper()} {value:g}" for name, value in told.items() if value or name in TUNED[:3])


def to_data(entry: Entry) -> dict[str, Any]:
    """As it stands in the file."""
    data = {name: getattr(entry, name) for name in ("number", "when", "axis", "method", "step", "words", "note")}
    response = entry.response
    return {
        **data,
        "controller": entry.controller,
        "gains": dc.asdict(entry.gains),
        "metrics": None if entry.metrics is None else dc.asdict(entry.metrics),
        "estimate": dict(entry.estimate),
        "period": response.period,
        "commanded": _kept(response.commanded, 0),
        "actual": _kept(response.actual, 0),
        "volts": _kept(response.volts, PLACES),
    }


def from_data(data: Mapping[str, Any]) -> Entry:
    """What a file says; one of the errors that `Logbook` expects when it is no run."""
    commanded, actual, volts = (_array(data[name]) for name in ("commanded", "actual", "volts"))
    axis, period = str(data["axis"]), _real(data["period"])
    if axis not in AXES or period <= 0 or not 2 <= len(commanded) == len(actual) == len(volts):
        raise ValueError("no response of an axis")
    gains = Gains(**{name: _real(value) for name, value in data["gains"].items()})
    metrics = data["metrics"]
    if metrics is not None:
        metrics = Metrics(
            **{"every": period} | {name: _real(value, name in MISSING) for name, value in metrics.items()}
        )
    return Entry(
        int(_real(data["number"])), str(data["when"]), axis, str(data["method"]), gains, int(_real(data["step"])),
        Response(period, commanded, actual, volts), metrics, str(data["words"]), dict(data["estimate"]),
        str(data["note"]), str(data["controller"]),
    )  # fmt: skip


@overload
def _real(value: Any, missing: Literal[False] = False) -> float: ...
@overload
def _real(value: Any, missing: bool) -> Any: ...
def _real(value: Any, missing: bool = False) -> Any:
    """A number, or None where it may be `missing`; anything else would only be noticed when it is drawn."""
    if value is None and missing:
        return None
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError("no number")
    return float(value)


def _kept(values: NDArray[np.float64], places: int) -> list[float | None]:
    return [None if not math.isfinite(value) else round(float(value), places) for value in values]


def _array(values: list[float | None]) -> NDArray[np.float64]:
    return np.array([math.nan if value is None else float(value) for value in values], dtype=np.float64)
