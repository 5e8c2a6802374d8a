"""Judges what was read, as pure functions: a verdict in words, what to do, and the figures."""

from __future__ import annotations

import dataclasses as dc
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from codegen.numbers import number_problem, parse_number, shown
from codegen.setup import Axis
from codegen.twoletter.problems import STOP_TEXTS
from device.commissioning.record import Finding, Verdict
from device.commissioning.seen import NOT_FITTED, NOTHING, RIGHT, SWITCHES, Switches, Turned

FEW = 20  # counts: less is too little to measure
HAND = Fraction(1, 20)  # a distance measured by hand may be off by that
GAUGE = Fraction(2, 100)  # and one with a gauge
STIRRED = 5  # counts: less is no movement
ARRIVED = 30  # counts from its target that an untuned loop may stay
AT_TARGET, FORWARD_LIMIT, REVERSE_LIMIT, BY_ERROR = 1, 2, 3, 8  # stop codes
PASSED, FAILED, OPEN = Verdict.PASSED, Verdict.FAILED, Verdict.OPEN

NO_ENABLE = (
    "Does an enable signal (AEN, AMPEN) go from the controller to the drive?",
    "The drive may want it the other way round: on the ICM-1460 the 7407 is exchanged for a 7406 "
    "(DMC-1412/1414 manual, chapter 2); elsewhere ask for the -LAEN option.",
)
ENCODER_CAUSES = (
    "Check the wires of the encoder: channels A and B, supply, and for a single-ended encoder nothing at A- and B-.",
    "Look at A and B with an oscilloscope: both need a peak of 5 to 12 V. If one is missing, replace the encoder.",
    "Connect the encoder to another axis: if it works there, the input of the controller has failed.",
    "Is the right kind of encoder set (CE)?",
)
TURN_THE_LOOP = (
    "Brush motor: exchange its two leads. That is the best way: it survives a master reset.",
    "Brushless motor: exchange CHA and CHB of a single-ended encoder, or CHA+ and CHA- of a differential one.",
    "Or in the controller, with the motor off: MT -1 (“Servo, reversed”), or CE 2 (“Quadrature, reversed”) in the "
    "setup. After a master reset these are gone and the axis runs away again.",
)
PULLED = "A load that pulls, as on a vertical axis, does the same: balance it, or allow a larger error limit."
TURN_THE_PHASES = ("Sine commutation: test the phases and drive to zero again; a wrong phase runs away as well.",)
TURN_THE_DIRECTION = (
    "Exchange the motor leads AND the encoder channels of a brush motor; only both together turn the direction.",
    "Brushless: see the drive's documentation for reversing its direction.",
)
WEAK = (
    "Is the drive enabled and powered? Look at its lamp while the motor is on.",
    "The torque limit may be too low for the friction: go back to “Error and torque limits” and raise TL a little.",
    "Is the command wire (ACMD) connected to the drive, and the motor to the drive?",
    "Is a brake closed, or the axis at its end?",
    "With weak gains the error limit is reached before there is force enough: allow a larger one, up to 400 counts.",
)
DIED = "Did the axis go on while its reading stood? Then a channel of its encoder died on the way: check its wires."


@dataclass(frozen=True, slots=True)
class Moved:
    """A bounded move as it was watched; places in counts, `torque` in V at its end."""

    asked: int
    start: int
    end: int
    commanded: int  # where the axis was commanded to be in the end
    low: int
    high: int
    code: int  # stop code
    tripped: bool  # the controller switched the motor off
    torque: float = 0.0
    bounded: bool = False  # it left its bounds and was switched off from here
    changes: int = 0  # of the reading, until it stood
    error: int = 0  # the error limit around it, counts
    encoder: int = 0  # what the encoder of a stepper moved, where there is one
    dead: bool = False  # its reading went one count forward and the same one back, try after try
    lost: bool = False  # it followed, and with more error allowed its reading stood still

    @property
    def way(self) -> int:
        """How far it came, in the asked direction."""
        return (self.end - self.start) * (1 if self.asked >= 0 else -1)

    @property
    def furthest(self) -> int:
        return max(self.high - self.start, self.start - self.low)


def joined(tries: Sequence[Moved], asked: int) -> Moved:
    """Tries with the same target as one move."""
    low, high = min(each.low for each in tries), max(each.high for each in tries)
    changes = sum(each.changes for each in tries)
    return dc.replace(tries[-1], asked=asked, start=tries[0].start, low=low, high=high, changes=changes)


def toggling(tries: Sequence[Moved]) -> bool:
    """Whether the last tries only went to and fro by one count; a single step may be a movement."""
    low, high, changes = tries[-1].low, tries[-1].high, 0
    for each in reversed(tries):
        low, high = min(low, each.low), max(high, each.high)
        if high - low > 1:
            break
        changes += each.changes
    return changes > 1


# ------------------------------------------------------------------------ by hand


def judge_safety(estop: bool, disabled: bool, motor_off: bool) -> Finding:
    """What the person saw at the drive with the motor off."""
    facts = (("Motor off (MO)", "yes" if motor_off else "no"),)
    if not motor_off:
        return Finding(OPEN, "Press “Motor off” first.", (), facts)
    if not disabled:
        return Finding(
            FAILED,
            "The drive stays enabled although the controller has the motor off: no error limit and no STOP can take "
            "its power.",
            NO_ENABLE,
            facts,
        )
    if not estop:
        words = "The emergency stop is not confirmed. It is the only thing that stops a machine whatever is wrong."
        return Finding(FAILED, words, ("Have it wired and tested before anything is switched on.",), facts)
    return Finding(PASSED, "Emergency stop and enable signal work, as you have seen at the drive.", (), facts)


def judge_encoder(seen: Turned, typed: str, axis: Axis) -> Finding:
    """Direction, counts in a unit, and whether both channels arrive."""
    facts: tuple[tuple[str, str], ...] = (
        ("Moved", f"{seen.moved} counts"),
        ("Lowest and highest", f"{seen.low}, {seen.high} counts"),
    )
    if seen.first is None:
        return Finding(OPEN, "Press “Begin” first.")
    if not seen.changes:
        words = "The reading did not change while the axis was moved: nothing comes from this encoder."
        return Finding(FAILED, words, ENCODER_CAUSES, facts)
    if seen.range <= 1:
        words = "The reading only toggles by one count: one of the two channels, A or B, does not arrive."
        return Finding(FAILED, words, ENCODER_CAUSES, facts)
    distance = parse_number(typed)
    if distance is None or not distance:
        return Finding(OPEN, f"Distance moved: {number_problem(typed) or 'it cannot be 0'}.", (), facts)
    if abs(seen.moved) < FEW:
        return Finding(OPEN, f"It moved by {seen.moved} counts only; move it further.", (), facts)
    found = Fraction(seen.moved) / distance
    facts = (*facts, (f"Counts in 1 {axis.symbol}", shown(abs(found))))
    if found < 0:
        way = "forward" if distance > 0 else "backward"
        return Finding(
            FAILED,
            f"The axis was moved {way}, and the position counted the other way.",
            (
                "Exchange the channels: CHA and CHB of a single-ended encoder, CHA+ and CHA- of a differential one.",
                "Or choose “Quadrature, reversed” (CE 2) in the setup, with the motor off.",
                "A loop that was in order before needs its motor leads exchanged as well.",
            ),
            facts,
        )
    return _scale(found, axis, HAND, facts, "The position counts in the right direction")


def _scale(found: Fraction, axis: Axis, allowed: Fraction, facts: tuple[tuple[str, str], ...], good: str) -> Finding:
    """Measured counts in a unit against those of the setup."""
    if not axis.is_set_up:
        words = f"{good}: {shown(found)} counts in 1 {axis.symbol}. The setup has no scale yet; take this one."
        return Finding(PASSED, words, (), facts)
    ratio = found / axis.scale
    if abs(ratio - 1) <= allowed:
        words = f"{good}: {shown(found)} counts in 1 {axis.symbol} were measured, {shown(axis.scale)} are in the setup."
        return Finding(PASSED, words, (), facts)
    words = (
        f"The scale is wrong: {shown(found)} counts in 1 {axis.symbol} were measured, {shown(ratio, 3)} times the "
        f"{shown(axis.scale)} of the setup."
    )
    return Finding(FAILED, words, _scale_causes(ratio), facts)


def _scale_causes(ratio: Fraction) -> tuple[str, ...]:
    likely = {
        4: "The controller counts four edges for each line of the encoder: 4 times its lines.",
        25.4: "One inch is 25.4 mm: is the unit right?",
        2: "A factor of 2: a screw with two starts, or a pulley of half the size?",
    }
    factor = float(max(ratio, 1 / ratio))
    hints = tuple(words for number, words in likely.items() if abs(factor / number - 1) < 0.06)
    return (
        *hints,
        "Counts in a unit are 4 × encoder lines × gear ratio ÷ travel of one turn of the screw or pulley.",
        "Measure again, then take the measured scale into the setup.",
    )


def judge_switches(seen: Switches, active: Mapping[str, int]) -> Finding:
    """Right input, right end, right polarity; `active` is the level of a tripped switch, by CN."""
    outcome, rest = seen.outcome, seen.rest
    facts = tuple((SWITCHES[name].capitalize(), _switch_words(name, seen, active)) for name in SWITCHES)
    if seen.asked:
        return Finding(OPEN, f"Trip the {SWITCHES[seen.asked]} switch by hand.", (), facts)
    if outcome["forward"] == "reverse" or outcome["reverse"] == "forward":
        return Finding(
            FAILED,
            "The limit switches are swapped: the forward one acts on the reverse input. The axis would run into the "
            "machine's end, and could not be moved away from it.",
            ("Exchange the two wires at the controller (forward limit, reverse limit).",),
            facts,
        )
    for name, came in outcome.items():
        if came not in (RIGHT, NOTHING, NOT_FITTED):
            words = f"The {SWITCHES[name]} switch acts on the {SWITCHES[came]} input."
            return Finding(FAILED, words, ("Put its wire on the right input.",), facts)
    if dead := [SWITCHES[name] for name, came in outcome.items() if came == NOTHING]:
        words = f"The {' and the '.join(dead)} input did not change when its switch was tripped: it is stuck."
        return Finding(FAILED, words, _stuck(rest, active), facts)
    limits = [name for name in ("forward", "reverse") if outcome[name] == RIGHT and rest[name] == active[name]]
    if limits:
        return Finding(FAILED, _polarity_words(limits), POLARITY, facts)
    fitted = [SWITCHES[name] for name, came in outcome.items() if came == RIGHT]
    words = f"Seen changing, at the right input, right polarity: {', '.join(fitted)}." if fitted else "None is fitted."
    return Finding(PASSED, words, (), facts)


POLARITY = (
    "CN says which level of the limit inputs means “tripped”: CN -1 low (the factory's way, a switch that closes to "
    "zero volts), CN 1 high (a switch that opens).",
    "Choose the other kind of limit switch above and try again; it is burned with the parameters.",
)


def _polarity_words(limits: list[str]) -> str:
    names = " and ".join(SWITCHES[name] for name in limits)
    return f"The {names} input is active while nothing is tripped: the polarity is wrong, the axis would not move."


def _stuck(rest: Mapping[str, int], active: Mapping[str, int]) -> tuple[str, ...]:
    return (
        "Check the switch with a meter, and its wire up to the terminal of the controller.",
        "Opto-isolated inputs need their common: is the limit switch common (LSCOM) connected?",
        "An input that nothing is connected to reads 1.",
    )


def _switch_words(name: str, seen: Switches, active: Mapping[str, int]) -> str:
    came = seen.outcome.get(name, "")
    level = f"reads {seen.rest[name]} at rest" if name in seen.rest else ""
    words = {RIGHT: "seen changing", NOTHING: "no change", NOT_FITTED: "not fitted", "": "not tripped yet"}
    told = words.get(came) or f"changed the {SWITCHES[came]} input"
    way = ""
    if name == "home" and came == RIGHT:
        way = f"; HM begins {'in reverse' if seen.rest['home'] else 'forward'} from here"
    return f"{told}, {level}{way}" if level and came != NOT_FITTED else told


# ------------------------------------------------------------------- set and read back


def judge_set(wanted: Mapping[str, str], there: Mapping[str, str]) -> Finding:
    """Registers as they were asked for and as they are."""
    facts = tuple((name, there.get(name, "?")) for name in wanted)
    wrong = [name for name, text in wanted.items() if there.get(name) != text]
    if wrong:
        return Finding(FAILED, f"The controller did not take {', '.join(wrong)}.", ("Set them again.",), facts)
    told = ", ".join(f"{name} {text}" for name, text in wanted.items())
    return Finding(PASSED, f"Set and read back: {told}.")


# --------------------------------------------------------------------------- moves


def judge_polarity(moved: Moved, sine: bool = False) -> Finding:
    """Whether the loop pulls the axis to where it is commanded to be; `sine`: the controller commutates the motor."""
    facts = move_facts(moved)
    if not moved.tripped and not moved.bounded and abs(moved.way - abs(moved.asked)) <= ARRIVED:
        words = f"The loop has the right polarity: the axis came {moved.way} of {abs(moved.asked)} counts and stood."
        return Finding(PASSED, words, (), facts)
    if moved.dead:
        words = "The reading only toggled by one count while the motor was driven: an encoder channel is dead."
        return Finding(FAILED, words, ENCODER_CAUSES, facts)
    if moved.lost:
        words = (
            f"The axis followed for {moved.way} counts, then its reading stood still although it was driven: an "
            "encoder channel died on the way, or the axis is jammed there."
        )
        return Finding(FAILED, words, (*ENCODER_CAUSES, *WEAK[3:4]), facts)
    if moved.furthest <= STIRRED:
        words = (
            f"The axis did not move, although it was driven up to an error of {moved.error} counts. Did you see it "
            "turn? Then its encoder tells nothing: do not go on. If it stood still, try again: each time it gets more "
            "force, up to the error limit on this page."
        )
        return Finding(FAILED, words, (*WEAK, *ENCODER_CAUSES[:1]), facts)
    commanded = (moved.commanded - moved.start) * (1 if moved.asked >= 0 else -1)
    if moved.bounded or (moved.tripped and (moved.way < -STIRRED or moved.way > commanded)):
        words = (
            f"Wrong polarity: the axis ran away from where it was commanded to be, {moved.furthest} counts, until it "
            "was switched off."
        )
        return Finding(FAILED, words, (*(TURN_THE_PHASES if sine else ()), *TURN_THE_LOOP, PULLED), facts)
    if moved.code in (FORWARD_LIMIT, REVERSE_LIMIT):
        end = "forward" if moved.code == FORWARD_LIMIT else "reverse"
        return Finding(FAILED, f"The {end} limit stopped it.", ("Move the axis away from its end by hand.",), facts)
    words = f"It stopped short of its target, after {moved.way} of {abs(moved.asked)} counts: too little force."
    return Finding(FAILED, words, (*WEAK, DIED), facts)


def judge_direction(finding: Finding, forward: bool) -> Finding:
    """With what the person saw: whether it went the way that is called forward."""
    if finding.verdict is not PASSED or forward:
        return finding
    words = "The loop is in order, but the axis moves the other way than the one called forward."
    return Finding(FAILED, words, TURN_THE_DIRECTION, finding.facts)


def judge_scale(moved: Moved, asked: str, typed: str, axis: Axis) -> Finding:
    """The commanded way against the measured one."""
    facts = move_facts(moved)
    if moved.tripped or moved.bounded or abs(moved.way - abs(moved.asked)) > ARRIVED:
        return Finding(FAILED, f"The move did not end at its target{_stopped(moved)}.", WEAK, facts)
    measured = parse_number(typed)
    if measured is None or not measured:
        return Finding(OPEN, f"Measured: {number_problem(typed) or 'it cannot be 0'}.", (), facts)
    facts = (*facts, ("Distance", f"{asked} {axis.symbol}"), ("Measured", f"{typed.strip()} {axis.symbol}"))
    found = Fraction(moved.end - moved.start) / measured
    if found < 0:
        words = "The axis went the other way than it was commanded to, by the sign of what you measured."
        return Finding(FAILED, words, TURN_THE_DIRECTION, facts)
    return _scale(found, axis, GAUGE, facts, "The scale is right")


def _stopped(moved: Moved) -> str:
    if moved.tripped:
        return ", and went off by its error limit" if moved.code == BY_ERROR else ", and its motor went off"
    return "" if moved.code == AT_TARGET else f" ({STOP_TEXTS.get(moved.code, f'stop code {moved.code}')})"


def move_facts(moved: Moved) -> tuple[tuple[str, str], ...]:
    return (
        ("Commanded", f"{moved.asked} counts"),
        ("Came", f"{moved.end - moved.start} counts"),
        ("Lowest and highest", f"{moved.low - moved.start}, {moved.high - moved.start} counts"),
        ("Stop code", f"{moved.code}, {STOP_TEXTS.get(moved.code, 'unknown')}"),
        *(_of_a_servo(moved) if moved.error else ()),
    )


def _of_a_servo(moved: Moved) -> tuple[tuple[str, str], ...]:
    return ("Motor command", f"{moved.torque:.2f} V"), ("Error limit", f"{moved.error} counts")
