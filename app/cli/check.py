"""`twoletter check`: problems of source and programs, as editors read them."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from app.cli.failure import DONE, NO
from app.cli.sources import Loaded, load_any
from codegen.generate import Listing
from codegen.twoletter.check import check as check_source

Row = dict[str, object]


def row(path: Path, place: tuple[int, int, int], severity: str, code: str, message: str) -> Row:
    """One finding; line and columns count from 1."""
    line, column, end = place
    return {
        "file": str(path),
        "line": line,
        "column": column,
        "end": end,
        "severity": severity,
        "code": code,
        "message": message,
    }


def first_line(listing: Listing, step: str) -> int:
    """The first line a step brings, from 1; 1 where it brings none."""
    lines = list(listing.lines_of(step)) if step else []
    return lines[0] + 1 if lines else 1


def findings(loaded: Loaded) -> list[Row]:
    """Everything that is wrong with one file, in the order of its lines."""
    rows = []
    if loaded.listing:
        for finding in loaded.listing.problems:
            place = first_line(loaded.listing, finding.step)
            rows.append(row(loaded.path, (place, 1, 1), finding.severity, finding.code, finding.message))
    for problem in check_source(loaded.text, loaded.model):
        place = (problem.line + 1, problem.column + 1, problem.end + 1)
        rows.append(row(loaded.path, place, problem.severity, problem.rule, problem.message))
    return sorted(rows, key=lambda each: (each["line"], each["column"]))  # type: ignore[arg-type,return-value]


def check(options: argparse.Namespace) -> int:
    """Prints the problems of every file; 1 when one of them is an error."""
    rows: list[Row] = []
    for name in options.files:
        rows += findings(load_any(Path(name), options.controller))
    if options.json:
        print(json.dumps(rows, indent=1, ensure_ascii=False))
    else:
        for each in rows:
            print("{file}:{line}:{column}: {severity} {code} {message}".format_map(each))
    return NO if any(each["severity"] == "error" for each in rows) else DONE
