"""The second language: five commands of the SmartMotor, enough to show that it needs nothing of the first."""

from __future__ import annotations

from codegen.smartmotor.emit import CANNOT, EMITTERS, NotYet, lines

__all__ = ["CANNOT", "EMITTERS", "NotYet", "lines"]
