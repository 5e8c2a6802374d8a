"""The panels at the machine and what joins them to it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from app.by_hand import ByHand
from app.event_list import Happened
from app.ghosts import Ghosts
from app.operator import Operator
from app.pads import Pads
from app.points import Points
from app.recorder import Recorded
from app.scope import Scope
from app.search import Candidate
from app.teach import Teach
from app.tuner_part import TunerPart
from app.variables import Variables
from app.window import BOTTOM, RIGHT
from widgets.events.panel import EventsPanel
from widgets.jog.panel import JogPanel
from widgets.operator.panel import OperatorPanel
from widgets.panel import Panel
from widgets.plane.panel import PlanePanel
from widgets.recorder.panel import RecorderPanel
from widgets.scope.panel import ScopePanel
from widgets.teach.panel import TeachPanel
from widgets.values.panel import ValuesPanel

if TYPE_CHECKING:
    from app.compose import Studio


class AtMachine:
    """`panels` want rows and notices; `docks` are titles, panels and places."""

    def __init__(
        self, studio: Studio, data: Path, clock: Callable[[], float], ports: Callable[[], list[Candidate]]
    ) -> None:
        connection, tick, ask = studio.connection, studio.tick, studio.desk.ask
        self.plane, self.keys = PlanePanel(clock=clock), OperatorPanel()
        self.jog, self.values, self.event_list = JogPanel(clock=clock), ValuesPanel(), EventsPanel()
        self.variables = Variables(connection, tick, self.values, ask, studio.files.folder, studio)
        self.operator = Operator(connection, tick, self.keys, ports, studio)
        self.happened = Happened(connection, studio.session, tick, self.event_list, data, studio.window)
        self.by_hand = ByHand(
            connection, studio.session, tick, self.jog, ask, studio.ear.homed_axes, studio.settings,
            Points(data / "points"), studio,
        )  # fmt: skip
        self.ghosts = Ghosts(studio.display, self.plane, self.jog, studio.ear.homed_axes)
        self.ghosts.sources.append(self.by_hand.ghost)
        tick.each(self.ghosts.look)
        self.pads = Pads()
        self.pads.add(self.jog)
        tick.each(self.pads.look)
        self.tape = RecorderPanel()
        self.recorded = Recorded(studio, studio.recorder, self.tape, studio.files.folder)
        self.recorded.said.connect(studio.desk.say)
        self.happened.recording = self.recorded.kept
        self.tuning = TunerPart(studio, data)
        self.curves = ScopePanel()
        self.scope = Scope(
            connection, studio.session, tick, self.curves, data / "captures", clock, studio.window, studio
        )
        self.scope.said.connect(studio.desk.say)
        self.scope.note = studio.recorder.note
        self.table = TeachPanel(clock=studio.now)
        self.teach = Teach(
            connection, studio.session, tick, self.table, self.plane, ask, studio.ear.homed_axes, studio.files.folder,
            data, studio.now, studio,
        )  # fmt: skip
        self.pads.add(self.table)
        self.ghosts.sources.append(self.teach.play.ghost)
        self.event_list.line_wanted.connect(studio.ear.reveal)
        self.operator.tap = lambda opener: studio.recorder.channel().tap(opener)
        self.event_list.help_wanted.connect(studio.desk.show_help)
        self.happened.said.connect(studio.desk.say)
        self.panels: tuple[Panel, ...] = (
            self.plane, self.keys, self.jog, self.values, self.event_list, self.happened.ear,
            self.tape, self.recorded.ear, self.curves, self.table, self.tuning.panel,
        )  # fmt: skip
        self.docks = (
            ("Jog", self.jog, RIGHT),
            ("X-Y view", self.plane, RIGHT),
            ("Teach", self.table, RIGHT),
            ("Operator terminal", self.keys, RIGHT),
            ("Tuner", self.tuning.panel, RIGHT),
            ("Scope", self.curves, BOTTOM),
            ("Variables", self.values, BOTTOM),
            ("Events", self.event_list, BOTTOM),
            ("Recorder", self.tape, BOTTOM),
        )
