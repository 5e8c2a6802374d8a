"""Source becomes a program of instructions; what is not recognised stays two-letter code, nothing is lost.

Every guess is proved twice: an instruction is taken only when the code it makes is the statements it replaces, and
the program only when the whole of its code is the source (up to the label and the EN that the frame of a program adds).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence

from codegen.document import Document
from codegen.fields import AXES, SYSTEM_LABELS
from codegen.generate import generate
from codegen.handover import Handover, stamp_of
from codegen.instructions import Comment, Instruction, Label, TwoLetterCode
from codegen.models import Model
from codegen.setup import Setup, Unit
from codegen.twoletter.lift.frame import WAYS, Way, frame
from codegen.twoletter.lift.moves import home, move, stop_and_wait
from codegen.twoletter.lift.same import makes, plain, refused, same_program
from codegen.twoletter.lift.settings import Found, pair, settings
from codegen.twoletter.lift.singles import MAKERS, equation
from codegen.twoletter.lift.tables import cam, contour
from codegen.twoletter.lift.tracks import path
from codegen.twoletter.lift.values import letters_of
from codegen.twoletter.nodes import Assign, Command, Foreign, Nothing, Source, Statement, Target
from codegen.twoletter.nodes import Comment as CommentNode
from codegen.twoletter.nodes import Label as LabelNode
from codegen.twoletter.parse import parse

__all__ = ["in_counts", "lift", "plain"]

NUMBERED = "Lines are counted in this program: a jump names a line, so nothing may be added or taken away above it."


@dataclasses.dataclass(frozen=True, slots=True)
class Piece:
    """A statement with its text and its line; a line that is not understood is one piece."""

    statement: Statement
    text: str
    line: int
    refused: bool = False


def in_counts(setup: Setup) -> Setup:
    """A setup whose axes are in counts, so that numbers of the source stay what they are."""
    for letter in AXES:
        axis = setup.axis(letter)
        if not axis.is_set_up:
            setup = setup.with_axis(letter, dataclasses.replace(axis, unit=Unit.COUNT))
    return setup


def pieces(source: Source, model: Model) -> Iterator[Piece]:
    """The statements of a source."""
    for number, line in enumerate(source.lines):
        alone = refused(line, model)
        if alone or any(isinstance(each, Foreign) for each in line.statements):
            yield Piece(line.statements[0], line.text.strip(), number, alone)
            continue
        for each in line.statements:
            if not isinstance(each, Nothing):
                yield Piece(each, line.text[each.span.start : each.span.end].strip(), number)


class _Reader:
    """Reads statements from the first to the last; remembers what later ones refer to."""

    def __init__(self, source: Source, setup: Setup, arrays: bool) -> None:
        self.setup = setup
        self.arrays = arrays
        self.pieces = list(pieces(source, setup.limits))
        self.statements = [piece.statement for piece in self.pieces]
        self.path_axes = ""
        self.master = "X"
        self.configuring = True

    def instructions(self) -> Iterator[Instruction]:
        """The whole source; neighbours that stay code share a step."""
        kept: list[Piece] = []
        place = 0
        while place < len(self.pieces):
            found = self.recognised(place)
            if found is None:
                if kept and (self.pieces[place].refused or kept[-1].refused):
                    yield _as_it_is(kept)
                    kept = []
                kept.append(self.pieces[place])
                self.configuring = False
                place += 1
                continue
            if kept:
                yield _as_it_is(kept)
                kept = []
            yield from found[0]
            self.configuring = self.configuring and all(_configures(each) for each in found[0])
            place += found[1]
        if kept:
            yield _as_it_is(kept)

    def recognised(self, place: int) -> Found | None:
        """The instructions that begin with this statement, and how many statements they are."""
        first = self.statements[place]
        if self.pieces[place].refused or isinstance(first, Foreign):
            return None
        following = self.statements[place:]
        if isinstance(first, Command):
            self.remember(first)
            if found := self.several(following):
                return found
        made = self.single(first)
        return ((made,), 1) if made is not None else None

    def remember(self, command: Command) -> None:
        """The axes of paths, the master of cams: what the commands behind them are about."""
        letters = letters_of(command, self.setup)
        if command.name in ("VM", "LM") and letters and set(letters) <= set(AXES):
            self.path_axes = letters[:2] if command.name == "VM" else letters
        elif command.name == "EA" and len(letters) == 1:
            self.master = letters

    def several(self, following: Sequence[Statement]) -> Found | None:
        """Instructions of several commands, the longest first."""
        setup = self.setup
        commands = []
        for each in following:
            if not isinstance(each, Command):
                break
            commands.append(each)
        if commands[0].name in ("DM", "DA") and not self.arrays:
            return None
        return (
            path(commands, setup, self.path_axes)
            or cam(commands, setup, self.master)
            or contour(commands, setup)
            or home(commands, setup)
            or move(commands, setup)
            or stop_and_wait(commands, setup)
            or pair(commands, setup)
            or settings(commands, setup, self.configuring)
        )

    def single(self, statement: Statement) -> Instruction | None:
        """The instruction of one statement."""
        made: Instruction | None = None
        if isinstance(statement, LabelNode):
            made = Label(name=statement.name)
            if statement.name in SYSTEM_LABELS:  # the frame makes a routine of it, or code
                return made
        elif isinstance(statement, CommentNode):
            if statement.mark != "NO":
                return Comment(text=statement.text.strip())
            made = Comment(text=statement.text.strip(), in_code=True)
        elif isinstance(statement, Command) and statement.name in MAKERS:
            made = MAKERS[statement.name](statement, self.setup)
        elif isinstance(statement, Assign):
            made = equation(statement, self.setup, self.configuring)
        return made if made is not None and makes((made,), (statement,), self.setup) else None


def _configures(each: Instruction) -> bool:
    return "C" in each.section or (isinstance(each, Label))


def _as_it_is(kept: Sequence[Piece]) -> TwoLetterCode:
    """Statements that stay code, those of a line together."""
    lines: list[str] = []
    for number, piece in enumerate(kept):
        if number and piece.line == kept[number - 1].line:
            lines[-1] += f";{piece.text}"
        else:
            lines.append(piece.text)
    return TwoLetterCode(text="\n".join(lines))


def without_freeing(source: Source) -> Source:
    """The source without the DA that the generator writes in front of the first array."""
    kept = [line for line in source.lines if line.statements]
    first = next((n for n, line in enumerate(kept) if _names(line.statements, "DM")), -1)
    start = first
    while start > 0 and _names(kept[start - 1].statements, "DA"):
        start -= 1
    return Source((*kept[:start], *kept[first:])) if 0 <= start < first else source


def _names(statements: Sequence[Statement], command: str) -> bool:
    return len(statements) == 1 and isinstance(statements[0], Command) and statements[0].name == command


def lift(text: str, name: str, setup: Setup) -> Document:
    """Source as a document: the boldest way to put its parts in their places that still writes the same source."""
    setup = in_counts(setup)
    source = parse(text)
    if _counts_lines(source):
        return _untouched(source, name, setup)
    stamp = stamp_of(source.lines[0].text) if source.lines else None
    made = Handover(author=stamp.author, revision=stamp.revision, date=stamp.date) if stamp else Handover()
    if stamp:
        source, name = Source(source.lines[1:]), stamp.name or name
    document = _proved(text, source, name, setup, made)
    if document is None and stamp:
        document = _proved(text, parse(text), name, setup, Handover())
    return document or _untouched(parse(text), name, setup)


def _proved(text: str, source: Source, name: str, setup: Setup, made: Handover) -> Document | None:
    """The boldest document that writes the source again; one whose every step becomes code comes first."""
    for wanted in ("complete", "same"):
        for each in WAYS:
            way = dataclasses.replace(each, named=bool(made.revision))
            document = Document(frame(_found(source, setup, way), name, way), setup, handover=made)
            listing = generate(document)
            if same_program(text, listing, setup.limits) and (wanted == "same" or listing.is_complete):
                return document
    return None


def _found(source: Source, setup: Setup, way: Way) -> list[Instruction]:
    """The instructions of a source; arrays only where the generator frees them as the source does."""
    if not way.arrays:
        return list(_Reader(source, setup, False).instructions())
    return list(_Reader(without_freeing(source), setup, True).instructions())


def _counts_lines(source: Source) -> bool:
    """Whether a jump names a line by its number."""
    return any(
        isinstance(argument, Target) and argument.line is not None
        for _, statement in source.statements()
        if isinstance(statement, Command)
        for argument in statement.arguments
    )


def _untouched(source: Source, name: str, setup: Setup) -> Document:
    """Every line as it is, in one step."""
    lines = "\n".join(line.text for line in source.lines if line.text.strip())
    found: list[Instruction] = [Comment(text=NUMBERED)] if _counts_lines(source) else []
    return Document(frame([*found, TwoLetterCode(text=lines)], name, WAYS[-1]), setup)
