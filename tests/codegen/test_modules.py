"""A module comes in with names of its own: what the two programs do stays what it was."""

from __future__ import annotations

import dataclasses as dc

import pytest

from codegen.document import Document
from codegen.generate import generate
from codegen.instructions import (
    AutoExecution,
    Comment,
    End,
    Instruction,
    Jump,
    Label,
    LoopRate,
    MathematicalEquation,
    Output,
    SingleAxisMove,
    Subroutine,
    TwoLetterCode,
    UserInterface,
)
from codegen.instructions.flow import JumpIf, JumpKind, Routine
from codegen.instructions.math import Equation
from codegen.instructions.motion import MoveMode
from codegen.models import model
from codegen.modules import Rename, imported, plan
from codegen.program import Place, Program, Section, Step
from codegen.setup import Axis, Setup, Unit
from device.simulator.simulation import Simulation

MM = Setup(model="ssc2", axes=(Axis(unit=Unit.MM, counts_per_unit="100"), *(Axis() for _ in "YZW")))


def main(*instructions: Instruction, setup: Setup = MM, routines: tuple[Step, ...] = ()) -> Document:
    steps = tuple(Step(f"s{number}", each) for number, each in enumerate(instructions, 1))
    return Document(Program("HOST", main=steps, routines=routines), setup)


def routine(name: str, *body: Instruction, which: Routine = Routine.USER) -> Step:
    steps = tuple(Step(f"{name}{number}", each) for number, each in enumerate(body))
    return Step(f"r{name}", Subroutine(name=name if which is Routine.USER else "", routine=which), body=steps)


def put(host: Document, module: Document, shared: frozenset[str] = frozenset()) -> Document:
    made = plan(host, module)
    assert not made.cannot
    return imported(host, made, Place(Section.MAIN, len(host.program.main)), shared)[0]


def code(document: Document) -> list[str]:
    listing = generate(document)
    assert [each.message for each in listing.problems if each.severity == "error"] == []
    return [line.text for line in listing.lines]


def test_a_label_that_is_used_in_both_becomes_another_also_where_it_is_jumped_to() -> None:
    host = main(Label(name="A"), Jump(target="A"))
    module = main(Label(name="A"), Jump(target="A"), TwoLetterCode(text="JP #A,V>1\n#A5;JP #A5"))
    assert plan(host, module).renames == (Rename("label", "A", "A2"),)
    assert code(put(host, module))[1:-1] == ["#A", "JP #A", "#A2", "JP #A2", "JP #A2,V>1", "#A5;JP #A5"]


def test_the_label_of_the_program_itself_is_taken_too() -> None:
    assert plan(main(Label(name="B")), main(Label(name="HOST"))).renames == (Rename("label", "HOST", "HOST2"),)


def test_new_names_keep_to_the_length_and_to_nobody_elses() -> None:
    host = main(Label(name="LONGEST"), Label(name="LONGES2"))
    assert plan(host, main(Label(name="LONGEST"))).renames == (Rename("label", "LONGEST", "LONGES3"),)


def test_subroutines_and_their_calls() -> None:
    host = main(Jump(kind=JumpKind.CALL, target="CUT"), routines=(routine("CUT", End()),))
    module = main(Jump(kind=JumpKind.CALL, target="CUT"), routines=(routine("CUT", Output(output="2"), End()),))
    made = put(host, module)
    assert [line for line in code(made) if "CUT" in line] == ["JS #CUT", "JS #CUT2", "#CUT", "#CUT2"]
    assert len(made.program.routines) == 2


def test_variables_are_renamed_wherever_they_stand_but_not_in_texts() -> None:
    host = main(MathematicalEquation(equations=(Equation(variable="LEN", expression="1"),)))
    module = main(
        UserInterface(prompt="LEN?", variable="LEN"),
        SingleAxisMove(axis="X", mode=MoveMode.BY, distance="LEN*2", speed="5"),
        Jump(target="E", when=JumpIf.CONDITION, condition="LEN>LENGTH"),
        TwoLetterCode(text='MG "LEN ",LEN;LEN=LEN+_TPX'),
        Comment(text="LEN is asked"),
        Label(name="E"),
    )
    made = put(host, module)
    texts = code(made)
    assert 'IN "LEN?",LEN2' in texts
    assert "PR (LEN2*2)*100" in texts or "PR LEN2*2*100" in texts
    assert "JP #E,LEN2>LENGTH" in texts
    assert 'MG "LEN ",LEN2;LEN2=LEN2+_TPX' in texts
    assert made.program.main[5].instruction == Comment(text="LEN is asked")


def test_a_variable_that_the_module_only_reads_is_the_programs() -> None:
    host = main(MathematicalEquation(equations=(Equation(variable="LEN", expression="1"),)))
    assert plan(host, main(TwoLetterCode(text="PR LEN"))).renames == ()


def test_a_variable_can_stay_the_same_in_both() -> None:
    host = main(MathematicalEquation(equations=(Equation(variable="N", expression="1"),)))
    module = main(MathematicalEquation(equations=(Equation(variable="N", expression="N+1"),)))
    assert code(put(host, module))[1:-1] == ["N=1", "N2=N2+1"]
    assert code(put(host, module, frozenset({"N"})))[1:-1] == ["N=1", "N=N+1"]


def test_arrays_of_code_are_variables_too() -> None:
    host = main(TwoLetterCode(text="DM POS[10]"))
    module = main(TwoLetterCode(text="DM POS[5]\nPOS[3]=7\nRA POS[]"))
    assert plan(host, module).renames == (Rename("variable", "POS", "POS2"),)
    assert [line for line in code(put(host, module)) if "POS" in line][1:] == ["DM POS2[5]", "POS2[3]=7", "RA POS2[]"]


def test_axis_letters_and_commands_are_no_variables() -> None:
    host = main(TwoLetterCode(text="A=1\nX=2"))
    module = main(TwoLetterCode(text="A=3\nBG A;AM A\nPR A"))
    assert code(put(host, module))[3:-1] == ["A2=3", "BG A;AM A", "PR A2"]


def test_what_a_program_has_once_is_left_out_or_commented_out() -> None:
    limits = routine("", End(), which=Routine.LIMSWI)
    host = main(Label(name="A"), routines=(limits,))
    module = dc.replace(
        main(routines=(limits,)),
        program=Program(
            "M", configuration=(Step("a", AutoExecution()), Step("t", LoopRate(period="500"))), routines=(limits,)
        ),
    )
    made = plan(host, module)
    assert made.left_out[:2] == (AutoExecution.title, LoopRate.title)
    assert "#LIMSWI" in made.left_out[2]
    program = put(host, module).program
    assert program.configuration == ()
    assert [step.enabled for step in program.routines] == [True, False]


def test_numbers_in_another_unit_are_refused() -> None:
    inches = MM.with_axis("X", Axis(unit=Unit.INCH, counts_per_unit="2540"))
    move = SingleAxisMove(axis="X", mode=MoveMode.BY, distance="10", speed="5")
    made = plan(main(Label(name="A")), main(move, setup=inches))
    assert "axis X is in in, here it is in mm" in made.cannot
    assert plan(main(Label(name="A")), main(Label(name="B"), setup=inches)).cannot == ""  # no number, no harm


def test_a_jump_to_a_line_number_is_refused() -> None:
    assert "JP 3" in plan(main(), main(TwoLetterCode(text="V=1\nJP 3"))).cannot


def test_names_of_inputs_and_outputs_become_numbers() -> None:
    named = dc.replace(MM, output_names=("", "", "knife", *[""] * 5))
    made = put(main(Label(name="A")), main(Output(output="knife"), setup=named))
    assert made.program.main[-1].instruction == Output(output="3")


@pytest.mark.parametrize("shared", [frozenset[str](), frozenset({"V"})])
def test_both_parts_do_what_they_did(shared: frozenset[str]) -> None:
    """The program counts V to 3, the module to 5; with names of their own neither disturbs the other."""
    loop = "V=0\n#L\nV=V+1\nJP #L,V<{}\nMG V{{F1.0}}"
    host, module = main(TwoLetterCode(text=loop.format(3))), main(TwoLetterCode(text=loop.format(5)))
    simulation = Simulation(model("ssc2"), compiled=False)
    simulation.load_program("\n".join(code(put(host, module, shared))))
    simulation.execute(0, 0)
    simulation.advance(1_024_000)
    assert simulation.errors == []
    assert [text.strip() for _, _, text in simulation.messages] == ["3", "5"]
    assert simulation.state()["variables"] == ({"V": 5.0} if shared else {"V": 3.0, "V2": 5.0})
