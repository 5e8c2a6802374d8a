"""Controller types: what each one has and where its limits lie."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

Family = Literal["ssc", "dmc141x", "smartmotor"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Model:
    """One controller type; lengths in characters, speeds in counts/s, times in microseconds."""

    name: str
    title: str
    family: Family
    axes: str
    inputs: int
    outputs: int
    analog_inputs: int
    lines: int
    columns: int
    labels: int
    variables: int
    arrays: int
    elements: int
    threads: int
    recorded_channels: int
    subroutine_levels: int
    tm_min_us: int
    servo_max_counts_s: int
    stepper_max_counts_s: int
    bauds: tuple[int, ...]
    default_baud: int
    latch_inputs: tuple[int, ...]
    coordinated: bool
    commutation: bool
    op_max: int
    gear_master: str
    address: Literal["jumpers", "SA"]
    power_up_motor_on: bool = False
    missing: frozenset[str] = frozenset()


# l.N: lines of the manuals. SSC lines 24-60, 1170-1190, 1923-1930; labels and variables 254 are recall.
_SSC1 = Model(
    name="ssc1",
    title="SSC, one axis",
    family="ssc",
    axes="X",
    inputs=8,
    outputs=8,
    analog_inputs=7,
    lines=1000,
    columns=80,
    labels=254,
    variables=254,
    arrays=30,
    elements=8000,
    threads=4,
    recorded_channels=4,
    subroutine_levels=8,
    tm_min_us=250,
    servo_max_counts_s=8_000_000,
    stepper_max_counts_s=2_000_000,
    bauds=(300, 1200, 4800, 9600, 19200, 38400),
    default_baud=9600,
    latch_inputs=(1,),
    coordinated=False,
    commutation=False,
    op_max=255,
    gear_master="any axis, GA",
    address="jumpers",
)
_SSC2 = replace(
    _SSC1, name="ssc2", title="SSC, two axes", axes="XY", tm_min_us=375, latch_inputs=(1, 2), coordinated=True
)
_SSC3 = replace(
    _SSC1, name="ssc3", title="SSC, three axes", axes="XYZ", tm_min_us=500, latch_inputs=(1, 2, 3), coordinated=True
)
_SSC4 = replace(
    _SSC1, name="ssc4", title="SSC, four axes", axes="XYZW", tm_min_us=500, latch_inputs=(1, 2, 3, 4), coordinated=True
)

# dmc-1412-1414.txt: chapters 1, 2, 4, 7 and the appendix; motor on at power-up (l.832).
_DMC1412 = Model(
    name="dmc1412",
    title="DMC-1412, one axis, sine commutation",
    family="dmc141x",
    axes="X",
    inputs=7,
    outputs=3,
    analog_inputs=2,
    lines=250,
    columns=40,
    labels=126,
    variables=126,
    arrays=6,
    elements=1000,
    threads=2,
    recorded_channels=2,
    subroutine_levels=8,
    tm_min_us=250,
    servo_max_counts_s=8_000_000,
    stepper_max_counts_s=2_000_000,
    bauds=(1200, 9600, 19200, 38400),
    default_baud=19200,
    latch_inputs=(1,),
    coordinated=False,
    commutation=True,
    op_max=7,
    gear_master="auxiliary encoder",
    address="SA",
    power_up_motor_on=True,
    missing=frozenset("LM LI LE VM VP CR VE VS VA VD VR VT ES TN CS AV GA EA".split()),  # noqa: SIM905
)
_DMC1414 = replace(_DMC1412, name="dmc1414", title="DMC-1414, one axis, internal amplifier", commutation=False)

# The SmartMotor speaks another language: none of the two-letter limits apply.
_SMARTMOTOR = Model(
    name="smartmotor",
    title="SmartMotor, firmware 4.76",
    family="smartmotor",
    axes="X",
    inputs=7,
    outputs=7,
    analog_inputs=7,
    lines=0,
    columns=0,
    labels=0,
    variables=0,
    arrays=0,
    elements=0,
    threads=1,
    recorded_channels=0,
    subroutine_levels=0,
    tm_min_us=0,
    servo_max_counts_s=0,
    stepper_max_counts_s=0,
    bauds=(9600,),
    default_baud=9600,
    latch_inputs=(),
    coordinated=False,
    commutation=False,
    op_max=127,
    gear_master="",
    address="SA",
)

MODELS: dict[str, Model] = {each.name: each for each in (_SSC1, _SSC2, _SSC3, _SSC4, _DMC1412, _DMC1414, _SMARTMOTOR)}


def model(name: str) -> Model:
    """The model of that name; the KeyError tells which names there are."""
    try:
        return MODELS[name.lower()]
    except KeyError:
        raise KeyError(f"no controller model {name!r}; the models are {', '.join(MODELS)}") from None
