"""Gains as the controller's registers hold them, and back."""

from __future__ import annotations

from collections.abc import Mapping

from codegen.twoletter.fixed import ONE, scaled
from device.tuning.loop import Gains

FIELDS = {"KP": "kp", "KI": "ki", "KD": "kd", "FV": "fv", "FA": "fa"}
ALL = {**FIELDS, "IL": "integrator_limit", "TL": "torque_limit", "OF": "offset"}


def registers(gains: Gains) -> dict[str, int]:
    """The five gains as the controller holds them."""
    return {name: scaled(float(getattr(gains, field))) for name, field in FIELDS.items()}


def gains_of(values: Mapping[str, int]) -> Gains:
    """Gains and what limits them, from registers."""
    return Gains(**{field: values[name] / ONE for name, field in ALL.items()})
