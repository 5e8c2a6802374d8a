"""Every mode of every instruction with what it promises."""

from __future__ import annotations

from tests.codegen.modes import flow, machine, motion, paths, ports, records, talk, waits
from tests.codegen.modes.bench import Mode

MODES: tuple[Mode, ...] = tuple(
    mode for group in (motion, paths, flow, talk, waits, machine, ports, records) for mode in group.MODES
)
