"""Help pages: read from the files that are shipped, and written there from the tables: `python -m app.help_pages`."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import resources
from codegen.models import MODELS, Model
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.rows import Row
from codegen.twoletter.tables import ERROR_TEXTS, STOP_TEXTS

FOLDER = "help"
GENERATED = ("instructions", "reference")  # folders that are written, never edited


class Pages(Mapping[str, str]):
    """Every shipped page by its title; read when one is first wanted."""

    def __init__(self) -> None:
        self._pages: dict[str, str] | None = None

    def _read(self) -> dict[str, str]:
        if self._pages is None:
            texts = (path.read_text(encoding="utf-8") for path in sorted(resources.path(FOLDER).rglob("*.md")))
            self._pages = {title_of(text): text for text in texts}
        return self._pages

    def __getitem__(self, title: str) -> str:
        return self._read()[title]

    def __iter__(self) -> Iterator[str]:
        return iter(self._read())

    def __len__(self) -> int:
        return len(self._read())


def search_words() -> dict[str, tuple[str, ...]]:
    """What people type into the search, and the words that the pages use for it."""
    from app.help_tables import table

    return {typed: tuple(said) for typed, said in table("help_words")["words"].items()}


def title_of(text: str) -> str:
    """The heading of a page."""
    return text.partition("\n")[0].removeprefix("# ").strip()


def generated() -> dict[str, str]:
    """Every written page by its file: one for each instruction, the commands by group, error and stop codes, keys."""
    from app import help_tables
    from codegen.docs import pages

    files = {f"instructions/{_file(title)}": text for title, text in pages().items()}
    for group in dict.fromkeys(row.group for row in COMMANDS.values()):
        text = _commands_page(group)
        files[f"reference/{_file(title_of(text))}"] = text
    for text in (_codes_page(), _keys_page(), *help_tables.pages().values()):
        files[f"reference/{_file(title_of(text))}"] = text
    return files


def write(folder: Path) -> int:
    """Writes what has changed and removes what is no page any more; how many files changed."""
    wanted, changed = generated(), 0
    for name, text in wanted.items():
        path = folder / name
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8", newline="\n")
            changed += 1
    for name in GENERATED:
        for path in (folder / name).glob("*.md"):
            if f"{name}/{path.name}" not in wanted:
                path.unlink()
                changed += 1
    return changed


def _commands_page(group: str) -> str:
    rows = [row for _, row in sorted(COMMANDS.items()) if row.group == group]
    entries = [_command(row) for row in rows]
    return f"# Commands: {group}\n\n" + "\n\n".join(entries) + "\n"


def _command(row: Row) -> str:
    """One command: what it does, what it takes, where it is possible."""
    facts = [row.takes.value, *_limits(row)]
    if row.default is not None:
        facts.append(f"at first {row.default}")
    if not row.moving:
        facts.append("not while its axis moves")
    if not (row.program and row.port):
        facts.append("only in a program" if row.program else "only from the port")
    speaking = {name: each for name, each in MODELS.items() if each.family != "smartmotor"}
    having = {name: each for name, each in speaking.items() if each.family in row.families}
    models = [name.upper() for name, each in having.items() if row.name not in each.missing]
    if len(models) < len(speaking):
        facts.append(f"only on {', '.join(models)}" if models else "on no model here")
    return f"## {row.name}: {row.title}\n\n{row.help}\n\nTakes {'; '.join(facts)}.\n\n```\n{row.example}\n```"


def _limits(row: Row) -> list[str]:
    """Its range, where it is one and the same on the model with the most axes."""
    most: Model = MODELS["ssc4"]
    low, high = row.range_for(most) if row.low is not None or row.high is not None or row.high_from else (None, None)
    if low is None or high is None:
        return []
    return [f"{low} to {high}{f' {row.unit}' if row.unit and row.unit != 'flag' else ''}"]


def _codes_page() -> str:
    from app.help_tables import advice

    errors = "\n".join(f"| {code} | {text} | {advice('error', code)} |" for code, text in sorted(ERROR_TEXTS.items()))
    stops = "\n".join(f"| {code} | {text} | {advice('stop', code)} |" for code, text in sorted(STOP_TEXTS.items()))
    head = "| code | meaning | what to do |\n|---|---|---|\n"
    return (
        "# Error and stop codes\n\nWhat TC tells after a refused command (`?`) or when a program has stopped. "
        "What has no code stands under [Troubleshooting](page:Troubleshooting).\n\n"
        f"{head}{errors}\n\n## Stop codes\n\nWhat SC tells of an axis:\n\n{head}{stops}\n"
    )


def _keys_page() -> str:
    from app.actions import ROWS
    from widgets.program.commands import COMMANDS as STEPS

    keys = [("F12", "Stops all motion and all programs, whatever has the focus")]
    keys += [(row.shortcut, row.help) for row in ROWS if row.shortcut]
    keys += [(row.keys, row.help) for row in STEPS if row.keys]
    lines = "\n".join(f"| {key} | {words} |" for key, words in keys)
    return f"# Keys\n\n| key | does |\n|---|---|\n{lines}\n"


def _file(title: str) -> str:
    return re.sub(r"[^a-z0-9]+", "_", title.lower()).strip("_") + ".md"


def main() -> int:
    """Writes the pages into the shipped folder."""
    print(f"{write(resources.path(FOLDER))} help pages changed")
    return 0


if __name__ == "__main__":
    sys.exit(main())
