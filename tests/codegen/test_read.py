"""Sentences, problems, counts and warnings of single fields; the second language."""

from __future__ import annotations

# ruff: noqa: E501  (tables: one case a line)
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen import smartmotor
from codegen.docs import pages
from codegen.fields import AXES, Dimension
from codegen.generate import code, compiled
from codegen.instructions import (
    ALL,
    AccelDecel,
    BeginMotion,
    End,
    Home,
    Instruction,
    Jump,
    LoopRate,
    MotionParameters,
    Output,
    Print,
    Repeat,
    SingleAxisMove,
    StopMotion,
    Subroutine,
    TwoLetterCode,
    UserInterface,
    VariableArray,
    Wait,
    WaitForCondition,
)
from codegen.instructions.configuration import Declare, ValueKind
from codegen.instructions.flow import EndOf, JumpIf, JumpKind, RepeatMode, Routine
from codegen.instructions.following import (
    Aborted,
    AbortMotion,
    DisableGearing,
    ElectronicGearing,
    IncrementalPosition,
    Master,
)
from codegen.instructions.io import OutputMode
from codegen.instructions.limits import FollowingError, Integrator, MotorDisable, PositionLimits, TorqueLimit
from codegen.instructions.machine import (
    AnalogFeedback,
    ArmLatch,
    Burned,
    DedicatedInputs,
    DefinePosition,
    Drive,
    Encoder,
    Motor,
    Polarity,
    PositionFormat,
    Power,
    Register,
    WriteEeprom,
)
from codegen.instructions.motion import Beginning, Direction, Homing, MoveMode, WaitFor, Which
from codegen.instructions.operator import AnswerKind, ItemKind, Port, PrintItem, Shape
from codegen.instructions.records import (
    Baud,
    Communication,
    Interval,
    Link,
    PortMode,
    RecordData,
    Recording,
    Source,
    UserSetup,
)
from codegen.instructions.servo import DualLoop, FeedForward, Offset, PidGains
from codegen.instructions.tasks import (
    ClearScreen,
    Execute,
    Halted,
    HaltTask,
    Interrupt,
    InterruptInput,
    Interrupts,
    Levels,
    Terminal,
    ZeroStack,
)
from codegen.instructions.waits import Clock, Finished, Moving, Place, WaitKind
from codegen.models import MODELS
from codegen.read import counts_text, has_errors, problem_of, problems, sentence, shown, unit_text, warning_of
from codegen.setup import Axis, MotorType, Setup, Unit
from codegen.twoletter.commands import COMMANDS
from codegen.twoletter.fixed import scaled
from codegen.twoletter.nodes import Broken, Foreign
from codegen.twoletter.parse import parse_line
from tests.codegen.strategies import instructions

MM = Axis(unit=Unit.MM, counts_per_unit="1000", forward_limit="200", reverse_limit="0", maximum_speed="100")
SETUP = Setup(
    model="ssc4",
    axes=(Axis(counts_per_unit="4000"), MM, Axis(motor=MotorType.STEPPER_LOW, counts_per_unit="200"), Axis()),
    input_names=("", "", "Door", *[""] * 5),
    output_names=("Clamp", *[""] * 7),
)


@pytest.mark.parametrize(
    ("instruction", "said", "sent"),
    [
        (SingleAxisMove(distance="4", speed="2"), "Move X by 4 in at 2 in/s, then wait until the profile has ended", "PR 16000/SP 8000/BG X/AM X"),
        (
            SingleAxisMove(axis="Y", mode=MoveMode.TO, position="12.5", speed="20", wait=WaitFor.POSITION, time_out="500"),
            "Move Y to 12.5 mm at 20 mm/s, then wait until in position, at most 500 ms",
            "PA ,12500/SP ,20000/BG Y/TW ,500/MC Y",
        ),
        (SingleAxisMove(mode=MoveMode.AT, jog_speed="-3"), "Run X at -3 in/s", "JG -12000/BG X"),
        (
            SingleAxisMove(distance="1", acceleration="64", deceleration="128", smoothing="128", wait=WaitFor.NOTHING),
            "Move X by 1 in, accelerating at 64 in/s², decelerating at 128 in/s², smoothing 128",
            "PR 4000/AC 256000/DC 512000/IT 0.5/BG X",
        ),
        (SingleAxisMove(axis="Z", distance="1", smoothing="2", begin=False), "Move Z by 1 in, smoothing 2, prepared but not begun", "PR ,,200/KS ,,2"),
        (SingleAxisMove(distance="1", smoothing="255"), "Move X by 1 in, smoothing 255, then wait until the profile has ended", "PR 4000/IT 0.004/BG X/AM X"),
        (SingleAxisMove(distance="LEN*2"), "Move X by (LEN*2) in, then wait until the profile has ended", "PR LEN*2*4000/BG X/AM X"),
        (AccelDecel(acceleration=("64", "", "", "")), "Accelerate X at 64 in/s²", "AC 256000"),
        (
            AccelDecel(acceleration=("64", "512", "", ""), deceleration=("64", "", "", "")),
            "Accelerate X at 64 in/s², decelerate at 64 in/s²; accelerate Y at 512 mm/s²",
            "AC 256000,512000/DC 256000",
        ),
        (MotionParameters(speed=("2", "", "", "2")), "Set X and W to 2 in/s", "SP 8000,,,2"),
        (BeginMotion(axes="XZ"), "Begin motion of X and Z", "BG XZ"),
        (BeginMotion(which=Beginning.PATH), "Begin the path", "BG S"),
        (StopMotion(axes="XYZ"), "Stop X, Y and Z, then wait until it has stopped", "ST XYZ/AM XYZ"),
        (StopMotion(which=Which.MOTION, wait=False), "Stop all motion", "ST XYZWS"),
        (StopMotion(which=Which.EVERYTHING), "Stop all motion and the program", "ST"),
        (Home(axes="X", speed=("1", "", "", "")), "Find home of X (X at 1 in/s), then wait until it has ended", "SP 4000/HM X/BG X/AM X"),
        (
            Home(routine=Homing.INDEX, direction=Direction.REVERSE, speed=("0.1", "", "", ""), wait=False),
            "Find the index of X going backward (X at 0.1 in/s)",
            "JG -400/FI X/BG X",
        ),
        (Home(routine=Homing.EDGE, axes="XY", begin=False), "Find the edge of the home switch of X and Y, prepared but not begun", "FE XY"),
        (Output(output="Clamp"), "Turn output 1 (Clamp) on", "SB 1"),
        (Output(mode=OutputMode.CONDITION, output="2", condition="A>5"), "Turn output 2 on when A>5, else off", "OB 2,A>5"),
        (Output(mode=OutputMode.PORT, byte="$0F"), "Send $0F to the output port", "OP $0F"),
        (Wait(time="T"), "Wait T ms", "WT T"),
        (Wait(time="T*2", exactly=True), "Wait (T*2) ms", "WT (T*2*128)/125"),
        (Jump(target="A", kind=JumpKind.CALL), "Call A", "JS #A"),
        (Jump(target="A", when=JumpIf.INPUT, input="Door"), "Go to A if input 3 (Door) is high", "JP #A,@IN[3]=1"),
        (Jump(target="A", when=JumpIf.CONDITION, condition="(A<B)&(C<D)"), "Go to A if (A<B)&(C<D)", "JP #A,(A<B)&(C<D)"),
        (Subroutine(routine=Routine.LIMSWI), "Subroutine LIMSWI (when a limit switch is reached)", "#LIMSWI"),
        (End(of=EndOf.ERROR, keep=True), "End of error or limit subroutine, go on with an interrupted wait", "RE 1"),
        (End(of=EndOf.COMMUNICATION, restore=True), "End of communication interrupt, enable the interrupt again", "EN 0,1"),
        (Repeat(mode=RepeatMode.UNTIL, until="A>5"), "Repeat until A>5", "#R1/JP #R1,(A>5)=0"),
        (VariableArray(variable="NAME", holds=ValueKind.TEXT, text="ABC"), 'Variable NAME = "ABC"', 'NAME="ABC"'),
        (VariableArray(mode=Declare.ARRAY, array="POS", size="50"), "Array POS with 50 elements", "DM POS[50]"),
        (VariableArray(mode=Declare.FORMAT, digits="4", decimals="2", hexadecimal=True), "Show variables with 4 digits and 2 decimals, hexadecimal", "VF -4.2"),
        (VariableArray(mode=Declare.FREE, freed="POS"), "Free array POS", "DA POS[]"),
        (
            Print(
                port=Port.AUXILIARY,
                items=(PrintItem(text="V="), PrintItem(kind=ItemKind.VALUE, expression="V", shape=Shape.DECIMAL, digits="4", decimals="2")),
                same_line=True,
            ),
            'Print "V=", V on the auxiliary port, without a line end',
            'MG {P2}"V=",V{F4.2}{N}',
        ),
        (Print(items=(PrintItem(kind=ItemKind.CHARACTER, character="7"),)), "Print character 7", "MG {^7}"),
        (
            UserInterface(port=Port.AUXILIARY, prompt="Name", variable="N", answer=AnswerKind.TEXT),
            'Ask "Name" on the auxiliary port and keep the answer in N (6 characters)',
            'IN {P2}"Name",N{S6}',
        ),
        (WaitForCondition(axes=""), "Wait until all motion has ended", "AM"),
        (WaitForCondition(axes="XY"), "Wait until the motion of X and Y has ended", "AM XY"),
        (WaitForCondition(moving=Moving.PATH), "Wait until the path has ended", "AM S"),
        (WaitForCondition(finished=Finished.POSITION, time_out="200"), "Wait until the motion of X is in position, at most 200 ms", "TW 200/MC X"),
        (WaitForCondition(kind=WaitKind.SPEED, speed_axis="Y"), "Wait until Y is at speed", "AS Y"),
        (WaitForCondition(kind=WaitKind.SPEED, moving=Moving.PATH), "Wait until the path is at speed", "AS S"),
        (WaitForCondition(kind=WaitKind.CLOCK), "Start the clock", "AT 0"),
        (
            WaitForCondition(kind=WaitKind.CLOCK, clock=Clock.AFTER, time="40"),
            "Wait until the clock shows 40 ms (40 samples = 39.1 ms)",
            "AT 40",
        ),
        (
            WaitForCondition(kind=WaitKind.CLOCK, clock=Clock.AGAIN, time="40"),
            "Wait until the clock shows 40 ms, then start it again (40 samples = 39.1 ms)",
            "AT -40",
        ),
        (WaitForCondition(kind=WaitKind.POSITION, position="1"), "Wait until X passes 1 in", "AP 4000"),
        (WaitForCondition(kind=WaitKind.POSITION, place=Place.FORWARD, axis="Y", position="10"), "Wait until Y has gone forward to 10 mm", "MF ,10000"),
        (WaitForCondition(kind=WaitKind.POSITION, place=Place.START, distance="-1"), "Wait until X has gone -1 in from the start of the move", "AD 4000"),
        (WaitForCondition(kind=WaitKind.POSITION, place=Place.LAST, distance="1"), "Wait until X has gone 1 in from the last distance wait", "AR 4000"),
        (WaitForCondition(kind=WaitKind.POSITION, place=Place.PATH, path="2"), "Wait until the path has gone 2 in since the start or the last such wait", "AV 8000"),
        (WaitForCondition(kind=WaitKind.INPUT, input="Door"), "Wait until input 3 (Door) is high", "AI 3"),
        (AnalogFeedback(axes=("on", "off", "", "")), "Analog feedback: X on, Y off", "AF 1,0"),
        (ArmLatch(axes="XZ"), "Arm the position latch of X and Z", "AL XZ"),
        (DefinePosition(position=("1", "", "", "")), "The present main encoder position is X 1 in", "DP 4000"),
        (DefinePosition(register=Register.AUXILIARY, position=("", "2", "", "")), "The present auxiliary encoder position is Y 2 mm", "DE ,2000"),
        (Drive(axes="XY"), "Enable the drive of X and Y", "SH XY"),
        (Drive(power=Power.DISABLE), "Disable the drive of X", "MO X"),
        (Encoder(main=("pulse_reversed", "", "", ""), auxiliary=("", "quadrature_reversed", "", "")), None, "CE 3,8"),
        (Motor(types=("servo_reversed", "", "stepper_low_reversed", ""), off="X"), "Motors: X Servo, reversed, Z Stepper, active low, reversed; off at first: X", "MT -1,,2.5/MO X"),
        (PositionFormat(digits="6", decimals="2", leading_zeros=False), "Show positions with 6 digits and 2 decimals, without leading zeros", "PF 6.2/LZ 1"),
        (WriteEeprom(what=Burned.VARIABLES), "Write the variables to the EEPROM", "BV"),
        (DedicatedInputs(home=Polarity.HIGH), "Limit inputs active low, home inputs active high, latch inputs active low", "CN -1,1,-1"),
        (AbortMotion(), "Abort motion and program", "AB"),
        (AbortMotion(what=Aborted.MOTION), "Abort motion only", "AB 1"),
        (IncrementalPosition(distance=("", "-1", "", "")), "Shift the target of Y -1 mm", "IP ,-1000"),
        (ElectronicGearing(master=Master.COMMANDED, ratio=("", "-1.5", "", "")), "Gear to the commanded position of X: Y -1.5", "GA CX/GR ,-1.5"),
        (ElectronicGearing(master=Master.PATH, ratio=("", "", "", "2")), "Gear to the path: W 2", "GA S/GR ,,,2"),
        (DisableGearing(axes="YW"), "Let Y and W no longer follow", "GR ,0,,0"),
        (ClearScreen(port=Port.AUXILIARY, terminal=Terminal.HANDHELD), "Clear the screen of the operator terminal on the auxiliary port", 'MG {P2}{^27},"E"{N}'),
        (ClearScreen(), "Clear the screen of the terminal window", 'MG {^27},"[2J",{^27},"[H"{N}'),
        (Execute(label="WATCH", thread="2"), "Start WATCH in thread 2", "XQ #WATCH,2"),
        (HaltTask(thread="3"), "Halt thread 3", "HX 3"),
        (HaltTask(which=Halted.ALL), "Halt all threads", "HX"),
        (Interrupt(inputs=(InterruptInput(input="2"), InterruptInput(input="Door"))), "Let input 2 and 3 (Door) interrupt the program", "II 2,3"),
        (Interrupt(inputs=(InterruptInput(input="1"), InterruptInput(input="4"))), "Let input 1 and 4 interrupt the program", "II ,,9"),
        (Interrupt(which=Interrupts.NONE), "Let no input interrupt the program", "II 0"),
        (ZeroStack(), "Forget the last call", "ZS 1"),
        (ZeroStack(levels=Levels.ALL), "Forget all calls", "ZS 0"),
        (Communication(baud=Baud.B19200, echo=True), "Port 2 at 19200 baud, for messages and data, with echo", "CC 19200,0,0,1"),
        (Communication(mode=PortMode.CHAIN, handshake=True), "Port 2 at 9600 baud, with handshake, as a daisy chain", "CC 9600,1,1,0"),
        (Communication(what=Link.INTERRUPT), "Interrupt by characters: port 1 no interrupt, port 2 on Enter", "CI 0,1,0"),
        (
            RecordData(recordings=(Recording(array="POS", size="500"), Recording(array="INS", source=Source.INPUTS)), interval=Interval.MS8, count="100"),
            "Record position of X in POS; inputs in INS every 8 samples, 100 times",
            "DM POS[500]/RA POS[],INS[]/RD _TPX,_TI/RC 3,100",
        ),
        (
            RecordData(recordings=(Recording(array="POS", size="500"),), endless=True),
            "Record position of X in POS every 2 samples, over and over",
            "DM POS[500]/RA POS[]/RD _TPX/RC 1,-500",
        ),
        (DualLoop(axes=("on", "", "", "")), "Dual loop: X on", "DV 1"),
        (FeedForward(velocity=("10", "", "", ""), acceleration=("", "5.25", "", "")), "Feed forward: velocity X 10; acceleration Y 5.25", "FV 10/FA ,5.25"),
        (Offset(offset=("-0.5", "", "", "")), "Offset of the motor command X -0.5 V", "OF -0.5"),
        (PidGains(proportional=("20", "", "", ""), derivative=("100.125", "", "", "")), "PID gains: proportional X 20; derivative X 100.125", "KP 20/KD 100.125"),
        (FollowingError(error=("0.25", "", "", "")), "Allow a following error of X 0.25 in", "ER 1000"),
        (Integrator(limit=("5", "", "", ""), freeze=True), "Limit the integrator to X 5 V, frozen while moving", "IL -5"),
        (MotorDisable(axes=("on", "off", "", "")), "Motor off on error: X on, Y off", "OE 1,0"),
        (TorqueLimit(limit=("9.9982", "", "", "")), "Limit the motor command to X 9.9982 V", "TL 9.9982"),
        (
            PositionLimits(forward=("1.00019", "off", "", ""), reverse=("-1.00019", "", "off", "")),
            "Position limits: forward X 1.00019 in, Y off; reverse X -1.00019 in, Z off",
            "FL 4000,2147483647/BL -4000,,-2147483648",
        ),
    ],
)  # fmt: skip
def test_sentence_and_code(instruction: Instruction, said: str | None, sent: str | None) -> None:
    if said is not None:
        assert sentence(instruction, SETUP) == said
    if sent is not None:
        assert "/".join(code(instruction, SETUP)) == sent, problems(instruction, SETUP)


@pytest.mark.parametrize(
    ("instruction", "field", "message"),
    [
        (SingleAxisMove(distance="12,5"), "distance", "Distance: write 12.5"),
        (SingleAxisMove(distance="A+B*2"), "distance", "Distance: group it with brackets: (A+B)*2 or A+(B*2)"),
        (SingleAxisMove(axis="Y", distance="500"), "distance", "Distance must lie between -200 and 200 mm"),
        (SingleAxisMove(axis="Y", mode=MoveMode.TO, position="-1"), "position", "Position must lie between 0 and 200 mm"),
        (SingleAxisMove(axis="Y", distance="1", speed="101"), "speed", "Speed must lie between 0 and 100 mm/s"),
        (SingleAxisMove(distance="1", speed="0"), "speed", "Speed must be more than 0 in/s"),
        (SingleAxisMove(distance="1", speed="0.0001"), "speed", "Speed is too small: it would be sent as 0"),
        (SingleAxisMove(axis="Y", mode=MoveMode.AT, jog_speed="-101"), "jog_speed", "Speed must lie between -100 and 100 mm/s"),
        (SingleAxisMove(distance="1", wait=WaitFor.POSITION, time_out="40000"), "time_out", "At most must be at most 32767 ms"),
        (SingleAxisMove(axis="Z", distance="1", smoothing="9"), "smoothing", "Smoothing of a stepper must lie between 0.5 and 8"),
        (SingleAxisMove(distance='"A"'), "distance", "Distance must be a number, no text"),
        (SingleAxisMove(distance="SP*2"), "distance", "Distance: SP is a command of the controller, no variable"),
        (Output(output="9"), "output", "Output must lie between 1 and 8"),
        (Output(output="Gate"), "output", "Output: 'Gate' is neither a number nor a name of the setup"),
        (Wait(), "time", "Time is missing"),
        (Jump(target="lower"), "target", "Label must be a letter and up to 6 letters or digits, in capitals"),
        (VariableArray(variable="SP"), "variable", "Variable: SP is a command of the controller; choose another name"),
        (VariableArray(variable="TIME"), "variable", "Variable must be a letter and up to 7 letters or digits"),
        (VariableArray(mode=Declare.ARRAY, array="pos"), "array", "Array must begin with a capital letter"),
        (Home(axes="X", speed=("1", "2", "", "")), "speed", "Y has a speed but is not among the axes"),
        (Home(routine=Homing.INDEX), "speed", "X: Speed is missing (the index search needs it for its direction)"),
        (AccelDecel(), "acceleration", "Enter an acceleration or a deceleration for an axis"),
        (Print(items=(PrintItem(text='say "hi"'),)), "items", 'Items, row 1: Text: the controller cannot send "'),
        (TwoLetterCode(text="PR 1000\nqq 5"), "text", None),
        (TwoLetterCode(text="A" * 81), "text", "longer than the 80 characters of this controller"),
    ],
)  # fmt: skip
def test_problems(instruction: Instruction, field: str, message: str | None) -> None:
    (finding,) = problems(instruction, SETUP)
    assert finding.field == field and finding.severity == "error"
    if message is not None:
        assert finding.message == message
    assert code(instruction, SETUP) == ()


def test_the_setup_is_sent_as_its_instructions_would() -> None:
    """spec/instructions.md, User Setup Settings; empty values and axes the controller has not are left out."""
    axis = Axis(counts_per_unit="100", kp="20", kd="100", fv="5", smoothing="128", forward_limit="10", torque_limit="5")
    setup = (
        Setup(model="ssc2")
        .with_axis("X", axis)
        .with_axis("Y", Axis(motor=MotorType.STEPPER_HIGH, kp="3", off_on_error=False))
    )
    assert code(UserSetup(), setup) == ("KP 20", "KD 100", "FV 5", "IT 0.5", "FL 1000", "OE 1", "TL 5")
    rest = UserSetup(motors=True, encoders=True, pid=False, feed_forward=False, smoothing=False, limits=False)
    assert code(rest, setup) == ("MT 1,-2", "CE 0,0")
    assert sentence(rest, setup) == "Send from the machine's setup · motor types · encoders"


def test_every_smoothing_reaches_the_controller() -> None:
    """0 … 255 is the filter (256 - s)/256, and the controller keeps steps of 1/256 (spec/instructions.md, Smoothing)."""
    for amount in range(256):
        (_, text, *_) = code(SingleAxisMove(distance="1", smoothing=str(amount)), SETUP)
        stored = COMMANDS["IT"].stored(scaled(Fraction(text.removeprefix("IT "))))
        assert stored == scaled(Fraction(max(256 - amount, 1), 256)), text


@pytest.mark.parametrize("scale", ["0", "-5", "abc", "1000/0", "-1000/3", "1000/3/2", "1e3", "12,5"])
def test_no_number_leaves_with_an_unusable_scale(scale: str) -> None:
    """Every step that converts on the axis is a problem, also where an expression reads the axis."""
    setup = SETUP.with_axis("Y", Axis(counts_per_unit=scale))
    for instruction in (
        SingleAxisMove(axis="Y", distance="10"),
        SingleAxisMove(axis="X", distance="_TPY"),
        AccelDecel(acceleration=("", "10", "", "")),
        PositionLimits(forward=("", "10", "", "")),
        UserSetup(),
    ):
        assert compiled(instruction, setup).before == () and compiled(instruction, setup).errors
    assert code(SingleAxisMove(axis="X", distance="1"), setup)


def test_hidden_fields_do_not_count() -> None:
    move = SingleAxisMove(distance="1", position="nonsense!", mode=MoveMode.BY)
    assert not shown(move, "position") and problem_of(move, "position", SETUP) is None
    assert problems(move, SETUP) == ()


def test_counts_and_warnings() -> None:
    move = SingleAxisMove(distance="0.0007", speed="5")
    assert counts_text(move, "distance", SETUP) == "3 counts"
    assert warning_of(move, "distance", SETUP) == "Distance will really be 0.00075 in"
    assert counts_text(move, "speed", SETUP) == "20000 counts/s" and warning_of(move, "speed", SETUP) is None
    assert counts_text(SingleAxisMove(distance="LEN"), "distance", SETUP) == "LEN × 4000, rounded down to whole counts"
    ramps = AccelDecel(acceleration=("", "40", "", ""))
    assert counts_text(ramps, "acceleration", SETUP, "Y") == "39936 counts/s²"
    assert warning_of(ramps, "acceleration", SETUP, "Y") == "Acceleration will really be 39.936 mm/s²"
    assert unit_text(ramps, "acceleration", SETUP, "Y") == "mm/s²" and unit_text(move, "speed", SETUP) == "in/s"
    assert [finding.severity for finding in problems(ramps, SETUP)] == ["warning"]


def test_a_fast_index_search_is_advised_against() -> None:
    (finding,) = problems(Home(routine=Homing.INDEX, speed=("1", "", "", "")), SETUP)
    assert finding.severity == "warning" and "500 or less is advised" in finding.message


def test_what_a_model_cannot_do() -> None:
    small = Setup(model="dmc1412", axes=SETUP.axes)
    assert [finding.message for finding in compiled(BeginMotion(which=Beginning.PATH), small).errors]
    assert [
        finding.message
        for finding in compiled(WaitForCondition(kind=WaitKind.POSITION, place=Place.PATH, path="1"), small).errors
    ]
    assert (
        compiled(Output(mode=OutputMode.PORT, byte="200"), small).errors
        and not compiled(Output(mode=OutputMode.PORT, byte="7"), small).errors
    )
    assert compiled(LoopRate(period="250"), SETUP).errors and not compiled(LoopRate(period="250"), small).errors
    assert code(StopMotion(which=Which.EVERYTHING), small) == ("ST", "HX")


@given(
    instructions(),
    st.sampled_from([name for name, model in MODELS.items() if model.family != "smartmotor"]),
    st.sampled_from(["1", "637", "39.37", "0.01", "5000000"]),
    st.sampled_from(["1000", "500", "375", "20000"]),
    st.sampled_from(list(MotorType)),
)
def test_any_instruction_on_any_machine(
    instruction: Instruction, model: str, scale: str, period: str, motor: MotorType
) -> None:
    """Code or a problem, never a crash; and the code is what the controller's parser accepts."""
    axis = Axis(counts_per_unit=scale, motor=motor)
    setup = Setup(model=model, axes=(axis,) * 4, sample_us=period)
    made = compiled(instruction, setup)
    assert "\n" not in sentence(instruction, setup)
    if made.errors:
        assert code(instruction, setup) == ()
        return
    assert not has_errors(instruction, setup)
    for line in code(instruction, setup):
        assert len(line) <= setup.limits.columns
        assert not any(isinstance(node, Broken | Foreign) for node in parse_line(line).statements), line


# ------------------------------------------------------------- the second language


def test_smartmotor() -> None:
    """smartmotor-4.76.txt: a speed is counts/sample × 65536, a sample 245.76 µs; 2000 counts are a turn."""
    setup = Setup(model="smartmotor").with_axis("X", Axis(unit=Unit.OWN, unit_name="turns", counts_per_unit="2000"))
    lines = smartmotor.lines(SingleAxisMove(distance="10", speed="1", acceleration="25"), setup)
    speed = round(2000 * 245.76e-6 * 65536)
    acceleration = round(25 * 2000 * 245.76e-6**2 * 65536)
    assert lines == (f"A={acceleration}", "MP", f"V={speed}", "D=20000", "G", "TWAIT")
    assert abs(speed - 32212.578) < 1 and abs(acceleration - 25 * 7.9166433) < 1  # spec/smartmotor.md, 4
    assert smartmotor.lines(StopMotion(), setup) == ("X", "TWAIT")


def test_help_pages_are_complete(approve: bool) -> None:
    assert list(pages()) == [kind.title for kind in ALL]
    assert all("## Example" in text and "None" not in text for text in pages().values())


def test_own_dimension_of_axes() -> None:
    assert all(SETUP.factor(Dimension.TIME, letter) == 1 for letter in AXES)
