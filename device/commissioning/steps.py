"""The steps that bring an axis to life, one row each, in the order of the manuals.

Sources: SSC manual chapter 2, steps 5-8 (ssc-tol-o-motion.txt l.807-931) and dmc-1412-1414.txt l.560-804, 832-891.
"""

from __future__ import annotations

import dataclasses as dc
from dataclasses import dataclass
from enum import StrEnum

MOST = 2000  # counts: nothing moves further in any step, whatever is wrong
HELP = "Bring an axis to life"  # the help page
TROUBLE = "Troubleshooting"  # the tables of chapter 9


class Drives(StrEnum):
    """Which motors a step is for."""

    ANY = "any"
    SERVO = "servo"
    STEPPER = "stepper"
    SINE = "sine"  # a servo whose phases the controller commutates (DMC-1412)


@dataclass(frozen=True, slots=True)
class Step:
    """What to do in words, what is read, how it is judged, and where the manuals say so."""

    key: str
    title: str
    todo: tuple[str, ...]
    read: str
    judged: str
    source: str  # for whoever checks: lines of the manuals' texts
    manual: str  # for the person: where the printed manuals say so
    drives: Drives = Drives.ANY
    moves: bool = False
    optional: bool = False
    needs: tuple[str, ...] = ()  # steps that come first


STEPS: tuple[Step, ...] = (
    Step(
        "safety",
        "Emergency stop and enable",
        (
            "Test the machine's emergency stop: it must take the power from the drive without controller and computer.",
            "Press “Motor off” and look at the drive: it must show that it is disabled, and the shaft must turn "
            "freely. A vertical axis may fall: support it first.",
        ),
        "whether the controller has the motor on",
        "by what you see at the drive; without a working enable signal no error limit can protect the axis",
        "dmc-1412-1414.txt l.581-585; SSC manual l.849-851",
        "SSC manual, chapter 2, step 6B; DMC-1412/1414 manual, chapter 2, step 7B",
    ),
    Step(
        "encoder",
        "Encoder by hand",
        (
            "The motor is off. Press “Begin”, then move the axis by hand, forward, by a distance that you can measure.",
            "Type that distance and press “Judge”.",
        ),
        "the position in counts, its lowest and highest value, and how often it changed",
        "direction, counts in a unit against the setup; a reading that changes by one count only has a dead channel",
        "dmc-1412-1414.txt l.599-607; SSC manual l.863-874",
        "SSC manual, chapter 2, step 6D; DMC-1412/1414 manual, chapter 2, step 7D",
        needs=("safety",),
    ),
    Step(
        "switches",
        "Limit and home switches",
        (
            "Choose what each kind of switch does when it is tripped, and press “Begin”.",
            "Trip each switch by hand when it is asked for, and let it go. Say so where nothing changes, or where none "
            "is fitted.",
        ),
        "the forward limit, reverse limit and home inputs",
        "the asked one changes, no other does, and it is not active at rest",
        "dmc-1412-1414.txt l.2323-2346, 4111-4113; SSC manual l.1289, 1353",
        "SSC manual, chapter 4; DMC-1412/1414 manual, homing and limit switches",
        optional=True,
        needs=("safety",),
    ),
    Step(
        "guards",
        "Error and torque limits",
        (
            "Type the error limit and the torque limit for the first moves, and press “Set”.",
            "The motor goes off; off-on-error (OE 1) is set with them.",
        ),
        "OE, ER and TL as the controller holds them afterwards",
        "read back equal; the manuals' example is ER 2000, OE 1 and TL 1",
        "dmc-1412-1414.txt l.631-657; SSC manual l.885-912",
        "SSC manual, chapter 2, steps 7B and 7C; DMC-1412/1414 manual, chapter 2, step 8a, A and B",
        Drives.SERVO,
        needs=("encoder",),
    ),
    Step(
        "stepper",
        "Step and direction",
        (
            "The SM jumper of this axis is set (SSC: JP40), and step and direction go to the drive (SSC: J4, ICM-1460: "
            "PWM and SIGN).",
            "Choose the active level of the pulses that the drive wants, type the smoothing, and press “Set”. The "
            "motor goes off.",
        ),
        "MT and KS as the controller holds them afterwards",
        "read back equal; without the jumper the controller refuses with error 96",
        "dmc-1412-1414.txt l.806-828, 2120-2147; SSC manual l.772, 934-956",
        "SSC manual, chapter 2, step 8; DMC-1412/1414 manual, chapter 2, step 8c",
        Drives.STEPPER,
        needs=("safety",),
    ),
    Step(
        "phases",
        "Sine: phases and halls",
        (
            "Only where the controller commutates the motor: type the counts of one magnetic cycle and where the hall "
            "sensors are, then press “Test phases”. The motor turns one cycle there and back.",
            "Put right what the answer says, and test again.",
        ),
        "the controller's own answer to BS",
        "phases and halls in order, and BM close to what was typed",
        "dmc-1412-1414.txt l.703-745",
        "DMC-1412/1414 manual, chapter 2, step 8b, C and D",
        Drives.SINE,
        moves=True,
        optional=True,
        needs=("guards", "switches"),
    ),
    Step(
        "zero",
        "Sine: commutation zero",
        (
            "Type the hall sensors' offset and the voltage, then press “Drive to zero”. The motor jerks by up to half "
            "a magnetic cycle and goes off.",
        ),
        "the answer to BZ, and the counts to phase zero",
        "the controller reports no error 112, 113 or 114",
        "dmc-1412-1414.txt l.755-804",
        "DMC-1412/1414 manual, chapter 2, step 8b, F",
        Drives.SINE,
        moves=True,
        optional=True,
        needs=("phases",),
    ),
    Step(
        "polarity",
        "Polarity of the loop",
        (
            "Keep away from the axis, with a hand at the emergency stop. Press “Test move”: the motor is switched on, "
            "moves a few hundred counts and goes off.",
            "Then say whether it went the way that you call forward.",
        ),
        "commanded and actual position during the move, stop code, motor command",
        "it comes to its target; what runs the other way has the wrong polarity",
        "dmc-1412-1414.txt l.659-687; SSC manual l.914-927",
        "SSC manual, chapter 2, step 7D; DMC-1412/1414 manual, chapter 2, step 8a, D",
        Drives.SERVO,
        moves=True,
        needs=("safety", "encoder", "switches", "guards"),
    ),
    Step(
        "direction",
        "Direction of the motor",
        (
            "Keep away from the axis, with a hand at the emergency stop. Press “Test move”: the motor is switched on, "
            "turns by a few hundred pulses and goes off.",
            "Say what you saw: nothing is measured, a stepper works without feedback.",
        ),
        "commanded position, pulses sent, and the encoder where there is one",
        "by what you see; the pulses that were sent are those that were commanded",
        "dmc-1412-1414.txt l.806-828, 2126-2147; SSC manual l.934-956",
        "SSC manual, chapter 2, step 8; DMC-1412/1414 manual, chapter 2, step 8c",
        Drives.STEPPER,
        moves=True,
        needs=("safety", "switches", "stepper"),
    ),
    Step(
        "halls",
        "Sine: phase by the halls",
        (
            "Only with hall sensors, for a phase that is more exact than their estimate at power-up: press “Move”. "
            "The axis goes over more than a sixth of its magnetic cycle, and its phase is set on the way (BC).",
        ),
        "the hall inputs before and after, and the move",
        "the halls changed on the way, and the axis followed",
        "dmc-1412-1414.txt l.773-804",
        "DMC-1412/1414 manual, chapter 2, step 8b, F",
        Drives.SINE,
        moves=True,
        optional=True,
        needs=("zero", "polarity"),
    ),
    Step(
        "scale",
        "Scale",
        (
            "Set a dial gauge or a mark. Type a small distance and press “Move”.",
            "Type what you measured, and press “Judge”.",
        ),
        "how far the axis came, in counts",
        "the measured way is the commanded one within 2 %",
        "dmc-1412-1414.txt l.671-687; SSC manual l.916",
        "SSC manual, chapter 2, step 7D; DMC-1412/1414 manual, chapter 2, step 8a, D",
        moves=True,
        optional=True,
        needs=("safety", "switches", "polarity", "direction"),
    ),
    Step(
        "limits",
        "Software limits",
        (
            "Type the forward and the reverse limit of the travel, inside the limit switches, and the torque limit for "
            "normal operation.",
            "Press “Set”: the motor goes off, FL, BL and TL are sent and read back.",
        ),
        "FL, BL and TL as the controller holds them afterwards",
        "read back equal, the axis between them",
        "dmc-1412-1414.txt l.657, 4135-4146; SSC manual l.912",
        "SSC manual, chapter 2, step 7C; DMC-1412/1414 manual, chapter 2, step 8a, B; commands FL and BL",
        optional=True,
        needs=("scale",),
    ),
    Step(
        "burn",
        "Burn",
        ("Read what will be burned and press “Burn…”. It is the last step: without it all is lost at power-down.",),
        "the controller's answer to BN",
        "accepted, with the motor off",
        "dmc-1412-1414.txt l.747-753, 832; commands.md, BN",
        "DMC-1412/1414 manual, chapter 2, step 8b, E; command BN",
        optional=True,
        needs=("limits",),
    ),
)
BY_KEY = {step.key: step for step in STEPS}


def steps_for(stepper: bool, sine: bool) -> tuple[Step, ...]:
    """The steps of an axis: a stepper has no loop, and few servos are commutated by the controller."""
    kinds = {Drives.ANY, Drives.STEPPER} if stepper else {Drives.ANY, Drives.SERVO} | ({Drives.SINE} if sine else set())
    steps = tuple(step for step in STEPS if step.drives in kinds)
    return tuple(_of_a_stepper(step) for step in steps) if stepper else steps


def _of_a_stepper(step: Step) -> Step:
    """What is different for it: an encoder is optional (l.601), nothing limits the force."""
    if step.key == "encoder":
        more = "A stepper needs no encoder: skip this step where none is fitted."
        return dc.replace(step, optional=True, todo=(*step.todo, more))
    if step.key == "limits":
        todo = (
            "Type the forward and the reverse limit of the travel, inside the limit switches.",
            "Press “Set”: the motor goes off, FL and BL are sent and read back.",
        )
        return dc.replace(step, todo=todo, read="FL and BL as the controller holds them afterwards")
    return step
