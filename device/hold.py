"""Hold-to-run: a lease that ends by itself, over moves that end by themselves.

On the controller it is a relative move of at most speed × 0.4 s and the stopping distance ahead, lengthened with IP
while the lease is renewed; so a dead computer or a pulled cable ends in a normal deceleration.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from device.download import proved
from device.tasks import LinkError, Steps, Wait
from device.wire import Kind

LEASE_S = 0.15
AHEAD_S = 0.4
EXTEND_S = 0.1


@dataclass
class Lease:
    """One axis moving while somebody holds on; `renew` is called every 50 ms by the one who holds."""

    axis: str
    speed_counts_s: int
    acceleration: int
    deceleration: int
    clock: Callable[[], float]
    nonces: Iterator[str]
    renewed: float = 0.0
    released: bool = False

    def renew(self) -> None:
        self.renewed = self.clock()

    def release(self) -> None:
        self.released = True

    @property
    def held(self) -> bool:
        return not self.released and self.clock() - self.renewed < LEASE_S

    @property
    def distance(self) -> int:
        """Counts ahead at the start: speed × 0.4 s and the stopping distance, with the sign of the speed."""
        speed = abs(self.speed_counts_s)
        stopping = speed * speed / (2 * self.deceleration) if self.deceleration else 0
        return self._signed(int(speed * AHEAD_S + stopping))

    def _signed(self, counts: int) -> int:
        return counts if self.speed_counts_s >= 0 else -counts

    def _list(self, value: int) -> str:
        return "," * "XYZW".index(self.axis) + str(value)

    def steps(self) -> Steps[None]:
        """Starts, lengthens while held, stops; ends when the stop was accepted."""
        for command in (
            f"AC {self._list(self.acceleration)};DC {self._list(self.deceleration)}",
            f"SP {self._list(abs(self.speed_counts_s))}",
            f"PR {self._list(self.distance)};BG {self.axis}",
        ):
            if not self.held:
                break
            answer = yield from proved(self.nonces, command, 0.5)
            if answer.kind is not Kind.ACCEPTED:
                yield from self._stop()
                raise LinkError(f"Axis {self.axis} did not start; is the motor on and the way free?")
        extended = self.clock()
        while self.held:
            yield Wait(0.01)
            ran = self.clock() - extended
            if self.held and ran >= EXTEND_S:
                extended += ran
                answer = yield from proved(
                    self.nonces, f"IP {self._list(self._signed(int(abs(self.speed_counts_s) * ran)))}", 0.5
                )
                if answer.kind is not Kind.ACCEPTED:
                    break
        yield from self._stop()

    def _stop(self) -> Steps[None]:
        yield from proved(self.nonces, f"ST {self.axis}", 0.5)
