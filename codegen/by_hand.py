"""What a person chooses for moving by hand, as fields with units, ranges and problems like those of instructions."""

from __future__ import annotations

import dataclasses as dc

from codegen.fields import (
    NONE,
    AxisName,
    AxisSet,
    Dimension,
    Number,
    PathQuantity,
    PerAxis,
    PerAxisText,
    Quantity,
    value,
)

WIDEST = 32000  # degrees (commands.md, CR)


def _speed(label: str, text: str, path: bool = False) -> Quantity:
    kind = PathQuantity if path else Quantity
    return kind(label=label, dimension=Dimension.SPEED, positive=True, literal=True, help=text)


def _ramp(label: str, text: str, path: bool = False) -> Quantity:
    kind = PathQuantity if path else Quantity
    return kind(label=label, dimension=Dimension.ACCELERATION, positive=True, literal=True, help=text)


@dc.dataclass(frozen=True, kw_only=True)
class OneAxis:
    """One axis: by an increment, while a button is held, to a place, home."""

    axis: str = value(AxisName(label="Axis", help="The axis that is moved."), "X")
    distance: str = value(
        Quantity(
            label="Increment", dimension=Dimension.DISTANCE, positive=True, literal=True, help="How far a click goes."
        ),
        "1",
    )
    speed: str = value(_speed("Speed", "Of increments, of holding, and on the way to a place."), "1")
    acceleration: str = value(_ramp("Acceleration", "How fast the speed grows."), "10")
    deceleration: str = value(_ramp("Deceleration", "How fast it stops when the button is let go."), "10")
    place: str = value(
        Quantity(
            label="Position", dimension=Dimension.POSITION, literal=True, required=False, help="Where Go to goes."
        ),
        "",
    )


@dc.dataclass(frozen=True, kw_only=True)
class Line:
    """Two axes or more on a straight line."""

    axes: str = value(AxisSet(label="Axes", help="The axes that move together."), "XY")
    distances: PerAxisText = value(  # noqa: RUF009 - frozen, as all fields
        PerAxis(
            label="Increment",
            of=Quantity(label="Increment", dimension=Dimension.DISTANCE, literal=True),
            help="How far each axis goes; the sign gives the direction.",
        ),
        NONE,
    )
    speed: str = value(_speed("Vector speed", "Along the line.", path=True), "1")
    acceleration: str = value(_ramp("Vector acceleration", "Along the line.", path=True), "10")
    deceleration: str = value(_ramp("Vector deceleration", "Along the line.", path=True), "10")


@dc.dataclass(frozen=True, kw_only=True)
class Arc:
    """Two axes on a part of a circle, from where they are."""

    axes: str = value(AxisSet(label="Axes", help="The two axes of the circle."), "XY")
    radius: str = value(
        PathQuantity(label="Radius", dimension=Dimension.DISTANCE, positive=True, literal=True, help="Of the circle."),
        "1",
    )
    start: str = value(
        Number(
            label="Start angle",
            low=-WIDEST,
            high=WIDEST,
            suffix="°",
            literal=True,
            help="Where on the circle it begins; 0 is to the right.",
        ),
        "0",
    )
    sweep: str = value(
        Number(
            label="Sweep angle",
            low=-WIDEST,
            high=WIDEST,
            suffix="°",
            literal=True,
            help="How far around; positive is counter-clockwise.",
        ),
        "90",
    )
    speed: str = value(_speed("Vector speed", "Along the arc.", path=True), "1")
    acceleration: str = value(_ramp("Vector acceleration", "Along the arc.", path=True), "10")
    deceleration: str = value(_ramp("Vector deceleration", "Along the arc.", path=True), "10")
