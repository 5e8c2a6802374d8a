"""Settings of power-up, burning and motion."""

from __future__ import annotations

from dataclasses import dataclass

from device.simulator.twoletter.profile_language import LanguageSettings
from device.simulator.twoletter.setting import BURNING, FACTORY, LIMITS, MOTION, PROGRAM, SEQUENCE, fact


@dataclass(frozen=True, slots=True)
class MotionSettings(LanguageSettings):
    """Power-up, burning, motion."""

    # ----------------------------------------------------- power-up, burning
    leading_zeros_removed: int = fact(
        0, "LZ after a master reset", "inferred", choices=(0, 1), rows=("LZ",), unseen=FACTORY
    )
    echo: int = fact(0, "EO after a master reset", "recall", choices=(0, 1), rows=("EO",), unseen=FACTORY)
    mark: int = fact(2, "first field of CW after a master reset", "recall", choices=(1, 2), unseen=FACTORY)
    port_two_baud: int = fact(
        9600,
        "speed of port 2 after a master reset",
        "recall",
        unit="baud",
        choices=(300, 1200, 4800, 9600, 19200, 38400),
        rows=("CC",),
        unseen=FACTORY,
    )
    burn_parameters_ms: int = fact(250, "BN", "SSC manual l.1941", unit="ms", rows=("BN",), unseen=BURNING)
    burn_program_ms: int = fact(2000, "BP, up to 10 s", "recall", unit="ms", rows=("BP",), unseen=BURNING)
    burn_variables_ms: int = fact(1000, "BV, up to 2 s", "recall", unit="ms", rows=("BV",), unseen=BURNING)
    burns_outputs: bool = fact(True, "BN keeps the outputs", "recall", unseen=BURNING)
    reset_ms: int = fact(
        1000,
        "from RS to the prompt",
        "recall",
        unit="ms",
        rows=("RS", "^R^S"),
        unseen="needs a reset, which stops programs and switches outputs",
    )

    # ------------------------------------------------------- programs, motion
    interrupt_once: bool = fact(
        True, "II: after #ININT was called once, RI enables it again", "recall", rows=("II", "RI"), unseen=PROGRAM
    )
    end_fields: str = fact(
        "trippoint,interrupt",
        "EN m,n at the end of #COMINT",
        "recall",
        choices=("trippoint,interrupt", "interrupt,trippoint"),
        rows=("EN", "RE"),
        unseen=PROGRAM,
    )
    abort_keeps_programs: int = fact(
        1, "argument of AB that leaves the programs", "recall", choices=(0, 1), rows=("AB",), unseen=MOTION
    )
    limits_follow_level: bool = fact(
        False, "with CN 1, TS shows limit levels instead of 'not active'", "inferred", unseen="needs CN 1", rows=("CN",)
    )
    edge_direction: str = fact(
        "table",
        "FE: forward where _HM is 0, or the other way round",
        "dmc-1412-1414.txt l.2341-2346; the sentence at l.1145 contradicts",
        choices=("table", "sentence"),
        unseen=MOTION,
    )
    velocity_feed_v: float = fact(
        1.22e-6, "FV: volts for 1 count/s at FV 1", "recall", unit="V", rows=("FV",), unseen=MOTION
    )
    acceleration_feed_v: float = fact(
        1.5e-7, "FA: volts for 1 count/s² at FA 1", "recall", unit="V", rows=("FA",), unseen=MOTION
    )
    target_beyond_limit: str = fact(
        "not refused",
        "a target behind FL or BL: where it is refused, or that the move runs and stops at the limit",
        "SSC manual l.2605 (stops); dmc-1412-1414.txt l.4135 (not accepted; the code is inferred)",
        choices=("not refused", "PA, PR, IP: error 6", "PA, PR, IP: error 22", "BG, IP: error 22"),
        unseen=LIMITS,
    )
    begins_as_a_whole: bool = fact(
        True, "BG of several axes starts none when one cannot start", "inferred", unseen=MOTION
    )
    home_speed: str = fact(
        "SP",
        "speed of HM's first stage",
        "recall; dmc-1412-1414.txt l.2323 says JG or SP",
        choices=("SP", "last of JG and SP", "JG"),
        unseen=MOTION,
    )
    index_speed: str = fact(
        "last of JG and SP",
        "speed of FI",
        "SSC manual l.1307 says SP, l.2074 looks at JG",
        choices=("last of JG and SP", "SP", "JG"),
        unseen=MOTION,
    )
    home_end: str = fact(
        "at once",
        "how HM stops at the index",
        "dmc-1412-1414.txt l.2334; SSC manual l.1311: decelerates",
        choices=("at once", "decelerates"),
        unseen=MOTION,
    )
    reference_rounding: str = fact(
        "nearest", "RP of a place between two counts", "inferred", choices=("nearest", "down"), unseen=MOTION
    )
    smoothing_tail: bool = fact(
        True, "a smoothed move ends at least a sample after its profile", "inferred from l.2305", unseen=MOTION
    )
    position_read: str = fact(
        "sample start",
        "TP and TE within a sample: what the servo used, or the encoder behind it",
        "inferred",
        choices=("sample start", "sample end"),
        unseen=MOTION,
    )
    distance_ends_with_move: bool = fact(
        True, "AD and AR also trip when the move ends before the distance", "recall", rows=("AD",), unseen=MOTION
    )
    limit_operand: str = fact(
        "level",
        "_LF and _LR with CN 1: the input's level, or 1 = not active as with CN -1",
        "recall",
        choices=("level", "not active"),
        rows=("_LF",),
        unseen="needs CN 1",
    )
    cam_follows: str = fact(
        "encoder",
        "place of the axis of EA that the cam follows",
        "recall",
        choices=("encoder", "commanded position"),
        rows=("EA",),
        unseen=MOTION,
    )
    plane_needs_tangent: bool = fact(
        False, "VM needs a third letter (N: no tangent axis)", "recall", rows=("VM",), unseen=SEQUENCE
    )
    ellipse: str = fact(
        "stretches",
        "ES m,n: the axis of the larger number goes further, or less far",
        "recall",
        choices=("stretches", "shrinks"),
        rows=("ES",),
        unseen=MOTION,
    )
    sequence_length: str = fact(
        "all segments",
        "_LE and _VE: of all segments, or of those not yet begun",
        "recall",
        choices=("all segments", "segments to come"),
        rows=("VE",),
        unseen=SEQUENCE,
    )
    empty_segment: str = fact(
        "error 30",
        "a segment of length 0",
        "inferred",
        choices=("error 30", "left out"),
        unseen=SEQUENCE,
    )
    tangent_turns: str = fact(
        "unwrapped",
        "TN: the angle goes on beyond 180 degrees, or jumps back by a turn",
        "inferred",
        choices=("unwrapped", "within half a turn"),
        unseen=MOTION,
    )
    segment_speed_stays: bool = fact(
        True, "the speed < n of a segment holds for those behind it", "inferred", unseen=MOTION
    )
    contour_full_code: int = fact(
        7,
        "error of CD typed while the record before it is not yet taken",
        "inferred",
        choices=(7, 18, 42),
        unseen=MOTION,
    )
    contour_untimed_code: int = fact(39, "error of CD before any DT", "inferred", choices=(39, 6), unseen=MOTION)
    phase_operand: str = fact(
        "degrees",
        "unit of BD and _BD",
        "recall",
        choices=("degrees", "counts"),
        rows=("BD",),
        unseen="sets the motor's commutation",
    )
