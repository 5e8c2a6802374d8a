"""What any instruction can tell about itself: sentence, problems, what is shown, what is really sent."""

from __future__ import annotations

import dataclasses as dc
from fractions import Fraction
from functools import lru_cache
from typing import Any

from codegen.fields import (
    AXES,
    AxisName,
    AxisSet,
    Context,
    Dimension,
    Field,
    ListOf,
    PathQuantity,
    PerAxis,
    Quantity,
    Smoothing,
    fields_of,
    is_shown,
    joined,
    value_of,
)
from codegen.instructions.instruction import Instruction
from codegen.setup import Finding, Setup, never_set_up, setup_problems
from codegen.template import Absent, Parts, filled, template

MISSING = "…"


def _word(item: Any, name: str, setup: Setup) -> str:
    """The text of one field, or `Absent`."""
    text = _word_or_none(item, name, setup)
    if text is None:
        raise Absent
    return text


def _word_or_none(item: Any, name: str, setup: Setup, letters: str = "") -> str | None:
    """The text of one field; None when it is empty or hidden. A row is told the axes of its path."""
    field = fields_of(item)[name]
    if not is_shown(item, name):
        return None
    value = getattr(item, name)
    if field.empty(value):
        return MISSING if field.required else None
    if isinstance(field, ListOf):
        return field.joint.join(_sentence_of(row, setup, row_axes(item, field)) for row in value)
    return field.text(value, context_of(item, name, setup, row_axis(field, letters))) or None


def _axis_word(item: Any, name: str, setup: Setup, letter: str) -> str:
    """The text of one field inside `<…>`: of a per-axis field the value of that axis."""
    field = fields_of(item).get(name)
    if not isinstance(field, PerAxis):
        return _word(item, name, setup)
    text = getattr(item, name)[AXES.index(letter)]
    if text == "" or not is_shown(item, name):
        raise Absent
    return field.of.text(text, Context(setup, letter))


def _each_axis(item: Any, parts: Parts, setup: Setup) -> str:
    """`<…>` for all axes that have a value; axes that read the same share one part."""
    groups: dict[str, list[str]] = {}
    for letter in AXES:
        if not any(
            getattr(item, name)[AXES.index(letter)]
            for name, field in fields_of(item).items()
            if isinstance(field, PerAxis)
        ):
            continue

        def words(name: str, letter: str = letter) -> str:
            return "\0" if name == "axis" else _axis_word(item, name, setup, letter)

        groups.setdefault(filled(parts, words, _no_each), []).append(letter)
    written = [text.replace("\0", joined(tuple(letters))) for text, letters in groups.items()]
    if not written:
        raise Absent
    return "; ".join(text if not place else _small(text) for place, text in enumerate(written))


def _small(text: str) -> str:
    """The same with a small first letter, unless an axis letter stands there."""
    return text if text[:1] in AXES and not text[1:2].isalpha() else text[:1].lower() + text[1:]


def _no_each(parts: Parts) -> str:
    raise AssertionError("<…> cannot stand inside <…>")


def _sentence_of(item: Any, setup: Setup, letters: str = "") -> str:
    known: dict[str, str | None] = {}

    def words(name: str) -> str:
        if name not in known:
            known[name] = _word_or_none(item, name, setup, letters)
        text = known[name]
        if text is None:
            raise Absent
        return text

    return filled(template(item.sentence), words, lambda parts: _each_axis(item, parts, setup))


def row_sentence(row: Any, setup: Setup, letters: str) -> str:
    """A row of a list as the sentence says it; `letters`: the axes that all rows move together."""
    text = _sentence_of(row, setup, letters)
    members = fields_of(row)
    return f"{next(iter(members.values())).label} {text}" if len(members) == 1 else text


def sentence(instruction: Instruction, setup: Setup) -> str:
    """The instruction in one line of plain English, with values and units."""
    text: str | None = instruction.recall("_sentence", setup)
    if text is None:
        text = _sentence(instruction, needed(instruction, setup))
        instruction.remember("_sentence", setup, text)
    return text


@lru_cache(maxsize=32768)
def _sentence(instruction: Instruction, setup: Setup) -> str:
    special = getattr(instruction, "samples_note", None)
    text = _sentence_of(instruction, setup)
    return text + special(setup) if special is not None else text


def axes_of(instruction: Instruction) -> str:
    """Letters of the axes for which an instruction holds a value in a unit."""
    letters = ""
    for name, field in fields_of(instruction).items():
        value = getattr(instruction, name)
        if field.empty(value) or not is_shown(instruction, name):
            continue
        if isinstance(field, PerAxis) and isinstance(field.of, Quantity):
            letters += field.given(value)
        elif isinstance(field, ListOf):
            letters += row_axes(instruction, field)
        elif isinstance(field, Quantity) and field.axis:
            letters += getattr(instruction, field.axis)
    return "".join(letter for letter in AXES if letter in letters)


# ---------------------------------------------------------------------- memos


@lru_cache(maxsize=256)
def _has_axes(kind: type[Any]) -> bool:
    return any(
        isinstance(field, AxisName | AxisSet | PerAxis)
        or (isinstance(field, Quantity | Smoothing) and field.axis)
        or (isinstance(field, ListOf) and any(name in fields_of(field.row) for name in ("axis", "axes")))
        for field in fields_of(kind).values()
    )


@lru_cache(maxsize=64)
def _without_axes(setup: Setup) -> Setup:
    return dc.replace(setup, axes=Setup().axes)


def needed(instruction: Instruction, setup: Setup) -> Setup:
    """The setup as far as an instruction depends on it: what is known of it stays known when a scale changes."""
    kind: Any = type(instruction)
    return setup if kind.uses_setup or _has_axes(kind) else _without_axes(setup)


# ---------------------------------------------------------------------- fields


def shown(instruction: Any, name: str) -> bool:
    """Whether a field is to be shown with the present values of the others."""
    return is_shown(instruction, name)


def context_of(item: Any, name: str, setup: Setup, axis: str = "") -> Context:
    """The context of a field: the setup, and the axis its sibling names."""
    field = fields_of(item)[name]
    if not axis and isinstance(field, Quantity | Smoothing) and field.axis:
        letter: str = getattr(item, field.axis, "")
        axis = letter if set(letter) <= set(AXES) else ""
    return Context(setup, axis)


def row_axes(item: Any, field: ListOf) -> str:
    """The axes that the rows of a list move together; "" where each row knows its own."""
    return str(getattr(item, field.axes)) if field.axes else ""


def row_axis(field: Field, letters: str) -> str:
    """What a field of a row is told of the axes of its path: only a value along the path belongs to all of them."""
    return letters if isinstance(field, PathQuantity) else ""


def _inner(item: Any, name: str, axis: str) -> tuple[Field, Any]:
    """Field and value; of a per-axis field those of one axis."""
    field = fields_of(item)[name]
    value = getattr(item, name)
    return (field.of, value[AXES.index(axis)]) if isinstance(field, PerAxis) and axis else (field, value)


def problem_of(item: Any, name: str, setup: Setup, axis: str = "") -> str | None:
    """What is wrong with one field (of a per-axis field: with one axis of it)."""
    if not is_shown(item, name):
        return None
    field = fields_of(item)[name]
    value = getattr(item, name)
    if isinstance(field, PerAxis) and axis:
        return field.problem_of(value, axis, Context(setup, axis))
    context = context_of(item, name, setup, axis)
    if not field.empty(value) and (absent := _absent(field, context)):
        return f"{field.label}: this controller has no axis {absent}"
    if problem := field.problem(value, context):
        return problem
    if isinstance(field, ListOf):
        return _rows_problem(field, value, setup, row_axes(item, field))
    return None


def _absent(field: Field, context: Context) -> str:
    """The axis that the controller lacks, of those a value belongs to: it has no scale to count with."""
    letters = context.axis if isinstance(field, Quantity) else ""
    return next((letter for letter in letters if letter not in context.setup.letters), "")


def _rows_problem(field: ListOf, rows: tuple[Any, ...], setup: Setup, letters: str) -> str | None:
    if field.most and len(rows) > field.most:
        return f"{field.label}: at most {field.most}"
    for number, row in enumerate(rows):
        found = (problem_of(row, name, setup, row_axis(each, letters)) for name, each in fields_of(row).items())
        if problem := next((each for each in found if each), None):
            return f"{field.label}, row {number + 1}: {problem}"
    return None


def warning_of(item: Any, name: str, setup: Setup, axis: str = "") -> str | None:
    """A warning where nobody set the scale up, or where rounding changes a value by more than 0.1 %."""
    field, value = _inner(item, name, axis)
    if isinstance(field, PerAxis | ListOf) or field.empty(value) or not is_shown(item, name):
        return None
    context = context_of(item, name, setup, axis)
    if _absent(field, context):
        return None  # that is its problem
    if isinstance(field, Quantity) and setup.converts(field.dimension):
        unscaled = (letter for letter in context.axis if not setup.axis(letter).is_set_up)
        if letter := next(unscaled, ""):
            return never_set_up(setup, letter)
    counts = field.counts(value, context)
    return counts.warning if counts else None


def counts_text(item: Any, name: str, setup: Setup, axis: str = "") -> str:
    """What is really sent for a field: `6370 counts`; empty where there is nothing to say."""
    field, value = _inner(item, name, axis)
    if isinstance(field, PerAxis | ListOf) or field.empty(value) or problem_of(item, name, setup, axis):
        return ""
    counts = field.counts(value, context_of(item, name, setup, axis))
    if counts is None:
        return ""
    return f"{counts.text}, rounded down to whole counts" if _is_cut(field, value) else counts.text


def _is_cut(field: Field, value: Any) -> bool:
    """Whether the controller works the length out itself: it takes the whole counts below (PR -0.5 goes by -1)."""
    length = isinstance(field, Quantity) and field.dimension in (Dimension.DISTANCE, Dimension.POSITION)
    return length and not isinstance(value_of(value), Fraction)


def unit_text(item: Any, name: str, setup: Setup, axis: str = "") -> str:
    """The unit shown behind a field: `in/s`."""
    field, _ = _inner(item, name, axis)
    return field.unit(context_of(item, name, setup, axis))


def problems(instruction: Instruction, setup: Setup) -> tuple[Finding, ...]:
    """Everything to put right in an instruction, errors before warnings."""
    return _problems(instruction, needed(instruction, setup))


@lru_cache(maxsize=32768)
def _problems(instruction: Instruction, setup: Setup) -> tuple[Finding, ...]:
    found: list[Finding] = []
    for name, field in fields_of(instruction).items():
        value = getattr(instruction, name)
        if field.when and not is_shown(instruction, name):
            continue
        if field.empty(value):
            if field.required:
                found.append(Finding(name, f"{field.label} is missing"))
        elif isinstance(field, PerAxis):
            for letter in field.given(value):
                text = value[AXES.index(letter)]
                problem = field.problem_of(value, letter, Context(setup, letter))
                _judge(found, name, field.of, text, Context(setup, letter), problem, letter)
        else:
            context = context_of(instruction, name, setup)
            problem = field.wrong(value, context)
            if problem is None and isinstance(field, ListOf):
                problem = _rows_problem(field, value, setup, row_axes(instruction, field))
            _judge(found, name, field, value, context, problem)
    if any(finding.severity == "error" for finding in found):
        return tuple(sorted(found, key=lambda finding: finding.severity))
    if own := instruction.own_problem() or _setup_problem(instruction, setup):
        found.insert(0, Finding(*own, rule="not-together"))
    elif reason := cannot(type(instruction), setup):
        found.insert(0, Finding("", reason, rule="not-on-model"))
    elif advice := instruction.own_warning(setup):
        found.append(Finding(*advice, "warning", rule="advice"))
    return tuple(found)


def _setup_problem(instruction: Instruction, setup: Setup) -> tuple[str, str] | None:
    """What is wrong with it on this machine, or in the setup with an instruction that sends the setup."""
    if not instruction.uses_setup:
        return instruction.setup_problem(setup)
    wrong = (finding.message for finding in setup_problems(setup) if finding.severity == "error")
    return next((("", message) for message in wrong), None)


def _judge(
    found: list[Finding], name: str, field: Field, value: Any, context: Context, problem: str | None, axis: str = ""
) -> None:
    """Notes what is wrong with one value, or that rounding changes it."""
    if problem:
        found.append(Finding(name, problem, "error", axis))
    elif field.warns and not _absent(field, context):
        counts = field.counts(value, context)
        if counts is not None and counts.warning:
            found.append(Finding(name, counts.warning, "warning", axis, rule="rounded"))


def has_errors(instruction: Instruction, setup: Setup) -> bool:
    """Whether the instruction cannot be sent as it stands."""
    return any(finding.severity == "error" for finding in problems(instruction, setup))


def cannot(kind: type[Instruction], setup: Setup) -> str | None:
    """Why this machine's controller cannot do the instruction at all; None when it can."""
    return kind.needs or None


def summary(instruction: Instruction) -> str:
    """Title and group, for lists of search results."""
    return f"{instruction.group}: {instruction.title}"
