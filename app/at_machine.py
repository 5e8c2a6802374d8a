"""The panels at the machine and what joins them to it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from app.window import BOTTOM, RIGHT
from widgets.parts.pieces import dressed

if TYPE_CHECKING:
    from PySide6.QtCore import Qt

    from app.compose import Studio
    from app.search import Candidate
    from widgets.panel import Panel


class AtMachine:
    """Made by `pieces`; each panel hears of ticks, controllers and documents from the moment it is made."""

    def __init__(self, studio: Studio, ports: Callable[[], list[Candidate]]) -> None:
        self._studio, self._ports = studio, ports
        self.panels: tuple[Panel, ...] = ()

    def pieces(self) -> Iterator[None]:
        """First those that hear what happens and keep it, then the panels with their docks, in order of the menu."""
        yield from self._events()
        yield from self._recorder()
        yield from self._jog()
        yield from self._plane()
        yield from self._teach()
        yield from self._operator()
        yield from self._tuner()
        yield from self._scope()
        yield from self._values()
        yield from self._dock(self.event_list, BOTTOM)
        yield from self._dock(self.tape, BOTTOM)

    def _add(self, panel: Panel) -> None:
        """Works with what is connected and open from now on."""
        studio = self._studio
        self.panels += (panel,)
        panel.loaded = lambda: studio.loading.ready
        studio.tick.add(panel)
        panel.attach(studio.connection.controller)
        panel.show_document(None, studio.session.document)

    def _dock(self, panel: Panel, area: Qt.DockWidgetArea) -> Iterator[None]:
        """In its dock, and dressed already when it is shown for the first time."""
        yield
        self._studio.desk.add(panel.title, panel, area)
        yield
        yield from dressed(panel)

    # ---- what hears

    def _events(self) -> Iterator[None]:
        from app.event_list import Happened
        from widgets.events.panel import EventsPanel

        studio = self._studio
        yield
        self.event_list = EventsPanel()
        yield
        self.happened = Happened(
            studio.connection, studio.session, studio.tick, self.event_list, studio.data, studio.window
        )
        self.happened.said.connect(studio.desk.say)
        self.event_list.line_wanted.connect(studio.ear.reveal)
        self.event_list.help_wanted.connect(studio.desk.show_help)
        self._add(self.event_list)
        self._add(self.happened.ear)
        yield

    def _recorder(self) -> Iterator[None]:
        from app.recorder import Recorded
        from widgets.recorder.panel import RecorderPanel

        studio = self._studio
        yield
        self.tape = RecorderPanel()
        yield
        self.recorded = Recorded(studio, studio.recorder, self.tape, studio.files.folder)
        self.recorded.said.connect(studio.desk.say)
        studio.leaving.last.append(self.recorded.once)
        self.happened.recording = self.recorded.kept
        self._add(self.tape)
        self._add(self.recorded.ear)
        yield

    # ---- what moves

    def _jog(self) -> Iterator[None]:
        from app.by_hand import ByHand
        from app.pads import Pads
        from app.points import Points
        from widgets.jog.panel import JogPanel

        yield
        studio = self._studio
        self.jog = JogPanel(clock=studio.now)
        yield
        self.by_hand = ByHand(
            studio.connection, studio.session, studio.tick, self.jog, studio.desk.ask, studio.ear.homed_axes,
            studio.settings, Points(studio.data / "points"), studio,
        )  # fmt: skip
        self.pads = Pads()
        self.jog.more.setup_wanted.connect(studio.setup.show)
        self.pads.add(self.jog)
        studio.tick.each(self.pads.look)
        self._add(self.jog)
        yield from self._dock(self.jog, RIGHT)

    def _plane(self) -> Iterator[None]:
        from app.ghosts import Ghosts
        from widgets.plane.panel import PlanePanel

        studio = self._studio
        yield
        self.plane = PlanePanel(clock=studio.now)
        yield
        self.ghosts = Ghosts(studio.display, self.plane, self.jog, studio.ear.homed_axes)
        self.ghosts.sources.append(self.by_hand.ghost)
        studio.tick.each(self.ghosts.look)
        self._add(self.plane)
        yield from self._dock(self.plane, RIGHT)

    def _teach(self) -> Iterator[None]:
        from app.teach import Teach
        from widgets.teach.panel import TeachPanel

        studio = self._studio
        yield
        self.table = TeachPanel(clock=studio.now)
        yield
        self.teach = Teach(
            studio.connection, studio.session, studio.tick, self.table, self.plane, studio.desk.ask,
            studio.ear.homed_axes, studio.files.folder, studio.data, studio.now, studio.settings, studio,
        )  # fmt: skip
        self.pads.add(self.table, self.table.pad_dead)
        self.ghosts.sources.append(self.teach.play.ghost)
        studio.leaving.last.append(self.teach.end)
        self._add(self.table)
        yield from self._dock(self.table, RIGHT)

    # ---- what is looked at

    def _operator(self) -> Iterator[None]:
        from app.operator import Operator
        from widgets.operator.panel import OperatorPanel

        studio = self._studio
        yield
        self.keys = OperatorPanel()
        yield
        self.operator = Operator(studio.connection, studio.tick, self.keys, self._ports, studio)
        self.operator.tap = lambda opener: studio.recorder.channel().tap(opener)
        self._add(self.keys)
        self.keys.loaded = lambda: True  # its keys need nothing that is loaded later
        yield from self._dock(self.keys, RIGHT)

    def _tuner(self) -> Iterator[None]:
        from app.tuner_part import TunerPart

        yield
        self.tuning = TunerPart(self._studio, self._studio.data)
        yield
        self._add(self.tuning.panel)
        yield from self._dock(self.tuning.panel, RIGHT)

    def _scope(self) -> Iterator[None]:
        from app.scope import Scope
        from widgets.scope.panel import ScopePanel

        studio = self._studio
        yield
        self.curves = ScopePanel()
        yield
        self.scope = Scope(
            studio.connection, studio.session, studio.tick, self.curves, studio.data / "captures", studio.now,
            studio.window, studio.settings, studio,
        )  # fmt: skip
        self.scope.said.connect(studio.desk.say)
        self.scope.note = studio.recorder.note
        studio.leaving.last.append(self.scope.end)
        self.recorded.capture_wanted.connect(self._show_capture)
        self._add(self.curves)
        yield from self._dock(self.curves, BOTTOM)

    def _show_capture(self, data: bytes) -> None:
        """Out of a recording."""
        self._studio.late.bring_scope()
        self.scope.show_recorded(data)

    def _values(self) -> Iterator[None]:
        from app.variables import Variables
        from widgets.values.panel import ValuesPanel

        studio = self._studio
        yield
        self.values = ValuesPanel()
        yield
        self.variables = Variables(
            studio.connection, studio.tick, self.values, studio.desk.ask, studio.files.folder, studio.settings, studio
        )
        studio.talk.taken.connect(self.variables.hear)
        self._add(self.values)
        yield from self._dock(self.values, BOTTOM)
