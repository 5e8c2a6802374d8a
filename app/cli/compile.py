"""`twoletter compile`: a visual program becomes source."""

from __future__ import annotations

import argparse
import dataclasses
import json
import sys
from pathlib import Path

from app.cli import smartmotor
from app.cli.failure import DONE, NO, Failure
from app.cli.sources import errors_of, fitted, is_program, of_two_letters, read_document, readable, target, write_text
from codegen.generate import Listing, generate


def source_map(listing: Listing) -> str:
    """Which step every line comes from; lines count from 0 as in the controller, frame lines have no step."""
    lines = [{"line": number, "text": line.text, "step": line.step} for number, line in enumerate(listing.lines)]
    return json.dumps({"lines": lines}, indent=1, ensure_ascii=False) + "\n"


def compile(options: argparse.Namespace) -> int:
    """Writes the source of a program; with a problem in a step nothing is written, and it is named: 1."""
    path = Path(options.file)
    readable(path)
    if not is_program(path):
        raise Failure(f"{path}: not a program (.tlp)")
    output = target(options.output, path) if options.output else None
    where = target(options.map, path) if options.map else None
    document = read_document(path)
    if (options.controller or document.setup.model) == smartmotor.MODEL:
        if options.map:
            raise Failure(f"{path}: a source map (--map) is not made for a SmartMotor yet")
        return _written(smartmotor.source_of(document, path), output)
    of_two_letters(document.setup.model, path)
    if options.controller:
        document = fitted(document, None, options.controller, path)
    if options.compact:
        document = dataclasses.replace(document, compact=True)
    listing = generate(document)
    if wrong_setup := [each.message for each in listing.problems if each.severity == "error" and not each.step]:
        raise Failure(f"{path}: {wrong_setup[0]}")
    if errors := errors_of(listing):
        for message in errors:
            print(f"twoletter: {path}: {message}", file=sys.stderr)
        return NO
    if where:
        write_text(where, source_map(listing))
    return _written(listing.text if listing.text.endswith("\n") else listing.text + "\n", output)


def _written(text: str, output: Path | None) -> int:
    if output:
        write_text(output, text)
    else:
        sys.stdout.write(text)
    return DONE
