"""A planned move on its way: sent, waited for, stopped when it is let go; speeds and ramps as they were afterwards."""

from __future__ import annotations

from dataclasses import dataclass, field

from device.jog import Plan
from device.lease import CODE, COUNTS, FLAG, LOOK_S, Exchange, at, ended, not_started
from device.tasks import LinkError, Steps, Wait
from device.wire import Kind, Shape


@dataclass(frozen=True, slots=True)
class Ended:
    """How a planned move ended."""

    places: dict[str, int]  # commanded positions, counts
    codes: dict[str, int]  # stop codes
    sentence: str


@dataclass
class Going:
    """A planned move on its way."""

    plan: Plan
    owner: str
    exchange: Exchange
    released: bool = False
    begun: bool = False
    former: list[tuple[str, str, int]] = field(default_factory=list)  # command, axis (none: of the path), value

    @property
    def held(self) -> bool:
        return not self.released

    @property
    def axes(self) -> str:
        """What a stop of it names."""
        return "S" if self.plan.sequence else self.plan.axes

    def release(self) -> None:
        self.released = True

    def steps(self) -> Steps[Ended]:
        """Sends, waits for the end (a release stops it), puts speeds and ramps back."""
        yield from self._remember()
        *first, last = self.exchange.packed(self.plan.commands)
        for line in first:
            if self.released:
                return Ended({}, {}, "Nothing was moved.")
            yield from self._accepted(line)
        if not self.released:
            self.begun = True
            yield from self._accepted(last)
        told = False
        while not self.plan.defines:
            if self.released and not told:
                told = yield from self._stop()
            values = yield from self.exchange.read(*self._moving())
            if values is not None and not any(values):
                break
            yield Wait(LOOK_S)
        return (yield from self._result())

    def _remember(self) -> Steps[None]:
        names = [(name, "") for name in ("VS", "VA", "VD")] if self.plan.sequence else []
        if not self.plan.sequence and not self.plan.defines:
            names = [(name, axis) for axis in self.plan.axes for name in ("SP", "AC", "DC")]
        values = yield from self.exchange.read(*((f"_{name}{axis}", Shape(8, 0)) for name, axis in names))
        if values is not None:
            self.former = [(name, axis, int(value)) for (name, axis), value in zip(names, values, strict=True)]

    def _moving(self) -> list[tuple[str, Shape]]:
        return [(f"_BG{letter}", FLAG) for letter in self.plan.axes + ("S" if self.plan.sequence else "")]

    def _accepted(self, line: str) -> Steps[None]:
        answer = yield from self.exchange.prove(line)
        if answer.kind is not Kind.ACCEPTED:
            code = yield from self.exchange.code()
            yield from self._put_back()
            raise LinkError(f"{self.plan.title}: not started: {not_started(code)}")

    def _stop(self) -> Steps[bool]:
        answer = yield from self.exchange.prove(f"ST {self.axes}", stops=True)
        return answer.kind is Kind.ACCEPTED

    def _result(self) -> Steps[Ended]:
        reads = [(f"_RP{letter}", COUNTS) for letter in self.plan.axes]
        reads += [(f"_SC{letter}", CODE) for letter in self.plan.axes]
        values = yield from self.exchange.read(*reads)
        yield from self._put_back()
        if values is None:
            raise LinkError(f"{self.plan.title}: ended, but the controller did not say where.")
        count = len(self.plan.axes)
        places = {letter: int(value) for letter, value in zip(self.plan.axes, values[:count], strict=True)}
        codes = {letter: int(value) for letter, value in zip(self.plan.axes, values[count:], strict=True)}
        done = " ".join(ended(letter, code) for letter, code in codes.items())
        return Ended(places, codes, f"{self.plan.title}." if self.plan.defines else done)

    @property
    def as_before(self) -> list[str]:
        """What sets speeds and ramps as they were."""
        return [f"{name} {at(axis, value) if axis else value}" for name, axis, value in self.former]

    def _put_back(self) -> Steps[None]:
        yield from self.exchange.put_back(self.as_before)
