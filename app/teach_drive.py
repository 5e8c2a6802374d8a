"""Driving by a stick while teaching: looks at the stick with every tick, and keeps the lease of both axes."""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import Future
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QApplication

from app.connection import Connection
from app.tick import Tick, failure_of
from codegen.teach_drive import ramps_of, speeds_of
from device.api import StopState
from widgets.teach.panel import JOYSTICK, PLACES, VOLTS, TeachPanel, is_fresh

if TYPE_CHECKING:
    from codegen.setup import Setup
    from device.steer import Drove

OWNER = "teach"
FORGOTTEN_S = 180.0  # in its middle for so long: driving ends
SILENT_S = 2.0  # without a reading of the joystick: driving ends
CENTRED_S = 0.4  # in its middle for so long: the axes are given back
RECORD, DONE = 0b0100_0000, 0b1000_0000  # inputs 7 and 8 (SSC manual, figure 2.5)


class TeachDrive(QObject):
    """`recorded` and `finished` are called when the buttons of the joystick were pressed."""

    def __init__(
        self,
        connection: Connection,
        tick: Tick,
        panel: TeachPanel,
        clock: Callable[[], float],
        recorded: Callable[[], None],
        finished: Callable[[], None],
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self._connection, self._tick, self._panel, self._clock = connection, tick, panel, clock
        self._recorded, self._finished = recorded, finished
        self._held: Future[Any] | None = None
        self._armed = False  # the stick was seen in its middle
        self._centred = 0.0  # since when
        self._released: int | None = None  # the inputs while nobody presses a button
        self._pressed = 0
        self._heard = 0.0  # when the stick was known last
        panel.enable_wanted.connect(self.enable)
        tick.each(self.look)

    @property
    def drives(self) -> bool:
        """Whether an axis is in this hand now."""
        return self._held is not None and not self._held.done()

    def enable(self, on: bool) -> None:
        """Begins, or ends and lets everything go."""
        self._armed, self._centred, self._released, self._pressed = False, 0.0, None, 0
        self._heard = self._clock()
        if on and not self._panel.reason:
            self._panel.show_result("Let the stick stand in its middle once; then it drives.")
        elif self.drives:
            self._connection.controller.motion.release(OWNER)
        self._panel.show_enabled(on and not self._panel.reason)

    def again(self) -> None:
        """Other values are to be read along the way: the axes are taken anew."""
        if self.drives:
            self._connection.controller.motion.release(OWNER)

    def look(self) -> None:
        """With every tick."""
        if not self._panel.enabled:
            return
        if why := self._ended():
            self._panel.ended(why)
            return
        across, upward = self._panel.pushed
        known = math.isfinite(across) and math.isfinite(upward)
        if known:
            self._heard = self._clock()
            self._armed |= across == 0 and upward == 0
        elif self._clock() - self._heard > SILENT_S:
            self._panel.ended("Driving ended: the joystick's voltages are not read any more.")
            return
        self._steer(across if known else 0.0, upward if known else 0.0)  # unknown: as if it were let go
        if self._panel.enabled and self._panel.source == JOYSTICK:
            self._buttons()

    def _ended(self) -> str:
        controller = self._connection.controller
        if self._panel.reason:
            return self._panel.reason
        if controller.stop_state in (StopState.STOPPING, StopState.NOT_CONFIRMED):
            return "Driving ended by STOP."
        if not self._panel.has_keyboard(QApplication.focusWidget()):
            return "Driving ended: something else has the keyboard now."
        return ""

    def _steer(self, across: float, upward: float) -> None:
        """The joystick at the controller keeps the axes all the time: only so its voltages are read often enough."""
        now, motion, setup = self._clock(), self._connection.controller.motion, self._panel.setup
        still, joystick = across == 0 and upward == 0, self._panel.source == JOYSTICK
        if not still or not self._centred:
            self._centred = now
        if setup is None:
            return
        if now - self._centred > FORGOTTEN_S:
            self._panel.ended("Driving ended: nothing was driven for some minutes.")
            return
        speeds = speeds_of(across, upward, self._panel.driving, setup) if self._armed else {"X": 0, "Y": 0}
        if not self.drives and (joystick or any(speeds.values())):
            self._begin(speeds, setup)
        elif self.drives and still and not joystick and now - self._centred > CENTRED_S:
            motion.release(OWNER)
        elif self.drives:
            motion.steer(OWNER, speeds)
            motion.renew(OWNER)

    def _begin(self, speeds: dict[str, int], setup: Setup) -> None:
        motion = self._connection.controller.motion
        motion.setup = setup
        ramps = ramps_of(self._panel.driving, setup)
        along = ("inputs", *VOLTS) if self._panel.source == JOYSTICK else ()
        self._held = motion.drive(speeds, ramps, ramps, OWNER, (*along, *PLACES) if self._panel.way else along)
        self._tick.when_done(self._held, self._ran)

    def _ran(self, future: Future[Any]) -> None:
        """Ended: let go, or by itself; then the stick has to come back to its middle."""
        failure = failure_of(future)
        drove: Drove | None = None if failure else future.result()
        self._armed = self._armed and self._panel.pushed == (0.0, 0.0)
        if failure:
            self._panel.show_result(failure, good=False)
            self._panel.ended(failure)
        elif drove is not None and drove.sentence:
            self._panel.show_result(f"{drove.sentence} Let the stick go to drive on.", good=False)

    def _buttons(self) -> None:
        """The two buttons of the joystick: an input that changes from what it was while nobody pressed it."""
        row = self._connection.controller.last()
        if not math.isfinite(row.value("inputs")) or not is_fresh(row, "inputs", self._clock()):
            return
        inputs = int(row.value("inputs")) & (RECORD | DONE)
        if self._released is None:
            self._released = inputs
        pressed = inputs ^ self._released
        new, self._pressed = pressed & ~self._pressed, pressed
        if new & RECORD:
            self._recorded()
        if new & DONE:
            self._finished()
