"""Long mixed runs: the same commands at the same samples, however the run is cut."""

from __future__ import annotations

import random

from device.simulator.kernel.compiled import Vector
from device.simulator.motion import Motion, Register, Watch
from device.simulator.plant import Drive, Place, Plant

PLANTS = (
    Plant(
        coulomb_friction=0.004, viscous_friction=0.001, encoder_noise=0.7, home_switch=(900.0, 1000.0), index_at=137.0
    ),
    Plant(drive=Drive.VOLTAGE, amplifier_gain=4.0, gravity=0.3, torque_ripple=0.05, delay_samples=2, peak_current=6.0),
    Plant(
        load_inertia=3.0e-4,
        coupling_stiffness=40.0,
        coupling_damping=0.01,
        backlash=9.0,
        coulomb_friction=0.003,
        auxiliary=Place.LOAD,
        forward_limit=60000.0,
        reverse_limit=-60000.0,
    ),
    Plant(drive=Drive.STEPPER),
)


def begin(motion: Motion) -> None:
    """Gains and modes the run starts with."""
    for axis in range(3):
        motion.set(axis, Register.KD, 150.0)
        motion.set(axis, Register.KI, 0.5)
        motion.set(axis, Register.ERROR_LIMIT, 3000.0)
    motion.set(0, Register.VELOCITY_FEED, 20.0)
    motion.set(1, Register.ACCELERATION_FEED, 9.0)
    motion.set(2, Register.SMOOTHING, 0.2)
    motion.set(3, Register.MOTOR_TYPE, 2.0)
    motion.set_gear_master(3, "main", 1)


def act(motion: Motion, choice: random.Random) -> None:
    """One command, as anybody might send it at this moment."""
    axis = choice.randrange(4)
    what = choice.randrange(20)
    if what < 6 and not motion.moving(axis):
        motion.begin_position(axis, motion.reference(axis) + choice.randint(-9000, 9000))
    elif what == 6 and not motion.moving(axis):
        motion.set(axis, Register.JOG_SPEED, 2 * choice.randint(-20000, 20000))
        motion.begin_jog(axis)
    elif what == 7 and not motion.moving(axis):
        motion.begin_home(axis, motion.home_level(axis))
    elif what == 8:
        motion.stop(axis)
    elif what == 9:
        motion.abort(axis)
    elif what == 10:
        motion.set(axis, Register.SPEED, 2 * choice.randint(500, 20000))
    elif what == 11:
        motion.increment(axis, choice.randint(-500, 500))
    elif what == 12:
        motion.load(axis, choice.uniform(-0.5, 0.5))
    elif what == 13:
        motion.push(axis, choice.randint(-20, 20))
    elif what == 14 and not motion.moving(axis):
        motion.define_position(axis, choice.randint(-1000, 1000))
    elif what == 15:
        motion.set(3, Register.GEAR_RATIO, choice.choice((0.0, 0.5, -1.132)))
    elif what == 16 and not motion.path.moving and not (motion.moving(0) or motion.moving(1)):
        motion.path.vector(0, 1)
        motion.path.point(choice.randint(100, 3000), choice.randint(-900, 900))
        motion.path.arc(700.0, choice.uniform(0, 360), choice.uniform(-400, 400), 9000.0)
        motion.path.end()
        motion.path.begin()
    elif what == 17 and not motion.moving(2):
        motion.contour.open([2])
        motion.contour.give({2: choice.randint(-60, 60)}, choice.randint(1, 8))
    elif what == 18 and motion.contour.free and motion.contour.active:
        motion.contour.give({2: choice.randint(-60, 60)}, choice.choice((0, 3)))
    elif what == 19:
        motion.set_abort(choice.random() < 0.8)
        motion.servo_here(axis)


def mixed_run(compiled: bool, samples: int, batch: int, seed: int = 1) -> tuple[Vector, Vector]:
    """Runs the scenario in pieces of at most `batch`; the final state and the trace."""
    choice = random.Random(seed)
    motion = Motion(4, PLANTS, seed=seed, compiled=compiled)
    motion.trace(samples)
    begin(motion)
    due = 0
    while motion.sample < samples:
        if motion.sample == due:
            act(motion, choice)
            number = motion.watch(Watch.AFTER_DISTANCE, choice.randrange(4), choice.randint(1, 2000))
            due += choice.randint(5, 400)
            due = min(due, samples)
        while motion.sample < due:
            motion.run(min(batch, due - motion.sample))
        motion.drop(number)
        motion.take_events()
    return motion.snapshot(), motion.trace_rows().copy()
