"""A line that plays a recording: what came then comes again, at its time; nothing can be sent."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

from device.recorder_format import What
from device.recorder_play import Player
from device.recorder_read import Placed
from device.transport import ONLY_WATCHED, TransportLost


class Replay:
    """`tell` is given every record of the recording in its order, the received ones before `read` returns them.

    `settle` is called before each look, so that what was read last is worked off before anything newer is told.
    """

    def __init__(
        self,
        records: Iterator[Placed],
        player: Player,
        tell: Callable[[Placed], bool],
        settle: Callable[[], None],
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self._records, self._player, self._tell, self._settle, self._sleep = records, player, tell, settle, sleep
        self._next = next(records, None)

    @property
    def description(self) -> str:
        return f"recording {self._player.name}"

    @property
    def ended(self) -> bool:
        """Whether everything was played."""
        return self._next is None

    def read(self, timeout_s: float) -> bytes:
        self._settle()
        now = self._player.place
        while self._next is not None and self._next.place <= now:
            due, self._next = self._next, next(self._records, None)
            if self._tell(due) and due.record.what is What.RECEIVED:
                return due.record.data
        self._sleep(timeout_s)
        return b""

    def write(self, data: bytes) -> int:
        raise TransportLost(ONLY_WATCHED)

    def unsent(self) -> int:
        return 0

    def discard_output(self) -> None:
        """Nothing was ever written."""

    def close(self) -> None:
        """Nothing to close."""
