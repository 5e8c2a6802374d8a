"""Joins ticks and samples: knows which sample it is at any tick, and runs the motion only as far as it is looked at."""

from __future__ import annotations

from dataclasses import dataclass

from device.simulator.motion import Motion


@dataclass(slots=True)
class Clock:
    """`tick` is the time at which sample number `sample` was taken; the next follows a period later."""

    motion: Motion
    now: int = 0
    tick: int = 0
    sample: int = 0
    period: int = 1000

    def sample_at(self, tick: int) -> int:
        """Number of the last sample taken at or before a tick; a sample precedes a command at an equal tick."""
        return self.sample + (tick - self.tick) // self.period

    def tick_of(self, sample: int) -> int:
        """When a sample is (or will be) taken."""
        return self.tick + (sample - self.sample) * self.period

    def sync(self, until: int) -> bool:
        """Runs the motion towards `until`; True when something happened in the last sample run (then see `tick`)."""
        due = (until - self.tick) // self.period
        if due <= 0:
            return False
        ran = self.motion.run(due)
        self.tick += ran * self.period
        self.sample += ran
        return ran < due or not self.motion.quiet()

    def catch_up(self, until: int) -> None:
        """Runs the motion up to `until` whatever happens on the way."""
        while self.tick + self.period <= until:
            self.sync(until)

    def set_period(self, period: int) -> None:
        """A new sample time, from the next sample on; call it caught up."""
        if period < 1:
            raise ValueError(f"sample time {period}")
        self.period = period
        self.motion.set_sample_time(float(period))
