"""A run in words: what was said, what went wrong, how things stand at the end."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from app.cli.sources import Loaded
from codegen.setup import Axis
from codegen.twoletter.problems import STOP_TEXTS

ENDS = {
    "end": "nothing runs or moves any more",
    "time": "the time was up",
    "error": "a program error",
}


def in_units(counts: float, axis: Axis) -> str:
    """A position in the user's unit behind its counts; nothing where no scale was set up."""
    if not axis.counts_per_unit or axis.scale == 1:
        return ""
    return f" ({float(counts / axis.scale):.4g} {axis.symbol})"


def timeline(state: dict[str, Any]) -> Iterator[str]:
    """Messages and errors, one line each."""
    for ms, port, text in state["messages"]:
        yield f"{ms:12.3f} ms  port {port}  {text}"
    for error in state["errors"]:
        handled = "  (handled by #CMDERR)" if error.get("handled") else ""
        yield f"error {error['code']} {error['text']} in line {error['line']}: {error['source']}{handled}"


def axes_lines(state: dict[str, Any], loaded: Loaded) -> Iterator[str]:
    """Where every axis stands."""
    for letter, values in state["axes"].items():
        axis = loaded.setup.axis(letter)
        stop = STOP_TEXTS.get(values["stop_code"], "")
        yield (
            f"{letter}: commanded {values['commanded']}{in_units(values['commanded'], axis)}, "
            f"actual {values['actual']}{in_units(values['actual'], axis)}, "
            f"motor {'on' if values['motor_on'] else 'off'}, stop code {values['stop_code']} {stop}".rstrip()
        )


def final_state(state: dict[str, Any], loaded: Loaded) -> Iterator[str]:
    """Axes, inputs, outputs and variables at the end."""
    yield from axes_lines(state, loaded)
    yield f"inputs {state['inputs']}, outputs {state['outputs']}"
    shown = {**state["variables"], **{name: repr(text) for name, text in state.get("strings", {}).items()}}
    for name, value in shown.items():
        yield f"{name} = {value}"


def report(
    state: dict[str, Any], stopped: str, virtual_seconds: float, loaded: Loaded, messages_shown: bool
) -> Iterator[str]:
    """The whole report of a run."""
    for line in timeline(state):
        if not (messages_shown and " ms  port " in line):
            yield line
    yield f"ended after {virtual_seconds:.3f} s: {ENDS[stopped]}"
    yield from final_state(state, loaded)
