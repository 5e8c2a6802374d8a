"""Modes of the groups 2-Letter Code, Configuration, I/O, Servo Settings, System Limits and Mathematical Equation."""

from __future__ import annotations

import math

from codegen.instructions import (
    AccelDecel,
    AnalogFeedback,
    ArmLatch,
    Comment,
    DedicatedInputs,
    DefinePosition,
    Drive,
    DualLoop,
    Encoder,
    FeedForward,
    FollowingError,
    Integrator,
    LoopRate,
    MathematicalEquation,
    Motor,
    MotorDisable,
    Offset,
    Output,
    PidGains,
    PositionFormat,
    PositionLimits,
    SingleAxisMove,
    TorqueLimit,
    UserSetup,
    VariableArray,
    Wait,
    WriteEeprom,
)
from codegen.instructions.configuration import Declare, ValueKind
from codegen.instructions.io import Level, OutputMode
from codegen.instructions.machine import Burned, Polarity, Power, Register
from codegen.instructions.math import Equation
from codegen.instructions.motion import MoveMode
from codegen.setup import EncoderType, MotorType
from tests.codegen.modes.bench import FULL, Mode, Seen, code
from tests.codegen.modes.oracles import at_once, became, both, close, is_at, output, sees


def turned_round(seen: Seen) -> bool:
    """A home switch that reads high counts as not reached, one that reads low as reached (dmc-1412-1414.txt, HM)."""
    high = seen["_HMX"]
    seen.simulation.stimulus("home_x", 0)
    seen.known.clear()
    return (high, seen["_HMX"]) == (1, 0)


RUN = SingleAxisMove(mode=MoveMode.AT, jog_speed="1")
CONFIGURATION = (
    Mode(code("SP 7000;V1=3"), "Code: SP 7000;V1=3", both(became("_SPX", 7000), sees(lambda b, a: a["V1"] == 3))),
    Mode(
        AccelDecel(acceleration=("32", "", "", ""), deceleration=("", "64", "", "")),
        "Accelerate X at 32 in/s²; decelerate Y at 64 in/s²",
        both(became("_ACX", 128000), became("_DCY", 128000), sees(lambda b, a: a["_DCX"] == b["_DCX"])),
    ),
    Mode(
        AnalogFeedback(axes=("on", "", "", "")),
        "Analog feedback: X on",
        sees(lambda b, a: close(a["_TPX"], 0.5 * 2048, 2) and b["_TPX"] == 0),
        first=(),
        then=(code("MO X"),),
        world=((0, "an1", 5.0),),
    ),
    Mode(
        ArmLatch(axes="X"),
        "Arm the position latch of X",
        sees(lambda b, a: 2000 < a["_RLX"] < 3000 and b["_RLX"] == 0 and a["_ALX"] == 0),  # 0.6 s at 1 in/s
        then=(RUN,),
        world=((0.6, "in1", 0),),
    ),
    Mode(
        DefinePosition(position=("1.5", "", "-90", "")),
        "The present main encoder position is X 1.5 in, Z -90 deg",
        both(is_at("X", 1.5, 3), is_at("Z", -90, 3), sees(lambda b, a: b["_RPX"] == 0)),
    ),
    Mode(
        DefinePosition(register=Register.AUXILIARY, position=("", "2", "", "")),
        "The present auxiliary encoder position is Y 2 in",
        sees(lambda b, a: close(a["_TDY"], 4000, 3) and close(b["_TDY"], 0, 3) and a["_RPY"] == b["_RPY"]),
    ),
    Mode(
        Drive(power=Power.DISABLE, axes="XZ"),
        "Disable the drive of X and Z",
        both(became("_MOX", 1), became("_MOZ", 1)),
    ),
    Mode(
        Drive(axes="X"),
        "Enable the drive of X",
        both(became("_MOX", 0), sees(lambda b, a: a["_RPX"] == a["_TPX"] or abs(a["_RPX"] - a["_TPX"]) < 3)),
        first=(code("MO"),),
    ),
    Mode(
        Encoder(main=(EncoderType.QUADRATURE_REVERSED.value, "", "", "")),
        "Encoders: main X Quadrature, reversed",
        # turned by hand (motor off) the count goes the other way
        sees(lambda b, a: a["_TPX"] == -b["_TPX"] != 0),
        then=(code("MO X"),),
        world=((0.4, "position_x", 1000.0),),
    ),
    Mode(
        Encoder(auxiliary=("", EncoderType.PULSE.value, "", "")),
        "Encoders: auxiliary Y Pulse and direction",
        became("_CEY", 4),
    ),
    Mode(
        Motor(types=(MotorType.SERVO_REVERSED.value, "", "", ""), off="X"),
        "Motors: X Servo, reversed; off at first: X",
        both(became("_MTX", -1), became("_MOX", 1)),
    ),
    Mode(
        PositionFormat(digits="4", decimals="1"),
        "Show positions with 4 digits and 1 decimals, with leading zeros",
        sees(lambda b, a: a.typed("TPX").strip() == "0000.0" and b.typed("TPX").strip() == "0000000000"),
        then=(code("MO X\nDP 0"),),
    ),
    Mode(
        PositionFormat(digits="4", decimals="0", hexadecimal=True, leading_zeros=False),
        "Show positions with 4 digits and 0 decimals, hexadecimal, without leading zeros",
        sees(lambda b, a: a.typed("TPX").strip() == "$15" or a.typed("TPX").strip() == "$0015"),
        then=(code("MO X\nDP 21"),),
    ),
    Mode(
        UserSetup(motors=True, encoders=True),
        "Send from the machine's setup · motor types · encoders · gains · feed forward · smoothing · limits",
        both(
            *(became("_KPX", 9), became("_KIX", 1), became("_KDX", 70), became("_FVX", 3), became("_FAX", 2)),
            *(became("_ITX", 0.5, 0.01), became("_FLX", 20000), became("_BLX", -20000), became("_ERX", 2000)),
            *(became("_OEX", 1), became("_TLX", 8, 0.01), became("_ILX", 4, 0.01), became("_MTX", -1)),
            became("_CEX", 2),
        ),
        first=(),
        then=(),
        setup=FULL,
    ),
    Mode(
        UserSetup(pid=False, feed_forward=False, smoothing=False),
        "Send from the machine's setup · limits",
        both(became("_FLX", 20000), sees(lambda b, a: a["_KPX"] == b["_KPX"] and a["_ITX"] == b["_ITX"])),
        setup=FULL,
    ),
    Mode(
        UserSetup(feed_forward=False, smoothing=False, limits=False),
        "Send from the machine's setup · gains",
        both(became("_KPX", 9), sees(lambda b, a: a["_FVX"] == b["_FVX"] and a["_FLX"] == b["_FLX"])),
        setup=FULL,
    ),
    Mode(
        VariableArray(variable="LEN", number="-2.5"),
        "Variable LEN = -2.5",
        sees(lambda b, a: a["LEN"] == -2.5),
    ),
    Mode(
        VariableArray(variable="WHO", holds=ValueKind.TEXT, text="WIRE"),
        'Variable WHO = "WIRE"',
        sees(lambda b, a: a.typed("MG WHO{S6}") == "WIRE"),
    ),
    Mode(
        VariableArray(mode=Declare.ARRAY, array="POS", size="250"),
        "Array POS with 250 elements",
        sees(lambda b, a: b["_DM"] - a["_DM"] == 250),
    ),
    Mode(
        VariableArray(mode=Declare.FORMAT, digits="3", decimals="2"),
        "Show variables with 3 digits and 2 decimals",
        sees(lambda b, a: a.typed("V=").strip() == "007.50"),
        then=(code("V=7.5"),),
    ),
    Mode(
        VariableArray(mode=Declare.FORMAT, digits="4", decimals="0", hexadecimal=True),
        "Show variables with 4 digits and 0 decimals, hexadecimal",
        sees(lambda b, a: a.typed("V=").strip() == "$00FF"),
        then=(code("V=255"),),
    ),
    Mode(
        VariableArray(mode=Declare.FREE, freed="POS"),
        "Free array POS",
        sees(lambda b, a: a["_DM"] - b["_DM"] == 40),
        first=(code("DA POS[]\nDM POS[40]"),),
    ),
    Mode(
        WriteEeprom(),
        "Write the parameters to the EEPROM",
        sees(lambda b, a: after_reset(a, "_KPX") == 11 and after_reset(b, "_KPX") == 6),
        first=(code("KP 11"),),
    ),
    Mode(
        WriteEeprom(what=Burned.VARIABLES),
        "Write the variables to the EEPROM",
        sees(lambda b, a: after_reset(a, "LEN") == 5),
        first=(code("LEN=5"),),
        seconds=3,
    ),
    Mode(Comment(text="cut to length"), "' cut to length", sees(lambda b, a: a.listing.text == b.listing.text)),
    Mode(
        Comment(text="cut to length", in_code=True),
        "' cut to length",
        both(at_once(), sees(lambda b, a: "NO cut to length" in a.listing.text)),
    ),
)


def after_reset(seen: Seen, expression: str) -> float:
    """What the controller still knows when it is switched on again."""
    seen.simulation.receive(1, b"HX\rRS\r")
    seen.simulation.advance(4_000 * 1024)
    seen.known.clear()
    return seen[expression]


IO = (
    Mode(Output(output="3"), "Turn output 3 (CUTTER) on", output(3, True)),
    Mode(
        Output(output="CUTTER", level=Level.OFF),
        "Turn output 3 (CUTTER) off",
        output(3, False),
        first=(code("OP 255"),),
    ),
    Mode(
        Output(mode=OutputMode.CONDITION, output="2", condition="LEN>5"),
        "Turn output 2 on when LEN>5, else off",
        output(2, True),
        first=(code("LEN=6"),),
    ),
    Mode(
        Output(mode=OutputMode.CONDITION, output="2", condition="LEN>5"),
        "Turn output 2 on when LEN>5, else off",
        output(2, False),
        first=(code("LEN=5\nOP 255"),),
    ),
    Mode(Output(mode=OutputMode.PORT, byte="165"), "Send 165 to the output port", became("_OP", 165)),
    Mode(
        DedicatedInputs(limit=Polarity.HIGH, home=Polarity.HIGH, latch=Polarity.HIGH),
        "Limit inputs active high, home inputs active high, latch inputs active high",
        # nothing connected reads high: with active high that is a limit reached
        sees(lambda b, a: a["_HMX"] != b["_HMX"] and a["_RLX"] > 2000 and b["_RLX"] == 0),
        first=(code("AL X"),),
        then=(code("DP 2500"), Wait(time="100")),
        world=((0, "in1", 0), (0.3, "in1", 1)),
    ),
    Mode(
        DedicatedInputs(),
        "Limit inputs active low, home inputs active low, latch inputs active low",
        sees(lambda b, a: turned_round(a) and not turned_round(b)),
        first=(code("CN 1,1,1"),),
    ),
)

SERVO = (
    Mode(
        DualLoop(axes=("on", "", "", "")),
        "Dual loop: X on",
        became("_DVX", 1),
    ),
    Mode(
        FeedForward(velocity=("5", "", "", ""), acceleration=("2.5", "", "", "")),
        "Feed forward: velocity X 5; acceleration X 2.5",
        both(became("_FVX", 5), became("_FAX", 2.5)),
    ),
    Mode(
        LoopRate(period="2000"),
        "Run the control loop every 2000 µs",
        # 2 in/s stay 2 in/s though the controller counts other samples
        both(became("_TM", 2000), sees(lambda b, a: close(a["_TVX"], b["_TVX"] * 2, 0.15 * abs(a["_TVX"])))),
        then=(SingleAxisMove(mode=MoveMode.AT, jog_speed="1"),),
    ),
    Mode(
        LoopRate(period="1000", external=True),
        "Run the control loop every 1000 µs, from an external clock",
        # the simulator has no such clock, and says that it was asked for one
        sees(
            lambda b, a: (
                any("external sample clock" in each for each in a.simulation.notices) and not b.simulation.notices
            )
        ),
    ),
    Mode(
        Offset(offset=("1.5", "", "", "")),
        "Offset of the motor command X 1.5 V",
        both(became("_OFX", 1.5, 0.001), sees(lambda b, a: close(a["_TTX"], 1.5, 0.01))),
        then=(code("MO X"),),
    ),
    Mode(
        PidGains(proportional=("12", "", "", ""), integral=("2", "", "", ""), derivative=("100", "", "", "")),
        "PID gains: proportional X 12; integral X 2; derivative X 100",
        both(became("_KPX", 12), became("_KIX", 2), became("_KDX", 100)),
    ),
    Mode(FollowingError(error=("0.5", "", "", "")), "Allow a following error of X 0.5 in", became("_ERX", 2000)),
    Mode(Integrator(limit=("3", "", "", "")), "Limit the integrator to X 3 V", became("_ILX", 3, 0.001)),
    Mode(
        Integrator(limit=("3", "", "", ""), freeze=True),
        "Limit the integrator to X 3 V, frozen while moving",
        became("_ILX", -3, 0.001),
    ),
    Mode(
        MotorDisable(axes=("on", "", "", "")),
        "Motor off on error: X on",
        # the error limit of 100 counts is passed without torque: the motor goes off
        sees(lambda b, a: a["_MOX"] == 1 and b["_MOX"] == 0),
        first=(code("ER 100\nTL 0"),),
        then=(RUN,),
    ),
    Mode(
        PositionLimits(forward=("1", "", "", "off"), reverse=("-2", "", "", "")),
        "Position limits: forward X 1 in, W off; reverse X -2 in",
        both(became("_FLX", 4000), became("_BLX", -8000), sees(lambda b, a: 4000 <= a["_RPX"] < 4400 < b["_RPX"])),
        then=(SingleAxisMove(mode=MoveMode.AT, jog_speed="2"),),
        fails=False,
    ),
    Mode(
        TorqueLimit(limit=("0.5", "", "", "")),
        "Limit the motor command to X 0.5 V",
        both(became("_TLX", 0.5, 0.001), sees(lambda b, a: abs(a["_TTX"]) <= 0.501)),
    ),
)

MATH = (
    Mode(
        MathematicalEquation(
            equations=(Equation(variable="A", expression="@SQR[16]+1"), Equation(variable="B", expression="@SIN[30]*A"))
        ),
        "Set A = @SQR[16]+1; B = @SIN[30]*A",
        sees(lambda b, a: close(a["A"], 5, 0.001) and close(a["B"], 5 * math.sin(math.radians(30)), 0.001)),
    ),
)

MODES = (*CONFIGURATION, *IO, *SERVO, *MATH)
