"""Compares a controller with the simulator's assumptions, without moving anything, and writes them down as a profile.

Only questions, comments and a few harmless settings are sent; what was touched is set back. It does not begin while a
program runs or an axis moves, and it ends as soon as one does.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, Final

from codegen.models import Model
from codegen.twoletter.commands import COMMANDS
from device.conform_checks import CHECKS, Check
from device.conform_talk import LOOKS, Odd, Talk
from device.identify import REVISION, model_of
from device.simulator.twoletter.profile import DEFAULTS, SETTINGS, Profile, ProfileWrong, shown
from device.simulator.twoletter.setting import FACTORY, MOTION, Value
from device.transport import Transport, TransportLost

STILL_S: Final = 0.15
STIRRED: Final = 100  # counts that an axis at rest may seem to move in that time (moved by hand, drifting)
ARRAYS: Final = ("CONFORM", "CONFORM1", "CONFORM2")


class Unfit(Exception):
    """The check cannot be made now; the text is one sentence."""


@dataclass(frozen=True, slots=True)
class Difference:
    """One setting in which the controller is not as the simulator assumes."""

    name: str
    assumed: Value
    found: Value

    @property
    def sentence(self) -> str:
        setting = SETTINGS.get(self.name)
        about = f" ({setting.doc})" if setting else ""
        return f"{self.name}{about}: {shown(self.found)} instead of {shown(self.assumed)}"


@dataclass(slots=True)
class Look:
    """What a check showed, as far as it came."""

    values: dict[str, Value] = field(default_factory=dict)
    odd: str = ""


@dataclass(slots=True)
class Report:
    """What a conformance check found."""

    named: str
    model: Model
    differences: list[Difference] = field(default_factory=list)
    seen: list[str] = field(default_factory=list)  # settings that were seen
    odd: list[str] = field(default_factory=list)  # what could not be understood, one sentence each
    profile: Profile = field(default_factory=Profile)

    @property
    def unseen(self) -> dict[str, str]:
        """What was not seen: what it is, and why."""
        found = {
            f"{name} ({each.doc})": each.unseen or "not understood or not asked of this type"
            for name, each in SETTINGS.items()
            if name not in self.seen
        }
        for name in found:
            if name.startswith("typed_message_marked "):
                found[name] = "CW cannot be read back; --cw tells what it is set to"
        probed = [name.split(".")[1] for name in self.seen if name.endswith((".high", ".step"))]
        found["commands.*.default"] = FACTORY
        found[f"commands.*.low, high, step except of {' '.join(probed)}"] = "would set what acts on the machine"
        found["commands.*.moving"] = MOTION
        codes = sorted(int(name.removeprefix("codes.")) for name in self.seen if name.startswith("codes."))
        found[f"codes except {' '.join(map(str, codes))}"] = "need motion, a program or a full memory"
        return found


class Session:
    """One check: the line, the controller's type, what has been touched."""

    def __init__(self, talk: Talk, clock: Callable[[], float], cw: int | None = None) -> None:
        self.talk = talk
        self.clock = clock
        self.cw = cw
        self.assumed = Profile()
        self.named = ""
        self.model: Model
        self._touched: dict[str, str] = {}

    # ------------------------------------------------------------- beginning

    def meet(self, expected: Model | None, address: int | None, patience_s: float) -> None:
        """Who is there, whether it echoes, and whether it is at rest."""
        if address is not None:
            self.talk.send(f"%{address}\r".encode())
        self.talk.send(b"\r")
        self.talk.listen(0.3)
        until = self.clock() + patience_s
        while not (probe := self.talk.line("NO")).accepted:
            if self.clock() > until:
                raise Unfit("nothing that speaks two-letter code answers here; check speed, cable and power")
        self.talk.settle()  # answers of what was asked while it was not yet there
        probe = self.talk.line("NO")
        self.talk.echoing = probe.data.startswith(b"NO")
        self.named = self._name()
        model = model_of(self.named) or expected
        if model is None:
            raise Unfit(f"it names itself {self.named!r}, which is no known type; --controller tells the type")
        self.model = model
        self.check_rest()

    def _name(self) -> str:
        """What it calls itself; one that a busy computer handed over in parts is asked for again."""
        names = [""]
        for _ in range(LOOKS):
            names.append(self.talk.say(REVISION, "^R^V").text.strip())
            if names[-1] == names[-2]:
                break
            self.talk.settle()
        return names[-1]

    def check_rest(self) -> None:
        """Raises Unfit while a program runs or an axis moves."""
        numbers, letters = self.talk.numbers, self.model.axes + ("S" if self.model.coordinated else "")
        for thread, line in enumerate(numbers([f"_XQ{thread}" for thread in range(self.model.threads)], 5)):
            if line >= 0:
                raise Unfit(f"a program runs in thread {thread}; end it (HX) and try again")
        for letter, moves in zip(letters, numbers([f"_BG{letter}" for letter in letters], 2), strict=True):
            if moves:
                raise Unfit(f"{letter} moves; wait until everything stands and try again")
        before = self._places()
        self.talk.listen(STILL_S)
        for letter, (was, now) in zip(self.model.axes, zip(before, self._places(), strict=True), strict=True):
            if now[0] != was[0] or abs(now[1] - was[1]) > STIRRED:
                raise Unfit(f"{letter} moves; wait until everything stands and try again")

    def _places(self) -> list[tuple[int, int]]:
        """Commanded and actual position of every axis."""
        both = self.talk.numbers([f"_{name}{axis}" for axis in self.model.axes for name in ("RP", "TP")], 10)
        return list(zip(both[::2], both[1::2], strict=True))

    def prepare(self) -> None:
        """No echo and leading zeros, as the answers are read; both are set back at the end."""
        if self.talk.echoing:
            self.restore("EO 1", "EO")
            self.talk.do("EO 0")
            self.talk.echoing = False
        if self.talk.number("_LZ", "F2.0") != 0:
            self.restore("LZ 1", "LZ")
            self.talk.do("LZ 0")

    # -------------------------------------------------------------- restoring

    def restore(self, line: str, what: str) -> None:
        """From now on this line has to be sent to undo what the script did."""
        self._touched[what] = line

    def put_back(self, what: str) -> None:
        """Undoes one thing now."""
        self.talk.again(lambda: self.talk.do(self._touched[what]))
        del self._touched[what]

    def put_all_back(self, but: int = 0) -> None:
        """Undoes everything that is still touched, but for the oldest ones, the newest first."""
        for what in reversed(list(self._touched)[but:]):
            self.put_back(what)
            self.talk.echoing |= what == "EO"

    # ---------------------------------------------------------------- looking

    def look(self, check: Check) -> Look:
        """What a check shows. What is not as assumed counts once two looks agree: answers can be handed over late."""
        looks: list[Look] = []
        while len(looks) < LOOKS:
            touched = len(self._touched)
            found = _once(check, self)
            usual = not found.odd and all(value == assumption(name) for name, value in found.values.items())
            if usual or found in looks:
                return found
            looks.append(found)
            self.talk.settle()
            self.put_all_back(touched)
        return Look(odd="the answers are others each time")

    @contextmanager
    def kept(self, name: str) -> Iterator[None]:
        """Sets a number back to what it was."""
        axis = "X" if COMMANDS[name].operand == "axis" else ""
        value = f"{self.talk.number(f'_{name}{axis}', 'F10.4'):.4f}".rstrip("0").rstrip(".")
        self.restore(f"{name} {value}", name)
        yield
        self.put_back(name)

    def free_array(self) -> str:
        """A name for an array of our own."""
        for name in ARRAYS:
            if not self.talk.line(f"MG {name}[0]").accepted:
                self.talk.code()
                return name
        raise Odd(f"the arrays {', '.join(ARRAYS)} are all there")


def conform(
    transport: Transport,
    *,
    clock: Callable[[], float],
    byte_s: float = 0.0,
    model: Model | None = None,
    address: int | None = None,
    cw: int | None = None,
    patience_s: float = 3.0,
    progress: Callable[[str], None] = lambda _: None,
) -> Report:
    """Makes the check; raises Unfit when it cannot be made, TransportLost when the line is lost."""
    session = Session(Talk(transport, byte_s=byte_s), clock, cw)
    try:
        session.meet(model, address, patience_s)
        session.prepare()
    except Odd as odd:
        raise Unfit(f"what answers here cannot be understood: {odd}") from odd
    report = Report(session.named, session.model)
    values: dict[str, Value] = {}
    try:
        for title, check in CHECKS:
            progress(title)
            session.check_rest()
            found = session.look(check)
            values |= found.values
            if found.odd:
                report.odd.append(f"{title}: {found.odd}")
    except Odd as odd:
        report.odd.append(str(odd))
    finally:
        _leave(session, report)
    judge(report, values)
    return report


def _once(check: Check, session: Session) -> Look:
    """One look."""
    found = Look()
    try:
        for name, value in check(session):
            found.values[name] = value
    except Odd as odd:
        found.odd = str(odd)
    return found


def _leave(session: Session, report: Report) -> None:
    """Sets everything back, and says what could not be."""
    try:
        session.put_all_back()
    except Odd as odd:
        report.odd.append(f"not everything could be set back: {odd}")
    except TransportLost as lost:
        report.odd.append(f"not everything could be set back: {lost}")


def judge(report: Report, values: dict[str, Value]) -> None:
    """Compares what was seen with what the simulator assumes, and makes the profile of it."""
    changed: dict[str, Any] = {}
    codes: dict[int, int] = {}
    commands: dict[str, dict[str, Value]] = {}
    for name, value in values.items():
        assumed = assumption(name)
        report.seen.append(name)
        if value == assumed:
            continue
        trial = _placed(name, value)
        try:
            Profile(**trial)
        except ProfileWrong as wrong:
            report.odd.append(f"{name}: {wrong}")
            continue
        report.differences.append(Difference(name, assumed, value))
        changed |= {key: each for key, each in trial.items() if key not in ("codes", "commands")}
        codes |= trial.get("codes", {})
        for command, change in trial.get("commands", {}).items():
            commands.setdefault(command, {}).update(change)
    report.profile = Profile(**changed, codes=codes, commands=commands)


def assumption(name: str) -> Value:
    """What the simulator has without a profile."""
    if name.startswith("codes."):
        return int(name.removeprefix("codes."))
    found = re.fullmatch(r"commands\.(\w+)\.(\w+)", name)
    if found is not None:
        value: Value = getattr(COMMANDS[found.group(1)], found.group(2))
        return value
    default: Value = DEFAULTS[name]
    return default


def _placed(name: str, value: Value) -> dict[str, Any]:
    """A value at its place in a profile."""
    if name.startswith("codes."):
        return {"codes": {assumption(name): value}}
    found = re.fullmatch(r"commands\.(\w+)\.(\w+)", name)
    return {"commands": {found.group(1): {found.group(2): value}}} if found else {name: value}
