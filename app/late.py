"""What the first window does not need: made after it, a piece with each tick, or at once when it is wanted."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from functools import cached_property, partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from device.api import Controller, Kind
from widgets.parts.pieces import BREATH_S, Pieces, in_breaths

if TYPE_CHECKING:
    from app.at_machine import AtMachine
    from app.backup_part import BackupPart
    from app.commissioning import Commissioning
    from app.compose import Studio
    from app.former_offer import Offer
    from app.search import Candidate
    from widgets.panel import Panel

ALL = ""  # no panel has that title: once everything is made
COMMISSIONING, TUNING = "commissioning", "tuning"  # folders with what was there before a step, or before a run


class Late(QObject):
    """Panels at the machine, back-ups, commissioning; and the actions that open them."""

    def __init__(self, studio: Studio, ports: Callable[[], list[Candidate]]) -> None:
        super().__init__(studio)
        self._studio, self._ports = studio, ports
        self._parts: AtMachine | None = None
        self._wish: tuple[str, Callable[[], None]] | None = None  # a panel that is not made yet, and what then
        self.making = Pieces(self._make())

    def _make(self) -> Iterator[None]:
        from app.at_machine import AtMachine

        self._parts = AtMachine(self._studio, self._ports)
        yield
        yield from in_breaths(self._parts.pieces())
        yield
        assert self.proof

    def look(self) -> None:
        """With each tick: the next piece; once all are there, what they have to look at."""
        if not self._made_more():
            return
        studio = self._studio
        self.proof.look(studio.follow.known)
        self.interrupted.look()
        if "commissioning" in self.__dict__:
            self.commissioning.look()

    def _made_more(self) -> bool:
        """The next piece, some more where somebody waits for a panel; True once all are there."""
        end = time.perf_counter() + 2 * BREATH_S
        while not self.making.step() and self._wish is not None and time.perf_counter() < end:
            pass
        if self._wish is not None and (self.making.done or self._wish[0] in self._studio.window.docks):
            (_, call), self._wish = self._wish, None
            call()
            return False  # the rest comes with the next tick
        return self.making.done

    def _once_made(self, title: str, call: Callable[[], None]) -> None:
        """At once where all panels are there; else as soon as this one is, unless the person wants another one."""
        self._wish = None if self.making.wanted() else (title, call)
        if self._wish is None:
            call()

    def close(self) -> None:
        """At the end; nothing more is made."""
        if self.making.done:
            self.at_machine.pads.close()
            self.at_machine.tuning.book.close()
        self.making.done = True

    @property
    def panels(self) -> tuple[Panel, ...]:
        """As far as they are made."""
        return self._parts.panels if self._parts is not None else ()

    @property
    def at_machine(self) -> AtMachine:
        """Jog, X-Y view, variables, events, operator terminal and the others: all of them."""
        self.making.finish()
        assert self._parts is not None
        return self._parts

    @cached_property
    def proof(self) -> BackupPart:
        """Compare, back-ups, handover."""
        from app.backup_part import BackupPart

        studio = self._studio
        proof = BackupPart(
            studio.connection, studio.run, studio.session, studio.desk.ask, studio.data, studio.tick, studio.program,
            studio.window,
        )  # fmt: skip
        proof.comparing.show_step.connect(studio.program.reveal_step)
        proof.backups.act.connect(lambda name: studio.actions[name].trigger())
        proof.said.connect(studio.desk.say)
        return proof

    @cached_property
    def commissioning(self) -> Commissioning:
        """Bringing an axis to life; made when it is wanted, or when an interrupted step may have left something."""
        from app.commissioning import Commissioning

        studio = self._studio
        made = Commissioning(
            studio.connection, studio.session, studio.tick, studio.desk.ask, lambda: studio.follow.known, studio.data,
            studio.window,
        )  # fmt: skip
        made.said.connect(studio.desk.say)
        made.help_wanted.connect(studio.desk.show_help)
        made.broken.connect(self.interrupted.again)
        return made

    @cached_property
    def interrupted(self) -> Offer:
        """What a step of commissioning that broke off has left."""
        from app.former_offer import STEP, Offer

        studio = self._studio
        made = Offer(
            studio.connection, studio.tick, studio.in_turn.ask, studio.data / COMMISSIONING,
            self._step_goes_on, self, STEP,
        )  # fmt: skip
        made.said.connect(studio.desk.say)
        return made

    @property
    def looking(self) -> bool:
        """Whether it is still open what an interrupted step has left in what is connected."""
        if self._studio.connection.controller.kind is Kind.OFFLINE:
            return False
        return not self.making.done or self.interrupted.looking or self.at_machine.tuning.offer.looking

    def offers_first(self, controller: Controller) -> bool:
        """Whether former values of what was interrupted are still to be offered: that comes first (safety.md, 4)."""
        folders = [folder for name in (COMMISSIONING, TUNING) if (folder := self._studio.data / name).is_dir()]
        if not folders or controller.resting():
            return False
        from device.former import left_behind, meant

        return any(meant(former, controller) for folder in folders for former in left_behind(folder))

    def _step_goes_on(self) -> bool:
        return "commissioning" in self.__dict__ and bool(self.commissioning.busy)

    # ---- actions

    def bring(self, title: str) -> None:
        """A panel that may have to be made first."""
        self._once_made(title, partial(self._studio.desk.bring, title))

    def bring_scope(self) -> None:
        """Curves want room."""
        self._once_made("Scope", self._bring_scope)

    def _bring_scope(self) -> None:
        assert self._parts is not None
        self._parts.scope.bring(self._studio.window.docks["Scope"])
        self._studio.desk.bring("Scope")

    def open_recording(self) -> None:
        """Asks which one."""
        self._once_made(ALL, self._open_recording)

    def _open_recording(self) -> None:
        self._studio.desk.bring("Recorder")
        self.at_machine.recorded.ask_open()

    def tune(self) -> None:
        """The tuner needs room: in its layout, unless it has a window of its own."""
        self._once_made(ALL, self._tune)

    def _tune(self) -> None:
        window = self._studio.window
        dock = window.docks["Tuner"]
        if not dock.isFloating() and window.centralWidget().isVisible():
            self._studio.desk.arrange("Tune")
        dock.bring()

    def arrange(self, layout: str) -> None:
        """A layout with panels that may have to be made first."""
        self._once_made(ALL, partial(self._studio.desk.arrange, layout))
