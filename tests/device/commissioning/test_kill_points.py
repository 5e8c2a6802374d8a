"""A studio that dies at any byte of a test move: whatever is not as before is on disk, and is put back.

From the moment it dies nothing leaves any more, and nothing is written or removed on disk.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from device import former
from device.api import Job, Kind
from device.commissioning import moves
from device.commissioning.moves import Trial
from device.former import Former, left_behind, meant, put_back
from device.tasks import Priority
from device.transport.loopback import Loopback
from tests.device.bench import Bench
from tests.device.commissioning.machine import NOW, Machine
from tests.long import count, record

FORMER = {
    "ER": 9000.0, "OE": 0.0, "TL": 5.0, "FL": 500000.0, "BL": -500000.0, "SP": 30000.0, "AC": 102400.0, "KI": 0.5,
    "KP": 40.0, "KD": 300.0,
}  # fmt: skip
LARGEST_ERROR = 60  # counts, as asked for
AFTER_S = 1.5  # until the next start
LAST = 2600  # bytes, and some more than a move needs
SPACING = count(700, 7)  # bytes between two deaths


def dies_at(byte: int, folder: Path, patch: pytest.MonkeyPatch) -> tuple[Machine, bool]:
    """The machine after so many bytes of a move, and whether the studio died before its end."""
    machine = Machine(kind=Kind.MACHINE)
    machine.controller.take_control()
    machine.ask("MO X")
    for name, value in FORMER.items():
        machine.ask(f"{name}X={value:g}")
    left, dead = [byte], [False]

    def write(data: bytes) -> int:
        now, left[0] = data[: left[0]], max(0, left[0] - len(data))
        Loopback.write(machine.loopback, now)
        if len(now) < len(data):
            dead[0] = machine.loopback.unplugged = True
        return len(data)

    patch.setattr(machine.loopback, "write", write)
    for name in ("keep", "forget"):
        real = getattr(former, name)
        patch.setattr(former, name, lambda each, real=real: None if dead[0] else real(each))
    steps = moves.move(machine.controller, Trial("X", 300, LARGEST_ERROR), folder, NOW, Job())
    future = machine.controller.run(steps, Priority.USER, "user")
    machine.run_until(lambda: dead[0] or future.done(), 60)
    patch.undo()
    return machine, dead[0]


def held(bench: Bench) -> dict[str, float]:
    values = bench.result(bench.controller.read(*(f"_{name}X" for name in FORMER)))
    return dict(zip(FORMER, values, strict=True))


def comes_back(machine: Machine, folder: Path) -> bool:
    """The next start: what is not as before is offered, and put back; whether something was left."""
    machine.simulation.advance(int(AFTER_S * 1_024_000))
    bench = Bench("ssc2", simulation=machine.simulation, kind=Kind.MACHINE)
    bench.ready()
    controller = bench.controller
    there, left = held(bench), [each for each in left_behind(folder) if meant(each, controller)]
    on = machine.simulation.state()["axes"]["X"]["motor_on"]
    assert not on or (there["OE"] == 1 and there["ER"] <= LARGEST_ERROR)
    assert left or there == FORMER
    controller.take_control()
    if left and there != FORMER:
        kept: Former = left[0]
        assert "motor is off" in bench.result(put_back(controller, kept, motor_off=True))
    assert held(bench) == FORMER
    return bool(left)


def test_killed_at_every_byte_of_a_move(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found = []
    for byte in range(SPACING // 2, LAST, SPACING):
        folder = tmp_path / str(byte)
        machine, died = dies_at(byte, folder, monkeypatch)
        found.append(comes_back(machine, folder))
        assert died or not found[-1]  # who comes to the end leaves nothing
    assert any(found)
    record("studios killed at a byte of a test move", "pytest tests/device/commissioning", 0, len(found), "kills")
