"""Something that takes long to make, made piece by piece, so that the window never waits for the whole."""

from __future__ import annotations

from collections.abc import Iterator


class Pieces:
    """`making` yields after each piece; whoever owns it asks for the next one with each tick."""

    def __init__(self, making: Iterator[object]) -> None:
        self._making = making
        self.done = False

    def step(self) -> bool:
        """Makes the next piece; True once there is nothing left to make."""
        if not self.done:
            self.done = next(self._making, self) is self
        return self.done

    def finish(self) -> None:
        """All that is left, for whoever cannot wait for the ticks."""
        while not self.step():
            pass
