"""The main job, whole: from dialogs to a moving machine over a serial line at 19 200 baud, by mouse and by keyboard.

The machine is the simulator that the studio itself starts: a process of its own behind a pseudo-terminal.
The program is the wire cutter of `dmc-1412-1414.txt` l.4018-4035; its machine has 637 counts an inch.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QFileDialog, QLineEdit

from app.compose import Studio
from app.connection import World, connector
from app.help_pages import Pages
from app.settings import Settings
from app.studio import begin
from codegen.models import MODELS
from device.api import Badge, Kind, State
from tests.app.hands import PATIENCE_S, Hands, Keys, Mouse, shown, until
from widgets.setup.window import SetupWindow

CODE = [
    "#CUTTER",
    "AC 254976",  # 637 × 400 = 254 800, the nearest multiple of 1024
    "DC 254976",
    "#A",
    "AI 1",
    "PR 6370",  # 10 in
    "SP 3184",  # 5 in/s are 3185 counts/s; speeds are even
    "BG X",
    "AM X",
    "SB 1",
    "WT 20",
    "CB 1",
    "WT 80",
    "JP #A",
    "EN",
]
WAITING = CODE.index("AI 1")
BAUD = 19_200
CHARACTER_S = 10 / BAUD  # a start bit, eight data bits, a stop bit (ssc-tol-o-motion.txt l.823)
TURNS = 5
TICK_S = 1 / 1_024_000  # the simulator counts time in these

pytestmark = pytest.mark.paced


@pytest.fixture
def studios(tmp_path: Path, qapp: QApplication) -> Iterator[list[Studio]]:
    """Studios that a test starts; closed at its end."""
    started: list[Studio] = []
    yield started
    for studio in started:
        studio.close()
        studio.session.close()
        studio.window.hide()
        studio.window.deleteLater()
    QApplication.processEvents()


def start(folder: Path, studios: list[Studio], application: QApplication) -> Studio:
    """A studio as on a fresh machine, or as it was left."""
    settings = Settings(folder / "settings.json")
    studio = Studio(application, settings, folder, connector(folder / "programs", lambda: 600.0), list, Pages())
    studios.append(studio)
    studio.window.show()
    studio.tick.start()
    QTest.qWaitForWindowActive(studio.window, 3000)
    begin(studio, None, "offline")
    return studio


def leave(studio: Studio, studios: list[Studio]) -> None:
    studio.close()
    studio.session.close()
    studio.window.hide()
    studios.remove(studio)
    QApplication.processEvents()


def set_up_machine(hands: Hands) -> None:
    hands.act("setup")
    window = shown(SetupWindow)
    assert isinstance(window, SetupWindow)
    hands.choose(window.controller.model, MODELS["ssc1"].title)
    hands.turn_to(window.list, window.axes.title)
    hands.fill(window.axes.rows["X"].scale, "637")
    hands.press(window.done_button)
    axis = hands.studio.session.document.setup.axis("X")
    assert (hands.studio.session.document.setup.model, axis.symbol, axis.scale) == ("ssc1", "in", 637)


def build_wire_cutter(hands: Hands) -> None:
    hands.fill(hands.studio.program.header.name, "Cutter")
    hands.add("Accel and Decel", acceleration_X="400", deceleration_X="400")
    hands.add("Label", name="A")
    hands.add("Wait For Condition", kind="Input", input="1")
    hands.add("Single Axis Move", distance="10", speed="5")
    hands.add("Output", output="1", level="On")
    hands.add("Wait", time="20")
    hands.add("Output", output="1", level="Off")
    hands.add("Wait", time="80")
    hands.add("Jump", target="A")


def connect_simulator(hands: Hands) -> None:
    studio = hands.studio
    hands.act("simulator")
    until(lambda: studio.connection.controller.state is State.READY, "the simulator to answer")
    controller = studio.connection.controller
    assert controller.kind is Kind.SIMULATOR and controller.control
    assert "SIMULATOR" in studio.window.windowTitle()
    assert controller.model is MODELS["ssc1"]
    over_a_serial_line(studio)


def over_a_serial_line(studio: Studio) -> None:
    """What is connected is a serial device of this computer (a socket on Windows), set to 19 200 baud."""
    transport = studio.connection.controller.link.transport
    assert transport is not None
    if os.name == "posix":
        device, _, speed = transport.description.partition(" at ")
        assert Path(device).is_char_device()
        assert speed == f"{BAUD} baud"
    until(lambda: "19 200 baud" in studio.window.status.link.text(), "the status bar to tell the speed")


def was_paced(studio: Studio) -> None:
    """Of the characters that the controller has received, none came sooner than its predecessor was through."""
    world = studio.connection.world
    assert world is not None
    moments = [moment for moment, _ in world.state()["received"]]
    assert len(moments) >= 50
    gaps = [later - sooner for sooner, later in pairwise(moments)]
    assert min(gaps) >= CHARACTER_S - TICK_S
    assert sorted(gaps)[len(gaps) // 20] <= CHARACTER_S + TICK_S  # those of one line follow each other


def flip_input(hands: Hands, high: bool) -> None:
    hands.act("simulator_panel")
    panel = hands.studio.simulator
    until(lambda: 1 in panel.inputs and panel.inputs[1].isVisible(), "the simulator panel")
    box = panel.inputs[1]
    if box.isChecked() != high:
        hands.press(box)
    assert box.isChecked() == high


def number(studio: Studio, key: str) -> float:
    return studio.connection.controller.last().value(key)


def waits_at(studio: Studio, line: int) -> bool:
    """Whether thread 0 stands on a line and the row of that line is the one marked in the tree."""
    step = studio.session.listing.step_of(line)
    return number(studio, "thread0") == line and 0 in studio.program.delegate.executing.get(step, ())


def run_it(hands: Hands) -> None:
    studio = hands.studio
    flip_input(hands, high=False)
    hands.act("download")
    until(lambda: studio.connection.controller.program_badge is Badge.SAME, "the download to be verified")
    was_paced(studio)
    hands.act("execute")
    until(lambda: waits_at(studio, WAITING), "the program to wait for input 1")
    assert number(studio, "position.x") == 0
    seen = set[str]()
    turns = 0
    while seen != {"moving", "output on"}:  # a busy computer may look away for the 20 ms of one turn
        turns += 1
        assert turns <= TURNS, f"in {TURNS} turns only {seen} was seen"
        seen |= one_turn(hands, turns)
    until(lambda: f"{10 * turns}.000 in" in studio.display.words(), "the display to show where the axis stands")


def one_turn(hands: Hands, turn: int) -> set[str]:
    """Input 1 goes high, the axis moves on by 10 in, output 1 fires, the program waits again; what was seen of it."""
    studio, world = hands.studio, hands.studio.connection.world
    assert world is not None
    start, end = 6370 * (turn - 1), 6370 * turn
    seen = set[str]()

    def watch() -> bool:
        if start < number(studio, "position.x") < end:
            seen.add("moving")
        return bool(world.state()["axes"]["X"]["commanded"] > end - 800)

    flip_input(hands, high=True)
    until(lambda: world.state()["axes"]["X"]["commanded"] > start, "the axis to start")
    flip_input(hands, high=False)
    hands.act("display")
    until(watch, "the axis to come near its end")
    if output_fired(world, end):
        seen.add("output on")
    until(lambda: number(studio, "commanded.x") == end, "the end of the move")
    until(lambda: waits_at(studio, WAITING), "the next turn of the program")
    until(lambda: abs(number(studio, "position.x") - end) <= 1, "the frictionless axis to settle")
    return seen


def output_fired(world: World, end: int) -> bool:
    """Output 1 is on for 20 ms after the move: looked for at the machine itself, as fast as it answers."""
    patience = time.monotonic() + PATIENCE_S
    fired = False
    while not fired and world.state()["threads"][0]["waiting_for"] != "AI":
        assert time.monotonic() < patience, "the program does not come round"
        state = world.state()
        fired = state["outputs"] == 1
        assert not fired or state["axes"]["X"]["commanded"] == end
    until(lambda: world.state()["outputs"] == 0, "output 1 to go off")
    return fired


def halt(hands: Hands) -> None:
    hands.act("halt")
    until(lambda: number(hands.studio, "thread0") == -1, "the program to be halted")


def file_dialog() -> tuple[QFileDialog, QLineEdit]:
    dialog = shown(QFileDialog)
    assert isinstance(dialog, QFileDialog)
    line = dialog.findChild(QLineEdit, "fileNameEdit")
    assert isinstance(line, QLineEdit)
    return dialog, line


def name_file(hands: Hands, path: Path) -> None:
    dialog, line = file_dialog()
    hands.fill(line, str(path))
    QTest.keyClick(line, "\r")
    until(lambda: not _open(dialog), "the file window to close")


def _open(dialog: QFileDialog) -> bool:
    try:
        return dialog.isVisible()
    except RuntimeError:  # it deletes itself
        return False


@pytest.mark.parametrize("way", [Mouse, Keys], ids=["mouse", "keyboard"])
def test_from_dialogs_to_a_moving_machine(
    way: type[Hands], tmp_path: Path, studios: list[Studio], qapp: QApplication
) -> None:
    studio = start(tmp_path, studios, qapp)
    hands = way(studio)
    hands.act("new")
    set_up_machine(hands)
    build_wire_cutter(hands)
    assert studio.session.listing.text.split("\n")[: len(CODE)] == CODE
    connect_simulator(hands)
    run_it(hands)
    halt(hands)
    path = tmp_path / "cutter.tlp"
    hands.act("save")
    name_file(hands, path)
    until(lambda: path.is_file() and not studio.session.dirty, "the file to be saved")
    document = studio.session.document
    leave(studio, studios)
    again = start(tmp_path, studios, qapp)
    hands = way(again)
    hands.act("open")
    name_file(hands, path)
    until(lambda: again.session.path == path, "the program to be opened again")
    assert again.session.document == document
    assert again.session.listing.text.split("\n")[: len(CODE)] == CODE
