"""Everything a person can do from menus, toolbar and keys, one row each; menus and toolbars are built from the rows."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from PySide6.QtCore import QObject, QPoint, Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QMenu, QMenuBar, QToolBar, QToolButton

from app import facts as need
from app.facts import Facts
from codegen.slowed import PERCENTS
from widgets.parts.icons import icon

Need = Callable[[Facts], str]


@dataclass(frozen=True)
class Row:
    """One action; it is grey, with the reason, while any of its needs has something to say."""

    name: str
    text: str
    menu: str
    help: str
    shortcut: str = ""
    icon: str = ""
    toolbar: str = ""  # "main" or "run", and the short text there
    short: str = ""
    needs: tuple[Need, ...] = ()
    checkable: bool = False
    submenu: str = ""  # the menu inside the menu that it stands in
    program: bool = False  # the action lives in the program window, which keeps its shortcut and state


def _program(name: str, menu: str) -> Row:
    return Row(name, name, menu, "", program=True)


def _slow(percent: int) -> Row:
    words = f"Sends the program with every speed at {percent} % and runs it: for the first time on a machine"
    needs = (*CHANGE, need.something)
    return Row(f"execute_{percent}", f"Execute at {percent} %…", "Controller", words, needs=needs, submenu="slow")


CHANGE = (need.control, need.quiet)
ROWS: tuple[Row, ...] = (
    Row("new", "New program", "File", "Starts an empty program", "Ctrl+N", "new"),
    Row("open", "Open…", "File", "Opens a program file", "Ctrl+O", "open", "main", "Open"),
    Row("recent", "Open recent", "File", "Programs opened last"),
    Row("open_recording", "Open recording or bundle…", "File",
        "Plays what was recorded, here or elsewhere; nothing is sent"),
    Row("examples", "Examples", "File", "Programs that come with the studio"),
    Row("save", "Save", "File", "Saves the program", "Ctrl+S", "save", "main", "Save"),
    Row("save_as", "Save as…", "File", "Saves the program under another name", "Ctrl+Shift+S"),
    Row("recover", "Recover unsaved work…", "File", "Work that an earlier session left behind without saving it"),
    Row("import_module", "Import module…", "File", "Adds another program, or two-letter code, to this one"),
    Row("export_code", "Export code…", "File", "Writes the two-letter code into a file", "", "export"),
    Row("options", "Settings…", "File", "Colours, what happens at start, the simulator's line", "Ctrl+,", "settings"),
    _program("-6", "File"),
    _program("print_program", "File"),
    _program("print_code", "File"),
    Row("print_pack", "Print handover pack…", "File",
        "Program, code, setup, names, limits, gains and a checklist: preview, PDF"),
    Row("handover", "Handover…", "File", "Author, revision and change notes; the revision goes into the controller",
        "Ctrl+Shift+H"),
    Row("exit", "Exit", "File", "Closes the studio", "Ctrl+Q", "exit", "main", "Exit"),
    _program("undo", "Edit"),
    _program("redo", "Edit"),
    _program("-1", "Edit"),
    _program("cut", "Edit"),
    _program("copy", "Edit"),
    _program("paste", "Edit"),
    _program("duplicate", "Edit"),
    _program("delete", "Edit"),
    _program("-2", "Edit"),
    _program("modify", "Edit"),
    _program("insert", "Edit"),
    _program("comment", "Edit"),
    _program("comment_out", "Edit"),
    _program("end_of_repeat", "Edit"),
    _program("view_code", "Edit"),
    _program("move_up", "Edit"),
    _program("move_down", "Edit"),
    _program("-4", "Edit"),
    _program("find_text", "Edit"),
    _program("replace_text", "Edit"),
    _program("find_next", "Edit"),
    _program("find_previous", "Edit"),
    _program("find", "Edit"),
    _program("trace", "View"),
    _program("program_status", "View"),
    _program("-5", "View"),
    _program("mode_program", "View"),
    _program("mode_both", "View"),
    _program("mode_code", "View"),
    _program("fold_all", "View"),
    _program("unfold_all", "View"),
    _program("-3", "View"),
    Row("layout_program", "Layout: Program", "View", "Instructions and program in front", "", "layout"),
    Row("layout_run", "Layout: Run", "View", "Display and messages in front", "", "display"),
    Row("layout_tune", "Layout: Tune", "View", "Tuner and display in front", "", "tune"),
    Row("panels", "Panels", "View", "Shows and hides panels"),
    Row("floats", "Panel in a window of its own", "View", "Takes a panel out of the window, or puts it back"),
    Row("theme_system", "Colours as the system", "View", "Light or dark as the system has it", "", "lamp",
        checkable=True),
    Row("theme_light", "Light colours", "View", "Dark on light", "", "light", checkable=True),
    Row("theme_dark", "Dark colours", "View", "Light on dark", "", "dark", checkable=True),
    Row("setup", "Setup…", "Machine", "Controller model, axes, units and names", "", "setup", "main", "Setup"),
    Row("program", "Program", "Machine", "The program window", "Alt+1", "program", "main", "Program"),
    Row("terminal", "Terminal", "Machine", "Type commands, see replies", "Alt+2", "terminal", "main", "Terminal"),
    Row("editor", "Code editor…", "Machine", "Two-letter code written by hand, sent and read", "Ctrl+Shift+E", "code"),
    Row("display", "Display", "Machine", "Positions, inputs, outputs and switches", "Alt+3", "display", "main",
        "Display"),
    Row("jog", "Jog", "Machine", "Move axes by hand", "Alt+6", "jog", "main", "Jog"),
    Row("commissioning", "Bring an axis to life…", "Machine",
        "A new axis, step by step: enable, encoder, switches, limits, polarity, scale, report", "", "machine"),
    Row("tune", "Tune", "Machine", "Gains of an axis: by hand, automatic, model-based; logbook", "Alt+0", "tune",
        "main", "Tune"),
    Row("scope", "Scope", "Machine", "Curves of positions, errors, torque, inputs: captured or live", "Alt+9", "scope",
        "main", "Scope"),
    Row("teach", "Teach", "Machine", "Drive two axes by a stick, record places, play them back", "Ctrl+J", "teach",
        "main", "Teach"),
    Row("plane", "X-Y view", "Machine", "The way of two axes from above", "Alt+4", "measure"),
    Row("operator", "Operator terminal", "Machine", "The terminal at port 2 of the controller", "Alt+5", "operator"),
    Row("variables", "Variables", "Machine", "Variables and arrays of the controller", "Alt+7", "program"),
    Row("events", "Events", "Machine", "What happened: faults, limits, stops, downloads; service bundle", "Alt+8",
        "messages"),
    Row("recorder", "Recorder", "Machine", "Everything that went over the line and was done; replay it", "", "record"),
    Row("simulator_panel", "Simulator switches", "Machine", "Flip the simulated machine's switches", "", "simulator"),
    Row("connect", "Connect…", "Controller", "Looks for a controller and offers what else can be done", "Ctrl+K",
        "connect"),
    Row("serial", "Serial communication setup…", "Controller", "Port, baud rate, flow control", "", "settings"),
    Row("doctor", "Examine the connection…", "Controller", "Looks at port, cable, speed, handshake; says what is wrong",
        "", "search"),
    Row("simulator", "Use the simulator", "Controller", "Starts the bundled simulator", "", "simulator"),
    Row("disconnect", "Disconnect", "Controller", "Closes the connection; a running program goes on", "", "disconnect",
        needs=(need.is_online,)),
    Row("take_control", "Control", "Controller", "Allows commands that move, set, download or burn", "Ctrl+T",
        "control",
        needs=(need.live,), checkable=True),
    Row("download", "Download", "Controller", "Sends the program to the controller and reads it back", "F7",
        "download", "run",
        needs=(*CHANGE, need.something)),
    Row("execute", "Execute", "Controller", "Runs the program that is in the controller", "F5", "execute", "run",
        needs=CHANGE),
    Row("slow", "Execute slowed", "Controller", "The program at a part of its speed, for a first run"),
    *map(_slow, PERCENTS),
    Row("halt", "Halt", "Controller", "Halts programs and decelerates all motion", "Shift+F5", "halt", "run",
        needs=(need.control,)),
    Row("burn", "Burn…", "Controller", "Writes the program into permanent memory", "", "burn", "run", needs=CHANGE),
    Row("upload", "Upload…", "Controller", "Reads the program that is in the controller", "", "upload", "run",
        needs=(need.live, need.quiet)),
    Row("compare", "Compare…", "Controller", "File, controller and EEPROM side by side, in plain English", "F6",
        "diff"),
    Row("backups", "Back-ups…", "Controller", "Back up, look inside, compare, restore, replace a controller", "Ctrl+B",
        "save"),
    Row("stop", "STOP", "Controller", "Stops all motion and all programs", "", "stop"),  # F12: app.stop_key
    Row("help", "Help on programming", "Help", "Help for what is in front", "F1", "help", "main", "Help"),
    Row("help_programming", "Programming", "Help", "How a program is put together", "", "program"),
    Row("help_examples", "Examples", "Help", "The programs that come with the studio, and their paths", "", "file"),
    Row("help_wiring", "Connectors and wiring", "Help", "The pins of the controller in the setup", "", "connect"),
    Row("help_trouble", "Troubleshooting", "Help", "What can be wrong, and what to do", "", "warning"),
    Row("about", "About Twoletter Studio", "Help", "Version and licence", "", "info"),
)  # fmt: skip

MENUS = ("File", "Edit", "View", "Machine", "Controller", "Help")
# what stands together in the toolbar, in the order of the manual's main panel
MAIN = (
    ("open", "save"),
    ("setup", "program", "terminal", "teach", "display", "jog", "scope", "tune"),
    ("help", "exit"),
)
RUN = (("download", "execute", "halt"), ("burn", "upload"))
BREAKS = {
    "exit",
    "layout_program",
    "theme_system",
    "program",
    "simulator_panel",
    "take_control",
    "download",
    "stop",
    "about",
}


class Actions(QObject):
    """The QActions of all rows; `show_facts` enables and disables them."""

    def __init__(
        self, handlers: Mapping[str, Callable[[], None]], program: Mapping[str, QAction], parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self.rows = {row.name: row for row in ROWS if not row.program}
        self._program = program
        self._facts: Facts | None = None
        self._reasons: dict[str, str] = {}  # of each action, as it was told last
        self.actions = {
            name: self._make(row, handlers[name]) for name, row in self.rows.items() if name not in SUBMENUS
        }

    def __getitem__(self, name: str) -> QAction:
        return self.actions[name]

    def reason(self, name: str, facts: Facts) -> str:
        """Why an action is not possible, the first reason that holds."""
        return next((words for each in self.rows[name].needs if (words := each(facts))), "")

    def show_facts(self, facts: Facts) -> None:
        """Enables what is possible; what is not says why in its tooltip and status tip."""
        if facts == self._facts:
            return
        self._facts = facts
        for name, action in self.actions.items():
            reason = self.reason(name, facts)
            if reason == self._reasons.get(name):
                continue
            self._reasons[name], row = reason, self.rows[name]
            action.setEnabled(not reason)
            keys = QKeySequence(row.shortcut).toString(QKeySequence.SequenceFormat.NativeText)
            action.setToolTip(f"{row.help}{f' ({keys})' if keys else ''}" + (f"\n{reason}" if reason else ""))
            action.setStatusTip(reason or row.help)
        self.actions["take_control"].setChecked(facts.control)

    def fill_menus(self, bar: QMenuBar, submenus: Mapping[str, QMenu]) -> None:
        """File, Edit, View, Machine, Controller, Help."""
        menus = {name: bar.addMenu(f"&{name}") for name in MENUS}
        for menu in (*menus.values(), *submenus.values()):
            menu.setToolTipsVisible(True)
        for row in ROWS:
            menu = menus[row.menu]
            if row.program:
                self._add_program(menu, row.name)
                continue
            if row.name in BREAKS:
                menu.addSeparator()
            if row.submenu:
                submenus[row.submenu].addAction(self.actions[row.name])
            elif row.name in SUBMENUS:
                menu.addMenu(submenus[row.name])
            else:
                menu.addAction(self.actions[row.name])

    def fill_toolbar(self, bar: QToolBar, groups: tuple[tuple[str, ...], ...]) -> None:
        """The buttons of the toolbar, reachable by Tab."""
        for index, names in enumerate(groups):
            if index:
                bar.addSeparator()
            for name in names:
                bar.addAction(self.actions[name])
                button = bar.widgetForAction(self.actions[name])
                if isinstance(button, QToolButton):
                    button.setFocusPolicy(button.focusPolicy().TabFocus)
                    button.setAccessibleName(self.rows[name].text.rstrip("…"))

    def open_below(self, bar: QToolBar, name: str, menu: QMenu) -> None:
        """An arrow behind a button of the toolbar opens a menu; it waits for nothing, as a button's own menu would."""
        arrow = QToolButton()
        arrow.setArrowType(Qt.ArrowType.DownArrow)
        arrow.setObjectName("arrow")
        arrow.setAccessibleName(menu.title())
        arrow.setToolTip(menu.title())
        arrow.setFocusPolicy(arrow.focusPolicy().TabFocus)
        arrow.clicked.connect(lambda: menu.popup(arrow.mapToGlobal(QPoint(0, arrow.height()))))
        shown = bar.actions()
        place = shown.index(self.actions[name]) + 1
        bar.insertWidget(shown[place] if place < len(shown) else None, arrow)  # type: ignore[arg-type]

    def _add_program(self, menu: QMenu, name: str) -> None:
        if name.startswith("-"):
            menu.addSeparator()
        elif name in self._program:
            menu.addAction(self._program[name])

    def _make(self, row: Row, handler: Callable[[], None]) -> QAction:
        action = QAction(row.text, self)
        action.setObjectName(row.name)
        if row.icon:
            action.setIcon(icon(row.icon, "stop" if row.name == "stop" else "text"))
        if row.shortcut:
            action.setShortcut(QKeySequence(row.shortcut))
        if row.short:
            action.setIconText(row.short)
        elif row.toolbar:
            action.setIconText(row.text.rstrip("…"))
        if row.name == "help":
            action.setShortcutContext(Qt.ShortcutContext.ApplicationShortcut)
        action.setCheckable(row.checkable)
        action.triggered.connect(lambda _=False: handler())
        return action


SUBMENUS = frozenset({"recent", "panels", "floats", "slow", "examples"})
