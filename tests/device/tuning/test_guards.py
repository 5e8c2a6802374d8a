"""Guards of an excitation over the simulator's byte stream (safety.md 4): narrowed only, kept on disk, put back."""

from __future__ import annotations

import json
from collections.abc import Callable
from concurrent.futures import Future
from datetime import datetime
from pathlib import Path
from typing import Any

import pytest

from codegen.setup import Setup
from codegen.twoletter.fixed import ONE
from device.api import StopState
from device.backing_up import LINE_S
from device.former import Former, keep, left_behind, meant, now_there, put_back
from device.proof import proved
from device.setup_transfer import burn_setup, send_setup
from device.tasks import LinkError, NotAllowed, Priority, Steps, Stopped, Wait
from device.tuning import guards
from device.tuning.guards import Fault, Guard, guarded
from tests.rig import Rig

WHEN = datetime(2026, 11, 22, 12, 0)
FORMER = {
    "KP": 6.125, "KI": 0.5, "KD": 80.0, "FV": 3.0, "FA": 0.25, "TL": 7.0, "ER": 1200.0, "FL": 90000.0, "BL": -500.0,
    "OE": 0.0, "SP": 30000.0, "AC": 102400.0, "DC": 204800.0,
}  # fmt: skip
GUARD = Guard("X", forward=3000, reverse=200, error=900, torque=4.0)


def ready(kind: str = "simulator", model: str = "ssc2", **more: Any) -> Rig:
    rig = Rig(kind, model, **more).ready()
    rig.controller.take_control()
    rig.type(*(f"{name}X={value:g}" for name, value in FORMER.items()), "SH X")
    rig.simulation.transmit(1)
    return rig


def held(rig: Rig) -> dict[str, float]:
    """Told by the simulation itself."""
    registers = rig.simulation.unit.state.registers
    return {name: registers[name][0] / ONE for name in FORMER}


def begin(rig: Rig, folder: Path, body: Callable[[Former], Steps[Any]], guard: Guard = GUARD) -> Future[Any]:
    return rig.controller.run(guarded(rig.controller, guard, folder, body, WHEN), Priority.USER, "user")


def asked(rig: Rig, text: str) -> Steps[None]:
    yield from proved(rig.controller.nonces, text, LINE_S)


def assert_former(rig: Rig) -> None:
    found = held(rig)
    for name, value in FORMER.items():
        assert found[name] == pytest.approx(value, abs=1e-3), name


def test_guards_narrow_keep_on_disk_and_put_back(tmp_path: Path) -> None:
    rig = ready()
    inside: list[dict[str, float]] = []

    def body(former: Former) -> Steps[str]:
        told = json.loads(former.file.read_text())  # on disk while the limits are narrow
        assert told["values"]["KP"] == int(6.125 * ONE) and told["axis"] == "X"
        inside.append(held(rig))
        yield from asked(rig, "KPX=20;PRX=1000")
        yield from asked(rig, "BG X")
        while (yield from guards.watch(rig.controller, "X")):
            yield Wait(0.02)
        return "done"

    assert rig.result(begin(rig, tmp_path, body)) == "done"
    assert inside[0]["OE"] == 1 and inside[0]["ER"] == 900 and inside[0]["TL"] == pytest.approx(4, abs=1e-3)
    assert inside[0]["FL"] == 3000 and inside[0]["BL"] == -200
    assert inside[0]["KP"] == 6.125  # the guards come before any gain
    assert_former(rig)
    assert rig.simulation.state()["axes"]["X"]["commanded"] == 0  # back where it began
    assert not list(tmp_path.iterdir())


def test_guards_never_open_a_limit(tmp_path: Path) -> None:
    rig = ready()
    seen: list[dict[str, float]] = []

    def body(former: Former) -> Steps[None]:
        seen.append(held(rig))
        yield Wait(0)

    wide = Guard("X", forward=3000, reverse=200, error=30000, torque=9.5)
    rig.result(begin(rig, tmp_path, body, wide))
    assert seen[0]["ER"] == 1200 and seen[0]["TL"] == pytest.approx(7, abs=1e-3)  # those of the machine were narrower
    for far in (Guard("X", 100, 501, 900, 4.0), Guard("X", 90001, 0, 900, 4.0)):
        with pytest.raises(NotAllowed, match="beyond its software limits"):
            rig.result(begin(rig, tmp_path, body, far))
    for step in (1200, -1500):
        with pytest.raises(NotAllowed, match="not smaller than the error limit ER of 1200 counts"):
            rig.result(begin(rig, tmp_path, body, Guard.around("X", step, 100, 4.0)))
    assert len(seen) == 1 and not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("commands", "says"),
    [
        (("MO X",), "motor of axis X is off"),
        (("PRX=30000", "BG X"), "an axis is moving"),
        (("GAY=X", "GRY=1"), "follows a master"),
    ],
)
def test_nothing_is_changed_where_it_may_not_begin(tmp_path: Path, commands: tuple[str, ...], says: str) -> None:
    rig = ready()
    for command in commands:
        rig.result(rig.controller.ask(command))
    with pytest.raises(NotAllowed, match=says):
        rig.result(begin(rig, tmp_path, lambda former: asked(rig, "KPX=500")))
    assert held(rig)["KP"] == 6.125 and held(rig)["OE"] == 0 and not list(tmp_path.iterdir())


@pytest.mark.parametrize("side", ["forward", "reverse"])
@pytest.mark.parametrize(("polarity", "tripped"), [(-1, 0), (1, 1)])
def test_an_axis_in_a_limit_switch_is_not_excited(tmp_path: Path, side: str, polarity: int, tripped: int) -> None:
    """CN -1: low inhibits motion (dmc-1412-1414.txt l.4111); CN turns the polarity of both."""
    rig = ready()
    rig.type("MO", f"CN {polarity}", "SH")
    for each in ("forward", "reverse"):
        rig.simulation.stimulus(f"{each[0]}ls_x", tripped if each == side else 1 - tripped)
    with pytest.raises(NotAllowed, match=f"stands in its {side} limit switch. Move it away first."):
        rig.result(begin(rig, tmp_path, lambda former: asked(rig, "KPX=500")))
    assert held(rig)["KP"] == 6.125 and held(rig)["OE"] == 0 and not list(tmp_path.iterdir())
    rig.simulation.stimulus(f"{side[0]}ls_x", 1 - tripped)
    rig.result(begin(rig, tmp_path, lambda former: asked(rig, "KPX=500")))


def test_not_in_watch_and_not_beside_a_program(tmp_path: Path) -> None:
    rig = ready("machine", program="#A;WT 100;JP #A")
    rig.type("XQ #A")
    with pytest.raises(NotAllowed, match="program is running"):
        rig.result(begin(rig, tmp_path, lambda former: asked(rig, "KPX=500")))
    rig.type("HX")
    rig.controller.release_control()
    with pytest.raises(NotAllowed, match="Watch"):
        rig.result(begin(rig, tmp_path, lambda former: asked(rig, "KPX=500")))
    assert held(rig)["KP"] == 6.125


def test_without_a_place_to_keep_them_nothing_is_changed(tmp_path: Path) -> None:
    rig = ready()
    blocked = tmp_path / "file"
    blocked.write_text("no folder")
    with pytest.raises(NotAllowed, match="cannot be kept"):
        rig.result(begin(rig, blocked, lambda former: asked(rig, "KPX=500")))
    assert held(rig)["OE"] == 0


def test_a_loop_that_runs_away_is_switched_off_and_set_back(tmp_path: Path) -> None:
    rig = ready()

    def body(former: Former) -> Steps[None]:
        yield from asked(rig, "KDX=0;KPX=900;PRX=2000")
        yield from asked(rig, "BG X")
        while True:
            yield from guards.watch(rig.controller, "X")
            yield Wait(0.02)

    with pytest.raises(Fault, match="went off"):
        rig.result(begin(rig, tmp_path, body))
    assert_former(rig)
    assert not rig.simulation.state()["axes"]["X"]["motor_on"]
    assert not list(tmp_path.iterdir())


def test_nobody_moves_it_by_hand_meanwhile(tmp_path: Path) -> None:
    rig = ready()

    def body(former: Former) -> Steps[str]:
        yield Wait(0.3)
        return "done"

    future = begin(rig, tmp_path, body)
    rig.until(lambda: held(rig)["OE"] == 1)
    with pytest.raises(NotAllowed, match="axis X is being tuned"):
        rig.result(rig.controller.motion.hold("X", 5000, 256000, 256000, "mouse"))
    assert rig.result(future) == "done"
    held_now = rig.controller.motion.hold("X", 5000, 256000, 256000, "mouse")
    rig.until(lambda: rig.moving)
    with pytest.raises(NotAllowed, match="moved by hand"):
        rig.result(begin(rig, tmp_path, body))
    rig.controller.motion.release("mouse")
    rig.result(held_now)
    assert_former(rig)


@pytest.mark.parametrize("line", ["BN", "KPX=3"])
def test_what_is_typed_meanwhile_burns_and_changes_nothing(tmp_path: Path, line: str) -> None:
    """BN would keep the narrow limits for ever, and a gain would be taken for that of the run."""
    rig = ready()

    def body(former: Former) -> Steps[str]:
        yield Wait(0.3)
        return "done"

    future = begin(rig, tmp_path, body)
    rig.until(lambda: held(rig)["FL"] == 3000)
    before = held(rig)
    with pytest.raises(NotAllowed, match="Not sent: axis X is being tuned"):
        rig.result(rig.controller.ask(line))
    controller, setup = rig.controller, Setup(model="ssc2")
    others = (controller.burn_program(), burn_setup(controller), send_setup(controller, setup, ()).future,
              controller.download("#A\nEN").future)  # fmt: skip
    for other in others:
        with pytest.raises(NotAllowed, match=r"Not [a-z]+: axis X is being tuned"):
            rig.result(other)
    assert held(rig) == before and not future.done()
    for allowed in ("MG _KPX", "SB 1", "TE X"):
        assert rig.result(rig.controller.ask(allowed)).accepted, allowed
    assert rig.result(future) == "done" and rig.simulation.state()["outputs"] == 1
    assert_former(rig)
    assert rig.result(rig.controller.ask("BN")).accepted


def test_stop_ends_the_run_and_the_former_values_come_back(tmp_path: Path) -> None:
    rig = ready()

    def body(former: Former) -> Steps[None]:
        yield from asked(rig, "KPX=20;JGX=1000")
        yield from asked(rig, "BG X")
        while True:
            yield Wait(0.05)

    future = begin(rig, tmp_path, body)
    rig.until(lambda: held(rig)["KP"] == 20 and rig.moving)
    rig.controller.stop()
    with pytest.raises(Stopped, match="former values of axis X are back"):
        rig.result(future)
    assert rig.controller.stop_state in (StopState.STOPPED, StopState.READY) and not rig.moving
    assert_former(rig)
    assert not list(tmp_path.iterdir())


def test_a_cut_cable_leaves_a_file_that_puts_everything_back_later(tmp_path: Path) -> None:
    rig = ready()

    def body(former: Former) -> Steps[None]:
        yield from asked(rig, "KPX=20;JGX=0")
        yield from asked(rig, "BG X")
        rig.cut()
        while True:
            yield from guards.watch(rig.controller, "X")
            yield Wait(0.05)

    with pytest.raises(LinkError):
        rig.result(begin(rig, tmp_path, body))
    (left,) = left_behind(tmp_path)
    assert left.gains() == "KP 6.125, KI 0.5, KD 80" and meant(left, rig.controller)
    assert held(rig)["OE"] == 1 and held(rig)["ER"] == 900  # what holds the axis meanwhile
    rig.loopback.unplugged = False
    rig.run(3.0)
    rig.controller.take_control()
    told = rig.result(now_there(rig.controller, left))
    assert told["KP"] == 20 * ONE
    assert "KP 6.125, KI 0.5, KD 80" in rig.result(put_back(rig.controller, left))
    assert_former(rig)
    assert left_behind(tmp_path) == ()


def test_values_of_another_machine_are_not_offered(tmp_path: Path) -> None:
    rig = ready()
    former = Former("X", "ssc2", 4711, "simulator", "", WHEN.isoformat(), 0, {"KP": ONE}, tmp_path / "a.before-tuning")
    keep(former)
    (left,) = left_behind(tmp_path)
    assert left == former and not meant(left, rig.controller)
    former.file.write_text('{"axis": "X"')
    assert left_behind(tmp_path) == ()
