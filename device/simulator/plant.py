"""The simulated machine behind one axis: motor, drive, load, encoder and switches."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Drive(StrEnum):
    """What the amplifier makes of the motor command."""

    CURRENT = "current"
    VOLTAGE = "voltage"
    VELOCITY = "velocity"
    STEPPER = "stepper"


class Enable(StrEnum):
    """What the amplifier hears of the controller's enable signal (AEN, dmc-1412-1414.txt l.593-597)."""

    WIRED = "wired"
    NONE = "none"  # never enabled: the motor has no power
    ALWAYS = "always"  # MO and off-on-error do not reach it


class Place(StrEnum):
    """Where an encoder sits."""

    MOTOR = "motor"
    LOAD = "load"
    EXTERNAL = "external"


@dataclass(frozen=True, kw_only=True)
class Plant:
    """One axis of a plant file; the defaults are the motor of dmc-1412-1414.txt l.4370-4376 without friction."""

    drive: Drive = Drive.CURRENT
    amplifier_gain: float = 1.0  # Ka, A/V, or Kv, V/V
    torque_constant: float = 0.1  # Kt, N·m/A
    inertia: float = 2.0e-4  # J, kg·m²
    resistance: float = 2.0  # R, Ω
    inductance: float = 0.004  # L, H
    tachometer_gain: float = 0.1  # Kg, V·s/rad
    load_inertia: float = 0.0  # kg·m²
    coupling_stiffness: float = 0.0  # N·m/rad; 0: rigid
    coupling_damping: float = 0.0  # N·m·s/rad
    delay_samples: int = 0
    gravity: float = 0.0  # V at the motor command that holds the load
    torque_ripple: float = 0.0  # fraction
    encoder_noise: float = 0.0  # counts, standard deviation
    viscous_friction: float = 0.0  # N·m·s/rad
    coulomb_friction: float = 0.0  # N·m
    encoder_lines: float = 1000.0  # N; 4N counts a revolution
    backlash: float = 0.0  # counts between motor and load
    main: Place = Place.MOTOR
    auxiliary: Place = Place.MOTOR
    auxiliary_ratio: float = 1.0  # auxiliary counts per main count
    peak_current: float = 1.0e9  # A
    magnetic_cycle: float = 4000.0 / 3.0  # counts
    hall_inputs: int | None = None  # first of three inputs
    hall_offset: float = 0.0  # degrees
    hall_order: str = "123"
    phases_swapped: bool = False
    home_switch: tuple[float, float] | None = None  # the home input reads 0 in this range (counts)
    forward_limit: float | None = None
    reverse_limit: float | None = None
    index_at: float = 0.0  # counts modulo 4N
    motor_reversed: bool = False  # its leads are exchanged: a positive command drives it backwards
    amplifier_enable: Enable = Enable.WIRED
    dead_channel: str = ""  # "a" or "b": the encoder's channel that stays low
    limits_swapped: bool = False  # each limit switch is wired to the other one's input
    home_stuck: bool = False  # the home input reads 1 whatever the switch does
