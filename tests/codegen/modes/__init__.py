"""Every mode of every instruction with what it promises."""

from __future__ import annotations

from tests.codegen.modes import motion, paths
from tests.codegen.modes.bench import Mode

MODES: tuple[Mode, ...] = (*motion.MODES, *paths.MODES)
