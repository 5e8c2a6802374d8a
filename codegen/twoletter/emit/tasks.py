"""Threads, interrupts, the stack, the screen; stopping at once, moving on, gearing."""

from __future__ import annotations

from collections.abc import Iterator

from codegen.fields import AXES, Dimension
from codegen.instructions.following import (
    Aborted,
    AbortMotion,
    DisableGearing,
    ElectronicGearing,
    IncrementalPosition,
    Master,
)
from codegen.instructions.operator import Port
from codegen.instructions.tasks import (
    ClearScreen,
    Execute,
    Halted,
    HaltTask,
    Interrupt,
    Interrupts,
    Levels,
    Terminal,
    ZeroStack,
)
from codegen.twoletter.calls import Statement, by_axis, listed, numbers, simple, target
from codegen.twoletter.emit.build import Build, raw

ESCAPE = "{^27}"
CLEARING = {Terminal.HANDHELD: (ESCAPE, '"E"'), Terminal.ANSI: (ESCAPE, '"[2J"', ESCAPE, '"[H"')}
MASTERS = {Master.ENCODER: "", Master.COMMANDED: "C", Master.AUXILIARY: "D"}


def clear_screen(clear: ClearScreen, build: Build) -> Iterator[Statement]:
    port = "{P2}" if clear.port is Port.AUXILIARY else ""
    yield listed("MG", port + ",".join(CLEARING[clear.terminal]) + "{N}")


def execute(execute: Execute, build: Build) -> Iterator[Statement]:
    yield target("XQ", execute.label, raw(execute.thread))


def halt_task(halt: HaltTask, build: Build) -> Iterator[Statement]:
    yield simple("HX") if halt.which is Halted.ALL else numbers("HX", int(halt.thread))


def interrupt(interrupt: Interrupt, build: Build) -> Iterator[Statement]:
    """A run of inputs by its ends, others by a mask with bit 0 for input 1."""
    if interrupt.which is Interrupts.NONE:
        yield numbers("II", 0)
        return
    inputs = sorted({build.setup.input_number(row.input) or 0 for row in interrupt.inputs})
    if inputs == list(range(inputs[0], inputs[-1] + 1)):
        yield numbers("II", inputs[0], inputs[-1])
    else:
        yield numbers("II", None, None, sum(1 << number - 1 for number in inputs))


def zero_stack(zero: ZeroStack, build: Build) -> Iterator[Statement]:
    yield numbers("ZS", 1 if zero.levels is Levels.ONE else 0)


def abort_motion(abort: AbortMotion, build: Build) -> Iterator[Statement]:
    yield numbers("AB", 1) if abort.what is Aborted.MOTION else simple("AB")


def incremental_position(shift: IncrementalPosition, build: Build) -> Iterator[Statement]:
    yield by_axis("IP", build.by_axis(shift.distance, Dimension.DISTANCE))


def electronic_gearing(gearing: ElectronicGearing, build: Build) -> Iterator[Statement]:
    """A controller of one axis follows its auxiliary encoder and needs no master."""
    if build.setup.limits.family != "dmc141x":
        yield listed("GA", "S" if gearing.master is Master.PATH else MASTERS[gearing.master] + gearing.axis)
    yield by_axis("GR", {letter: raw(text) for letter, text in zip(AXES, gearing.ratio, strict=True) if text.strip()})


def disable_gearing(disable: DisableGearing, build: Build) -> Iterator[Statement]:
    yield by_axis("GR", dict.fromkeys(disable.axes, 0))
