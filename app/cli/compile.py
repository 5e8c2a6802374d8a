"""`twoletter compile`: a visual program becomes source."""

from __future__ import annotations

import argparse
import dataclasses
import json
import sys
from pathlib import Path

from app.cli.failure import DONE, NO, Failure
from app.cli.sources import errors_of, fitted, is_program, of_two_letters, read_document, write_text
from codegen.generate import Listing, generate


def source_map(listing: Listing) -> str:
    """Which step every line comes from; lines count from 0 as in the controller, frame lines have no step."""
    lines = [{"line": number, "text": line.text, "step": line.step} for number, line in enumerate(listing.lines)]
    return json.dumps({"lines": lines}, indent=1, ensure_ascii=False) + "\n"


def compile(options: argparse.Namespace) -> int:
    """Writes the source of a program; 1 when a step has a problem, which is then named."""
    path = Path(options.file)
    if not is_program(path):
        raise Failure(f"{path}: not a program (.tlp)")
    document = read_document(path)
    of_two_letters(document.setup.model, path)
    if options.controller:
        document = fitted(document, None, options.controller, path)
    if options.compact:
        document = dataclasses.replace(document, compact=True)
    listing = generate(document)
    errors = errors_of(listing)
    for message in errors:
        print(f"twoletter: {path}: {message}", file=sys.stderr)
    if options.map:
        write_text(Path(options.map), source_map(listing))
    text = listing.text if listing.text.endswith("\n") else listing.text + "\n"
    if options.output:
        write_text(Path(options.output), text)
    else:
        sys.stdout.write(text)
    return NO if errors else DONE
