"""What happens on the link, told to the controller: connecting, texts, questions, loss (on the link's thread)."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from codegen.models import MODELS
from device import commands
from device.asking import Listing
from device.download import recover, upload_steps
from device.happenings import Kind, NoticeKind, State
from device.identify import Identity, identify, read_surely
from device.stop import StopState
from device.tasks import LinkLost, NotAllowed, Priority, Steps, Stopped, Wait
from device.wire import Shape

if TYPE_CHECKING:
    from device.api import Controller


class Events:
    """Hears the link and keeps the controller's state (on the link's thread)."""

    def __init__(self, controller: Controller) -> None:
        self._c = controller

    def opened(self) -> None:
        c = self._c
        c.state, c.state_text = State.CONNECTING, "Asking who is there…"
        c.link.submit(self._meet_surely(), Priority.USER, "poll")

    def _meet_surely(self) -> Steps[None]:
        """Meeting again after whatever came in between (STOP, silence)."""
        while True:
            try:
                yield from self._meet()
                return
            except (LinkLost, Stopped, NotAllowed) as reason:
                if self._c.link.transport is None:
                    raise
                self._c.state_text = str(reason)
                yield Wait(0.3)

    def _meet(self) -> Steps[None]:
        """Identifies, learns whether a program runs and may ask, then starts reading."""
        c = self._c
        identity = yield from self._identify()
        self._know(identity)
        c.waiting.restarted()
        yield from self._programs()
        c.state, c.state_text = State.READY, f"Connected: {identity.text or 'unknown controller'}"
        c.show_stop(StopState.READY)
        c.notify(NoticeKind.IDENTIFIED, f"Connected to {identity.text or 'a controller that does not name itself'}.")
        if c.model is None:
            c.notify(NoticeKind.IDENTIFIED, "This controller's type is not known; choose it to see live values.")
        c.link.submit(c.poller.run(), Priority.POLL, "poll")

    def _know(self, identity: Identity) -> None:
        """The type: as it says itself, as chosen before for this serial number, or as expected; never guessed."""
        c = self._c
        c.identity = identity
        remembered = MODELS.get(c.known_models.get(identity.serial, "")) if identity.serial is not None else None
        c.take_model(identity.model or remembered or c.expected_model)

    def again(self) -> Steps[None]:
        """After silence on the same line: another controller may be there now."""
        c = self._c
        self._know((yield from identify(c.nonces, c.line.address)))
        yield from self._programs()

    def _identify(self) -> Steps[Identity]:
        c = self._c
        while True:
            try:
                if c.waiting.unfinished:
                    yield from recover(c.waiting, c.nonces)
                return (yield from identify(c.nonces, c.line.address))
            except LinkLost as reason:
                if c.state is not State.LOST:
                    self.lost(str(reason), refused=True)

    def _programs(self) -> Steps[None]:
        """Which threads run; a running program that is not known is read, because it may ask."""
        c = self._c
        threads = c.model.threads if c.model is not None else 1
        lines = []
        for number in range(threads):
            answer = yield from read_surely(c.nonces, (f"_XQ{number}", Shape(4, 0)))
            lines += [int(v) for v in answer.values if v >= 0]
        if lines and c.listing is None:
            text = yield from upload_steps(c.nonces, None)
            c.waiting.listing = Listing(text)
        c.waiting.threads(frozenset(lines))

    def lost(self, sentence: str, *, refused: bool) -> None:
        c = self._c
        if not refused and c.link.transport is not None and c.state is not State.READY:
            return  # not met yet: whoever is asking tells
        new = c.state is not State.LOST or c.state_text != sentence
        c.state, c.state_text = State.LOST, sentence
        if c._stop_state is StopState.STOPPING:
            c.show_stop(StopState.NOT_CONFIRMED)
        elif c._stop_state is not StopState.NOT_CONFIRMED:
            c.show_stop(StopState.NO_LINK)
        if new:
            c.notify(NoticeKind.LOST, sentence)
        if not refused and c.kind is Kind.MACHINE:
            c.release_control("Back to Watch: the connection was lost.")

    def text(self, line: str) -> None:
        c = self._c
        fault = re.fullmatch(r"\?\s*(\d{3}) (.*)", line)
        c.notify(NoticeKind.FAULT if fault else NoticeKind.MESSAGE, line)

    def standing(self, rest: str) -> None:
        c = self._c
        if c.waiting.seen(rest):
            c.door.question = c.waiting.question
            c.notify(NoticeKind.PROMPT, rest)

    def sent(self, data: bytes, source: str) -> None:
        """What leaves may change what the controller holds or waits for."""
        commands.sent(self._c, data, source)
