"""What may not stand in any file of the project."""

from __future__ import annotations

import re

import pytest

from tests.long.table import README, rows_of, with_table
from tests.rules.sources import project_texts, relative

# Written in pieces so that this file does not find itself.
WORDS = (
    r"\bcl" + r"aude\b",
    r"\banth" + r"ropic\b",
    r"\bopen" + r"ai\b",
    r"\bchat" + r"gpt\b",
    r"\bcopil" + r"ot\b",
    r"\bco-authored" + r"-by\b",
    r"\bthis ses" + r"sion's\b",
    r"\bissue" + r" ?#?\d",
    r"\bissues" + r" show\b",
    r"\bdeveloper [A-H]" + r"\b",
)
PLACES = (
    r"py" + r"pi\.org",
    r"python" + r"hosted\.org",
    r"(extra-)?index" + r"-url",
    r"trusted" + r"-host",
    r"/work" + r"/(main|shared)",
    r"/tmp" + r"/board",
    r"/(home|Users)" + r"/[a-z]+/",
    r"/root" + r"/",
)
FORBIDDEN = re.compile("|".join((*WORDS, *PLACES)), re.IGNORECASE)
# Finds at least as much in small letters, many times faster: where it finds nothing, nothing is forbidden.
LIKELY = re.compile("|".join(each.removeprefix(r"\b") for each in (*WORDS, *PLACES)).lower())


def offences(text: str) -> list[tuple[int, str]]:
    """Line and text of every forbidden word."""
    if not LIKELY.search(text.lower()):
        return []
    return [
        (number, match.group()) for number, line in enumerate(text.splitlines(), 1) if (match := FORBIDDEN.search(line))
    ]


def test_no_file_names_tools_machines_or_registries() -> None:
    wrong = [
        f"{relative(path)}:{line}: {word}"
        for path in project_texts()
        for line, word in offences(path.read_text(encoding="utf-8", errors="replace"))
    ]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("text", ["--index" + "-url https://x", "see /work" + "/main/app", "fixes iss" + "ue 2"])
def test_a_planted_word_is_seen(text: str) -> None:
    assert offences(text)


def test_licence_readme_and_changes_are_there() -> None:
    names = {relative(path) for path in project_texts()}
    assert {"README.md", "LICENSE", "CONTRIBUTING.md", "CHANGELOG.md"} <= names


def test_the_readme_shows_the_measured_figures() -> None:
    text = README.read_text(encoding="utf-8")
    assert text == with_table(text, rows_of()), "write it with: python -m tests.long.table"
