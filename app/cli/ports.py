"""`twoletter ports`: the serial ports of this computer."""

from __future__ import annotations

import argparse

from app.cli.failure import DONE
from device.find import ports as found_ports


def ports(_: argparse.Namespace) -> int:
    """One port a line; says so when there is none."""
    found = found_ports()
    for port in found:
        print("  ".join(part for part in (port.device, port.description, port.hardware) if part))
    if not found:
        print("no serial port found")
    return DONE
