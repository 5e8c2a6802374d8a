"""The controller's own clock: whether `TIME` shows what it must show by now, or the controller was switched off."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto

TICKS = 1_024_000  # TM of one true second: TM 1000 counts 1024 samples a second (commands.md, TIME and TM)
USUAL_TM = 1000.0
DRIFT = 0.002  # of the time passed: both clocks are quartz
MARGIN_S = 0.3
TURNS = (0, 1 << 31, 1 << 32)  # where a clock that ran for weeks may begin again


class Verdict(Enum):
    """What a reading of the clock says about the time since the one before."""

    FIRST = auto()  # there was none before
    AS_EXPECTED = auto()
    RESTARTED = auto()  # it began again since
    ANOTHER = auto()  # it runs, but this clock never showed what was read before


@dataclass(frozen=True, slots=True)
class Reading:
    """`TIME` and `TM`, and between which moments of our clock (s) they were read."""

    samples: float
    period: float
    sent: float
    came: float


class Clock:
    """Compares every reading with the one before and the time that has passed."""

    def __init__(self) -> None:
        self.last: Reading | None = None

    @property
    def period(self) -> float:
        """The TM of the last reading."""
        return self.last.period if self.last is not None else USUAL_TM

    def judge(self, now: Reading) -> Verdict:
        """What this reading says; it does not become the last one."""
        last = self.last
        if last is None:
            return Verdict.FIRST
        if last.period <= 0 or now.period <= 0:  # an external clock: its speed is not known
            return Verdict.RESTARTED if now.samples < last.samples else Verdict.AS_EXPECTED
        rates = (TICKS / last.period, TICKS / now.period)
        margin = MARGIN_S * max(rates)
        least = last.samples + max(now.sent - last.came, 0.0) * min(rates) * (1 - DRIFT) - margin
        passed = max(now.came - last.sent, 0.0) * max(rates) * (1 + DRIFT) + margin
        if any(least <= now.samples + turn <= last.samples + passed for turn in TURNS):
            return Verdict.AS_EXPECTED
        return Verdict.RESTARTED if now.samples <= passed else Verdict.ANOTHER

    def keep(self, now: Reading) -> None:
        """From here on later readings are compared with this one."""
        self.last = now
