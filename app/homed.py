"""Which axes are known to be homed: the studio's own knowledge, because the controller keeps no such mark."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

from codegen.setup import Axis, MotorType, Setup
from codegen.twoletter import nodes
from codegen.twoletter.parse import parse_line
from device.api import Controller, NoticeKind, Row

ENDS = {9: "found its edge (FE)", 10: "was homed (HM, FI)"}  # stop codes (dmc-1412-1414.txt, SC)
SERVOS = frozenset({MotorType.SERVO, MotorType.SERVO_REVERSED})
NEVER = "this studio has not seen it homed since it was connected"
OWN = "The controller keeps no such mark: this is what the studio knows. Right click: say what you know."


@dataclass(frozen=True)
class Mark:
    """What is known of one axis, with the reason."""

    homed: bool
    why: str

    @property
    def words(self) -> str:
        """A shape and a word."""
        return "● homed" if self.homed else "○ not homed"

    @property
    def help(self) -> str:
        """For the tooltip."""
        return f"{self.words[2:].capitalize()}: {self.why}. {OWN}"


class Homed:
    """Learns from what is read and what happens; only a homing that was seen to end counts."""

    def __init__(self, wall: Callable[[], time.struct_time] = time.localtime) -> None:
        self._wall = wall
        self._after = 0.0  # readings before this moment say nothing any more
        self._seen_line = 0
        self._ready: set[str] = set()  # axes that were read with another stop code: the next end is a new one
        self.marks: dict[str, Mark] = {}

    def begin(self, controller: Controller) -> None:
        """Another controller, or none."""
        self._after, self._seen_line = controller.clock(), 0
        self._ready.clear()
        self.marks = {}

    def happened(self, kind: NoticeKind, now: float) -> None:
        """A restart or a lost connection: where the axes are is not known any more."""
        words = {
            NoticeKind.RESTARTED: "the controller was restarted or exchanged",
            NoticeKind.LOST: "the connection was lost meanwhile",
        }.get(kind)
        if words is not None:
            self._after = now
            self._ready.clear()
            self.marks = {letter: Mark(False, words if mark.homed else mark.why) for letter, mark in self.marks.items()}

    def look(self, controller: Controller, row: Row, setup: Setup) -> None:
        """What the newest readings and the lines that left tell."""
        for letter in controller.axes:
            self.marks.setdefault(letter, Mark(False, NEVER))
            self._read_code(letter, row)
            off = f"motor_off.{letter.lower()}"
            if is_stepper(setup.axis(letter)) and row.value(off) == 1 and row.time(off) > self._after:
                self._lose(letter, "its stepper motor was switched off")
        self._hear_lines(controller)

    def _read_code(self, letter: str, row: Row) -> None:
        code = f"stop_code.{letter.lower()}"
        if not math.isfinite(row.value(code)) or row.time(code) <= self._after:
            return
        ended = ENDS.get(int(row.value(code)))
        if ended is None:
            self._ready.add(letter)
        elif letter in self._ready:
            self._ready.discard(letter)
            self.marks[letter] = Mark(True, f"it {ended}, seen at {time.strftime('%H:%M', self._wall())}")

    def confirm(self, letter: str, homed: bool) -> None:
        """The person says so."""
        self.marks[letter] = Mark(homed, "you said so")

    def _hear_lines(self, controller: Controller) -> None:
        """A position defined by hand (DP) is not the homed one."""
        for entry in controller.traffic(self._seen_line):
            self._seen_line = entry.number
            if entry.source == "user" and entry.direction == ">":
                for letter in _defined(entry.text, controller.axes):
                    self._lose(letter, "its position was defined by hand (DP)")

    def _lose(self, letter: str, why: str) -> None:
        if self.marks.get(letter, Mark(False, "")).homed:
            self.marks[letter] = Mark(False, why)


def is_stepper(axis: Axis) -> bool:
    """Whether its motor keeps no count of its own while it is off."""
    return axis.motor not in SERVOS


def _defined(line: str, axes: str) -> str:
    """The axes whose position a line defines."""
    found = ""
    for statement in parse_line(line.strip()).statements:
        if isinstance(statement, nodes.Command) and statement.name == "DP":
            given = [not isinstance(item, nodes.Empty | nodes.Query) for item in statement.arguments]
            found += "".join(letter for letter, on in zip(axes, given, strict=False) if on)
            found += statement.axis or ""
    return found
