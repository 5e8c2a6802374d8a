"""A gamepad, when the optional extra is installed: read by a thread of its own, looked at without waiting.

pygame-ce (SDL) is imported with the first use. SDL gets no window and no screen; it reads pads behind other windows
too, so whoever uses a pad asks whether its own window is in front.
"""

from __future__ import annotations

import importlib.util
import os
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

READ_S = 0.01  # between two looks at the pad
FRESH_S = 0.1  # an older look is none: its thread hangs
SHOULDERS = frozenset({4, 5})  # of a pad that SDL knows no names for
NAMED_SHOULDERS = frozenset({9, 10})  # SDL_CONTROLLER_BUTTON_LEFTSHOULDER, RIGHTSHOULDER
NAMED_BUTTONS = range(15)
FULL = 32767  # of an axis of a pad with names
INSTALL = "A gamepad needs an optional part: install it with “pip install twoletter-studio[gamepad]” and start again."
NONE = "No gamepad is connected."


class PadMissing(Exception):
    """No pad can be read here; the text is the sentence to show."""


@dataclass(frozen=True, slots=True)
class Held:
    """How a pad stands: its left stick (-1 to 1, right and up are positive), whether a dead-man button is down."""

    x: float
    y: float
    dead_man: bool
    buttons: frozenset[int] = frozenset()  # the others that are down


class Pad(Protocol):
    """Whatever is held like a gamepad."""

    def read(self) -> Held | None:
        """How it stands now, at once; None without a pad, or when it was unplugged."""
        ...

    def close(self) -> None: ...


class Gamepad:
    """The first pad that is plugged in; another one when that is gone."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._last: Held | None = None
        self._at = 0.0
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._run, name="gamepad", daemon=True)
        self._thread.start()

    def read(self) -> Held | None:
        return self._last if self._clock() - self._at < FRESH_S else None

    def close(self) -> None:
        self._closing.set()
        self._thread.join(1.0)

    def _run(self) -> None:
        """SDL wants to be read by the thread that started it."""
        pygame = _sdl()
        pygame.display.init()
        pygame.joystick.init()
        eye = _Eye(pygame)
        try:
            while not self._closing.wait(READ_S):
                self._last = eye.look()
                self._at = self._clock()
        except pygame.error:  # SDL was ended under it: the program closes
            return
        pygame.joystick.quit()
        pygame.display.quit()


class _Eye:
    """Looks at one pad; plugging and unplugging come as events."""

    def __init__(self, pygame: Any) -> None:
        from pygame._sdl2 import controller

        self._pygame, self._named = pygame, controller
        controller.init()
        self._pad: Any = None  # by position
        self._controller: Any = None  # the same pad by names, when SDL knows it

    def look(self) -> Held | None:
        pygame = self._pygame
        changed = any(event.type in (pygame.JOYDEVICEADDED, pygame.JOYDEVICEREMOVED) for event in pygame.event.get())
        if changed or self._pad is None:
            self._choose()
        if self._pad is None:
            return None
        try:
            return self._by_names() if self._controller is not None else self._by_position()
        except pygame.error:  # gone between two looks
            self._pad = self._controller = None
            return None

    def _choose(self) -> None:
        """The pad of before when it is still there, else the first one."""
        joystick = self._pygame.joystick
        if self._pad is not None and self._pad.get_instance_id() in _present(joystick):
            return
        self._pad = self._controller = None
        if joystick.get_count():
            self._pad = joystick.Joystick(0)
            if self._named.is_controller(0):
                self._controller = self._named.Controller.from_joystick(self._pad)

    def _by_names(self) -> Held:
        pad, names = self._controller, self._pygame
        x, y = (pad.get_axis(axis) / FULL for axis in (names.CONTROLLER_AXIS_LEFTX, names.CONTROLLER_AXIS_LEFTY))
        down = frozenset(button for button in NAMED_BUTTONS if pad.get_button(button))
        return Held(x, -y, bool(down & NAMED_SHOULDERS), down - NAMED_SHOULDERS)

    def _by_position(self) -> Held:
        pad = self._pad
        axes = [pad.get_axis(axis) for axis in range(min(2, pad.get_numaxes()))]
        x, y = (*axes, 0.0, 0.0)[:2]
        down = frozenset(button for button in range(pad.get_numbuttons()) if pad.get_button(button))
        return Held(x, -y, bool(down & SHOULDERS), down - SHOULDERS)


def open_gamepad() -> Gamepad:
    """The reader of this computer's pads; PadMissing where the optional part is not installed. Loads nothing yet."""
    if importlib.util.find_spec("pygame") is None:
        raise PadMissing(INSTALL)
    return Gamepad()


def _sdl() -> Any:
    """SDL without a screen; the variables have to be there before it is loaded."""
    os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
    os.environ.setdefault("SDL_JOYSTICK_ALLOW_BACKGROUND_EVENTS", "1")
    os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
    import pygame

    return pygame


def _present(joystick: Any) -> set[int]:
    return {joystick.Joystick(number).get_instance_id() for number in range(joystick.get_count())}
