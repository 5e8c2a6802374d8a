"""Bounded moves against machines that are wired wrong: each fault is recognised, and nothing runs far.

How far it went is told by the simulated motor itself, not by the encoder (dmc-1412-1414.txt l.606, 659-687).
"""

from __future__ import annotations

import random
import re
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from codegen.twoletter.fixed import ONE, scaled
from device.api import Job, Kind, LinkError, NotAllowed
from device.commissioning import moves, settings, sine
from device.commissioning.judge import (
    Moved,
    judge_polarity,
    judge_switches,
)
from device.commissioning.judge_sine import judge_halls, judge_phases, judge_zero
from device.commissioning.moves import Trial
from device.commissioning.record import Verdict
from device.commissioning.seen import NOTHING, Switches
from device.commissioning.sine import Phases
from device.former import left_behind, put_back
from device.simulator.plant import Drive, Enable
from device.tasks import Priority
from tests.device.commissioning.machine import NOW, Machine, bearing
from tests.long import count, record

MOST = 2000  # counts, whatever is wrong
LAST = 100  # counts in front of the target, in which it already counts as arrived or brakes
FACTORY = (0.0, 16384.0, 9.9982, 2147483647.0, -2147483648.0, 25000.0, 256000.0, 256000.0, 1.0)
FAULTS: dict[str, tuple[dict[str, Any], str]] = {
    "reversed": ({"motor_reversed": True}, "Wrong polarity"),
    "reversed, light": ({"motor_reversed": True, "inertia": 2e-5}, "Wrong polarity"),
    "reversed, velocity drive": ({"motor_reversed": True, "drive": Drive.VELOCITY}, "Wrong polarity"),
    "reversed, voltage drive": ({"motor_reversed": True, "drive": Drive.VOLTAGE}, "Wrong polarity"),
    "reversed, enable not heard": ({"motor_reversed": True, "amplifier_enable": Enable.ALWAYS}, "Wrong polarity"),
    "channel A dead": ({"dead_channel": "a"}, "toggled by one count"),
    "channel B dead": ({"dead_channel": "b"}, "toggled by one count"),
    "not enabled": ({"amplifier_enable": Enable.NONE}, "did not move"),
    "much friction": ({"coulomb_friction": 0.12}, "did not move"),
    "at its end": ({"forward_limit": 100.0}, "forward limit stopped it"),
}
USUAL = ("reversed", "channel B dead", "not enabled", "at its end")  # of the everyday run


@pytest.mark.parametrize(
    "fault", [name if name in USUAL else pytest.param(name, marks=pytest.mark.long) for name in FAULTS]
)
def test_a_fault_is_recognised_and_nothing_runs_far(fault: str, tmp_path: Path) -> None:
    plant, words = FAULTS[fault]
    machine = Machine(plant=bearing(**plant))
    finding = judge_polarity(machine.try_move(tmp_path))
    assert finding.verdict is Verdict.FAILED
    assert words in finding.sentence
    assert finding.advice
    assert machine.furthest < MOST
    assert machine.registers() == FACTORY
    assert not left_behind(tmp_path)
    assert not machine.simulation.state()["axes"]["X"]["motor_on"]


@pytest.mark.parametrize(("model", "baud"), [("ssc2", 9600), ("dmc1412", 19200)])
def test_a_healthy_axis_comes_to_its_target(model: str, baud: int, tmp_path: Path) -> None:
    machine = Machine(model, baud=baud)
    if model == "ssc2":
        machine.ask("KP 40;KD 400")  # tuned stiffly
    moved = machine.try_move(tmp_path)
    assert judge_polarity(moved).verdict is Verdict.PASSED
    assert moved.way == pytest.approx(300, abs=30)
    assert 270 < machine.furthest < 400
    assert machine.registers() == FACTORY


def test_everything_is_on_disk_before_it_is_changed(tmp_path: Path) -> None:
    machine = Machine()
    machine.ask("TL 2.5;ER 900;OE 1")
    job: Job[Moved] = Job()
    future = machine.controller.run(
        moves.move(machine.controller, Trial("X", 300), tmp_path, NOW, job), Priority.USER, "user"
    )
    machine.run_until(lambda: bool(left_behind(tmp_path)))
    held = machine.simulation.unit.state.registers
    assert (held["ER"][0], held["OE"][0], held["SP"][0]) == (900 * ONE, ONE, 25000 * ONE)  # not changed yet
    former = left_behind(tmp_path)[0]
    assert (former.values["ER"], former.values["OE"], former.values["SP"]) == (900 * ONE, ONE, 25000 * ONE)
    machine.result(future)
    assert not left_behind(tmp_path)
    assert machine.registers()[:2] == (1.0, 900.0)


@pytest.mark.parametrize("how", ["stop", "cancel", "watch"])
def test_what_ends_a_move_puts_everything_back(how: str, tmp_path: Path) -> None:
    machine = Machine(kind=Kind.MACHINE)
    controller = machine.controller
    controller.take_control()
    job: Job[Moved] = Job()
    machine.rest()
    future = controller.run(moves.move(controller, Trial("X", 900), tmp_path, NOW, job), Priority.USER, "user")
    machine.run_until(lambda: machine.furthest > 50)
    {"stop": controller.stop, "cancel": job.cancel, "watch": controller.release_control}[how]()
    machine.run_until(future.done)
    assert isinstance(future.exception(), LinkError)
    machine.run(1.0)
    assert machine.furthest < MOST
    assert not machine.simulation.state()["axes"]["X"]["motor_on"]
    if how == "watch":  # nothing more may be sent; it is offered later
        controller.take_control()
        machine.result(put_back(controller, left_behind(tmp_path)[0], motor_off=True))
    assert machine.registers() == FACTORY
    assert not left_behind(tmp_path)


def test_a_cut_cable_leaves_the_guards_and_the_file(tmp_path: Path) -> None:
    """The controller ends the move by itself; the former values are offered when it answers again."""
    machine = Machine()
    machine.rest()
    controller = machine.controller
    future = controller.run(moves.move(controller, Trial("X", 900), tmp_path, NOW, Job()), Priority.USER, "user")
    machine.run_until(lambda: machine.furthest > 50)
    machine.loopback.unplugged = True
    machine.run_until(future.done)
    machine.run(3.0)
    assert machine.furthest < MOST
    machine.loopback.unplugged = False
    machine.ready()
    assert machine.registers() != FACTORY
    sentence = machine.result(put_back(controller, left_behind(tmp_path)[0], motor_off=True))
    assert "motor is off" in sentence
    assert machine.registers() == FACTORY
    assert not left_behind(tmp_path)


def test_what_may_not_begin(tmp_path: Path) -> None:
    machine = Machine(kind=Kind.MACHINE)
    with pytest.raises(NotAllowed, match="Watch"):
        machine.try_move(tmp_path)
    machine.controller.take_control()
    with pytest.raises(NotAllowed, match="no step moves an axis by more than 1000 counts"):
        machine.try_move(tmp_path, Trial("X", -1001))
    with pytest.raises(NotAllowed, match="the error limit of a first move is 1 to 400 counts"):
        machine.try_move(tmp_path, Trial("X", 600, error=401))
    machine.simulation.unit.state.registers["MT"][0] = 2 * ONE
    with pytest.raises(NotAllowed, match=r"drives axis X as a stepper \(MT 2\), the setup says servo"):
        machine.try_move(tmp_path)
    machine.simulation.unit.state.registers["MT"][0] = ONE
    machine.simulation.load_program("#A\nJP #A\nEN")
    machine.simulation.execute(0)
    with pytest.raises(NotAllowed, match="program is running"):
        machine.try_move(tmp_path)
    assert machine.furthest == 0
    assert not left_behind(tmp_path)


def test_limits_are_set_read_back_and_the_motor_is_off(tmp_path: Path) -> None:
    machine = Machine()
    machine.ask("SH")
    wanted = {"OE": ONE, "ER": 2000 * ONE, "TL": scaled(Fraction(1))}
    former, there = machine.carry_out(settings.set_values(machine.controller, "X", wanted, tmp_path, NOW))
    assert (there["OE"], there["ER"]) == (ONE, 2000 * ONE)
    assert there["TL"] / ONE == pytest.approx(1, abs=3e-4)  # the converter's step
    assert former["ER"] == 16384 * ONE
    assert machine.registers()[:3] == (1.0, 2000.0, pytest.approx(1, abs=3e-4))
    assert not machine.simulation.state()["axes"]["X"]["motor_on"]
    assert machine.carry_out(settings.set_switches(machine.controller, "X", 1, -1))
    assert tuple(machine.simulation.unit.state.switches[:2]) == (1, -1)
    assert machine.carry_out(settings.burn(machine.controller, "X")).accepted


@pytest.mark.parametrize(
    ("plant", "words"),
    [({}, "Seen changing"), ({"limits_swapped": True}, "swapped"), ({"home_stuck": True}, "home input did not change")],
)
def test_switches_tripped_by_hand(plant: dict[str, Any], words: str) -> None:
    machine = Machine(plant=bearing(**plant))
    seen = Switches()

    def look() -> Switches:
        levels = machine.carry_out(settings.look_at_switches(machine.controller, "X"))
        assert levels is not None
        return seen.with_levels(levels)

    seen = look()
    for signal in ("fls_x", "rls_x", "home_x"):
        for level in (0, 1):
            machine.simulation.stimulus(signal, level)
            seen = look()
    if seen.asked:
        seen = seen.answered(NOTHING)
    finding = judge_switches(seen, {"forward": 0, "reverse": 0, "home": 0})
    assert words in finding.sentence
    assert (finding.verdict is Verdict.PASSED) == (not plant)
    assert machine.furthest == 0


CYCLE = Fraction("1333.333")  # dmc-1412-1414.txt l.727: 4000 counts, three pole pairs


@pytest.mark.parametrize(
    ("plant", "cycle", "words"),
    [
        ({"hall_inputs": 5, "hall_offset": 30.0}, CYCLE, ""),
        ({"phases_swapped": True}, CYCLE, "exchange phases A and B"),
        pytest.param({"hall_inputs": 5, "hall_order": "213"}, CYCLE, "exchange inputs", marks=pytest.mark.long),
        pytest.param({"amplifier_enable": Enable.NONE}, CYCLE, "did not move", marks=pytest.mark.long),
        pytest.param({"magnetic_cycle": 1000.0}, CYCLE, "not 1333.333", marks=pytest.mark.long),
    ],
)
def test_sine_commutation(plant: dict[str, Any], cycle: Fraction, words: str, tmp_path: Path) -> None:
    machine = Machine("dmc1412", bearing(**plant))
    machine.rest()
    phases = Phases("X", cycle, 5 if "hall_inputs" in plant else 0, Fraction(2))
    finding = judge_phases(machine.carry_out(sine.try_phases(machine.controller, phases)), "1333.333")
    assert finding.verdict is (Verdict.FAILED if words else Verdict.PASSED)
    assert words in finding.sentence
    assert machine.furthest < MOST
    assert not machine.simulation.state()["axes"]["X"]["motor_on"]
    if words:
        return
    told = re.search(r"BB is about (\d+)", finding.sentence)
    assert told is not None and abs(int(told[1]) - 30) <= 3  # steps of five degrees
    reply, counts = machine.carry_out(sine.drive_to_zero(machine.controller, "X", Fraction(2), 30))
    assert judge_zero(reply.accepted, reply.code, counts).verdict is Verdict.PASSED
    assert abs(machine.simulation.motion.commutation.phase_error(0)) < 2
    assert judge_polarity(machine.try_move(tmp_path)).verdict is Verdict.PASSED
    machine.rest()
    moved, before, after = machine.carry_out(
        sine.by_halls(machine.controller, "X", cycle, Fraction(1), tmp_path, NOW, Job())
    )
    assert judge_halls(moved, before, after).verdict is Verdict.PASSED
    assert before != after
    assert not machine.simulation.motion.commutation.calibrating(0)
    assert abs(machine.simulation.motion.commutation.phase_error(0)) < 2
    assert machine.furthest < MOST


def test_a_motor_without_power_has_no_commutation_zero() -> None:
    machine = Machine("dmc1412", bearing(amplifier_enable=Enable.NONE))
    phases = Phases("X", Fraction(1900 + 1), 0, Fraction(2))
    with pytest.raises(NotAllowed, match="more than 2000 counts"):
        machine.carry_out(sine.try_phases(machine.controller, phases))
    machine.ask("BA X")
    reply, counts = machine.carry_out(sine.drive_to_zero(machine.controller, "X", Fraction(2), 0))
    finding = judge_zero(reply.accepted, reply.code, counts)
    assert finding.verdict is Verdict.FAILED
    assert "error 113" in finding.sentence


def a_machine(seeds: random.Random, **faults: Any) -> Machine:
    """Motors from 20 to 1000 g cm², drives of 0.3 to 2 A/V, encoders of 250 to 2500 lines, at any speed of the line."""
    plant = bearing(
        inertia=10 ** seeds.uniform(-4.7, -3),
        amplifier_gain=10 ** seeds.uniform(-0.5, 0.3),
        coulomb_friction=10 ** seeds.uniform(-2.7, -1.5),
        viscous_friction=10 ** seeds.uniform(-2.7, -2.2),
        encoder_lines=seeds.choice([250.0, 500.0, 1000.0, 2500.0]),
        **faults,
    )
    return Machine(plant=plant, baud=seeds.choice([9600, 19200, 38400]))


@pytest.mark.parametrize("seed", range(count(1, 10)))
def test_nothing_runs_far_on_any_machine(seed: int, tmp_path: Path) -> None:
    seeds = random.Random(seed)
    furthest = 0.0
    for number in range(count(4, 40)):
        faults: list[dict[str, Any]] = [{"motor_reversed": True}, {"dead_channel": "a"}, {"dead_channel": "b"}, {}]
        fault = faults[number % 4]
        machine = a_machine(seeds, **fault)
        if not fault:
            machine.kill_encoder()
        finding = judge_polarity(machine.try_move(tmp_path, Trial("X", 300, seeds.choice([60, 60, 400]))))
        assert finding.verdict is Verdict.FAILED, (number, finding)
        assert machine.furthest < MOST, number
        furthest = max(furthest, machine.furthest)
    name = f"furthest way in a commissioning step, machines {seed}"
    record(name, "pytest tests/device/commissioning", seed, furthest, "counts")


STIFF = ((1023, 64), (1023, 4095), (200, 2000), (50, 500), (20, 4095))  # up to the largest there are (l.871, 878)


@pytest.mark.parametrize("seed", range(count(1, 10)))
def test_nothing_runs_far_whatever_the_axis_was_tuned_to(seed: int, tmp_path: Path) -> None:
    """With the gains it was tuned to an error of 60 counts would be the whole torque."""
    seeds = random.Random(3000 + seed)
    furthest = 0.0
    for number in range(count(2, 40)):
        stiff, fault = STIFF[number % len(STIFF)], ("dead", "a", "reversed", "dies")[number % 4]
        faults: dict[str, dict[str, Any]] = {"a": {"dead_channel": "a"}, "reversed": {"motor_reversed": True}}
        machine = a_machine(seeds, **faults.get(fault, {}))
        machine.ask(f"KP {stiff[0]};KD {stiff[1]};FA 20;FV 20")
        if fault == "dead":
            machine.kill_encoder()
        elif fault == "dies":
            machine.dies(seeds.choice("ab"), seeds.uniform(1, 200))
        moved = machine.try_move(tmp_path, Trial("X", 300, seeds.choice([60, 400])))
        assert judge_polarity(moved).verdict is Verdict.FAILED, (number, moved)
        assert machine.furthest < MOST, number
        assert machine.result(machine.controller.read("_KPX", "_KDX", "_FAX", "_FVX")) == (*stiff, 20, 20)
        furthest = max(furthest, machine.furthest)
    name = f"furthest way in a commissioning step of a stiff axis, machines {seed}"
    record(name, "pytest tests/device/commissioning", seed, furthest, "counts")


@pytest.mark.parametrize("seed", range(count(1, 10)))
def test_nothing_runs_far_when_the_encoder_dies_on_the_way(seed: int, tmp_path: Path) -> None:
    """A channel fails at any place of a move, or just behind its end; the way is that of the motor, not its reading."""
    seeds = random.Random(1000 + seed)
    furthest, recognised = 0.0, 0
    for number in range(count(3, 35)):
        machine = a_machine(seeds)
        counts = seeds.choice([300, -600, 1000, -1000])
        channel, at = seeds.choice("ab"), seeds.uniform(1, abs(counts) + 20)
        machine.dies(channel, at)
        moved = machine.try_move(tmp_path, Trial("X", counts, seeds.choice([60, 60, 400])))
        assert machine.furthest < MOST, number
        if at < abs(counts) - LAST:  # what dies in the last moment is seen by the next move
            assert judge_polarity(moved).verdict is Verdict.FAILED, number
        furthest = max(furthest, machine.furthest)
        recognised += judge_polarity(moved).verdict is Verdict.FAILED
    name = f"furthest way of a motor whose encoder dies on the way, machines {seed}"
    record(name, "pytest tests/device/commissioning", seed, furthest, "counts")
    assert recognised > count(3, 35) // 2


@pytest.mark.parametrize("seed", range(count(1, 40)))
def test_sound_axes_come_to_their_target(seed: int, tmp_path: Path) -> None:
    """Whatever the error limit that it takes; more than 400 counts of error are too much friction for these gains."""
    seeds = random.Random(2000 + seed)
    machine = a_machine(seeds)
    moved = machine.try_move(tmp_path, Trial("X", 600, 400, silent=400))  # the person saw it stand still before
    finding = judge_polarity(moved)
    assert finding.verdict is Verdict.PASSED or "too little force" in finding.sentence, finding
    assert machine.furthest < 700
