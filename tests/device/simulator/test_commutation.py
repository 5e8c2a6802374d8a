"""Sine commutation as it is typed: examples of dmc-1412-1414.txt l.615-804, errors 110 to 114, what is burned."""

from __future__ import annotations

import pytest

from device.simulator.eeprom import Eeprom
from device.simulator.plant import Plant
from tests.device.simulator.bench import Bench

CYCLE = 4000 / 3  # l.721-723: 4000 counts and three magnetic cycles a revolution


def brushless(eeprom: Eeprom | None = None, **changes: object) -> Bench:
    """A motor with friction; hall sensors on inputs 5, 6 and 7 unless it is told otherwise."""
    values: dict[str, object] = {"viscous_friction": 0.002, "hall_inputs": 5} | changes
    bench = Bench("dmc1412", {"X": Plant(**values)}, eeprom)  # type: ignore[arg-type]
    bench.ask("KD 200;KP 20;ER 500;OE 1;BA X;BM 1333.333")
    return bench


def phase_error(bench: Bench) -> float:
    return bench.simulation.unit.motion.commutation.phase_error(0)


def value(bench: Bench, expression: str) -> float:
    """What MG prints of it."""
    return float(bench.ask(f"MG {expression}"))


def setting(bench: Bench, name: str) -> float:
    """What the controller keeps for a command that has no operand."""
    return bench.simulation.unit.state.registers[name][0] / 65536


def motor_off(bench: Bench) -> bool:
    return not bench.simulation.unit.motion.motor_on(0)


def moves_to(bench: Bench, command: str, place: int) -> bool:
    bench.ask(command)
    bench.wait(4000)
    return abs(int(bench.ask("TP")) - place) <= 2


def test_three_inputs_carry_the_halls() -> None:
    bench = brushless()
    bench.ask("BI5")  # l.615
    assert setting(bench, "BI") == 5
    assert value(bench, "_BC") in range(1, 7)
    assert bench.refused("BI 6") == 6  # the last of seven inputs is 7
    assert bench.refused("BI 0") == 6


def test_the_magnetic_cycle_may_have_a_fraction() -> None:
    bench = brushless()
    bench.ask("BM 62000")  # l.719
    assert setting(bench, "BM") == 62000
    bench.ask("BM 1333.333")  # l.723
    assert setting(bench, "BM") == pytest.approx(1333.333, abs=1e-5)
    assert bench.refused("BM 0") == 6


def test_setup_tells_a_right_wiring() -> None:
    bench = brushless()
    bench.ask("MO;BI5")
    bench.type("BS 2,700\r")  # l.719
    assert bench.wait(5000) == ""
    answer = bench.wait(5000)  # l.735: a host waits ten seconds for it
    assert answer.splitlines() == [
        "Phase wiring is correct",
        "BM is about 1333",
        "Hall wiring is correct",
        "BB is about 0",
        ":",
    ]
    assert motor_off(bench)


@pytest.mark.parametrize("offset", [30, 90])
def test_setup_tells_the_offset_of_the_halls(offset: int) -> None:
    bench = brushless(hall_offset=float(offset))
    bench.ask("BI5")
    answer = bench.type("BS 2,700\r", 10_000)
    told = int(answer.split("BB is about ")[1].split()[0])
    assert abs(told - offset) <= 2


def test_setup_tells_swapped_phases() -> None:
    bench = brushless(phases_swapped=True)
    answer = bench.type("BS 2,700\r", 10_000)
    assert "Phase wiring is wrong, exchange phases A and B\r\nBM is about 1333\r\n:" in answer


@pytest.mark.parametrize(("order", "right"), [("123", True), ("231", True), ("132", False), ("321", False)])
def test_setup_tells_the_order_of_the_halls(order: str, right: bool) -> None:
    bench = brushless(hall_order=order)
    bench.ask("BI5")
    answer = bench.type("BS 2,700\r", 10_000)
    assert ("Hall wiring is correct" in answer) == right
    assert ("exchange inputs 6 and 7" in answer) == (not right)


def test_setup_without_halls_and_without_movement() -> None:
    bench = brushless(hall_inputs=None)
    assert "No hall sensors" in bench.type("BS 2\r", 10_000)
    stuck = brushless(coulomb_friction=5.0)
    assert "No movement" in stuck.type("BS 2,100\r", 10_000)


@pytest.mark.parametrize("start", [0, 300, 500, -450, 651])
def test_a_negative_voltage_ends_in_servo_here(start: int) -> None:
    bench = brushless(hall_inputs=None)
    bench.ask("MO")
    bench.simulation.stimulus("position_x", start)
    bench.type("BZ -2\r")  # l.765
    assert bench.wait(4000) == ":"
    assert abs(phase_error(bench)) < 1
    assert not motor_off(bench)
    assert abs(value(bench, "_BZ")) <= 1
    assert min(value(bench, "_BD"), 360 - value(bench, "_BD")) < 1
    assert moves_to(bench, "DP 0;PR 2000;BG", 2000)


def test_a_positive_voltage_ends_with_the_motor_off() -> None:
    bench = brushless(hall_inputs=None)
    bench.type("BZ 2\r", 4000)
    assert motor_off(bench)
    assert abs(phase_error(bench)) < 1


def test_close_to_zero_first_then_zero() -> None:
    bench = brushless(hall_offset=30.0)
    bench.ask("MO;BI5;BB 30;BN")
    bench.wait(400)
    bench.type("RS\r", 1500)
    assert abs(phase_error(bench)) <= 30.5  # l.777: good to within 30 degrees
    program = "#A\nSH\nPRX=-1*(_BZX)\nBG\nAM\nBZX=-1\nEN"  # l.781-786
    assert bench.run(program) == "end"
    assert not bench.simulation.errors
    assert abs(phase_error(bench)) < 1
    assert not motor_off(bench)


def test_calibration_sets_the_phase_at_the_first_transition() -> None:
    bench = brushless(hall_offset=30.0)
    bench.ask("MO;BI5;BB 30;BN")
    bench.wait(400)
    bench.type("RS\r", 1500)
    before = phase_error(bench)
    assert 2 < abs(before) <= 30.5
    bench.ask("SH;BC;PR 50000;BG")  # l.792-804
    assert phase_error(bench) == pytest.approx(before, abs=3)  # hardly moving yet
    bench.wait(3000)
    assert abs(phase_error(bench)) < 2
    assert abs(int(bench.ask("TP")) - 50000) <= 3


def test_without_a_phase_the_loop_is_unstable() -> None:
    bench = brushless(hall_inputs=None)  # l.750
    bench.ask("SH;PR 2000;BG")
    bench.wait(2000)
    assert motor_off(bench)  # OE
    assert abs(int(bench.ask("TP"))) > 500


def test_errors() -> None:
    bench = Bench("dmc1412", {"X": Plant(viscous_friction=0.002)})
    for command in ("BZ 2", "BC", "BD 90", "BS 2,700"):
        assert bench.refused(command) == 111, command
    assert bench.refused("BA Y") == 90
    assert bench.refused("BZ 12") == 6
    bench.ask("BA X")
    assert bench.refused("BC") == 110  # no BI
    bench.ask("BI 1")
    assert bench.refused("BC") == 110  # three high inputs are no sensors
    bench.ask("BD 90")
    assert value(bench, "_BD") == 90
    bench.ask("BA N")
    assert bench.refused("BD 90") == 111
    assert Bench("dmc1414").refused("BA X") == 1
    assert Bench("ssc4").refused("BZ 2") == 1


def test_a_motor_that_does_not_move() -> None:
    bench = brushless(coulomb_friction=5.0, hall_inputs=None)
    bench.type("BZ 2\r")
    assert bench.wait(5000) == "?"
    assert bench.ask("TC1").startswith("113 No movement in BZ")
    assert motor_off(bench)


@pytest.mark.parametrize(
    ("code", "machine"),
    [
        (114, {"gravity": 5.0}),  # the field of one volt cannot hold it
        (112, {"viscous_friction": 0.05, "inertia": 0.02}),  # it is still on its way when BZ gives up
    ],
)
def test_a_motor_that_does_not_come_to_rest(code: int, machine: dict[str, float]) -> None:
    bench = brushless(hall_inputs=None, **machine)
    bench.type("BZ 1\r")
    assert bench.wait(8000) == "?"
    assert int(bench.ask("TC")) == code
    assert motor_off(bench)


def test_a_field_ends_with_its_program() -> None:
    bench = brushless(hall_inputs=None)
    bench.load("#A\nBZ -2\nEN")
    bench.simulation.execute("#A")
    bench.wait(300)
    assert bench.simulation.state()["threads"][0]["waiting_for"] == "BZ"
    bench.ask("HX")
    bench.wait(3000)
    assert motor_off(bench)
    bench.type("BZ -2\r", 4000)
    assert not motor_off(bench)


def test_what_is_burned_comes_back() -> None:
    eeprom = Eeprom()
    bench = brushless(eeprom)
    bench.ask("BI5;BB 90;BO 0.25;MO;BN")  # l.739: must be burned
    bench.wait(400)
    bench.type("RS\r", 1500)
    assert [setting(bench, name) for name in ("BI", "BB", "BO")] == [5, 90, 0.25]
    assert motor_off(bench)
    again = Bench("dmc1412", {"X": Plant(hall_inputs=5)}, eeprom)
    assert setting(again, "BI") == 5
    again.ask("BD 45")  # brushless, or it would be error 111


def test_hall_inputs_can_be_read() -> None:
    bench = brushless()
    bench.ask("MO;BI5")
    seen = set()
    for _ in range(12):
        bench.simulation.stimulus("position_x", 111)
        bench.wait(2)
        levels = int(bench.ask("TI"))
        assert levels & 15 == 15
        assert levels >> 4 == value(bench, "_BC")
        assert levels >> 4 & 1 == value(bench, "@IN[5]")
        seen.add(levels >> 4)
    assert seen == {1, 2, 3, 4, 5, 6}


@pytest.mark.parametrize("command", ["BZ -2", "BS 2,100"])
def test_any_slicing_and_any_snapshot_give_the_same(command: str) -> None:
    ends = []
    for slice_ms in (1, 37, 3700):
        bench = brushless()
        bench.ask("BI5")
        answer = bench.type(command + "\r", 0)
        for _ in range(3700 // slice_ms):
            answer += bench.wait(slice_ms)
        ends.append((answer, bench.simulation.unit.motion.snapshot().tobytes()))
    bench = brushless()
    bench.ask("BI5")
    bench.type(command + "\r", 400)
    moment = bench.simulation.snapshot()
    bench.wait(5000)
    bench.simulation.restore(moment)
    ends.append((bench.wait(3300), bench.simulation.unit.motion.snapshot().tobytes()))
    assert len(set(ends)) == 1
    assert ends[0][0].endswith(":")
