"""Works out the coefficients with which the sample loop moves a machine exactly from sample to sample."""

from __future__ import annotations

import functools
import math

from device.simulator.kernel import layout
from device.simulator.kernel.layout import State
from device.simulator.plant import Drive, Enable, Place, Plant

Matrix = list[list[float]]
NEVER = 1.0e300
TAYLOR_TERMS = 14


def product(left: Matrix, right: Matrix) -> Matrix:
    """The matrix product."""
    columns = list(zip(*right, strict=True))
    return [[math.fsum(a * c for a, c in zip(line, column, strict=True)) for column in columns] for line in left]


def exponential(matrix: Matrix) -> Matrix:
    """exp(matrix) by scaling, Taylor series and squaring; the same bits on every machine."""
    size = len(matrix)
    norm = max(sum(abs(value) for value in line) for line in matrix)
    squarings = 0
    while norm > 0.25:
        norm *= 0.5
        squarings += 1
    scale = 0.5**squarings
    scaled = [[value * scale for value in line] for line in matrix]
    result = [[1.0 if i == j else 0.0 for j in range(size)] for i in range(size)]
    term = result
    for order in range(1, TAYLOR_TERMS):
        term = [[value / order for value in line] for line in product(term, scaled)]
        result = [[a + c for a, c in zip(one, other, strict=True)] for one, other in zip(result, term, strict=True)]
    for _ in range(squarings):
        result = product(result, result)
    return result


def counts_per_radian(plant: Plant) -> float:
    """Kf = 4N/2π (l.4440)."""
    return 4.0 * plant.encoder_lines / (2.0 * math.pi)


def is_coupled(plant: Plant) -> bool:
    """The load has inertia of its own behind a springy coupling."""
    return plant.load_inertia > 0.0 and plant.coupling_stiffness > 0.0 and plant.drive is not Drive.STEPPER


def is_electrical(plant: Plant) -> bool:
    """The current is a state of its own (voltage drive with inductance)."""
    return plant.drive is Drive.VOLTAGE and plant.inductance > 0.0


def motor_inertia(plant: Plant) -> float:
    """Inertia that turns with the motor, kg·m²."""
    return plant.inertia if is_coupled(plant) else plant.inertia + plant.load_inertia


def torque_per_volt(plant: Plant) -> float:
    """Torque at standstill for one volt of motor command, N·m/V."""
    gain = plant.amplifier_gain * plant.torque_constant
    return gain / plant.resistance if plant.drive is Drive.VOLTAGE else gain


def back_volts(plant: Plant) -> float:
    """Volts of command that one count/s takes off: tachometer or back EMF."""
    if plant.drive is Drive.VELOCITY:
        return plant.tachometer_gain / counts_per_radian(plant)
    if plant.drive is Drive.VOLTAGE:
        return plant.torque_constant / (plant.amplifier_gain * counts_per_radian(plant))
    return 0.0


@functools.lru_cache(maxsize=256)  # every controller that starts asks for the same
def decay_terms(rate: float, period: float) -> tuple[float, float, float]:
    """For v' = a - rate·v over one period: what is left of v, ∫v for v = 1 (and v for a = 1), ∫∫ for a = 1."""
    result = exponential([[-rate * period, 0.0, period], [period, 0.0, 0.0], [0.0, 0.0, 0.0]])
    return result[0][0], result[0][2], result[1][2]


@functools.lru_cache(maxsize=256)
def regime_matrix(plant: Plant, regime: int, step: float) -> tuple[float, ...]:
    """One regime of the general machine as 5 × 7 coefficients for a step of `step` seconds (see `layout`)."""
    inertia, scale = motor_inertia(plant), counts_per_radian(plant)
    powered = not regime & layout.REGIME_OFF
    stuck = bool(regime & layout.REGIME_STUCK)
    joined = is_coupled(plant) and not regime & layout.REGIME_APART
    # unknowns: motor v, current, load v, twist, motor travel, load travel; then volts, motor a, load a
    rate: Matrix = [[0.0] * 9 for _ in range(9)]
    if not stuck:
        rate[0][0] = -plant.viscous_friction / inertia
        rate[0][6 + 1] = 1.0
        if powered and is_electrical(plant):
            rate[0][1] = plant.torque_constant * scale / inertia
        elif powered:
            gain = torque_per_volt(plant) * scale / inertia
            rate[0][6] = gain
            rate[0][0] -= gain * back_volts(plant)
    if powered and is_electrical(plant):
        rate[1][1] = -plant.resistance / plant.inductance
        rate[1][0] = -plant.torque_constant / (scale * plant.inductance)
        rate[1][6] = plant.amplifier_gain / plant.inductance
    if is_coupled(plant):
        rate[2][6 + 2] = 1.0
    if joined:
        for line, mass, sign in ((0, inertia, -1.0), (2, plant.load_inertia, 1.0)):
            if line == 0 and stuck:
                continue
            rate[line][3] += sign * plant.coupling_stiffness / mass
            rate[line][0] += sign * plant.coupling_damping / mass
            rate[line][2] -= sign * plant.coupling_damping / mass
    if is_coupled(plant):
        rate[3][0], rate[3][2] = (0.0 if stuck else 1.0), -1.0
    rate[4][0], rate[5][2] = 1.0, 1.0
    result = exponential([[value * step for value in line] for line in rate])
    columns = (0, 1, 2, 3, 6, 7, 8)
    lines = {0: result[0], 1: result[1], 2: result[2], 3: result[4], 4: result[5]}
    if not powered:
        lines[1] = [0.0] * 9
    if stuck:
        lines[0] = lines[3] = [0.0] * 9
    if not is_coupled(plant):
        lines[2] = lines[4] = [0.0] * 9
    return tuple(lines[line][column] for line in range(layout.MATRIX_ROWS) for column in columns)


def substeps(plant: Plant, period: float) -> int:
    """How finely a sample is cut so that contact and friction change in time."""
    if plant.coulomb_friction == 0.0 and plant.backlash == 0.0:
        return 1
    if not is_coupled(plant):
        return 4
    stiffness = plant.coupling_stiffness * (1.0 / plant.inertia + 1.0 / plant.load_inertia)
    return min(32, max(4, math.ceil(math.sqrt(stiffness) * period / 0.2)))


def write_general(state: State, b: int, plant: Plant, period: float) -> None:
    """Fills in the matrices of a machine with a coupling or an electrical time constant."""
    scale = counts_per_radian(plant)
    steps = substeps(plant, period)
    state[b + layout.SUBSTEPS] = steps
    state[b + layout.CURRENT_A] = plant.torque_constant * scale / motor_inertia(plant) if is_electrical(plant) else 0.0
    if is_coupled(plant):
        state[b + layout.LOAD_GAIN_A] = torque_per_volt(plant) * scale / plant.load_inertia
        state[b + layout.COUPLING_A] = plant.coupling_stiffness / plant.inertia
        state[b + layout.COUPLING_DAMPING_A] = plant.coupling_damping / plant.inertia
    for regime in range(layout.REGIMES):
        if regime & layout.REGIME_STUCK and plant.coulomb_friction == 0.0:
            continue
        if regime & layout.REGIME_APART and not (is_coupled(plant) and plant.backlash > 0.0):
            continue
        place = b + layout.MATRICES + layout.MATRIX_LENGTH * regime
        for offset, value in enumerate(regime_matrix(plant, regime, period / steps)):
            state[place + offset] = value


def write_period(state: State, b: int, plant: Plant, period: float) -> None:
    """Everything that depends on the length of a sample."""
    rate = plant.viscous_friction / motor_inertia(plant)
    decay, gain_v, gain_x = decay_terms(rate, period)
    state[b + layout.COAST_DECAY], state[b + layout.COAST_V], state[b + layout.COAST_X] = decay, gain_v, gain_x
    powered = rate + state[b + layout.GAIN_A] * back_volts(plant)
    decay, gain_v, gain_x = decay_terms(powered, period)
    state[b + layout.DECAY], state[b + layout.GAIN_V], state[b + layout.GAIN_X] = decay, gain_v, gain_x
    if state[b + layout.GENERAL]:
        write_general(state, b, plant, period)


def write_plant(state: State, b: int, plant: Plant, period: float) -> None:
    """Describes the machine of one axis to the sample loop."""
    scale, inertia = counts_per_radian(plant), motor_inertia(plant)
    kinds = {Drive.CURRENT: layout.DRIVE_CURRENT, Drive.VELOCITY: layout.DRIVE_VELOCITY}
    kinds[Drive.STEPPER] = layout.DRIVE_STEPPER
    kinds[Drive.VOLTAGE] = layout.DRIVE_VOLTAGE if is_electrical(plant) else layout.DRIVE_VELOCITY
    amperes_per_volt = plant.amplifier_gain / (plant.resistance if plant.drive is Drive.VOLTAGE else 1.0)
    home = plant.home_switch or (NEVER, -NEVER)
    enabling = {Enable.NONE: 0.0, Enable.WIRED: 1.0, Enable.ALWAYS: 2.0}
    sources = {Place.MOTOR: 0.0, Place.LOAD: 1.0, Place.EXTERNAL: 2.0}
    values = {
        layout.DRIVE: kinds[plant.drive],
        layout.GENERAL: 1.0 if is_coupled(plant) or is_electrical(plant) else 0.0,
        layout.GAIN_A: torque_per_volt(plant) * scale / inertia,
        layout.BACK_V: back_volts(plant),
        layout.FRICTION_A: plant.coulomb_friction * scale / inertia,
        layout.GRAVITY: plant.gravity,
        layout.PEAK_VOLTS: plant.peak_current / amperes_per_volt,
        layout.PEAK_CURRENT: plant.peak_current,
        layout.RIPPLE: plant.torque_ripple,
        layout.RIPPLE_SCALE: 6.0 * layout.SINE_LENGTH / plant.magnetic_cycle,
        layout.NOISE: plant.encoder_noise,
        layout.DELAY: plant.delay_samples,
        layout.HALF_BACKLASH: 0.5 * plant.backlash,
        layout.MAIN_ON_LOAD: 1.0 if plant.main is Place.LOAD else 0.0,
        layout.AUXILIARY_SOURCE: sources[plant.auxiliary],
        layout.AUXILIARY_RATIO: plant.auxiliary_ratio,
        layout.HOME_FROM: home[0],
        layout.HOME_TO: home[1],
        layout.FORWARD_SWITCH: NEVER if plant.forward_limit is None else plant.forward_limit,
        layout.REVERSE_SWITCH: -NEVER if plant.reverse_limit is None else plant.reverse_limit,
        layout.INDEX_AT: plant.index_at,
        layout.REVOLUTION: 4.0 * plant.encoder_lines,
        layout.SUBSTEPS: 1.0,
        layout.WIRING: -1.0 if plant.motor_reversed else 1.0,
        layout.ENABLING: enabling[plant.amplifier_enable],
        layout.DEAD_CHANNEL: float(" ab".index(plant.dead_channel or " ")),
        layout.LIMITS_SWAPPED: float(plant.limits_swapped),
        layout.HOME_STUCK: float(plant.home_stuck),
    }
    for slot, value in values.items():
        state[b + slot] = value
    write_period(state, b, plant, period)
