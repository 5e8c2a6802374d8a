"""The automatic routines of a program: what calls them, and when they may be called (dmc-1412-1414.txt l.2967-3060)."""

from __future__ import annotations

from device.simulator.twoletter.state import Thread, Wait
from device.simulator.twoletter.unit import Unit

MC_TIMEOUT = 99  # stop code


def watched(unit: Unit) -> bool:
    """A sample may bring what calls a routine."""
    state = unit.state
    if not unit.routines or not state.threads[0].running:
        return False
    if "LIMSWI" in unit.routines or "POSERR" in unit.routines:
        return True
    return "ININT" in unit.routines and state.interrupt_armed


def call_due(unit: Unit) -> tuple[bool, bool]:
    """#LIMSWI, #POSERR and #ININT are called while their condition holds: whether one was, and whether one holds."""
    state, motion, main = unit.state, unit.clock.motion, unit.state.threads[0]
    at_limit = any(_limit_calls(unit, axis) for axis in unit.axes())
    beyond = any(motion.error_exceeded(axis) for axis in unit.axes())
    low = bool(state.interrupt_armed and ~state.inputs & state.interrupt_mask)
    holds = at_limit or beyond or low
    for due, label in ((at_limit, "LIMSWI"), (beyond, "POSERR"), (low, "ININT")):
        if due and _may_call(unit, main, label):
            if label == "ININT":
                state.interrupt_armed = not unit.profile.interrupt_once
            unit.call(main, label, main.pc)
            return True, holds
    return False, holds


def _limit_calls(unit: Unit, axis: int) -> bool:
    """The axis is driven into a limit switch, or (software_limit_routine) into FL or BL."""
    motion = unit.clock.motion
    direction = motion.driving_into_limit(axis)
    if not direction or unit.profile.software_limit_routine:
        return direction != 0
    level = motion.forward_level(axis) if direction > 0 else motion.reverse_level(axis)
    return level == (unit.state.switches[0] == 1)


def call_comint(unit: Unit) -> None:
    """A character or line came that CI wants to know of (l.3576)."""
    state, main = unit.state, unit.state.threads[0]
    state.comint_due = False
    if _may_call(unit, main, "COMINT"):
        state.comint_armed = False
        unit.call(main, "COMINT", main.pc)


def call_when_late(unit: Unit, wait: Wait) -> None:
    """MC gave up after TW: stop code 99, and #MCTIME (l.3049)."""
    main = unit.state.threads[0]
    late = [axis for axis in wait.axes if not unit.motion.in_position(axis)]
    for axis in late:
        unit.motion.set_stop_code(axis, MC_TIMEOUT)
    if late and _may_call(unit, main, "MCTIME"):
        unit.call(main, "MCTIME", main.pc)


def _may_call(unit: Unit, main: Thread, label: str) -> bool:
    return (
        main.running
        and label in unit.routines
        and len(main.stack) < unit.model.subroutine_levels
        and all(frame.kind != label for frame in main.stack)
    )
