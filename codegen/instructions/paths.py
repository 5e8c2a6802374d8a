"""The group Motion: paths of several axes at one speed, of lines and arcs."""

# ruff: noqa: RUF009  (value() declares a field as dataclasses.field does)

from __future__ import annotations

import dataclasses as dc
from fractions import Fraction

from codegen.fields import AxisName, AxisSet, Choice, Dimension, Flag, ListOf, Number, Quantity, value, value_of
from codegen.instructions.instruction import Group, Instruction
from codegen.instructions.path_parts import (
    ACCELERATION,
    BEGIN,
    CONTINUES,
    DECELERATION,
    END_OF_PATH,
    ENDING,
    FIRST,
    RAMPS,
    SMOOTHING,
    SPEED,
    WAIT,
    Ending,
    InAPlane,
    Measured,
    OnAPath,
    Piece,
    Shape,
    Stretch,
    corner_advice,
    ellipse,
)
from codegen.paths import legs
from codegen.setup import Setup


@dc.dataclass(frozen=True, kw_only=True)
class CircularPath(InAPlane, Instruction):
    """A path of lines and arcs in a plane."""

    title = "2D Circular Interpolation"
    group = Group.MOTION
    sentence = "{continues} of {axes}" + RAMPS + ": {segments}" + END_OF_PATH
    help = (
        "Two axes follow lines and arcs at one speed, without stopping between them. Where the path begins is its "
        "point (0, 0); that does not change the positions of the axes. An arc begins where the path is: its start "
        "angle says in which direction from its centre that is."
    )

    axes: str = value(AxisSet(label="Axes", help="The two axes of the plane."), "XY")
    continues: bool = value(CONTINUES, False)
    segments: tuple[Piece, ...] = value(
        ListOf(label="Segments", row=Piece, axes="axes", help="Lines and arcs, one after the other."), (Piece(),)
    )
    speed: str = value(SPEED, "")
    acceleration: str = value(ACCELERATION, "")
    deceleration: str = value(DECELERATION, "")
    smoothing: str = value(SMOOTHING, "")
    ending: Ending = value(ENDING, Ending.STOP)
    begin: bool = value(BEGIN, True)
    wait: bool = value(WAIT, True)

    def own_problem(self) -> tuple[str, str] | None:
        return self.plane_problem()

    def setup_problem(self, setup: Setup) -> tuple[str, str] | None:
        return self.path_problem(setup, self.segments) or self.arc_problem(setup)

    def own_warning(self, setup: Setup) -> tuple[str, str] | None:
        return corner_advice(self, setup)

    @classmethod
    def example(cls) -> CircularPath:
        return cls(
            speed="2",
            segments=(
                Piece(to=("3", "0", "", "")),
                Piece(shape=Shape.ARC, radius="1", start="-90", sweep="180"),
                Piece(to=("0", "2", "", "")),
            ),
        )


@dc.dataclass(frozen=True, kw_only=True)
class TangentPath(InAPlane, Instruction):
    """A path in a plane, and an axis that turns along with its direction."""

    title = "Tangent Motion"
    group = Group.MOTION
    sentence = (
        "{continues} of {axes}"
        + RAMPS
        + "[, {tangent} along its direction, {turn_first}|, {tangent} along its direction]: {segments}"
        + END_OF_PATH
    )
    help = (
        "Two axes follow lines and arcs, a third one turns a tool so that it always points along the path. The third "
        "axis must stand in the direction of the path before it begins: “first turn it there” does that."
    )

    axes: str = value(AxisSet(label="Plane", help="The two axes of the plane."), "XY")
    continues: bool = value(CONTINUES, False)
    tangent: str = value(AxisName(label="Tangent axis", help="The axis that turns the tool."), "Z")
    turn_counts: str = value(
        Number(
            label="Counts per turn",
            low=-45720,
            high=45720,
            step="1.40625",
            literal=True,
            when=FIRST,
            help="Counts of the tangent axis for one whole turn; negative turns the other way.",
        ),
        "",
    )
    zero: str = value(
        Quantity(
            label="Position of 0°",
            dimension=Dimension.POSITION,
            axis="tangent",
            when=FIRST,
            help="Position of the tangent axis at which the tool points along the first axis.",
        ),
        "0",
    )
    turn_first: bool = value(
        Flag(
            label="First turn it there",
            phrase="turned there first",
            when=FIRST,
            help="Moves the tangent axis to the direction of the first segment before the path begins.",
        ),
        True,
    )
    segments: tuple[Piece, ...] = value(
        ListOf(label="Segments", row=Piece, axes="axes", help="Lines and arcs, one after the other."), (Piece(),)
    )
    speed: str = value(SPEED, "")
    acceleration: str = value(ACCELERATION, "")
    deceleration: str = value(DECELERATION, "")
    smoothing: str = value(SMOOTHING, "")
    ending: Ending = value(ENDING, Ending.STOP)
    begin: bool = value(BEGIN, True)
    wait: bool = value(WAIT, True)

    def own_problem(self) -> tuple[str, str] | None:
        if self.tangent in self.axes:
            return "tangent", f"Tangent axis: {self.tangent} is an axis of the plane"
        turns = value_of(self.turn_counts)
        if not self.continues and isinstance(turns, Fraction) and abs(turns) < 1:
            return "turn_counts", "Counts per turn must be 1 or more"
        return self.plane_problem()

    def setup_problem(self, setup: Setup) -> tuple[str, str] | None:
        return self.path_problem(setup, self.segments) or self.arc_problem(setup)

    def own_warning(self, setup: Setup) -> tuple[str, str] | None:
        return corner_advice(self, setup)

    @classmethod
    def example(cls) -> TangentPath:
        return cls(
            turn_counts="3600",
            speed="2",
            segments=(Piece(to=("3", "0", "", "")), Piece(shape=Shape.ARC, radius="1", start="-90", sweep="180")),
        )


@dc.dataclass(frozen=True, kw_only=True)
class LinearPath(OnAPath, Instruction):
    """Straight segments of one to four axes at one speed."""

    title = "Linear Interpolation"
    group = Group.MOTION
    sentence = "{continues} of {axes}" + RAMPS + ": {measured} {segments}" + END_OF_PATH
    help = (
        "One to four axes follow straight segments at one speed, without stopping between them. The speed is that "
        "along the path. With two axes the path can be mixed with arcs of 2D Circular Interpolation."
    )

    axes: str = value(AxisSet(label="Axes", help="One to four axes that move together."), "XY")
    continues: bool = value(CONTINUES, False)
    measured: Measured = value(
        Choice(
            label="Displacements",
            kind=Measured,
            words={Measured.POINTS: "From the start of the path", Measured.STEPS: "From the last end point"},
            phrases={Measured.POINTS: "to", Measured.STEPS: "by"},
            help="Whether the numbers are places, measured from where the path begins, or steps.",
        ),
        Measured.POINTS,
    )
    segments: tuple[Stretch, ...] = value(
        ListOf(label="Segments", row=Stretch, axes="axes", help="One straight segment after the other."), (Stretch(),)
    )
    speed: str = value(SPEED, "")
    acceleration: str = value(ACCELERATION, "")
    deceleration: str = value(DECELERATION, "")
    smoothing: str = value(SMOOTHING, "")
    ending: Ending = value(ENDING, Ending.STOP)
    begin: bool = value(BEGIN, True)
    wait: bool = value(WAIT, True)

    def own_problem(self) -> tuple[str, str] | None:
        if self.continues and (self.measured is Measured.POINTS) != (len(self.axes) == 2):
            wanted = "from the start of the path" if len(self.axes) == 2 else "from the last end point"
            return "measured", f"Displacements: a path that goes on is measured {wanted}"
        for number, row in enumerate(self.segments):
            if not any(row.to):
                return "segments", f"Segments, row {number + 1}: the segment goes nowhere"
        found = legs(self)
        for number in found.unknown:
            return (
                "segments",
                f"Segments, row {number + 1}: enter both axes, because it is not known where the path is",
            )
        for number in found.empty:
            return "segments", f"Segments, row {number + 1}: the segment has no length"
        return None

    def setup_problem(self, setup: Setup) -> tuple[str, str] | None:
        if problem := self.path_problem(setup, self.segments):
            return problem
        if len(self.axes) == 2 and ellipse(setup, self.axes) is None:
            text = f"The counts per unit of {self.axes[0]} and {self.axes[1]} are in no ratio the controller can use"
            return "axes", text
        return None

    def own_warning(self, setup: Setup) -> tuple[str, str] | None:
        scales = {setup.axis(letter).scale for letter in self.axes}
        typed = any(not isinstance(value_of(text), Fraction) for row in self.segments for text in row.to if text)
        if self.speed and len(self.axes) > 2 and len(scales) > 1 and typed:
            return "speed", "With expressions and different counts per unit the speed is at most this, often less"
        return corner_advice(self, setup)

    @classmethod
    def example(cls) -> LinearPath:
        return cls(
            axes="XYZ",
            measured=Measured.STEPS,
            speed="2",
            segments=(Stretch(to=("4", "2", "", "")), Stretch(to=("4", "2.05", "0.01", ""))),
        )
