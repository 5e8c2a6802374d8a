"""The fact sheet: what the manuals say of every command, put to the simulator as it would be typed.

`sheet/*.txt` holds one entry a command, typed from the manuals (or from the row of the command facts it names):

    == NAME MODELS           the controllers that have it: ssc, ssc2+ (two axes and more), dmc (both), or one by name
    from SOURCE…             where the facts below stand: dmc:LINE, ssc:LINE, spec:ROW
    on MODELS                the facts below are about these of them (`all` again for every one)
    plant KEY=VALUE…         the machine on which the facts below are tried (a fresh one)
    fresh                    a fresh controller for what follows
    takes LINE               column 1: is accepted
    sends BYTES              column 1: is answered by a prompt within three seconds, without a line end of its own
    never COLUMN WHY         that column does not exist (control characters only)
    runs LINE                column 1: is accepted in a program (which has a subroutine #Q)
    opens LINE               column 1: is accepted and takes what follows, until ctrl-Q
    refuses CODE LINE        column 2: is refused with that error code
    stops CODE LINE          column 2: ends a program with that error code
    answers LINE -> REPLY    column 3: `?`, or what the command tells
    unasked CODE LINE        column 3: there is no such question
    reads VALUE OPERAND      column 4: the operand reads that (VALUE may be a range LOW..HIGH)
    unread OPERAND           column 4: there is no such operand (error 58)
    axes V1 V2 V3 V4         columns 1 to 4 of `x,y,z,w` commands: stored, asked and read by axis, by letter (`KPX=`);
                             an empty place keeps its value, one too many is 90
    letters                  columns 1 and 2 of commands with axis letters: each letter (A to D too); one too many is 90
    does WHAT                column 5: does what the manual says; steps of `tests/examples/script.py`, indented, follow
    # …                      comment
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from codegen.models import MODELS, model
from tests.examples.script import Bench, Example, Player

HERE = Path(__file__).parent
COLUMNS = ("takes", "refuses", "answers", "reads", "does")
IN_COLUMN = {
    "takes": "takes",
    "sends": "takes",
    "runs": "takes",
    "opens": "takes",
    "refuses": "refuses",
    "stops": "refuses",
    "answers": "answers",
    "unasked": "answers",
    "reads": "reads",
    "unread": "reads",
    "does": "does",
}
SHORT = {
    "ssc": ("ssc1", "ssc2", "ssc3", "ssc4"),
    "ssc2+": ("ssc2", "ssc3", "ssc4"),
    "dmc": ("dmc1412", "dmc1414"),
}
CONTROLLERS = (*SHORT["ssc"], *SHORT["dmc"])
LETTERS = "XYZW"
SOURCE = re.compile(r"(dmc|ssc):[1-9]\d*|spec:\S+").fullmatch


@dataclass(frozen=True)
class Fact:
    """One line of an entry, or a `does` with its steps."""

    verb: str
    text: str
    models: frozenset[str]
    sources: tuple[str, ...]
    line: int
    steps: tuple[tuple[int, str], ...] = ()


@dataclass(frozen=True)
class Entry:
    """Everything the sheet says of one command."""

    name: str
    models: tuple[str, ...]
    file: str
    facts: tuple[Fact, ...]

    def about(self, model_name: str) -> list[Fact]:
        """The facts that hold on that controller."""
        return [fact for fact in self.facts if model_name in fact.models]

    def columns(self, model_name: str) -> dict[str, int]:
        """How many facts each column of the table has there; 0 is a hole."""
        found = dict.fromkeys(COLUMNS, 0)
        for fact in self.about(model_name):
            if fact.verb == "axes":
                for column in COLUMNS[:4]:
                    found[column] += 1
            elif fact.verb == "letters":
                found["takes"] += 1
                found["refuses"] += 1
            elif fact.verb == "never":
                found[fact.text.partition(" ")[0]] += 1
            elif fact.verb in IN_COLUMN:
                found[IN_COLUMN[fact.verb]] += 1
        return found

    def sources(self, model_name: str) -> tuple[str, ...]:
        """Where they stand."""
        return tuple(dict.fromkeys(source for fact in self.about(model_name) for source in fact.sources))


def models_of(words: str) -> tuple[str, ...]:
    """`ssc2+ dmc1412` as names of controllers."""
    found = tuple(name for word in words.split() for name in SHORT.get(word, (word,)))
    assert set(found) <= set(MODELS), words
    return found


@dataclass
class Reader:
    """Reads one file of the sheet."""

    file: str
    entries: list[Entry] = field(default_factory=list)
    name: str = ""
    models: tuple[str, ...] = ()
    on: tuple[str, ...] = ()
    sources: tuple[str, ...] = ()
    facts: list[Fact] = field(default_factory=list)

    def close(self) -> None:
        """The entry is complete."""
        if self.name:
            self.entries.append(Entry(self.name, self.models, self.file, tuple(self.facts)))
        self.facts = []

    def take(self, number: int, line: str) -> None:
        """One line that is not a step."""
        word, _, rest = line.partition(" ")
        if word == "==":
            self.close()
            self.name, _, models = rest.partition(" ")
            self.models = self.on = models_of(models)
            self.sources = ()
        elif word == "from":
            self.sources = tuple(rest.split())
            assert all(map(SOURCE, self.sources)), f"{self.file}:{number}: no source: {rest}"
        elif word == "on":
            self.on = self.models if rest == "all" else models_of(rest)
            assert set(self.on) <= set(self.models), f"{self.file}:{number}: {rest}"
        else:
            assert word in IN_COLUMN or word in ("axes", "letters", "plant", "fresh", "never"), (
                f"{self.file}:{number}: {line}"
            )
            assert self.sources, f"{self.file}:{number}: where does it stand?"
            self.facts.append(Fact(word, rest, frozenset(self.on), self.sources, number))

    def step(self, number: int, line: str) -> None:
        """One indented line: a step of the last `does`."""
        last = self.facts.pop()
        assert last.verb == "does", f"{self.file}:{number}: a step of nothing"
        self.facts.append(
            Fact(last.verb, last.text, last.models, last.sources, last.line, (*last.steps, (number, line)))
        )


def read_sheet(path: Path) -> list[Entry]:
    """Every entry of one file."""
    reader = Reader(path.name)
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if line.startswith("  "):
            reader.step(number, line[2:])
        elif line.strip() and not line.startswith("#"):
            reader.take(number, line)
    reader.close()
    return reader.entries


@cache
def sheet() -> dict[str, Entry]:
    """The whole sheet by command."""
    entries = [entry for path in sorted((HERE / "sheet").glob("*.txt")) for entry in read_sheet(path)]
    names = [entry.name for entry in entries]
    assert len(set(names)) == len(names), sorted(name for name in names if names.count(name) > 1)
    return {entry.name: entry for entry in entries}


class Prober(Player):
    """Tries the facts of one entry on one controller; what one of `enough` does is left to that one."""

    def __init__(self, entry: Entry, model_name: str, enough: tuple[str, ...] = ()) -> None:
        super().__init__(Example(model_name, entry.name, model_name, (), entry.file))
        self.entry = entry
        self.axes = model(model_name).axes
        self.enough = frozenset(enough) if model_name not in enough else frozenset()

    def probe(self) -> int:
        """Every fact, in order; an assertion names the line of the sheet. Answers how many there were."""
        for fact in self.entry.about(self.example.model):
            self.place = fact.line
            if fact.verb == "does":
                if not self.enough & fact.models:
                    self._does(fact)
            elif fact.verb in ("plant", "fresh"):
                self.waiting, self.plants = None, {}
                if fact.verb == "plant":
                    self.step("plant", fact.text, [])
            elif fact.verb != "never":
                getattr(self, f"do_{fact.verb}")(fact.text)
        return len(self.entry.about(self.example.model))

    def _does(self, fact: Fact) -> None:
        """A fresh controller does what the steps say."""
        title = f"{self.entry.name} {fact.text}"
        Player(Example(self.example.model, " ".join(fact.sources), title, fact.steps, self.entry.file)).play()

    def do_takes(self, rest: str) -> None:
        """Is accepted."""
        self.do_port(rest)

    def do_refuses(self, rest: str) -> None:
        """Is refused."""
        self.do_refused(rest)

    def _in_program(self, text: str) -> list[int]:
        """The error codes of a program with that line."""
        bench = Bench.of(self.example.model)
        bench.simulation.load_program(f"#A\n{text}\nEN\n#Q;EN")
        bench.simulation.execute("#A")
        bench.run(0.1)
        return [error["code"] for error in bench.simulation.errors]

    def do_runs(self, rest: str) -> None:
        """Is accepted in a program."""
        codes = self._in_program(rest)
        self.must(codes == [], f"{rest} was refused with {codes}")

    def do_opens(self, rest: str) -> None:
        """Opens a mode of its own: neither prompt nor refusal, and then ctrl-Q ends it."""
        came = b""
        for data in (rest.encode() + b"\r", b"\x11"):
            self.bench.simulation.transmit(1)
            self.bench.simulation.receive(1, data)
            self.bench.run(0.02)
            came = self.bench.simulation.transmit(1)
            self.must(came.endswith(b":") if data == b"\x11" else not came.endswith((b":", b"?")), f"{rest}: {came!r}")

    def do_sends(self, rest: str) -> None:
        """Bytes that are answered by a prompt."""
        simulation, came = self.bench.simulation, b""
        simulation.transmit(1)
        simulation.receive(1, rest.encode().decode("unicode_escape").encode("latin-1"))
        for _ in range(300):
            self.bench.run(0.01)
            came += simulation.transmit(1)
            if came.endswith(b":"):
                return
        self.must(False, f"{rest}: {came!r}")

    def do_stops(self, rest: str) -> None:
        """Ends a program."""
        code, _, text = rest.partition(" ")
        codes = self._in_program(text)
        self.must(codes == [int(code)], f"{text} ended with {codes}, not {code}")

    def do_answers(self, rest: str) -> None:
        """Answers."""
        assert " -> " in rest, rest
        self.do_port(rest)

    def do_unasked(self, rest: str) -> None:
        """Has no answer."""
        self.do_refused(rest)

    def value_of(self, operand: str) -> float:
        """An operand's value, read through MG."""
        return float(self.bench.answer(f"MG {operand}{{F10.4}}", 1).strip(":\r\n "))

    def do_reads(self, rest: str) -> None:
        """The operand reads that."""
        wanted, _, operand = rest.partition(" ")
        low, _, high = wanted.partition("..")
        value = self.value_of(operand)
        self.must(float(low) - 6e-5 <= value <= float(high or low) + 6e-5, f"{operand} reads {value}, not {wanted}")

    def do_unread(self, rest: str) -> None:
        """There is no such operand."""
        self.do_refused(f"58 MG {rest}")

    def do_axes(self, rest: str) -> None:
        """`x,y,z,w`: every axis has its own number; one too many is error 90."""
        name, given, count = self.entry.name, rest.split(), len(self.axes)
        self.do_port(f"{name} {','.join(given[:count])}")
        answer = self.bench.answer(f"{name} {','.join('?' * count)}", 1).strip(":\r\n ")
        told = [float(part) for part in answer.split(",")]
        self.must(told == [float(value) for value in given[:count]], f"{name} answers {told}")
        for letter, value in zip(self.axes, given, strict=False):
            self.must(self.value_of(f"_{name}{letter}") == float(value), f"_{name}{letter} is not {value}")
        if count < len(LETTERS):
            self.do_refused(f"90 {name} {',' * count}{given[0]}")
        last = self.axes[-1]
        self.do_port(f"{name}{last}={given[0]}")
        self.must(self.value_of(f"_{name}{last}") == float(given[0]), f"{name}{last}= does not store")
        if count > 1:  # an empty place keeps its value
            self.do_port(f"{name} ,{given[1]}")
            self.must(self.value_of(f"_{name}X") == float(given[0]), f"{name} , changes the first axis")

    def do_letters(self, rest: str) -> None:
        """Axis letters: each is known, one too many is error 90."""
        name = self.entry.name
        for letter, other in zip(self.axes, "ABCD", strict=False):
            self.do_port(f"{name}{letter}")
            self.do_port(f"{name} {other}")
        if len(self.axes) < len(LETTERS):
            self.do_refused(f"90 {name}{LETTERS[len(self.axes)]}")
