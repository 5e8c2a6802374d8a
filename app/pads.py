"""The gamepad and who uses it: looked at with every tick, for the one panel that wants it and is in front."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from device.gamepad import NONE, Held, Pad, PadMissing, open_gamepad
from device.jog import DEAD_ZONE, deflection


class PadUser(Protocol):
    """A panel that can be driven by a pad."""

    @property
    def pad_wanted(self) -> bool:
        """Whether the pad may move something now: only where a person sees what it does."""
        ...

    def pad_moved(self, across: float, upward: float) -> None:
        """The stick stands here, behind its dead zone; in the middle unless the dead-man button is down."""
        ...

    def pad_pressed(self, button: int) -> None:
        """Another button went down."""
        ...

    def show_pad(self, words: str) -> None:
        """Why there is no pad; nothing while there is one."""
        ...


class Pads:
    """One pad, one user at a time; whoever loses it is told that the stick is in its middle."""

    def __init__(self, opened: Callable[[], Pad] = open_gamepad) -> None:
        self.opened = opened
        self._pad: Pad | None = None
        self._missing = ""
        self._users: list[tuple[PadUser, Callable[[], float]]] = []
        self._user: PadUser | None = None
        self._free = False  # it was let go since this user has it: what was pushed before starts nothing
        self._down: frozenset[int] = frozenset()

    def add(self, user: PadUser, dead: Callable[[], float] = lambda: DEAD_ZONE) -> None:
        """A panel more, and its dead band as a share of the way; the first panel that wants the pad has it."""
        self._users.append((user, dead))

    def look(self) -> None:
        """With every tick; never waits."""
        wants, dead = next((each for each in self._users if each[0].pad_wanted), (None, None))
        if wants is not self._user:
            if self._user is not None:
                self._user.pad_moved(0.0, 0.0)
            self._user, self._free = wants, False
        if wants is None or dead is None:
            return
        held = self._read()
        wants.show_pad(self._missing or ("" if held is not None else NONE))
        place = deflection(held.x, held.y, dead()) if held is not None and held.dead_man else (0.0, 0.0)
        self._free |= place == (0.0, 0.0)
        wants.pad_moved(*(place if self._free else (0.0, 0.0)))
        down = held.buttons if held is not None else frozenset[int]()
        for button in sorted(down - self._down):
            wants.pad_pressed(button)
        self._down = down

    def close(self) -> None:
        """At the end."""
        if self._pad is not None:
            self._pad.close()
            self._pad = None

    def _read(self) -> Held | None:
        if self._pad is None and not self._missing:
            try:
                self._pad = self.opened()
            except PadMissing as reason:
                self._missing = str(reason)
        return self._pad.read() if self._pad is not None else None
