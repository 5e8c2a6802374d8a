"""Windows and panels: what is in front, in which colours and arrangement, and what is asked before leaving."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtWidgets import QApplication, QDialog, QVBoxLayout

import resources
from app.actions import Actions
from app.files import Files
from app.recovery import Recovered
from app.run import Answers
from app.session import Session
from app.settings import Settings
from app.theme import Choice, Theme
from app.window import Window
from widgets.display.messages import MessagesPanel
from widgets.help.topic import topic_of
from widgets.parts.pictures import fit_pictures
from widgets.parts.question import Question

if TYPE_CHECKING:
    from widgets.help.panel import HelpPanel
    from widgets.panel import Panel
    from widgets.terminal.code_window import CodeWindow
    from widgets.unsaved.window import UnsavedWork


@dataclass(frozen=True)
class Layout:
    """A ready arrangement: the panels that are there, and those of them in front. All others open from the menu."""

    panels: tuple[str, ...]
    front: tuple[str, ...]
    program: bool = True  # whether the program stands in the middle; else the panels have all the room


LAYOUTS: Mapping[str, Layout] = {
    "Program": Layout(
        ("Instructions", "Display", "Simulator", "Inspector", "Problems", "Messages", "Terminal"),
        ("Instructions", "Display", "Problems"),
    ),
    "Run": Layout(
        ("Instructions", "Display", "X-Y view", "Simulator", "Messages", "Terminal", "Problems"),
        ("Instructions", "Display", "Messages"),
    ),
    "Tune": Layout(
        ("Display", "Tuner", "Simulator"),
        ("Tuner",),
        program=False,
    ),
}


class Desk(QObject):
    """Acts on the window; decides nothing about machines or programs."""

    export_wanted = Signal(str)

    def __init__(
        self,
        window: Window,
        session: Session,
        settings: Settings,
        theme: Theme,
        messages: MessagesPanel,
        pages: Mapping[str, str],
    ) -> None:
        super().__init__(window)
        self._window, self._session, self._settings = window, session, settings
        self._theme, self._messages, self._pages = theme, messages, pages
        self.question: Question | None = None
        self.help: QDialog | None = None
        self.upload: CodeWindow | None = None
        self.unsaved: UnsavedWork | None = None
        self._left: tuple[Recovered, ...] = ()
        self._help_panel: HelpPanel | None = None
        self._page = ""  # of the help, to be opened

    def ask(self, title: str, words: str, answers: Answers, picture: str = "help") -> None:
        """A question that blocks nothing."""
        self.put(title, words, answers, picture)

    def put(self, title: str, words: str, answers: Answers, picture: str = "help") -> Question:
        """The same for those who want to know when it is closed."""
        self.question = question = Question(title, words, list(answers), self._window, picture)
        question.show()
        return question

    def say(self, sentence: str) -> None:
        """A sentence in the status bar and in the messages."""
        self._window.status.say(sentence)
        self._messages.say(sentence)

    def bring(self, title: str) -> None:
        """A panel in front."""
        self._window.docks[title].bring()

    def arrange(self, layout: str) -> None:
        """A ready layout."""
        self._settings.set("layout", layout)
        self._window.arrange(LAYOUTS[layout].panels, LAYOUTS[layout].front, LAYOUTS[layout].program)

    def restore(self) -> None:
        """The arrangement of last time, or the layout chosen last."""
        if not self._window.restore(self._settings.get("window")):
            layout = LAYOUTS.get(self._settings.get("layout"), LAYOUTS["Program"])
            self._window.arrange(layout.panels, layout.front, layout.program)

    def add(self, title: str, panel: Panel, area: Qt.DockWidgetArea) -> None:
        """A panel that is made after the window: where it was last time, else as the layout has it."""
        layout = LAYOUTS.get(self._settings.get("layout"), LAYOUTS["Program"])
        self._window.add_late(title, panel, area, shown=title in layout.panels)

    def choose_theme(self, name: str, actions: Actions) -> None:
        """Light, dark or system, remembered."""
        self._settings.set("theme", name)
        self._theme.choose(Choice(name))
        self.tick_theme(actions)

    def tick_theme(self, actions: Actions) -> None:
        """The menu's tick stands at what was chosen."""
        for name in ("system", "light", "dark"):
            actions[f"theme_{name}"].setChecked(self._theme.choice == name)

    def retitle(self, title: str, count: int) -> None:
        """A number behind the title of a panel."""
        self._window.docks[title].setWindowTitle(f"{title} {count}" if count else title)

    def show_help(self, page: str) -> None:
        """A help page in a window of its own; the first one comes with the tick after that window."""
        self._page = page
        if self.help is None:
            self.help = self._help_window()
            self.help.show()
        else:
            self.look()

    def look(self) -> None:
        """With each tick: the page that was asked for together with the window."""
        if not self._page or self.help is None or self._help_panel is None:
            return
        page, self._page = self._page, ""
        self.help.show()
        if not self._help_panel.open(page):
            self._help_panel.open("Program window")
        self.help.raise_()

    def _help_window(self) -> QDialog:
        from app.help_pages import search_words
        from widgets.help.panel import HelpPanel

        window = QDialog(self._window)
        window.setWindowTitle("Help")
        window.resize(880, 640)
        self._help_panel = HelpPanel(self._pages, search_words())
        self._help_panel.browser.setSearchPaths([str(resources.path("help"))])
        self._help_panel.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._help_panel.opened.connect(lambda _: self._fit_pictures())
        column = QVBoxLayout(window)
        column.addWidget(self._help_panel)
        return window

    def _fit_pictures(self) -> None:
        if self._help_panel is not None:
            fit_pictures(self._help_panel.browser)

    def help_for_focus(self) -> None:
        """Help for whatever has the focus."""
        self.show_help(topic_of(QApplication.focusWidget()) or "Program window")

    def show_upload(self, text: str) -> None:
        """The program that was read from the controller."""
        from widgets.terminal.code_window import CodeWindow

        self.upload = CodeWindow("The program in the controller", text, self._session.listing.text, self._window)
        self.upload.save_wanted.connect(self.export_wanted)
        self.upload.show()

    def offer_recovery(self) -> bool:
        """Shows all work that crashed sessions left behind; False when there is none."""
        window = self.left_behind()
        if window is not None:
            window.show()
            window.raise_()
        return window is not None

    def left_behind(self) -> UnsavedWork | None:
        """The same, not shown yet."""
        from widgets.unsaved.window import UnsavedWork

        self._left = self._session.recoverable()
        if not self._left:
            return None
        if self.unsaved is None:
            self.unsaved = UnsavedWork(self._window)
            self.unsaved.recover_wanted.connect(self._recover)
            self.unsaved.forget_wanted.connect(self._ask_forget)
        self.unsaved.show_work([_line(left) for left in self._left])
        return self.unsaved

    def show_unsaved(self) -> None:
        """The same when a person asks for it."""
        if not self.offer_recovery():
            self.say("There is no unsaved work of an earlier session.")

    def _recover(self, row: int) -> None:
        """Opens it; what is open and unsaved is set aside, not lost."""
        if 0 <= row < len(self._left) and self.unsaved is not None:
            self.unsaved.accept()
            self._session.recover(self._left[row])
            others = len(self._session.recoverable())
            more = (
                f" {others} more unsaved document{'s' * (others != 1)} stay kept for the next start." if others else ""
            )
            self.say(f"Recovered: {self._left[row].name}; it is not saved yet.{more}")

    def _ask_forget(self, row: int) -> None:
        if 0 <= row < len(self._left):
            left = self._left[row]
            words = f"{_line(left)}\n\nWhat is thrown away cannot be brought back."
            self.ask("Throw unsaved work away?", words, [("Throw it away", partial(self._forget, left))], "warning")

    def _forget(self, left: Recovered) -> None:
        self._session.forget(left)
        self._left = self._session.recoverable()
        if self.unsaved is not None:
            self.unsaved.show_work([_line(each) for each in self._left])

    def fill_recent(self, files: Files) -> None:
        """The menu of programs opened last."""
        menu = self._window.submenus["recent"]
        menu.clear()
        for path in files.recent:
            action = menu.addAction(
                path.name, partial(files.careful, "Open another program?", partial(files.open_path, path))
            )
            action.setToolTip(str(path))
        if menu.isEmpty():
            menu.addAction("Nothing opened yet").setEnabled(False)

    def leave(self) -> None:
        """The end of the session: the arrangement is remembered, nothing is kept for after a crash."""
        self._settings.set("window", self._window.arrangement())
        self._session.close()


def _line(left: Recovered) -> str:
    """ "cutter.tlp – 2026-11-22 17:05 – 12 steps – in /programs"."""
    steps = sum(1 for _ in left.document.program.steps())
    parts = [left.name, f"{left.when:%Y-%m-%d %H:%M}", f"{steps} step{'s' * (steps != 1)}"]
    if left.original:
        parts.append(f"in {Path(left.original).parent}")
        if not left.is_newer_than_file():
            parts.append("the file was saved later")
    else:
        parts.append("never saved")
    return " – ".join(parts)
