"""STOP while the controller turns the field of a motor (BS, BZ): it hears nothing for seconds, and that is shown.

No manual says that a command comes through meanwhile (dmc-1412-1414.txt l.719-771: only that BS takes up to ten
seconds); so 500 ms after STOP the button says NOT CONFIRMED, and the stop waits in the controller's receiver, first of
all, and is confirmed when it is carried out (safety.md 1).
"""

from __future__ import annotations

from concurrent.futures import Future
from fractions import Fraction
from typing import Any

import pytest

from device.commissioning import sine
from device.commissioning.sine import Phases
from device.stop import StopState
from device.tasks import Priority, Stopped
from tests.device.commissioning.machine import Machine, bearing
from tests.long import is_long

CYCLE = Fraction("1333.333")  # dmc-1412-1414.txt l.727
CONFIRMED_S = 0.5  # behind the end of the field: the stop, HX, and their proof
MOST = 2000  # counts


def begun(machine: Machine, what: str, time_ms: int = 200) -> Future[Any]:
    """The field turns."""
    steps = sine.try_phases(machine.controller, Phases("X", CYCLE, 5, Fraction(2), time_ms))
    if what == "BZ":
        steps.close()
        machine.ask("BA X")
        future: Future[Any] = machine.controller.run(
            sine.drive_to_zero(machine.controller, "X", Fraction(2), 30), Priority.USER, "user"
        )
    else:
        future = machine.controller.run(steps, Priority.USER, "user")
    machine.rest()
    machine.run_until(lambda: turning(machine))
    return future


def turning(machine: Machine) -> bool:
    return machine.simulation.unit.state.field_test is not None


@pytest.mark.parametrize(
    ("what", "time_ms", "baud"),
    [
        ("BS", 200, 19200),
        ("BZ", 200, 9600),
        *((what, ms, baud) for what in ("BS", "BZ") for ms in (200, 700) for baud in (9600, 19200, 38400) if is_long()),
    ],
)
def test_stop_while_the_field_turns(what: str, time_ms: int, baud: int) -> None:
    machine = Machine("dmc1412", bearing(hall_inputs=5, hall_offset=30.0), baud=baud)
    controller = machine.controller
    future = begun(machine, what, time_ms)
    machine.run(0.1)
    controller.stop()
    pressed, shown, ended = machine.loopback.clock(), [(0.0, controller.stop_state)], 0.0
    while not future.done() or turning(machine):
        machine.step()
        now = machine.loopback.clock()
        assert now < pressed + 20
        if turning(machine):
            ended = now
        if controller.stop_state is not shown[-1][1]:
            shown.append((now - pressed, controller.stop_state))
    assert ended - pressed > CONFIRMED_S  # the field turned on, STOP or not
    states = [state for _, state in shown]
    assert states[:2] == [StopState.STOPPING, StopState.NOT_CONFIRMED]
    assert 0.4 < shown[1][0] <= 0.52
    assert states.count(StopState.NOT_CONFIRMED) == 1
    assert [state for _, state in shown[2:]] == [StopState.STOPPED]  # confirmed, and it stays so
    assert ended - 0.05 < pressed + shown[2][0] < ended + CONFIRMED_S  # not before it was carried out
    assert isinstance(future.exception(), Stopped) and "heard it when the motor had turned" in str(future.exception())
    machine.run(0.5)
    assert not machine.simulation.state()["axes"]["X"]["motor_on"] and machine.still()
    assert machine.furthest < MOST
    assert not machine.simulation.unit.state.program


def test_stop_twice_while_the_field_turns() -> None:
    """AB waits behind ST and changes nothing: the motor is off afterwards, and that is proved."""
    machine = Machine("dmc1412", bearing())
    future = begun(machine, "BS")
    machine.controller.stop()
    machine.run(0.7)
    assert machine.controller.stop_state is StopState.NOT_CONFIRMED
    machine.controller.stop()
    machine.run_until(lambda: future.done() and not turning(machine))
    machine.run(CONFIRMED_S)
    assert machine.controller.stop_state is StopState.STOPPED
    assert not machine.simulation.state()["axes"]["X"]["motor_on"] and machine.still()


def test_a_cable_that_is_cut_while_the_field_turns() -> None:
    """STOP is never confirmed; the controller ends the field by itself, with the motor off (l.765)."""
    machine = Machine("dmc1412", bearing())
    future = begun(machine, "BZ")
    machine.loopback.unplugged = True
    machine.controller.stop()
    machine.run(0.6)
    assert machine.controller.stop_state in (StopState.NOT_CONFIRMED, StopState.NO_LINK)
    machine.run_until(future.done)
    machine.run(3.0)
    assert machine.controller.stop_state in (StopState.NOT_CONFIRMED, StopState.NO_LINK)
    assert not machine.simulation.state()["axes"]["X"]["motor_on"]
    assert machine.furthest < MOST
