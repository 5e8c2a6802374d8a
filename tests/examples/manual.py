"""A scan of the manuals' text for lines of code: which there are is kept in `manual-lines.txt`.

`python -m tests.examples.manual` prints what it finds, `… --write` renews the list. The manuals are not part of the
project: they are looked for in the folder that TWOLETTER_MANUALS names, or in `shared/manuals` beside the project.
"""

from __future__ import annotations

import os
import re
import sys
from dataclasses import dataclass
from pathlib import Path

from tests.facts.sheet import sheet

HERE = Path(__file__).parent
LIST = HERE / "manual-lines.txt"
FILES = {"dmc": "dmc-1412-1414.txt", "ssc": "ssc-tol-o-motion.txt"}
# Chapters 2 to 8 and the terminal of the appendix; chapter 3's links and chapter 5 of the other manual.
RANGES = {"dmc": (range(349, 4214), range(5340, 5376)), "ssc": (range(1170, 1250), range(1450, 2948))}

NAMES = "|".join(sorted(name for name in sheet() if re.fullmatch("[A-Z]{2}", name)))
COMMAND = re.compile(rf"(?:[!%]\d?)?(?:{NAMES}|REM)(?:[XYZWSABCDN]{{0,4}}|_[A-Z]{{2}})(?=$|[^A-Za-z_'’:/.)])")
LABEL = re.compile(r"#\s?[A-Za-z0-9]{1,8}(?=$|[^A-Za-z0-9])|%\d")
NAME = r"[A-Za-z][A-Za-z0-9]{0,7}(?:\s?\[[A-Z0-9a-z]+\])?"
ASSIGNED = re.compile(rf"{NAME}\s*=\s*(?=$|[-+$\"@_({{A-Za-z0-9.])")
CONDITION = re.compile(r"@[A-Z]{2,4}\[|_[A-Z]{2}|[A-Z]\w*[<>=]")
SCANNED = re.compile(r"(?:Instruction ?Interpretation|Interpretation Instruction)\s*\S")
MARKS = re.compile(r"</?[A-Za-z][^<>]*>|<(?:CR|cr|enter|return)>|\$\$|<c<td[^>]*>")
BULLET = re.compile(r"^(?:- |\d\. |:)+ ?")
LONGEST = 90  # characters of a line that are kept


@dataclass(frozen=True)
class CodeLine:
    """One line of a manual that looks like code; `text` without what explains it."""

    manual: str
    line: int
    text: str

    @property
    def place(self) -> str:
        """As the examples name it."""
        return f"{self.manual}:{self.line}"


def code_in(text: str) -> str:
    """The code with which a line of a manual begins, or nothing."""
    plain = re.sub(r"\\([_@*$&|<>])", r"\1", MARKS.sub("", text))
    plain = BULLET.sub("", plain.strip().strip("*").strip()).strip()
    first, *others = (column.strip(" $") for column in plain.split("\t"))
    if LABEL.match(first) or ASSIGNED.match(first) or COMMAND.match(first):
        return "" if first.lower().startswith("group =") else first[:LONGEST].strip()
    if SCANNED.match(first):
        return first[:LONGEST]
    return next((other[:LONGEST].strip() for other in others if CONDITION.match(other)), "")


def folder() -> Path | None:
    """Where the manuals are, when they are there."""
    found = Path(os.environ.get("TWOLETTER_MANUALS", HERE.parents[2] / "shared" / "manuals"))
    return found if (found / FILES["dmc"]).is_file() else None


def scan(where: Path) -> list[CodeLine]:
    """Every line of code in the chapters with examples."""
    found = []
    for manual, name in FILES.items():
        lines = (where / name).read_text(encoding="utf-8").splitlines()
        for number in (number for part in RANGES[manual] for number in part):
            if number <= len(lines) and (text := code_in(lines[number - 1])):
                found.append(CodeLine(manual, number, text))
    return found


def listed() -> list[CodeLine]:
    """The same as it was found when the list was written."""
    rows = (line.split("\t", 1) for line in LIST.read_text(encoding="utf-8").splitlines())
    return [CodeLine(place[:3], int(place[4:]), text) for place, text in rows]


def main() -> None:
    """Prints or writes the list."""
    where = folder()
    if where is None:
        sys.exit("the manuals are not there: set TWOLETTER_MANUALS to their folder")
    rows = [f"{each.place}\t{each.text}" for each in scan(where)]
    if "--write" in sys.argv:
        LIST.write_text("\n".join(rows) + "\n", encoding="utf-8")
    else:
        print("\n".join(rows))


if __name__ == "__main__":
    main()
