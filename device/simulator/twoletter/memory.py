"""Program, variable and array memory: what fits, what is refused and with which error code."""

from __future__ import annotations

from typing import Final

from codegen.models import Model
from codegen.twoletter.nodes import Comment, Label
from codegen.twoletter.parse import parse_line
from device.simulator.twoletter.state import CommandError, Download, State

TOO_LONG: Final = 60
BAD_LABEL: Final = 61
TOO_MANY_LABELS: Final = 62
ARRAY_SPACE: Final = 66
TOO_MANY: Final = 67
UNDEFINED_ARRAY: Final = 82
BAD_INDEX: Final = 56
NAME_CHARACTERS: Final = 8


class DownloadRefused(Exception):
    """A program does not fit: the controller's error code, and the line from 0."""

    def __init__(self, code: int, line: int, text: str) -> None:
        super().__init__(f"line {line}: {text} ({code})")
        self.code = code
        self.line = line


# ------------------------------------------------------------------- program


def labels_of(lines: tuple[str, ...]) -> dict[str, int]:
    """Label names with their lines; the first of a doubled one."""
    labels: dict[str, int] = {}
    for number, text in enumerate(lines):
        if "#" in text:
            for statement in parse_line(text).statements:
                if isinstance(statement, Label):
                    labels.setdefault(statement.name, number)
    return labels


def is_host_comment(text: str) -> bool:
    """REM lines are the host's, which leaves them out of a download (dmc-1412-1414.txt l.2588)."""
    statements = parse_line(text).statements
    return bool(statements) and isinstance(statements[0], Comment) and statements[0].mark != "NO"


def bad_label(lines: tuple[str, ...], model: Model) -> tuple[int, int]:
    """Error code and line of the first label problem, or (0, 0)."""
    seen: set[str] = set()
    for number, text in enumerate(lines):
        if "#" not in text:
            continue
        for statement in parse_line(text).statements:
            if getattr(statement, "code", 0) == BAD_LABEL:
                return BAD_LABEL, number
            if isinstance(statement, Label):
                if statement.name in seen:
                    return BAD_LABEL, number
                seen.add(statement.name)
                if len(seen) > model.labels:
                    return TOO_MANY_LABELS, number
    return 0, 0


def add_line(download: Download, text: str, model: Model) -> None:
    """Takes one more line; after the first error the rest is ignored (error 60)."""
    if download.error:
        return
    count = len(download.before) + len(download.lines) + len(download.after)
    if len(text) > model.columns or count >= model.lines:
        download.error = TOO_LONG
        return
    parse_line(text)  # what it found is remembered, so that the end of the download is answered at once
    download.lines.append(text)


def finish_program(state: State, download: Download, model: Model) -> int:
    """Makes the received lines the program; the error code, or 0."""
    state.program = (*download.before, *download.lines, *download.after)
    return download.error or bad_label(state.program, model)[0]


def check_program(lines: tuple[str, ...], model: Model) -> None:
    """Refuses what a download would refuse."""
    for number, text in enumerate(lines):
        if len(text) > model.columns or number >= model.lines:
            raise DownloadRefused(TOO_LONG, number, "line too long or too many lines")
    code, number = bad_label(lines, model)
    if code:
        raise DownloadRefused(code, number, "duplicate, bad or too many labels")


# ----------------------------------------------------------------- variables


def set_variable(state: State, model: Model, name: str, value: int) -> None:
    """Assigns; a new name needs a free place."""
    variables = state.variables
    if name not in variables:
        if len(name) > NAME_CHARACTERS:
            raise CommandError(9)
        if len(variables) >= model.variables:
            raise CommandError(TOO_MANY)
    variables[name] = value


def element(state: State, name: str, index: int) -> int:
    """An array element."""
    array = state.arrays.get(name)
    if array is None:
        raise CommandError(UNDEFINED_ARRAY)
    if not 0 <= index < len(array):
        raise CommandError(BAD_INDEX)
    return array[index]


def set_element(state: State, name: str, index: int, value: int) -> None:
    """Assigns an array element."""
    element(state, name, index)
    state.arrays[name][index] = value


# -------------------------------------------------------------------- arrays


def free_elements(state: State, model: Model) -> int:
    """Elements that DM can still give (DM?, dmc-1412-1414.txt l.2691)."""
    return model.elements - sum(len(array) for array in state.arrays.values())


def free_arrays(state: State, model: Model) -> int:
    """Arrays that DM can still define (DA?, dmc-1412-1414.txt l.2691)."""
    return model.arrays - len(state.arrays)


def dimension(state: State, model: Model, name: str, size: int) -> None:
    """DM name[size]; size 0 frees the array (dmc-1412-1414.txt l.3341)."""
    if size == 0:
        state.arrays.pop(name, None)
        return
    if not 1 <= size <= model.elements:
        raise CommandError(6)
    if name in state.arrays:
        raise CommandError(57)
    if free_arrays(state, model) < 1:
        raise CommandError(TOO_MANY)
    if size > free_elements(state, model):
        raise CommandError(ARRAY_SPACE)
    state.arrays[name] = [0] * size
