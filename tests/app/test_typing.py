"""What is typed into the terminal: in Watch whatever only reads, in Control everything, or the reason why not."""

from __future__ import annotations

import pytest

from tests.rig import Rig
from tests.stage import Stage

PROGRAM = "#A\nSB 2\nEN"
# "listed side-effect-free reads" (safety.md, 2): tell commands, lists, queries, operands
READS = (
    "TP", "TPX", "TP X", "TE", "TV", "TT", "TD", "TS", "TSX", "TB", "TI", "RP", "SC", "LS", "LL", "LV", "LA", "UL",
    "MG _TPX", "MG _TC", "MG TIME,_BN", 'MG "X IS",_TPX{F8.2}', "KP ?", "SP ?", "FL ?,?", "KP ?;KD ?", "V1=",
)  # fmt: skip
# framed reads of the studio's own, and the program, which is read before XQ: it decides what may be sent while it runs
READS_OF_OURS = r"(?!UL$|MG\{\^30\})"
ACTS = (
    "ST", "AB", "HX", "XQ", "PR 100", "BG", "BGX", "SB 1", "CB 1", "OP 0", "DP 0", "KP 10", "KP ?;KP 1", "TP;BG X",
    "MO", "SH", "V1=5", "TC", "BN", "BP", "BV", "RS", "DL", "ED", "QD V[]", "TR 1", "CW 2", "MG{P2} 1", "JG 100", "HM",
    "TM 500", "DM A[5]", "IN \"A\",B", "EO 0", "PF 4.2", "KPX=5", "%2", "!ST", "DA *", "CI 0",
)  # fmt: skip


def watching(stage: Stage) -> Rig:
    rig = stage.connect("machine", program=PROGRAM)
    assert not rig.controller.control
    stage.studio.desk.bring("Terminal")
    stage.go()
    return rig


def last(stage: Stage) -> str:
    return stage.studio.terminal.log.toPlainText().splitlines()[-1]


def test_in_watch_whatever_only_reads_is_answered(stage: Stage) -> None:
    rig = watching(stage)
    assert stage.studio.terminal.line.isEnabled()
    assert "Ctrl+T" in stage.studio.terminal.why.text()
    for command in READS:
        stage.type(command)
        assert "Not sent" not in last(stage), command
        assert rig.sent(r".*" + command[:2]), command
    assert rig.program == PROGRAM.split("\n")


@pytest.mark.parametrize("part", range(4))
def test_in_watch_whatever_acts_is_refused_with_the_way_to_control(stage: Stage, part: int) -> None:
    rig = watching(stage)
    before = rig.simulation.state()
    commands = ACTS[part::4]
    assert commands
    for command in commands:  # nothing of a refused one is left for the next
        stage.type(command)
        assert "Watch" in last(stage) or "reads" in last(stage), f"{command}: {last(stage)}"
        assert "Control" in last(stage), command
        assert rig.sent(READS_OF_OURS) == [], command
        after = rig.simulation.state()
        seen = (after["outputs"], rig.program, rig.running, rig.moving)
        assert seen == (before["outputs"], PROGRAM.split("\n"), [], []), command


def test_in_control_the_same_line_leaves(stage: Stage) -> None:
    rig = watching(stage)
    stage.type("SB 1")
    assert "Not sent" in last(stage)
    stage.studio.actions["take_control"].trigger()
    stage.go()
    assert not stage.studio.terminal.why.isVisible()
    stage.type("SB 1")
    assert rig.simulation.state()["outputs"] & 1
