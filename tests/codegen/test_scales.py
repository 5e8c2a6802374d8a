"""Another scale for the same machine: the numbers of a program follow, and its code stays."""

from __future__ import annotations

from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from codegen.document import Document
from codegen.generate import code, compiled, generate
from codegen.instructions import AccelDecel, Repeat, SingleAxisMove
from codegen.program import Program, Step
from codegen.rescale import scaled_text, with_setup
from codegen.setup import Axis, Setup, Unit
from tests.codegen.strategies import programs


def test_keeping_counts_rewrites_numbers() -> None:
    """The same machine in mm instead of inches: 25.4 times fewer counts per unit, the same code."""
    inch = Setup(model="ssc1").with_axis("X", Axis(counts_per_unit="2540", forward_limit="10"))
    millimetre = Setup(model="ssc1").with_axis("X", Axis(unit=Unit.MM, counts_per_unit="100", forward_limit="10"))
    steps = (
        Step("a", SingleAxisMove(distance="4", speed="2")),
        Step("b", Repeat(count="3"), body=(Step("c", SingleAxisMove(distance="LEN+_TPX")),)),
        Step("d", AccelDecel(acceleration=("100", "", "", ""))),
    )
    old = Document(Program("P", main=steps), inch)
    new = with_setup(old, millimetre, "counts")
    assert new.program.main[0].instruction == SingleAxisMove(distance="101.6", speed="50.8")
    assert new.setup.axis("X").forward_limit == "254"
    lines, before = generate(new).text.split("\n"), generate(old).text.split("\n")
    assert [line for line in lines if "LEN" not in line] == [line for line in before if "LEN" not in line]
    assert "PR (LEN*25.4*100)+_TPX" in lines and "PR (LEN*2540)+_TPX" in before
    assert with_setup(old, millimetre, "units").program is old.program


@given(programs(), st.sampled_from(["2", "0.5", "25.4"]))
def test_keeping_counts_keeps_the_code_of_plain_numbers(program: Program, ratio: str) -> None:
    old = Setup(model="ssc4", axes=(Axis(counts_per_unit="1000"),) * 4)
    scale = str(Fraction(1000) / Fraction(ratio)) if Fraction(1000) % Fraction(ratio) == 0 else "1000"
    new = Setup(model="ssc4", axes=(Axis(counts_per_unit=scale),) * 4)
    document = Document(program, old)
    moved = with_setup(document, new, "counts")
    for one, other in zip(document.program.steps(), moved.program.steps(), strict=True):
        if not compiled(one.instruction, old).errors and not any(
            name in repr(one.instruction) for name in ("LEN", "A", "_", "POS")
        ):
            assert code(other.instruction, new) == code(one.instruction, old)


def test_scaled_texts() -> None:
    two = Fraction(2)
    assert [scaled_text(text, two) for text in ("", "4", "LEN", "_TPX", "12,5")] == ["", "8", "LEN*2", "_TPX", "12,5"]
