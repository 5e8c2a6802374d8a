"""Paths, contours and cams: what a machine refuses, what is worked out, and that rounding never adds up."""

from __future__ import annotations

import dataclasses as dc
import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen.document import Document
from codegen.generate import code, generate
from codegen.instructions import CircularPath, ContourMode, ElectronicCam, LinearPath, TangentPath
from codegen.instructions.contour import Every
from codegen.instructions.curves import CamPlace, CamStep
from codegen.instructions.path_parts import Ending, Measured, Piece, Shape, Stretch, Turn
from codegen.models import model
from codegen.paths import legs, path_of
from codegen.program import Program, Step
from codegen.read import problems, sentence
from codegen.rescale import with_setup
from codegen.setup import Axis, Setup, Unit
from device.simulator.simulation import Simulation

SAME = Setup(model="ssc4", axes=(Axis(counts_per_unit="4000"),) * 4)
TWO_SCALES = SAME.with_axis("Y", Axis(counts_per_unit="1000"))
TWO_UNITS = SAME.with_axis("Y", Axis(unit=Unit.MM, counts_per_unit="100"))
QUARTER = Piece(shape=Shape.ARC, radius="1", start="0", sweep="90")


def line(x: str, y: str, **more: str) -> Piece:
    return Piece(to=(x, y, "", ""), **more)


def errors(item: object, setup: Setup = SAME) -> list[str]:
    return [each.message for each in problems(item, setup) if each.severity == "error"]  # type: ignore[arg-type]


def warnings(item: object, setup: Setup = SAME) -> list[str]:
    return [each.message for each in problems(item, setup) if each.severity == "warning"]  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("path", "setup", "message"),
    [
        (CircularPath(axes="XYZ", segments=(QUARTER,)), SAME, "Axes: choose the two axes of the plane"),
        (
            CircularPath(segments=(QUARTER,)),
            TWO_UNITS,
            "X has the unit in and Y mm: a path needs one unit",
        ),
        (CircularPath(segments=(Piece(to=("", "", "", "")),)), SAME, "Segments, row 1: To is missing"),
        (CircularPath(segments=(line("1", "0"), line("1", "0"))), SAME, "Segments, row 2: the line has no length"),
        (
            CircularPath(segments=(line("1", "0", speed="2"),)),
            SAME,
            "Speed is missing: row 1 has its own, the others need that of the path",
        ),
        (
            CircularPath(continues=True, segments=(line("1", ""),)),
            SAME,
            "Segments, row 1: enter both axes, because it is not known where the path is",
        ),
        (
            CircularPath(segments=(dc.replace(QUARTER, radius="0.002"),)),
            SAME,
            "Segments, row 1: Radius must be at least 0.0025 in",  # 10 counts (commands.md, CR)
        ),
        (
            CircularPath(segments=(dc.replace(QUARTER, radius="1000", sweep="360"),)),
            SAME,
            "Segments, row 1: the arc is longer than the controller takes",  # 4e6 counts x 360 deg > 4.5e8
        ),
        (CircularPath(speed="9000", segments=(QUARTER,)), SAME, "Speed must lie between 0 and 2000 in/s"),
        (
            TangentPath(tangent="X", turn_counts="3600", segments=(QUARTER,)),
            SAME,
            "Tangent axis: X is an axis of the plane",
        ),
        (TangentPath(segments=(QUARTER,)), SAME, "Counts per turn is missing"),
        (
            LinearPath(axes="XYZ", continues=True, segments=(Stretch(to=("1", "", "", "")),)),
            SAME,
            "Displacements: a path that goes on is measured from the last end point",
        ),
        (
            LinearPath(axes="XY", segments=(Stretch(to=("1", "", "1", "")),)),
            SAME,
            "Segments, row 1: Z is no axis of this path",
        ),
        (
            LinearPath(
                axes="XYZ",
                ending=Ending.CONTINUE,
                measured=Measured.STEPS,
                segments=(Stretch(to=("1", "", "", "")),) * 512,
            ),
            SAME,
            "More than 511 segments must begin and end in one instruction",
        ),
    ],
)
def test_what_cannot_be_is_told(path: object, setup: Setup, message: str) -> None:
    assert errors(path, setup)[0] == message


def test_a_controller_of_one_axis_has_no_paths() -> None:
    one = dc.replace(SAME, model="ssc1")
    document = Document(
        Program(
            "P",
            main=(Step("s", LinearPath(axes="X", measured=Measured.STEPS, segments=(Stretch(to=("1", "", "", "")),))),),
        ),
        one,
    )
    assert any("has no" in each.message for each in generate(document).problems)


def test_circles_stay_circles_with_different_counts() -> None:
    """ES m,n stretches the axis with the larger number; radius and speed are those of the other (commands.md)."""
    path = CircularPath(speed="2", segments=(QUARTER,))
    assert code(path, TWO_SCALES)[:4] == ("VM XY", "ES 4,1", "VS 2000", "CR 1000,0,90")
    assert "ES" not in " ".join(code(path, SAME))


def test_a_picture_turned_round_turns_the_arc() -> None:
    """An axis drawn to the left mirrors start angle and sweep; both together turn by half a circle."""
    arc = CircularPath(segments=(dc.replace(QUARTER, start="30", turn=Turn.CW),))
    drawn = {
        letters: dc.replace(
            SAME,
            axes=tuple(
                dc.replace(axis, mirrored=letter in letters) for letter, axis in zip("XYZW", SAME.axes, strict=True)
            ),  # type: ignore[arg-type]
        )
        for letters in ("", "X", "Y", "XY")
    }
    written = {letters: code(arc, setup)[1] for letters, setup in drawn.items()}
    assert written == {"": "CR 4000,30,-90", "X": "CR 4000,150,90", "Y": "CR 4000,-30,90", "XY": "CR 4000,-150,-90"}


def test_where_an_arc_ends() -> None:
    """Centre = start - r (cos, sin): a quarter from 0° leads to (-r, r)."""
    end = legs(CircularPath(segments=(QUARTER,))).legs[0].end
    assert [float(each) for each in end if isinstance(each, Fraction)] == pytest.approx([-1, 1])
    drawn = path_of(CircularPath(segments=(line("2", "0"), dc.replace(QUARTER, start="-90"))), SAME)
    assert drawn[1].centre == pytest.approx((2, 1)) and drawn[1].end == pytest.approx((3, 1)) and drawn[1].corner == 0


def test_a_sharp_corner_at_full_speed_is_told() -> None:
    path = CircularPath(segments=(line("1", "0"), line("1", "1")))
    assert warnings(path) == ["Row 2 turns by 90° at full speed: round the corner, or stop there"]
    assert warnings(CircularPath(segments=(line("1", "0"), dc.replace(QUARTER, start="-90")))) == []


def test_more_segments_than_can_wait_are_sent_in_time() -> None:
    """600 segments: the path begins early and waits for room; it runs to its end without error 32."""
    rows = tuple(Stretch(to=("0.01", "0.005" if number % 2 else "", "", "")) for number in range(600))
    path = LinearPath(axes="XYZ", measured=Measured.STEPS, speed="20", segments=rows)
    listing = generate(Document(Program("P", main=(Step("s", path),)), SAME))
    assert listing.is_complete and "BG S" in listing.text and "_LM<100" in listing.text
    simulation = Simulation(model("ssc4"))
    simulation.load_program(listing.text)
    simulation.execute(0)
    assert simulation.run_until_idle(20 * 1_024_000) == "end"
    assert simulation.errors == []
    assert simulation.unit.motion.reference(0) == 24000 and simulation.unit.motion.reference(1) == 6000


@given(
    st.lists(st.integers(-999, 999).filter(bool), min_size=1, max_size=40), st.sampled_from(["637", "39.37", "4000"])
)
def test_steps_do_not_drift(steps: list[int], scale: str) -> None:
    """The counts sent add up to the rounded sum of what was asked, to the count."""
    setup = Setup(model="ssc4", axes=(Axis(counts_per_unit=scale),) * 4)
    total = round(sum(Fraction(step, 1000) for step in steps) * Fraction(scale) + Fraction(1, 10**9))
    texts = [f"{step / 1000:.3f}" for step in steps]
    line_path = LinearPath(
        axes="X", measured=Measured.STEPS, segments=tuple(Stretch(to=(text, "", "", "")) for text in texts)
    )
    lines = code(line_path, setup)
    assert abs(sum(int(each[3:]) for each in lines if each.startswith("LI ")) - total) <= 1
    contour = ContourMode(table="\n".join(texts))
    if not errors(contour, setup):
        assert abs(sum(int(each[3:]) for each in code(contour, setup) if each.startswith("CD ")) - total) <= 1


@given(st.floats(0.2, 50), st.floats(0.2, 50), st.floats(0.2, 50))
def test_the_speed_along_a_path_is_that_of_the_sentence(x: float, y: float, z: float) -> None:
    """Counts/s along the counts of a segment, seen in units: never faster, slower by less than 0.1 %."""
    to = (f"{x:.3f}", f"{y:.3f}", f"{z:.3f}", "")
    path = LinearPath(axes="XYZ", measured=Measured.STEPS, speed="2", segments=(Stretch(to=to),))
    text = next(each for each in code(path, TWO_SCALES) if each.startswith("LI"))
    counts = math.dist((0, 0, 0), [float(each) for each in text[3:].split("<")[0].split(",")])
    speed = float(text.split("<")[1]) if "<" in text else 2000.0
    units = math.dist((0, 0, 0), [float(each) for each in to[:3]])
    assert 1.995 <= speed / counts * units <= 2.001


def test_values_behind_a_segment_with_its_own_speed() -> None:
    """`<n` stays on the controller, so the next segment gets the path's speed back."""
    path = CircularPath(speed="2", segments=(line("1", "0", speed="1"), line("2", "0"), line("3", "0")))
    assert [each for each in code(path, SAME) if each.startswith("VP")] == [
        "VP 4000,0<4000",
        "VP 8000,0<8000",
        "VP 12000,0",
    ]


def test_expressions_in_a_path() -> None:
    path = LinearPath(
        axes="XY", measured=Measured.STEPS, segments=(Stretch(to=("LEN", "1", "", "")), Stretch(to=("2", "", "", "")))
    )
    assert [each for each in code(path, SAME) if each.startswith("VP")] == ["VP LEN*4000,4000", "VP (LEN+2)*4000,4000"]
    three = LinearPath(axes="XYZ", segments=path.segments)  # places become steps
    assert [each for each in code(three, SAME) if each.startswith("LI")] == ["LI LEN*4000,4000", "LI (2-LEN)*4000"]
    assert errors(path) == []


# ----------------------------------------------------------------------- tables


def test_a_contour_row_may_not_move_further_than_a_record() -> None:
    """32 000 counts (dmc-1412-1414.txt l.1979)."""
    assert errors(ContourMode(table="7.99")) == []
    assert errors(ContourMode(table="0.1\n8.1")) == ["Table: row 2 moves X by more than 32000 counts"]


@pytest.mark.parametrize(
    ("contour", "message"),
    [
        (ContourMode(axes="XY", table="1"), "Table: it has 1 columns and needs 2"),
        (ContourMode(timed=True, table="3\t1"), "Table: row 1 has the interval 3 ms; it must be 2, 4, 8 … 256"),
        (ContourMode(timed=True, table="\t1"), "Table: row 1 has no interval"),
        (ContourMode(table="1,234\t5"), "Table: row 1, cell 1: '1,234' can be read in two ways; write 1.234 or 1234"),
    ],
)
def test_wrong_contours(contour: ContourMode, message: str) -> None:
    assert errors(contour)[0] == message


def test_a_contour_that_is_too_fast_is_told() -> None:
    slow = SAME.with_axis("X", Axis(counts_per_unit="4000", maximum_speed="1"))
    contour = ContourMode(interval=Every.MS2, table="0.001\n0.01")  # 0.01 in in 2 samples: 5.12 in/s
    assert warnings(contour, slow) == ["In row 2 X goes at 5.12 in/s, top is 1 in/s"]


@pytest.mark.parametrize(
    ("cam", "message"),
    [
        (ElectronicCam(cycle="4", slaves="XY", table="0\t0\n1\t1"), "Slaves: X is the master"),
        (ElectronicCam(cycle="4", table="0\t0\n1\t1"), "Table: it has 2 columns; 1 slaves need 1"),
        (ElectronicCam(cycle="4", table="0"), "Table must have 2 to 257 rows, not 1"),
        (ElectronicCam(cycle="4", slaves="YZ", table="0\t0\n1\t"), "Table: row 2 has an empty cell"),
        (ElectronicCam(cycle="4", change=("", "", "1", ""), table="0\n1"), "Change in a cycle: Z is no slave"),
        (ElectronicCam(cycle="4000", table="0\n1"), "Master cycle must be at most 2097 in"),
        (
            ElectronicCam(cycle="20", table="0\n1"),
            "Table: more rows are needed, at most 32767 counts of the master apart",
        ),
        (ElectronicCam(step=CamStep.ENGAGE, places=(CamPlace(slave="X"),)), "Slaves and places: X is the master"),
        (ElectronicCam(step=CamStep.ENGAGE, places=(CamPlace(), CamPlace())), "Slaves and places: Y is there twice"),
    ],
)
def test_wrong_cams(cam: ElectronicCam, message: str) -> None:
    assert errors(cam)[0] == message


def test_a_cam_says_where_it_does_not_fit() -> None:
    assert warnings(ElectronicCam(cycle="4", table="0\n1\n2\n0")) == [
        "Master cycle: its 16000 counts do not divide into 3 equal parts, so the curve ends early: "
        "write 3.99975 in (15999 counts), or use 5 rows"
    ]
    jump = ElectronicCam(cycle="4", change=("", "1", "", ""), table="0\n1\n1.5")
    assert warnings(jump) == ["Y jumps by 0.5 in where the cycle begins again"]
    assert warnings(ElectronicCam(cycle="4", table="0\n1\n2\n3\n4")) == []


def test_a_cam_of_the_dmc_has_its_reason() -> None:
    one = dc.replace(SAME, model="dmc1412")
    assert "auxiliary encoder" in errors(ElectronicCam(step=CamStep.EXIT), one)[0]


# -------------------------------------------------------------- another machine


def test_counts_stay_when_the_scale_changes_under_a_path() -> None:
    """Keep the counts: every number along the path and in the tables is rewritten, the code stays the same."""
    half = Setup(model="ssc4", axes=(Axis(counts_per_unit="2000"),) * 4)
    items = (
        CircularPath(
            speed="2", acceleration="64", segments=(line("1", "0", speed="1"), dc.replace(QUARTER, start="-90"))
        ),
        LinearPath(axes="XYZ", measured=Measured.STEPS, speed="2", segments=(Stretch(to=("1", "", "0.5", "")),)),
        ContourMode(axes="XY", timed=True, table="64\t0.1\t0\n\t0.1\t0.1"),
        ElectronicCam(cycle="4", offset="1", table="0\n1\n2\n3\n4"),
        ElectronicCam(step=CamStep.ENGAGE, places=(CamPlace(at="1"),)),
    )
    document = Document(Program("P", main=tuple(Step(f"s{number}", item) for number, item in enumerate(items))), SAME)
    kept = with_setup(document, half, "counts")
    assert generate(kept).text == generate(document).text
    assert generate(with_setup(document, half)).text != generate(document).text
    assert "radius 2 in" in sentence(kept.program.main[0].instruction, half)
