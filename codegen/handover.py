"""Author, revision and change notes of a program, and the comment that carries them into the controller."""

from __future__ import annotations

import dataclasses as dc
import re
import unicodedata

from codegen.models import Model

MARK = "NO "  # a comment that both families keep in memory; ' and REM stay with the host (commands.md, NO and REM)
SHORT_FAMILY, SHORT_COMMENT = "dmc141x", 38  # characters of a comment there (dmc-1412-1414.txt l.2536)
FOUND = re.compile(
    r"^NO (?P<name>[^,]*), rev (?P<revision>[^,]+)(?:, (?P<date>\d{4}-\d\d-\d\d))?(?:, by (?P<author>[^,]+))?$"
)


@dc.dataclass(frozen=True)
class Handover:
    """Who made it, which revision it is and since when, and what was changed: one line for each revision."""

    author: str = ""
    revision: str = ""
    date: str = ""  # of the revision, 2026-11-22
    changes: str = ""


@dc.dataclass(frozen=True)
class Stamp:
    """What the first line of a program in a controller tells."""

    name: str
    revision: str
    date: str = ""
    author: str = ""

    @property
    def words(self) -> str:
        """ "Wirecutter, revision C, 2026-11-22, by J. Smith"."""
        date = f", {self.date}" if self.date else ""
        author = f", by {self.author}" if self.author else ""
        return f"{self.name or 'a program without a name'}, revision {self.revision}{date}{author}"


def first_line(handover: Handover, name: str, model: Model) -> str:
    """The comment in front of the code; nothing without a revision. What does not fit goes from behind."""
    revision, date, author = _plain(handover.revision), handover.date.strip(), _plain(handover.author)
    if not revision:
        return ""
    room = min(model.columns, len(MARK) + SHORT_COMMENT if model.family == SHORT_FAMILY else model.columns)
    dated = f", {date}" if re.fullmatch(r"\d{4}-\d\d-\d\d", date) else ""
    signed = f", by {author}" if author else ""
    title = _plain(name)
    for behind in (f"{dated}{signed}", dated, ""):
        text = f"{MARK}{title}, rev {revision}{behind}"
        if len(text) <= room:
            return text
    rest = room - len(f"{MARK}, rev {revision}")
    return f"{MARK}{title[: max(rest, 0)].rstrip()}, rev {revision}"[:room].rstrip()


def stamp_of(line: str) -> Stamp | None:
    """What a first line tells; None when it is none of ours."""
    found = FOUND.match(line.strip())
    if found is None:
        return None
    return Stamp(found["name"].strip(), found["revision"].strip(), found["date"] or "", (found["author"] or "").strip())


def _plain(text: str) -> str:
    """Letters that the controller knows, without those that mean something in the line."""
    flat = unicodedata.normalize("NFKD", text.replace("ß", "ss"))
    known = "".join(letter for letter in flat if not unicodedata.combining(letter))
    kept = "".join(letter if " " <= letter <= "~" and letter not in ';\\,"' else " " for letter in known)
    return " ".join(kept.split())
