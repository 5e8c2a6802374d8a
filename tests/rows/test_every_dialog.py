"""Whatever a dialog accepts: code that the checker accepts and that the simulated controller runs without an error."""

from __future__ import annotations

import dataclasses as dc
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from codegen.document import Document
from codegen.generate import generate
from codegen.instructions import (
    ALL,
    BeginMotion,
    ElectronicCam,
    End,
    Execute,
    Instruction,
    Label,
    RecordData,
    Subroutine,
    TwoLetterCode,
    VariableArray,
)
from codegen.instructions.curves import CamStep
from codegen.instructions.flow import EndOf
from codegen.instructions.motion import Beginning
from codegen.models import model
from codegen.program import Program, Step
from codegen.read import has_errors
from codegen.setup import Setup
from codegen.twoletter.check import check
from device.simulator.plant import Drive, Plant
from device.simulator.simulation import Simulation
from tests.codegen.modes.bench import MACHINE, ONE_UNIT
from tests.codegen.strategies import plain_items
from tests.long import count

KINDS = [kind for kind in ALL if not kind.needs]
TICKS = 1_024_000  # in a second
# what every instruction may name: labels, variables, arrays
KNOWN = TwoLetterCode(
    text="LEN=1\nCOUNT=1\nResult=1\nn=1\nA=1\nB=1\nC=1\nD=1\nI=1\nV1=1\nSPEED=1\nRC1=1\nDA POS[]\nDM POS[10]\nPOS[3]=1"
)
CAM = "EA X\nEM 1000,0\nEP 500,0\nET[0]=,0,0,0\nET[1]=,5,5,5\nET[2]=,0,0,0\nEB 1"


def prepared(instruction: Instruction) -> tuple[Instruction, ...]:
    """What has to be there first, as its help says."""
    if isinstance(instruction, ElectronicCam) and instruction.step in (CamStep.ENGAGE, CamStep.DISENGAGE):
        return (
            TwoLetterCode(
                text=CAM.replace("EA X", f"EA {instruction.master}").replace("EM 1000,0", _cycle(instruction))
            ),
        )
    if isinstance(instruction, BeginMotion) and instruction.which is Beginning.PATH:
        return (TwoLetterCode(text="VM XY\nVP 10,10\nVE"),)
    if getattr(instruction, "continues", False):
        letters = instruction.axes  # type: ignore[attr-defined]
        tangent = getattr(instruction, "tangent", "")
        plane = f"VM {letters}{tangent}\nVP 10,10"
        return (TwoLetterCode(text=plane if len(letters) == 2 else f"LM {letters}\nLI {_ones(letters)}"),)
    return ()


def _ones(letters: str) -> str:
    return ",".join("1" if each in letters else "" for each in "XYZW").rstrip(",")


def _cycle(cam: ElectronicCam) -> str:
    return "EM " + ",".join("1000" if letter == cam.master else "0" for letter in "XYZW")


def excused(instruction: Instruction) -> set[int]:
    """Error codes that depend on what else the program does, which no dialog can know."""
    if isinstance(instruction, Execute) and instruction.thread.strip() == "0":
        return {19}  # thread 0 runs already: the dialog warns
    if isinstance(instruction, RecordData) and any(not row.size for row in instruction.recordings):
        return {6, 66, 82}  # arrays that another instruction has to dimension, large enough
    if isinstance(instruction, VariableArray | RecordData):
        return {66}  # the ten elements of this program are in the way
    return set()


def program(instruction: Instruction, setup: Setup) -> Document:
    """The instruction where it may stand, with what it needs around it."""
    it = Step("it", instruction)
    first = Step("k", KNOWN)
    before = tuple(Step(f"p{number}", each) for number, each in enumerate(prepared(instruction)))
    texts = (getattr(instruction, name, None) for name in ("target", "label"))
    labels = [each for each in texts if isinstance(each, str) and each and not isinstance(instruction, Subroutine)]
    ends = tuple(Step(f"l{name}", Label(name=name)) for name in labels)
    routines: tuple[Step, ...] = ()
    main: tuple[Step, ...] = (it,)
    configuration: tuple[Step, ...] = ()
    if isinstance(instruction, Subroutine):
        main, routines = (), (Step("it", instruction),)
    elif isinstance(instruction, End):
        main = ()
        start = {EndOf.SUBROUTINE: "user"}.get(instruction.of)
        if start:
            routines = (Step("r", Subroutine(name="CUT"), body=(it,)),)
    elif instruction.section == "C":
        main, configuration = (), (it,)
    return Document(
        Program("P", configuration=configuration, main=(first, *before, *main, *ends), routines=routines), setup
    )


def _has_stepper(text: str) -> bool:
    """Whether the program makes an axis a stepper, which needs its jumper."""
    return any(line.startswith("MT") and "2" in line for line in text.split("\n"))


def errors_of(document: Document) -> list[Any]:
    """What the checker and the simulator have against a program."""
    listing = generate(document)
    assert listing.is_complete, listing.problems
    found: list[Any] = [
        (each.rule, each.message)
        for each in check(listing.text, model(document.setup.model))
        if each.severity == "error" and each.rule != "too-many-elements"
    ]
    steppers = dict.fromkeys("XYZW", Plant(drive=Drive.STEPPER)) if _has_stepper(listing.text) else {}
    simulation = Simulation(model(document.setup.model), steppers)
    for number in range(1, 9):
        simulation.stimulus(f"in{number}", 1)
    simulation.load_program(listing.text)
    simulation.execute(0, 0)
    simulation.advance(TICKS // 3)
    return found + [dict(each) for each in simulation.errors]


@settings(max_examples=count(120, 3000), suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much])
@given(
    st.sampled_from([kind for kind in ALL if not kind.needs]).flatmap(plain_items), st.sampled_from([MACHINE, ONE_UNIT])
)
def test_what_a_dialog_accepts_runs(instruction: Instruction, setup: Setup) -> None:
    setup = dc.replace(setup, input_names=("",) * 8, output_names=("",) * 8)
    document = program(instruction, setup)
    if has_errors(instruction, setup) or not generate(document).is_complete:
        return
    told = excused(instruction)
    found = [each for each in errors_of(document) if not (isinstance(each, dict) and each["code"] in told)]
    assert found == [], generate(document).text
