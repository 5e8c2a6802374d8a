"""Runs an example of the manual, written as a short script, on the simulator in virtual time.

A file holds several examples. Each begins with `== MODEL l.FIRST-LAST title`; then one instruction a line:

    plant KEY=VALUE …        what hangs on axis x (before anything else); yplant … for axis y and so on
    program                  the lines up to the next `end` become the controller's program
    badprogram CODE          the same, and it must be refused with this error code
    port TEXT                sends a line to port 1; every prompt must be `:`
    port TEXT -> REPLY       the same; the data that comes back, without its CR LF (\\r \\n inside are escapes)
    ask NAME EXPRESSION      NAME becomes what the controller says the expression is
    refused CODE TEXT        sends a line that must be answered `?`, for this reason
    raw TEXT                 sends these bytes (escapes), waits for nothing
    xq LABEL                 starts the program there (0 or #LABEL)
    set SIGNAL VALUE         something happens outside, as in a stimulus file
    run SECONDS              lets time pass
    idle SECONDS             lets time pass until nothing runs and nothing moves; fails when that takes longer
    until SECONDS EXPRESSION lets time pass, true milliseconds, until the expression holds; fails when that takes longer
    edges SECONDS SIGNAL     notes each change of a value (ms, value) in `edges`, in true milliseconds
    mark                     `t` counts true milliseconds from here
    expect EXPRESSION        must hold
    said / said2             the lines up to the next `end` have been sent unasked to port 1 / 2 since the last `said`
    # …                      comment

Expressions know: x y z w (commanded actual error velocity torque stop_code motor_on moving), v (variables), strings,
arrays, outputs, inputs, out(n), ms (true milliseconds since power-up), t, edges, errors, threads, messages, said(port),
bench, gaps (milliseconds between edges), near(a, b, tolerance).
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field, fields
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from codegen.models import model
from device.simulator.plant import Plant
from device.simulator.simulation import Simulation
from device.simulator.twoletter.memory import DownloadRefused

TICKS = 1_024_000
MILLISECOND = 1024
LONGEST_ANSWER_S = 30.0
HEAD = re.compile(r"== (\w+) (\S+) (.*)")


@dataclass(frozen=True)
class Example:
    """One example: where it stands in the manual and what to do."""

    model: str
    lines: str
    title: str
    steps: tuple[tuple[int, str], ...]
    file: str

    def __str__(self) -> str:
        return f"{self.lines} {self.title}"


def read_examples(path: Path) -> list[Example]:
    """Every example of one script file."""
    found: list[Example] = []
    head: re.Match[str] | None = None
    steps: list[tuple[int, str]] = []

    def close() -> None:
        if head:
            found.append(Example(head[1], head[2], head[3], tuple(steps), path.name))

    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if match := HEAD.fullmatch(line):
            close()
            head, steps = match, []
        elif head:
            steps.append((number, line))
    close()
    return found


def typed(text: str) -> Any:
    """A value of a plant as it would stand in its file."""
    if text.startswith("["):
        return tuple(float(part) for part in text.strip("[]").split(","))
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


@dataclass
class Bench:
    """A simulated controller on the table, and what has been noted about it."""

    simulation: Simulation
    heard: dict[int, int] = field(default_factory=lambda: {1: 0, 2: 0})
    edges: list[tuple[int, float]] = field(default_factory=list)
    marked: float = 0.0
    asked: dict[str, float] = field(default_factory=dict)

    @classmethod
    def of(cls, model_name: str, plants: dict[str, dict[str, Any]] | None = None) -> Bench:
        """A bench with that controller; plants by axis letter."""
        known = {item.name for item in fields(Plant)}
        built = {}
        for axis, values in (plants or {}).items():
            assert set(values) <= known, f"no such plant key: {set(values) - known}"
            built[axis] = Plant(**values)
        return cls(Simulation(model(model_name), plants=built or None, compiled=None))

    def seconds(self) -> float:
        """True seconds since power-up."""
        return self.simulation.ticks / TICKS

    def run(self, seconds: float) -> None:
        """Lets time pass."""
        self.simulation.advance(round(seconds * TICKS))

    def names(self) -> dict[str, Any]:
        """What expressions may use, as things are now."""
        state = self.simulation.state()
        axes = {letter.lower(): SimpleNamespace(**values) for letter, values in state["axes"].items()}
        outputs = state["outputs"]
        return {
            **axes,
            **state,
            **self.asked,
            "bench": self,
            "v": SimpleNamespace(**state["variables"]),
            "out": lambda number: outputs >> (number - 1) & 1,
            "ms": self.seconds() * 1000,
            "t": self.seconds() * 1000 - self.marked,
            "edges": self.edges,
            "gaps": [later[0] - sooner[0] for sooner, later in pairwise(self.edges)],
            "near": lambda value, wanted, tolerance: abs(value - wanted) <= tolerance,
            "said": lambda port=1: [text for _, where, text in state["messages"] if where == port],
        }

    def value(self, expression: str) -> Any:
        """An expression of a script, worked out now."""
        return eval(expression, self.names())

    def answer(self, text: str, prompts: int) -> str:
        """Sends a line and collects what comes back up to its last prompt."""
        self.simulation.transmit(1)
        self.simulation.receive(1, text.encode("latin-1") + b"\r")
        came = ""
        started = self.seconds()
        while came.count(":") + came.count("?") < prompts:
            self.run(0.002)
            came += self.simulation.transmit(1).decode("latin-1")
            assert self.seconds() - started < LONGEST_ANSWER_S, f"{text}: no answer, only {came!r}"
            if came.endswith("?"):
                break
        return came

    def said(self, port: int) -> list[str]:
        """What has been sent unasked to a port since the last question."""
        texts = [text for _, where, text in self.simulation.state()["messages"] if where == port]
        fresh = texts[self.heard[port] :]
        self.heard[port] = len(texts)
        return fresh


def commands_in(text: str) -> int:
    """How many prompts a line brings: one for each command between semicolons outside quotes."""
    parts = re.sub(r'"[^"]*"', '""', text).split(";")
    return max(1, len([part for part in parts if part.strip()]))


class Player:
    """Plays one example on a bench."""

    def __init__(self, example: Example) -> None:
        self.example = example
        self.plants: dict[str, dict[str, Any]] = {}
        self.waiting: Bench | None = None
        self.place = 0

    @property
    def bench(self) -> Bench:
        """The bench, set up at the first use, when all plants are known."""
        if self.waiting is None:
            self.waiting = Bench.of(self.example.model, self.plants)
        return self.waiting

    def play(self) -> None:
        """Does every step; an assertion names the line of the script."""
        steps = list(self.example.steps)
        while steps:
            number, line = steps.pop(0)
            word, _, rest = line.strip().partition(" ")
            if not word or word.startswith("#"):
                continue
            block: list[str] = []
            if word in ("program", "badprogram", "said", "said2"):
                while (text := steps.pop(0)[1]) != "end":
                    block.append(text)
            self.place = number
            self.step(word, rest.strip(), block)

    def must(self, truth: object, message: str) -> None:
        """Fails with the place in the script."""
        assert truth, f"{self.example.file}:{self.place} ({self.example}): {message}"

    def step(self, word: str, rest: str, block: list[str]) -> None:
        """Does one step."""
        if word.endswith("plant"):
            values = dict(pair.split("=") for pair in rest.split())
            self.plants[(word[0] if word != "plant" else "x").upper()] = {
                key: typed(text) for key, text in values.items()
            }
            return
        if word == "program":
            self.bench.simulation.load_program("\n".join(block))
            return
        if word == "badprogram":
            with pytest.raises(DownloadRefused) as refused:
                self.bench.simulation.load_program("\n".join(block))
            self.must(refused.value.code == int(rest), f"refused with {refused.value.code}")
            return
        if word in ("said", "said2"):
            came = self.bench.said(2 if word == "said2" else 1)
            self.must(came == block, f"said {came}, not {block}")
            return
        getattr(self, f"do_{word}")(rest)

    def do_port(self, rest: str) -> None:
        """Sends a line that is accepted, and compares the data."""
        text, arrow, wanted = rest.partition(" -> ")
        came = self.bench.answer(text.rstrip() if arrow else text, commands_in(text))
        self.must("?" not in came, f"{text} was refused")
        if arrow:
            data = came.strip(":").removesuffix("\r\n").replace(":", "")
            self.must(data == wanted.encode().decode("unicode_escape"), f"{text} answered {data!r}")

    def do_ask(self, rest: str) -> None:
        """Asks for a value."""
        name, _, expression = rest.partition(" ")
        self.bench.asked[name] = float(self.bench.answer(f"MG {expression}{{F10.4}}", 1).strip(":\r\n "))

    def do_refused(self, rest: str) -> None:
        """Sends a line that is refused, and asks why (`any`: whatever the reason)."""
        code, _, text = rest.partition(" ")
        came = self.bench.answer(text, commands_in(text))
        self.must(came.endswith("?"), f"{text} was accepted: {came!r}")
        why = self.bench.answer("TC1", 1).split(" ")[0]
        self.must(code == "any" or int(why) == int(code), f"{text} was refused with {why}, not {code}")

    def do_raw(self, rest: str) -> None:
        """Sends bytes."""
        self.bench.simulation.receive(1, rest.encode().decode("unicode_escape").encode("latin-1"))

    def do_xq(self, rest: str) -> None:
        """Starts the program."""
        self.bench.simulation.execute(rest if rest.startswith("#") else int(rest or 0))

    def do_set(self, rest: str) -> None:
        """Something happens outside."""
        signal, _, value = rest.partition(" ")
        if signal.startswith("type"):
            self.bench.simulation.stimulus(signal, value.encode().decode("unicode_escape"))
        else:
            self.bench.simulation.stimulus(signal, float(value))

    def do_run(self, rest: str) -> None:
        """Lets time pass."""
        self.bench.run(float(rest))

    def do_idle(self, rest: str) -> None:
        """Waits until nothing runs and moves."""
        outcome = self.bench.simulation.run_until_idle(round(float(rest) * TICKS))
        self.must(outcome == "end", f"ended with {outcome} after {rest} s: {self.bench.simulation.errors}")

    def do_until(self, rest: str) -> None:
        """Waits until an expression holds."""
        limit, _, expression = rest.partition(" ")
        end = self.bench.seconds() + float(limit)
        while not self.bench.value(expression):
            self.must(self.bench.seconds() < end, f"not within {limit} s: {expression}")
            self.bench.simulation.advance(MILLISECOND)

    def do_edges(self, rest: str) -> None:
        """Notes every change of a value."""
        limit, _, expression = rest.partition(" ")
        self.bench.edges.clear()
        last = self.bench.value(expression)
        for _ in range(round(float(limit) * 1000)):
            self.bench.simulation.advance(MILLISECOND)
            now = self.bench.value(expression)
            if now != last:
                self.bench.edges.append((round(self.bench.seconds() * 1000), now))
                last = now

    def do_mark(self, _: str) -> None:
        """Begins to count time."""
        self.bench.marked = self.bench.seconds() * 1000

    def do_expect(self, rest: str) -> None:
        """Compares."""
        self.must(self.bench.value(rest), f"{rest} does not hold: {self.bench.simulation.state()}")
