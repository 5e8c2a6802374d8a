"""The type plate of an SSC: `SSC47` or the part number tells axes and motors (ssc-tol-o-motion.txt l.732-764)."""

from __future__ import annotations

import dataclasses as dc
import re

from codegen.fields import AXES
from codegen.models import MODELS
from codegen.setup import MotorType, Setup

CODE = re.compile(r"SSC\s*-?\s*([1-4])([0-8])\Z", re.ASCII | re.IGNORECASE)
PART = re.compile(r"3600\s*-?\s*0([12])([1-4])([0-8])\Z", re.ASCII | re.IGNORECASE)
PRINTED_TWICE = "3600-0147"  # l.758 prints it for SSC46 with a servo on X too, where 3600-0246 would be expected
KINDS = {True: "a servo (±10 V)", False: "a stepper (step and direction)", None: "a servo or a stepper"}


@dc.dataclass(frozen=True, slots=True)
class Plate:
    """What a type plate tells: for each axis True for a servo, False for a stepper, None where it does not say."""

    code: str
    model: str
    servos: tuple[bool | None, ...]
    part: str = ""

    @property
    def words(self) -> str:
        """The plate explained."""
        number = len(self.servos)
        named = f"{self.code}{f', part {self.part}' if self.part else ''}"
        kinds = "; ".join(f"{letter} {KINDS[kind]}" for letter, kind in zip(AXES, self.servos, strict=False))
        text = f"{named}: {number} {'axis' if number == 1 else 'axes'}, jumpered for {kinds}."
        if self.servos[0] is None:
            text += " The part number tells X: 3600-01… stepper, 3600-02… servo."
        if self.part == PRINTED_TWICE:
            text += " The manual prints this part number for SSC46 with a servo on X too: look at the code."
        return text


def read_plate(text: str) -> Plate | None:
    """A code or a part number as people type it; None when there is no such controller."""
    if match := CODE.match(text.strip()):
        return _plate(int(match[1]), int(match[2]), None, "")
    if match := PART.match(text.strip()):
        servo = match[1] == "2"
        return _plate(int(match[2]), int(match[3]), servo, f"3600-0{match[1]}{match[2]}{match[3]}")
    return None


def plate_problem(text: str) -> str:
    """What is wrong with a plate that cannot be read, as a sentence; nothing when it is empty or known."""
    if not text.strip() or read_plate(text) is not None:
        return ""
    return f"Type plate: there is no “{text.strip()}”. Write SSC10 to SSC48, or the part number, such as 3600-0247."


def _plate(axes: int, kind: int, x_servo: bool | None, part: str) -> Plate | None:
    """The last digit counts what the axes behind X are, in twos: SSC46 is Y servo, Z stepper, W servo."""
    others = axes - 1
    number = kind - 1 if others else kind
    if not 0 <= number < 2**others:
        return None
    behind = tuple(bool(number >> place & 1) for place in reversed(range(others)))
    return Plate(f"SSC{axes}{kind}", f"ssc{axes}", (x_servo, *behind), part)


def with_plate(setup: Setup, plate: Plate) -> Setup:
    """The setup with the model and the kinds of motor of a plate; a polarity that fits is kept."""
    assert plate.model in MODELS
    setup = dc.replace(setup, model=plate.model)
    for letter, servo in zip(AXES, plate.servos, strict=False):
        axis = setup.axis(letter)
        if servo is not None and servo is axis.is_stepper:
            motor = MotorType.SERVO if servo else MotorType.STEPPER_LOW
            setup = setup.with_axis(letter, dc.replace(axis, motor=motor, smoothing=""))
    return setup
