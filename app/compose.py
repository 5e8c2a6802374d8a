"""The only place that creates long-lived objects and joins them."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QSize
from PySide6.QtWidgets import QApplication

from app.actions import MAIN, RUN, Actions
from app.connection import Connection, Connector
from app.crash import CrashHook
from app.desk import Desk
from app.docks import settle
from app.doctor_desk import DoctorDesk, examined
from app.editor import Editor
from app.files import Files
from app.folding import Folding
from app.follow import Follow, Program
from app.found_working import FoundWorking
from app.importing import Importing
from app.in_turn import InTurn
from app.late import Late
from app.leaving import Leaving
from app.live_values import LiveValuesReader
from app.loading import Loading
from app.options import Options
from app.right_machine import RightMachine
from app.rubbish import Rubbish
from app.run import Run
from app.search import Candidate, Search
from app.session import Session
from app.settings import Settings
from app.setup_desk import SetupDesk
from app.setup_file import last_setup
from app.setup_limits import SetupLimits
from app.start import Start
from app.stop_key import StopKey
from app.talk import Talk
from app.theme import Choice, Theme
from app.tick import Tick
from app.which_model import WhichModel
from app.window import BOTTOM, LEFT, RIGHT, Window
from codegen.document import Document
from codegen.generate import Listing
from codegen.setup import Setup
from codegen.slowed import PERCENTS
from device.api import Controller, Kind
from device.recorder import Recorder
from widgets.display.display import DisplayPanel
from widgets.display.messages import MessagesPanel
from widgets.panel import Panel
from widgets.program.view import ProgramView
from widgets.simulator.panel import SimulatorPanel
from widgets.terminal.terminal import TerminalPanel

if TYPE_CHECKING:
    from app.at_machine import AtMachine
    from app.backup_part import BackupPart
    from app.commissioning import Commissioning


RECORDINGS = "recordings"  # the folder of the recorder


class Studio(QObject):
    """One running studio: everything in it is made here and handed what it needs."""

    def __init__(
        self,
        application: QApplication,
        settings: Settings,
        data: Path,
        connect: Connector,
        ports: Callable[[], list[Candidate]],
        pages: Mapping[str, str],
        clock: Callable[[], float] = time.monotonic,
        seek: Connector | None = None,
        recorder: Recorder | None = None,
    ) -> None:
        super().__init__()
        self.rubbish = Rubbish()
        self.recorder = recorder or Recorder(data / RECORDINGS, clock=clock, threaded=False)
        self.settings = settings
        self.theme = Theme(application, Choice(settings.get("theme")), ticking=True)
        self.session = Session(Document(setup=last_setup(data) or Setup()), recovery_folder=data / "recovery")
        self.connection = Connection(connect, Controller.offline, self)
        self.tick, self.clock = Tick(self), clock
        self.program = ProgramView(self.session)
        self.window = Window(self.program)
        self.display, self.messages = DisplayPanel(clock=self.now), MessagesPanel()
        self.terminal, self.simulator = TerminalPanel(), SimulatorPanel()
        self.desk = Desk(self.window, self.session, settings, self.theme, self.messages, pages)
        self.files = Files(self.session, settings, self.desk.ask, self.tick, self.window)
        self.folding = Folding(self.session, self.program, settings, self)
        self.importing = Importing(self.session, self.desk.ask, self.window)
        self.right = RightMachine(self.connection, self.session, self.desk.ask)
        self.setup = SetupDesk(self.window, self.session, self.connection, self.tick, self.desk.ask, self.right, data)
        self.limits = SetupLimits(self.connection, self.session, self.tick, self.desk.ask, self)
        self.run = Run(self.connection, self.session, self.tick, self.desk.ask, self.right, self)
        self.data = data
        self.late, self.loading = Late(self, ports), Loading(pages)
        self.run.before = lambda reason, go_on: self.late.proof.keeping.before(reason, go_on)
        self.run.before_start = self.limits.careful
        self.leaving = Leaving(self.connection, self.run, self.desk, self.files, self.tick, self.window)
        self.talk = Talk(self.connection, self.tick, self.terminal, self)
        self.editor = Editor(
            self.connection, self.session, self.run, self.desk.ask, self.importing.take, self.files.folder, data,
            self.window,
        )  # fmt: skip
        self.leaving.careful_of_code = self.editor.careful
        self.leaving.last.append(self.folding.remember)
        self.search = Search(seek or connect, clock, self)
        self.start = Start(self.connection, self.search, settings, ports, self.model, self.leaving, self.window)
        self.doctor = DoctorDesk(
            self.connection, self.tick, ports, self.start.line, lambda: self.start.choice().port, self.window,
            partial(examined, self.recorder),
        )  # fmt: skip
        self.options = Options(settings, self._theme, self.window)
        self.in_turn = InTurn(self.connection, self.desk.put, self._asks_later, self)
        self.which = WhichModel(self.connection, settings, self.in_turn.ask)
        self.met = FoundWorking(
            self.connection, self.in_turn.ask, self.connection.stop, self.run.upload,
            lambda controller: self.in_turn.asking or self.late.offers_first(controller),
        )  # fmt: skip
        self.actions = Actions(self._handlers(), self.program.commands, self)
        self.follow = Follow(self.connection, self.session, self.run, self.actions, self.window, self)
        self.setup.facts = self.follow.facts
        self.ear = Program(self.program, self.display, self.tick, self.desk.say)
        self.program.live = LiveValuesReader(self.connection, self.tick)
        self.stop_key = StopKey(application, self.connection.stop)
        self.tick.around = self.stop_key.aside
        self.crash = CrashHook(data / "crashes", self.connection.stop, self)
        self._first: tuple[Panel, ...] = (self.display, self.messages, self.terminal, self.simulator, self.ear)
        self._fill_window()
        self._join()
        self._attach(self.connection.controller)
        self.tick.show_all()
        self._document_changed(None, self.session.document)

    def _asks_later(self) -> bool:
        """Whether something about the machine may be asked in a moment."""
        return self.start.looking or self.met.asking or self.late.looking

    def now(self) -> float:
        """The time by which live values get old: a replay's own, which stands still with it."""
        controller = self.connection.controller
        return controller.clock() if controller.kind is Kind.REPLAY else self.clock()

    def model(self) -> str:
        """The controller model the open program is for."""
        return self.session.document.setup.model

    def close(self) -> None:
        """At the end: no more ticks, the connection closed, the hooks given back."""
        self.tick.stop()
        self.search.cancel()
        self.late.close()
        self.connection.close()
        self.recorder.close()
        self.crash.uninstall()
        self.stop_key.remove()
        self.theme.release()
        self.rubbish.end()

    def _handlers(self) -> dict[str, Callable[[], None]]:
        desk, run, start, late = self.desk, self.run, self.start, self.late
        return {
            "new": self._new, "open": self.files.open, "save": self.files.save, "save_as": self.files.save_as,
            "recover": desk.show_unsaved,
            "import_module": lambda: self.importing.ask_file(self.files.folder()),
            "export_code": self.files.export_code, "options": self.options.show, "exit": self._exit,
            "layout_program": partial(desk.arrange, "Program"), "layout_run": partial(desk.arrange, "Run"),
            "layout_tune": partial(late.arrange, "Tune"),
            "theme_system": partial(self._theme, "system"), "theme_light": partial(self._theme, "light"),
            "theme_dark": partial(self._theme, "dark"),
            "setup": self.setup.show, "program": self._program, "terminal": partial(desk.bring, "Terminal"),
            "plane": partial(late.bring, "X-Y view"), "operator": partial(late.bring, "Operator terminal"),
            "teach": partial(late.bring, "Teach"),
            "scope": late.bring_scope,
            "events": partial(late.bring, "Events"), "recorder": partial(late.bring, "Recorder"),
            "open_recording": late.open_recording,
            "editor": self.editor.show,
            "commissioning": lambda: late.commissioning.show(),
            "jog": partial(late.bring, "Jog"), "tune": late.tune, "variables": partial(late.bring, "Variables"),
            "display": partial(desk.bring, "Display"), "simulator_panel": partial(desk.bring, "Simulator"),
            "connect": start.look, "serial": start.show_serial, "doctor": self.doctor.show,
            "simulator": start.use_simulator, "disconnect": start.disconnect_now,
            "take_control": self._toggle_control,
            "download": run.download, "execute": run.execute, "halt": run.halt, "burn": run.burn, "upload": run.upload,
            **{f"execute_{each}": partial(run.execute_slowly, each) for each in PERCENTS},
            "compare": lambda: late.proof.comparing.show(), "backups": lambda: late.proof.backups.show(),
            "handover": lambda: late.proof.handing.show(), "print_pack": lambda: late.proof.handing.show_pack(),
            "stop": self.connection.stop, "help": desk.help_for_focus,
            "about": self._about, "help_wiring": self._wiring,
            "help_programming": partial(desk.show_help, "Programming"),
            "help_examples": partial(desk.show_help, "Examples"),
            "help_trouble": partial(desk.show_help, "Troubleshooting"),
        }  # fmt: skip

    def _fill_window(self) -> None:
        window, header = self.window, self.window.header
        window.add("Instructions", self.program.instructions, LEFT)
        window.add("Display", self.display, RIGHT, moves=True)
        window.add("Simulator", self.simulator, RIGHT, moves=True)
        window.add("Inspector", self.program.inspector, RIGHT)
        window.add("Problems", self.program.problems, BOTTOM)
        window.add("Messages", self.messages, BOTTOM)
        window.add("Terminal", self.terminal, BOTTOM, moves=True)
        self.actions.fill_menus(header.menus, window.submenus)
        self.actions.fill_toolbar(header.toolbar, MAIN)
        self.actions.fill_toolbar(window.run_bar.toolbar, RUN)
        self.actions.open_below(window.run_bar.toolbar, "execute", window.submenus["slow"])
        self.desk.tick_theme(self.actions)

    def _join(self) -> None:
        for panel in self.panels:
            self.tick.add(panel)
        for look in (
            self.leaving.look,
            self.theme.look,
            self.desk.look,
            self.ear.look,
            self.follow.look,
            self.setup.look,
            self.met.look,
            self.late.look,
            lambda: self.editor.look(self.follow.known),
            self.which.look,
            self.in_turn.look,
            self.search.look,
            self.start.echo.look,
            self.rubbish.look,
        ):
            self.tick.each(look)
        self._join_window()
        self._join_talk()
        self.connection.changed.connect(self._attach)
        self.session.document_changed.connect(self._document_changed)
        self.session.replaced.connect(self._another_document)
        self.start.setup_wanted.connect(self.setup.show)
        self.start.exit_wanted.connect(self._exit)
        self.start.doctor_wanted.connect(self.doctor.show)
        self.doctor.connect_wanted.connect(self.start.connect_at)
        self.doctor.help_wanted.connect(self.desk.show_help)
        self.run.uploaded.connect(self.desk.show_upload)
        self.run.show_problem.connect(self.program.reveal_step)
        self.run.downloaded.connect(self._downloaded)
        for said in (
            self.files.said,
            self.setup.said,
            self.limits.said,
            self.importing.said,
            self.run.said,
            self.start.said,
            self.talk.said,
            self.leaving.said,
            self.session.autosave_failed,
        ):
            said.connect(self.desk.say)
        for complaint in self.settings.complaints:
            self.desk.say(complaint)

    @property
    def panels(self) -> tuple[Panel, ...]:
        """All that hear of controllers and documents, as far as they are made."""
        return self._first + self.late.panels

    @property
    def at_machine(self) -> AtMachine:
        """The panels at the machine, made at once where they are not there yet."""
        return self.late.at_machine

    @property
    def proof(self) -> BackupPart:
        """Compare, back-ups, handover."""
        return self.late.proof

    @property
    def commissioning(self) -> Commissioning:
        """Bringing an axis to life."""
        return self.late.commissioning

    def _join_window(self) -> None:
        window = self.window
        window.resize(window.screen().availableSize().boundedTo(QSize(1400, 860)))
        window.first_shown.connect(self.desk.restore)
        window.stop.connect(self.connection.stop)
        window.came.connect(self.tick.look)
        window.closing.connect(self.leaving.asked)
        window.status.progress.cancelled.connect(self.run.cancel)
        window.submenus["recent"].aboutToShow.connect(lambda: self.desk.fill_recent(self.files))
        examples = window.submenus["examples"]
        examples.aboutToShow.connect(partial(self.files.fill_examples, examples))
        self.desk.export_wanted.connect(self.files.export_code)
        self.importing.placed.connect(self.program.tree.choose)
        self.program.said.connect(window.status.say)
        self.program.help_requested.connect(self.desk.show_help)
        self.program.problems.count_changed.connect(partial(self.desk.retitle, "Problems"))

    def _join_talk(self) -> None:
        talk = self.talk
        self.window.prompt.answered.connect(talk.answer)
        self.window.prompt.not_waiting.connect(talk.not_waiting)
        self.window.header.switch.wanted.connect(talk.control)
        self.display.io_control_wanted.connect(talk.io_control)
        self.display.output_wanted.connect(talk.output)
        self.display.read_wanted.connect(talk.not_waiting)
        self.display.connect_wanted.connect(self.start.look)
        self.display.simulator_wanted.connect(self.start.use_simulator)
        self.display.help_wanted.connect(self.desk.show_help)
        self.display.setup_wanted.connect(self.session.set_setup)
        self.display.said.connect(self.desk.say)
        self.terminal.command.connect(talk.typed)
        self.simulator.stimulus.connect(talk.stimulus)

    def _attach(self, controller: Controller) -> None:
        """Everything works with this controller from now on."""
        controller.show_listing(self.session.listing.text)
        self.tick.attach(controller)
        self.follow.look()
        settle()

    def _document_changed(self, old: Document | None, new: Document) -> None:
        for panel in self.panels:
            panel.show_document(old, new)
        self.connection.controller.show_listing(self.session.listing.text)

    def _downloaded(self, listing: Listing) -> None:
        self.program.clear_error()
        self.program.running = listing

    def _another_document(self) -> None:
        """What runs belongs to the document before; its lines say nothing about this one."""
        self.program.clear_error()
        self.program.running = None

    def _theme(self, name: str) -> None:
        self.desk.choose_theme(name, self.actions)

    def _wiring(self) -> None:
        family = self.session.document.setup.limits.family
        self.desk.show_help("Connectors: SSC" if family == "ssc" else "Connectors: DMC-1412 and DMC-1414")

    def _about(self) -> None:
        from app.about import about_words

        self.desk.ask("About Twoletter Studio", about_words(), (), "info")

    def _new(self) -> None:
        """An empty program for the machine whose setup was finished last."""
        self.files.careful("Start a new program?", lambda: self.session.new(self.setup.default))

    def _program(self) -> None:
        """The program, also where a layout has put it away."""
        if not self.window.centralWidget().isVisible():
            self.desk.arrange("Program")
        self.program.setFocus()

    def _toggle_control(self) -> None:
        self.talk.control(not self.connection.controller.control)

    def _exit(self) -> None:
        self.window.close()
