"""Values of expressions for the forms: read through the controller twice a second, while somebody watches."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from functools import partial

from app.connection import Connection
from app.tick import Tick, failure_of
from device.api import State
from device.door import CONSUMING

EVERY = 15  # ticks between two readings
CLEARS = frozenset({*CONSUMING, "_TC"})
Call = Callable[[Mapping[str, float | str]], None]


class LiveValuesReader:
    """Only reads; nothing while a program waits for an answer, or may be about to ask."""

    def __init__(self, connection: Connection, tick: Tick) -> None:
        self._connection, self._tick = connection, tick
        self._watched: dict[object, tuple[tuple[str, ...], Call]] = {}
        self._pending: list[Future[tuple[float, ...]]] = []
        self._count = 0
        tick.each(self._each)

    def watch(self, owner: object, texts: Sequence[str], call: Call) -> None:
        """Calls back with the value of each text, or with why it has none; with nothing while offline."""
        self._watched[owner] = tuple(texts), call
        self._count = 0

    def forget(self, owner: object) -> None:
        """Nobody watches any more."""
        self._watched.pop(owner, None)

    def _each(self) -> None:
        self._pending = [future for future in self._pending if not future.done()]
        if not self._watched or self._pending:
            return
        self._count -= 1
        if self._count > 0:
            return
        self._count = EVERY
        for owner, (texts, call) in list(self._watched.items()):
            self._read(owner, texts, call)

    def _read(self, owner: object, texts: tuple[str, ...], call: Call) -> None:
        controller = self._connection.controller
        if controller.state is not State.READY:
            call({})
            return
        why = "a program waits for an answer" if controller.pending_prompt is not None else controller.resting()
        values: dict[str, float | str] = {}
        for text in texts:
            if why or text in CLEARS:
                values[text] = f"not read: {why}" if why else "not read, because reading clears it"
        open_ = [text for text in texts if text not in values]
        if not open_:
            call(values)
        for text in open_:
            future = controller.read(text)
            self._pending.append(future)
            self._tick.when_done(future, partial(self._done, owner, text, values, texts))

    def _done(
        self,
        owner: object,
        text: str,
        values: dict[str, float | str],
        texts: tuple[str, ...],
        future: Future[tuple[float, ...]],
    ) -> None:
        why = failure_of(future)
        values[text] = why or future.result()[0]
        watched = self._watched.get(owner)
        if watched is not None and watched[0] == texts and len(values) == len(texts):
            watched[1](values)
