"""All checks of two-letter source, in the order of the text."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from codegen.models import Model
from codegen.twoletter.checks import flow, memory, motion, moving, ways
from codegen.twoletter.checks.line import line_problems
from codegen.twoletter.facts import Facts, gather
from codegen.twoletter.parse import parse
from codegen.twoletter.problems import Problem

CHECKS: tuple[Callable[[Facts], Iterator[Problem]], ...] = (
    memory.line_count,
    memory.label_count,
    memory.variable_count,
    memory.arrays,
    memory.elements,
    memory.whole_arrays,
    memory.before_dimension,
    memory.unassigned,
    memory.later_assignment,
    flow.duplicate_labels,
    flow.targets,
    flow.never_reached,
    flow.missing_end,
    flow.bare_stop,
    flow.input_threads,
    flow.wrong_returns,
    flow.stray_returns,
    ways.runs_into,
    ways.stack_grows,
    ways.call_depth,
    ways.sequences,
    moving.still_moving,
    motion.routine_missing,
    motion.recordings,
    motion.contours,
)


def check(source: str, model: Model) -> list[Problem]:
    """The problems of a program on that controller, sorted by place; SmartMotor sources are not two-letter."""
    if model.family == "smartmotor":
        return []
    tree = parse(source)
    problems = [
        replace(problem, line=number)
        for number, line in enumerate(tree.lines)
        for problem in line_problems(line.text, model)
    ]
    facts = gather(tree, model)
    for one in CHECKS:
        problems += one(facts)
    return sorted(set(problems), key=lambda problem: (problem.line, problem.column, problem.rule))
