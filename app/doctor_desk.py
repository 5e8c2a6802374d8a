"""The connection doctor of the windows: examines a port beside the window's thread, and connects where it answers."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeAlias

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QWidget

from app.connection import Connection
from app.search import Candidate
from app.tick import Tick
from device.api import Kind, LineSettings, State
from device.transport import open_transport

if TYPE_CHECKING:
    from device.doctor import Diagnosis
    from device.download import Job
    from device.recorder import Recorder
    from widgets.connect.doctor import DoctorWindow

Examine: TypeAlias = "Callable[[str, LineSettings], Job[Diagnosis]]"


def examined(recorder: Recorder, device: str, line: LineSettings) -> Job[Diagnosis]:
    """The examination, recorded; what it needs is loaded when somebody asks for one."""
    from device.doctor import examination

    channel = recorder.channel()
    return examination(device, line, open_=lambda address, line: channel.wrap(open_transport(address, line)))


class DoctorDesk(QObject):
    """Owns the window; one examination at a time."""

    connect_wanted = Signal(str, int)  # port, baud
    help_wanted = Signal(str)  # page

    def __init__(
        self,
        connection: Connection,
        tick: Tick,
        ports: Callable[[], list[Candidate]],
        line: Callable[[], LineSettings],
        chosen: Callable[[], str],
        parent: QWidget,
        examine: Examine,
    ) -> None:
        super().__init__(parent)
        self._connection, self._ports, self._line, self._chosen = connection, ports, line, chosen
        self._parent, self.examine_port = parent, examine
        self.window: DoctorWindow | None = None
        self.job: Job[Diagnosis] | None = None
        tick.each(self.look)

    def show(self) -> None:
        """The window, with the ports there are."""
        from widgets.connect.doctor import DoctorWindow

        if self.window is None:
            self.window = DoctorWindow(self._parent)
            self.window.examine_wanted.connect(self.examine)
            self.window.cancel_wanted.connect(self.cancel)
            self.window.connect_wanted.connect(self._connect)
            self.window.help_wanted.connect(self.help_wanted)
        if self.job is None:
            self.window.show_ports([(each.device, each.words) for each in self._ports()], self._chosen())
        self.window.show()
        self.window.raise_()
        self.window.examine.setFocus()

    def examine(self, device: str) -> None:
        """Begins; a port that is ours and answers needs no examination, one that does not is let go first."""
        assert self.window is not None
        controller = self._connection.controller
        ours = controller.kind is Kind.MACHINE and self._connection.address == device
        if ours and controller.state is State.READY:
            self.window.show_diagnosis(f"{device} is connected, and {controller.who} answers.", (), None, True)
            return
        if ours:
            self._connection.go_offline()
        self.cancel()
        self.job = self.examine_port(device, self._line())
        self.window.show_busy("Opening", 0.0)

    def cancel(self) -> None:
        """Ends the examination at the next moment."""
        if self.job is not None:
            self.job.cancel()

    def look(self) -> None:
        """With each tick: how far it is, and its end."""
        job, window = self.job, self.window
        if job is None or window is None:
            return
        if not job.future.done():
            window.show_busy(job.phase, job.fraction)
            return
        self.job = None
        from widgets.connect.doctor import PAGE, TROUBLE

        found = job.future.result()
        page = TROUBLE if found.of_the_line else PAGE
        window.show_diagnosis(found.sentence, found.steps, found.baud, found.fine, page)

    def _connect(self, device: str, baud: int) -> None:
        assert self.window is not None
        self.window.close()
        self.connect_wanted.emit(device, baud)
