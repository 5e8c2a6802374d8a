"""The reader of gamepads, with a pad that SDL itself pretends to have."""

from __future__ import annotations

import ctypes
import importlib.util
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from device import gamepad
from device.gamepad import Gamepad, Held, PadMissing, open_gamepad

FULL, HALF = 32767, -16384  # SDL: axes are 16 bits, down is positive
GAMEPAD = 1  # SDL_JOYSTICK_TYPE_GAMECONTROLLER
LEFT_SHOULDER, A = 9, 0  # SDL_GameControllerButton


class VirtualPad:
    """A pad of SDL's own making, in this process."""

    def __init__(self) -> None:
        found = importlib.util.find_spec("pygame")
        assert found is not None and found.origin is not None
        folder = Path(found.origin).parents[1] / "pygame_ce.libs"
        libraries = sorted(folder.glob("libSDL2-2*"))
        if not libraries:
            pytest.skip("SDL lies elsewhere on this system")
        self.sdl = ctypes.CDLL(str(libraries[0]))
        self.sdl.SDL_JoystickOpen.restype = ctypes.c_void_p
        self.number = -1
        self._pad = ctypes.c_void_p()

    def plug(self) -> None:
        self.number = self.sdl.SDL_JoystickAttachVirtual(GAMEPAD, 6, 15, 0)
        assert self.number >= 0
        self._pad = ctypes.c_void_p(self.sdl.SDL_JoystickOpen(self.number))

    def push(self, axis: int, value: int) -> None:
        self.sdl.SDL_JoystickSetVirtualAxis(self._pad, axis, ctypes.c_int16(value))

    def press(self, button: int, down: bool) -> None:
        self.sdl.SDL_JoystickSetVirtualButton(self._pad, button, int(down))

    def unplug(self) -> None:
        if self.number >= 0:
            self.sdl.SDL_JoystickDetachVirtual(self.number)
            self.number = -1


@pytest.fixture
def pad() -> Iterator[tuple[Gamepad, VirtualPad]]:
    pytest.importorskip("pygame")
    reader, virtual = open_gamepad(), VirtualPad()
    until(lambda: reader._at > 0)  # SDL has begun
    yield reader, virtual
    virtual.unplug()
    reader.close()


def until(true: Callable[[], object]) -> None:
    end = time.monotonic() + 20
    while not true():
        assert time.monotonic() < end
        time.sleep(0.005)


@pytest.mark.paced
def test_a_pad_is_found_read_and_missed_when_it_is_unplugged(pad: tuple[Gamepad, VirtualPad]) -> None:
    reader, virtual = pad
    assert reader.read() is None
    virtual.plug()
    until(lambda: reader.read() is not None)
    virtual.push(0, FULL)
    virtual.push(1, HALF)
    virtual.press(A, True)
    until(lambda: (held := reader.read()) is not None and held.buttons == {A} and held.x == 1.0)
    held = reader.read()
    assert held is not None and held.y == pytest.approx(0.5, abs=1e-3) and not held.dead_man
    virtual.press(LEFT_SHOULDER, True)
    until(lambda: (held := reader.read()) is not None and held.dead_man)
    virtual.unplug()
    until(lambda: reader.read() is None)
    virtual.plug()
    until(lambda: reader.read() == Held(0.0, 0.0, False, frozenset()))


def test_a_thread_that_hangs_is_no_pad() -> None:
    reader = Gamepad.__new__(Gamepad)
    reader._clock, reader._last, reader._at = (lambda: 10.0), Held(1.0, 0.0, True), 9.95
    assert reader.read() == Held(1.0, 0.0, True)
    reader._at = 9.85
    assert reader.read() is None


def test_without_the_optional_part_one_sentence_says_how_to_install_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gamepad.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(PadMissing, match=r"pip install twoletter-studio\[gamepad\]"):
        open_gamepad()
