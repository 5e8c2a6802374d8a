"""Modes of the group Program Flow."""

from __future__ import annotations

from codegen.instructions import (
    AutoExecution,
    End,
    Execute,
    HaltTask,
    Interrupt,
    Jump,
    Label,
    Repeat,
    SingleAxisMove,
    Subroutine,
    Wait,
    ZeroStack,
)
from codegen.instructions.flow import EndOf, InputLevel, JumpIf, JumpKind, RepeatMode, Routine
from codegen.instructions.motion import MoveMode
from codegen.instructions.tasks import Halted, InterruptInput, Interrupts, Levels
from device.simulator.simulation import Simulation
from tests.codegen.modes.bench import MS, Mode, Steps, code
from tests.codegen.modes.oracles import at_once, both, close, sees, stands

COUNT = (code("N=N+1"),)
SEEN_LOW = "\n".join(f"A{number}=A{number}|(@IN[{number}]=0)" for number in (1, 3, 4))
UNTIL_HIGH = code("#LOW\nJP #LOW,@IN[2]=0")
ON = code("SB 4")  # what a step that is jumped over would do
HERE = Label(name="HERE")

JUMPS = (
    Mode(Label(name="HERE"), "Label HERE", sees(lambda b, a: "#HERE" in a.listing.text and a["_DL"] == b["_DL"] - 1)),
    Mode(
        Jump(target="HERE"),
        "Go to HERE",
        sees(lambda b, a: a["_OP"] == 0 and b["_OP"] == 8),
        then=(ON, HERE),
    ),
    Mode(
        Jump(kind=JumpKind.CALL, target="CUT"),
        "Call CUT",
        sees(lambda b, a: a["N"] == 1 and b["N"] == 0 and a["_OP"] == 8),  # and back again
        first=(code("N=0"),),
        then=(ON,),
        routines=((Subroutine(name="CUT"), (*COUNT, End())),),
    ),
    Mode(
        Jump(target="HERE", when=JumpIf.INPUT, input="2", level=InputLevel.LOW),
        "Go to HERE if input 2 is low",
        sees(lambda b, a: a["_OP"] == 0 and b["_OP"] == 8),
        then=(ON, HERE),
        world=((0, "in2", 0),),
    ),
    Mode(
        Jump(target="HERE", when=JumpIf.INPUT, input="2", level=InputLevel.HIGH),
        "Go to HERE if input 2 is high",
        sees(lambda b, a: a["_OP"] == 8),  # the input is low: it does not
        then=(ON, HERE),
        world=((0, "in2", 0),),
    ),
    Mode(
        Jump(target="HERE", when=JumpIf.CONDITION, condition="(A<2)&(B=5)"),
        "Go to HERE if (A<2)&(B=5)",
        sees(lambda b, a: a["_OP"] == 0 and b["_OP"] == 8),
        first=(code("A=1\nB=5"),),
        then=(ON, HERE),
    ),
)

REPEATS = (
    Mode(
        Repeat(count="7"),
        "Repeat 7 times",
        sees(lambda b, a: a["N"] == 7),
        first=(code("N=0"),),
        body=COUNT,
    ),
    Mode(
        Repeat(count="M-2"),
        "Repeat M-2 times",
        sees(lambda b, a: a["N"] == 0),  # a count of 0 does nothing
        first=(code("N=0\nM=2"),),
        body=COUNT,
    ),
    Mode(
        Repeat(mode=RepeatMode.UNTIL, until="N>=5"),
        "Repeat until N>=5",
        sees(lambda b, a: a["N"] == 10),  # once at least
        first=(code("N=9"),),
        body=COUNT,
    ),
    Mode(
        Repeat(mode=RepeatMode.WHILE, condition="N<5"),
        "Repeat while N<5",
        sees(lambda b, a: a["N"] == 5),
        first=(code("N=0"),),
        body=COUNT,
    ),
    Mode(
        Repeat(mode=RepeatMode.FOREVER),
        "Repeat for ever",
        sees(lambda b, a: a["N"] > 50 and a["_XQ0"] >= 0 and a["_OP"] == 0 and b["_OP"] == 8),
        first=(code("N=0"),),
        body=(*COUNT, Wait(time="5")),
        then=(ON,),
    ),
)


def routine(which: Routine, end: EndOf, extra: str = "", **more: bool) -> tuple[tuple[Subroutine, Steps], ...]:
    """A routine of the system that counts its calls in N."""
    return ((Subroutine(routine=which), (*COUNT, *((code(extra),) if extra else ()), End(of=end, **more))),)


LIMIT = SingleAxisMove(mode=MoveMode.AT, jog_speed="1")
SUBROUTINES = (
    Mode(
        Subroutine(name="CUT"),
        "Subroutine CUT",
        sees(lambda b, a: "#CUT" in a.listing.text and a["N"] == 0),  # only when it is called
        first=(code("N=0"),),
        body=(*COUNT, End()),
    ),
    Mode(
        Subroutine(routine=Routine.ININT),
        "Subroutine ININT (when an input interrupts)",
        sees(lambda b, a: a["N"] >= 1 and b["N"] == 0),  # again and again while the input is low
        first=(code("N=0\nII 2"),),
        body=(*COUNT, End(of=EndOf.INPUT)),
        world=((0.3, "in2", 0), (0.31, "in2", 1)),
    ),
    Mode(
        Subroutine(routine=Routine.MCTIME),
        "Subroutine MCTIME (when in-position takes too long)",
        sees(lambda b, a: a["N"] == 1 and a["_SCX"] == 99),
        first=(code("N=0\nTW 20\nKP 0;KD 0;TL 0\nPR 500;BGX"),),
        then=(code("MC X"),),
        body=(*COUNT, End()),
    ),
    Mode(
        Subroutine(routine=Routine.POSERR),
        "Subroutine POSERR (when the following error is too large)",
        sees(lambda b, a: a["N"] >= 1 and b["N"] == 0),
        first=(code("N=0\nER 100\nTL 0"),),
        then=(LIMIT,),
        body=(*COUNT, code("ST X\nER 16000"), End(of=EndOf.ERROR)),
    ),
    Mode(
        Subroutine(routine=Routine.LIMSWI),
        "Subroutine LIMSWI (when a limit switch is reached)",
        both(stands("X"), sees(lambda b, a: a["N"] >= 1 and b["N"] == 0)),
        first=(code("N=0"), LIMIT),
        body=(*COUNT, End(of=EndOf.ERROR)),
        world=((0.4, "fls_x", 0),),
    ),
    Mode(
        Subroutine(routine=Routine.CMDERR),
        "Subroutine CMDERR (when a command fails)",
        sees(lambda b, a: a["N"] == 1 and a["_OP"] == 8 and b["_OP"] == 0),
        first=(code("N=0\nM=9000000"),),
        fails=True,
        then=(code("SP M"), ON),  # too fast: error 6, and the program goes on
        body=(*COUNT, End()),
    ),
    Mode(
        Subroutine(routine=Routine.COMINT),
        "Subroutine COMINT (when a character arrives)",
        sees(lambda b, a: a["N"] == 1 and b["N"] == 0),
        first=(code("N=0\nCC 9600,0,0,0\nCI ,2"),),
        body=(*COUNT, End(of=EndOf.COMMUNICATION)),
        world=((0.3, "type2", "X"), (0.5, "type2", "Y")),  # not enabled again: the second does nothing
    ),
)

ENDS = (
    Mode(
        End(),
        "End of subroutine",
        sees(lambda b, a: a["_XQ0"] == -1 and b["_XQ0"] >= 0),  # nothing was called: the program ends
    ),
)


def interrupted(end: End, says: str, which: Routine, setup_code: str, world: object, kept: bool, again: int) -> Mode:
    """A wait of 600 samples that the routine interrupts after 0.2 s, and a second cause after 1 s."""
    holds = sees(lambda b, a: close(a["T3"] - a["T2"], 600 if kept else 200, 60) and a["N"] == again)
    return Mode(
        Subroutine(routine=which),
        f"Subroutine {which.value} ({says})",
        holds,
        first=(code(f"N=0\n{setup_code}"),),
        then=(code("T2=TIME\nWT 600\nT3=TIME"),),
        body=(*COUNT, *((UNTIL_HIGH,) if which is Routine.ININT else ()), end),
        world=world,  # type: ignore[arg-type]
        seconds=1.6,
    )


PULSES = ((0.2, "in2", 0), (0.21, "in2", 1), (1.0, "in2", 0), (1.01, "in2", 1))
TYPED = ((0.2, "type2", "X"), (1.0, "type2", "Y"))
WHEN_INPUT, WHEN_TYPED = "when an input interrupts", "when a character arrives"
KEEPING = (
    interrupted(End(of=EndOf.INPUT), WHEN_INPUT, Routine.ININT, "II 2", PULSES, False, 2),
    interrupted(End(of=EndOf.INPUT, keep=True), WHEN_INPUT, Routine.ININT, "II 2", PULSES, True, 2),
    interrupted(End(of=EndOf.COMMUNICATION), WHEN_TYPED, Routine.COMINT, "CI ,2", TYPED, False, 1),
    interrupted(End(of=EndOf.COMMUNICATION, keep=True), WHEN_TYPED, Routine.COMINT, "CI ,2", TYPED, True, 1),
    interrupted(End(of=EndOf.COMMUNICATION, restore=True), WHEN_TYPED, Routine.COMINT, "CI ,2", TYPED, False, 2),
)

TASKS = (
    Mode(
        Execute(label="WATCH", thread="2"),
        "Start WATCH in thread 2",
        both(at_once(), sees(lambda b, a: a["_XQ2"] >= 0 and b["_XQ2"] == -1 and a["N"] > 10 and b["N"] == 0)),
        first=(code("N=0"),),
        routines=((Subroutine(name="WATCH"), (*COUNT, code("WT 5\nJP #WATCH"), End())),),
    ),
    Mode(
        HaltTask(thread="2"),
        "Halt thread 2",
        sees(lambda b, a: a["_XQ2"] == -1 and b["_XQ2"] >= 0 and a["_XQ0"] >= 0),
        first=(code("N=0\nXQ #WATCH,2"), Wait(time="50")),
        routines=((Subroutine(name="WATCH"), (*COUNT, code("WT 5\nJP #WATCH"), End())),),
    ),
    Mode(
        HaltTask(which=Halted.ALL),
        "Halt all threads",
        sees(lambda b, a: a["_XQ2"] == -1 == a["_XQ0"] and b["_XQ2"] >= 0 and b["_XQ0"] >= 0),
        first=(code("N=0\nXQ #WATCH,2"), Wait(time="50")),
        routines=((Subroutine(name="WATCH"), (*COUNT, code("WT 5\nJP #WATCH"), End())),),
    ),
    Mode(
        Interrupt(inputs=(InterruptInput(input="START"), InterruptInput(input="4"))),
        "Let input 1 (START) and 4 interrupt the program",
        sees(lambda b, a: a["A1"] == a["A4"] == 1 and a["A3"] == b["A1"] == b["A4"] == 0),
        first=(code("A1=0\nA3=0\nA4=0"),),
        routines=((Subroutine(routine=Routine.ININT), (code(SEEN_LOW), End(of=EndOf.INPUT))),),
        world=(
            *((0.2, "in1", 0), (0.21, "in1", 1), (0.4, "in3", 0), (0.41, "in3", 1)),
            *((0.6, "in4", 0), (0.61, "in4", 1)),
        ),
    ),
    Mode(
        Interrupt(which=Interrupts.NONE),
        "Let no input interrupt the program",
        sees(lambda b, a: a["N"] == 0 and b["N"] >= 1),
        first=(code("N=0\nII 2"),),
        routines=routine(Routine.ININT, EndOf.INPUT),  # type: ignore[arg-type]
        world=((0.4, "in2", 0), (0.41, "in2", 1)),
    ),
    Mode(
        ZeroStack(levels=Levels.ALL),
        "Forget all calls",
        sees(lambda b, a: a["_ZS0"] == 0 and b["_ZS0"] == 2),
        first=(code("JS #ONE\n#ONE\nJS #TWO\n#TWO"),),
    ),
    Mode(
        ZeroStack(),
        "Forget the last call",
        sees(lambda b, a: a["_ZS0"] == 1 and b["_ZS0"] == 2),
        first=(code("JS #ONE\n#ONE\nJS #TWO\n#TWO"),),
    ),
    Mode(
        AutoExecution(),
        "Start this program when the controller is switched on",
        sees(lambda b, a: restarted(a) and not restarted(b)),
        first=(code("SB 4"),),
    ),
)


def restarted(seen: object) -> bool:
    """Burned, outputs off, switched off and on again: whether the program has run by itself."""
    simulation: Simulation = seen.simulation  # type: ignore[attr-defined]
    for line, ms in ((b"HX\r", 100), (b"CB 4\r", 100), (b"BP\r", 12_000), (b"RS\r", 4_000)):
        simulation.receive(1, line)
        simulation.advance(ms * MS)
    return bool(simulation.state()["outputs"] == 8)


MODES = (*JUMPS, *REPEATS, *SUBROUTINES, *ENDS, *KEEPING, *TASKS)
