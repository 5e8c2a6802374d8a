"""The slots of the one flat float64 vector that holds everything the sample loop knows.

`S[SLOT]` is global, `S[axis_base(i) + SLOT]` belongs to an axis. Suffixes: `_V` counts/s, `_A` counts/s², `_T` seconds.
Positions are counts, voltages volts, flags 0 or 1.
"""

from __future__ import annotations

from collections.abc import MutableSequence
from typing import TypeAlias

State: TypeAlias = MutableSequence[float]  # a memoryview of the vector in plain Python, the array itself when compiled

MAXIMUM_AXES = 4
SAMPLES_PER_SECOND = 1024  # at TM 1000: a speed of SP counts/s is SP/1024 counts a sample

# --- header -----------------------------------------------------------------------------------------------------------
(
    AXES,
    SAMPLE,  # samples run since power-up
    PERIOD_T,  # true length of a sample: TM / 1 024 000 s
    EVENTS,  # number of event bits raised and not yet taken, all axes
    WATCHES,  # entries of the watch table to look at (one past the highest used)
    TRIPS,  # watches that tripped in the last sample
    TRACE_CAPACITY,  # rows that still fit; 0: no trace
    TRACE_ROWS,
    TRACE_EVERY,
    TRACE_COUNTDOWN,
    RANDOM,  # state of the noise generator, 1..2**31-2
    ABORT_LEVEL,  # abort input; 0 is active
    ABORT_SEEN,
    INPUTS,  # byte as TI has it
    OUTPUTS,  # byte as OP has it (for the trace only)
    INPUT_1,  # eight levels, for watches
) = range(16)
ANALOG_1 = 24  # eight voltages
(
    CONTOUR_LEFT,  # samples left of the running record
    CONTOUR_BUFFERED,  # 1: a record waits (WC trips at 0)
    CONTOUR_LENGTH,  # samples of the waiting record; 0 ends the mode
    CONTOUR_ACTIVE,
    CAM_ON,
    CAM_MASTER,  # absolute slot of the master's position
    CAM_AXIS,  # axis the master belongs to
    CAM_AUXILIARY,  # 1: the master is that axis' auxiliary encoder
    CAM_CYCLE,
    CAM_INTERVAL,
    CAM_START,
    CAM_LAST,  # master position of the last sample
) = range(32, 44)
GUARDS, GUARD_BROKEN = range(44, 46)  # guards to look at; 1: one has been left (see GUARD)
(
    PATH_ACTIVE,  # 1: the sequence runs
    PATH_MOVING,  # 1 until its end is put out
    PATH_HEAD,  # number of the segment the profile is on, counted since LM/VM
    PATH_OUT_HEAD,  # number of the segment the smoothed point is on
    PATH_TAIL,  # segments given since LM/VM
    PATH_ENDED,  # 1: LE/VE given
    PATH_SPEED_V,  # VS
    PATH_AC_STEP,  # VA/1024
    PATH_DC_STEP,
    PATH_RATIO,  # VR
    PATH_SMOOTHING,  # VT
    PATH_V,
    PATH_TRAVELLED,  # counts since BGS
    PATH_SMOOTHED,  # the same behind the VT filter
    PATH_MARK,  # where the last AV tripped
    PATH_STOP_CODE,  # not 0: stopping with VD for this reason
    PATH_AT_SPEED,
    PATH_TOTAL,  # counts of all segments given
    PATH_FIRST,  # plane of VM
    PATH_SECOND,
    PATH_TANGENT,  # axis that follows the direction of travel, -1: none
    PATH_OPENED,  # 1 LM, 2 VM
    PATH_MEMBERS,  # bit a: axis a is one of LM's
    PATH_LAST_FIRST,  # end of the last segment given, before ES
    PATH_LAST_SECOND,
    PATH_HEADING,  # direction of travel there, degrees
    PATH_HEADING_KNOWN,
    PATH_SCALE_FIRST,  # ES
    PATH_SCALE_SECOND,
    PATH_TANGENT_SCALE,  # TN, counts a degree
    PATH_TANGENT_ZERO,
    PATH_FINISHED,  # 1: the sequence has ended; the next segment begins a new one
) = range(48, 80)

# --- watches: armed (0 free, 1 armed, 2 tripped), then two conditions (slot, operator, value), either trips ---
WATCH = 80
WATCH_STRIDE = 12
MAXIMUM_WATCHES = 64
W_STATE, W_SLOT, W_OPERATOR, W_VALUE, W_SLOT_2, W_OPERATOR_2, W_VALUE_2 = range(7)
W_KIND, W_AXIS, W_NUMBER = range(7, 10)  # as the host asked for it
W_FIRST, W_LEFT = range(10, 12)  # the first of those that must all trip; how many of them have not (in the first only)
NOT_LESS, NOT_MORE, EQUAL, NEVER = range(4)
CROSSING = 5  # the kind of watch (AP) whose direction is decided anew where positions are renamed

# --- guards: the loop ends after the sample in which a slot has left its range (slot, lowest, highest) ---
GUARD = WATCH + WATCH_STRIDE * MAXIMUM_WATCHES
GUARD_STRIDE = 3
MAXIMUM_GUARDS = 24

# --- one axis ---------------------------------------------------------------------------------------------------------
AXIS = GUARD + GUARD_STRIDE * MAXIMUM_GUARDS
(
    # registers, written by the host
    SPEED_V,
    AC_A,
    DC_A,
    AC_STEP,  # AC/1024: counts/s a sample
    DC_STEP,
    DC_HALF_INVERSE,  # 1 / (2 DC_STEP)
    JOG_V,
    SMOOTHING,
    STEP_SMOOTHING,  # KS
    STEP_FILTER,  # fraction of the way a step pulse output goes each sample
    KP,
    KI,
    KD,
    INTEGRATOR_LIMIT,
    TORQUE_LIMIT,
    OFFSET,
    VELOCITY_FEED,
    ACCELERATION_FEED,
    ERROR_LIMIT,
    OFF_ON_ERROR,
    FORWARD_SOFT,
    REVERSE_SOFT,
    MOTOR_TYPE,
    OUTPUT_SIGN,  # -1: MT -1
    STEPPER,  # 1: MT 2, 2.5 and their negatives
    ENCODER,  # CE
    ENCODER_SIGN,
    AUXILIARY_SIGN,
    DUAL_LOOP,
    ANALOG_FEEDBACK,
    LIMIT_ACTIVE_LEVEL,  # 0 with CN -1, 1 with CN +1
    GEAR_RATIO,
    GEAR_MASTER,  # absolute slot whose change is followed, -1: none
    GEAR_LAST,
    # profile
    MODE,
    MOVING,  # 1 until the profile is complete
    POSITION,  # commanded, before smoothing
    VELOCITY_V,  # commanded, before smoothing
    SMOOTHED,  # commanded, behind the IT filter
    REFERENCE,  # RP: SMOOTHED to the nearest count
    SMOOTHED_LAST,
    COMMANDED_V,  # change of SMOOTHED in this sample, counts/s
    COMMANDED_LAST_V,
    SLEW_V,  # signed speed of a homing stage
    TARGET,
    DIRECTION,
    POSITION_SHIFT,  # sum of all renamings
    TRAVEL,  # POSITION without renamings, for axes that follow it
    START,  # where the move began
    MARK,  # where the last AR or AD tripped
    DISTANCE,  # |POSITION - START|
    MARK_DISTANCE,  # |POSITION - MARK|
    AT_SPEED,
    STOP_CODE,
    STAGE,  # of FE, FI and HM
    STAGE_LEVEL,  # home input when the stage began
    LIMIT_NOW,  # 1: driven into an active forward limit, 2: reverse
    IN_POSITION,  # profile done and the encoder has reached or passed its end
    SETTLING,  # samples since the profile was done
    # servo
    MOTOR_ON,
    COUNTS,  # main encoder since power-up, sign of CE applied; DP does not change it
    COUNTS_BEFORE,  # COUNTS 256 samples ago
    MOVED,  # COUNTS less COUNTS_BEFORE: a quarter of TV
    COUNTS_SHIFT,  # ACTUAL = COUNTS + COUNTS_SHIFT
    ACTUAL,  # TP
    ERROR,  # TE
    LAST_ERROR,  # of the derivative's encoder
    INTEGRAL,  # volts
    COMMAND,  # volts, TT
    ERROR_HIGH,  # 1: |TE| > ER
    STEPS,  # TD of a stepper (behind the KS filter)
    STEPS_SMOOTH,
    STEPS_SHIFT,
    AUXILIARY,  # TD of a servo
    AUXILIARY_COUNTS,
    AUXILIARY_SHIFT,
    LATCH_ARMED,
    LATCHED,
    EVENT,  # bits, see below
    # switches
    FORWARD_LEVEL,
    REVERSE_LEVEL,
    HOME_LEVEL,
    FORWARD_FORCED,  # level from outside; the input reads 0 where either is 0
    REVERSE_FORCED,
    HOME_FORCED,
    # plant, constants
    DRIVE,
    GAIN_A,  # acceleration of the motor for one volt, counts/s²
    DECAY,  # simple plant, powered: velocity left after a sample
    GAIN_V,  # velocity after a sample for one count/s², and travel for one count/s
    GAIN_X,  # travel in a sample for one count/s²
    COAST_DECAY,  # the same with the amplifier off
    COAST_V,
    COAST_X,
    FRICTION_A,  # Coulomb friction as acceleration
    GRAVITY,  # volts
    BACK_V,  # volts taken off the command per count/s by tachometer or back EMF
    PEAK_VOLTS,  # peak current as volts of command in the current loop
    PEAK_CURRENT,
    RIPPLE,
    RIPPLE_SCALE,  # sine table entries a count
    NOISE,
    DELAY,
    DELAY_INDEX,
    GENERAL,  # 1: matrices (electrical time constant or two masses)
    SUBSTEPS,
    HALF_BACKLASH,
    COUPLING_A,  # motor acceleration for one count of twist
    LOAD_GAIN_A,  # acceleration of the load for one volt of gravity or disturbance
    CURRENT_A,  # acceleration of the motor for one ampere
    COUPLING_DAMPING_A,  # motor acceleration for one count/s of twist speed
    MAIN_ON_LOAD,
    AUXILIARY_SOURCE,  # 0 motor, 1 load, 2 outside
    AUXILIARY_RATIO,
    HOME_FROM,
    HOME_TO,
    FORWARD_SWITCH,
    REVERSE_SWITCH,
    INDEX_AT,
    REVOLUTION,  # 4N
    # plant, state
    MOTOR_X,
    MOTOR_V,
    CURRENT,
    LOAD_X,
    LOAD_V,
    OUTSIDE_X,  # external auxiliary encoder
    OUTSIDE_V,
    DISTURBANCE,  # volts, positive pushes forward
    RAW,  # main encoder since power-up, sign of the machine
    RAW_LAST,
    # contour, cam, path
    CONTOUR_STEP,
    CONTOUR_NEXT,
    IN_CONTOUR,
    CAM_ENGAGED,  # 0 off, 1 follows
    CAM_WAITS,  # 1: changes over to CAM_NEXT when the master passes CAM_AT forwards
    CAM_NEXT,
    CAM_AT,
    CAM_NET,  # change of the slave in a cycle, with its sign
    PATH_MEMBER,  # 1: an axis of the path, 2: the tangent axis
    PATH_ORIGIN,  # POSITION at BGS
    PATH_END,  # coordinate at the end of the last segment given
    PATH_POINT,  # coordinate at the end of the last finished segment
    # sine commutation
    PHASE_MODE,  # 0: none, 1: the command turns with the phase, 2: a field held still
    PHASE_ZERO,  # COUNTS where the controller takes its phase to be 0
    PHASE_CYCLE,  # BM
    PHASE_HELD,  # direction of the held field, degrees
    PHASE_VOLTS,  # its strength
    PHASE_DAMPING,  # volts per count/s
    PHASE_CALIBRATE,  # 1: set the phase at the next hall transition
    PHASE_HALL_OFFSET,  # BB, degrees
    PHASE_HALLS,  # BI: first of three inputs, 0: none
    PHASE_OFFSET,  # BO: volts added to the second signal
    MAGNETIC_CYCLE,  # of the motor, counts
    MAGNETIC_ZERO,  # electrical angle of the motor at machine position 0, degrees
    WIRES_SWAPPED,
    HALL_FIRST,  # input the first hall sensor is wired to, 0: no sensors
    HALL_ANGLE,  # from commutation zero to the sensors' zero, degrees
    HALL_ORDER,  # which sensor is on the first, second and third of the inputs (three slots)
    HALL_ORDER_2,
    HALL_ORDER_3,
    HALL_SECTOR,  # 0..5 as the controller reads its inputs, -1: no valid pattern
    # how this controller is where the manuals leave it open
    HOME_V,  # speed of the first stage of HM, 0: SP
    HOME_RAMPED,  # 1: HM decelerates at the index
    REFERENCE_BIAS,  # 0.5: RP is the nearest count, 0: the one below
    SETTLES_AT_ONCE,  # 1: a smoothed move may end with its profile
    READ_LATE,  # 1: TP is the encoder at the end of the sample
    # faults of the wiring
    WIRING,  # sign with which the command reaches the motor
    ENABLING,  # 0: the amplifier is never on, 1: as the controller says, 2: always
    DEAD_CHANNEL,  # of the main encoder, 1: A, 2: B; 0: none
    LIMITS_SWAPPED,
    HOME_STUCK,
) = range(170)
DELAY_RING = 170
MAXIMUM_DELAY = 32
HISTORY = DELAY_RING + MAXIMUM_DELAY  # COUNTS of the last 256 samples, for TV
HISTORY_LENGTH = 256
MATRICES = HISTORY + HISTORY_LENGTH  # regimes of the general plant
MATRIX_ROWS = 5  # motor v, current, load v, motor travel, load travel
MATRIX_COLUMNS = 7  # motor v, current, load v, twist, volts, motor acceleration, load acceleration
MATRIX_LENGTH = MATRIX_ROWS * MATRIX_COLUMNS
REGIME_APART, REGIME_STUCK, REGIME_OFF = (
    1,
    2,
    4,
)  # bits: parts apart, motor held by friction, no power
REGIMES = 8
STRIDE = MATRICES + MATRIX_LENGTH * REGIMES

# --- tables behind the axes -------------------------------------------------------------------------------------------
SINE = AXIS + STRIDE * MAXIMUM_AXES
SINE_LENGTH = 1024  # one period; one entry more closes it
CAM = SINE + SINE_LENGTH + 1  # 257 entries of four axes
CAM_LENGTH = 257
SEGMENTS = CAM + CAM_LENGTH * MAXIMUM_AXES
SEGMENT_STRIDE = 16
MAXIMUM_SEGMENTS = 1024  # a ring; 511 may wait, the smoothed point may lag behind the profile
WAITING_SEGMENTS = 511
(
    G_ARC,  # 0 line, 1 arc
    G_LENGTH,
    G_END,  # way from the start of the sequence to the end of this segment
    G_SPEED_V,  # `< n`, -1: none
    G_TANGENT,  # of the tangent axis at the start of the segment, and its change a count
    G_TANGENT_SLOPE,
    G_START,  # four coordinates: start of a line, centre of an arc
) = range(7)
G_DIRECTION = 10  # line: change of four coordinates a count; arc: radius of either axis, first angle, degrees a count
SIZE = SEGMENTS + SEGMENT_STRIDE * MAXIMUM_SEGMENTS

# --- values -----------------------------------------------------------------------------------------------------------
MODE_IDLE, MODE_POSITION, MODE_JOG, MODE_STOPPING, MODE_SETTLING, MODE_CONTOUR, MODE_PATH = range(7)
(
    STAGE_NONE,
    STAGE_EDGE,  # FE: slews until the home input changes
    STAGE_INDEX,  # FI: slews until the index pulse
    STAGE_HOME_SEARCH,
    STAGE_HOME_STOP,
    STAGE_HOME_BACK,
    STAGE_HOME_INDEX,
) = range(7)
EVENT_FORWARD_LIMIT, EVENT_REVERSE_LIMIT, EVENT_ERROR, EVENT_OFF, EVENT_HOMED, EVENT_ABORT = 1, 2, 4, 8, 16, 32
DRIVE_CURRENT, DRIVE_VOLTAGE, DRIVE_VELOCITY, DRIVE_STEPPER = range(4)
TRACE_COLUMNS_PER_AXIS = 4  # commanded, actual, velocity, torque
TRACE_EXTRA = 3  # sample first; inputs and outputs last
WRAP = 4294967296.0
HALF_WRAP = 2147483648.0


def axis_base(axis: int) -> int:
    """The slot where an axis begins."""
    return AXIS + STRIDE * axis


def slots(S: State, first: int, length: int) -> State:
    """Some of the vector, over the same memory (compiled: without counting references)."""
    return S[first : first + length]


def part(S: State, axis: int) -> State:
    """The slots of one axis."""
    return slots(S, AXIS + STRIDE * axis, STRIDE)


def trace_columns(axes: int) -> int:
    """Floats in one trace row: sample, four an axis, inputs, outputs."""
    return TRACE_EXTRA + TRACE_COLUMNS_PER_AXIS * axes
