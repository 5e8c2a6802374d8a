"""`twoletter import`: source becomes a visual program; what is not recognised stays two-letter code."""

from __future__ import annotations

import argparse
from pathlib import Path

from app.cli.failure import DONE, Failure
from app.cli.sources import is_program, load_any
from codegen.document import Document
from codegen.files import dumps
from codegen.setup import Setup


def import_source(options: argparse.Namespace) -> int:
    """Writes the program and says how much of it was recognised."""
    path, output = Path(options.file), Path(options.output)
    if is_program(path):
        raise Failure(f"{path}: already a program")
    if not is_program(output):
        raise Failure(f"{output}: a program's name ends in .tlp")
    if output.exists() and not options.force:
        raise Failure(f"{output} exists already (--force overwrites it)")
    loaded = load_any(path, options.controller)
    document = lifted(loaded.text, path.stem, loaded.setup)
    write(output, dumps(document))
    steps = list(document.program.steps())
    plain = sum(type(step.instruction).__name__ == "TwoLetterCode" for step in steps)
    print(f"{output}: {len(steps)} steps, {plain} of them 2-Letter Code")
    return DONE


def write(path: Path, text: str) -> None:
    """Writes the program."""
    from app.cli.sources import write_text

    write_text(path, text)


def lifted(text: str, name: str, setup: Setup) -> Document:
    """Source as a document."""
    from codegen.twoletter.lift import lift

    return lift(text, name, setup)
