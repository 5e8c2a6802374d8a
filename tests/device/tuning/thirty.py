"""Thirty machines behind one axis, each with what its technician asks for; their true loops are worked out here."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from typing import Any

from device.simulator.plant import Drive, Place, Plant
from device.tuning.design import Target

MOTOR = 2.0e-4  # kg·m², the motor of chapter 10 (dmc-1412-1414.txt l.4370)


@dataclass(frozen=True)
class Case:
    """A machine, the travel its technician allows for the excitation, and the target."""

    name: str
    plant: Plant
    travel: int
    target: Target
    reachable: bool = True


def spring(hertz: float, damping: float, ratio: float, times: float = 1.0) -> dict[str, float]:
    """Motor, load and coupling of a resonance: w² = k (1/Jm + 1/JL), damping as a part of the critical one."""
    whole = MOTOR * times
    motor = whole / (1 + ratio)
    load = whole - motor
    omega, together = 2 * math.pi * hertz, motor * load / whole
    return {
        "inertia": motor,
        "load_inertia": load,
        "coupling_stiffness": omega**2 * together,
        "coupling_damping": 2 * damping * omega * together,
    }


def rigid(
    times: float, lines: float, amplifier: float = 1.0, rub: float = 1e-3, dry: float = 0.0, **more: object
) -> Plant:
    """One mass: so many times the motor's inertia."""
    return Plant(
        inertia=MOTOR * times,
        encoder_lines=lines,
        amplifier_gain=amplifier,
        viscous_friction=rub,
        coulomb_friction=dry,
        **more,  # type: ignore[arg-type]
    )


def random_machine(chance: random.Random) -> Plant:
    """Any machine of the kinds below, with noise and torque ripple in some; the amplifier suits inertia and encoder."""
    times, lines = math.exp(chance.uniform(0, math.log(50))), chance.choice([250, 500, 1000, 2500, 5000, 10000])
    suits = times * 1000 / lines * chance.choice([0.2, 0.5, 1, 2])
    amplifier = min(10.0, max(0.5, suits))
    volt = amplifier * Plant().torque_constant
    known: dict[str, Any] = {
        "amplifier_gain": amplifier,
        "encoder_lines": float(lines),
        "viscous_friction": chance.uniform(0, 3) * MOTOR * times,
        "coulomb_friction": volt * chance.choice([0, 0, 0.02, 0.05, 0.1]),
        "encoder_noise": chance.choice([0, 0, 0.3]),
        "torque_ripple": chance.choice([0, 0, 0.02]),
        "delay_samples": chance.choice([0, 0, 1, 2, 4]),
        "gravity": chance.choice([0, 0, chance.uniform(-0.8, 0.8)]),
    }
    kind = chance.choice(["mass", "mass", "speed", "spring", "spring", "behind"])
    if kind in ("mass", "speed"):
        known["inertia"] = MOTOR * times
    else:
        hertz = math.exp(chance.uniform(math.log(30), math.log(300)))
        known.update(spring(hertz, chance.uniform(0.02, 0.1), chance.uniform(0.2, 2), times))
    if kind == "speed":
        known.update(drive=Drive.VELOCITY, tachometer_gain=chance.uniform(0.05, 0.2))
    if kind == "behind":
        known["main"] = Place.LOAD
    return Plant(**known)


CASES = (
    # inertia x1 to x50, encoders of 100 to 10 000 lines, friction
    Case("plain", rigid(1, 1000), 200, Target(80, 50)),
    Case("dry", rigid(1, 1000, dry=0.005), 200, Target(70, 50)),
    Case("sticky", rigid(2, 2000, 2.0, dry=0.02), 800, Target(100, 50)),
    Case("x5", rigid(5, 2500, 2.0, dry=0.01), 600, Target(70, 50)),
    Case("x10", rigid(10, 5000, 4.0, dry=0.02), 1000, Target(90, 50)),
    Case("x20", rigid(20, 5000, 4.0, rub=5e-3, dry=0.05), 2000, Target(80, 50)),
    Case("x50", rigid(50, 10000, 6.0, rub=1e-2, dry=0.1), 4000, Target(80, 50)),
    Case("100 lines", rigid(1, 100, 4.0, dry=0.005), 100, Target(60, 50)),
    Case("10 000 lines", rigid(1, 10000, 1.0, dry=0.003), 1000, Target(280, 55, 0.0)),
    Case("256 lines, x2", rigid(2, 256, 4.0, dry=0.01), 200, Target(70, 50)),
    # with a delay in the drive, samples
    Case("late 1", rigid(1, 1000, dry=0.003, delay_samples=1), 200, Target(70, 50)),
    Case("late 2", rigid(2, 2500, delay_samples=2), 400, Target(60, 50)),
    Case("late 3", rigid(5, 2500, 2.0, dry=0.01, delay_samples=3), 800, Target(60, 45)),
    Case("late 4", rigid(1, 2000, delay_samples=4), 300, Target(60, 50, 0.1)),
    Case("late 5, too fast", rigid(1, 2000, delay_samples=5), 300, Target(200, 50), reachable=False),
    # hanging
    Case("hangs", rigid(1, 1000, gravity=0.5), 200, Target(80, 50)),
    Case("hangs, dry", rigid(3, 2000, 2.0, dry=0.01, gravity=0.8), 400, Target(80, 50)),
    Case("hangs, x10", rigid(10, 5000, 4.0, dry=0.02, gravity=-0.6), 1000, Target(80, 50)),
    # drives with a velocity loop
    Case("speed drive", Plant(drive=Drive.VELOCITY, amplifier_gain=2.0, coulomb_friction=0.002), 200, Target(150, 50)),
    Case(
        "fast speed drive",
        Plant(drive=Drive.VELOCITY, amplifier_gain=8.0, encoder_lines=2500, tachometer_gain=0.05),
        400,
        Target(150, 72, 0.0),
    ),
    # with a resonance
    Case("30 Hz", Plant(**spring(30, 0.03, 0.5)), 200, Target(60, 50)),
    Case(
        "45 Hz behind",
        Plant(main=Place.LOAD, encoder_lines=500, amplifier_gain=0.5, **spring(45, 0.1, 0.5)),
        200,
        Target(20, 50),
    ),
    Case("60 Hz, dry", Plant(coulomb_friction=0.004, **spring(60, 0.04, 1.0)), 200, Target(80, 50)),
    Case("80 Hz, x5", Plant(encoder_lines=2500, amplifier_gain=2.0, **spring(80, 0.03, 1.5, 5)), 500, Target(80, 50)),
    Case("110 Hz", Plant(encoder_lines=2000, **spring(110, 0.03, 0.3)), 300, Target(100, 50, 0.1)),
    Case("140 Hz behind, too fast", Plant(main=Place.LOAD, **spring(140, 0.03, 0.5)), 200, Target(120, 45), False),
    Case("180 Hz, hangs", Plant(gravity=0.4, **spring(180, 0.03, 0.8)), 200, Target(80, 50)),
    Case(
        "220 Hz, late 1",
        Plant(delay_samples=1, encoder_lines=2500, **spring(220, 0.04, 0.4)),
        300,
        Target(100, 50, 0.1),
    ),
    Case(
        "260 Hz, dry, hangs", Plant(gravity=0.3, coulomb_friction=0.003, **spring(260, 0.05, 1.0)), 200, Target(80, 50)
    ),
    Case("300 Hz", Plant(encoder_lines=5000, **spring(300, 0.02, 0.6)), 500, Target(135, 55, 0.0)),
)
EVERY_DAY = ("x50", "late 3", "hangs, dry", "60 Hz, dry", "140 Hz behind, too fast")
